"""One failure shear stress for all depths and angles: the law that Mössner and others (2013) propose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._support.arrays import FloatArray
from ..measured_ranges import FAILURE_SHEAR_STRESS
from ..parameter_checks import require_above_zero
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class ConstantShear(ShearLaw):
    """F_t = S_f e L (Eqn 9).

    Attributes
    ----------
    failure_shear_stress
        S_f (N/m²).

    See Also
    --------
    skisnow.forces.shear.AngleShear
    skisnow.forces.shear.DensityShear

    Notes
    -----
    Range: 0.04-0.52 N/mm² on groomed ski slopes. Source: Mössner and others (2013), 108 experiments; the upper end is
    the race piste of Federolf and others (2006) as converted there. S_f is the stress at the start of shearing. The
    resistance during further sliding may be lower and was not measured.

    References
    ----------
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.

    Examples
    --------
    0.2 N/mm² on 100 mm of edge, 6 mm deep: 120 N.

    >>> law = ConstantShear(failure_shear_stress=0.2e6)
    >>> round(float(law.failure_force(0.006, 0.100, 0.0)), 9)
    120.0
    """

    failure_shear_stress: float

    def __post_init__(self) -> None:
        require_above_zero(self, failure_shear_stress=self.failure_shear_stress)
        FAILURE_SHEAR_STRESS.warn_outside(self.failure_shear_stress, "ConstantShear", stacklevel=3)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return np.full(depth.shape, self.failure_shear_stress)
