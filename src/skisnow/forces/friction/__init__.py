"""Glide friction over the speed; ``LAWS`` lists the rivals."""

from typing import Final

from .law import FrictionLaw
from .law_file import FrictionFile, SnowState, read_friction_file
from .speed_laws import ConstantFriction, LinearFriction, QuadraticFriction, WaterFilmFriction

LAWS: Final[tuple[type[FrictionLaw], ...]] = (ConstantFriction, LinearFriction, QuadraticFriction, WaterFilmFriction)
"""Every law for glide friction: one set of tests runs over all of them."""

__all__ = [
    "LAWS", "ConstantFriction", "FrictionFile", "FrictionLaw", "LinearFriction", "QuadraticFriction", "SnowState",
    "WaterFilmFriction", "read_friction_file",
]  # fmt: skip
