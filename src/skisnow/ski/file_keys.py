"""The keys of a ski file: unit, range, usual range and default, in one place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from ..units import DEGREE, MM

_LENGTHS: Final = (("metres", 1e3), ("centimetres", 10.0), ("inches", 25.4))


@dataclass(frozen=True, slots=True, kw_only=True)
class NumberKey:
    """What a number of a ski file may be; all in the unit that its key names.

    Attributes
    ----------
    unit
        Factor to SI.
    lowest, highest
        What lies beyond is an error.
    usual
        What lies beyond, and is not 0, is warned of.
    other_units
        Units that people write by mistake: name and factor to the key's unit.
    """

    unit: float
    lowest: float
    highest: float
    usual: tuple[float, float]
    other_units: tuple[tuple[str, float], ...] = ()

    @property
    def allowed(self) -> str:
        """The range in words."""
        return f"{self.lowest:g} to {self.highest:g}"

    def is_usual(self, value: float) -> bool:
        """Whether skis have such a value (in the key's unit)."""
        return self.usual[0] <= value <= self.usual[1]

    def likely_unit(self, value: float) -> str:
        """Name the unit in which an unusual value would be a usual one, as a question; or nothing."""
        for name, factor in self.other_units:
            if self.is_usual(value * factor):
                return f" Is it in {name}? Then write {value * factor:g}."
        return ""


def _mm(lowest: float, highest: float, usual: tuple[float, float]) -> NumberKey:
    return NumberKey(unit=MM, lowest=lowest, highest=highest, usual=usual, other_units=_LENGTHS)


_STIFFNESS_UNITS = (("N mm²", 1e-6), ("kN m²", 1e3))

NUMBER_KEYS: Final[dict[str, NumberKey]] = {
    "length_mm": _mm(20, 3000, (180, 2300)),
    "running_length_mm": _mm(20, 3000, (180, 2300)),
    "sidecut_length_mm": _mm(20, 3000, (180, 2300)),
    "tip_width_mm": _mm(15, 500, (40, 350)),
    "waist_width_mm": _mm(15, 500, (40, 350)),
    "tail_width_mm": _mm(15, 500, (40, 350)),
    "tail_overhang_mm": _mm(0, 500, (1, 250)),
    "boot_position_mm": _mm(-500, 500, (-200, 200)),
    "camber_mm": _mm(-50, 50, (0.5, 25)),
    "shovel_height_mm": _mm(0, 300, (5, 150)),
    "tail_height_mm": _mm(0, 300, (1, 150)),
    "tip_rocker_length_mm": _mm(0, 1500, (20, 800)),
    "tip_rocker_height_mm": _mm(0, 200, (0.5, 100)),
    "tail_rocker_length_mm": _mm(0, 1500, (20, 800)),
    "tail_rocker_height_mm": _mm(0, 200, (0.5, 100)),
    "mass_kg": NumberKey(unit=1.0, lowest=0.01, highest=50, usual=(0.1, 10), other_units=(("grams", 1e-3),)),
    "base_bevel_deg": NumberKey(
        unit=DEGREE, lowest=0, highest=5, usual=(0.1, 3), other_units=(("radians", 1.0 / DEGREE),)
    ),
    "edge_width_mm": _mm(0, 20, (0.5, 5)),
}
"""Keys with one number."""

LIST_KEYS: Final[dict[str, NumberKey]] = {
    "EI_N_m2": NumberKey(unit=1.0, lowest=1e-3, highest=1e8, usual=(5, 5000), other_units=_STIFFNESS_UNITS),
    "GJ_N_m2": NumberKey(unit=1.0, lowest=1e-3, highest=1e8, usual=(2, 5000), other_units=_STIFFNESS_UNITS),
    "stiffness_station_mm": _mm(-3000, 3000, (-1500, 1500)),
}
"""Keys with a list of numbers, tip to tail."""

COLUMNS: Final[dict[str, NumberKey]] = {
    "station_m": NumberKey(unit=1.0, lowest=-3, highest=3, usual=(-1.5, 2.0), other_units=(("mm", 1e-3), ("cm", 1e-2))),
    "width_mm": _mm(1, 500, (5, 350)),
    "base_height_mm": _mm(-300, 300, (-150, 200)),
    "EI_N_m2": LIST_KEYS["EI_N_m2"],
    "GJ_N_m2": LIST_KEYS["GJ_N_m2"],
    "mass_per_length_kg_per_m": NumberKey(
        unit=1.0, lowest=0.01, highest=50, usual=(0.1, 10), other_units=(("g/m", 1e-3),)
    ),
}
"""Columns of a table, a row for each station from tip to tail."""

TEXT_KEYS: Final = ("name", "source", "table", "shape")
"""Keys with a text."""

RIGID: Final = 1e6
"""EI and GJ of a rigid ski (N m²). Choice: 200 mm of it, held in the middle, bend by 0.03 micrometre under 500 N."""

WIDTHS: Final = ("tip_width_mm", "waist_width_mm", "tail_width_mm")
LENGTHS: Final = ("length_mm", "tail_overhang_mm")
BASE: Final = (
    "camber_mm",
    "shovel_height_mm",
    "tail_height_mm",
    "tip_rocker_length_mm",
    "tip_rocker_height_mm",
    "tail_rocker_length_mm",
    "tail_rocker_height_mm",
)

KEYS: Final = (*TEXT_KEYS, *NUMBER_KEYS, *LIST_KEYS, "rigid")
"""Every key of a ski file."""
