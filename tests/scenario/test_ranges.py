"""Python refuses the same values as files, in the same words; a built scenario is changed part by part."""

import math
import re
from dataclasses import replace
from typing import Any

import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import load_scenario
from skisnow.snow import SnowProperties
from tests.coded import raises

OUT_OF_RANGE: list[tuple[str, str, object, str, object]] = [
    ("solver", "method", "rk4", "solver.method", "rk4"),
    ("solver", "elements", 2, "solver.elements", 2),
    ("solver", "elements", 40.5, "solver.elements", 40.5),
    ("solver", "fixed", 1, "solver.fixed", 1),
    ("solver", "line_spacing", 0.0, "solver.line_spacing_mm", 0),
    ("contact", "compaction_resistance", "yes", "snow.compaction_resistance", "yes"),
    ("contact", "friction_by_speed", 0.5, "friction.mu_1_s_per_m", 0.5),
    ("contact", "unloading_ratio", math.inf, "snow.unloading_ratio", math.inf),
    ("air", "density", 0.0, "drag.air_density_kg_per_m3", 0),
    ("air", "centre_of_pressure_height", -0.1, "drag.centre_of_pressure_height_m", -0.1),
    ("sledge", "mass", 2000.0, "sledge.mass_kg", 2000),
    ("sledge", "stance_width", 5.0, "sledge.stance_width_m", 5),
    ("sledge", "centre_of_mass", (0.0, 4.0), "sledge.centre_of_mass_height_m", 4),
    ("sledge", "centre_of_mass", (-2.0, 0.1), "sledge.centre_of_mass_forward_m", -2),
    ("start", "heading", math.radians(270.0), "start.heading_deg", 270),
    ("start", "x", math.nan, "start.x_m", math.nan),
    ("stop", "duration", 7200.0, "run.duration_s", 7200),
    ("stop", "length", 1e6, "run.length_m", 1e6),
    ("slope", "angle", math.radians(80.0), "slope.angle_deg", 80),
]
"""For each the part of a scenario, the field and its value in SI; the key and its value."""


def said(error: pytest.ExceptionInfo[ParameterError]) -> str:
    """The message without the file and without how the value is written."""
    return re.sub(r"^carved-46m: | is .*?; ", "", str(error.value))


@pytest.mark.parametrize(("part", "field", "value", "key", "given"), OUT_OF_RANGE)
def test_python_refuses_what_a_file_refuses(part: str, field: str, value: object, key: str, given: object) -> None:
    scenario = load_scenario("carved-46m")
    with pytest.raises(ParameterError, match=rf"{re.escape(key)} is ") as in_file:
        load_scenario("carved-46m", changes={key: given})
    with pytest.raises(ParameterError, match=rf"^{re.escape(key)} is ") as in_python:
        replace(getattr(scenario, part), **{field: value})
    assert said(in_file) == said(in_python)


@pytest.mark.parametrize("values", [(-2e8, 5e5), (2e8, 0.0), (math.inf, 5e5), (2e8, math.nan)])
def test_snow_that_is_none_is_refused(values: tuple[float, float]) -> None:
    with raises(ParameterError, "out_of_range", low=0.0, allowed="above 0"):
        SnowProperties(*values, source="given as numbers")


@pytest.mark.parametrize(
    ("part", "values"),
    [
        ("start", {"heading": math.pi}),
        ("slope", {"angle": math.radians(75.0)}),
        ("solver", {"step": 5e-3, "tolerance": 1e-2, "line_spacing": 0.2, "elements": 4000}),
        ("sledge", {"centre_of_mass": (-1.0, 3.0), "stance_width": 3.0}),
        ("stop", {"duration": 3600.0, "length": 1e5}),
    ],
)
def test_ends_of_ranges_are_allowed_in_python(part: str, values: dict[str, Any]) -> None:
    """However the units round: 75 degrees in radians are not 75 times a degree."""
    changed = replace(getattr(load_scenario("carved-46m"), part), **values)
    assert all(getattr(changed, name) == value for name, value in values.items())
