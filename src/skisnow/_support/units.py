"""Unit factors (multiply a number in the named unit to get SI), and objects in a few lines.

The only place where 1 N/mm³ = 10⁹ N/m³ and its likes are written.

>>> 0.2 * N_PER_MM3
200000000.0
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from html import escape
from typing import Any, Final, NamedTuple

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
    """A unit: its symbol in texts, and the factor from it to SI."""

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
    """Unit at the end of the name of a key or column; without one, the unit with the symbol "" and the size 1.

    >>> unit_of_name("snow.H_V_N_per_mm3"), unit_of_name("friction.mu_0").symbol
    (Unit(symbol='N/mm³', size=1000000000.0), '')
    """
    return _BY_ENDING.get(_unit_ending(name), _NONE)


def without_unit(name: str) -> str:
    """A name without its unit.

    >>> without_unit("start.speed_m_per_s"), without_unit("friction.mu_0")
    ('start.speed', 'friction.mu_0')
    """
    ending = _unit_ending(name)
    return name.removesuffix(f"_{ending}") if ending else name


@cache
def _unit_ending(name: str) -> str:
    """Known unit at the end of a name, without the underscore; "" without one."""
    name = name.partition("[")[0]  # unit of each item of a list
    return next((ending for ending in _BY_ENDING if name.endswith(f"_{ending}")), "")


def in_degrees_if_radians(angle_deg: float) -> float | None:
    """Angle in degrees if a number stated as degrees looks like radians (above 0, below 1.6), otherwise None.

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


MOST_ROWS: Final = 8
"""With its title an object stays below ten lines."""
_WIDEST: Final = 120
_ROUNDING: Final = 1e-12
"""Share of the larger end of a range, and at least of 1, below which the other end is a rounding error of 0."""


class Facts(NamedTuple):
    """Content of an object's repr: title, and rows of name and text; with at most one row all is on one line."""

    title: str
    rows: tuple[tuple[str, str], ...] = ()


class Shown:
    """Base of objects with a readable repr and a notebook's table, both from the title and rows of `_repr_facts`.

    A dataclass of this kind has no generated repr (``repr=False``).
    """

    __slots__ = ()

    def _repr_facts(self) -> Facts:
        """Title and rows of the object's repr, each row a name and a text."""
        raise NotImplementedError

    def _notebook_facts(self) -> Facts:
        """Title and rows of a notebook's table, where a row may have a value that the text has in its title."""
        return self._repr_facts()

    def __repr__(self) -> str:
        """Title and rows, below ten lines."""
        title, rows = self._repr_facts()
        kind = type(self).__name__
        head = f"<{kind} {title}" if title else f"<{kind}"
        if not rows:
            return f"{_clip(head)}>"
        few = _limit_rows(rows)
        width = max(len(name) for name, _ in few)
        return "\n".join([_clip(head), *(_clip(f"  {name.ljust(width)}  {text}") for name, text in few)]) + ">"

    def _repr_html_(self) -> str:
        """Table of the title and rows in HTML, which a notebook displays."""
        title, rows = self._notebook_facts()
        caption = escape(f"{type(self).__name__} {title}".strip())
        cells = "".join(
            f'<tr><th scope="row" style="text-align:left">{escape(name)}</th>'
            f'<td style="text-align:left">{escape(text)}</td></tr>'
            for name, text in _limit_rows(rows)
        )
        return f'<table><caption style="text-align:left">{caption}</caption>{cells}</table>'


class ShownFields(Shown):
    """Base of dataclasses whose repr has one row for each field, without units, which the docstring states."""

    __slots__ = ()

    def _repr_facts(self) -> Facts:
        """Facts of all fields, for the representation."""
        return field_facts(self, {})


def amount(value: float | None, unit: str = "", *, digits: int = 4) -> str:
    """A number with its unit.

    >>> amount(0.44215), amount(12.0, "m"), amount(None, "m"), amount(30.0, "°")
    ('0.4421', '12 m', 'unknown', '30°')
    """
    if value is None or math.isnan(value):
        return "unknown"
    return f"{value:.{digits}g}{'' if unit in ('', '°') else ' '}{unit}"


def span(low: float, high: float, unit: str = "", *, digits: int = 4) -> str:
    """Both ends of a range with their unit.

    >>> span(7.0, 10.25, "m/s")
    '7 to 10.25 m/s'
    >>> span(-2e-17, 30.0, "°")
    '0 to 30°'
    """
    negligible = _ROUNDING * max(abs(low), abs(high), 1.0)
    low, high = (0.0 if abs(end) < negligible else end for end in (low, high))
    return f"{amount(low, digits=digits)} to {amount(high, unit, digits=digits)}"


def ends(values: Any, unit: str = "", *, factor: float = 1.0) -> str:
    """Minimum and maximum of the finite values of an array, in a unit of this size.

    >>> ends([0.001, 0.003, float("nan")], "mm", factor=1e-3)
    '1 to 3 mm'
    """
    import numpy as np  # the commands' help starts without it

    finite = np.asarray(values, float)
    finite = finite[np.isfinite(finite)] / factor
    return span(float(finite.min()), float(finite.max()), unit) if finite.size else "none"


def field_facts(thing: Any, units: dict[str, str], *, title: str = "") -> Facts:
    """Title and rows of a dataclass's repr: short values with the units by name; for an array its shape and range."""
    shown = [field.name for field in fields(thing) if field.repr]
    rows = [(name, _short_text(getattr(thing, name), units.get(name, ""))) for name in shown]
    return Facts(title, tuple(rows))


def name_with_values(thing: object) -> str:
    """Reproducible text of an object: a dataclass by its name and values, any other object by its name alone.

    >>> from skisnow.forces.friction import ConstantFriction
    >>> name_with_values(ConstantFriction(0.04)), name_with_values(math.sqrt)
    ('ConstantFriction(friction_coefficient=0.04)', 'sqrt')
    """
    if is_dataclass(thing) and not isinstance(thing, type):
        values = ", ".join(f"{field.name}={getattr(thing, field.name)!r}" for field in fields(thing) if field.repr)
        return f"{type(thing).__qualname__}({' '.join(values.split())})"
    name: str = getattr(thing, "__qualname__", type(thing).__qualname__)
    return name


def _short_text(value: Any, unit: str) -> str:
    """Short text of a value: size and range of an array, type of a dataclass, number with unit, count or text."""
    if hasattr(value, "dtype") and hasattr(value, "shape"):  # an array, without loading NumPy
        size = " × ".join(map(str, value.shape))
        return f"{size}: {ends(value, unit)}" if value.dtype.kind in "fiu" and value.size else size
    if is_dataclass(value):
        return type(value).__name__
    if isinstance(value, float):
        return amount(value, unit)
    if isinstance(value, Mapping) or (isinstance(value, tuple | list) and len(value) > 3):
        return f"{len(value)} entries"
    text = str(value)
    return text if len(text) <= 60 else f"{text[:59]}…"


def _limit_rows(rows: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    """The rows up to the maximum; the names of further ones share the last row."""
    if len(rows) <= MOST_ROWS:
        return rows
    rest = ", ".join(name for name, _ in rows[MOST_ROWS - 1 :])
    return (*rows[: MOST_ROWS - 1], ("also", rest))


def _clip(line: str) -> str:
    """Text in one line, cut with "…" at the maximum width."""
    plain = " ".join(line.split("\n"))
    return plain if len(plain) <= _WIDEST else f"{plain[: _WIDEST - 1]}…"
