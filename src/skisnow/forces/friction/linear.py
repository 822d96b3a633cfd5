"""Friction that changes in proportion to the speed."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ..parameter_checks import require_finite, require_not_below_zero
from .law import FrictionLaw


@dataclass(frozen=True, slots=True)
class LinearFriction(FrictionLaw):
    """μ = μ_0 + μ_1 v.

    Attributes
    ----------
    friction_at_rest
        μ_0, ≥ 0: μ as v → 0.
    friction_slope
        μ_1 (s/m). Below 0 the law is refused at speeds at which μ would be negative; a run counts μ as 0 there.

    See Also
    --------
    skisnow.forces.friction.ConstantFriction
    skisnow.forces.friction.QuadraticFriction

    Notes
    -----
    Range: μ from 0.023 to 0.139 on skis (Wolfsperger and others 2021); no range of μ_1 is known to us. Source: the form
    in which a friction that depends on the speed has been identified from runs (Mössner and others 2013 report such an
    identification and print no numbers).

    References
    ----------
    * Wolfsperger and others (2021), Front. Mech. Eng. 7, doi 10.3389/fmech.2021.728722.
    * Kaps, Nachbauer and Mössner (1996), "Determination of kinetic friction and drag area in alpine skiing", ASTM STP
      1266, 165-177.

    Examples
    --------
    0.03 + 0.001·20 = 0.05.

    >>> round(float(LinearFriction(friction_at_rest=0.03, friction_slope=0.001).coefficient(20.0)), 9)
    0.05
    """

    friction_at_rest: float
    friction_slope: float

    def __post_init__(self) -> None:
        require_not_below_zero(self, friction_at_rest=self.friction_at_rest)
        require_finite(self, friction_slope=self.friction_slope)
        self._warn_outside()

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return self.friction_at_rest + self.friction_slope * speed
