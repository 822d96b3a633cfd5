"""Friction with a minimum at an intermediate speed: a film of water forms, then shears."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ..parameter_checks import require_above_zero, require_not_below_zero
from .law import FrictionLaw


@dataclass(frozen=True, slots=True)
class WaterFilmFriction(FrictionLaw):
    """μ = μ_∞ + a/(1 + v/v_0) + c v.

    The dry part a falls as the sliding melts a film of water; the shearing of the film grows with the speed.

    Attributes
    ----------
    lubricated_friction
        μ_∞, ≥ 0: the friction coefficient at high speed.
    dry_friction
        a, ≥ 0: the reduction by the film; μ as v → 0 is μ_∞ + a.
    film_speed
        v_0 (m/s), > 0: speed at which half of a is left.
    viscous_slope
        c (s/m), ≥ 0.

    See Also
    --------
    skisnow.forces.friction.ConstantFriction

    Notes
    -----
    Range: μ from 0.023 to 0.139 on skis (Wolfsperger and others 2021). Source: Colbeck (1988, J. Glaciol. 34) describes
    the two parts and the minimum between them; he computes them from the heat and gives no such formula. The formula is
    ours (modelling assumption): the simplest with both parts and a minimum that can be stated exactly,
    v = v_0 (√(a/(c v_0)) - 1) if a > c v_0, where μ = μ_∞ + 2 √(a c v_0) - c v_0. Otherwise μ grows from the start.

    References
    ----------
    * Colbeck (1988), J. Glaciol. 34.
    * Wolfsperger and others (2021), Front. Mech. Eng. 7, doi 10.3389/fmech.2021.728722.

    Examples
    --------
    a = 0.04, v_0 = 1 m/s, c = 0.0004 s/m: the minimum is at 1·(√100 - 1) = 9 m/s, where
    μ = 0.03 + 0.04/10 + 0.0004·9 = 0.0376.

    >>> law = WaterFilmFriction(lubricated_friction=0.03, dry_friction=0.04, film_speed=1.0, viscous_slope=0.0004)
    >>> round(law.speed_of_least_friction, 9), round(float(law.coefficient(9.0)), 9)
    (9.0, 0.0376)
    """

    lubricated_friction: float
    dry_friction: float
    film_speed: float
    viscous_slope: float

    def __post_init__(self) -> None:
        require_not_below_zero(
            self,
            lubricated_friction=self.lubricated_friction,
            dry_friction=self.dry_friction,
            viscous_slope=self.viscous_slope,
        )
        require_above_zero(self, film_speed=self.film_speed)
        self._warn_outside()

    @property
    def speed_of_least_friction(self) -> float:
        """Speed (m/s) of the minimum of μ: 0 where μ only grows, infinite where it only falls."""
        if self.dry_friction <= self.viscous_slope * self.film_speed:
            return 0.0
        if self.viscous_slope == 0:
            return math.inf
        return self.film_speed * (math.sqrt(self.dry_friction / (self.viscous_slope * self.film_speed)) - 1.0)

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        dry = self.dry_friction / (1.0 + speed / self.film_speed)
        return self.lubricated_friction + dry + self.viscous_slope * speed
