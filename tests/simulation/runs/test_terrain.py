"""Runs over a grid of heights: a tilted plane is the plane, and energy is kept over rollers and along a bank."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from skisnow import Run
from skisnow.scenario import Plane, Terrain, load_scenario
from skisnow.simulation.simulated_run import simulate

FloatArray = npt.NDArray[np.float64]

PLAIN = """\
[slope]
kind = "grid"
grid = "heights.csv"
[snow]
H_V_N_per_mm3 = 0.2
S_f_N_per_mm2 = 0.5
unloading_ratio = 10.0
[friction]
mu_0 = 0.01
[drag]
drag_area_m2 = 0.42
[sledge]
mass_kg = 80.0
inertia_kg_m2 = [6.0, 8.0, 10.0]
centre_of_mass_height_m = 0.12
stance_width_m = 0.50
edge_angle_deg = 30.0
[ski]
name = "giant-slalom"
[start]
speed_m_per_s = 7.0
heading_deg = {heading!r}
[run]
duration_s = 1.0
"""
"""carved-46m, but for its slope."""


def write_heights(path: Path, x: FloatArray, y: FloatArray, height: FloatArray) -> None:
    """Rows from the last place to the first: their order does not count."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        rows = csv.writer(stream)
        rows.writerow(["x_m", "y_m", "z_m"])
        rows.writerows(
            map(repr, (float(x[i]), float(y[j]), float(height[i, j]))) for i, j in list(np.ndindex(height.shape))[::-1]
        )


@pytest.fixture(scope="module")
def on_plane() -> Run:
    return simulate(load_scenario("carved-46m", changes={"run.duration_s": 1.0}))


@pytest.mark.parametrize("turned_deg", [0.0, 35.0])
def test_tilted_plane_as_a_grid_gives_the_run_of_the_plane(tmp_path: Path, on_plane: Run, turned_deg: float) -> None:
    """With the fall line along x, and turned by 35 degrees to the left of it: the same run in other coordinates.

    A metre of the run is 2e-16 m in the last digit, the snow is met thousands of times: 1e-12 m is what is left.
    """
    slope = on_plane.scenario.slope
    assert isinstance(slope, Plane)
    fall = math.tan(slope.angle)
    direction = np.array([math.cos(math.radians(turned_deg)), math.sin(math.radians(turned_deg))])
    x, y = np.linspace(-3.0, 12.0, 16), np.linspace(-12.0, 12.0, 13)
    write_heights(tmp_path / "heights.csv", x, y, -fall * np.add.outer(x * direction[0], y * direction[1]))

    down = np.array([*direction, -fall]) * math.cos(slope.angle)  # of space in the slope's own axes, each a row
    out = np.array([fall * direction[0], fall * direction[1], 1.0]) * math.cos(slope.angle)
    axes = np.stack([down, np.cross(out, down), out])
    towards_x = np.array([1.0, 0.0, -fall * direction[0]])
    of_fall_line = math.atan2(down @ np.cross(out, towards_x), down @ towards_x)
    file = tmp_path / "turn.toml"
    file.write_text(PLAIN.format(heading=-30.0 + math.degrees(of_fall_line)), encoding="utf-8")

    run = simulate(load_scenario(file))
    assert run.time[-1] == 1.0
    np.testing.assert_allclose(run.place, on_plane.place @ axes, atol=1e-9)
    np.testing.assert_allclose(run.skis.depth, on_plane.skis.depth, atol=1e-9)
    np.testing.assert_allclose(run.heading - of_fall_line, on_plane.heading, atol=1e-9)


def pipe(x: FloatArray, y: FloatArray) -> FloatArray:
    """Waves 14 m long down the slope, and sides that rise like those of a half-pipe."""
    return np.asarray(-0.15 * x + 0.25 * np.cos(2.0 * np.pi * x / 14.0) + 0.02 * y**2)


def run_in_pipe(changes: dict[str, float]) -> Run:
    x, y = np.arange(0.0, 40.0, 0.5), np.arange(-8.0, 8.5, 0.5)
    given = {"start.x_m": 3.0, "start.speed_m_per_s": 6.0, "friction.mu_0": 0.0, "drag.drag_area_m2": 0.0}
    terrain = Terrain(x, y, pipe(x[:, None], y[None, :]))
    run = simulate(load_scenario("carved-46m", changes=given | changes).with_(slope=terrain))
    assert run.outcome == "finished"
    np.testing.assert_allclose(run.place[:, 2], pipe(run.place[:, 0], run.place[:, 1]), atol=0.04)  # on the snow
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < 2e-3
    return run


@pytest.mark.slow
def test_without_loss_speed_is_height_over_rollers() -> None:
    """Along the bottom of the pipe, on elastic snow, without friction and drag: v² = v₀² + 2 g (z₀ - z).

    Beside it there are a bounce on the snow's springs, and the pitch of the sledge: some joules of 1500.
    """
    straight = {"start.heading_deg": 0.0, "sledge.edge_angle_deg": 0.0, "run.duration_s": 2.0}
    run = run_in_pipe(straight | {"snow.unloading_ratio": 1.0})
    assert np.abs(run.place[:, 1]).max() < 1e-6
    assert np.ptp(run.place[:, 2]) > 1.5
    by_height = run.speed[0] ** 2 + 2.0 * 9.81 * (run.place[0, 2] - run.place[:, 2])
    np.testing.assert_allclose(run.speed, np.sqrt(by_height), atol=0.05)
    assert run.speed[-1] == pytest.approx(math.sqrt(by_height[-1]), abs=0.02)


def test_energy_closes_along_a_bank() -> None:
    """Across the pipe and up its side in plastic snow, edges at work: what is lost is counted, the rest is there."""
    run = run_in_pipe(
        {"start.y_m": 2.0, "start.heading_deg": 25.0, "sledge.edge_angle_deg": 8.0, "run.duration_s": 1.0}
    )
    assert run.place[-1, 1] > 3.5
    assert run.energies["penetration"][-1] > 1.0


@pytest.mark.parametrize(
    ("heading_deg", "x_m", "y_m"), [(0.0, 5.0, 0.0), (80.0, 0.0, 1.0), (-80.0, 0.0, -1.0), (170.0, -1.0, 0.0)]
)
def test_each_border_of_a_grid_ends_the_run(heading_deg: float, x_m: float, y_m: float) -> None:
    x, y = np.linspace(-3.0, 7.0, 11), np.linspace(-3.0, 3.0, 7)
    height = np.repeat(-0.02 * x[:, None], len(y), axis=1)
    changes = {"start.x_m": x_m, "start.y_m": y_m, "start.heading_deg": heading_deg, "run.duration_s": 1.0}
    flat = {"sledge.edge_angle_deg": 0.0, "solver.method": "fast"}
    run = simulate(load_scenario("carved-46m", changes=changes | flat).with_(slope=Terrain(x, y, height)))
    assert run.outcome == "end_of_slope"
    assert 0.05 < run.simulated_s < 0.4
