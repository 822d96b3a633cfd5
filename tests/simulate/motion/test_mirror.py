"""Left and right are alike: forces, what the snow remembers, what is put away. Nothing is counted from one side."""

from __future__ import annotations

import copy
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.judge.run_record import Record
from skisnow.simulate.judge.run_setup import Setup, set_up
from skisnow.simulate.motion.archive import new_archive, put_away
from skisnow.simulate.motion.forces import Forces, feel, new_forces
from skisnow.simulate.motion.lines import (
    ANCHOR,
    CELL,
    CELLS,
    DEPTH,
    EDGE,
    EDGE_ABOVE,
    EDGE_MARKED,
    FALL,
    HIGH,
    KEPT,
    LOW,
    SLOPE,
    WINDOW,
    Lines,
    begin_line,
    cells_of,
    new_lines,
    open_window,
)
from skisnow.simulate.motion.model import PADDING, State
from skisnow.simulate.motion.path import press
from skisnow.simulate.scenario import read_scenario

FloatArray = npt.NDArray[np.float64]
SIDE = np.array([1.0, -1.0, 1.0])
SIX = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
"""Signs of a force and a moment, or a velocity and a turning, in the mirror of the plane y = 0."""
SITUATIONS: Mapping[str, Mapping[str, object]] = {
    "carves": {},
    "skids": {"snow.S_f_N_per_mm2": 0.05, "start.heading_deg": -70.0},
    "skids on ice": {"snow.H_V_N_per_mm3": 20.0, "snow.S_f_N_per_mm2": 0.3},
    "hardly edged": {"sledge.edge_angle_deg": 1.0, "snow.S_f_N_per_mm2": 0.02},
    "steep": {"sledge.edge_angle_deg": 60.0},
}


def mirrored_lines(lines: Lines) -> Lines:
    """The other ski's lines: frames mirrored, cells in the other order."""
    other, ring = copy.deepcopy(lines), len(lines.flag) // 2
    rows = np.roll(np.arange(2 * ring), ring)
    frame, value, flag = lines.frame[rows], lines.value[rows], lines.flag[rows]
    frame[:, :3], frame[:, 3:6], frame[:, 9:] = frame[:, :3] * SIDE, frame[:, 3:6] * SIDE, frame[:, 9:] * SIDE
    frame[:, 6:9] *= -SIDE
    value[:, [LOW, HIGH]] = -value[:, [HIGH, LOW]]
    value[:, [SLOPE, ANCHOR, EDGE, FALL, EDGE_ABOVE, EDGE_MARKED]] *= -1.0
    flag[:, WINDOW] = -CELLS - flag[:, WINDOW]
    other.frame[:], other.value[:], other.flag[:] = frame, value, flag
    other.first[:], other.count[:] = lines.first[::-1], lines.count[::-1]
    for row in range(2 * ring):
        deepest, start, end, centre = cells_of(lines, int(rows[row]))[:, ::-1]
        cells_of(other, row)[:] = deepest, -end, -start, centre
    return other


def mirrored_state(state: State) -> State:
    other = copy.deepcopy(state)
    other.place[:], other.velocity[:] = state.place * SIDE, state.velocity * SIX
    other.turn[:] = state.turn * np.outer(SIDE, SIDE)
    for name in ("bend", "bend_rate"):
        turned = getattr(state, name)[::-1].copy()
        turned[:, PADDING + 2 : -PADDING : 3] *= -1.0
        getattr(other, name)[:] = turned
    return other


@pytest.fixture(scope="module", params=SITUATIONS)
def pair(request: pytest.FixtureRequest) -> tuple[Setup, Setup]:
    """A set-up under way, and the one that mirrors its edge angle."""
    changes = {"solver.fixed": True, "solver.elements": 12, "solver.line_spacing_mm": 24.0}
    given = {"sledge.edge_angle_deg": 30.0, **SITUATIONS[request.param], **changes}
    setup = set_up(read_scenario("carved-46m", changes=given))
    Record(setup).advance(np.array([0.03]))
    angle = "sledge.edge_angle_deg"
    return setup, set_up(read_scenario("carved-46m", changes={**given, angle: -float(str(given[angle]))}))


def felt(setup: Setup, lines: Lines, state: State) -> Forces:
    out = new_forces(len(setup.model.mass), len(lines.flag) // 2)
    feel(setup.model, setup.snow, lines, state, True, True, out)
    return out


def test_forces_and_memory(pair: tuple[Setup, Setup]) -> None:
    setup, other = pair
    lines, there = copy.deepcopy(setup.lines), mirrored_lines(setup.lines)
    one, two = felt(setup, lines, setup.memory.state), felt(other, there, mirrored_state(setup.memory.state))
    largest = float(np.abs(one.rigid).max())
    assert largest > 100.0
    assert two.rigid * SIX == pytest.approx(one.rigid, abs=1e-12 * largest)
    assert two.power == pytest.approx(one.power, rel=1e-9, abs=1e-9)
    signs = np.outer([1, 1, -1, -1, -1, 1], [1, 1, -1, -1, -1, 1])
    assert two.corner[::-1] * signs == pytest.approx(one.corner, rel=1e-9, abs=1e-12 * float(np.abs(one.corner).max()))
    press(setup.snow, lines, copy.deepcopy(setup.archive))
    press(other.snow, there, copy.deepcopy(setup.archive))
    known = mirrored_lines(lines)
    assert np.array_equal(there.flag, known.flag)
    kept = np.flatnonzero(known.flag[:, KEPT] == 1)
    assert there.value[kept][:, [CELL, EDGE, DEPTH, ANCHOR]] == pytest.approx(
        known.value[kept][:, [CELL, EDGE, DEPTH, ANCHOR]], abs=1e-13
    )
    for row in kept:
        assert cells_of(there, int(row)) == pytest.approx(cells_of(known, int(row)), abs=1e-12)


@pytest.mark.parametrize("covered", [1, 11, 12, 13, 24, 25, 37, 64])
def test_pieces_put_away(covered: int) -> None:
    """None is longer than 12 cm, none is missing, and from the right they are the same."""
    cut = []
    for start in (-40, 40 - covered):
        lines, archive = new_lines(1, spacing=0.02, cell=0.01), new_archive(100, 1000)
        begin_line(lines, 0, np.r_[np.zeros(3), np.eye(3).ravel()])
        open_window(lines, 0, -40 if start == -40 else 40 - CELLS)
        deepest, begin, end, _ = cells_of(lines, 0)
        at = start - int(lines.flag[0, WINDOW])
        number = start + np.arange(covered)
        deepest[at : at + covered], begin[at : at + covered] = 0.01, number * 0.01
        end[at : at + covered] = (number + 1) * 0.01
        first = int(lines.flag[0, WINDOW])
        put_away(archive, lines, 0, first, first + CELLS, 2e8, 8e8)
        cut.append(archive.start[: archive.used[0], :2].copy())
    left, right = cut
    assert left[:, 1].sum() == covered
    assert left[:, 1].max() <= 12
    assert np.array_equal(left[1:, 0], (left[:, 0] + left[:, 1])[:-1])
    assert np.array_equal(right[::-1, 1], left[:, 1])
    assert np.array_equal(-(right[::-1, 0] + right[::-1, 1]), left[:, 0])
