"""Unit factors: multiply a number in the named unit to get SI; divide to go back.

The only place where 1 N/mm³ = 10⁹ N/m³ and its likes are written.

>>> 0.2 * N_PER_MM3
200000000.0
"""

from __future__ import annotations

import math
from functools import cache
from typing import Final, NamedTuple

MM: Final = 1e-3
"""Metres in a millimetre."""
MM2: Final = 1e-6
"""Square metres in a square millimetre."""
MM3: Final = 1e-9
"""Cubic metres in a cubic millimetre."""
CM: Final = 1e-2
"""Metres in a centimetre."""
N_PER_MM: Final = 1e3
"""N/m in 1 N/mm, the unit of H_e."""
N_PER_MM2: Final = 1e6
"""N/m² in 1 N/mm², the unit of H_A and S_f."""
N_PER_MM3: Final = 1e9
"""N/m³ in 1 N/mm³, the unit of H_V."""
KILOGRAM_FORCE: Final = 9.80665
"""Newtons in the weight of a kilogram under standard gravity (CGPM 1901)."""
DEGREE: Final = 0.017453292519943295
"""Radians in a degree."""
HOUR: Final = 3600.0
"""Seconds in an hour."""
PERCENT: Final = 0.01
"""One percent."""
MS: Final = 1e-3
"""Seconds in a millisecond."""

_LIKE_RADIANS_DEG: Final = 1.6
"""Angles below it, but 0, look like radians: 1.6 is just above 90° in radians."""


class Unit(NamedTuple):
    """A unit as people write it, and its size in SI."""

    symbol: str
    size: float


_NONE: Final = Unit("", 1.0)
_BY_ENDING: Final = {
    "N_per_mm3": Unit("N/mm³", N_PER_MM3),
    "N_s_per_mm3": Unit("N s/mm³", N_PER_MM3),
    "N_per_mm2": Unit("N/mm²", N_PER_MM2),
    "N_per_mm": Unit("N/mm", N_PER_MM),
    "per_mm": Unit("1/mm", 1.0 / MM),
    "kg_per_m3": Unit("kg/m³", 1.0),
    "kg_per_m": Unit("kg/m", 1.0),
    "m_per_s2": Unit("m/s²", 1.0),
    "m_per_s": Unit("m/s", 1.0),
    "s_per_m": Unit("s/m", 1.0),
    "per_rad": Unit("1/rad", 1.0),
    "per_s": Unit("1/s", 1.0),
    "kg_m2": Unit("kg m²", 1.0),
    "N_m2": Unit("N m²", 1.0),
    "Nm_per_deg": Unit("N m/°", 1.0 / DEGREE),
    "deg": Unit("°", DEGREE),
    "mm": Unit("mm", MM),
    "ms": Unit("ms", MS),
    "Nm": Unit("N m", 1.0),
    "m2": Unit("m²", 1.0),
    "kg": Unit("kg", 1.0),
    "C": Unit("°C", 1.0),
    "N": Unit("N", 1.0),
    "m": Unit("m", 1.0),
    "s": Unit("s", 1.0),
    "h": Unit("h", HOUR),
}
"""Endings of keys and columns, longer ones before those that end like them."""


def unit_of_name(name: str) -> Unit:
    """The unit that a name of a key or column ends with; none: a number without unit, of size 1.

    >>> unit_of_name("snow.H_V_N_per_mm3"), unit_of_name("friction.mu_0").symbol
    (Unit(symbol='N/mm³', size=1000000000.0), '')
    """
    return _BY_ENDING.get(_ending(name), _NONE)


def without_unit(name: str) -> str:
    """A name without its unit.

    >>> without_unit("start.speed_m_per_s"), without_unit("friction.mu_0")
    ('start.speed', 'friction.mu_0')
    """
    ending = _ending(name)
    return name.removesuffix(f"_{ending}") if ending else name


@cache
def _ending(name: str) -> str:
    name = name.partition("[")[0]  # unit of each item of a list
    return next((ending for ending in _BY_ENDING if name.endswith(f"_{ending}")), "")


def in_degrees_if_radians(angle_deg: float) -> float | None:
    """Degrees for a number that looks like radians, else None.

    >>> round(in_degrees_if_radians(0.785), 1), in_degrees_if_radians(45.0), in_degrees_if_radians(0.0)
    (45.0, None, None)
    """
    return math.degrees(angle_deg) if 0.0 < angle_deg < _LIKE_RADIANS_DEG else None


STANDARD_GRAVITY: Final = 9.81
"""Acceleration of gravity in m/s² (modelling assumption: the value the skiing literature computes with)."""

ICE_DENSITY: Final = 917.0
"""Density of ice at 0 °C in kg/m³ (Mössner and others 2013, introduction): no snow is denser."""

ZERO_CELSIUS: Final = 273.15
"""0 °C in K (exact: the definition of the degree Celsius)."""

CONFIDENCE: Final = 0.95
"""Coverage that every interval of this package claims."""
