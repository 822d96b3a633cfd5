"""Declarations of a scenario's dataclasses hold in files: defaults, ranges, schema."""

import json
import math
import tomllib
from importlib.resources import files
from typing import Any

import jsonschema
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Solver, keys, load_scenario, scenario_names, scenario_text
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.scenario.schema import scenario_schema
from tests.coded import raises

SCHEMAS = files("skisnow.scenario") / "schemas"
SCHEMA = json.loads((SCHEMAS / "scenario.schema.json").read_text(encoding="utf-8"))


def test_switches_and_words_have_pythons_defaults() -> None:
    told = {key: SCENARIO_KEYS[key].default for key in ("solver.method", "solver.fixed", "snow.compaction_resistance")}
    assert told == {"solver.method": "default", "solver.fixed": False, "snow.compaction_resistance": True}
    assert (Solver().method, Solver().fixed) == ("default", False)


def test_defaults_stand_in_the_unit_of_their_key() -> None:
    told = {key: SCENARIO_KEYS[key].default for key in ("solver.step_ms", "solver.tolerance_mm", "run.output_ms")}
    assert told == pytest.approx({"solver.step_ms": 0.5, "solver.tolerance_mm": 0.001, "run.output_ms": 10.0})
    assert (Solver().step, Solver().tolerance, Solver().output_interval) == (0.5e-3, 1e-6, 0.01)


def test_what_must_be_given() -> None:
    """Slope, snow, ski and the end of the run have further rules."""
    assert {name for name, key in SCENARIO_KEYS.items() if key.needed} == {
        "friction.mu_0",
        "drag.drag_area_m2",
        "sledge.mass_kg",
        "sledge.inertia_kg_m2",
        "sledge.centre_of_mass_height_m",
        "sledge.stance_width_m",
        "sledge.edge_angle_deg",
        "start.speed_m_per_s",
    }


def test_what_makes_a_scenario_has_no_default() -> None:
    without = {name for name, key in SCENARIO_KEYS.items() if key.default is None}
    assert {"snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.unloading_ratio", "slope.angle_deg"} <= without


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
        "unloading_ratio",
        "delayed_share",
        "mu_0",
        "damping_ratio",
        "groove_tolerance",
        "transverse_friction",
        "residual_ratio",
        "stiffness_factor",
        "turns",
        "leg_gain",
        "edge_gain",
        "outer_share",
    }


def test_factors_lead_to_si() -> None:
    assert SCENARIO_KEYS["snow.H_V_N_per_mm3"].in_si(0.2) == 2e8
    assert SCENARIO_KEYS["snow.S_f_N_per_mm2"].in_si(0.5) == 5e5
    assert SCENARIO_KEYS["sledge.edge_angle_deg"].in_si(30.0) == pytest.approx(math.pi / 6.0, rel=1e-15)
    assert SCENARIO_KEYS["solver.delayed_spacing_mm"].in_si(4.0) == 0.004
    assert SCENARIO_KEYS["run.output_ms"].in_si(10.0) == 0.01


def test_a_word_that_may_mean_two_keys_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """No two keys that can be looked for share a word now; a further one may."""
    two = ("friction.mu_0", "snow.S_f_N_per_mm2")
    monkeypatch.setattr(keys, "_KEYS_BY_WORD", {"both": two, "one": two[:1]})
    assert keys.free_key("one") == "friction.mu_0"
    with raises(ParameterError, "ambiguous", word="both"):
        keys.free_key("both")


def test_the_written_schema_is_that_of_the_dataclasses() -> None:
    assert scenario_schema() == SCHEMA


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
def test_schema_refuses_what_the_reader_refuses(changes: dict[str, dict[str, Any]]) -> None:
    parsed = tomllib.loads(scenario_text("carved-46m"))
    for section, values in changes.items():
        parsed[section].update(values)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(parsed, SCHEMA)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("mass_kg", 0.0),
        ("edge_angle_deg", 90.0),
        ("edge_angle_deg", -90.0),
        ("step_ms", 1000.0),
        ("unloading_ratio", 0.9),
        ("inertia_kg_m2", [1.0, 2.0]),
        ("inertia_kg_m2", [1.0, 0.0, 1.0]),
        ("inertia_kg_m2", 3.0),
        ("elements", 40.5),
        ("mass_kg", math.nan),
        ("mass_kg", math.inf),
        ("mass_kg", True),
        ("fixed", 1),
        ("method", "euler"),
        ("published", " "),
    ],
)
def test_values_outside_their_range_are_refused_by_the_key(key: str, value: object) -> None:
    with pytest.raises(ParameterError, match=rf"\.{key} is "):
        load_scenario("carved-46m", changes={key: value})
