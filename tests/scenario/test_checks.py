"""A scenario that is built in Python holds to the same limits as one from a file."""

import math
import re
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow import Run, simulate
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.parameters import Quantity
from skisnow.scenario import Profile, load_scenario, scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS
from skisnow.snow import SnowProperties
from tests.coded import Coded, coded, raises


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"gravity": 0.0}, coded("out_of_range", low=0.0)),
        ({"damping_ratio": 2.0}, "out_of_range"),
        ({"clamp_length": -0.1}, coded("out_of_range", low=0.0, value="-0.1")),
        ({"clamp_length": 1.8}, "contradiction"),
        ({"slope": Profile(np.arange(1.0, 5.0), np.zeros(4))}, "contradiction"),
    ],
)
def test_scenario_out_of_its_limits_is_rejected(values: dict[str, Any], told: str | Coded) -> None:
    with raises(ParameterError, told):
        replace(load_scenario("carved-46m"), **values)


BASE = "carved-46m"
SHORT = {"run.duration_s": 0.04, "run.output_ms": 20.0, "solver.method": "fast", "solver.tolerance_mm": 1e-4}
FIRST_GUESS = "solver.step_ms"
"""The control of the error may replace this first step at once."""


@pytest.fixture(scope="module")
def reference() -> Run:
    return simulate(load_scenario(BASE, changes=SHORT))


def other_value(key: Quantity, value: float | bool | None) -> float | bool:
    """A value of the key that differs from the value in force."""
    if key.kind == "switch":
        return not value
    if value is None:
        return max(key.lowest, 0.0) + (17 if key.kind == "whole number" else 10.0 if key.unit == "mm" else 0.01)
    larger = value + 1 if key.kind == "whole number" else 1.3 * value + 0.013
    return larger if larger < key.highest else 0.7 * value


NUMBERS = [name for name, key in SCENARIO_KEYS.items() if key.kind in ("number", "whole number", "switch")]


@pytest.mark.parametrize("name", [name for name in NUMBERS if name != FIRST_GUESS])
def test_every_number_has_an_effect_or_is_rejected(name: str, reference: Run) -> None:
    value = other_value(SCENARIO_KEYS[name], scenario_values(reference.scenario)[name])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        try:
            run = simulate(load_scenario(BASE, changes={**SHORT, name: value}))
        except ParameterError:
            return
    assert not same_motion(run, reference)


def same_motion(run: Run, other: Run) -> bool:
    pairs = ((run.time, other.time), (run.place, other.place), (run.skis.total_force, other.skis.total_force))
    return all(np.array_equal(one, two) for one, two in pairs) and math.isclose(run.time[-1], other.time[-1])


OUT_OF_RANGE: list[tuple[str, str, object, str, object]] = [
    ("solver", "method", "rk4", "solver.method", "rk4"),
    ("solver", "elements", 2, "solver.elements", 2),
    ("solver", "elements", 40.5, "solver.elements", 40.5),
    ("solver", "fixed", 1, "solver.fixed", 1),
    ("solver", "step", 1.0, "solver.step_ms", 1000),
    ("solver", "tolerance", 0.0, "solver.tolerance_mm", 0),
    ("solver", "output_interval", 0.0, "run.output_ms", 0),
    ("solver", "line_spacing", 0.0, "solver.line_spacing_mm", 0),
    ("contact", "compaction_resistance", "yes", "snow.compaction_resistance", "yes"),
    ("contact", "friction_by_speed", 0.5, "friction.mu_1_s_per_m", 0.5),
    ("contact", "unloading_ratio", math.inf, "snow.unloading_ratio", math.inf),
    ("contact", "unloading_ratio", 0.5, "snow.unloading_ratio", 0.5),
    ("contact", "friction", -0.01, "friction.mu_0", -0.01),
    ("air", "drag_area", -1.0, "drag.drag_area_m2", -1),
    ("air", "density", math.inf, "drag.air_density_kg_per_m3", math.inf),
    ("air", "density", 0.0, "drag.air_density_kg_per_m3", 0),
    ("air", "centre_of_pressure_height", -0.1, "drag.centre_of_pressure_height_m", -0.1),
    ("sledge", "edge_angle", math.radians(90.0), "sledge.edge_angle_deg", 90),
    ("sledge", "edge_angle", math.nan, "sledge.edge_angle_deg", math.nan),
    ("sledge", "mass", 0.0, "sledge.mass_kg", 0),
    ("sledge", "mass", 2000.0, "sledge.mass_kg", 2000),
    ("sledge", "stance_width", 5.0, "sledge.stance_width_m", 5),
    ("sledge", "centre_of_mass", (0.0, 4.0), "sledge.centre_of_mass_height_m", 4),
    ("sledge", "centre_of_mass", (-2.0, 0.1), "sledge.centre_of_mass_forward_m", -2),
    ("start", "speed", -1.0, "start.speed_m_per_s", -1),
    ("start", "heading", math.radians(270.0), "start.heading_deg", 270),
    ("start", "x", math.nan, "start.x_m", math.nan),
    ("stop", "duration", 0.0, "run.duration_s", 0),
    ("stop", "length", math.nan, "run.length_m", math.nan),
    ("stop", "duration", 7200.0, "run.duration_s", 7200),
    ("stop", "length", 1e6, "run.length_m", 1e6),
    ("slope", "angle", math.radians(80.0), "slope.angle_deg", 80),
]
"""For each the part of a scenario, the field and its value in SI; the key and its value."""


def said(error: pytest.ExceptionInfo[ParameterError]) -> str:
    """The message without the file and without how the value is written."""
    return re.sub(r"^carved-46m: | is .*?; ", "", str(error.value))


@pytest.mark.parametrize(("part", "field", "value", "key", "given"), OUT_OF_RANGE)
def test_python_rejects_what_a_file_rejects(part: str, field: str, value: object, key: str, given: object) -> None:
    scenario = load_scenario("carved-46m")
    with pytest.raises(ParameterError, match=rf"{re.escape(key)} is ") as in_file:
        load_scenario("carved-46m", changes={key: given})
    with pytest.raises(ParameterError, match=rf"^{re.escape(key)} is ") as in_python:
        replace(getattr(scenario, part), **{field: value})
    assert said(in_file) == said(in_python)


@pytest.mark.parametrize("values", [(-2e8, 5e5), (2e8, 0.0), (math.inf, 5e5), (2e8, math.nan)])
def test_snow_that_is_none_is_rejected(values: tuple[float, float]) -> None:
    with raises(ParameterError, "out_of_range", low=0.0, allowed="above 0"):
        SnowProperties(*values, source="given as numbers")


@pytest.mark.parametrize(
    ("part", "values"),
    [
        ("start", {"heading": math.pi}),
        ("slope", {"angle": math.radians(75.0)}),
        ("sledge", {"edge_angle": -math.radians(85.0), "stance_width": 0.11}),
        ("solver", {"step": 5e-3, "tolerance": 1e-2, "line_spacing": 0.2, "elements": 4000}),
        ("sledge", {"centre_of_mass": (-1.0, 3.0), "stance_width": 3.0}),
        ("stop", {"duration": 3600.0, "length": 1e5}),
    ],
)
def test_ends_of_ranges_are_allowed_in_python(part: str, values: dict[str, Any]) -> None:
    """However the units round: 75 degrees in radians are not 75 times a degree."""
    changed = replace(getattr(load_scenario("carved-46m"), part), **values)
    assert all(getattr(changed, name) == value for name, value in values.items())
