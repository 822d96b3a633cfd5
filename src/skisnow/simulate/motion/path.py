"""Lines laid ahead of the skis and taken up behind them; what the skis do to the snow once a step is accepted."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .archive import ALL, Archive, leave_line, look_ahead, make_room
from .compiled import MAKING, PLAIN
from .lines import (
    ABOVE,
    ANCHOR,
    ANCHORED,
    CELL,
    CELLS,
    DEEP_NOW,
    DEPTH,
    DEPTH_MARKED,
    EDGE,
    EDGE_MARKED,
    FALL,
    HIGH,
    KEPT,
    LOST,
    LOW,
    MARGIN,
    MARKED,
    SWEPT,
    TOUCHED,
    WINDOW,
    Lines,
    anchor_of,
    begin_line,
    cut_of,
    energy_left,
    mark_cells,
    mark_cut,
    mark_swept,
)
from .model import Model, Snow, State, World

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

AHEAD: Final = 0.12
"""Distance (m) before tip and behind tail in which lines are laid: more than a ski moves in a step."""
BESIDE: Final = 0.04
"""Half the width of a ski (m), about: where the edge will cross a line (no accuracy hangs on it)."""
NEWTON_STEPS: Final = 3
"""To the place on a curved surface: off by 1 cm at the first, by its square over the radius at the next."""
MOST_TURN: Final = 0.3
"""Angle (rad) between a line's direction ahead and the ski beyond which the lines are laid anew (Choice)."""

FURTHER: Final = 1.5
"""How much farther than in this step an edge may go aside in the next (Choice)."""
MOST_UNEVEN: Final = 0.25
"""Share of their spacing by which the lines may lie nearer or farther from each other before they are laid anew
(Choice)."""


@compiled(**PLAIN)
def surface(world: World, x: float) -> tuple[float, float]:
    """Height of the slope (m) and its gradient at x."""
    if len(world.heights) == 1:
        return 0.0, 0.0
    at = (x - world.slope_start) / world.slope_step
    i = min(max(int(np.floor(at)), 0), len(world.heights) - 2)
    h = world.slope_step
    f = min(max(at - i, 0.0), 1.0)
    z0, z1, g0, g1 = world.heights[i, 0], world.heights[i + 1, 0], world.heights[i, 1], world.heights[i + 1, 1]
    e = 1.0 - f
    height = e * e * (1.0 + 2.0 * f) * z0 + f * f * (3.0 - 2.0 * f) * z1 + h * f * e * (e * g0 - f * g1)
    gradient = 6.0 * f * e * (z1 - z0) / h + e * (1.0 - 3.0 * f) * g0 + f * (3.0 * f - 2.0) * g1
    return height + (at - i - f) * h * gradient, gradient


@compiled(**MAKING)
def _lay(
    model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, state: State, k: int, s: float, way: float
) -> None:  # fmt: skip
    """Lay a line of ski k at station s of its straight axis, before the others (way > 0) or behind them."""
    ring = len(lines.flag) // 2
    R = state.turn
    y = model.middle[k, 1]
    lateral, frame = np.zeros(3), np.zeros(12)
    for a in range(3):
        lateral[a] = R[a, 1] * model.lateral[1] + R[a, 2] * model.lateral[2]
    side = min(max(-lateral[2] / snow.one_sided, -1.0), 1.0) * BESIDE
    for a in range(3):
        frame[a] = state.place[a] + R[a, 1] * y + s * R[a, 0] + side * lateral[a]
    # on the surface at this station: straight below or above it would be another, and lines crowd where a ski runs into
    # a hollow
    x, y, z, level, ahead = frame[0], frame[1], frame[2], R[0, 0] * R[0, 0] + R[1, 0] * R[1, 0], 0.0
    for _ in range(NEWTON_STEPS):
        height, gradient = surface(world, x + ahead * R[0, 0])
        ahead -= (ahead * level + (height - z) * R[2, 0]) / (level + gradient * R[0, 0] * R[2, 0])
    frame[0], frame[1] = x + ahead * R[0, 0], y + ahead * R[1, 0]
    frame[2], gradient = surface(world, frame[0])
    size = 1.0 / np.sqrt(1.0 + gradient * gradient)
    n0, n2 = -gradient * size, size
    # ahead: the ski's axis in the surface
    up = R[0, 0] * n0 + R[2, 0] * n2
    d0, d1, d2 = R[0, 0] - up * n0, R[1, 0], R[2, 0] - up * n2
    size = 1.0 / np.sqrt(d0 * d0 + d1 * d1 + d2 * d2)
    d0, d1, d2 = d0 * size, d1 * size, d2 * size
    frame[3], frame[4], frame[5] = d0, d1, d2
    frame[6], frame[7], frame[8] = -n2 * d1, n2 * d0 - n0 * d2, n0 * d1
    frame[9], frame[10], frame[11] = n0, 0.0, n2
    if way > 0.0:
        row = k * ring + (lines.first[k] + lines.count[k]) % ring
    else:
        lines.first[k] = (lines.first[k] - 1) % ring
        row = k * ring + lines.first[k]
    lines.count[k] += 1
    begin_line(lines, row, frame)
    look_ahead(archive, lines, row, snow.hardness, snow.excess)


@compiled(**PLAIN)
def _station(model: Model, lines: Lines, state: State, k: int, number: int) -> float:
    """Station at which ski k's line `number`, counted from the tail, goes through under the straight axis."""
    R, side, frame = state.turn, model.middle[k, 1], lines.frame
    row = k * (len(lines.flag) // 2) + (lines.first[k] + number) % (len(lines.flag) // 2)
    along, across, line_along, line_across = 0.0, 0.0, 0.0, 0.0
    for a in range(3):
        there = frame[row, a] - state.place[a] - R[a, 1] * side
        along += there * R[a, 0]
        across += there * R[a, 1]
        line_along += frame[row, 6 + a] * R[a, 0]
        line_across += frame[row, 6 + a] * R[a, 1]
    return along - across * line_along / line_across


@compiled(**PLAIN)
def follow(model: Model, snow: Snow, world: World, lines: Lines, archive: Archive, state: State) -> None:
    """Take up the lines that the skis have left, then lay those they will meet: both meet what either left."""
    ring = len(lines.flag) // 2
    spacing = lines.spacing[0]
    for k in range(2):
        if lines.count[k] > 0 and _has_turned(lines, state, k):
            _leave_all(snow, lines, archive, k)
        while lines.count[k] > 0 and _station(model, lines, state, k, 0) < model.tail - AHEAD - 3.0 * spacing:
            leave_line(archive, lines, k * ring + lines.first[k], snow.hardness, snow.excess)
            lines.first[k] = (lines.first[k] + 1) % ring
            lines.count[k] -= 1
        while lines.count[k] > 0 and _station(model, lines, state, k, lines.count[k] - 1) > (
            model.tip + AHEAD + 3.0 * spacing
        ):
            last = (lines.first[k] + lines.count[k] - 1) % ring
            leave_line(archive, lines, k * ring + last, snow.hardness, snow.excess)
            lines.count[k] -= 1
    for k in range(2):
        if lines.count[k] == 0:
            _lay(model, snow, world, lines, archive, state, k, 0.0, spacing)
        s = _station(model, lines, state, k, lines.count[k] - 1)
        while s < model.tip + AHEAD and lines.count[k] < ring:
            s += spacing
            _lay(model, snow, world, lines, archive, state, k, s, spacing)
        s = _station(model, lines, state, k, 0)
        while s > model.tail - AHEAD and lines.count[k] < ring:
            s -= spacing
            _lay(model, snow, world, lines, archive, state, k, s, -spacing)


@compiled(**PLAIN)
def lay_anew(model: Model, snow: Snow, lines: Lines, archive: Archive, state: State) -> None:
    """Leave lines that have come to lie unevenly under a ski: where it has slipped far, those of other directions.

    Their snow is remembered, and `follow` lays others.
    """
    for k in range(2):
        if _is_uneven(model, lines, state, k):
            _leave_all(snow, lines, archive, k)


@compiled(**PLAIN)
def _is_uneven(model: Model, lines: Lines, state: State, k: int) -> bool:
    """Whether neighbouring lines cross the ski's axis nearer or farther from each other than they may."""
    spacing, before = lines.spacing[0], _station(model, lines, state, k, 0)
    for number in range(1, lines.count[k]):
        s = _station(model, lines, state, k, number)
        if abs(s - before - spacing) > MOST_UNEVEN * spacing:
            return True
        before = s
    return False


@compiled(**PLAIN)
def _has_turned(lines: Lines, state: State, k: int) -> bool:
    ring = len(lines.flag) // 2
    row = k * ring + lines.first[k] % ring
    R = state.turn
    ahead = R[0, 0] * lines.frame[row, 3] + R[1, 0] * lines.frame[row, 4] + R[2, 0] * lines.frame[row, 5]
    across = R[0, 0] * lines.frame[row, 6] + R[1, 0] * lines.frame[row, 7] + R[2, 0] * lines.frame[row, 8]
    return abs(np.arctan2(across, ahead)) > MOST_TURN


@compiled(**PLAIN)
def _leave_all(snow: Snow, lines: Lines, archive: Archive, k: int) -> None:
    ring = len(lines.flag) // 2
    for c in range(lines.count[k]):
        leave_line(archive, lines, k * ring + (lines.first[k] + c) % ring, snow.hardness, snow.excess)
    lines.count[k] = 0


@compiled(**PLAIN)
def press(snow: Snow, lines: Lines, archive: Archive) -> None:
    """Let the snow remember the bases that touch its lines now, and where the edges hold."""
    ring = len(lines.flag) // 2
    value, flag, cells = lines.value, lines.flag, lines.cells
    archive.used[2] = archive.used[0]  # neither ski meets what the other leaves now
    for k in range(2):
        for c in range(lines.count[k]):
            row = k * ring + (lines.first[k] + c) % ring
            if flag[row, TOUCHED] == 0:
                flag[row, MARKED] = 0
                continue
            cell, start = value[row, CELL], flag[row, WINDOW]
            edge, low, high = value[row, EDGE], value[row, LOW], value[row, HIGH]
            swept = flag[row, MARKED] == 1 and (edge - value[row, EDGE_MARKED]) * value[row, FALL] < 0.0
            cut = cut_of(value, flag, row, edge, low, high, value[row, FALL])
            if swept or cut != 0.0:
                before = value[row, EDGE_MARKED]
                # where it was, and where it may be after the next step: what lies there must be known then
                further = FURTHER * (edge - before) if edge in (low, high) else 0.0
                low, high = min(low, low + further, before), max(high, high + further, before)
            reach = MARGIN * cell
            if flag[row, KEPT] == 0 or low - reach < start * cell or high + reach >= (start + CELLS) * cell:
                make_room(archive, lines, row, low, high, snow.hardness, snow.excess)
            known = -1
            if swept:
                if mark_swept(cells, value, row, flag[row, WINDOW]):
                    flag[row, SWEPT] = 1
            elif cut != 0.0:
                known = mark_cut(cells, value, row, flag[row, WINDOW], cut)
            mark_cells(cells, value, row, flag[row, WINDOW], known)
            value[row, EDGE_MARKED], value[row, DEPTH_MARKED], flag[row, MARKED] = edge, value[row, DEPTH], 1
            anchor = anchor_of(value, flag, row, edge, value[row, DEEP_NOW])
            value[row, ANCHOR] = max(min(anchor, edge + snow.holding), edge - snow.holding)
            flag[row, ANCHORED], flag[row, ABOVE] = 1, 0
    archive.used[2] = ALL


@compiled(**PLAIN)
def energy_in_snow(snow: Snow, lines: Lines, archive: Archive) -> float:
    """Energy lost to the grooves so far (J), those under the skis included."""
    ring = len(lines.flag) // 2
    total = archive.lost[0]
    for k in range(2):
        for c in range(lines.count[k]):
            row = k * ring + (lines.first[k] + c) % ring
            if lines.flag[row, KEPT] == 1:
                start = lines.flag[row, WINDOW]
                total += energy_left(lines, row, start, start + CELLS, snow.hardness, snow.excess)
                total -= lines.value[row, LOST]
    return total
