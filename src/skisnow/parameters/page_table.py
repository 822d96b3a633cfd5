"""The table of a page of the documentation that says every key."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from .quantity import Quantity


def _allowed(quantity: Quantity) -> str:
    if quantity.kind == "text" and not quantity.choices:
        return "a text"
    return quantity.allowed + (", `inf`" if quantity.infinite else "")


def _usual(quantity: Quantity) -> str:
    return "" if quantity.usual is None else "{:g} to {:g}".format(*quantity.usual)


def _default(quantity: Quantity) -> str:
    default = quantity.default
    if default is None:
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default}`" if isinstance(default, str) else f"{default:g}"


def _size(quantity: Quantity) -> str:
    search = quantity.search
    if search is None:
        return ""
    return f"factor e^{search.size:g}" if search.logarithmic else f"{search.size:g} {quantity.unit}".rstrip()


def _bounds(quantity: Quantity) -> str:
    search = quantity.search
    if search is None:
        return ""
    if search.about and search.lower == -search.upper:
        return f"the start ± {search.upper:g}"
    return f"{'the start and ' * search.about}{search.lower:g} to {search.upper:g}"


_CELLS: Final[dict[str, Callable[[Quantity], str]]] = {
    "key": lambda quantity: f"`{quantity.name}`",
    "column": lambda quantity: f"`{quantity.name}`",
    "unit": lambda quantity: quantity.unit,
    "range": _allowed,
    "usual": _usual,
    "default": _default,
    "usual size": _size,
    "bounds": _bounds,
    "where default or range comes from": lambda quantity: quantity.origin,
    "left out": lambda quantity: quantity.origin,
    "instead of": lambda quantity: quantity.origin,
    "meaning": lambda quantity: quantity.meaning,
}
USUAL_COLUMNS: Final = ("key", "unit", "range", "default", "where default or range comes from", "meaning")


def page_table(quantities: Iterable[Quantity], columns: Iterable[str] = USUAL_COLUMNS) -> str:
    """A table in Markdown with a row for each quantity."""
    named = tuple(columns)
    rows = [named, ("---",) * len(named), *(tuple(_CELLS[name](each) for name in named) for each in quantities)]
    return "".join("|" + "|".join(f" {cell} " if cell else " " for cell in row) + "|\n" for row in rows)
