"""Runs over measured heights, and runs whose boots move: where snow and skis are drawn."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow.geometry.vectors import axes_of
from skisnow.replay import Replay, replay_bytes, replay_of_file, replay_of_run
from skisnow.replay.page import _arrays_by_name as arrays_by_name
from skisnow.scenario import Terrain, read_terrain
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Run
from skisnow.track.course import Course, Gate
from tests.present import present

from ..report.runs import circle_run
from .held import ski_edges, snow_heights, unpacked
from .test_of_run import written

X, Y = np.arange(-6.0, 31.0, 1.0), np.arange(-20.0, 21.0, 1.0)


def hills(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height (m): down 20 %, with waves of 30 cm."""
    return -0.2 * x + 0.05 * y + 0.3 * np.sin(x / 4.0) * np.cos(y / 5.0)


def over(height: np.ndarray, **changes: object) -> Run:
    run = circle_run(count=5)
    return replace(run, scenario=replace(run.scenario, slope=Terrain(X, Y, height)), **changes)  # type: ignore[arg-type]


def run_with_boots() -> Run:
    """Boots that stand 10 cm farther out than the sledge has them, with separate angles that grow."""
    run = circle_run(count=5)
    angles = np.linspace(0.1, 0.5, 5)[:, None] * np.array([1.0, -0.5])
    axes = np.array([[axes_of(angle, 0.05, 0.2 + angle) for angle in pair] for pair in angles])
    place = run.place[:, None] + np.array([[0.0, 0.35, 0.02], [0.1, -0.35, 0.0]])
    zeros = np.zeros((5, 2, 3))
    boots = BootHistory(place=place, axes=axes, own_force=zeros, own_moment=zeros, centre_of_mass=place.mean(axis=1))
    return replace(run, boots=boots, boots_by="moved by a table")


def test_a_tilted_plane_as_a_grid_is_that_plane_everywhere_and_heights_are_those_that_the_skis_run_on() -> None:
    plane = -0.2 * X[:, None] + 0.05 * Y
    shown = present(replay_of_run(over(plane)).terrain)
    assert shown.grade == pytest.approx((-0.2, 0.05), abs=1e-12)
    for x, y in ((3.21, 4.4), (-300.0, 7.0), (500.0, -900.0)):
        assert float(snow_heights(shown, x, y)) == pytest.approx(-0.2 * x + 0.05 * y, abs=1e-9)
    run = over(hills(X[:, None], Y))
    terrain = present(replay_of_run(run).terrain)
    x, y = np.random.default_rng(1).uniform((-4.0, -10.0), (25.0, 10.0), (200, 2)).T
    apart = snow_heights(terrain, x, y) - run.scenario.slope.surface.heights(x, y)  # type: ignore[union-attr]
    # straight over half a metre: 0.3 m (1/4² + 1/5²) 0.5² / 8 = 1 mm, the patches' bends at the places besides
    assert np.abs(apart).max() < 2e-3
    assert max(terrain.x[0], terrain.y[0]) < run.place[:, :2].min() - 29.0


def test_a_long_run_has_no_more_places_than_a_screen_needs() -> None:
    run = over(hills(X[:, None], Y))
    far = present(replay_of_run(replace(run, place=run.place * 60.0)).terrain)
    assert 30_000 < far.height.size < 45_000


def test_gates_of_the_course_stand_on_the_snow() -> None:
    gates = tuple(Gate(name=str(i), turning=place, side="left") for i, place in enumerate([(4.0, 2.0), (9.0, -1.0)]))
    run = over(hills(X[:, None], Y))
    run = replace(run, scenario=replace(run.scenario, course=Course(gates=gates)))
    found = present(replay_of_run(run).gates)
    assert found[:, :2].tolist() == [[4.0, 2.0], [9.0, -1.0]]
    assert found[:, 2] == pytest.approx(run.scenario.slope.surface.heights([4.0, 9.0], [2.0, -1.0]))  # type: ignore[union-attr]


def test_skis_are_where_their_boots_have_them() -> None:
    """By hand: the middle of a flat ski's base goes from the boot along its own axis ahead."""
    run = run_with_boots()
    skis = replace(run.skis, bending=0.0 * run.skis.bending, twist=0.0 * run.skis.twist)
    replay = replay_of_run(replace(run, skis=skis))
    for frame in (0, 3):
        edges = ski_edges(replay, frame)
        for ski in (0, 1):
            ahead, left, off = present(run.boots).axes[frame, ski]
            middle = present(run.boots).place[frame, ski] + replay.skis.station[:, None] * ahead
            middle = middle + replay.skis.base_height[:, None] * off
            assert edges[ski].mean(axis=1) == pytest.approx(middle, abs=1e-12)
            across = edges[ski, :, 0] - edges[ski, :, 1]
            assert across == pytest.approx(2.0 * replay.skis.half_width[:, None] * left, abs=1e-12)


def same(one: Replay, other: Replay) -> None:
    for frame in range(len(one.time)):
        assert ski_edges(one, frame) == pytest.approx(ski_edges(other, frame), abs=2e-5)
    assert (one.terrain is None) == (other.terrain is None)
    if one.terrain is not None and other.terrain is not None:
        assert one.terrain.height == pytest.approx(other.terrain.height, abs=1e-5)
        assert one.terrain.grade == other.terrain.grade


@pytest.mark.parametrize("run", [over(hills(X[:, None], Y)), run_with_boots()], ids=["terrain", "boots"])
def test_bytes_hold_both(run: Run) -> None:
    replay = replay_of_run(run)
    head, back = unpacked(replay_bytes(replay))
    for name, values in arrays_by_name(replay).items():
        assert back[name] == pytest.approx(values, abs=1.001 * head["arrays"][name]["error"] + 1e-12, nan_ok=True), name
    assert {"terrain_height", "boot_place"} & back.keys()


def test_files_hold_both(tmp_path: Path) -> None:
    places = np.stack(np.meshgrid(X, Y, indexing="ij"), axis=-1).reshape(-1, 2)
    table = "\n".join(f"{x},{y},{z}" for (x, y), z in zip(places, hills(*places.T), strict=True))
    (tmp_path / "heights.csv").write_text(f"x_m,y_m,z_m\n{table}\n", encoding="utf-8")
    run = replace(run_with_boots(), scenario=over(hills(X[:, None], Y)).scenario)
    folder = tmp_path / "run"
    folder.mkdir()
    written(run, folder, **{"slope.kind": "grid", "slope.grid": str(tmp_path / "heights.csv")})
    same(replay_of_file(folder), replay_of_run(run))
    written(run, folder, **{"slope.kind": "grid", "slope.grid": str(tmp_path / "heights.csv"), "slope.smooth_m": 9.0})
    smooth = read_terrain(tmp_path / "heights.csv", smoothing=9.0)
    same(replay_of_file(folder), replay_of_run(replace(run, scenario=replace(run.scenario, slope=smooth))))
