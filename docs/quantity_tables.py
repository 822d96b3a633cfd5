"""Markdown tables of declared quantities, a row for each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from skisnow.parameters import Quantity


def _allowed_cell(quantity: Quantity) -> str:
    if quantity.kind == "text" and not quantity.choices:
        return "a text"
    return quantity.allowed + (", `inf`" if quantity.infinite else "")


def _usual_range_cell(quantity: Quantity) -> str:
    return "" if quantity.usual is None else "{:g} to {:g}".format(*quantity.usual)


def _default_cell(quantity: Quantity) -> str:
    default = quantity.default
    if default is None:
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default}`" if isinstance(default, str) else f"{default:g}"


def _search_size_cell(quantity: Quantity) -> str:
    search = quantity.search
    if search is None:
        return ""
    return f"factor e^{search.size:g}" if search.logarithmic else f"{search.size:g} {quantity.unit}".rstrip()


def _search_bounds_cell(quantity: Quantity) -> str:
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
    "range": _allowed_cell,
    "usual": _usual_range_cell,
    "default": _default_cell,
    "usual size": _search_size_cell,
    "bounds": _search_bounds_cell,
    "where default or range comes from": lambda quantity: quantity.origin,
    "excluded": lambda quantity: quantity.origin,
    "instead of": lambda quantity: quantity.origin,
    "meaning": lambda quantity: quantity.meaning,
}
USUAL_COLUMNS: Final = ("key", "unit", "range", "default", "where default or range comes from", "meaning")


def page_table(quantities: Iterable[Quantity], columns: Iterable[str] = USUAL_COLUMNS) -> str:
    """A table in Markdown with a row for each quantity."""
    named = tuple(columns)
    rows = [named, ("---",) * len(named), *(tuple(_CELLS[name](quantity) for name in named) for quantity in quantities)]
    return "".join("|" + "|".join(f" {cell} " if cell else " " for cell in row) + "|\n" for row in rows)
