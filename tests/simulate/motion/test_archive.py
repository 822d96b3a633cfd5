"""A second pass meets the groove of the first, whatever the angle between them."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.archive import Archive, grown, leave_line, look_ahead, new_archive
from skisnow.simulate.motion.lines import (
    DEPTH,
    EDGE,
    FALL,
    HIGH,
    KEPT,
    LOST,
    LOW,
    TOUCHED,
    WINDOW,
    Lines,
    begin_line,
    cells_of,
    energy_left,
    new_lines,
    open_window,
)
from skisnow.simulate.motion.path import press

from .flight import NO_SNOW

FloatArray = npt.NDArray[np.float64]
H, EXCESS = 2e8, 8e8
SPACING, CELL = 0.02, 2e-3
DEPTH_AT_MIDDLE, SLOPE, HALF = 5e-3, 0.1, 0.021
"""Of the older groove: it deepens to the left."""
ORIGIN = np.array([7.3, -4.1, 0.0])


def frame_at(place: FloatArray, heading: float) -> FloatArray:
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    return np.concatenate([place, ahead, np.cross([0.0, 0.0, 1.0], ahead), [0.0, 0.0, 1.0]])


def first_pass(heading: float, drift: float = 0.0) -> tuple[Archive, Lines]:
    """A straight groove that goes `drift` aside of the heading for each metre ahead, archived line by line."""
    archive, lines = new_archive(200, 20000), new_lines(1, spacing=SPACING, cell=CELL)
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    archive.course[1] = 9.0 * (ahead + drift * np.cross([0.0, 0.0, 1.0], ahead))
    for number in range(-40, 41):
        aside = drift * number * SPACING
        begin_line(lines, 0, frame_at(ORIGIN + number * SPACING * ahead, heading))
        open_window(lines, 0, math.floor(aside / CELL) - 32)
        given = ((LOW, aside - HALF), (HIGH, aside + HALF), (EDGE, aside), (DEPTH, DEPTH_AT_MIDDLE), (FALL, SLOPE))
        for column, value in given:
            lines.value[0, column] = value
        lines.flag[0, TOUCHED], lines.count[0] = 1, 1
        press(NO_SNOW, lines, archive)
        leave_line(archive, lines, 0, H, EXCESS)
    return archive, lines


@pytest.mark.parametrize("heading", [0.0, -0.5, 2.5])
@pytest.mark.parametrize("angle", [0.0, 0.3, -0.7, 1.2, math.pi])
@pytest.mark.parametrize("drift", [0.0, 0.4, -0.8])
def test_older_groove_is_recalled(heading: float, angle: float, drift: float) -> None:
    """Also where the ski skidded, between its lines too."""
    archive, lines = first_pass(heading, drift)
    lost = float(archive.lost[0])
    begin_line(lines, 0, frame_at(ORIGIN + np.array([0.004, -0.003, 0.0]), heading + angle))
    look_ahead(archive, lines, 0, H, EXCESS)
    assert lines.flag[0, KEPT] == 1
    ahead, left = frame_at(ORIGIN, heading)[3:5], frame_at(ORIGIN, heading)[6:8]
    frame, met = lines.frame[0], 0
    for j in range(lines.flag[0, WINDOW], lines.flag[0, WINDOW] + 64):
        place = frame[:2] + (j + 0.5) * CELL * frame[6:8]
        across = float((place - ORIGIN[:2]) @ (left - drift * ahead))
        deepest, low, high = cells_of(lines, 0)[:3, j - lines.flag[0, WINDOW]]
        if abs(across) < HALF - 1e-6:
            met += 1
            assert deepest == pytest.approx(DEPTH_AT_MIDDLE + SLOPE * across, abs=1e-9)  # single precision of 5 mm
            assert (low, high) == (j * CELL, (j + 1) * CELL)
        elif abs(across) > HALF + 1e-6:
            assert high < low
    assert met >= (2.0 * HALF / CELL - 2.0) / (1.0 + abs(drift))
    # its energy was counted when the first pass left it
    assert lines.value[0, LOST] == pytest.approx(energy_left(lines, 0, -32, 32, H, EXCESS), rel=1e-12)
    leave_line(archive, lines, 0, H, EXCESS)
    assert archive.lost[0] == pytest.approx(lost, rel=1e-9)


@pytest.mark.parametrize("step", [0.2e-3, 1.1e-3, 7e-3])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_ground_that_an_edge_swept_is_flat(step: float, way: float) -> None:
    """As deep as the edge when it passed, whatever the steps; within a cell no deeper along the base."""
    archive, lines = new_archive(200, 20000), new_lines(1, spacing=SPACING, cell=CELL)
    begin_line(lines, 0, frame_at(ORIGIN, 0.0))
    for edge in np.arange(0.0, 0.03, step):
        low, high = sorted((edge, edge + 4e-3))
        low, high = (low, high) if way > 0.0 else (-high, -low)
        given = ((LOW, low), (HIGH, high), (EDGE, way * edge), (DEPTH, 4e-3), (FALL, -way))
        for column, value in given:
            lines.value[0, column] = value
        lines.flag[0, TOUCHED], lines.count[0] = 1, 1
        press(NO_SNOW, lines, archive)
    leave_line(archive, lines, 0, H, EXCESS)
    begin_line(lines, 0, frame_at(ORIGIN + np.array([0.003, 0.0004, 0.0]), 0.0))
    look_ahead(archive, lines, 0, H, EXCESS)
    first = int(lines.flag[0, WINDOW])
    for j in range(1, 11) if way > 0.0 else range(-11, -1):
        assert cells_of(lines, 0)[0, j - first] == pytest.approx(4e-3, abs=1e-9)


def test_energy_of_the_first_pass() -> None:
    """½ H ε² (1 - H/k_u) per area of 81 lines."""
    archive, _ = first_pass(0.3)
    square = DEPTH_AT_MIDDLE**2 + SLOPE**2 * HALF**2 / 3.0
    known = 0.5 * H * EXCESS / (H + EXCESS) * square * 2.0 * HALF * 81 * SPACING
    assert archive.lost[0] == pytest.approx(known, rel=1e-9)


def test_beside_and_beyond_there_is_nothing() -> None:
    archive, lines = first_pass(0.3)
    left = np.array([-math.sin(0.3), math.cos(0.3), 0.0])
    for place in (ORIGIN + 0.3 * left, ORIGIN + np.array([1.2, 0.4, 0.0]), ORIGIN + np.array([50.0, 0.0, 0.0])):
        begin_line(lines, 0, frame_at(place, 0.3))
        look_ahead(archive, lines, 0, H, EXCESS)
        assert lines.flag[0, KEPT] == 0


def test_growing_keeps_everything() -> None:
    archive, lines = first_pass(0.3)
    larger = grown(archive, 400, 50000)
    assert len(larger.cell) == 400
    for of in (archive, larger):
        begin_line(lines, 0, frame_at(ORIGIN, 0.9))
        look_ahead(of, lines, 0, H, EXCESS)
        if of is archive:
            kept = lines.cells[0].copy()
    assert np.array_equal(lines.cells[0], kept)
    assert larger.lost[0] == archive.lost[0]
    assert np.array_equal(larger.used, archive.used)
