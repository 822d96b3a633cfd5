"""From values as given to a scenario in SI."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..course import Course, course_names, on_slope, read_course
from ..errors import ParameterError
from ..inputs import made, meant
from ..ski import Ski, ski_names
from ..snow import SnowProperties
from ..snow.given_stress import require_stress, with_stress
from ..snow.mean_snow import without_measured
from ..sources import Sources
from ..units import N_PER_MM2, N_PER_MM3
from .boots import Boots
from .boots_file import read_boots
from .contact import ELASTIC, Contact
from .given import GivenScenario
from .keys import SCENARIO_KEYS
from .profile_file import read_profile
from .replaced import KEYS_OF_KIND
from .scenario import Scenario
from .slope import Plane
from .slope_surface import Slope
from .snow_map import SnowMap
from .snow_map_file import read_snow_map
from .terrain_file import read_terrain


def built(given: GivenScenario, sources: Sources) -> tuple[Scenario, tuple[str, ...]]:
    """The scenario, and what the reader of the ski warned of.

    Raises
    ------
    ParameterError
        A key is missing, two say the same or do not go together, or a file that one names cannot be read.
    """
    values = dict(given.values)
    for name, key in SCENARIO_KEYS.items():
        if key.needed and name not in values:
            raise ParameterError(_missing(name))
    ski, warned = _ski(given, sources)
    slope, snow_map = _slope(given, values), _snow_map(given)
    snow = _snow(given, snow_map, sources)
    for name in outdone(given, snow, snow_map):
        del values[name]
    contact = _contact(values, snow, snow_map)
    if "run.duration_s" not in values and "run.length_m" not in values:
        raise ParameterError("the run has no end: give run.duration_s or run.length_m")
    values.setdefault("drag.centre_of_pressure_height_m", values["sledge.centre_of_mass_height_m"])
    course = _course(given, slope)
    told = () if course is None else course.warnings
    boots = _boots(given, values)
    scenario = made(
        Scenario, values, slope=slope, contact=contact, ski=ski, course=course, boots=boots, **_no_skier(values)
    )
    return scenario, (*warned, *told)


def _boots(given: GivenScenario, values: Mapping[str, Any]) -> Boots | None:
    if "boots.file" not in values:
        return None
    edge_angle = math.radians(values["sledge.edge_angle_deg"])
    return read_boots(given.path("boots.file"), edge_angle=edge_angle, stance_width=values["sledge.stance_width_m"])


def _no_skier(values: Mapping[str, Any]) -> dict[str, Any]:
    """A scenario has a skier where it says something of one."""
    return {} if any(name.startswith("skier.") for name in values) else {"skier": None}


def outdone(given: GivenScenario, snow: SnowProperties, snow_map: SnowMap | None) -> frozenset[str]:
    """Names of given values that the snow, or its map, which was given after them, has itself."""
    mapped = frozenset(_nominal(snow_map)) & given.before_map
    if "snow.results" not in given.values:
        return mapped
    known = {"snow.unloading_ratio": snow.unloading_ratio, "snow.shear_displacement_mm": snow.shear_displacement}
    return mapped | frozenset(name for name in given.before_results if known[name] is not None)


def _missing(name: str) -> str:
    return f"{name} is missing: {SCENARIO_KEYS[name].meaning}. It has no default"


def _slope(given: GivenScenario, values: Mapping[str, Any]) -> Slope:
    kind = values.get("slope.kind", _default("slope.kind"))
    for of, names in KEYS_OF_KIND.items():
        for name in names:
            if name in given.values and kind != of:
                raise ParameterError(f'{name} goes with slope.kind = "{of}"; it is "{kind}". Change one of them')
    if kind == "plane":
        _require(values, "slope.angle_deg", 'or a measured profile: slope.kind = "profile" and slope.profile')
        return made(Plane, values)
    if kind == "grid":
        _require(values, "slope.grid", 'or a plane: slope.kind = "plane" and slope.angle_deg')
        smoothing, *origin = (float(values.get(name, _default(name))) for name in KEYS_OF_KIND["grid"][1:])
        return read_terrain(given.path("slope.grid"), smoothing=smoothing, origin_x=origin[0], origin_y=origin[1])
    _require(values, "slope.profile", 'or a plane: slope.kind = "plane" and slope.angle_deg')
    return read_profile(given.path("slope.profile"), gap=values.get("slope.profile_gap", _default("slope.profile_gap")))


def _course(given: GivenScenario, slope: Slope) -> Course | None:
    said: dict[str, Any] = {
        name.partition(".")[2]: value for name, value in given.values.items() if name.startswith("course.")
    }
    name, file = said.pop("name", None), said.pop("file", None)
    if name is not None and file is not None:
        raise ParameterError("a course has either course.name, of the catalogue, or course.file; both are there")
    if name is None and file is None:
        if said:
            raise ParameterError(
                f"course.{next(iter(said))} is there without a course; give course.file, or leave it out"
            )
        return None
    if name is not None and name not in course_names():
        known = f"{meant(str(name), course_names())}There are {', '.join(course_names())}"
        raise ParameterError(f"course.name is {name!r}, no course of the catalogue. {known}. A path is course.file")
    course = read_course(name or given.path("course.file"), **said)
    return on_slope(course, slope_angle=slope.angle if isinstance(slope, Plane) else None)


def _default(name: str) -> Any:
    return SCENARIO_KEYS[name].default


def _require(values: Mapping[str, Any], name: str, other: str) -> None:
    if name not in values:
        raise ParameterError(f"{name} is missing: {SCENARIO_KEYS[name].meaning}. Give it, {other}")


def _snow_map(given: GivenScenario) -> SnowMap | None:
    if "snow.map_file" not in given.values:
        return None
    found = read_snow_map(given.path("snow.map_file"))
    for name in _nominal(found).keys() & given.values.keys() - given.before_map:
        raise ParameterError(
            f"{name} is given twice, as a number and over the place by snow.map_file. Leave the number out, or "
            "remove the column from the map"
        )
    return found


def _nominal(snow_map: SnowMap | None) -> dict[str, float]:
    """Means over the map, by key, in its unit."""
    if snow_map is None:
        return {}
    hardness, stress = snow_map.mean_hardness, snow_map.mean_stress
    found = {
        "snow.H_V_N_per_mm3": None if hardness is None else hardness / N_PER_MM3,
        "snow.S_f_N_per_mm2": None if stress is None else stress / N_PER_MM2,
    }
    return {name: value for name, value in found.items() if value is not None}


def _snow(given: GivenScenario, snow_map: SnowMap | None, sources: Sources) -> SnowProperties:
    over_place = _nominal(snow_map)
    values = {**given.values, **over_place}
    ways = [name for name in ("snow.H_V_N_per_mm3", "snow.results", "snow.published") if name in values]
    if "snow.H_V_N_per_mm3" in over_place and len(ways) > 1:  # the map's H_V comes before that of a named snow
        ways = ways[1:]
    choices = "Give snow.H_V_N_per_mm3 and snow.S_f_N_per_mm2, or snow.results, or snow.published"
    if not ways:
        raise ParameterError(f"no snow is given: H_V has no default. {choices}")
    if len(ways) > 1:
        raise ParameterError(f"the snow is given in two ways, {ways[0]} and {ways[1]}. {choices}")
    if "snow.site" in given.values and ways != ["snow.results"]:
        raise ParameterError("snow.site goes with snow.results: it names one site of a campaign. Leave it out")
    stress = given.values.get("snow.S_f_N_per_mm2")
    snow = _named_snow(given, sources) if ways != ["snow.H_V_N_per_mm3"] else _snow_of_numbers(values)
    if ways != ["snow.H_V_N_per_mm3"] and isinstance(stress, float) and "snow.S_f_N_per_mm2" not in over_place:
        require_stress(snow, stress, carves=True)
        snow = with_stress(snow, stress)
    return snow if snow_map is None else snow_map.means_of(snow)


def _snow_of_numbers(values: Mapping[str, Any]) -> SnowProperties:
    if "snow.S_f_N_per_mm2" not in values:
        raise ParameterError("snow.S_f_N_per_mm2 is missing: the failure shear stress S_f. It has no default")
    return made(SnowProperties, values, section="snow", source="given as numbers")


def _named_snow(given: GivenScenario, sources: Sources) -> SnowProperties:
    words = {name: given.values.get(f"snow.{name}") for name in ("published", "site")}
    results = str(given.path("snow.results")) if "snow.results" in given.values else None
    return sources.named_snow({**words, "results": results})


def _contact(values: Mapping[str, Any], snow: SnowProperties, snow_map: SnowMap | None) -> Contact:
    ratio = values.get("snow.unloading_ratio")
    if values.get("snow.penetration") == "elastic":
        if ratio not in (None, ELASTIC):
            raise ParameterError(
                f'snow.unloading_ratio is {ratio:g} beside snow.penetration = "elastic", which is 1. Leave one out'
            )
        ratio = ELASTIC
    way = values.get("snow.shear_displacement_mm")
    snow = without_measured(snow, unloading=ratio is not None, displacement=way is not None)
    ratio = snow.unloading_ratio if ratio is None else ratio
    if ratio is None:
        unknown = f"; the snow ({snow.source}) has none that was measured" if "snow.results" in values else ""
        raise ParameterError(_missing("snow.unloading_ratio") + unknown)
    measured: dict[str, Any] = {}
    if snow.shear_displacement is not None:
        measured["shear_displacement"] = snow.shear_displacement
    return made(Contact, values, snow=snow, snow_map=snow_map, unloading_ratio=ratio, **measured)


def _ski(given: GivenScenario, sources: Sources) -> tuple[Ski, tuple[str, ...]]:
    name, file = given.values.get("ski.name"), given.values.get("ski.file")
    if (name is None) == (file is None):
        found = "both are there" if name else "neither is there"
        raise ParameterError(f"a ski has either ski.name, of the catalogue, or ski.file; {found}")
    if file is not None:
        return sources.ski(str(given.path("ski.file").absolute()))
    if name not in ski_names():
        known = f"{meant(str(name), ski_names())}There are {', '.join(ski_names())}"
        raise ParameterError(f"ski.name is {name!r}, no ski of the catalogue. {known}. A path stands under ski.file")
    return sources.ski(str(name))
