"""Elastic snow at one place: it forgets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..measured_ranges import SNOW_HARDNESS
from ..parameter_checks import require_above_zero
from .point_law import PointLaw


@dataclass(frozen=True, slots=True)
class ElasticPoint(PointLaw):
    """p = H_V ε for ε > 0, else 0 (Eqn 12), loading and unloading on the same line.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).

    See Also
    --------
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range: that of `VolumeLaw`. Source: Mössner and others (2013), who measured only loading. No groove is left and no
    energy is lost: snow does not behave so, but most simulations of skiing do.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    0.2 N/mm³, 5 mm deep: 1 N/mm², and ½·0.2·5² = 2.5 N/mm = 2,500 J/m².

    >>> snow = ElasticPoint(snow_hardness=0.2e9)
    >>> float(snow.stress(0.005, 0.008)), float(snow.stored_energy(0.005, 0.008))
    (1000000.0, 2500.0)
    """

    snow_hardness: float

    def __post_init__(self) -> None:
        require_above_zero(self, snow_hardness=self.snow_hardness)
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "ElasticPoint", stacklevel=3)

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stress`; the deepest depth does not matter."""
        depth, _ = np.broadcast_arrays(np.asarray(depth, float), np.asarray(deepest, float))
        result: FloatArray = self.snow_hardness * np.maximum(depth, 0.0)
        return result

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.residual_depth`: 0."""
        return np.zeros(np.shape(deepest))

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stored_energy`: ½ H_V ε²."""
        return self.stress(depth, deepest) ** 2 / (2.0 * self.snow_hardness)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.lost_energy`: 0."""
        return np.zeros(np.shape(deepest))
