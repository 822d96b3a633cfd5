"""A scenario that is built in Python holds to the same limits as one from a file."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import Profile, Scenario, load_scenario


def changed(part: str, **values: Any) -> Scenario:
    scenario = load_scenario("carved-46m")
    return replace(scenario, **{part: replace(getattr(scenario, part), **values)})


@pytest.mark.parametrize(
    ("part", "values", "told"),
    [
        ("sledge", {"edge_angle": np.radians(90.0)}, "edge_angle_deg is 90.0; allowed is from -85 to 85 °"),
        ("sledge", {"edge_angle": np.nan}, "edge_angle_deg is nan"),
        ("sledge", {"stance_width": 0.05}, "the ski giant-slalom is 0.11 m wide"),
        ("sledge", {"mass": 0.0}, "mass_kg is 0.0"),
        ("solver", {"step": 1.0}, "step_ms is 1000.0; allowed is from 0.001 to 5 ms"),
        ("solver", {"tolerance": 0.0}, "tolerance_mm is 0.0"),
        ("solver", {"output_interval": 0.0}, "output_ms is 0.0"),
        ("contact", {"unloading_ratio": 0.5}, "unloading_ratio is 0.5"),
        ("contact", {"friction": -0.01}, "mu_0 is -0.01"),
        ("contact", {"friction_by_speed": -0.01}, "below 0 it would drive the ski"),
        ("air", {"drag_area": -1.0}, "drag_area_m2 is -1"),
        ("air", {"density": np.inf}, "air_density_kg_per_m3 is inf"),
        ("start", {"speed": -1.0}, "speed_m_per_s is -1"),
        ("stop", {"duration": 0.0}, "duration_s is 0"),
        ("stop", {"length": np.nan}, "length_m is nan"),
    ],
)
def test_part_out_of_its_limits_is_refused(part: str, values: dict[str, Any], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        changed(part, **values)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"gravity": 0.0}, "gravity_m_per_s2 is 0"),
        ({"damping_ratio": 2.0}, "damping_ratio is 2"),
        ({"clamp_length": -0.1}, "clamp_length_m is -0.1"),
        ({"clamp_length": 1.8}, "allows less than 1.71 m"),
        ({"slope": Profile(np.arange(1.0, 5.0), np.zeros(4))}, "x = 0 m, is off the slope"),
    ],
)
def test_scenario_out_of_its_limits_is_refused(values: dict[str, Any], told: str) -> None:
    with pytest.raises(ParameterError, match=told):
        replace(load_scenario("carved-46m"), **values)


def test_limits_themselves_are_allowed() -> None:
    assert changed("solver", step=5e-3).solver.step == 5e-3
    assert changed("sledge", stance_width=0.11).sledge.stance_width == 0.11
    assert changed("sledge", edge_angle=-np.radians(85.0)).sledge.edge_angle < 0.0
