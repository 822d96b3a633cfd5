"""From values as given to a scenario in SI."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..errors import ParameterError
from ..inputs import made, meant
from ..ski import Ski, ski_names
from ..snow import SnowProperties
from ..snow.given_stress import require_stress, with_stress
from ..snow.mean_snow import without_measured
from ..sources import Sources
from .boots import Boots
from .boots_file import read_boots
from .contact import ELASTIC, Contact
from .given import GivenScenario
from .keys import SCENARIO_KEYS
from .profile_file import read_profile
from .scenario import Scenario
from .slope import Plane, Profile


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
    slope, snow = _slope(given, values), _snow(given, sources)
    for name in outdone(given, snow):
        del values[name]
    contact = _contact(values, snow)
    if "run.duration_s" not in values and "run.length_m" not in values:
        raise ParameterError("the run has no end: give run.duration_s or run.length_m")
    values.setdefault("drag.centre_of_pressure_height_m", values["sledge.centre_of_mass_height_m"])
    return made(Scenario, values, slope=slope, contact=contact, ski=ski, boots=_boots(given, values)), warned


def _boots(given: GivenScenario, values: Mapping[str, Any]) -> Boots | None:
    if "boots.file" not in values:
        return None
    edge_angle = math.radians(values["sledge.edge_angle_deg"])
    return read_boots(given.path("boots.file"), edge_angle=edge_angle, stance_width=values["sledge.stance_width_m"])


def outdone(given: GivenScenario, snow: SnowProperties) -> frozenset[str]:
    """Names of given values that the snow, which was given after them, has measured itself."""
    if "snow.results" not in given.values:
        return frozenset()
    known = {"snow.unloading_ratio": snow.unloading_ratio, "snow.shear_displacement_mm": snow.shear_displacement}
    return frozenset(name for name in given.before_results if known[name] is not None)


def _missing(name: str) -> str:
    return f"{name} is missing: {SCENARIO_KEYS[name].meaning}. It has no default"


def _slope(given: GivenScenario, values: Mapping[str, Any]) -> Plane | Profile:
    kind = values.get("slope.kind", _default("slope.kind"))
    for name, of in (("slope.angle_deg", "plane"), ("slope.profile", "profile"), ("slope.profile_gap", "profile")):
        if name in given.values and kind != of:
            raise ParameterError(f'{name} goes with slope.kind = "{of}"; it is "{kind}". Change one of them')
    if kind == "plane":
        _require(values, "slope.angle_deg", 'or a measured profile: slope.kind = "profile" and slope.profile')
        return made(Plane, values)
    _require(values, "slope.profile", 'or a plane: slope.kind = "plane" and slope.angle_deg')
    return read_profile(given.path("slope.profile"), gap=values.get("slope.profile_gap", _default("slope.profile_gap")))


def _default(name: str) -> Any:
    return SCENARIO_KEYS[name].default


def _require(values: Mapping[str, Any], name: str, other: str) -> None:
    if name not in values:
        raise ParameterError(f"{name} is missing: {SCENARIO_KEYS[name].meaning}. Give it, {other}")


def _snow(given: GivenScenario, sources: Sources) -> SnowProperties:
    ways = [name for name in ("snow.H_V_N_per_mm3", "snow.results", "snow.published") if name in given.values]
    choices = "Give snow.H_V_N_per_mm3 and snow.S_f_N_per_mm2, or snow.results, or snow.published"
    if not ways:
        raise ParameterError(f"no snow is given: H_V has no default. {choices}")
    if len(ways) > 1:
        raise ParameterError(f"the snow is given in two ways, {ways[0]} and {ways[1]}. {choices}")
    if "snow.site" in given.values and ways != ["snow.results"]:
        raise ParameterError("snow.site goes with snow.results: it names one site of a campaign. Leave it out")
    stress = given.values.get("snow.S_f_N_per_mm2")
    snow = _named_snow(given, sources) if ways != ["snow.H_V_N_per_mm3"] else _snow_of_numbers(given)
    if ways == ["snow.H_V_N_per_mm3"] or not isinstance(stress, float):
        return snow
    require_stress(snow, stress, carves=True)
    return with_stress(snow, stress)


def _snow_of_numbers(given: GivenScenario) -> SnowProperties:
    if "snow.S_f_N_per_mm2" not in given.values:
        raise ParameterError("snow.S_f_N_per_mm2 is missing: the failure shear stress S_f. It has no default")
    return made(SnowProperties, given.values, section="snow", source="given as numbers")


def _named_snow(given: GivenScenario, sources: Sources) -> SnowProperties:
    words = {name: given.values.get(f"snow.{name}") for name in ("published", "site")}
    results = str(given.path("snow.results")) if "snow.results" in given.values else None
    return sources.named_snow({**words, "results": results})


def _contact(values: Mapping[str, Any], snow: SnowProperties) -> Contact:
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
    return made(Contact, values, snow=snow, unloading_ratio=ratio, **measured)


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
