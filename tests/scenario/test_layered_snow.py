"""Layers of snow in a scenario: their law, what they contradict, and a run on equal layers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, simulate
from skisnow._support.errors import ParameterError
from skisnow.forces.penetration import LayeredPoint
from tests.coded import raises

LAYERS = {"snow.layer_depth_mm": 5, "snow.lower_H_V_N_per_mm3": 2}


def test_the_law_of_the_keys() -> None:
    law = load_scenario("carved-46m", changes=LAYERS | {"snow.hardness_growth_per_mm": 0.02}).contact.penetration
    assert isinstance(law, LayeredPoint)
    assert (law.layer_depth, law.lower_hardness, law.hardness_growth) == pytest.approx((5e-3, 2e9, 20.0))
    assert law.snow_hardness == load_scenario("carved-46m").contact.snow.snow_hardness
    assert load_scenario("carved-46m").contact.penetration is None


@pytest.mark.parametrize(
    "changes",
    [
        {"snow.layer_depth_mm": 5},
        {"snow.lower_H_V_N_per_mm3": 2},
        LAYERS | {"snow.damping_N_s_per_mm3": 0.01},
        LAYERS | {"snow.delayed_share": 0.1},
    ],
)
def test_contradictions(changes: dict[str, Any]) -> None:
    with raises(ParameterError, "contradiction"):
        load_scenario("carved-46m", changes=changes)


def test_a_run_on_equal_layers_is_that_on_one() -> None:
    short = {"run.duration_s": 0.3, "solver.method": "fast"}
    one = load_scenario("carved-46m", changes=short)
    hardness = one.contact.snow.snow_hardness / 1e9
    layers = {"snow.layer_depth_mm": 2, "snow.lower_H_V_N_per_mm3": hardness}
    two = load_scenario("carved-46m", changes=short | layers)
    found, expected = simulate(two), simulate(one)
    np.testing.assert_allclose(found.place, expected.place, atol=1e-6)
