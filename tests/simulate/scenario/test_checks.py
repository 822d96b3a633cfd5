"""A scenario that is built in Python holds to the same limits as one from a file."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow import read_scenario
from skisnow.errors import ParameterError
from skisnow.simulate.scenario import Profile, Scenario


def changed(part: str, **values: Any) -> Scenario:
    scenario = read_scenario("carved-46m")
    return replace(scenario, **{part: replace(getattr(scenario, part), **values)})


@pytest.mark.parametrize(
    ("part", "values", "told"),
    [
        ("sledge", {"edge_angle": np.radians(90.0)}, "the edge angle is 90; allowed is from -85 to 85 degrees"),
        ("sledge", {"edge_angle": np.nan}, "the edge angle is nan"),
        ("sledge", {"stance_width": 0.05}, "the ski giant-slalom is 0.11 m wide"),
        ("sledge", {"mass": 0.0}, "mass is 0.0"),
        ("solver", {"step": 1.0}, "the first step is 1000; allowed is from 0.001 to 5 ms"),
        ("solver", {"tolerance": 0.0}, "the tolerance is 0"),
        ("solver", {"output_interval": 0.0}, "the output interval is 0"),
        ("contact", {"unloading_ratio": 0.5}, "the unloading ratio k_u/H_V is 0.5"),
        ("contact", {"friction": -0.01}, "the friction at rest is -0.01"),
        ("contact", {"friction_by_speed": -0.01}, "below 0 it would drive the ski"),
        ("air", {"drag_area": -1.0}, "the drag area is -1"),
        ("air", {"density": np.inf}, "the air's density is inf"),
        ("start", {"speed": -1.0}, "the start's speed is -1"),
        ("stop", {"duration": 0.0}, "the run's duration is 0"),
        ("stop", {"length": np.nan}, "the run's length is nan"),
    ],
)
def test_part_out_of_its_limits_is_refused(part: str, values: dict[str, Any], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        changed(part, **values)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"gravity": 0.0}, "gravity is 0"),
        ({"damping_ratio": 2.0}, "the damping ratio is 2"),
        ({"clamp_length": -0.1}, "the clamp length is -0.1 m"),
        ({"clamp_length": 1.8}, "allows less than 1.71 m"),
        ({"slope": Profile(np.arange(1.0, 5.0), np.zeros(4))}, "x = 0 m, is off the profile"),
    ],
)
def test_scenario_out_of_its_limits_is_refused(values: dict[str, Any], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        replace(read_scenario("carved-46m"), **values)


def test_limits_themselves_are_allowed() -> None:
    assert changed("solver", step=5e-3).solver.step == 5e-3
    assert changed("sledge", stance_width=0.11).sledge.stance_width == 0.11
    assert changed("sledge", edge_angle=-np.radians(85.0)).sledge.edge_angle < 0.0
