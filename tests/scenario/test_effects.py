"""Every number of a scenario changes the run, or is rejected."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from skisnow import Run, load_scenario, simulate
from skisnow._support.errors import ParameterError, RangeWarning
from skisnow.parameters import Quantity
from skisnow.scenario import scenario_values
from skisnow.scenario.keys import SCENARIO_KEYS

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
        return max(key.lowest, 0.0) + (20 if key.kind == "whole number" else 0.01)
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
