"""The snow's memory under the skis: lines across the path, fixed in the snow, on which the contact is integrated.

A line is laid ahead of the tip and stays where it is until the tail has passed. Across it, cells remember the deepest
base that they met. The contact is evaluated on the lines themselves, so the memory is never transported or
interpolated: nothing smears, and no rounding decides which cell is hit. Across a cell the groove is taken parallel to
the base that meets it.

What lines and cells leave behind goes to the archive, and comes back where a ski crosses an older track.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numba
import numpy as np
import numpy.typing as npt

from .compiled import PLAIN, SUMS

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

NOTHING = 1e9
"""Stands for a place that nothing has touched."""
FLAT = 1e-12
"""Fall of the depth across below which a base is level."""
MARGIN = 6
"""Cells kept free on both sides of a contact."""

# columns of `value`: size of the line's cells (m), slope of the deepest base across, energy that an older track had
# taken (J), where across the edge holds (m); where the base meets the line now: from, to, edge (m), depth at the edge
# (m), fall of the depth across, depth of the deepest edge (m); edge and depth when it was last looked at and the base
# was above it (m)
CELL, SLOPE, LOST, ANCHOR, LOW, HIGH, EDGE, DEPTH, FALL, DEEP_NOW, EDGE_ABOVE, DEEP_ABOVE = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    8,
    9,
    10,
    11,
)
# where its edge was marked last, and how deep (m)
EDGE_MARKED, DEPTH_MARKED = 12, 13
# columns of `flag`: number of the first cell, whether the cells hold anything, whether the edge holds, whether the base
# is there, whether at the last look it was just above, whether its base was marked at the last look, whether
# an edge has swept across it by more than a cell in a step: its ground is flat then
WINDOW, KEPT, ANCHORED, TOUCHED, ABOVE, MARKED, SWEPT = 0, 1, 2, 3, 4, 5, 6
CELLS = 64
"""Cells that a line keeps at a time: many more than a contact needs, few enough for the processor's cache; a multiple
of eight."""
BESIDES: Final = 8
"""Empty places of each row: rows a power of two apart compete for the same places of the processor's cache."""
# where in a row of `cells` they begin, unsigned: the compiled loops need not ask whether a place counts from the end.
# Deepest base extended to the cell's middle, part that a base has covered, across; deepest base at the middle itself,
# which counts for the energy: an edge that leaves a cell is deeper, extended to the middle (m)
DEEPEST, FROM, TO, CENTRE = (np.uint64(i * CELLS) for i in range(4))


class Lines(NamedTuple):
    """Lines of both skis, in one ring for each: row k × ring + i. Places in space (m)."""

    frame: FloatArray  # (2 ring, 12) origin, unit vectors ahead, to the left, out of the snow
    cells: FloatArray  # (2 ring, 4 × CELLS + BESIDES), each from the first of a window on
    value: FloatArray  # (2 ring, 14)
    flag: IntArray  # (2 ring, 7)
    first: IntArray  # (2,) of the ring, the line nearest the tail
    count: IntArray  # type: ignore[assignment]  # (2,) hides the tuple's own, which nothing asks for
    spacing: FloatArray  # (2,) of the lines along the path, and of fresh cells across (m)


def new_lines(ring: int, *, spacing: float, cell: float) -> Lines:
    """Room for `ring` lines under each ski."""
    rows = 2 * ring
    return Lines(
        np.zeros((rows, 12)),
        np.zeros((rows, 4 * CELLS + BESIDES)),
        np.zeros((rows, 14)),
        np.zeros((rows, 7), np.int64),
        np.zeros(2, np.int64),
        np.zeros(2, np.int64),
        np.array([spacing, cell]),
    )


def cells_of(lines: Lines, row: int) -> FloatArray:
    """(4, CELLS) of a line: deepest, from, to, centre."""
    return lines.cells[row, : 4 * CELLS].reshape(4, CELLS)


@numba.njit(**PLAIN)
def begin_line(lines: Lines, row: int, frame: FloatArray) -> None:
    """Make a row a line of virgin snow."""
    for a in range(12):
        lines.frame[row, a] = frame[a]
    lines.value[row, CELL] = lines.spacing[1]
    lines.flag[row, KEPT] = 0
    lines.value[row, SLOPE] = 0.0
    lines.value[row, LOST] = 0.0
    lines.flag[row, ANCHORED] = 0
    lines.flag[row, TOUCHED] = 0
    lines.flag[row, ABOVE] = 0
    lines.flag[row, MARKED] = 0
    lines.flag[row, SWEPT] = 0


@numba.njit(**PLAIN)
def open_window(lines: Lines, row: int, start: int) -> None:
    """Give a line empty cells from number `start` on."""
    lines.flag[row, WINDOW] = start
    lines.flag[row, KEPT] = 1
    for j in range(np.uint64(CELLS)):
        lines.cells[row, DEEPEST + j] = -NOTHING
        lines.cells[row, FROM + j] = NOTHING
        lines.cells[row, TO + j] = -NOTHING
        lines.cells[row, CENTRE + j] = 0.0


@numba.njit(**PLAIN, fastmath={"contract"}, inline="always")
def anchor_of(value: FloatArray, flag: IntArray, row: int, edge: float, deep: float) -> float:
    """Where across an edge that is `deep` now holds: as before, else where it met the surface since the last look."""
    if flag[row, ANCHORED] == 1:
        return value[row, ANCHOR]
    if flag[row, ABOVE] == 1:
        return edge - deep / (deep - value[row, DEEP_ABOVE]) * (edge - value[row, EDGE_ABOVE])
    return edge


@numba.njit(**PLAIN, fastmath={"contract"})
def mark_cells(cells: FloatArray, value: FloatArray, row: np.uint64, window: int) -> None:
    """Remember the base that touches a line now; its cells must reach as far."""
    low, high, edge = value[row, LOW], value[row, HIGH], value[row, EDGE]
    depth, slope, cell = value[row, DEPTH], value[row, FALL], value[row, CELL]
    per_cell = 1.0 / cell
    first = (int(np.floor(low * per_cell)) - window) & ~7
    last = (int(np.floor(high * per_cell)) - window) | 7
    deeper = 0
    for i in range(np.uint64(first), np.uint64(last + 1)):
        number = float(window) + i
        a, b, middle = max(low, number * cell), min(high, (number + 1.0) * cell), (number + 0.5) * cell
        here = depth + slope * (middle - edge)
        marked = here if b >= a else -NOTHING
        deeper |= marked > cells[row, DEEPEST + i]
        cells[row, DEEPEST + i] = max(cells[row, DEEPEST + i], marked)
        cells[row, FROM + i] = min(cells[row, FROM + i], a if b >= a else NOTHING)
        cells[row, TO + i] = max(cells[row, TO + i], b if b >= a else -NOTHING)
        cells[row, CENTRE + i] = max(cells[row, CENTRE + i], here if a <= middle <= b else 0.0)
    if deeper:
        value[row, SLOPE] = slope


@numba.njit(**PLAIN, fastmath={"contract"})
def mark_swept(cells: FloatArray, value: FloatArray, row: int, window: int) -> None:
    """Remember the ground that the edge left sideways since it was marked last: as deep as the edge that passed."""
    edge, before, depth, slope = value[row, EDGE], value[row, EDGE_MARKED], value[row, DEPTH], value[row, FALL]
    cell = value[row, CELL]
    rise = (depth - value[row, DEPTH_MARKED]) / (edge - before)
    low, high = min(edge, before), max(edge, before)
    for j in range(int(np.floor(low / cell)), int(np.floor(high / cell)) + 1):
        i = np.uint64(j - window)
        middle = (j + 0.5) * cell
        passed = min(max(middle, low), high)
        here = depth + rise * (passed - edge) + slope * (middle - passed)
        if passed == middle:
            cells[row, CENTRE + i] = max(cells[row, CENTRE + i], here)
        cells[row, DEEPEST + i] = max(cells[row, DEEPEST + i], here)
        cells[row, FROM + i] = min(cells[row, FROM + i], max(low, j * cell))
        cells[row, TO + i] = max(cells[row, TO + i], min(high, (j + 1) * cell))


@numba.njit(**PLAIN, fastmath=SUMS)
def energy_left(lines: Lines, row: int, first: int, last: int, hardness: float, excess: float) -> float:
    """Energy lost to the groove in the cells first ≤ j < last of a line (J): ½ H_V g² (1 - H_V/k_u) per area."""
    start, cells = lines.flag[row, WINDOW], lines.cells
    cell, slope = lines.value[row, CELL], 0.0 if lines.flag[row, SWEPT] == 1 else lines.value[row, SLOPE]
    total, fall2 = 0.0, slope * slope / 12.0
    for i in range(np.uint64(first - start), np.uint64(last - start)):
        low, high, at_middle = cells[row, FROM + i], cells[row, TO + i], cells[row, CENTRE + i]
        width = max(high - low, 0.0)
        depth = at_middle if at_middle > 0.0 else cells[row, DEEPEST + i]
        depth += slope * (0.5 * (high + low) - (float(start) + i + 0.5) * cell)
        total += width * (depth * depth + fall2 * width * width)
    return 0.5 * hardness * excess / (hardness + excess) * total * lines.spacing[0]


@numba.njit(**PLAIN, fastmath={"contract"}, inline="always")
def energy_at_edge(
    cells: FloatArray, row: int, start: int, cell: float, slope: float, y: float, depth: float, covers: bool,
    hardness: float, excess: float,
) -> float:  # fmt: skip
    """Energy per area (J/m²) that the snow gains where an edge covers new ground, or gives back where it leaves."""
    j = int(np.floor(y / cell))
    at = j - start
    stiff = hardness + excess
    i = np.uint64(at)
    before, deepest = 0.0, depth
    if 0 <= at < CELLS:
        known = cells[row, DEEPEST + i] + slope * (y - (j + 0.5) * cell)
        deepest = max(known, depth)
        if cells[row, FROM + i] <= y <= cells[row, TO + i]:
            before = known
    pressed = max(0.0, hardness * depth - excess * (deepest - depth))
    gain = 0.5 * pressed * pressed / stiff
    if covers:
        gain += 0.5 * hardness * excess / stiff * (deepest * deepest - before * before)
    return gain
