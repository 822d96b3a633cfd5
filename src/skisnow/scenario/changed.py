"""A scenario with other parts and other values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from ..errors import ParameterError
from ..inputs import Word, changed, values_of
from ..ski import read_ski
from ..snow import SnowProperties, published_snow
from ..snow.mean_snow import without_measured
from .contact import Contact
from .given import full_name
from .keys import SCENARIO_KEYS
from .scenario import Scenario
from .snow_map import SnowMap


def changed_scenario(scenario: Scenario, changes: Mapping[str, object]) -> Scenario:
    """See `Scenario.with_`."""
    own = {field.name for field in fields(scenario)} | {"snow", "snow_map"}
    parts: dict[str, Any] = {name: value for name, value in changes.items() if name in own}
    values = {full_name(name): value for name, value in changes.items() if name not in own}
    for name in values:
        _require_number(name)
    if "ski" in parts and isinstance(parts["ski"], str | Path):
        parts["ski"] = read_ski(parts["ski"])
    if "snow" in parts:
        parts["contact"] = _on_snow(parts.get("contact", scenario.contact), parts.pop("snow"))
    if "snow_map" in parts:
        parts["contact"] = _on_map(parts.get("contact", scenario.contact), parts.pop("snow_map"))
    made = replace(scenario, **parts)
    _require_part_of(made, values)
    return changed(_with_numbers(made, values), values)


def _with_numbers(scenario: Scenario, values: Mapping[str, object]) -> Scenario:
    """Where H_V or S_f become numbers, their source says so, and their interval is gone.

    What was measured of k_u/H_V and u_y goes as well where they do.
    """
    _require_not_mapped(scenario.contact.snow_map, values)
    snow = without_measured(
        scenario.contact.snow,
        unloading="snow.unloading_ratio" in values,
        displacement="snow.shear_displacement_mm" in values,
    )
    if "snow.H_V_N_per_mm3" in values:
        snow = replace(snow, source=f"{snow.source}; H_V given as a number", snow_hardness_interval=None)
    if "snow.S_f_N_per_mm2" in values:
        snow = replace(snow, source=f"{snow.source}; S_f given as a number", failure_shear_stress_interval=None)
    if snow is scenario.contact.snow:
        return scenario
    return replace(scenario, contact=replace(scenario.contact, snow=snow))


def _on_snow(contact: Contact, snow: SnowProperties | str) -> Contact:
    found = published_snow(snow) if isinstance(snow, str) else snow
    if not isinstance(found, SnowProperties):
        raise ParameterError(
            f"snow is a {type(found).__name__}; it must be SnowProperties, as Analysis.snow and snow_from_results give "
            "it, or the name of a published snow"
        )
    ratio = contact.unloading_ratio if found.unloading_ratio is None else found.unloading_ratio
    way = contact.shear_displacement if found.shear_displacement is None else found.shear_displacement
    return replace(contact, snow=found, snow_map=None, unloading_ratio=ratio, shear_displacement=way)


def _on_map(contact: Contact, snow_map: SnowMap | None) -> Contact:
    """On snow that varies over the place; None: that does not."""
    snow = contact.snow if snow_map is None else snow_map.means_of(contact.snow)
    return replace(contact, snow=snow, snow_map=snow_map)


def _require_not_mapped(snow_map: SnowMap | None, values: Mapping[str, object]) -> None:
    if snow_map is None:
        return
    for name, over_place in (
        ("snow.H_V_N_per_mm3", snow_map.hardness),
        ("snow.S_f_N_per_mm2", snow_map.failure_shear_stress),
    ):
        if name in values and over_place is not None:
            raise ParameterError(
                f"{name} is given over the place by snow.map_file, {snow_map.source}. snow_map=None takes the map away"
            )


def _require_part_of(scenario: Scenario, values: Mapping[str, object]) -> None:
    """A profile has no angle."""
    for name in values.keys() - values_of(scenario).keys():
        part = name.partition(".")[0]
        raise ParameterError(
            f"{name} plays no part in this scenario, whose {part} is of another kind. Leave it out, or give the part "
            f"itself: {part}="
        )


def _require_number(name: str) -> None:
    """What a file says in a word is a part in Python."""
    if isinstance(SCENARIO_KEYS[name], Word):
        raise ParameterError(
            f"{name} is a word of a scenario's file; in Python give the part itself, such as snow=, ski= or slope=, or "
            "read the scenario with it: skisnow.scenario(…, changes={…})"
        )
