"""The slope under the lines, and where lines are laid."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.archive import new_archive
from skisnow.simulate.motion.lines import Lines, new_lines
from skisnow.simulate.motion.model import Snow, State, World, new_state
from skisnow.simulate.motion.path import AHEAD, MOST_UNEVEN, follow, lay_anew, surface
from skisnow.simulate.scenario import Profile

from .flight import NO_SNOW, free_model

FloatArray = npt.NDArray[np.float64]
SNOW: Snow = NO_SNOW
STEP = 0.02


@pytest.fixture(scope="module")
def profile() -> Profile:
    x = np.arange(0.0, 20.0, 0.5)
    return Profile(x, -0.2 * x + 0.3 * np.sin(x / 2.0))


@pytest.fixture(scope="module")
def hill(profile: Profile) -> World:
    x = np.arange(0.0, 19.5 + STEP / 2.0, STEP)
    heights = np.column_stack([profile.heights(x), profile.gradients(x)])
    return World(np.array([0.0, 0.0, -9.81]), 0.0, 0.0, 0.0, STEP, heights)


def test_surface_is_the_profile(profile: Profile, hill: World) -> None:
    """The profile's pieces begin at points of the table: its cubics are reproduced; beyond the ends straight on."""
    for x in np.random.default_rng(2).uniform(-1.0, 20.5, 200):
        height, gradient = surface(hill, float(x))
        assert height == pytest.approx(float(profile.heights(x)), abs=1e-12)
        assert gradient == pytest.approx(float(profile.gradients(x)), abs=1e-10)
    assert surface(hill._replace(heights=np.zeros((1, 2))), 3.0) == (0.0, 0.0)


def laid(world: World, state: State) -> Lines:
    """Lines under a sledge that has just come."""
    lines, archive = new_lines(256, spacing=0.02, cell=1e-3), new_archive(10, 100)
    follow(free_model(), SNOW, world, lines, archive, state)
    return lines


def under_axis(frame: FloatArray, state: State, boot: FloatArray) -> FloatArray:
    """Stations at which lines go through the plane that a ski's straight axis spans with the sledge's own upwards."""
    origin = (frame[:, :3] - state.place) @ state.turn - boot
    left = frame[:, 6:9] @ state.turn
    there = [
        np.linalg.solve(np.array([[1.0, -y[0]], [0.0, -y[1]]]), e[:2])[0] for e, y in zip(origin, left, strict=True)
    ]
    return np.array(there)


@pytest.mark.parametrize("pitch", [0.0, 0.35])
def test_lines_lie_on_the_slope_across_the_skis(profile: Profile, hill: World, pitch: float) -> None:
    """As far from each other along the skis as asked, also where the slope rises from a ski that points downwards."""
    model, heading = free_model(), 0.3
    state = new_state(len(model.mass))
    state.place[:] = 9.0, 2.0, float(profile.heights(9.0))
    c, s = math.cos(heading), math.sin(heading)
    down = np.array(
        [[math.cos(pitch), 0.0, math.sin(pitch)], [0.0, 1.0, 0.0], [-math.sin(pitch), 0.0, math.cos(pitch)]]
    )
    state.turn[:] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ down
    lines = laid(hill, state)
    for k in range(2):
        rows = k * 256 + (int(lines.first[k]) + np.arange(int(lines.count[k]))) % 256
        frame = lines.frame[rows]
        along = under_axis(frame, state, model.middle[k])
        assert along[0] < model.tail - AHEAD + 1e-9
        assert along[-1] > model.tip + AHEAD - 1e-9
        assert np.diff(along) == pytest.approx(np.full(len(along) - 1, 0.02), rel=1e-9)
        assert frame[:, 2] == pytest.approx(profile.heights(frame[:, 0]), abs=1e-12)
        for one in frame:
            ahead, left, out = one[3:6], one[6:9], one[9:12]
            assert np.column_stack([ahead, left, out]).T @ np.column_stack([ahead, left, out]) == pytest.approx(
                np.eye(3)
            )
            assert np.cross(ahead, left) == pytest.approx(out)
            gradient = float(profile.gradients(one[0]))
            assert out == pytest.approx(np.array([-gradient, 0.0, 1.0]) / math.hypot(1.0, gradient))
            # the skis' axis, pressed into the slope
            assert abs(float(np.cross(out, state.turn[:, 0]) @ ahead)) < 1e-12
            assert ahead @ state.turn[:, 0] > 0.9


def test_lines_stay_while_the_ski_goes_over_them(hill: World) -> None:
    """A metre ahead: those behind the tail are gone, those under the ski are where they were."""
    model = free_model()
    state = new_state(len(model.mass))
    state.place[:] = 9.0, 2.0, 0.0
    lines, archive = new_lines(256, spacing=0.02, cell=1e-3), new_archive(10, 100)
    follow(model, SNOW, hill, lines, archive, state)
    before = {tuple(lines.frame[(int(lines.first[0]) + c) % 256, :3]) for c in range(int(lines.count[0]))}
    for _ in range(20):
        state.place[0] += 0.05
        follow(model, SNOW, hill, lines, archive, state)
    now = [tuple(lines.frame[(int(lines.first[0]) + c) % 256, :3]) for c in range(int(lines.count[0]))]
    kept = [place for place in now if place in before]
    assert len(kept) == len([place for place in before if place[0] > min(now)[0] - 1e-9])
    assert min(now)[0] > 10.0 + model.tail - AHEAD - 0.1
    assert max(now)[0] > 10.0 + model.tip + AHEAD - 1e-9
    assert np.diff([place[0] for place in now]) == pytest.approx(np.full(len(now) - 1, 0.02), rel=1e-9)


@pytest.mark.parametrize("heading", [0.0, 1.2])
def test_lines_stay_even_under_a_ski_that_slips_sideways(hill: World, heading: float) -> None:
    """Ten metres aside and a metre ahead, turning by 3°: lines that crossed far off would count snow twice."""
    model, flat = free_model(), hill._replace(heights=np.zeros((1, 2)))
    state = new_state(len(model.mass))
    lines, archive = new_lines(256, spacing=0.02, cell=1e-3), new_archive(10, 100)
    for step in range(1000):
        c, s = math.cos(heading + 0.05 * math.sin(0.05 * step)), math.sin(heading + 0.05 * math.sin(0.05 * step))
        state.turn[:] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        state.place[:] += 0.001 * state.turn[:, 0] + 0.01 * state.turn[:, 1]
        lay_anew(model, SNOW, lines, archive, state)
        follow(model, SNOW, flat, lines, archive, state)
        for k in range(2):
            frame = lines.frame[k * 256 + (int(lines.first[k]) + np.arange(int(lines.count[k]))) % 256]
            along = under_axis(frame, state, model.middle[k])
            assert along[0] < model.tail - 0.1
            assert along[-1] > model.tip + 0.1
            # a line that has just been laid lies as far from the last as asked
            assert np.all(np.abs(np.diff(along) - 0.02) <= 1.1 * MOST_UNEVEN * 0.02)
