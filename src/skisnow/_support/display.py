"""Short text and table of an object: a few lines with units at a prompt, a small table in a notebook."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, Final, NamedTuple

import numpy as np

MOST_ROWS: Final = 8
"""With its title an object stays below ten lines."""
_WIDEST: Final = 120
_ROUNDING: Final = 1e-12
"""Share of the larger end of a range, and at least of 1, below which the other end is a rounding error of 0."""


class Facts(NamedTuple):
    """Content of an object: a title, and rows of a name and a text; with one row or none all is on one line."""

    title: str
    rows: tuple[tuple[str, str], ...] = ()


class Shown:
    """Something that shows itself by its `_facts`; a dataclass has no generated repr (``repr=False``)."""

    __slots__ = ()

    def _facts(self) -> Facts:
        raise NotImplementedError

    def __repr__(self) -> str:
        """Title and rows, below ten lines."""
        title, rows = self._facts()
        kind = type(self).__name__
        head = f"<{kind} {title}" if title else f"<{kind}"
        if not rows:
            return f"{_cut(head)}>"
        few = _few(rows)
        width = max(len(name) for name, _ in few)
        return "\n".join([_cut(head), *(_cut(f"  {name.ljust(width)}  {text}") for name, text in few)]) + ">"

    def _repr_html_(self) -> str:
        """The same as a table, which a notebook shows."""
        from html import escape

        title, rows = self._facts()
        caption = escape(f"{type(self).__name__} {title}".strip())
        cells = "".join(
            f'<tr><th scope="row" style="text-align:left">{escape(name)}</th>'
            f'<td style="text-align:left">{escape(text)}</td></tr>'
            for name, text in _few(rows)
        )
        return f'<table><caption style="text-align:left">{caption}</caption>{cells}</table>'


class ShownFields(Shown):
    """A dataclass that shows one row for each of its fields; units are in its docstring."""

    __slots__ = ()

    def _facts(self) -> Facts:
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
    finite = np.asarray(values, float)
    finite = finite[np.isfinite(finite)] / factor
    return span(float(finite.min()), float(finite.max()), unit) if finite.size else "none"


def field_facts(thing: Any, units: dict[str, str], *, title: str = "") -> Facts:
    """One row for each field of a dataclass: an array by its size and ends, in the unit given, all else in short."""
    rows = [(field.name, _short(getattr(thing, field.name), units.get(field.name, ""))) for field in fields(thing)]
    return Facts(title, tuple(rows))


def name_with_values(thing: object) -> str:
    """A dataclass by its name and values, all else by its name alone: no address in memory, the same each time.

    >>> from skisnow.forces.friction import ConstantFriction
    >>> name_with_values(ConstantFriction(0.04)), name_with_values(math.sqrt)
    ('ConstantFriction(friction_coefficient=0.04)', 'sqrt')
    """
    if is_dataclass(thing) and not isinstance(thing, type):
        values = ", ".join(f"{field.name}={getattr(thing, field.name)!r}" for field in fields(thing) if field.repr)
        return f"{type(thing).__qualname__}({' '.join(values.split())})"
    name: str = getattr(thing, "__qualname__", type(thing).__qualname__)
    return name


def _short(value: Any, unit: str) -> str:
    if isinstance(value, np.ndarray):
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


def _few(rows: tuple[tuple[str, str], ...]) -> tuple[tuple[str, str], ...]:
    if len(rows) <= MOST_ROWS:
        return rows
    rest = ", ".join(name for name, _ in rows[MOST_ROWS - 1 :])
    return (*rows[: MOST_ROWS - 1], ("also", rest))


def _cut(line: str) -> str:
    plain = " ".join(line.split("\n"))
    return plain if len(plain) <= _WIDEST else f"{plain[: _WIDEST - 1]}…"
