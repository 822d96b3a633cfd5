"""Failure of snow sideways under an edge; ``LAWS`` lists the rivals."""

from typing import Final

from .law import ShearLaw
from .machining import IceCuttingShear, MachiningShear, cutting_stress, cutting_thrust
from .stress_laws import AngleShear, ConstantShear, DensityShear, NaturalDensityShear

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
    "LAWS", "AngleShear", "ConstantShear", "DensityShear", "IceCuttingShear", "MachiningShear", "NaturalDensityShear",
    "ShearLaw", "cutting_stress", "cutting_thrust",
]  # fmt: skip
