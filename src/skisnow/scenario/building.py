"""A scenario in SI from the values that count, and with other parts or values."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from .._support.errors import ParameterError, most_similar
from .._support.messages import Message
from .._support.units import N_PER_MM2, N_PER_MM3
from ..forces.friction import read_friction_file
from ..parameters import Word, build_declared, replace_declared, suggest_and_list, values_of
from ..ski import Ski, read_ski, ski_names
from ..ski.ski_file import Sources
from ..snow import SnowProperties, published_snow
from ..snow.properties import require_stress
from ..track.course import Course, course_names, read_course
from .boots import read_boots
from .contact import ELASTIC, Contact
from .keys import SCENARIO_KEYS, full_name
from .resolution import CONDITIONS, DISPLACEMENT, H_V, S_F, UNLOADING, ContradictionError, Resolution
from .scenario import Scenario, course_on_slope
from .slope import Plane, read_profile
from .snow_map import read_snow_layers
from .terrain import Slope, read_terrain

LAW_FILE = "friction.law_file"
SNOW_CHOICES = "Give snow.H_V_N_per_mm3 and snow.S_f_N_per_mm2, or snow.results, or snow.published"


def build(resolution: Resolution, sources: Sources) -> tuple[Scenario, tuple[str, ...]]:
    """Scenario built from resolved values, and the warnings of the readers of its ski and course."""
    values = dict(resolution.values)
    for name, key in SCENARIO_KEYS.items():
        if key.needed and not (name == "friction.mu_0" and LAW_FILE in values):
            _require_key(values, name, Message("It has no default"))
    ski, ski_warnings = _build_ski(resolution, sources)
    slope = _build_slope(resolution)
    contact = _contact(resolution)
    if "run.duration_s" not in values and "run.length_m" not in values:
        raise ParameterError("the run has no end: give run.duration_s or run.length_m").tag("no_data")
    values.setdefault("drag.centre_of_pressure_height_m", values["sledge.centre_of_mass_height_m"])
    course = _build_course(resolution, slope)
    boots = None
    if "boots.file" in resolution.files:
        edge_angle = math.radians(float(str(values["sledge.edge_angle_deg"])))
        stance_width = float(str(values["sledge.stance_width_m"]))
        boots = read_boots(resolution.files["boots.file"], edge_angle=edge_angle, stance_width=stance_width)
    parts: dict[str, Any] = {} if any(name.startswith("skier.") for name in values) else {"skier": None}
    parts |= {"slope": slope, "contact": contact, "ski": ski, "course": course, "boots": boots}
    return build_declared(Scenario, values, **parts), ski_warnings


def _require_key(values: Mapping[str, Any], name: str, remedy: Message) -> None:
    """Reject values without a key; the error includes its meaning and the remedy."""
    if name not in values:
        raise ParameterError("{name} is missing: {meaning}. {remedy}").tag(
            "missing", name=name, meaning=SCENARIO_KEYS[name].meaning, remedy=remedy
        )


def _value_of(values: Mapping[str, Any], name: str) -> Any:
    """Value of a key, or its default."""
    return values.get(name, SCENARIO_KEYS[name].default)


def _build_slope(resolution: Resolution) -> Slope:
    """Slope of the kind in slope.kind: a plane, a grid of heights, or a profile."""
    values = resolution.values
    kind = _value_of(values, "slope.kind")
    if kind == "plane":
        profile = Message('Give it, or a measured profile: slope.kind = "profile" and slope.profile')
        _require_key(values, "slope.angle_deg", profile)
        return build_declared(Plane, values)
    plane = Message('Give it, or a plane: slope.kind = "plane" and slope.angle_deg')
    if kind == "grid":
        _require_key(values, "slope.grid", plane)
        smoothing, x, y = (float(_value_of(values, f"slope.{key}")) for key in ("smooth_m", "origin_x_m", "origin_y_m"))
        return read_terrain(resolution.files["slope.grid"], smoothing=smoothing, origin_x=x, origin_y=y)
    _require_key(values, "slope.profile", plane)
    return read_profile(resolution.files["slope.profile"], gap=_value_of(values, "slope.profile_gap"))


def _build_course(resolution: Resolution, slope: Slope) -> Course | None:
    """Course of course.name or course.file, placed on the slope; None without both."""
    options: dict[str, Any] = {
        name.partition(".")[2]: value for name, value in resolution.values.items() if name.startswith("course.")
    }
    name, file = options.pop("name", None), options.pop("file", None)
    if name is None and file is None:
        if options:
            raise ParameterError("course.{key} is stated without a course; add course.file, or remove it").tag(
                "contradiction", key=next(iter(options))
            )
        return None
    if name is not None and name not in course_names():
        raise ParameterError(
            "course.name is {name!r}, no course of the catalogue. {allowed} A path is course.file"
        ).tag("unknown_name", name=name, allowed=suggest_and_list(str(name), course_names()))
    course = read_course(name or resolution.files["course.file"], **options)
    return course_on_slope(course, slope)


def _build_ski(resolution: Resolution, sources: Sources) -> tuple[Ski, tuple[str, ...]]:
    """Ski from ski.file, or the catalogue's ski of ski.name, with the warnings of reading it."""
    if "ski.file" in resolution.files:
        return sources.ski(str(resolution.files["ski.file"].absolute()))
    name = resolution.values.get("ski.name")
    if name is None:
        raise ParameterError("a ski has either ski.name, of the catalogue, or ski.file; neither is there").tag(
            "missing"
        )
    if name not in ski_names():
        raise ParameterError(
            "ski.name is {name!r}, not a ski of the catalogue. {allowed} Put a path under ski.file"
        ).tag("unknown_name", name=name, allowed=suggest_and_list(str(name), ski_names()))
    return sources.ski(str(name))


def _contact(resolution: Resolution) -> Contact:
    """Contact of a scenario, from its resolved values of snow, unloading, friction and layers."""
    values = resolution.values
    ratio = ELASTIC if values.get("snow.penetration") == "elastic" else values.get(UNLOADING)
    snow = _snow(resolution).without_measured(unloading=ratio is not None, displacement=DISPLACEMENT in values)
    if ratio is None and snow.unloading_ratio is None:
        fields = {"name": UNLOADING, "meaning": SCENARIO_KEYS[UNLOADING].meaning}
        if resolution.snow:
            raise ParameterError("{name} is missing: {meaning}; {source} has no measured value. Give it").tag(
                "missing", **fields, source=snow.source
            )
        raise ParameterError("{name} is missing: {meaning}. Give it").tag("missing", **fields)
    measured: dict[str, Any] = {"unloading_ratio": snow.unloading_ratio if ratio is None else ratio}
    if snow.shear_displacement is not None:
        measured["shear_displacement"] = snow.shear_displacement
    if LAW_FILE in values:
        law = read_friction_file(resolution.files[LAW_FILE])
        measured |= {"friction_law": law, "friction": values.get("friction.mu_0", 0.0)}
    if "snow.layers_file" in values:
        measured["layers"] = read_snow_layers(resolution.files["snow.layers_file"])
    return build_declared(Contact, values, snow=snow, snow_map=resolution.snow_map, **measured)


def _snow(resolution: Resolution) -> SnowProperties:
    """Snow combined from named snow, numbers and map, each for the quantities that it gives."""
    values, snow, snow_map = dict(resolution.values), resolution.snow, resolution.snow_map
    if "snow.site" in values and "snow.results" not in values:
        raise ParameterError("snow.site names one site of a campaign and needs snow.results. Remove it").tag(
            "contradiction"
        )
    if snow is None:
        if snow_map is not None:
            values.setdefault(H_V, (snow_map.mean_hardness or math.nan) / N_PER_MM3)
            values.setdefault(S_F, (snow_map.mean_stress or math.nan) / N_PER_MM2)
        if H_V not in values:
            raise ParameterError("no snow is given: H_V has no default. {choices}").tag("missing", choices=SNOW_CHOICES)
        if S_F not in values:
            raise ParameterError("{name} is missing: the failure shear stress S_f. It has no default").tag(
                "missing", name=S_F
            )
        snow = build_declared(SnowProperties, values, section="snow", source=Message("given as numbers"))
    else:
        snow = with_numbers(snow, values)
        require_stress(snow, None, carves=snow_map is None or snow_map.mean_stress is None)
    return snow if snow_map is None else snow_map.means_of(snow)


def with_numbers(snow: SnowProperties, values: Mapping[str, Any]) -> SnowProperties:
    """The snow with numbers for H_V or S_f, which then have no interval."""
    if H_V in values:
        hardness = float(values[H_V]) * N_PER_MM3
        source = f"{snow.source}; H_V given as a number"
        snow = replace(snow, snow_hardness=hardness, snow_hardness_interval=None, source=source)
    if S_F in values:
        stress = float(values[S_F]) * N_PER_MM2
        source = f"{snow.source}; S_f given as a number"
        snow = replace(snow, failure_shear_stress=stress, failure_shear_stress_interval=None, source=source)
    return snow


def changed_scenario(scenario: Scenario, changes: Mapping[str, object]) -> Scenario:
    """Copy of a scenario with other parts, by name, and values, by key; rejects unknown names and words of a file."""
    part_names = {field.name for field in fields(scenario)} | {"snow", "snow_map"}
    parts: dict[str, Any] = {name: value for name, value in changes.items() if name in part_names}
    numbers = {_full_name(name, part_names): value for name, value in changes.items() if name not in part_names}
    for name in numbers:
        if isinstance(SCENARIO_KEYS[name], Word):
            raise ParameterError(
                "{name} is a word of a scenario's file; in Python give the part itself, such as snow=, ski= or "
                "slope=, or read the scenario with it: skisnow.load_scenario(…, changes={{…}})"
            ).tag("wrong_kind", name=name)
    if isinstance(parts.get("ski"), str | Path):
        parts["ski"] = read_ski(parts["ski"])
    if "snow" in parts:
        parts["contact"] = _contact_on_snow(parts.get("contact", scenario.contact), parts.pop("snow"))
    if "snow_map" in parts:
        contact, snow_map = parts.get("contact", scenario.contact), parts.pop("snow_map")
        mapped = contact.snow if snow_map is None else snow_map.means_of(contact.snow)
        parts["contact"] = replace(contact, snow=mapped, snow_map=snow_map)
    scenario = replace(scenario, **parts)
    _require_changeable(scenario, numbers)
    measured = {"unloading": UNLOADING in numbers, "displacement": DISPLACEMENT in numbers}
    strengths: dict[str, Any] = {
        name: SCENARIO_KEYS[name].in_range(numbers[name]) for name in (H_V, S_F) if name in numbers
    }
    snow = with_numbers(scenario.contact.snow.without_measured(**measured), strengths)
    if snow is not scenario.contact.snow:
        scenario = replace(scenario, contact=replace(scenario.contact, snow=snow))
    return replace_declared(scenario, numbers)


def _full_name(name: str, part_names: Collection[str]) -> str:
    """Full name of a scenario key; the error for an unknown one suggests a part of similar name."""
    try:
        return full_name(name)
    except ParameterError as error:
        part = most_similar(name, part_names)
        if part is None:
            raise
        raise ParameterError("{problem} Did you mean the part {part}?").tag(
            "unknown_name", problem=error, part=part
        ) from error


def _contact_on_snow(contact: Contact, snow: SnowProperties | str) -> Contact:
    """The contact with another snow, whose k_u/H_V and u_y replace its own if the snow has them; without a map."""
    new = published_snow(snow) if isinstance(snow, str) else snow
    if not isinstance(new, SnowProperties):
        raise ParameterError(
            "snow is a {kind}; it must be SnowProperties, as Analysis.snow and snow_from_results give it, or the "
            "name of a published snow"
        ).tag("wrong_kind", kind=type(new).__name__)
    ratio = contact.unloading_ratio if new.unloading_ratio is None else new.unloading_ratio
    displacement = contact.shear_displacement if new.shear_displacement is None else new.shear_displacement
    return replace(contact, snow=new, snow_map=None, unloading_ratio=ratio, shear_displacement=displacement)


def _require_changeable(scenario: Scenario, numbers: Mapping[str, object]) -> None:
    """Reject numbers that a snow map gives, those of a part of another kind (angle of a profile), or without effect."""
    snow_map = scenario.contact.snow_map
    mapped = {} if snow_map is None else {H_V: snow_map.hardness, S_F: snow_map.failure_shear_stress}
    for name in numbers:
        if snow_map is not None and mapped.get(name) is not None:
            raise ParameterError(
                "{name} is given by a map, snow.map_file, {source}. Remove the map with snow_map=None"
            ).tag("contradiction", name=name, source=snow_map.source)
    values = values_of(scenario)
    for name in numbers.keys() - values.keys():
        part = name.partition(".")[0]
        raise ParameterError(
            "{name} has no effect in this scenario, whose {part} is of another kind. Remove it, or replace the part "
            "itself: {part}="
        ).tag("wrong_kind", name=name, part=part)
    values |= numbers
    for name in numbers:
        condition = CONDITIONS.get(name)
        if condition is not None and not condition.holds(values.get(condition.key)):
            raise ContradictionError(
                (name, condition.key),
                Message("{name} goes with {condition}. Change one of them", name=name, condition=condition.in_words),
            )
