"""The table of keys says what holds: defaults, ranges, schema."""

import json
import math
import tomllib
from dataclasses import fields
from importlib.resources import files
from typing import Any

import jsonschema
import pytest

import skisnow
from skisnow.errors import ParameterError
from skisnow.simulate.input_keys import InputKey
from skisnow.simulate.scenario import Contact, Scenario, Solver, Start, read_scenario, scenario_names, scenario_text
from skisnow.simulate.scenario.keys import REQUIRED, SCENARIO_KEYS, in_si

SCHEMAS = files(skisnow.simulate) / "schemas"
SCHEMA = json.loads((SCHEMAS / "scenario.schema.json").read_text(encoding="utf-8"))
DATACLASS_DEFAULTS = [
    (Solver, "step", "solver.step_ms"),
    (Solver, "tolerance", "solver.tolerance_mm"),
    (Solver, "output_interval", "run.output_ms"),
    (Scenario, "clamp_length", "ski.clamp_length_m"),
    (Scenario, "damping_ratio", "ski.damping_ratio"),
    (Scenario, "gravity", "slope.gravity_m_per_s2"),
    (Contact, "friction_by_speed", "friction.mu_1_s_per_m"),
    (Start, "x", "start.x_m"),
    (Start, "y", "start.y_m"),
    (Start, "heading", "start.heading_deg"),
]


@pytest.mark.parametrize(("owner", "name", "key"), DATACLASS_DEFAULTS)
def test_default_of_a_file_is_that_of_python(owner: type, name: str, key: str) -> None:
    (default,) = [field.default for field in fields(owner) if field.name == name]
    assert in_si(key, SCENARIO_KEYS[key].default) == pytest.approx(default, rel=1e-15)


def test_switches_and_words_have_pythons_defaults() -> None:
    told = {key: SCENARIO_KEYS[key].default for key in ("solver.method", "solver.fixed", "snow.compaction_resistance")}
    assert told == {"solver.method": "ros2", "solver.fixed": False, "snow.compaction_resistance": True}
    assert (Solver().method, Solver().fixed) == ("ros2", False)


def test_what_makes_a_scenario_has_no_default() -> None:
    without = {name for name, key in SCENARIO_KEYS.items() if key.default is None}
    assert set(REQUIRED) <= without
    assert {"snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2", "snow.unloading_ratio", "slope.angle_deg"} <= without


def test_units_stand_in_the_names() -> None:
    ending = {
        "°": "_deg",
        "m": "_m",
        "ms": "_ms",
        "mm": "_mm",
        "s": "_s",
        "kg": "_kg",
        "m²": "_m2",
        "m/s": "_m_per_s",
        "m/s²": "_m_per_s2",
        "s/m": "_s_per_m",
        "kg m²": "_kg_m2",
        "kg/m³": "_kg_per_m3",
        "N/mm³": "_N_per_mm3",
        "N/mm²": "_N_per_mm2",
    }
    for key in SCENARIO_KEYS.values():
        if key.unit:
            assert key.name.endswith(ending[key.unit]), key.name


def test_factors_lead_to_si() -> None:
    assert in_si("snow.H_V_N_per_mm3", 0.2) == 2e8
    assert in_si("snow.S_f_N_per_mm2", 0.5) == 5e5
    assert in_si("sledge.edge_angle_deg", 30.0) == pytest.approx(math.pi / 6.0, rel=1e-15)
    assert in_si("solver.cell_mm", 4.0) == 0.004
    assert in_si("run.output_ms", 10.0) == 0.01


def of_schema(key: InputKey) -> dict[str, Any]:
    section, name = key.name.split(".")
    found: dict[str, Any] = SCHEMA["properties"][section]["properties"][name]
    return found


@pytest.mark.parametrize("key", SCENARIO_KEYS.values(), ids=lambda key: key.name)
def test_schema_has_the_ranges_of_the_table(key: InputKey) -> None:
    told = of_schema(key)
    of_number = told.get("items", told)
    lowest = of_number.get("exclusiveMinimum" if key.above else "minimum", -math.inf)
    assert (lowest, of_number.get("maximum", math.inf)) == (key.lowest, key.highest)
    assert tuple(told.get("enum", ())) == key.choices
    assert told.get("default") == key.default


def test_schema_has_no_other_keys() -> None:
    sections = {name: part for name, part in SCHEMA["properties"].items() if name != "identify"}
    told = {f"{section}.{name}" for section, part in sections.items() for name in part["properties"]}
    assert told == set(SCENARIO_KEYS)


@pytest.mark.parametrize("name", scenario_names())
def test_built_in_scenarios_hold_to_the_schema(name: str) -> None:
    jsonschema.validate(tomllib.loads(scenario_text(name)), SCHEMA)


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
        read_scenario("carved-46m", changes={key: value})
