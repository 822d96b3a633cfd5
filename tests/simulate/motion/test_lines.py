"""The snow's memory on one line: pressure across, loading and unloading, marks, windows, coarser cells."""

from __future__ import annotations

import math

import numba
import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.archive import Archive, leave_line, make_room, new_archive

# isort: off
from skisnow.simulate.motion.columns import (
    COLUMNS, DEEP, EDGE_AT, EDGE_DEEP, FALLING, FORCE, MOMENT, PER_FALL, SHARE, SPRING, STIFF0, STIFF1, STIFF2,
    WATERLINE, WET_FROM, WET_TO, WIDTH,
)  # fmt: skip

# isort: on
from skisnow.simulate.motion.lines import (
    CELL,
    CELLS,
    DEPTH,
    EDGE,
    FALL,
    HIGH,
    KEPT,
    LOW,
    SLOPE,
    TOUCHED,
    WINDOW,
    Lines,
    begin_line,
    cells_of,
    energy_at_edge,
    energy_left,
    ground_cut,
    new_lines,
    open_window,
)
from skisnow.simulate.motion.path import press as press_lines
from skisnow.simulate.motion.pressure import bear, sum_cells

from .flight import NO_SNOW

FloatArray = npt.NDArray[np.float64]
H, K = 2e8, 1e9
"""Hardness, and k_u = 5 H_V (N/m³)."""
SPACING = 0.02
FRAME = np.concatenate([np.zeros(3), np.eye(3)[0], np.eye(3)[1], np.eye(3)[2]])


def one_line(*, cell: float = 1e-3) -> Lines:
    lines = new_lines(1, spacing=SPACING, cell=cell)
    begin_line(lines, 0, FRAME)
    open_window(lines, 0, -CELLS // 2)
    return lines


def press(lines: Lines, low: float, high: float, edge: float, depth: float, fall: float) -> None:
    """A base comes down on the line and stays in its memory."""
    for column, value in ((LOW, low), (HIGH, high), (EDGE, edge), (DEPTH, depth), (FALL, fall)):
        lines.value[0, column] = value
    lines.flag[0, TOUCHED], lines.count[0] = 1, 1
    press_lines(NO_SNOW, lines, new_archive(4, 400))


def sums_of(lines: Lines, low: float, high: float, depth: float, fall: float, edge: float) -> FloatArray:
    """The sums of a base from `low` to `high` across, places from the edge."""
    sheet, one = np.zeros(COLUMNS * WIDTH), np.uint64(0)
    per_fall = 1.0 / fall if fall != 0.0 else 1e12
    given = {WET_FROM: low, WET_TO: high, EDGE_DEEP: depth, FALLING: fall, EDGE_AT: edge, SHARE: 1.0, DEEP: 1.0}
    for column, value in {**given, PER_FALL: per_fall, WATERLINE: -depth * per_fall}.items():
        sheet[column] = value
    cell = lines.value[0, CELL]
    _sum_cells(sheet, one, lines.cells, one, lines.flag[0, WINDOW], cell, 1.0 / cell, K / H - 1.0)
    bear(np.uint64(1), H, K - H, sheet)
    return sheet[[FORCE, MOMENT, STIFF0, STIFF1, STIFF2, SPRING]]


@numba.njit()
def _sum_cells(
    sheet: FloatArray, i: np.uint64, cells: FloatArray, row: np.uint64, start: int, cell: float, per_cell: float,
    ratio: float,
) -> None:  # fmt: skip
    sum_cells(sheet, i, cells, row, start, cell, per_cell, ratio)


def quadrature(lines: Lines, low: float, high: float, depth: float, fall: float, edge: float) -> FloatArray:
    """The same by midpoints every 20 nm or so."""
    x = low + (high - low) * (np.arange(400_000) + 0.5) / 400_000
    cell, size = lines.value[0, CELL], CELLS
    number = np.floor((x + edge) / cell).astype(int)
    place = number - lines.flag[0, WINDOW]
    inside = (place >= 0) & (place < size)
    deepest_of, start_of, end_of, _ = cells_of(lines, 0)[:, np.where(inside, place, 0)]
    covered = inside & (end_of > start_of)  # a cell that a base has met in part counts as met all over
    now = depth + fall * x
    there = deepest_of + fall * (x + edge - (number + 0.5) * cell)
    deepest = np.where(covered & (there > now), there, now)
    p = np.maximum(0.0, H * deepest - K * (deepest - now))
    stiffness = np.where(p > 0.0, np.where(deepest > now, K, H), 0.0)
    width = (high - low) / len(x)
    return np.array([np.sum(f) for f in (p, p * x, stiffness, stiffness * x, stiffness * x**2, p**2 / K)]) * width


@pytest.mark.parametrize("seed", range(12))
def test_pressure_over_random_grooves(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lines = one_line()
    for j in range(-25, 25):
        if rng.uniform() < 0.6:
            ends = (
                np.sort(rng.uniform(j * 1e-3, (j + 1) * 1e-3, 2)) if rng.uniform() < 0.5 else (j * 1e-3, (j + 1) * 1e-3)
            )
            cells_of(lines, 0)[:, j - lines.flag[0, WINDOW]] = rng.uniform(0.0, 8e-3), *ends, 0.0
    edge, fall = rng.uniform(-5e-3, 5e-3), float(rng.choice([-0.6, -0.02, 0.0, 0.02, 0.6]))
    # the base ends at the waterline or before it
    low, high = (-12e-3, 0.0) if fall > 0.0 else (0.0, 12e-3)
    depth = max(5e-3, abs(fall) * 12e-3)
    found, known = sums_of(lines, low, high, depth, fall, edge), quadrature(lines, low, high, depth, fall, edge)
    # midpoints miss each of some 50 jumps by half a piece of 30 nm at most: 1e-4 of 12 mm; kinks far less
    scale = np.array([known[0], known[0] * 12e-3, known[2], known[2] * 12e-3, known[2] * 1.44e-4, known[5]])
    assert np.all(np.abs(found - known) <= 1e-4 * scale)
    assert known[0] > 100.0


def test_wedge_on_virgin_snow() -> None:
    """F = ½ H e² / tan ϑ per length, at a third of the width from the edge; k_u does not matter for it."""
    lines = one_line()
    fall = math.tan(0.5)
    found = sums_of(lines, -4e-3 / fall, 0.0, 4e-3, fall, 1e-3)
    width = 4e-3 / fall
    assert found[0] == pytest.approx(0.5 * H * 4e-3 * width, rel=1e-12)
    assert found[1] == pytest.approx(-0.5 * H * 4e-3 * width * width / 3.0, rel=1e-12)
    assert found[2:5] == pytest.approx([H * width, -H * width**2 / 2.0, H * width**3 / 3.0], rel=1e-12)
    assert found[5] == pytest.approx((H * 4e-3) ** 2 * width / 3.0 / K, rel=1e-12)


@pytest.mark.parametrize("fall", [0.0, 0.3])
def test_energy_of_a_cycle(fall: float) -> None:
    """Load, unload, reload: ½ H ε² (1 - H/k_u) per area is lost, once, and the reload loses nothing."""
    lines = one_line(cell=0.25e-3)
    width, deepest = 9e-3, 6e-3

    def travel(depths: FloatArray) -> float:
        """Work done on the snow per length, by trapezoids; forces before the snow gives way."""
        work, before = 0.0, None
        for depth in depths:
            low = max(-width, -depth / fall) if fall > 0.0 else -width
            force = sums_of(lines, low, 0.0, float(depth), fall, 0.0)[0] if depth > 0.0 else 0.0
            if before is not None:
                work += 0.5 * (force + before[1]) * (depth - before[0])
            before = (depth, force)
            if depth > 0.0:
                press(lines, low, 0.0, 0.0, float(depth), fall)
        return work

    down = np.linspace(0.0, deepest, 1501)
    loading = travel(down)
    unloading = travel(down[::-1])
    lost = loading + unloading
    x = -width * (np.arange(100_000) + 0.5) / 100_000
    depth = np.maximum(0.0, deepest + fall * x)
    known = 0.5 * H * (1.0 - H / K) * float(np.sum(depth**2)) * width / 100_000
    # steps of 4 µm in depth, cells of a quarter millimetre where the waterline ends
    assert lost == pytest.approx(known, rel=1e-4 if fall == 0.0 else 2e-3)
    first = int(lines.flag[0, WINDOW])
    left = energy_left(lines, 0, first, first + CELLS, H, K - H) / SPACING
    assert left == pytest.approx(known, rel=1e-9 if fall == 0.0 else 2e-3)
    again = travel(down) + travel(down[::-1])
    assert abs(again) < (1e-9 if fall == 0.0 else 2e-3) * known
    assert energy_left(lines, 0, first, first + CELLS, H, K - H) / SPACING == pytest.approx(left, rel=1e-9)
    assert loading > 0.5 * H * float(np.sum(depth**2)) * width / 100_000 * 0.999


def test_groove_left_behind() -> None:
    """The base lets go at ε_max H/k_u below its deepest: the groove is ε_max (1 - H/k_u)."""
    lines = one_line()
    press(lines, -10e-3, 10e-3, 0.0, 5e-3, 0.0)
    groove = 5e-3 * (1.0 - H / K)
    assert sums_of(lines, -10e-3, 10e-3, groove - 1e-9, 0.0, 0.0)[0] < 1e-9
    assert sums_of(lines, -10e-3, 10e-3, groove + 1e-6, 0.0, 0.0)[0] == pytest.approx(K * 1e-6 * 20e-3, rel=1e-9)


def test_energy_where_an_edge_covers_or_leaves() -> None:
    """New ground takes the whole work of loading, ½ H ε²; what is left gives the springy part back, ½ (H ε)²/k_u."""
    lines = one_line()
    press(lines, -5e-3, 0.0, 0.0, 4e-3, 0.0)
    arguments = (lines.cells, 0, int(lines.flag[0, WINDOW]), float(lines.value[0, CELL]), float(lines.value[0, SLOPE]))
    assert energy_at_edge(*arguments, 2e-3, 4e-3, 1.0, True, H, K - H) == pytest.approx(0.5 * H * 4e-3**2, rel=1e-12)
    springy = 0.5 * (H * 4e-3) ** 2 / K
    assert energy_at_edge(*arguments, -2e-3, 4e-3, 1.0, False, H, K - H) == pytest.approx(springy, rel=1e-12)
    assert energy_at_edge(*arguments, -2e-3, 4e-3, 1.0, True, H, K - H) == pytest.approx(springy, rel=1e-12)
    # an edge 0.1 mm into a cell of 1 mm that was met before cuts it from 4 to 5 mm
    work = 0.5 * H * (1.0 - H / K) * (5e-3**2 - 4e-3**2) + 0.5 * (H * 5e-3) ** 2 / K
    assert energy_at_edge(*arguments, -1.1e-3, 5e-3, -1.0, True, H, K - H) == pytest.approx(work, rel=1e-12)


def groove(lines: Lines) -> dict[int, tuple[float, float, float]]:
    """Covered cells by number."""
    deepest, start, end, _ = cells_of(lines, 0)
    first = int(lines.flag[0, WINDOW])
    return {first + int(i): (float(deepest[i]), float(start[i]), float(end[i])) for i in np.flatnonzero(end > start)}


def total_energy(lines: Lines, archive: Archive) -> float:
    start, size = int(lines.flag[0, WINDOW]), CELLS
    return float(archive.lost[0]) + energy_left(lines, 0, start, start + size, H, K - H) - float(lines.value[0, 2])


def test_marks_keep_the_deepest() -> None:
    lines = one_line()
    press(lines, -3.5e-3, 2.25e-3, 0.0, 4e-3, 0.1)
    press(lines, -1.5e-3, 4.5e-3, 0.0, 2e-3, 0.0)
    kept = groove(lines)
    assert sorted(kept) == list(range(-4, 5))
    for j, (deepest, _, _) in kept.items():
        known = 4e-3 + 0.1 * (j + 0.5) * 1e-3 if j < 3 else 2e-3
        assert deepest == pytest.approx(known, rel=1e-12)
    ends = np.array([[low, high] for _, low, high in kept.values()])
    assert ends.min() == -3.5e-3
    assert ends.max() == 4.5e-3
    assert np.sum(ends[:, 1] - ends[:, 0]) == pytest.approx(8e-3, rel=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_edge_does_not_fill_ground_that_was_met_before(way: float) -> None:
    """It went from 0.6 to 0.2 mm, 2 mm deep, with its base rising away from it: under it lies what lay there."""
    lines = one_line()
    ends = sorted((0.0, 4e-3 * way))
    number = 0.0 if way > 0.0 else -1.0
    cut = (0.2e-3 * way, 4e-3 * way, 2e-3, -0.5 * way, 0.4e-3 * way, 0.0)

    def ground() -> float:
        place = np.uint64(int(number) - int(lines.flag[0, WINDOW]))
        return float(ground_cut(lines.cells, 0, place, number, 1e-3, *cut))

    press(lines, ends[0], ends[1], 0.0, 1e-3, -0.25 * way)
    # deeper than what lay there: as deep as the edge when it passed, and the base where it had been
    assert ground() == pytest.approx(0.5 * (1.95e-3 + 1.85e-3), rel=1e-12)
    press(lines, ends[0], ends[1], 0.0, 5e-3, -0.5 * way)
    # 4.75 mm at the middle, seen as level where the edge went, at 0.4 mm
    assert ground() == pytest.approx(0.5 * (4.70e-3 + 4.75e-3), rel=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_window_moves_along_with_the_ski(way: float) -> None:
    """What stays in the window stays, what leaves is archived, and no energy comes or goes."""
    lines, archive = one_line(), new_archive(50, 5000)
    for step in range(25):
        middle = way * 4e-3 * step
        lines.value[0, [LOW, HIGH, EDGE]] = middle - 6.5e-3, middle + 6.5e-3, middle
        before, old = total_energy(lines, archive), groove(lines)
        make_room(archive, lines, 0, lines.value[0, LOW], lines.value[0, HIGH], H, K - H)
        assert total_energy(lines, archive) == pytest.approx(
            before, rel=1e-6, abs=1e-12
        )  # the archive is single precision
        now = groove(lines)
        assert all(old[j] == kept for j, kept in now.items())
        press(lines, middle - 6.5e-3, middle + 6.5e-3, middle, 3e-3 + 1e-3 * math.sin(step), 0.0)
        assert {math.floor(1e3 * (middle - 6.5e-3)), math.floor(1e3 * (middle + 6.5e-3))} <= set(groove(lines))
    swept = total_energy(lines, archive)
    leave_line(archive, lines, 0, H, K - H)
    assert archive.lost[0] == pytest.approx(swept, rel=1e-12)
    assert lines.flag[0, KEPT] == 0
    assert archive.used[0] > 2


@pytest.mark.parametrize("fall", [0.0, 0.2])
def test_coarser_cells_keep_depth_and_energy(fall: float) -> None:
    lines, archive = one_line(), new_archive(50, 5000)
    press(lines, -15e-3, 15e-3, 0.0, 5e-3, fall)
    before, energy = groove(lines), total_energy(lines, archive)
    lines.value[0, [LOW, HIGH]] = -30e-3, 30e-3
    make_room(archive, lines, 0, lines.value[0, LOW], lines.value[0, HIGH], H, K - H)
    assert lines.value[0, CELL] == 2e-3
    for j, (deepest, low, high) in groove(lines).items():
        assert deepest == pytest.approx(5e-3 + fall * (j + 0.5) * 2e-3, rel=1e-12)
        assert low == min(before[i][1] for i in (2 * j, 2 * j + 1) if i in before)
        assert high == max(before[i][2] for i in (2 * j, 2 * j + 1) if i in before)
    assert total_energy(lines, archive) == pytest.approx(energy, rel=1e-12)


def test_a_fresh_line_chooses_cells_wide_enough() -> None:
    lines, archive = one_line(), new_archive(50, 5000)
    lines.flag[0, KEPT] = 0
    lines.value[0, [LOW, HIGH]] = -0.05, 0.05
    make_room(archive, lines, 0, lines.value[0, LOW], lines.value[0, HIGH], H, K - H)
    assert lines.value[0, CELL] == 4e-3
    start = int(lines.flag[0, WINDOW])
    assert start * 4e-3 < -0.05
    assert (start + 64) * 4e-3 > 0.05
    assert not groove(lines)
