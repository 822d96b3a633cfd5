"""Twenty gates on a slope as a watch measured it."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, simulate, time_gates

watched_slope: Any = importlib.import_module("watched_slope")


def test_a_profile_is_that_of_the_way(tmp_path: Path) -> None:
    """One that falls by a tenth from 100 m on, and not before."""
    day, profile = tmp_path / "day.csv", tmp_path / "profile.csv"
    lines = (f"1,{way},{50.0 - 0.1 * max(0.0, way - 100.0)}" for way in range(0, 400, 4))
    day.write_text("\n".join(["lap,dist_m,alt_m", *lines, "1,,5"]), encoding="utf-8")
    angles = watched_slope.write_profile(profile, 80.0, 200.0, day)
    assert angles[60:] == pytest.approx(np.degrees(np.arctan(0.1)), abs=0.01)
    assert 0.0 < angles[0] < 0.5
    x, y = np.loadtxt(profile, delimiter=",", skiprows=1).T
    assert (x[0], x[-1]) == (-20.0, 229.0)
    assert y[0] - y[-1] == pytest.approx(0.1 * 209.0, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "begins", "length"),
    [
        ("slalom-20-gates", 4420.0, 203.0),
        ("slalom-20-gates", 11710.0, 203.0),
        pytest.param(
            "giant-slalom-20-gates",
            11600.0,
            477.0,
            marks=pytest.mark.xfail(reason="the skier straddles a gate of the giant slalom on 12 degrees", strict=True),
        ),
    ],
)
def test_twenty_gates_on_a_measured_profile(tmp_path: Path, name: str, begins: float, length: float) -> None:
    if not watched_slope.DAY.exists():
        pytest.skip("the shared tracks are not beside this repository")
    profile = tmp_path / "profile.csv"
    watched_slope.write_profile(profile, begins, length)
    changes = {"slope.kind": "profile", "slope.profile": str(profile), "solver.method": "fast"}
    run = simulate(load_scenario(name, changes=changes))
    assert run.outcome == "finished"
    course = run.scenario.course
    assert course is not None
    assert [each.outcome for each in time_gates(course, run).passages] == 20 * ["passed"]
    assert run.energy_balance_error == pytest.approx(0.0, abs=1e-3)
