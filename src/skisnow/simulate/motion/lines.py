"""The snow's memory under the skis: lines across the path, fixed in the snow, on which the contact is integrated.

A line is laid ahead of the tip and stays where it is until the tail has passed. Across it, cells remember the deepest
base that they met. The contact is evaluated on the lines themselves, so the memory is never transported or
interpolated: nothing smears, and no rounding decides which cell is hit. Across a cell the groove is taken parallel to
the base that meets it.

What lines and cells leave behind goes to the archive, and comes back where a ski crosses an older track.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numba
import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

NOTHING = 1e9
"""Stands for a place that nothing has touched."""
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
# columns of `cells`: deepest base extended to the cell's middle, part that a base has covered, across; deepest base at
# the middle itself, which counts for the energy: an edge that leaves a cell is deeper, extended to the middle (m)
DEEPEST, FROM, TO, CENTRE = 0, 1, 2, 3


class Lines(NamedTuple):
    """Lines of both skis, in one ring for each: row k × ring + i. Places in space (m)."""

    frame: FloatArray  # (2 ring, 12) origin, unit vectors ahead, to the left, out of the snow
    cells: FloatArray  # (2 ring, cells, 4)
    value: FloatArray  # (2 ring, 14)
    flag: IntArray  # (2 ring, 7)
    first: IntArray  # (2,) of the ring, the line nearest the tail
    count: IntArray  # type: ignore[assignment]  # (2,) hides the tuple's own, which nothing asks for
    spacing: FloatArray  # (2,) of the lines along the path, and of fresh cells across (m)


def new_lines(ring: int, cells: int, *, spacing: float, cell: float) -> Lines:
    """Room for `ring` lines under each ski, with `cells` cells (a power of two) across."""
    rows = 2 * ring
    return Lines(
        np.zeros((rows, 12)),
        np.zeros((rows, cells, 4)),
        np.zeros((rows, 14)),
        np.zeros((rows, 7), np.int64),
        np.zeros(2, np.int64),
        np.zeros(2, np.int64),
        np.array([spacing, cell]),
    )


@numba.njit(cache=True, error_model="numpy")
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


@numba.njit(cache=True, error_model="numpy")
def open_window(lines: Lines, row: int, start: int) -> None:
    """Give a line empty cells from number `start` on."""
    lines.flag[row, WINDOW] = start
    lines.flag[row, KEPT] = 1
    for j in range(lines.cells.shape[1]):
        lines.cells[row, j, DEEPEST] = -NOTHING
        lines.cells[row, j, FROM] = NOTHING
        lines.cells[row, j, TO] = -NOTHING
        lines.cells[row, j, CENTRE] = 0.0


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
def pressure(
    sums: FloatArray, cells: FloatArray, row: int, start: int, cell: float, low: float, high: float, depth: float,
    slope: float, edge: float, hardness: float, excess: float,
) -> None:  # fmt: skip
    """Fill the sums of the snow's pressure over low ≤ x ≤ high, where the base is depth + slope x > 0 deep.

    x counts from the edge. `sums` (6,): ∫p dx, ∫p x dx, ∫∂p/∂ε xⁿ dx for n = 0, 1, 2, and ∫p²/k_u dx, twice the springy
    energy.
    """
    size = cells.shape[1]
    mask = size - 1
    stiff = hardness + excess
    total = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    j, last = int(np.floor((low + edge) / cell)), int(np.floor((high + edge) / cell))
    j, last = max(j, start), min(last, start + size - 1)
    middle = (j + 0.5) * cell - edge
    u = low  # virgin from here on, as far as is known
    while j <= last:
        i = np.uint64(j & mask)
        lift = cells[row, i, DEEPEST] - (depth + slope * middle)
        if lift > 0.0:
            a = max(u, cells[row, i, FROM] - edge, middle - 0.5 * cell)
            b = min(high, cells[row, i, TO] - edge, middle + 0.5 * cell)
            if b > a:
                if a > u:
                    total = _with_piece(total, u, a, hardness * (depth + slope * u), hardness * slope, hardness)
                rise = hardness * (depth + slope * a) - excess * lift
                total = _with_piece(total, a, b, rise, hardness * slope, stiff)
                u = b
        middle += cell
        j += 1
    if high > u:
        total = _with_piece(total, u, high, hardness * (depth + slope * u), hardness * slope, hardness)
    sums[0], sums[1], sums[2], sums[3], sums[4] = total[0], total[1], total[2], total[3], total[4]
    sums[5] = total[5] / (3.0 * stiff)


Sums: TypeAlias = tuple[float, float, float, float, float, float]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
def _with_piece(total: Sums, u: float, v: float, p0: float, rise: float, stiffness: float) -> Sums:
    """Sums with a piece from u to v of the pressure p0 + rise (x - u), where it is above zero."""
    p1 = p0 + rise * (v - u)
    h = v - u
    if min(p0, p1) < 0.0:
        zero = max(p0, p1) / abs(rise) if max(p0, p1) > 0.0 else 0.0
        u = v - zero if p1 > p0 else u
        h = zero
        p0, p1 = max(p0, 0.0), max(p1, 0.0)
    force = 0.5 * h * (p0 + p1)
    k = stiffness * h
    return (
        total[0] + force,
        total[1] + u * force + h * h * (p0 + 2.0 * p1) * (1.0 / 6.0),
        total[2] + k,
        total[3] + k * (u + 0.5 * h),
        total[4] + k * (u * (u + h) + h * h * (1.0 / 3.0)),
        total[5] + h * (p0 * p0 + p0 * p1 + p1 * p1),
    )


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
def anchor_of(value: FloatArray, flag: IntArray, row: int, edge: float, deep: float) -> float:
    """Where across an edge that is `deep` now holds: as before, else where it met the surface since the last look."""
    if flag[row, ANCHORED] == 1:
        return value[row, ANCHOR]
    if flag[row, ABOVE] == 1:
        return edge - deep / (deep - value[row, DEEP_ABOVE]) * (edge - value[row, EDGE_ABOVE])
    return edge


@numba.njit(cache=True, error_model="numpy", inline="always")
def mark_cells(cells: FloatArray, value: FloatArray, row: int) -> None:
    """Remember the base that touches a line now; its cells must reach as far."""
    low, high, edge = value[row, LOW], value[row, HIGH], value[row, EDGE]
    depth, slope, cell = value[row, DEPTH], value[row, FALL], value[row, CELL]
    mask = cells.shape[1] - 1
    start = low
    j, last = int(np.floor(low / cell)), int(np.floor(high / cell))
    while j <= last:
        end = high if j == last else (j + 1) * cell
        i = j & mask
        middle = (j + 0.5) * cell
        here = depth + slope * (middle - edge)
        if low <= middle <= high:
            cells[row, i, CENTRE] = max(cells[row, i, CENTRE], here)
        if here > cells[row, i, DEEPEST]:
            cells[row, i, DEEPEST] = here
            value[row, SLOPE] = slope
        cells[row, i, FROM] = min(cells[row, i, FROM], start)
        cells[row, i, TO] = max(cells[row, i, TO], end)
        start = end
        j += 1


@numba.njit(cache=True, error_model="numpy", inline="always")
def mark_swept(cells: FloatArray, value: FloatArray, row: int) -> None:
    """Remember the ground that the edge left sideways since it was marked last: as deep as the edge that passed."""
    edge, before, depth, slope = value[row, EDGE], value[row, EDGE_MARKED], value[row, DEPTH], value[row, FALL]
    cell = value[row, CELL]
    rise = (depth - value[row, DEPTH_MARKED]) / (edge - before)
    mask = cells.shape[1] - 1
    low, high = min(edge, before), max(edge, before)
    j, last = int(np.floor(low / cell)), int(np.floor(high / cell))
    while j <= last:
        i = j & mask
        middle = (j + 0.5) * cell
        passed = min(max(middle, low), high)
        here = depth + rise * (passed - edge) + slope * (middle - passed)
        if passed == middle:
            cells[row, i, CENTRE] = max(cells[row, i, CENTRE], here)
        cells[row, i, DEEPEST] = max(cells[row, i, DEEPEST], here)
        cells[row, i, FROM] = min(cells[row, i, FROM], max(low, j * cell))
        cells[row, i, TO] = max(cells[row, i, TO], min(high, (j + 1) * cell))
        j += 1


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def energy_left(lines: Lines, row: int, first: int, last: int, hardness: float, excess: float) -> float:
    """Energy lost to the groove in the cells first ≤ j < last of a line (J): ½ H_V g² (1 - H_V/k_u) per area."""
    mask = lines.cells.shape[1] - 1
    cell, slope = lines.value[row, CELL], 0.0 if lines.flag[row, SWEPT] == 1 else lines.value[row, SLOPE]
    total = 0.0
    for j in range(first, last):
        i = j & mask
        width = lines.cells[row, i, TO] - lines.cells[row, i, FROM]
        if width > 0.0:
            middle = 0.5 * (lines.cells[row, i, TO] + lines.cells[row, i, FROM])
            depth = lines.cells[row, i, CENTRE] if lines.cells[row, i, CENTRE] > 0.0 else lines.cells[row, i, DEEPEST]
            depth += slope * (middle - (j + 0.5) * cell)
            total += width * (depth * depth + slope * slope * width * width / 12.0)
    return 0.5 * hardness * excess / (hardness + excess) * total * lines.spacing[0]


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
def energy_at_edge(
    cells: FloatArray, row: int, start: int, cell: float, slope: float, y: float, depth: float, covers: bool,
    hardness: float, excess: float,
) -> float:  # fmt: skip
    """Energy per area (J/m²) that the snow gains where an edge covers new ground, or gives back where it leaves."""
    j = int(np.floor(y / cell))
    i = j & (cells.shape[1] - 1)
    stiff = hardness + excess
    before = 0.0
    if start <= j < start + cells.shape[1] and cells[row, i, FROM] <= y <= cells[row, i, TO]:
        before = cells[row, i, DEEPEST] + slope * (y - (j + 0.5) * cell)
    deepest = max(before, depth)
    pressed = max(0.0, hardness * depth - excess * (deepest - depth))
    gain = 0.5 * pressed * pressed / stiff
    if covers:
        gain += 0.5 * hardness * excess / stiff * (deepest * deepest - before * before)
    return gain
