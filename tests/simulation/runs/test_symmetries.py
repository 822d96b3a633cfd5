"""Changes that must not matter: the left side, the start, where a level slope's axes point, the last bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import Run
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

FIXED = {"solver.fixed": True, "solver.step_ms": 0.5, "run.output_ms": 50.0}
CARVES = {"sledge.edge_angle_deg": 30.0, "start.heading_deg": -30.0}
SKIDS = {**CARVES, "snow.S_f_N_per_mm2": 0.1, "snow.shear_displacement_mm": 0.5}
"""With the default of 0.02 mm a slipping edge trembles: a change of 1e-12 of an input moves this end by 0.1 to 3 mm."""


TREMBLES = pytest.mark.xfail(strict=True, reason="the end of a skid on ice moves by 8e-6 m")


def simulated(**changes: object) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


def mirrored(changes: dict[str, float]) -> dict[str, float]:
    turned = ("sledge.edge_angle_deg", "start.heading_deg", "start.y_m")
    return {key: -value if key in turned else value for key, value in changes.items()}


@pytest.mark.parametrize("changes", [CARVES, SKIDS], ids=["carves", "skids"])
def test_mirror(changes: dict[str, float]) -> None:
    """Left and right differ only by rounding; 1.5 s bring it to far less than 1e-9 m."""
    given = {**changes, "start.y_m": 1.5, "run.duration_s": 1.5}
    one, other = simulated(**given, **FIXED), simulated(**mirrored(given), **FIXED)
    assert other.place == pytest.approx(one.place * [1.0, -1.0, 1.0], abs=1e-9)
    assert other.heading == pytest.approx(-one.heading, abs=1e-9)
    assert other.turn_radius[2:-2] == pytest.approx(-one.turn_radius[2:-2], rel=1e-5)
    assert other.skis.edge_depth == pytest.approx(one.skis.edge_depth[:, ::-1], abs=1e-9)
    assert other.skis.shear_per_length == pytest.approx(-one.skis.shear_per_length[:, ::-1], abs=1e-2)
    for name, energy in one.energies.items():
        assert other.energies[name] == pytest.approx(energy, abs=1e-6), name


ICE = {"snow.H_V_N_per_mm3": 20.0, "snow.S_f_N_per_mm2": 0.3}
ACROSS = {"snow.S_f_N_per_mm2": 0.05, "sledge.edge_angle_deg": 10.0, "start.heading_deg": 80.0}


@pytest.mark.parametrize(
    ("changes", "duration"),
    [
        ({**CARVES, **ICE}, 0.3),
        ({**CARVES, **ICE}, 0.5e-3),
        ({**CARVES, "snow.S_f_N_per_mm2": 0.02}, 1.0),
        (ACROSS, 1.0),
    ],
)
def test_mirrored_skids(changes: dict[str, float], duration: float) -> None:
    """Windows of cells, pieces of older tracks and the order of the skis are the same from both sides."""
    given = {**changes, "run.duration_s": duration}
    one, other = simulated(**given, **FIXED), simulated(**mirrored(given), **FIXED)
    assert other.place == pytest.approx(one.place * [1.0, -1.0, 1.0], abs=1e-11)


@pytest.mark.parametrize("hardness", [0.03, 0.2])
def test_straight_down_stays_straight(hardness: float) -> None:
    """A knot closer than 1e-12 m to another is merged, perhaps on one side only: one edge is then so much deeper.

    A flat ski is nearly neutral. An edge angle of 1e-7 measures how far that carries it, hundreds of metres for each
    radian; the run may drift by that times 1e-12 m over half the width. An unstable run would swing by millimetres.
    """
    changes = {"start.heading_deg": 0.0, "snow.H_V_N_per_mm3": hardness, "run.duration_s": 1.0, **FIXED}
    flat, tilted = (simulated(**changes, **{"sledge.edge_angle_deg": math.degrees(each)}) for each in (0.0, 1e-7))
    growth = np.abs(tilted.place[:, 1]).max() / 1e-7
    assert 100.0 < growth < 1e4
    half_width = 0.5 * tilted.scenario.ski.width.min()
    assert np.abs(flat.place[:, 1]).max() < growth * 1e-12 / half_width


@pytest.mark.slow
@pytest.mark.parametrize("changes", [CARVES, SKIDS], ids=["carves", "skids"])
def test_mirror_of_the_whole_run(changes: dict[str, float]) -> None:
    """Five seconds with the error held: steps are chosen alike, the ends agree to 1e-6 m."""
    one, other = simulated(**changes), simulated(**mirrored(changes))
    assert other.place[-1] == pytest.approx(one.place[-1] * [1.0, -1.0, 1.0], abs=1e-6)
    assert other.steps == pytest.approx(one.steps, rel=0.01)


def test_start_elsewhere() -> None:
    """A plane is the same everywhere."""
    one = simulated(**{"run.duration_s": 1.0}, **FIXED)
    other = simulated(**{"run.duration_s": 1.0, "start.x_m": 13.7, "start.y_m": -8.2}, **FIXED)
    assert other.place == pytest.approx(one.place + np.array([13.7, -8.2, 0.0]), abs=1e-9)
    assert other.groove.depth == pytest.approx(one.groove.depth, abs=1e-8)


def test_level_slope_knows_no_direction() -> None:
    """Turned by 70° at the start, the whole track is turned by 70°."""
    level = {"slope.angle_deg": 0.0, "run.duration_s": 1.0}
    one = simulated(**level, **{"start.heading_deg": 0.0}, **FIXED)
    other = simulated(**level, **{"start.heading_deg": 70.0}, **FIXED)
    c, s = math.cos(math.radians(70.0)), math.sin(math.radians(70.0))
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    assert other.place == pytest.approx(one.place @ turn.T, abs=1e-9)
    assert other.heading == pytest.approx(one.heading + math.radians(70.0), abs=1e-9)
    assert one.place[-1, 1] > 0.5  # it does turn


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "value"),
    [("start.speed_m_per_s", 7.0), ("snow.H_V_N_per_mm3", 0.2), ("sledge.edge_angle_deg", 30.0), ("start.x_m", 1.0)],
)
@pytest.mark.parametrize("changes", [CARVES, SKIDS], ids=["carves", "skids"])
def test_rounding(key: str, value: float, changes: dict[str, float]) -> None:
    """A change of one input by 1e-12 of itself moves the end by less than a micrometre in five seconds."""
    one, other = (simulated(**{**changes, key: each}) for each in (value, value * (1.0 + 1e-12)))
    assert one.outcome == other.outcome == "finished"
    assert one.time[-1] == other.time[-1] == 5.0
    moved = float(np.linalg.norm(other.place[-1] - one.place[-1]))
    assert 0.0 < moved < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("failure_shear_stress", [10.0, pytest.param(0.3, marks=TREMBLES)])
def test_rounding_on_ice(failure_shear_stress: float) -> None:
    """Where edges tremble by micrometres: the deeper of two bases that lie equally deep is not chosen by rounding."""
    changes = {"snow.H_V_N_per_mm3": 90.0, "snow.S_f_N_per_mm2": failure_shear_stress, "run.duration_s": 3.0}
    one, other = (simulated(**changes, **{"start.speed_m_per_s": 7.0 * (1.0 + each)}) for each in (0.0, 1e-12))
    assert 0.0 < float(np.linalg.norm(other.place[-1] - one.place[-1])) < 1e-6


def test_twice_the_same_bits() -> None:
    one, other = (simulated(**{"run.duration_s": 0.5}) for _ in range(2))
    for name in ("time", "place", "attitude", "velocity", "turn_radius"):
        assert np.array_equal(getattr(one, name), getattr(other, name))
    for name in ("track", "edge_depth", "force_per_length", "shear_per_length", "bending", "twist"):
        assert np.array_equal(getattr(one.skis, name), getattr(other.skis, name))
    assert np.array_equal(one.groove.middle, other.groove.middle)
    assert np.array_equal(one.groove.depth, other.groove.depth)
    assert all(np.array_equal(one.energies[name], other.energies[name]) for name in one.energies)
    assert (one.steps, one.rejected_steps) == (other.steps, other.rejected_steps)
