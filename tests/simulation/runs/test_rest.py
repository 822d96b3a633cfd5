"""A flat ski on a slope that its friction holds: it stays, or comes to rest and then stays."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import Run
from skisnow.contact.snow_field import STICK_DISPLACEMENT
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate

from .sledges import GRAVITY, load, total_mass


def flat(*, friction: float, speed: float, duration: float) -> Run:
    changes = {
        "slope.angle_deg": 2.0,
        "friction.mu_0": friction,
        "drag.drag_area_m2": 0.0,
        "start.speed_m_per_s": speed,
        "start.heading_deg": 0.0,
        "sledge.edge_angle_deg": 0.0,
        "run.duration_s": duration,
    }
    scenario = load_scenario("carved-46m", changes=changes)
    return simulate(scenario.with_(solver=Solver(output_interval=0.05)))


def test_friction_holds_a_ski_at_rest() -> None:
    """It gives by a part of the stick displacement, swings about it, and stands; that energy is counted."""
    run = flat(friction=0.05, speed=0.0, duration=5.0)
    assert run.outcome == "finished"
    assert np.abs(run.place - run.place[0]).max() < 0.1e-3
    share = math.tan(math.radians(2.0)) / 0.05  # of the friction in use
    assert run.place[-1, 0] - run.place[0, 0] == pytest.approx(share * STICK_DISPLACEMENT, rel=0.8)
    assert run.speed[-1] < 1e-9
    held = 0.5 * 0.05 * load(run.scenario) * STICK_DISPLACEMENT * share**2
    assert np.abs(run.energy_residual).max() < 0.3 * held


def test_a_ski_comes_to_rest_and_stays() -> None:
    """From 2 m/s over v²/(2 g (μ cos α - sin α)), less what the snow takes else; then it does not creep."""
    run = flat(friction=0.1, speed=2.0, duration=5.0)
    slope = math.radians(2.0)
    way = run.place[-1, 0] - run.place[0, 0]
    to_snow = run.energies["penetration"][-1] + run.energies["shear"][-1]  # groove, and what the tail pushes aside
    lost = to_snow / (total_mass(run.scenario) * GRAVITY)
    braking = 0.1 * math.cos(slope) - math.sin(slope)
    assert way == pytest.approx((2.0**2 / (2.0 * GRAVITY) - lost) / braking, rel=1e-3)
    assert run.energies["friction"][-1] == pytest.approx(0.1 * load(run.scenario) * way, rel=1e-3)
    stopped = run.time > 4.0
    assert np.ptp(run.place[stopped, 0]) < 1e-6
    assert run.speed[-1] < 1e-9
