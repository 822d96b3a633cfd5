"""The table of a page of the documentation that says every key."""

from __future__ import annotations

from collections.abc import Iterable

from .quantity import Quantity

_HEAD = """| key | unit | range | default | where default or range comes from | meaning |
| --- | --- | --- | --- | --- | --- |
"""


def page_table(quantities: Iterable[Quantity]) -> str:
    """A table in Markdown with a row for each quantity."""
    return _HEAD + "".join(_row(each) for each in quantities)


def _row(quantity: Quantity) -> str:
    is_any = quantity.kind == "text" and not quantity.choices
    allowed = "a text" if is_any else quantity.allowed + (", `inf`" if quantity.infinite else "")
    cells = (f"`{quantity.name}`", quantity.unit, allowed, _default(quantity), quantity.origin, quantity.meaning)
    return "|" + "|".join(f" {cell} " if cell else " " for cell in cells) + "|\n"


def _default(quantity: Quantity) -> str:
    default = quantity.default
    if default is None:
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{default}`" if isinstance(default, str) else f"{default:g}"
