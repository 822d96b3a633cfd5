"""A failure shear stress that falls with the edge angle, as the soft snow of the paper shows."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.units import N_PER_MM2
from ...snow.published.moessner_2013 import STRESS_BY_ANGLE
from ..measured_ranges import FAILURE_SHEAR_STRESS
from ..parameter_checks import RIGHT_ANGLE, require_above_zero, require_finite
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class AngleShear(ShearLaw):
    """F_t = S_f0 (1 - k ϑ) e L, ϑ in rad (the form of Eqn 13).

    Attributes
    ----------
    flat_shear_stress
        S_f0 (N/m²), the stress extrapolated to ϑ = 0.
    relative_decrease
        k (1/rad), at most 2/π: the stress must not turn negative before the edge is upright.

    See Also
    --------
    skisnow.forces.shear.ConstantShear
    skisnow.forces.shear.MachiningShear

    Notes
    -----
    Range: one soft snow, S_f0 = 0.059 N/mm² and k = 0.266, n = 30, rmse 0.006 N/mm²: `AngleShear.soft_snow`. On the
    hard snow of the paper no dependence on ϑ was found (n = 20, p = 0.50). Source: Mössner and others (2013).
    At 90° the printed digits give 0.0343 N/mm²; with unrounded ones 0.0344 has been stated.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    Upright: 0.059 (1 - 0.266·1.5708) = 0.0343 N/mm², on 100 mm of edge, 10 mm deep: 34.3 N.

    >>> import math
    >>> round(float(AngleShear.soft_snow().failure_force(0.010, 0.100, math.pi / 2)), 1)
    34.3
    """

    flat_shear_stress: float
    relative_decrease: float

    def __post_init__(self) -> None:
        require_above_zero(self, flat_shear_stress=self.flat_shear_stress)
        require_finite(self, relative_decrease=self.relative_decrease)
        if self.relative_decrease * RIGHT_ANGLE > 1.0:
            raise ParameterError(
                "AngleShear: with a relative_decrease of {relative_decrease!r} per rad the stress is negative on an "
                "upright edge; it must be at most 2/π = 0.637 per rad (Eqn 13: 0.266)",
                code="out_of_range",
                relative_decrease=self.relative_decrease,
            )
        FAILURE_SHEAR_STRESS.warn_outside(self.flat_shear_stress, "AngleShear", stacklevel=3)

    @classmethod
    def soft_snow(cls) -> AngleShear:
        """Eqn 13 with its printed numbers, the soft snow on which it was found."""
        flat, decrease = STRESS_BY_ANGLE
        return cls(flat_shear_stress=flat * N_PER_MM2, relative_decrease=decrease)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return self.flat_shear_stress * (1.0 - self.relative_decrease * angle)
