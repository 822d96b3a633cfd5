"""From values as given to a scenario in SI."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...errors import ParameterError
from ...ski import Ski, ski_names
from ...snow import SnowProperties
from ..carve_answer import Sources
from ..carve_limits import require_stress, with_stress
from ..input_keys import meant
from ..sledge import RigidSledge
from .given import GivenScenario
from .keys import REQUIRED, SCENARIO_KEYS, in_si
from .profile_file import read_profile
from .scenario import Air, Contact, Scenario, Solver, Start, Stop
from .slope import Plane, Profile

ELASTIC = 1.0
"""k_u/H_V of snow that springs back."""


def built(given: GivenScenario, sources: Sources) -> tuple[Scenario, tuple[str, ...]]:
    """The scenario, and what the reader of the ski warned of.

    Raises
    ------
    ParameterError
        A key is missing, two say the same or do not go together, or a file that one names cannot be read.
    """
    values = {name: given.values.get(name, key.default) for name, key in SCENARIO_KEYS.items()}
    if values["solver.method"] == "fast":
        values["solver.fixed"] = given.values.get("solver.fixed", True)
    for name in REQUIRED:
        if values[name] is None:
            raise ParameterError(f"{name} is missing: {SCENARIO_KEYS[name].meaning}. It has no default")
    ski, told = _ski(given, sources)
    scenario = Scenario(
        slope=_slope(given, values),
        contact=_contact(values, _snow(given, sources)),
        air=_air(values),
        sledge=_sledge(values),
        ski=ski,
        clamp_length=_number(values, "ski.clamp_length_m"),
        damping_ratio=_number(values, "ski.damping_ratio"),
        start=Start(
            x=_number(values, "start.x_m"),
            y=_number(values, "start.y_m"),
            speed=_number(values, "start.speed_m_per_s"),
            heading=_number(values, "start.heading_deg"),
        ),
        stop=_stop(values),
        solver=_solver(values),
        gravity=_number(values, "slope.gravity_m_per_s2"),
    )
    return scenario, told


def _number(values: Mapping[str, Any], name: str) -> float:
    return in_si(name, values[name])


def _optional(values: Mapping[str, Any], name: str) -> float | None:
    return None if values[name] is None else in_si(name, values[name])


def _slope(given: GivenScenario, values: Mapping[str, Any]) -> Plane | Profile:
    kind = values["slope.kind"]
    for name, of in (("slope.angle_deg", "plane"), ("slope.profile", "profile"), ("slope.profile_gap", "profile")):
        if name in given.values and kind != of:
            raise ParameterError(f'{name} goes with slope.kind = "{of}"; it is "{kind}". Change one of them')
    if kind == "plane":
        _require(values, "slope.angle_deg", 'or a measured profile: slope.kind = "profile" and slope.profile')
        return Plane(_number(values, "slope.angle_deg"))
    _require(values, "slope.profile", 'or a plane: slope.kind = "plane" and slope.angle_deg')
    return read_profile(given.path("slope.profile"), gap=values["slope.profile_gap"])


def _require(values: Mapping[str, Any], name: str, other: str) -> None:
    if values[name] is None:
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
    hardness, stress = (in_si(name, given.values[name]) for name in ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"))
    return SnowProperties(hardness, stress, source="given as numbers")


def _named_snow(given: GivenScenario, sources: Sources) -> SnowProperties:
    words = {name: given.values.get(f"snow.{name}") for name in ("published", "site")}
    results = str(given.path("snow.results")) if "snow.results" in given.values else None
    return sources.named_snow({**words, "results": results})


def _contact(values: Mapping[str, Any], snow: SnowProperties) -> Contact:
    ratio = values["snow.unloading_ratio"]
    if values["snow.penetration"] == "elastic":
        if ratio not in (None, ELASTIC):
            raise ParameterError(
                f'snow.unloading_ratio is {ratio:g} beside snow.penetration = "elastic", which is 1. Leave one out'
            )
        ratio = ELASTIC
    if ratio is None:
        raise ParameterError(
            f"snow.unloading_ratio is missing: {SCENARIO_KEYS['snow.unloading_ratio'].meaning}. It has no default"
        )
    return Contact(
        snow=snow,
        unloading_ratio=ratio,
        compaction_resistance=values["snow.compaction_resistance"],
        friction=values["friction.mu_0"],
        friction_by_speed=values["friction.mu_1_s_per_m"],
    )


def _air(values: Mapping[str, Any]) -> Air:
    height = values["drag.centre_of_pressure_height_m"]
    return Air(
        drag_area=values["drag.drag_area_m2"],
        density=values["drag.air_density_kg_per_m3"],
        centre_of_pressure_height=values["sledge.centre_of_mass_height_m"] if height is None else height,
    )


def _sledge(values: Mapping[str, Any]) -> RigidSledge:
    return RigidSledge(
        mass=values["sledge.mass_kg"],
        inertia=values["sledge.inertia_kg_m2"],
        centre_of_mass=(values["sledge.centre_of_mass_forward_m"], values["sledge.centre_of_mass_height_m"]),
        stance_width=values["sledge.stance_width_m"],
        edge_angle=_number(values, "sledge.edge_angle_deg"),
    )


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


def _stop(values: Mapping[str, Any]) -> Stop:
    stop = Stop(duration=_optional(values, "run.duration_s"), length=_optional(values, "run.length_m"))
    if stop.duration is stop.length is None:
        raise ParameterError("the run has no end: give run.duration_s or run.length_m")
    return stop


def _solver(values: Mapping[str, Any]) -> Solver:
    return Solver(
        method=values["solver.method"],
        step=_number(values, "solver.step_ms"),
        tolerance=_number(values, "solver.tolerance_mm"),
        fixed=values["solver.fixed"],
        elements=values["solver.elements"],
        line_spacing=_optional(values, "solver.line_spacing_mm"),
        cell=_optional(values, "solver.cell_mm"),
        output_interval=_number(values, "run.output_ms"),
    )
