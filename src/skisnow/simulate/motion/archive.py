"""Tracks left behind: pieces of lines, found again by place."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import MAKING, PLAIN
from .lines import (
    CELL,
    CELLS,
    CENTRE,
    DEEPEST,
    FROM,
    KEPT,
    LOST,
    MARGIN,
    NOTHING,
    SLOPE,
    TO,
    WINDOW,
    Lines,
    energy_left,
    ground_slope,
    open_window,
)
from .model import State

FloatArray: TypeAlias = npt.NDArray[np.float64]
SmallArray: TypeAlias = npt.NDArray[np.float32]
IntArray: TypeAlias = npt.NDArray[np.int64]

BUCKET = 0.0625
"""Size (m) of the squares in which pieces are looked up."""
LONGEST = 0.12
"""Longest piece (m): as wide as the track of a flat ski, which a run tells piece by piece."""
BUCKETS = 32768
ALL = 1 << 62
"""Number of a piece that none has."""
SWEEP = 0.005
"""Cells that an edge leaves sideways grow until they reach as far (m): on ice it would leave them at every step. With
half as much a skid on ice ends 1 cm elsewhere, with twice as much 5 cm (Choice)."""


class Archive(NamedTuple):
    """Pieces of lines. `frame` as in `Lines`, `cells` in one pool."""

    frame: FloatArray  # (m, 12)
    cell: FloatArray  # (m,)
    slope: FloatArray  # (m,)
    drift: FloatArray  # (m,) how far the groove goes aside for each metre ahead
    start: IntArray  # (m, 3): number of the first cell, how many, place in the pool
    pool: SmallArray  # (l, 3): deepest, covered from and to, both from the cell's middle (m)
    head: IntArray  # (BUCKETS,) newest piece of each square, -1: none
    before: IntArray  # (m,) the next older piece of its square
    used: IntArray  # (3,) pieces, places in the pool; pieces from this one on are not recalled yet
    lost: FloatArray  # (1,) energy lost in what left the skis (J)
    course: FloatArray  # (3, 3) in space: the sledge's place, velocity and turning now, which lead its grooves


def new_archive(pieces: int, places: int) -> Archive:
    """Room for that many pieces, and places of cells."""
    return Archive(
        np.zeros((pieces, 12)),
        np.zeros(pieces),
        np.zeros(pieces),
        np.zeros(pieces),
        np.zeros((pieces, 3), np.int64),
        np.zeros((places, 3), np.float32),
        np.full(BUCKETS, -1, np.int64),
        np.zeros(pieces, np.int64),
        np.array([0, 0, ALL], np.int64),
        np.zeros(1),
        np.zeros((3, 3)),
    )


def grown(archive: Archive, pieces: int, places: int) -> Archive:
    """The same archive with room for more."""
    larger = new_archive(pieces, places)
    m, places_used = (int(n) for n in archive.used[:2])
    larger.frame[:m], larger.cell[:m], larger.slope[:m] = archive.frame[:m], archive.cell[:m], archive.slope[:m]
    larger.drift[:m], larger.start[:m], larger.before[:m] = archive.drift[:m], archive.start[:m], archive.before[:m]
    larger.pool[:places_used] = archive.pool[:places_used]
    larger.head[:], larger.used[:], larger.lost[:] = archive.head, archive.used, archive.lost
    larger.course[:] = archive.course
    return larger


@compiled(**PLAIN, inline="always")
def _square(x: float) -> int:
    """Number of the squares in which a coordinate lies."""
    return int(np.floor(x / BUCKET))


@compiled(**PLAIN, inline="always")
def _bucket(a: int, b: int) -> int:
    return (a * 73856093 ^ b * 19349663) & (BUCKETS - 1)


@compiled(**PLAIN)
def put_away(archive: Archive, lines: Lines, row: int, first: int, last: int, hardness: float, excess: float) -> None:
    """Archive the cells first ≤ j < last of a line where a base has been, and count the energy lost there."""
    archive.lost[0] += energy_left(lines, row, first, last, hardness, excess)
    start = lines.flag[row, WINDOW]
    j = first
    while j < last:
        if not _covered(lines, row, j - start):
            j += 1
            continue
        end = j
        while end < last and _covered(lines, row, end - start):
            end += 1
        _add_pieces(archive, lines, row, j, end)
        j = end


@compiled(**PLAIN)
def _add_pieces(archive: Archive, lines: Lines, row: int, first: int, last: int) -> None:
    """Archive the cells first ≤ j < last, cut in pieces that are the same counted from the left or from the right."""
    most, whole = max(1, int(LONGEST / lines.value[row, CELL])), last - first
    pieces = (whole + most - 1) // most
    pieces += 1 - pieces % 2  # an odd number: what is over goes to the middle
    each = whole // pieces
    over = whole - each * pieces
    j = first
    for piece in range(pieces):
        outer = min(piece, pieces - 1 - piece)  # of so many pairs and the middle, the outer ones take one more each
        end = j + each + (1 if outer < over // 2 or (over % 2 == 1 and 2 * piece == pieces - 1) else 0)
        if end > j:
            _add(archive, lines, row, j, end)
        j = end


@compiled(**PLAIN, inline="always")
def _covered(lines: Lines, row: int, place: int) -> bool:
    i = np.uint64(place)
    return lines.cells[row, TO + i] > lines.cells[row, FROM + i]


@compiled(**PLAIN)
def _add(archive: Archive, lines: Lines, row: int, first: int, last: int) -> None:
    m, place = archive.used[0], archive.used[1]
    if m >= len(archive.cell) or place + last - first > len(archive.pool):
        return  # the caller keeps room; see `room_left`
    start = lines.flag[row, WINDOW]
    cell = lines.value[row, CELL]
    for a in range(12):
        archive.frame[m, a] = lines.frame[row, a]
    archive.cell[m] = cell
    archive.slope[m] = ground_slope(lines, row)
    archive.start[m, 0], archive.start[m, 1], archive.start[m, 2] = first, last - first, place
    for j in range(first, last):
        i, p, middle = np.uint64(j - start), place + j - first, (j + 0.5) * cell
        # what was extended to the cell's middle may be deeper than any base that came there
        at_middle = lines.cells[row, CENTRE + i]
        archive.pool[p, 0] = at_middle if at_middle > 0.0 else lines.cells[row, DEEPEST + i]
        archive.pool[p, 1] = lines.cells[row, FROM + i] - middle
        archive.pool[p, 2] = lines.cells[row, TO + i] - middle
    y = 0.5 * (first + last) * cell
    archive.drift[m] = _drift(archive.course, archive.frame[m], y)
    square = _bucket(
        _square(archive.frame[m, 0] + y * archive.frame[m, 6]), _square(archive.frame[m, 1] + y * archive.frame[m, 7])
    )
    archive.before[m] = archive.head[square]
    archive.head[square] = m
    archive.used[0] = m + 1
    archive.used[1] = place + last - first


@compiled(**PLAIN, fastmath={"contract"})
def set_course(archive: Archive, state: State) -> None:
    """Note how the sledge moves: which way what it leaves goes on."""
    R, V, course = state.turn, state.velocity, archive.course
    for a in range(3):
        course[0, a] = state.place[a]
        course[1, a] = R[a, 0] * V[0] + R[a, 1] * V[1] + R[a, 2] * V[2]
        course[2, a] = R[a, 0] * V[3] + R[a, 1] * V[4] + R[a, 2] * V[5]


@compiled(**PLAIN, inline="always")
def _drift(course: FloatArray, frame: FloatArray, y: float) -> float:
    """How far what is left at y on a line goes aside for each metre ahead; none where it moves along the line."""
    rx, ry = frame[0] + y * frame[6] - course[0, 0], frame[1] + y * frame[7] - course[0, 1]
    rz = frame[2] + y * frame[8] - course[0, 2]
    vx = course[1, 0] + course[2, 1] * rz - course[2, 2] * ry
    vy = course[1, 1] + course[2, 2] * rx - course[2, 0] * rz
    vz = course[1, 2] + course[2, 0] * ry - course[2, 1] * rx
    ahead, aside = vx * frame[3] + vy * frame[4] + vz * frame[5], vx * frame[6] + vy * frame[7] + vz * frame[8]
    return ahead * aside / max(ahead * ahead, aside * aside, 1e-12)


@compiled(**PLAIN)
def meets_older(archive: Archive, x: float, y: float, reach: float) -> bool:
    """Whether there is any older track within reach (m) of a place, about."""
    around = reach + LONGEST  # pieces stand in the square of their middle
    for i in range(_square(x - around), _square(x + around) + 1):
        for j in range(_square(y - around), _square(y + around) + 1):
            if archive.head[_bucket(i, j)] >= 0:
                return True
    return False


@compiled(**PLAIN)
def recall(archive: Archive, lines: Lines, row: int, first: int, last: int, hardness: float, excess: float) -> bool:
    """Bring older tracks into the cells first ≤ j < last of a line, and tell whether there were any."""
    cell = lines.value[row, CELL]
    frame = lines.frame[row]
    y = 0.5 * (first + last) * cell
    reach = 0.5 * (last - first) * cell
    x0, y0, z0 = frame[0] + y * frame[6], frame[1] + y * frame[7], frame[2] + y * frame[8]
    around, found = reach + 0.5 * LONGEST + lines.spacing[0], False
    for i in range(_square(x0 - around), _square(x0 + around) + 1):
        for j in range(_square(y0 - around), _square(y0 + around) + 1):
            piece = archive.head[_bucket(i, j)]
            while piece >= 0:
                if piece < archive.used[2] and _lies_on(
                    archive, piece, x0, y0, z0, frame, reach, 0.5 * lines.spacing[0]
                ):
                    found = _take_over(archive, piece, lines, row, first, last) or found
                piece = archive.before[piece]
    if found:
        lines.value[row, LOST] += energy_left(lines, row, first, last, hardness, excess)
    return found


@compiled(**PLAIN, inline="always")
def _lies_on(
    archive: Archive, piece: int, x: float, y: float, z: float, frame: FloatArray, reach: float, wide: float
) -> bool:
    """Whether a piece may lie on a line's cells within reach of a place; a piece counts `wide` before and behind."""
    other = archive.frame[piece]
    ex, ey, ez = x - other[0], y - other[1], z - other[2]
    tilt = abs(frame[6] * other[3] + frame[7] * other[4] + frame[8] * other[5])
    if abs(ex * other[3] + ey * other[4] + ez * other[5]) > wide + reach * tilt:
        return False
    half = 0.5 * archive.start[piece, 1] * archive.cell[piece]
    across = ex * other[6] + ey * other[7] + ez * other[8]
    aside = wide * abs(archive.drift[piece])
    return abs(across - archive.start[piece, 0] * archive.cell[piece] - half) <= half + reach + aside


@compiled(**PLAIN)
def _take_over(archive: Archive, piece: int, lines: Lines, row: int, first: int, last: int) -> bool:
    cell, old, start = lines.value[row, CELL], archive.cell[piece], lines.flag[row, WINDOW]
    frame, other = lines.frame[row], archive.frame[piece]
    found = False
    for j in range(first, last):
        middle = (j + 0.5) * cell
        ex = frame[0] + middle * frame[6] - other[0]
        ey = frame[1] + middle * frame[7] - other[1]
        ez = frame[2] + middle * frame[8] - other[2]
        along = ex * other[3] + ey * other[4] + ez * other[5]
        if abs(along) > 0.5 * lines.spacing[0]:
            continue
        y = ex * other[6] + ey * other[7] + ez * other[8] - archive.drift[piece] * along
        number = int(np.floor(y / old))
        at = number - archive.start[piece, 0]
        if at < 0 or at >= archive.start[piece, 1]:
            continue
        p = archive.start[piece, 2] + at
        offset = y - (number + 0.5) * old
        if offset < archive.pool[p, 1] or offset > archive.pool[p, 2]:
            continue
        # straight from the middle of a cell to the next one's, at a piece's end as beside it
        first, last = archive.start[piece, 2], archive.start[piece, 2] + archive.start[piece, 1] - 1
        near = min(p if offset > 0.0 else p - 1, last - 1)
        slope = archive.slope[piece]
        if last > first:
            near = max(near, first)
            slope = (archive.pool[near + 1, 0] - archive.pool[near, 0]) / old
        here = archive.pool[p, 0] + slope * offset
        i = np.uint64(j - start)
        if here > max(lines.cells[row, DEEPEST + i], 0.0):
            lines.cells[row, DEEPEST + i] = lines.cells[row, CENTRE + i] = here
            lines.cells[row, FROM + i], lines.cells[row, TO + i] = j * cell, (j + 1) * cell
            found = True
    return found


@compiled(**PLAIN)
def look_ahead(archive: Archive, lines: Lines, row: int, hardness: float, excess: float) -> None:
    """Give a fresh line the older tracks that lie on it, if there are any."""
    if not meets_older(archive, lines.frame[row, 0], lines.frame[row, 1], 0.5 * CELLS * lines.value[row, CELL]):
        return
    open_window(lines, row, -CELLS // 2)
    if not recall(archive, lines, row, -CELLS // 2, CELLS - CELLS // 2, hardness, excess):
        lines.flag[row, KEPT] = 0


@compiled(**PLAIN)
def make_room(
    archive: Archive, lines: Lines, row: int, low: float, high: float, hardness: float, excess: float
) -> None:  # fmt: skip
    """Bring a line's cells to where it is touched now: open them, move them along, or make them coarser."""
    fresh = lines.flag[row, KEPT] == 0
    while (high - low) / lines.value[row, CELL] > CELLS - 4 * MARGIN:
        if fresh:
            lines.value[row, CELL] *= 2.0
        else:
            _coarsen(lines, row)
    cell = lines.value[row, CELL]
    first, last = int(np.floor(low / cell)) - MARGIN, int(np.floor(high / cell)) + MARGIN
    start = lines.flag[row, WINDOW]
    if not fresh and start <= first and last < start + CELLS:
        return
    while not fresh and cell * CELLS < SWEEP:
        _coarsen(lines, row)
        cell, start = lines.value[row, CELL], lines.flag[row, WINDOW]
        first, last = int(np.floor(low / cell)) - MARGIN, int(np.floor(high / cell)) + MARGIN
        if start <= first and last < start + CELLS:
            return
    new = _mirrored_half(first + last + 1) - CELLS // 2
    if fresh:
        open_window(lines, row, new)
        y = (new + 0.5 * CELLS) * cell
        x0, y0 = lines.frame[row, 0] + y * lines.frame[row, 6], lines.frame[row, 1] + y * lines.frame[row, 7]
        if meets_older(archive, x0, y0, 0.5 * CELLS * cell):
            recall(archive, lines, row, new, new + CELLS, hardness, excess)
        return
    before = lines.value[row, LOST]
    if new >= start + CELLS or new + CELLS <= start:
        put_away(archive, lines, row, start, start + CELLS, hardness, excess)
        archive.lost[0] -= before
        lines.value[row, LOST] = 0.0
        open_window(lines, row, new)
        recall(archive, lines, row, new, new + CELLS, hardness, excess)
        return
    gone_from, gone_to = (start, new) if new > start else (new + CELLS, start + CELLS)
    put_away(archive, lines, row, gone_from, gone_to, hardness, excess)
    _move_window(lines, row, new - start)
    lines.flag[row, WINDOW] = new
    if new > start:
        recall(archive, lines, row, start + CELLS, new + CELLS, hardness, excess)
    else:
        recall(archive, lines, row, new, start, hardness, excess)


@compiled(**PLAIN, inline="always")
def _mirrored_half(number: int) -> int:
    """Half of a number, cut towards zero: of cells that are counted from the left or from the right the same."""
    return number // 2 if number >= 0 else -(-number // 2)


@compiled(**PLAIN)
def _move_window(lines: Lines, row: int, by: int) -> None:
    """Move a line's cells down by so many places, and empty those that become free; |by| < cells."""
    for column in range(4):
        about = lines.cells[row, CELLS * column : CELLS * (column + 1)]
        nothing = NOTHING if column == 1 else 0.0 if column == 3 else -NOTHING
        if by > 0:
            for i in range(CELLS):
                about[i] = about[i + by] if i + by < CELLS else nothing
        else:
            for i in range(CELLS - 1, -1, -1):
                about[i] = about[i + by] if i + by >= 0 else nothing


@compiled(**MAKING)
def _coarsen(lines: Lines, row: int) -> None:
    """Double the size of a line's cells."""
    start, cell, slope = lines.flag[row, WINDOW], lines.value[row, CELL], lines.value[row, SLOPE]
    deepest, low, high = np.full(CELLS, -NOTHING), np.full(CELLS, NOTHING), np.full(CELLS, -NOTHING)
    centre, both = np.zeros(CELLS), np.zeros(CELLS, np.int64)
    new = _mirrored_half(start + CELLS // 2) - CELLS // 2
    for j in range(start, start + CELLS):
        i, target = np.uint64(j - start), int(np.floor(j / 2))
        if lines.cells[row, TO + i] > lines.cells[row, FROM + i]:
            t = target - new
            shift = slope * ((target + 0.5) * 2.0 * cell - (j + 0.5) * cell)
            deepest[t] = max(deepest[t], lines.cells[row, DEEPEST + i] + shift)
            centre[t] += 0.5 * lines.cells[row, CENTRE + i]
            both[t] += 1 if lines.cells[row, CENTRE + i] > 0.0 else 0
            low[t], high[t] = min(low[t], lines.cells[row, FROM + i]), max(high[t], lines.cells[row, TO + i])
    lines.value[row, CELL], lines.flag[row, WINDOW] = 2.0 * cell, new
    for each in range(np.uint64(CELLS)):
        lines.cells[row, DEEPEST + each] = deepest[each]
        lines.cells[row, FROM + each], lines.cells[row, TO + each] = low[each], high[each]
        lines.cells[row, CENTRE + each] = centre[each] if both[each] == 2 else 0.0


@compiled(**PLAIN)
def leave_line(archive: Archive, lines: Lines, row: int, hardness: float, excess: float) -> None:
    """Archive a line that the ski has left."""
    if lines.flag[row, KEPT] == 1:
        start = lines.flag[row, WINDOW]
        put_away(archive, lines, row, start, start + CELLS, hardness, excess)
        archive.lost[0] -= lines.value[row, LOST]
        lines.flag[row, KEPT] = 0
