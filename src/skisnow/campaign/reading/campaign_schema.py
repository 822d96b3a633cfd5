"""JSON Schema of campaign.toml, from the declarations of `CampaignFile`, plates and tools."""

from __future__ import annotations

from typing import Final

from ...parameters import own_quantities
from ...parameters.json_schema import DRAFT, Schema, table_schema
from ..problems import QUALITY_FLAGS
from ..smet import WeatherSettings
from ..snow_micro_pen_records import SnowMicroPenSettings
from .campaign_file import CAMPAIGN_KEYS, PLATE_LENGTH, SHAPES, Shape

_NAME: Final[Schema] = {"type": "string", "pattern": "\\S", "description": "Unique in its list."}


def campaign_schema() -> Schema:
    """JSON Schema of a parsed campaign.toml."""
    words = "Codes of the quality flags that exclude an experiment; replaces the default."
    exclude = {"description": words, **_one_or_several({"$ref": "#/$defs/mark"})}
    return {
        "$schema": DRAFT,
        "$id": "urn:skisnow:schema:campaign:1",
        "title": "campaign.toml of a skisnow campaign, parsed",
        "description": "Units are part of the keys. Keys that are not listed here are ignored with a warning; keys "
        "that are nearly one of these are refused as misspelt.",
        "type": "object",
        "properties": {
            **table_schema(CAMPAIGN_KEYS.values())["properties"],
            "observers": {"description": "who", **_one_or_several({"type": "string"})},
            "tool": {"type": "array", "items": {"$ref": "#/$defs/tool"}},
            "plate": {"type": "array", "items": {"$ref": "#/$defs/plate"}},
            "columns": _by_heading("Column of the numbers or texts below a heading"),
            "units": _by_heading("Unit of the numbers below a heading that names none"),
            "import": {"type": "object", "description": "File, answers and notes of skisnow import."},
            "snow_micro_pen": {
                "description": "How the recordings that snow_micro_pen.csv names are evaluated.",
                **table_schema(own_quantities(SnowMicroPenSettings)),
            },
            "weather": {
                "description": "Readings of a weather station, in SMET.",
                **table_schema(own_quantities(WeatherSettings)),
            },
            "screening": {"type": "object", "properties": {"exclude": exclude}},
        },
        "$defs": {"mark": {"enum": list(QUALITY_FLAGS)}, "tool": _tool(), "plate": _plate()},
    }


def _one_or_several(item: Schema) -> Schema:
    return {"anyOf": [item, {"type": "array", "items": item}]}


def _by_heading(words: str) -> Schema:
    """Schema of a mapping from headings to texts, for all tables or nested for one table; ``words`` describe it."""
    pairs = {"type": "object", "additionalProperties": {"type": "string"}}
    either: Schema = {"anyOf": [{"type": "string"}, pairs]}
    words = f"{words}; in a table of a table's name, such as penetration, for that one."
    return {"description": words, "type": "object", "additionalProperties": either}


def _tool() -> Schema:
    return {
        "type": "object",
        "properties": {"name": _NAME, "shape": {"enum": list(SHAPES)}},
        "required": ["name", "shape"],
        "oneOf": [_shape(name, shape) for name, shape in SHAPES.items()],
    }


def _shape(name: str, shape: Shape) -> Schema:
    lengths = table_schema(shape.lengths)
    return {
        "properties": {"shape": {"const": name}, **lengths["properties"]},
        "required": lengths["required"],
    }


def _plate() -> Schema:
    length = table_schema([PLATE_LENGTH])
    return {
        "type": "object",
        "properties": {"name": _NAME, **length["properties"]},
        "required": ["name", *length["required"]],
    }
