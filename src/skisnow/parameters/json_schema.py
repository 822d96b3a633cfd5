"""Declared quantities as JSON Schemas."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from typing import Any, Final

from .quantity import Quantity

Schema = dict[str, Any]

DRAFT: Final = "https://json-schema.org/draft/2020-12/schema"
_TYPES: Final = {"number": "number", "whole number": "integer", "text": "string", "switch": "boolean"}


def schema_of(quantity: Quantity) -> Schema:
    """JSON Schema of the value of a quantity.

    >>> schema_of(Quantity("load_N", "load", lowest=0.0, above=True))
    {'type': 'number', 'description': 'load (N)', 'exclusiveMinimum': 0.0}
    """
    words = quantity.described
    default = {} if quantity.default is None else {"default": quantity.default}
    least = "exclusiveMinimum" if quantity.above else "minimum"
    most = "exclusiveMaximum" if quantity.below else "maximum"
    ends = {least: quantity.lowest, most: quantity.highest}
    limits: Schema = {name: end for name, end in ends.items() if math.isfinite(end)}
    if quantity.kind in ("numbers", "three numbers"):
        count = {"minItems": 1} if quantity.default is None else {}
        if quantity.kind == "three numbers":
            count = {"minItems": 3, "maxItems": 3}
        return {"type": "array", "description": words, **count, "items": {"type": "number", **limits}}
    if quantity.choices:
        limits = {"enum": list(quantity.choices)}
    elif quantity.kind == "text":
        limits = {} if quantity.blank else {"pattern": "\\S"}
    return {"type": _TYPES[quantity.kind], "description": words, **limits, **default}


def table_schema(quantities: Iterable[Quantity]) -> Schema:
    """JSON Schema of a table of an input file: allowed keys with their values, and required keys."""
    by_key = {quantity.name.rpartition(".")[2]: quantity for quantity in quantities}
    needed = [key for key, quantity in by_key.items() if quantity.needed]
    return {
        "type": "object",
        "additionalProperties": False,
        **({"required": needed} if needed else {}),
        "properties": {key: schema_of(quantity) for key, quantity in by_key.items()},
    }


def output_schema(quantities: Iterable[Quantity], *, every_null: bool = False) -> Schema:
    """JSON Schema of a table of an output file, with each key and its used value, or null for a key without one.

    every_null: True if null is also allowed for keys that are required or have a default.
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
    """Text of a schema as JSON with indentation."""
    return json.dumps(schema, ensure_ascii=False, indent=1) + "\n"
