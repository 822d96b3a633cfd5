"""JSON Schema of a scenario file, from the declarations of its dataclasses and the rules between keys."""

from __future__ import annotations

from typing import Any, Final

from ..parameters import Quantity, quantities
from ..parameters.json_schema import DRAFT, Schema, output_schema, table_schema
from .identify_section import CLOCKS, SearchEntry, Site
from .keys import SCENARIO_KEYS, SECTIONS


def _one_of(*names: str) -> list[Schema]:
    """Schemas for "oneOf" or "anyOf": each requires one of the names."""
    return [{"required": [name]} for name in names]


_PLANE: Final[Schema] = {
    "required": ["angle_deg"],
    "properties": {"kind": {"const": "plane"}, "profile": False, "profile_gap": False},
}
_PROFILE: Final[Schema] = {
    "required": ["kind", "profile"],
    "properties": {"kind": {"const": "profile"}, "angle_deg": False},
}
_ELASTIC: Final[Schema] = {"properties": {"penetration": {"const": "elastic"}}, "required": ["penetration"]}
_TOGETHER: Final[dict[str, Schema]] = {
    "slope": {"oneOf": [_PLANE, _PROFILE]},
    "snow": {
        "oneOf": [{"required": ["H_V_N_per_mm3", "S_f_N_per_mm2"]}, *_one_of("results", "published")],
        "dependentRequired": {"site": ["results"]},
        "anyOf": [*_one_of("unloading_ratio", "results"), _ELASTIC],
    },
    "ski": {"oneOf": _one_of("name", "file")},
    "run": {"anyOf": _one_of("duration_s", "length_m")},
}
"""Rules between the keys of a section."""


def scenario_schema() -> Schema:
    """The schema of a parsed scenario file."""
    sections = {name: {**table_schema(_section_keys(name)), **_TOGETHER.get(name, {})} for name in SECTIONS}
    return {
        "$schema": DRAFT,
        "$id": "urn:skisnow:schema:scenario:1",
        "title": "A scenario for skisnow simulate",
        "description": "Keys end with their units. Slope, snow, ski and the end of the run are given in one way each.",
        "type": "object",
        "additionalProperties": False,
        "required": [name for name, part in sections.items() if "required" in part or name in _TOGETHER],
        "properties": {**sections, "identify": _identify_schema()},
    }


def output_scenario_schema() -> Schema:
    """Schema of the scenario in summary.json: every key with the value in force."""
    sections = {name: output_schema(_section_keys(name), every_null=True) for name in SECTIONS}
    return {"type": "object", "additionalProperties": False, "required": list(sections), "properties": sections}


def _section_keys(section: str) -> list[Quantity]:
    """Keys of a section, such as "snow"."""
    return [key for full, key in SCENARIO_KEYS.items() if full.startswith(f"{section}.")]


def _identify_schema() -> Schema:
    """JSON schema of the section [identify]: clock, runs, site, and a table for each parameter."""
    clock: dict[str, Any] = {
        "type": "string",
        "description": "whether photo cells count from the start, or each run's clock has a separate offset",
        "enum": list(CLOCKS),
        "default": CLOCKS[0],
    }
    runs = {
        "type": "object",
        "description": "values that are known of one run and differ from the scenario's, by the name of the run",
        "additionalProperties": {
            "type": "object",
            "description": "keys of slope, snow, friction, drag, sledge, ski or start",
            "additionalProperties": {"type": "number"},
        },
    }
    place = "how the slope lies, for tracks in latitude and longitude"
    parameter = "one parameter, by its full key in quotes; numbers in the key's unit"
    return {
        "type": "object",
        "description": "parameters for skisnow identify; a simulated run ignores them",
        "properties": {
            "clock": clock,
            "runs": runs,
            "site": {
                **table_schema(quantities(Site)),
                "description": place,
                "dependentRequired": {"latitude_deg": ["longitude_deg"], "longitude_deg": ["latitude_deg"]},
            },
        },
        "additionalProperties": {
            **table_schema(quantities(SearchEntry)),
            "description": parameter,
            "dependentRequired": {"prior_mean": ["prior_sd"], "prior_sd": ["prior_mean"]},
        },
    }
