"""A scenario that is built in Python holds to the same limits as one from a file."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Profile, Scenario, load_scenario
from tests.coded import Coded, coded, raises


def changed(part: str, **values: Any) -> Scenario:
    scenario = load_scenario("carved-46m")
    return replace(scenario, **{part: replace(getattr(scenario, part), **values)})


@pytest.mark.parametrize(
    ("part", "values", "told"),
    [
        (
            "sledge",
            {"edge_angle": np.radians(90.0)},
            coded("out_of_range", low=-85.0, high=85.0, value="90.0", allowed="from -85 to 85", unit="°"),
        ),
        ("sledge", {"edge_angle": np.nan}, coded("out_of_range", value="nan")),
        ("sledge", {"stance_width": 0.05}, "contradiction"),
        ("sledge", {"mass": 0.0}, coded("out_of_range", low=0.0, value="0.0")),
        (
            "solver",
            {"step": 1.0},
            coded("out_of_range", low=0.001, high=5.0, value="1000.0", allowed="from 0.001 to 5", unit="ms"),
        ),
        ("solver", {"tolerance": 0.0}, coded("out_of_range", value="0.0")),
        ("solver", {"output_interval": 0.0}, coded("out_of_range", value="0.0")),
        ("contact", {"unloading_ratio": 0.5}, coded("out_of_range", value="0.5")),
        ("contact", {"friction": -0.01}, coded("out_of_range", low=0.0, value="-0.01")),
        ("contact", {"friction_by_speed": -0.01}, "contradiction"),
        ("air", {"drag_area": -1.0}, "out_of_range"),
        ("air", {"density": np.inf}, coded("out_of_range", value="inf")),
        ("start", {"speed": -1.0}, "out_of_range"),
        ("stop", {"duration": 0.0}, coded("out_of_range", low=0.0)),
        ("stop", {"length": np.nan}, coded("out_of_range", value="nan")),
    ],
)
def test_part_out_of_its_limits_is_refused(part: str, values: dict[str, Any], told: str | Coded) -> None:
    with raises(ParameterError, told):
        changed(part, **values)


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
def test_scenario_out_of_its_limits_is_refused(values: dict[str, Any], told: str | Coded) -> None:
    with raises(ParameterError, told):
        replace(load_scenario("carved-46m"), **values)


def test_limits_themselves_are_allowed() -> None:
    assert changed("solver", step=5e-3).solver.step == 5e-3
    assert changed("sledge", stance_width=0.11).sledge.stance_width == 0.11
    assert changed("sledge", edge_angle=-np.radians(85.0)).sledge.edge_angle < 0.0
