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
    DEPTH_MARKED,
    EDGE_ABOVE,
    EDGE_MARKED,
    KEPT,
    MARKED,
    SLOPE,
    WINDOW,
    Lines,
    cells_of,
)
from skisnow.simulate.motion.model import Snow

FloatArray = npt.NDArray[np.float64]
ROUNDING = 1e-12
"""Lift (m) that is none, and depth by which a base is no deeper."""


@dataclass
class Cell:
    """Deepest base extended to the middle of the cell, the part across that was met, deepest at the middle (m)."""

    deepest: float
    start: float
    end: float
    centre: float = 0.0


@dataclass
class Touch:
    """Where a base meets a line: from, to, edge across, depth there (m), fall of the depth across, deepest edge (m)."""

    low: float
    high: float
    edge: float
    depth: float
    fall: float
    deep: float

    def base(self, y: float) -> float:
        """Depth of the base at y, extended."""
        return self.depth + self.fall * (y - self.edge)


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
            for j, (deepest, start, end, centre) in enumerate(cells_of(arrays, row).T.tolist(), int(flag[WINDOW])):
                if end > start:
                    made.cells[j] = Cell(deepest, start, end, centre)
        if flag[MARKED]:
            made.marked = float(value[EDGE_MARKED]), float(value[DEPTH_MARKED])
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
    sums, cut = Sums(), cut_ground(line, touch)
    for a, b in itertools.pairwise(ends):
        j = math.floor(0.5 * (a + b) / line.cell)
        deepest = cut[j] if j in cut else line.cells[j].deepest if j in line.cells else -math.inf
        lift = deepest - touch.base((j + 0.5) * line.cell)
        lift = lift if lift > ROUNDING else 0.0
        _add_piece(sums, a - touch.edge, b - touch.edge, touch, lift, snow.hardness, stiff)
    return sums


def cut_ground(line: Line, touch: Touch) -> dict[int, float]:
    """Ground in the cells that an edge going away from its base has cut since the snow was pressed, by number.

    Extended to their middles along the base, from where it is on the mean over all that lies under the base.
    """
    if line.marked is None or (line.marked[0] - touch.edge) * touch.fall >= 0.0:
        return {}
    cut = line.marked[0] - touch.edge
    border, end = (touch.low, touch.high) if cut > 0.0 else (touch.high, touch.low)
    if abs(border - touch.edge) > 1e-12:
        return {}
    before = border + cut

    def when_it_passed(y: float) -> float:
        share = (y - border) / cut
        passing = touch.base(border) + share * (line.marked[1] - touch.depth) if line.marked else 0.0
        return max(passing, touch.base(y))

    ground = {}
    for j in range(math.floor(min(border, before) / line.cell), math.floor(max(border, before) / line.cell) + 1):
        first, last, middle = j * line.cell, (j + 1) * line.cell, (j + 0.5) * line.cell
        near, far, to = (min(max(y, first), last) for y in (border, before, end))
        cell = line.cells.get(j, Cell(-math.inf, math.inf, -math.inf))
        met = cell.start if cut > 0.0 else cell.end
        met = min(max(met, min(near, far)), max(near, far))
        about = 0.5 * (met + far)
        # width, depth at its middle, that middle: the strip that nothing had met, and that which had been met
        pieces = [(max(abs(met - near), 1e-15), when_it_passed(0.5 * (near + met)), 0.5 * (near + met))]
        if met != far:
            known = cell.centre if cell.centre > 0.0 else cell.deepest + touch.fall * (about - middle)
            pieces.append((abs(far - met), max(when_it_passed(about), known), about))
        if first <= before <= last and (to - before) * cut > 0.0:  # and what lay under the base before
            about = 0.5 * (to + before)
            known = cell.deepest + touch.fall * (about - middle)
            pieces.append((abs(to - before), max(known, touch.base(about)), about))
        width = sum(piece[0] for piece in pieces)
        here, centre = (sum(piece[0] * piece[i] for piece in pieces) / width for i in (1, 2))
        ground[j] = here + touch.fall * (middle - centre)
    return ground


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
    cut = {}
    if before is not None:
        line.marked = before
        cut = cut_ground(line, touch)
        line.marked = (touch.edge, touch.depth)
        if cut:
            _cut(line, touch, cut, *before)
        elif (touch.edge - before[0]) * touch.fall < 0.0:
            _sweep(line, touch, *before)
    start = touch.low
    last = math.floor(touch.high / line.cell)
    border = touch.low if touch.fall < 0.0 else touch.high
    for j in range(math.floor(touch.low / line.cell), last + 1):
        end = touch.high if j == last else (j + 1) * line.cell
        middle = (j + 0.5) * line.cell
        here = touch.base(middle)
        cell = line.cells.setdefault(j, Cell(-math.inf, math.inf, -math.inf))
        if here > cell.deepest and not (cut and j == math.floor(border / line.cell)):
            line.slope = touch.fall if here > cell.deepest + ROUNDING else line.slope
            cell.deepest = here
        cell.start, cell.end = min(cell.start, start), max(cell.end, end)
        if start <= middle <= end:
            cell.centre = max(cell.centre, here)
        start = end
    line.anchor = min(max(anchor(line, touch.edge, touch.deep), touch.edge - snow.holding), touch.edge + snow.holding)
    line.above = None


def _cut(line: Line, touch: Touch, ground: dict[int, float], edge_before: float, depth_before: float) -> None:
    """Keep the ground that was cut."""
    cut = edge_before - touch.edge
    low, high = sorted((touch.edge, edge_before))
    for j, deepest in ground.items():
        middle = (j + 0.5) * line.cell
        cell = line.cells.setdefault(j, Cell(-math.inf, math.inf, -math.inf))
        cell.deepest = deepest
        cell.start = min(cell.start, max(low, j * line.cell))
        cell.end = max(cell.end, min(high, (j + 1) * line.cell))
        if low <= middle <= high:
            passing = touch.depth + (middle - touch.edge) / cut * (depth_before - touch.depth)
            cell.centre = max(cell.centre, passing, touch.base(middle))


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
        if nearest == middle:
            cell.centre = max(cell.centre, depth)
