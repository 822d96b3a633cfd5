"""Failure of snow sideways under an edge; ``LAWS`` lists the rivals."""

from typing import Final

from .by_angle import AngleShear
from .by_density import DensityShear
from .by_density_natural import NaturalDensityShear
from .constant import ConstantShear
from .ice_cutting import IceCuttingShear
from .law import ShearLaw
from .machining import MachiningShear

LAWS: Final[tuple[type[ShearLaw], ...]] = (
    ConstantShear,
    AngleShear,
    DensityShear,
    NaturalDensityShear,
    MachiningShear,
    IceCuttingShear,
)
"""Every law for the shear force: one set of tests runs over all of them."""

__all__ = [
    "LAWS",
    "AngleShear",
    "ConstantShear",
    "DensityShear",
    "IceCuttingShear",
    "MachiningShear",
    "NaturalDensityShear",
    "ShearLaw",
]
