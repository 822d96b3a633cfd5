"""Snow under a ski, slow and readable: lines as objects, cells in a dictionary, the pressure summed piece by piece.

Nothing here comes from the compiled loops but the names of their arrays, from which lines are read.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from skisnow.simulate.motion.lines import (
    ABOVE,
    ANCHOR,
    ANCHORED,
    CELL,
    DEEP_ABOVE,
    EDGE_ABOVE,
    KEPT,
    SLOPE,
    WINDOW,
    Lines,
    cells_of,
)
from skisnow.simulate.motion.model import Snow

FloatArray = npt.NDArray[np.float64]


@dataclass
class Cell:
    """Deepest base extended to the cell's middle, and the part across that a base has covered (m)."""

    deepest: float
    start: float
    end: float


@dataclass
class Touch:
    """Where a base meets a line: from, to, edge across, depth there (m), fall of the depth across, deepest edge (m)."""

    low: float
    high: float
    edge: float
    depth: float
    fall: float
    deep: float


@dataclass
class Line:
    """A line across the path: frame, size of its cells (m), cells by number, where the edge holds, the touch of now.

    `above`: where the edge was, and how deep (< 0), when it was last looked at from above; `marked`: the same, when
    the snow was last pressed there, if the base has not left it since.
    """

    origin: FloatArray
    ahead: FloatArray
    left: FloatArray
    out: FloatArray
    cell: float
    cells: dict[int, Cell] = field(default_factory=dict)
    slope: float = 0.0
    anchor: float | None = None
    touch: Touch | None = None
    above: tuple[float, float] | None = None
    marked: tuple[float, float] | None = None


@dataclass
class Sums:
    """∫p dx, ∫p x dx, ∫∂p/∂ε xⁿ dx (n = 0, 1, 2) and ∫p²/k_u dx; x counts from the edge."""

    force: float = 0.0
    moment: float = 0.0
    stiffness: tuple[float, float, float] = (0.0, 0.0, 0.0)
    springy: float = 0.0


def lines_of(arrays: Lines) -> tuple[list[Line], list[Line]]:
    """The lines of both skis, tail to tip, out of the arrays of the compiled loops."""
    ring = len(arrays.flag) // 2

    def line(row: int) -> Line:
        frame, value, flag = arrays.frame[row], arrays.value[row], arrays.flag[row]
        origin, ahead, left, out = (frame[i : i + 3].copy() for i in (0, 3, 6, 9))
        made = Line(origin, ahead, left, out, float(value[CELL]), slope=float(value[SLOPE]))
        made.anchor = float(value[ANCHOR]) if flag[ANCHORED] else None
        made.above = (float(value[EDGE_ABOVE]), float(value[DEEP_ABOVE])) if flag[ABOVE] else None
        if flag[KEPT]:
            for j, (deepest, start, end, _) in enumerate(cells_of(arrays, row).T.tolist(), int(flag[WINDOW])):
                if end > start:
                    made.cells[j] = Cell(deepest, start, end)
        return made

    left, right = (
        [line(k * ring + (int(arrays.first[k]) + c) % ring) for c in range(int(arrays.count[k]))] for k in range(2)
    )
    return left, right


def pressure_sums(line: Line, touch: Touch, snow: Snow) -> Sums:
    """Integrals of the pressure across a line, over pieces on which it is one straight line in x."""
    stiff = snow.hardness + snow.excess
    inside = {touch.low, touch.high}
    near = range(math.floor(touch.low / line.cell) - 1, math.floor(touch.high / line.cell) + 2)
    for j in near:
        inside.update((j * line.cell, (j + 1) * line.cell))
    ends = sorted(y for y in inside if touch.low <= y <= touch.high)
    sums = Sums()
    for a, b in itertools.pairwise(ends):
        middle = 0.5 * (a + b)
        cell = line.cells.get(math.floor(middle / line.cell))
        lift = 0.0
        if cell is not None:
            centre = (math.floor(middle / line.cell) + 0.5) * line.cell
            lift = max(0.0, cell.deepest - (touch.depth + touch.fall * (centre - touch.edge)))
        _add_piece(sums, a - touch.edge, b - touch.edge, touch, lift, snow.hardness, stiff)
    return sums


def _add_piece(sums: Sums, a: float, b: float, touch: Touch, lift: float, hardness: float, stiff: float) -> None:
    """H_V ε_max - k_u (ε_max - ε) with ε_max = ε + lift, where it pushes; three Gauss points are exact."""

    def law(x: FloatArray) -> FloatArray:
        depth = touch.depth + touch.fall * x
        return hardness * (depth + lift) - stiff * lift

    if touch.fall != 0.0:
        zero = ((stiff - hardness) * lift / hardness - touch.depth) / touch.fall
        a, b = (max(a, min(zero, b)), b) if touch.fall > 0.0 else (a, min(b, max(zero, a)))
    elif law(np.array(a)) <= 0.0:
        return
    branch = stiff if lift > 0.0 else hardness
    if b <= a:
        return
    point, weight = np.polynomial.legendre.leggauss(3)
    x, w = 0.5 * (a + b) + 0.5 * (b - a) * point, 0.5 * (b - a) * weight
    p = law(x)
    sums.force += float(w @ p)
    sums.moment += float(w @ (p * x))
    sums.springy += float(w @ p**2) / stiff
    k0, k1, k2 = sums.stiffness
    sums.stiffness = (k0 + branch * float(w.sum()), k1 + branch * float(w @ x), k2 + branch * float(w @ x**2))


def anchor(line: Line, edge: float, deep: float) -> float:
    """Where an edge that is `deep` now is held: where it was, else where it came through the surface."""
    if line.anchor is not None:
        return line.anchor
    if line.above is None:
        return edge
    before, height = line.above
    return before + (edge - before) * height / (height - deep)


def remember(line: Line, snow: Snow, most_cells: int) -> None:
    """Keep the base that touches a line, and let its edge take hold."""
    touch, before = line.touch, line.marked
    line.marked = None if touch is None else (touch.edge, touch.depth)
    if touch is None:
        return
    while not line.cells and (touch.high - touch.low) / line.cell > most_cells:
        line.cell *= 2.0
    if before is not None and (touch.edge - before[0]) * touch.fall < 0.0:
        _sweep(line, touch, *before)
    start = touch.low
    last = math.floor(touch.high / line.cell)
    for j in range(math.floor(touch.low / line.cell), last + 1):
        end = touch.high if j == last else (j + 1) * line.cell
        here = touch.depth + touch.fall * ((j + 0.5) * line.cell - touch.edge)
        cell = line.cells.setdefault(j, Cell(-math.inf, math.inf, -math.inf))
        if here > cell.deepest:
            cell.deepest, line.slope = here, touch.fall
        cell.start, cell.end = min(cell.start, start), max(cell.end, end)
        start = end
    line.anchor = min(max(anchor(line, touch.edge, touch.deep), touch.edge - snow.holding), touch.edge + snow.holding)
    line.above = None


def _sweep(line: Line, touch: Touch, edge_before: float, depth_before: float) -> None:
    """Ground between where the edge was and is has been as deep as the edge when it passed."""
    low, high = sorted((edge_before, touch.edge))
    for j in range(math.floor(low / line.cell), math.floor(high / line.cell) + 1):
        middle = (j + 0.5) * line.cell
        nearest = float(np.clip(middle, low, high))
        share = (nearest - edge_before) / (touch.edge - edge_before)
        depth = depth_before + share * (touch.depth - depth_before) + touch.fall * (middle - nearest)
        cell = line.cells.setdefault(j, Cell(-math.inf, math.inf, -math.inf))
        cell.deepest = max(cell.deepest, depth)
        cell.start = min(cell.start, max(low, j * line.cell))
        cell.end = max(cell.end, min(high, (j + 1) * line.cell))
