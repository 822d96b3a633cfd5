"""Friction with a term in the square of the speed."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ..parameter_checks import require_finite, require_not_below_zero
from .law import FrictionLaw


@dataclass(frozen=True, slots=True)
class QuadraticFriction(FrictionLaw):
    """μ = μ_0 + μ_1 v + μ_2 v².

    Attributes
    ----------
    friction_at_rest
        μ_0, ≥ 0: μ as v → 0.
    friction_slope
        μ_1 (s/m).
    friction_curvature
        μ_2 (s²/m²). Speeds at which μ would be negative are refused.

    See Also
    --------
    skisnow.forces.friction.LinearFriction

    Notes
    -----
    Range: μ from 0.023 to 0.139 on skis (Wolfsperger and others 2021); none is known to us of μ_1 and μ_2. Source: the
    next term of a Taylor series (assumption). Under a constant normal force μ_2 v² cannot be distinguished from air
    drag: μ_2 F_n = ½ ρ C_dA.

    References
    ----------
    Wolfsperger and others (2021), Front. Mech. Eng. 7, doi 10.3389/fmech.2021.728722.

    Examples
    --------
    0.03 + 0.001·10 + 0.0001·10² = 0.05.

    >>> law = QuadraticFriction(friction_at_rest=0.03, friction_slope=0.001, friction_curvature=0.0001)
    >>> round(float(law.coefficient(10.0)), 9)
    0.05
    """

    friction_at_rest: float
    friction_slope: float
    friction_curvature: float

    def __post_init__(self) -> None:
        require_not_below_zero(self, friction_at_rest=self.friction_at_rest)
        require_finite(self, friction_slope=self.friction_slope, friction_curvature=self.friction_curvature)
        self._warn_outside()

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return self.friction_at_rest + (self.friction_slope + self.friction_curvature * speed) * speed
