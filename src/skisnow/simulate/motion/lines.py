"""The snow's memory under the skis: lines across the path, fixed in the snow, on which the contact is integrated.

A line is laid ahead of the tip and stays where it is until the tail has passed. Across it, cells remember the deepest
base that they met. The contact is evaluated on the lines themselves, so the memory is never transported or
interpolated: nothing smears, and no rounding decides which cell is hit. Across a cell the groove is taken parallel to
the base that meets it.

An edge that goes aside leaves ground as deep as it was when it passed. Towards its base it sweeps: that ground lies
behind it. Away from its base it cuts: that ground lies under the base, which rises from it, and carries next to none.

What lines and cells leave behind goes to the archive, and comes back where a ski crosses an older track.
"""

from __future__ import annotations

from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN, SUMS

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

NOTHING = 1e9
"""Stands for a place that nothing has touched."""
FLAT = 1e-12
"""Fall of the depth across below which a base is level."""
SMALL = 1e-15
"""Width (m) that is none."""
ROUNDING: Final = 1e-12
"""Depth (m) that is none: of bases that lie equally deep rounding would choose the deeper."""
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
# an edge has left a cell of it sideways: its ground is flat then
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
    spare: FloatArray  # (CELLS,) working space


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
        np.zeros(CELLS),
    )


def cells_of(lines: Lines, row: int) -> FloatArray:
    """(4, CELLS) of a line: deepest, from, to, centre."""
    return lines.cells[row, : 4 * CELLS].reshape(4, CELLS)


@compiled(**PLAIN)
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


@compiled(**PLAIN)
def open_window(lines: Lines, row: int, start: int) -> None:
    """Give a line empty cells from number `start` on."""
    lines.flag[row, WINDOW] = start
    lines.flag[row, KEPT] = 1
    for j in range(np.uint64(CELLS)):
        lines.cells[row, DEEPEST + j] = -NOTHING
        lines.cells[row, FROM + j] = NOTHING
        lines.cells[row, TO + j] = -NOTHING
        lines.cells[row, CENTRE + j] = 0.0


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def anchor_of(value: FloatArray, flag: IntArray, row: int, edge: float, deep: float) -> float:
    """Where across an edge that is `deep` now holds: as before, else where it met the surface since the last look."""
    if flag[row, ANCHORED] == 1:
        return value[row, ANCHOR]
    if flag[row, ABOVE] == 1:
        return edge - deep / (deep - value[row, DEEP_ABOVE]) * (edge - value[row, EDGE_ABOVE])
    return edge


@compiled(**PLAIN, fastmath={"contract"})
def mark_cells(cells: FloatArray, value: FloatArray, row: np.uint64, window: int, known: int) -> None:
    """Remember the base that touches a line now; its cells must reach as far. That of place `known` is left."""
    low, high, edge = value[row, LOW], value[row, HIGH], value[row, EDGE]
    depth, slope, cell = value[row, DEPTH], value[row, FALL], value[row, CELL]
    per_cell = 1.0 / cell
    first = max((int(np.floor(low * per_cell)) - window) & ~7, 0)
    last = max(min((int(np.floor(high * per_cell)) - window) | 7, CELLS - 1), -1)
    deeper = 0
    for i in range(np.uint64(first), np.uint64(last + 1)):
        number = float(window) + i
        a, b, middle = max(low, number * cell), min(high, (number + 1.0) * cell), (number + 0.5) * cell
        here = depth + slope * (middle - edge)
        marked = here if b >= a and int(i) != known else -NOTHING
        deeper |= marked > cells[row, DEEPEST + i] + ROUNDING
        cells[row, DEEPEST + i] = max(cells[row, DEEPEST + i], marked)
        cells[row, FROM + i] = min(cells[row, FROM + i], a if b >= a else NOTHING)
        cells[row, TO + i] = max(cells[row, TO + i], b if b >= a else -NOTHING)
        cells[row, CENTRE + i] = max(cells[row, CENTRE + i], here if a <= middle <= b else 0.0)
    if deeper:
        value[row, SLOPE] = slope


@compiled(**PLAIN, fastmath={"contract"})
def mark_swept(cells: FloatArray, value: FloatArray, row: int, window: int) -> bool:
    """Remember the ground that the edge left sideways since it was marked last: as deep as the edge that passed.

    Whether it left a cell.
    """
    swept = False
    edge, before, depth, slope = value[row, EDGE], value[row, EDGE_MARKED], value[row, DEPTH], value[row, FALL]
    cell = value[row, CELL]
    rise = (depth - value[row, DEPTH_MARKED]) / (edge - before)
    low, high = min(edge, before), max(edge, before)
    now = int(np.floor(edge / cell))
    for j in range(max(int(np.floor(low / cell)), window), min(int(np.floor(high / cell)) + 1, window + CELLS)):
        i = np.uint64(j - window)
        middle = (j + 0.5) * cell
        passed = min(max(middle, low), high)
        here = depth + rise * (passed - edge) + slope * (middle - passed)
        if passed == middle:
            cells[row, CENTRE + i] = max(cells[row, CENTRE + i], here)
        cells[row, DEEPEST + i] = max(cells[row, DEEPEST + i], here)
        cells[row, FROM + i] = min(cells[row, FROM + i], max(low, j * cell))
        cells[row, TO + i] = max(cells[row, TO + i], min(high, (j + 1) * cell))
        swept = swept or (j != now and cells[row, CENTRE + i] > 0.0)
    return swept


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def cut_of(
    value: FloatArray, flag: IntArray, row: int, edge: float, low: float, high: float, slope: float
) -> float:  # fmt: skip
    """Width (m) that an edge which goes away from its base has cut since it was marked: > 0 to its left; or none.

    `low` and `high`: where the wet base begins and ends; of a level base both edges may be down, and none cuts.
    """
    cut = value[row, EDGE_MARKED] - edge
    ploughs = flag[row, MARKED] == 1 and cut * slope < 0.0
    return cut if ploughs and (low if cut > 0.0 else high) == edge else 0.0


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def slope_cut(value: FloatArray, row: int, cut: float, depth: float, slope: float) -> float:
    """Slope of the ground that the edge has cut: as deep as the edge when it passed, or as the base there now."""
    left = (value[row, DEPTH_MARKED] - depth) / cut
    return left if (left - slope) * cut > 0.0 else slope


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def ground_cut(
    cells: FloatArray, row: int, i: np.uint64, number: float, cell: float, edge: float, end: float, depth: float,
    slope: float, cut: float, left: float,
) -> float:  # fmt: skip
    """Ground of a cell that was cut, in part perhaps, extended to the cell's middle along the base (m).

    It is place `i` of the row. The wet base goes from the edge, which is `depth` deep, to `end`. What counts is the
    mean of the ground over all that lies under the base. Ground that was met before does not rise where an edge goes
    over it: one that trembles over its own strip does not forget how deep it was.
    """
    known, at_middle, met_low, met_high = (
        cells[row, DEEPEST + i], cells[row, CENTRE + i], cells[row, FROM + i], cells[row, TO + i],
    )  # fmt: skip
    first, middle, after, before = number * cell, (number + 0.5) * cell, (number + 1.0) * cell, edge + cut
    if cut > 0.0:
        met = min(max(met_low, edge, first), before, after)
        new_from, new_to, over_from, over_to = max(edge, first), met, met, min(before, after)
        under_from, under_to = max(before, first), min(end, after)
    else:
        met = max(min(met_high, edge, after), before, first)
        new_from, new_to, over_from, over_to = met, min(edge, after), max(before, first), met
        under_from, under_to = max(end, first), min(before, after)
    # new: as deep as the edge when it passed; gone over: that, or deeper from before; what lay under the base before:
    # its ground, or the base if that is deeper now
    new, over = max(new_to - new_from, SMALL), max(over_to - over_from, 0.0)
    under = under_to - under_from if under_from <= before <= under_to else 0.0
    at_new, at_over = 0.5 * (new_to + new_from), 0.5 * (over_to + over_from)
    ground_new = depth + left * (at_new - edge) - slope * (at_new - middle)
    before_over = at_middle - slope * (at_over - middle) if at_middle > 0.0 else known
    ground_over = max(before_over, depth + left * (at_over - edge) - slope * (at_over - middle))
    ground_under = max(known, depth + slope * (middle - edge))
    return (new * ground_new + over * ground_over + under * ground_under) / (new + over + under)


@compiled(**PLAIN, fastmath={"contract"})
def mark_cut(cells: FloatArray, value: FloatArray, row: int, window: int, cut: float) -> int:
    """Remember the ground that the edge has cut, as deep as the edge when it passed; the place of the edge's cell."""
    edge, depth, slope, cell = value[row, EDGE], value[row, DEPTH], value[row, FALL], value[row, CELL]
    end = value[row, HIGH] if cut > 0.0 else value[row, LOW]
    left, per_cell = slope_cut(value, row, cut, depth, slope), 1.0 / cell
    low, high = min(edge, edge + cut), max(edge, edge + cut)
    for j in range(max(int(np.floor(low * per_cell)), window), min(int(np.floor(high * per_cell)) + 1, window + CELLS)):
        i, middle = np.uint64(j - window), (j + 0.5) * cell
        cells[row, DEEPEST + i] = ground_cut(cells, row, i, j, cell, edge, end, depth, slope, cut, left)
        cells[row, FROM + i] = min(cells[row, FROM + i], max(low, j * cell))
        cells[row, TO + i] = max(cells[row, TO + i], min(high, (j + 1) * cell))
        if low <= middle <= high:
            cells[row, CENTRE + i] = max(cells[row, CENTRE + i], depth + left * (middle - edge))
    return int(np.floor(edge * per_cell)) - window


@compiled(**PLAIN, inline="always")
def ground_slope(lines: Lines, row: int) -> float:
    """Slope of the ground across a line's cells: that of the deepest base, but flat where its edge left sideways."""
    return 0.0 if lines.flag[row, SWEPT] == 1 else lines.value[row, SLOPE]


@compiled(**PLAIN, fastmath=SUMS)
def energy_left(lines: Lines, row: int, first: int, last: int, hardness: float, excess: float) -> float:
    """Energy lost to the groove in the cells first ≤ j < last of a line (J): ½ H_V g² (1 - H_V/k_u) per area."""
    start, cells = lines.flag[row, WINDOW], lines.cells
    cell, slope = lines.value[row, CELL], ground_slope(lines, row)
    total, fall2 = 0.0, slope * slope / 12.0
    for i in range(np.uint64(first - start), np.uint64(last - start)):
        low, high, at_middle = cells[row, FROM + i], cells[row, TO + i], cells[row, CENTRE + i]
        width = max(high - low, 0.0)
        depth = at_middle if at_middle > 0.0 else cells[row, DEEPEST + i]
        depth += slope * (0.5 * (high + low) - (float(start) + i + 0.5) * cell)
        total += width * (depth * depth + fall2 * width * width)
    return 0.5 * hardness * excess / (hardness + excess) * total * lines.spacing[0]


@compiled(**PLAIN, fastmath={"contract"}, inline="always")
def energy_at_edge(
    cells: FloatArray, row: int, start: int, cell: float, slope: float, y: float, depth: float, ahead: float,
    covers: bool, hardness: float, excess: float,
) -> float:  # fmt: skip
    """Energy per area (J/m²) that the snow gains where an edge covers new ground, or gives back where it leaves."""
    stiff = hardness + excess
    before, deepest = 0.0, depth
    number = int(np.floor(y / cell))
    at = number - start
    if 0 <= at < CELLS:
        i = np.uint64(at)
        low, high = cells[row, FROM + i], cells[row, TO + i]
        known = cells[row, DEEPEST + i] + slope * (y - (number + 0.5) * cell)
        if not covers:
            deepest = max(known, depth)
        elif low <= y <= high:
            before = known
            if high >= (number + 1) * cell if ahead > 0.0 else low <= number * cell:
                # met before as far as it goes, so what is known of it may be the edge that is here now: the ground of
                # half a cell on
                at = int(np.floor((y + 0.5 * ahead * cell) / cell)) - start
                on = np.uint64(at)
                met = 0 <= at < CELLS and cells[row, TO + on] > cells[row, FROM + on]
                before = cells[row, CENTRE + on] if met else known
            deepest = max(before, depth)
    pressed = max(0.0, hardness * depth - excess * (deepest - depth))
    gain = 0.5 * pressed * pressed / stiff
    if covers:
        gain += 0.5 * hardness * excess / stiff * (deepest * deepest - before * before)
    return gain
