"""Tracks of runs made without a simulation: straight down the fall line, in closed form."""

import sys
from types import ModuleType

import numpy as np
import pytest

from skisnow.scenario import load_scenario
from skisnow.track.track import Track

from ..simulation.straight_run import ASIDE, acceleration, straight_run

SCENARIO: dict[str, object] = {
    "start.heading_deg": 0.0,
    "friction.mu_0": 0.02,
    "drag.drag_area_m2": 0.0,
    "start.speed_m_per_s": 5.0,
    "run.duration_s": 1.0,
}
TRUE_FRICTION, TRUE_SPEED, SD = 0.06, 5.5, 0.02


def put(monkeypatch: pytest.MonkeyPatch) -> None:
    """Instead of the simulator, as far as this process goes."""
    module = ModuleType("skisnow.simulation.simulated_run")
    vars(module)["simulate"] = straight_run
    monkeypatch.setitem(sys.modules, "skisnow.simulation.simulated_run", module)


def track(
    *,
    seed: int | None = None,
    name: str = "one",
    stated: bool = True,
    points: int = 41,
    changes: dict[str, float] | None = None,
) -> Track:
    """Ten points a second; without a seed there is no noise."""
    truth = {"friction.mu_0": TRUE_FRICTION, "start.speed_m_per_s": TRUE_SPEED} | (changes or {})
    scenario = load_scenario("carved-46m", changes=SCENARIO | truth)
    time = np.asarray(0.1 * np.arange(points), dtype=np.float64)
    place = np.zeros((points, 3))
    place[:, 0] = scenario.start.x + scenario.start.speed * time + acceleration(scenario) * time**2 / 2.0
    place[:, 1] = scenario.start.y + ASIDE / 40
    if seed is not None:
        place[:, :2] += SD * np.random.default_rng(seed).standard_normal((points, 2))
    sd = np.full((points, 3), SD) if stated else None
    return Track(
        name=name, time=time, place=place, speed=np.full(points, np.nan), time_scale="local", frame="slope",
        place_sd=sd, axes="slope",
    )  # fmt: skip
