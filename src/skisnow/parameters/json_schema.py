"""Declared quantities as JSON Schemas and as tables of the documentation."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from typing import Any, Final

from .quantity import Quantity

Schema = dict[str, Any]

DRAFT: Final = "https://json-schema.org/draft/2020-12/schema"
_TYPES: Final = {"number": "number", "whole number": "integer", "text": "string", "switch": "boolean"}


def schema_of(quantity: Quantity) -> Schema:
    """The schema of one value.

    >>> schema_of(Quantity("load_N", "load", lowest=0.0, above=True))
    {'type': 'number', 'description': 'load (N)', 'exclusiveMinimum': 0.0}
    """
    words = quantity.described
    default = {} if quantity.default is None else {"default": quantity.default}
    if quantity.kind == "three numbers":
        items = {"type": "number", **_range_schema(quantity)}
        return {"type": "array", "description": words, "minItems": 3, "maxItems": 3, "items": items}
    if quantity.kind == "numbers":
        least = {"minItems": 1} if quantity.default is None else {}
        return {"type": "array", "description": words, **least, "items": {"type": "number", **_range_schema(quantity)}}
    limits = _range_schema(quantity) if quantity.kind != "text" else _words_schema(quantity)
    return {"type": _TYPES[quantity.kind], "description": words, **limits, **default}


def table_schema(quantities: Iterable[Quantity]) -> Schema:
    """The schema of a table of a file: its keys, no others, and which of them are needed."""
    listed = list(quantities)
    own = [quantity.name.rpartition(".")[2] for quantity in listed]
    needed = [name for name, quantity in zip(own, listed, strict=True) if quantity.needed]
    return {
        "type": "object",
        "additionalProperties": False,
        **({"required": needed} if needed else {}),
        "properties": {name: schema_of(quantity) for name, quantity in zip(own, listed, strict=True)},
    }


def output_schema(quantities: Iterable[Quantity], *, every_null: bool = False) -> Schema:
    """Schema of a table with the used value under every key; null if missing.

    With `every_null` also a key that has a default, or must be given, may have none in force.
    """
    properties = {}
    for quantity in quantities:
        schema = schema_of(quantity)
        if every_null or not (quantity.needed or quantity.default is not None):
            words = {"enum": [*schema["enum"], None]} if "enum" in schema else {}
            schema = {**schema, "type": [schema["type"], "null"], **words}
        properties[quantity.name.rpartition(".")[2]] = schema
    return {"type": "object", "additionalProperties": False, "required": list(properties), "properties": properties}


def schema_text(schema: Schema) -> str:
    """A schema as it is in its file."""
    return json.dumps(schema, ensure_ascii=False, indent=1) + "\n"


def _range_schema(quantity: Quantity) -> Schema:
    least = "exclusiveMinimum" if quantity.above else "minimum"
    most = "exclusiveMaximum" if quantity.below else "maximum"
    ends = {least: quantity.lowest, most: quantity.highest}
    return {name: end for name, end in ends.items() if math.isfinite(end)}


def _words_schema(quantity: Quantity) -> Schema:
    if quantity.choices:
        return {"enum": list(quantity.choices)}
    return {} if quantity.blank else {"pattern": "\\S"}


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
