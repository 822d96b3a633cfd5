"""The same friction at every speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._support.arrays import FloatArray
from ..parameter_checks import require_not_below_zero
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

    friction_coefficient: float

    def __post_init__(self) -> None:
        require_not_below_zero(self, friction_coefficient=self.friction_coefficient)
        self._warn_outside()

    def _coefficient(self, speed: FloatArray) -> FloatArray:
        return np.full(speed.shape, self.friction_coefficient)
