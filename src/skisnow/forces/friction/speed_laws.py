"""Friction that is constant or a polynomial of the speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..._support.arrays import FloatArray
from ..parameter_checks import ABOVE_ZERO, FINITE, NOT_BELOW_ZERO
from .law import FrictionLaw


@dataclass(frozen=True, slots=True)
class ConstantFriction(FrictionLaw):
    """μ = μ_0.

    Attributes
    ----------
    friction_coefficient
        μ_0, ≥ 0.

    See Also
    --------
    skisnow.forces.friction.LinearFriction
    skisnow.forces.friction.WaterFilmFriction

    Notes
    -----
    Range: 0.023-0.139 on skis. Source: Coulomb's law; the range from Wolfsperger and others (2021).

    References
    ----------
    Wolfsperger and others (2021), Front. Mech. Eng. 7, doi 10.3389/fmech.2021.728722.

    Examples
    --------
    800 N at 6 m/s along x and 8 m/s along y, μ = 0.05: 40 N, against the motion.

    >>> force = ConstantFriction(friction_coefficient=0.05).friction_force(800.0, [6.0, 8.0])
    >>> [round(component, 9) for component in force.tolist()]
    [-24.0, -32.0]
    """

    friction_coefficient: Annotated[float, NOT_BELOW_ZERO]

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return np.full(speed.shape, self.friction_coefficient)


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

    friction_at_rest: Annotated[float, NOT_BELOW_ZERO]
    friction_slope: Annotated[float, FINITE]

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return self.friction_at_rest + self.friction_slope * speed


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

    friction_at_rest: Annotated[float, NOT_BELOW_ZERO]
    friction_slope: Annotated[float, FINITE]
    friction_curvature: Annotated[float, FINITE]

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return self.friction_at_rest + (self.friction_slope + self.friction_curvature * speed) * speed


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

    lubricated_friction: Annotated[float, NOT_BELOW_ZERO]
    dry_friction: Annotated[float, NOT_BELOW_ZERO]
    film_speed: Annotated[float, ABOVE_ZERO]
    viscous_slope: Annotated[float, NOT_BELOW_ZERO]

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
