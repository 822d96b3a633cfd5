"""Total force of the snow on each ski, against sums that use nothing of its computation."""

from __future__ import annotations

import numpy as np
import pytest

import skisnow
from skisnow.scenario import Plane
from skisnow.simulation.run import Run

TURN = "carved-46m"
"""Edge angle 30°."""
SETTLED = slice(30, -5)
"""Moments after the start and before the end, where differences over time are accurate."""


def simulated(**changes: object) -> Run:
    return skisnow.simulate(skisnow.load_scenario(TURN, changes={"run.duration_s": 2.0} | changes))


@pytest.fixture(scope="module")
def turn() -> Run:
    return simulated()


def force_by_inertia(run: Run) -> np.ndarray:
    """Force on the boot, and mass of the ski times its acceleration without gravity (N), (n, 2, 3)."""
    slope, ski, boots = run.scenario.slope, run.scenario.ski, run.boots
    assert isinstance(slope, Plane)
    assert boots is not None
    gravity = run.scenario.gravity * np.array([np.sin(slope.angle), 0.0, -np.cos(slope.angle)])
    acceleration = np.gradient(np.gradient(boots.place, run.time, axis=0), run.time, axis=0)
    return np.asarray(boots.force + ski.mass * (acceleration - gravity))


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"sledge.edge_angle_deg": -30.0, "start.heading_deg": 30.0},
        {"friction.mu_0": 0.1, "friction.acts_on": "base-normal"},
        {"snow.S_f_N_per_mm2": 0.1},
    ],
    ids=["left", "right", "friction", "side-slip"],
)
def test_the_total_force_is_what_boot_and_inertia_take(changes: dict[str, object]) -> None:
    run = simulated(**changes)
    expected = force_by_inertia(run)[SETTLED]
    assert np.linalg.norm(run.skis.force[SETTLED] - expected, axis=2).max() < 4.0  # of 300 to 900 N
    assert run.skis.total_force[SETTLED] == pytest.approx(np.linalg.norm(expected, axis=2), abs=4.0)


def test_the_total_force_is_the_vector_of_normal_force_shear_and_friction(turn: Run) -> None:
    """Friction is 0.01 of the normal force. The edge line turns by 0.1 rad at most: cos 0.1 = 0.995."""
    skis = turn.skis
    normal, side = (
        np.trapezoid(each, -skis.station, axis=2) for each in (skis.force_per_length, skis.shear_per_length)
    )
    expected = np.sqrt(normal**2 + side**2 + (0.01 * normal) ** 2)
    assert skis.normal_force == pytest.approx(normal, rel=1e-3)
    assert skis.total_force[SETTLED] == pytest.approx(expected[SETTLED], rel=5e-3)
    assert np.median(skis.total_force / skis.normal_force) > 1.05
    assert np.all(skis.force[SETTLED][..., 2] == pytest.approx(skis.normal_force[SETTLED]))


def test_friction_is_along_the_ski_against_its_motion() -> None:
    """Flat skis straight down the fall line: no shear, and friction of a tenth of the normal force."""
    changes = {"sledge.edge_angle_deg": 0.0, "start.heading_deg": 0.0, "friction.mu_0": 0.1}
    run = simulated(**changes)
    share = run.skis.force[SETTLED] / run.skis.normal_force[SETTLED][..., None]
    assert share == pytest.approx(np.broadcast_to([-0.1, 0.0, 1.0], share.shape), abs=3e-3)


def test_the_thrust_of_a_cut_is_part_of_the_normal_force() -> None:
    """Cutting lifts the ski: nearly all of its normal force is the thrust at the edge."""
    run = simulated(**{"shear.law": "machining", "run.duration_s": 4.0})
    late = slice(len(run.time) // 2, -5)
    expected = force_by_inertia(run)[late]
    assert np.median(np.linalg.norm(run.skis.force[late] - expected, axis=2)) < 2.0  # of 600 N
    assert np.median(run.skis.normal_force[late, 1]) == pytest.approx(np.median(expected[:, 1, 2]), rel=0.01)
