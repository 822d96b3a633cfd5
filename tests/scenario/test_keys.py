"""Declarations of a scenario's dataclasses hold in files: defaults, ranges, schema."""

import math
import tomllib
from typing import Any

import jsonschema
import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Solver, keys, load_scenario, scenario_names, scenario_text
from skisnow.scenario.identify_section import Prior, measured_of, prior_of
from skisnow.scenario.keys import FREE_KEYS, SCENARIO_KEYS, free_key, free_keys
from skisnow.scenario.schema import scenario_schema
from skisnow.snow import SnowProperties
from tests.coded import Coded, coded, raises
from tests.key_names import DELAYED_SPACING, EDGE_ANGLE

SCHEMA = scenario_schema()


def test_defaults_are_in_the_unit_of_their_key() -> None:
    """Those of Python are the same."""
    told = {key: SCENARIO_KEYS[key].default for key in ("solver.method", "solver.fixed", "snow.compaction_resistance")}
    assert told == {"solver.method": "default", "solver.fixed": False, "snow.compaction_resistance": True}
    assert (Solver().method, Solver().fixed) == ("default", False)
    told = {key: SCENARIO_KEYS[key].default for key in ("solver.step_ms", "solver.tolerance_mm", "run.output_ms")}
    assert told == pytest.approx({"solver.step_ms": 0.5, "solver.tolerance_mm": 0.001, "run.output_ms": 10.0})
    assert (Solver().step, Solver().tolerance, Solver().output_interval) == (0.5e-3, 1e-6, 0.01)


DEFAULTS = {
    "slope": {"smooth_m": 0.0, "origin_x_m": 0.0, "origin_y_m": 0.0, "gravity_m_per_s2": 9.81},
    "snow": {
        "shear_displacement_mm": 0.02, "hardness_growth_per_mm": 0.0, "damping_N_s_per_mm3": 0.0, "delayed_share": 0.0,
        "retardation_time_ms": 100.0,
    },
    "friction": {"mu_1_s_per_m": 0.0},
    "drag": {"air_density_kg_per_m3": 1.2},
    "sledge": {"centre_of_mass_forward_m": 0.0},
    "ski": {"stiffness_factor": 1.0, "clamp_length_m": 0.3, "damping_ratio": 0.02},
    "start": {"x_m": 0.0, "y_m": 0.0, "heading_deg": 0.0},
    "run": {"output_ms": 10.0},
    "shear": {
        "relative_decrease_per_rad": 0.266, "transverse_friction": 0.0, "least_shear_plane_deg": 5.0,
        "residual_ratio": 1.0, "slip_weakening_mm": 1.0,
    },
    "solver": {"step_ms": 0.5, "tolerance_mm": 0.001, "groove_tolerance": 1e-4, "delayed_spacing_mm": 1.0},
    "skier": {
        "first_turn_s": 0.8, "turn_time_s": 2.0, "turns": 4.5, "turn_angle_deg": 30.0, "pole_clearance_m": 0.85,
        "brakes_to_m_per_s": 0.0, "stops_after_s": 3.0, "assumed_H_V_N_per_mm3": 0.0, "assumed_S_f_N_per_mm2": 0.0,
        "line_rate_per_s": 2.0, "longest_leg_m": 1.05, "shortest_leg_m": 0.32, "leg_load": 3.0,
        "greatest_edge_deg": 66.0, "greatest_hip_deg": 60.0, "hip_torque_Nm": 150.0, "shift_m": 0.15,
        "shift_speed_m_per_s": 1.5, "greatest_lean_deg": 50.0, "greatest_slip_deg": 28.0, "least_slip_deg": 13.0,
        "braking_per_s": 0.8, "outer_share": 0.65, "edge_rate_per_s": 35.0, "leg_gain": 0.7,
        "leg_yielding_per_s": 0.7, "edge_gain": 1.0, "highest_flight_m": 2.0, "control_period_ms": 5.0,
    },
}  # fmt: skip


@pytest.mark.parametrize("section", DEFAULTS)
def test_each_number_has_its_default(section: str) -> None:
    keys = {name.partition(".")[2]: key for name, key in SCENARIO_KEYS.items() if name.startswith(f"{section}.")}
    numbers = {name: key.default for name, key in keys.items() if key.kind == "number" and key.default is not None}
    assert numbers == pytest.approx(DEFAULTS[section], rel=1e-12)


def test_each_switch_has_its_default() -> None:
    switches = {name: key.default for name, key in SCENARIO_KEYS.items() if isinstance(key.default, bool)}
    expected = {"snow.compaction_resistance": True, "skier.first_to_left": True}
    assert switches == {**dict.fromkeys(("solver.fixed", "skier.carves"), False), **expected}


def test_what_must_be_given() -> None:
    """Slope, snow, ski and the end of the run have further rules."""
    assert {name for name, key in SCENARIO_KEYS.items() if key.needed} == {
        "friction.mu_0", "drag.drag_area_m2", "sledge.mass_kg", "sledge.inertia_kg_m2",
        "sledge.centre_of_mass_height_m", "sledge.stance_width_m", EDGE_ANGLE, "start.speed_m_per_s",
    }  # fmt: skip


def test_units_come_from_the_names() -> None:
    """Every unit that a scenario's keys have, and the keys without one."""
    found = {name.rpartition(".")[2]: key.unit for name, key in SCENARIO_KEYS.items()}
    assert {name: found[name] for name in ("H_V_N_per_mm3", "S_f_N_per_mm2", "inertia_kg_m2", "mu_1_s_per_m")} == {
        "H_V_N_per_mm3": "N/mm³",
        "S_f_N_per_mm2": "N/mm²",
        "inertia_kg_m2": "kg m²",
        "mu_1_s_per_m": "s/m",
    }
    assert (found["gravity_m_per_s2"], found["air_density_kg_per_m3"]) == ("m/s²", "kg/m³")
    assert (found["step_ms"], found["delayed_spacing_mm"], found["heading_deg"], found["x_m"]) == ("ms", "mm", "°", "m")
    numbers = {name.rpartition(".")[2] for name, key in SCENARIO_KEYS.items() if key.kind == "number"}
    assert {name for name in numbers if not found[name]} == {
        "unloading_ratio", "delayed_share", "mu_0", "liquid_water_percent", "damping_ratio", "groove_tolerance",
        "transverse_friction", "residual_ratio", "stiffness_factor", "turns", "leg_gain", "leg_load", "edge_gain",
        "outer_share",
    }  # fmt: skip


def test_factors_lead_to_si() -> None:
    assert SCENARIO_KEYS["snow.H_V_N_per_mm3"].in_si(0.2) == 2e8
    assert SCENARIO_KEYS["snow.S_f_N_per_mm2"].in_si(0.5) == 5e5
    assert SCENARIO_KEYS[EDGE_ANGLE].in_si(30.0) == pytest.approx(math.pi / 6.0, rel=1e-15)
    assert SCENARIO_KEYS[DELAYED_SPACING].in_si(4.0) == 0.004
    assert SCENARIO_KEYS["run.output_ms"].in_si(10.0) == 0.01


def test_a_word_that_may_mean_two_keys_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    """No two keys that can be looked for share a word now; a further one may."""
    two = ("friction.mu_0", "snow.S_f_N_per_mm2")
    monkeypatch.setattr(keys, "_KEYS_BY_WORD", {"both": two, "one": two[:1]})
    assert keys.free_key("one") == "friction.mu_0"
    with raises(ParameterError, "ambiguous", word="both"):
        keys.free_key("both")


@pytest.mark.parametrize("name", scenario_names())
def test_built_in_scenarios_hold_to_the_schema(name: str) -> None:
    assert list(jsonschema.Draft202012Validator(SCHEMA).iter_errors(tomllib.loads(scenario_text(name)))) == []


@pytest.mark.parametrize(
    "changes",
    [
        {"snow": {"published": "race-piste"}},
        {"ski": {"file": "a.toml"}},
        {"slope": {"profile": "p.csv"}},
        {"sledge": {"inertia_kg_m2": [1.0, 2.0]}},
        {"sledge": {"mass": 80}},
    ],
)
def test_schema_rejects_what_the_reader_rejects(changes: dict[str, dict[str, Any]]) -> None:
    parsed = tomllib.loads(scenario_text("carved-46m"))
    for section, values in changes.items():
        parsed[section].update(values)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parsed, SCHEMA)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("edge_angle_deg", -90.0),
        ("unloading_ratio", 0.9),
        ("inertia_kg_m2", [1.0, 2.0]),
        ("inertia_kg_m2", [1.0, 0.0, 1.0]),
        ("inertia_kg_m2", 3.0),
        ("mass_kg", math.inf),
        ("mass_kg", True),
        ("method", "euler"),
        ("published", " "),
    ],
)
def test_values_outside_their_range_are_rejected_by_the_key(key: str, value: object) -> None:
    with pytest.raises(ParameterError, match=rf"\.{key} is "):
        load_scenario("carved-46m", changes={key: value})


@pytest.mark.parametrize(
    ("word", "key"),
    [
        ("start.x_m", "start.x_m"),
        ("x_m", "start.x_m"),
        ("start.x", "start.x_m"),
        (" x ", "start.x_m"),
        ("mu_1", "friction.mu_1_s_per_m"),
    ],
)
def test_with_and_without_section_and_unit(word: str, key: str) -> None:
    assert free_key(word) == key


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("x_ms", coded("unknown_name", word="x_ms")),
        ("MASS", "unknown_name"),
        ("speeds", "unknown_name"),
        ("dragarea", coded("unknown_name", similar="drag_area_m2")),
        ("sf", coded("unknown_name", word="sf")),
        ("step", coded("not_free", key="solver.step_ms")),
        ("inertia", coded("not_free", key="sledge.inertia_kg_m2")),
        ("ski.name", coded("not_free", key="ski.name")),
        ("mu_0@ ", coded("missing", word="mu_0@ ", own="mu_0", each="each")),
        ("mu_0, mass, friction.mu_0", coded("repeated", key="friction.mu_0")),
    ],
)
def test_what_is_no_key_to_look_for(word: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        free_keys(word)


def test_where_nothing_is_near_all_are_reported() -> None:
    with pytest.raises(ParameterError) as refused:
        free_key("quark")
    told = str(refused.value).partition("Allowed: ")[2].removesuffix(".").split(", ")
    assert [free_key(word) for word in told] == list(FREE_KEYS)
    assert told == [key.partition(".")[2] for key in FREE_KEYS]


def test_a_key_of_one_run_may_stand_beside_that_of_another() -> None:
    listed = ["mu_0@first", "mu_0 @ second", "", "speed@each"]
    keys = ("friction.mu_0@first", "friction.mu_0@second", "start.speed_m_per_s@each")
    assert free_keys(listed) == free_keys(",".join(listed)) == keys


SHARES = np.array([0.0, 0.5, 1.0])


def test_the_logarithm_is_even() -> None:
    prior = prior_of("unloading_ratio=2:50")
    assert prior.at(SHARES, 7.0) == pytest.approx([2.0, 10.0, 50.0])


def test_about_the_scenarios_own_value() -> None:
    prior = Prior(key="friction.mu_0", low=0.4, high=2.5, origin="", about=True)
    assert prior.at(SHARES, 0.03) == pytest.approx([0.012, 0.03, 0.075])
    assert prior.at(SHARES, 0.0) == pytest.approx([0.0, 0.0, 0.0])
    assert prior.at(SHARES, 0.8)[2] == 1.0  # what the key allows


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("unknown_name", "wrong_kind"),
        ("mu_0=1", "wrong_kind"),
        ("mu_0=a:b", "wrong_kind"),
        ("mu_0=0.2:0.1", "out_of_range"),
        ("mu_0=0:0.1", "out_of_range"),
        ("mu_0=nan:0.1", "out_of_range"),
        ("mu_0=0.1:7", coded("out_of_range", name="friction.mu_0")),
        ("mew_0=0.1:0.2", "unknown_name"),
    ],
)
def test_what_is_no_prior_is_rejected(word: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        prior_of(word)


def test_measured_quantities_are_in_the_units_of_their_keys_and_spread_as_their_intervals() -> None:
    """An interval down to 0 has no logarithm; a key's range cuts what lies beyond it."""
    snow = SnowProperties(
        2e8, 5e5, source="mine", snow_hardness_interval=(1e8, 4e8), failure_shear_stress_interval=(0.0, 1e6),
        shear_displacement=2e-4, shear_displacement_interval=(1e-4, 4e-4), unloading_ratio=2.0,
        unloading_ratio_interval=(0.8, 5.0),
    )  # fmt: skip
    found = {each.key: each for each in measured_of(snow)}
    expected = {"snow.H_V_N_per_mm3": [0.1, 0.2, 0.4], "snow.unloading_ratio": [0.8, 2.0, 5.0]}
    expected["snow.shear_displacement_mm"] = [0.1, 0.2, 0.4]
    assert found.keys() == expected.keys()
    for key, numbers in expected.items():
        assert [found[key].low, found[key].value, found[key].high] == pytest.approx(numbers)
    ends = np.array([0.025, 0.5, 0.975])
    assert found["snow.H_V_N_per_mm3"].at(ends, 7.0) == pytest.approx([0.1, 0.2, 0.4], rel=1e-6)
    assert found["snow.unloading_ratio"].at(ends, 7.0) == pytest.approx([1.0, 2.0, 5.0], rel=1e-6)


SEARCHED = {name: key for name, key in SCENARIO_KEYS.items() if key.search is not None and not key.search.about}


@pytest.mark.parametrize("name", SEARCHED)
def test_usual_bounds_hold_the_default_and_lie_in_the_range(name: str) -> None:
    key = SEARCHED[name]
    assert key.search is not None
    assert key.lowest <= key.search.lower < key.search.upper <= key.highest
    if isinstance(key.default, float | int):
        assert key.search.lower <= key.default <= key.search.upper


def test_a_logarithm_has_a_size_of_its_own_order() -> None:
    """A factor of e^0.5 to e^3: with a size in another unit a step would be no step."""
    for key in SEARCHED.values():
        if key.search is not None and key.search.logarithmic:
            assert 0.5 <= key.search.size <= 3.0


@pytest.mark.parametrize(
    ("name", "parts"),
    [("carved-46m", set()), ("skier-10deg", {"skier"}), ("giant-slalom-20-gates", {"course", "skier"})],
)
def test_facts_of_a_scenario_have_the_parts_that_it_has(name: str, parts: set[str]) -> None:
    facts = dict(load_scenario(name)._repr_facts().rows)
    assert facts.keys() & {"boots", "course", "skier"} == parts
