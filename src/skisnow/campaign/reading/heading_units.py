"""Units that the headings of tables name, and how their numbers are converted to the unit of the column."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from ..._support.units import DEGREE, KILOGRAM_FORCE, ZERO_CELSIUS

if TYPE_CHECKING:
    from ..records import FloatArray

_OWN: Final = {
    "deg": ("°", "deg", "degree", "degrees", "Grad", "Winkelgrad"), "N": ("N", "Newton"),
    "mm": ("mm", "Millimeter"), "Nm": ("Nm", "N m", "N·m", "N*m"),
    "kg_per_m3": ("kg/m³", "kg/m3", "kg/m^3", "kg m-3", "kg·m⁻³", "g/l"), "C": ("°C", "Grad C", "Celsius"),
}  # fmt: skip
"""Units of columns, as the last part of a column's name writes them, with their names in headings."""
_OTHER: Final[dict[str, dict[tuple[str, ...], tuple[float, float]]]] = {
    "deg": {("rad",): (1.0 / DEGREE, 0.0)},
    "N": {
        ("kg", "kgf", "kp"): (KILOGRAM_FORCE, 0.0),
        ("g", "Gramm"): (1e-3 * KILOGRAM_FORCE, 0.0),
        ("kN",): (1e3, 0.0),
        ("daN",): (10.0, 0.0),
    },
    "mm": {
        ("cm", "Zentimeter"): (10.0, 0.0),
        ("m", "Meter"): (1e3, 0.0),
        ("dm",): (100.0, 0.0),
        ("µm", "μm", "um"): (1e-3, 0.0),
        ("in", "inch"): (25.4, 0.0),
    },
    "Nm": {
        ("Ncm", "N cm", "N·cm"): (1e-2, 0.0),
        ("Nmm", "N mm", "N·mm"): (1e-3, 0.0),
        ("kNm", "kN m", "kN·m"): (1e3, 0.0),
    },
    "kg_per_m3": {("g/cm³", "g/cm3", "g/cm^3", "g cm-3", "kg/l", "kg/dm³", "kg/dm3", "t/m³", "t/m3"): (1e3, 0.0)},
    "C": {("K", "Kelvin"): (1.0, -ZERO_CELSIUS), ("°F", "Fahrenheit"): (5.0 / 9.0, -160.0 / 9.0)},
}
"""Factor and shift from other units to those of columns."""
_ONLY_NAMED: Final = ("mn", "s", "min", "h", "%", "pa", "kpa", "mpa")
"""Units that no column is converted from."""
FORM: Final = re.compile(
    r"(?P<words>[^\[(]*?)\s*(?:[\[(](?P<in>[^\])]*)[\])]?|/\s*(?P<per>\S+)|\bin\s+(?P<of>\S+))?\s*"
)
_LAST_WORD: Final = re.compile(
    r".*[^\s_,][\s_,]+(mm|cm|µm|μm|kg|N|kN|Nm|Ncm|Nmm|°|°C|kg/m³|kg/m3|g/cm³|g/cm3|kg/l)|.*[^\s_]_m"
)
"""Headings that end with a unit without brackets: Last kg, load_kg, depth_m."""


@dataclass(frozen=True, slots=True)
class UnitConversion:
    """Conversion of numbers from the unit that a heading names to the unit of their column."""

    name: str = field(compare=False)
    factor: float = 1.0
    shift: float = 0.0

    @property
    def changes(self) -> bool:
        """Whether the units differ."""
        return (self.factor, self.shift) != (1.0, 0.0)

    def convert(self, values: FloatArray) -> FloatArray:
        """Numbers in the unit of the column.

        >>> import numpy as np
        >>> conversion("cm", "depth_mm").convert(np.array([1.5])).tolist()
        [15.0]
        """
        return values * self.factor + self.shift if self.changes else values

    def revert(self, value: float) -> float:
        """A number in the unit that the heading names, from the unit of the column.

        >>> conversion("cm", "depth_mm").revert(15.0)
        1.5
        """
        return (value - self.shift) / self.factor if self.changes else value


_CONVERSIONS: Final = {
    **{(unit, name.casefold()): UnitConversion(names[0]) for unit, names in _OWN.items() for name in names},
    **{
        (unit, name.casefold()): UnitConversion(names[0], *size)
        for unit, others in _OTHER.items()
        for names, size in others.items()
        for name in names
    },
}
_KNOWN: Final = frozenset({name for _, name in _CONVERSIONS} | set(_ONLY_NAMED))


def unit_of_column(name: str) -> str:
    """The unit in a column's name, as its last part writes it; empty where it has none.

    >>> unit_of_column("snow_density_kg_per_m3"), unit_of_column("load_N"), unit_of_column("site")
    ('kg_per_m3', 'N', '')
    """
    return next((unit for unit in sorted(_OWN, key=len, reverse=True) if name.endswith(f"_{unit}")), "")


def named_unit(heading: str) -> str:
    """Known unit that a heading names, in small letters; empty if it names none.

    >>> [named_unit(each) for each in ("Last [kg]", "Tiefe / mm", "Arm in cm", "load_kg", "Tiefe (roh)", "Moment M")]
    ['kg', 'mm', 'cm', 'kg', '', '']
    """
    plain = " ".join(heading.split())
    last = _LAST_WORD.fullmatch(plain)
    if last:
        return (last[1] or "m").casefold()
    found = FORM.fullmatch(plain)
    unit = (found["in"] or found["per"] or found["of"] or "").strip() if found else ""
    return known_unit(unit)


def known_unit(text: str) -> str:
    """A unit as the tables of this module write it; empty if it is unknown."""
    unit = " ".join(text.split()).casefold()
    return unit if unit in _KNOWN else ""


def conversion(unit: str, column: str) -> UnitConversion | None:
    """Conversion from a known unit to that of a column; None if the column has a quantity of another kind."""
    return _CONVERSIONS.get((unit_of_column(column), unit))


def own_unit(column: str) -> str:
    """The unit of a column as headings name it."""
    return _OWN[unit_of_column(column)][0].casefold()


def units_for(column: str) -> str:
    """Names of the units that numbers of a column may have, the column's first.

    >>> units_for("load_N")
    'N, kg, g, kN, daN'
    """
    unit = unit_of_column(column)
    return ", ".join([_OWN[unit][0], *(names[0] for names in _OTHER[unit])])


def every_unit() -> str:
    """Names of the units that numbers of any column may have."""
    return ", ".join(f"{names[0]}, {', '.join(other[0] for other in _OTHER[unit])}" for unit, names in _OWN.items())
