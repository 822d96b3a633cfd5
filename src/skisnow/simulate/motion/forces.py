"""Forces of snow on the skis of a sledge, and their tangent, line by line.

The shear acts across the edge, glide friction and the resistance of compaction along it. An edge that runs in its own
track does no work against the shear.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN, SUMS

# isort: off
from .columns import (
    ARM, ASIDE, C0, C1, C2, CLIMB, COLUMNS, COSINE, D0, D1, D2, DEEP, EDGE_AT, EDGE_DEEP, FALLING, FLARE, FORCE, H0,
    H1, H2, HALF, HEIGHT, HOLD, K1, K2, LATERAL, LEFT, LEFT_MOVES, LENGTH, MOMENT, N0, N1, N2, NORMAL_AHEAD, REACH,
    RESIST, RIGHT, RIGHT_MOVES, RISE, RUB, S, SHARE, SHEARING, SINE, SIZE, SLIDING, SPRING, STEEP, STIFF0, STIFF1,
    STIFF2, T0, T1, T2, TILT, TURNING, TWISTING, TWIST_RATE, U0, U1, U2, UP, USED, VS, VT, VW, W0, W1, W2, W3,
    WET_FROM, WET_TO, WIDE, WIDTH, WS, WT, WW, Y0, Y1, Y2, Z,
)  # fmt: skip

# isort: on
from .lines import (
    ABOVE,
    ANCHORED,
    CELL,
    CELLS,
    DEEP_ABOVE,
    DEEP_NOW,
    DEEPEST,
    DEPTH,
    EDGE,
    EDGE_ABOVE,
    FALL,
    HIGH,
    KEPT,
    LOW,
    SLOPE,
    TOUCHED,
    WINDOW,
    Lines,
    anchor_of,
    cut_of,
    energy_at_edge,
    ground_cut,
    slope_cut,
)
from .model import PADDING, Model, Snow, State
from .pressure import bear, sum_cells
from .sections import ELEMENT, FRONT, ONE, REAR, ROW, TWO, find_sections
from .tangent import CHANNELS, add_tangent

FloatArray: TypeAlias = npt.NDArray[np.float64]
PlaceArray: TypeAlias = npt.NDArray[np.uint64]

FAR = 1 << 40
YIELDS = 1.0 + 1e-6
"""Share of its grip at which an edge counts as yielding in the tangent: one at rest with all of it in use holds,
and rounding does not choose."""

# entries of `power`
SHEAR, FRICTION, SIDEWAYS, RELEASED, SPRINGY, HELD, NORMAL = 0, 1, 2, 3, 4, 5, 6


class Forces(NamedTuple):
    """Generalised forces of the snow, and their tangent; the skis' rows are padded in `bend` alone."""

    rigid: FloatArray  # (6,)
    bend: FloatArray  # (2, n + 10)
    band: FloatArray  # (2, n, 6) minus the tangent, lower half
    channels: FloatArray  # (2, n, CHANNELS) minus the tangent between beam and channels
    corner: FloatArray  # (2, CHANNELS, CHANNELS) upper half
    power: FloatArray  # (7,) W of shear and friction; given sideways, released; J springy and held; W of normal force
    section: (
        FloatArray  # (2, ring, 4) of each line from the tail: station, force, shear (N), edge depth; see `sections`
    )
    sections: npt.NDArray[np.int64]  # (2,) how many
    sheet: FloatArray  # (COLUMNS × WIDTH,) working space: sections of the ski that is looked at, see `columns`
    numbers: PlaceArray  # (WIDTH, 4) their line, element, and places of its unknowns
    skis: FloatArray  # (3, 3) directions of both skis in space: ahead, across the base to the left, off the snow


def new_forces(size: int, ring: int) -> Forces:
    """Empty arrays for skis with that many unknowns and a ring of that many lines."""
    return Forces(
        np.zeros(6),
        np.zeros((2, size + 2 * PADDING)),
        np.zeros((2, size, 6)),
        np.zeros((2, size, CHANNELS)),
        np.zeros((2, CHANNELS, CHANNELS)),
        np.zeros(7),
        np.zeros((2, ring, 4)),
        np.zeros(2, np.int64),
        np.zeros(COLUMNS * WIDTH),
        np.zeros((WIDTH, 4), np.uint64),
        np.zeros((3, 3)),
    )


@compiled(**PLAIN, fastmath={"contract"})
def feel(model: Model, snow: Snow, lines: Lines, state: State, tangent: bool, look: bool, out: Forces) -> None:
    """Fill `out` with the forces at a state, with `tangent` also their tangent, with `look` powers and touches."""
    out.rigid[:] = 0.0
    out.bend[:] = 0.0
    if look:
        out.power[:] = 0.0
    if tangent:
        out.band[:] = 0.0
        out.channels[:] = 0.0
        out.corner[:] = 0.0
    R, frame, lateral, normal = state.turn, out.skis, model.lateral, model.normal
    for a in range(3):
        frame[0, a] = R[a, 0]
        frame[1, a] = R[a, 1] * lateral[1] + R[a, 2] * lateral[2]
        frame[2, a] = R[a, 1] * normal[1] + R[a, 2] * normal[2]
    for k in range(2):
        if look:
            out.sections[k] = 0
        for begin in range(0, lines.count[k], WIDTH):
            count = np.uint64(min(lines.count[k] - begin, WIDTH))
            find_sections(model, snow.one_sided, lines, state, frame, k, begin, count, out.sheet, out.numbers)
            _press(snow, lines, count, look, out.sheet, out.numbers)
            _push(model, snow, state, k, count, out.sheet, out.rigid)
            _bend(count, out.sheet, out.numbers, out.bend[k])
            if look:
                _record(lines, k, count, out)
                _sum_powers(model, snow, state, lines.spacing[0], count, out.sheet, out.power)
                out.power[SIDEWAYS] += _cover_ground(snow, lines, count, out.sheet, out.numbers)
            if tangent:
                _add_tangents(model, snow, k, count, out)


@compiled(**PLAIN, fastmath=SUMS)
def _press(snow: Snow, lines: Lines, count: np.uint64, look: bool, sheet: FloatArray, numbers: PlaceArray) -> None:
    """Let the snow answer the sections that lie in it; the others get no force."""
    cells, value, flag = lines.cells, lines.value, lines.flag
    per_holding, ratio, fresh = 1.0 / snow.holding, snow.excess / snow.hardness, lines.spacing[1]
    per_fresh = 1.0 / fresh
    for i in range(count):
        row, weight, deep, edge = numbers[i, ROW], sheet[SHARE + i], sheet[DEEP + i], sheet[EDGE_AT + i]
        if look:
            flag[row, TOUCHED] = 0
        if not (weight > 0.0 and deep > 0.0):
            sheet[HOLD + i], sheet[USED + i] = 0.0, 0.0
            if look and weight > 0.0:
                # the anchor of a line is where the edge meets the surface, within a step
                value[row, EDGE_ABOVE], value[row, DEEP_ABOVE] = edge, deep
                flag[row, ANCHORED], flag[row, ABOVE] = 0, 1
            continue
        # a line that nothing has touched has no cells: its window lies far off
        window = flag[row, WINDOW] if flag[row, KEPT] == 1 else FAR
        cell = value[row, CELL]
        per_cell = per_fresh if cell == fresh else 1.0 / cell
        cut = cut_of(
            value, flag, row, edge, edge + sheet[WET_FROM + i], edge + sheet[WET_TO + i], sheet[FALLING + i]
        )  # fmt: skip
        if cut == 0.0:
            sum_cells(sheet, i, cells, row, window, cell, per_cell, ratio)
        else:
            # the ground that the edge has cut within the step, for this look alone
            first, last = _lay_cut(lines, sheet, i, row, window, cut, per_cell)
            sum_cells(sheet, i, cells, row, window, cell, per_cell, ratio)
            for j in range(first, last):
                cells[row, DEEPEST + j] = lines.spare[j]
        # the edge holds where it first took hold, with up to its strength
        sheet[HOLD + i] = snow.shear_stress * deep * weight
        sheet[USED + i] = (anchor_of(value, flag, row, edge, deep) - edge) * per_holding
    bear(count, snow.hardness, snow.excess, sheet)


@compiled(**PLAIN, fastmath={"contract"})
def _lay_cut(
    lines: Lines, sheet: FloatArray, i: np.uint64, row: np.uint64, window: int, cut: float, per_cell: float
) -> tuple[np.uint64, np.uint64]:  # fmt: skip
    """Put what the edge of line i has cut into the line's cells; which they are. What they held is in `spare`."""
    cells, value, edge, slope = lines.cells, lines.value, sheet[EDGE_AT + i], sheet[FALLING + i]
    depth, cell, spare = sheet[EDGE_DEEP + i], value[row, CELL], lines.spare
    end = edge + (sheet[WET_TO + i] if cut > 0.0 else sheet[WET_FROM + i])
    left = slope_cut(value, row, cut, depth, slope)
    low, high = min(edge, edge + cut), max(edge, edge + cut)
    first = np.uint64(min(max(int(np.floor(low * per_cell)) - window, 0), CELLS))
    last = np.uint64(min(max(int(np.floor(high * per_cell)) - window + 1, 0), CELLS))
    for j in range(first, last):
        spare[j] = cells[row, DEEPEST + j]
        cells[row, DEEPEST + j] = ground_cut(
            cells, row, j, float(window) + j, cell, edge, end, depth, slope, cut, left
        )  # fmt: skip
    return first, last


@compiled(**PLAIN, fastmath=SUMS)
def _push(  # noqa: PLR0915 - one loop over many lines at a time
    model: Model, snow: Snow, state: State, k: int, count: np.uint64, sheet: FloatArray, rigid: FloatArray
) -> None:  # fmt: skip
    """Work out what acts along and across the edge, and add the forces on the rigid body to `rigid`."""
    V = state.velocity
    side = model.middle[k, 1]
    left1, left2, up1, up2 = model.lateral[1], model.lateral[2], model.normal[1], model.normal[2]
    # velocity of the boot, and turning, in the ski's frame
    v0, va, vb = V[0] - V[5] * side, V[1], V[2] + V[3] * side
    v1, v2 = left1 * va + left2 * vb, up1 * va + up2 * vb
    o0, o1, o2 = V[3], left1 * V[4] + left2 * V[5], up1 * V[4] + up2 * V[5]
    mu, by_speed, compaction = snow.friction, snow.friction_by_speed, snow.compaction
    friction2 = snow.friction_speed * snow.friction_speed
    f0, f1, f2, g0, g1, g2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        s, sp, cp, sine = sheet[S + i], sheet[SINE + i], sheet[COSINE + i], sheet[TILT + i]
        n0, n1, n2, s0, s1, s2 = (
            sheet[N0 + i], sheet[N1 + i], sheet[N2 + i], sheet[T0 + i], sheet[T1 + i], sheet[T2 + i],
        )  # fmt: skip
        fall, k1, k2, reach = sheet[FALLING + i], sheet[K1 + i], sheet[K2 + i], sheet[REACH + i]
        # centre of pressure, on the base where it is wet: of a force that is rounding alone M/F would be anywhere
        F, M = sheet[FORCE + i], sheet[MOMENT + i]
        off = max(min(M / (F if F > 0.0 else 1.0), sheet[WET_TO + i]), sheet[WET_FROM + i])
        h0 = s + off * (sheet[Y0 + i] - fall * n0)
        h1, h2 = k1 + off * (sheet[Y1 + i] - fall * n1), k2 + off * (sheet[Y2 + i] - fall * n2)
        z, h = sheet[Z + i], sheet[LENGTH + i]
        y = 1.0 - z
        w0, w1, w2, w3 = y * y * (1.0 + 2.0 * z), h * z * y * y, z * z * (3.0 - 2.0 * z), -h * z * z * y
        bend_rate = w0 * sheet[VW + i] + w1 * sheet[VS + i] + w2 * sheet[WW + i] + w3 * sheet[WS + i]
        twist_rate = y * sheet[VT + i] + z * sheet[WT + i]
        arm = reach + off * sheet[WIDE + i]
        turning = twist_rate * arm
        c0 = v0 + o1 * h2 - o2 * h1
        c1 = v1 + o2 * h0 - o0 * h2 - sp * turning
        c2 = v2 + o0 * h1 - o1 * h0 + bend_rate - cp * turning
        sliding = c0 * s0 + c1 * s1 + c2 * s2
        by_twist = sheet[TWISTING + i] * M / (1.0 - sine * sine) * sheet[SIZE + i]
        resist = (F * sheet[CLIMB + i] + by_twist) * compaction
        rub = -(mu + by_speed * abs(sliding)) * F * sliding / np.sqrt(sliding * sliding + friction2)
        push = resist + rub
        # normal force and what acts along the edge at the centre of pressure, shear at the edge
        shear = sheet[HOLD + i] * min(max(sheet[USED + i], -1.0), 1.0)
        a0, a1, a2 = F * n0 + push * s0, F * n1 + push * s1, F * n2 + push * s2
        z0, z1, z2 = shear * sheet[U0 + i], shear * sheet[U1 + i], shear * sheet[U2 + i]
        f0 += a0 + z0
        f1 += a1 + z1
        f2 += a2 + z2
        g0 += h1 * a2 - h2 * a1 + k1 * z2 - k2 * z1
        g1 += h2 * a0 - h0 * a2 + k2 * z0 - s * z2
        g2 += h0 * a1 - h1 * a0 + s * z1 - k1 * z0
        sheet[H0 + i], sheet[H1 + i], sheet[H2 + i] = h0, h1, h2
        sheet[W0 + i], sheet[W1 + i], sheet[W2 + i], sheet[W3 + i] = w0, w1, w2, w3
        sheet[C0 + i], sheet[C1 + i], sheet[C2 + i] = c0, c1, c2
        sheet[SLIDING + i], sheet[ARM + i], sheet[TWIST_RATE + i] = sliding, arm, twist_rate
        sheet[RESIST + i], sheet[RUB + i], sheet[SHEARING + i] = resist, rub, shear
        sheet[UP + i] = a2 + z2
        sheet[TURNING + i] = -arm * (sp * a1 + cp * a2) - reach * (sp * z1 + cp * z2)
    # into the sledge's frame, about its origin
    p1, p2 = left1 * f1 + up1 * f2, left2 * f1 + up2 * f2
    rigid[0] += f0
    rigid[1] += p1
    rigid[2] += p2
    rigid[3] += g0 + side * p2
    rigid[4] += left1 * g1 + up1 * g2
    rigid[5] += left2 * g1 + up2 * g2 - side * f0


@compiled(**PLAIN, fastmath={"contract"})
def _bend(count: np.uint64, sheet: FloatArray, numbers: PlaceArray, force: FloatArray) -> None:
    """Add the forces on the beam."""
    for i in range(count):
        if not (sheet[SHARE + i] > 0.0 and sheet[DEEP + i] > 0.0):
            continue
        A, B, up, turn, z = numbers[i, FRONT], numbers[i, REAR], sheet[UP + i], sheet[TURNING + i], sheet[Z + i]
        force[A] += sheet[W0 + i] * up
        force[A + ONE] += sheet[W1 + i] * up
        force[A + TWO] += (1.0 - z) * turn
        force[B] += sheet[W2 + i] * up
        force[B + ONE] += sheet[W3 + i] * up
        force[B + TWO] += z * turn


@compiled(**PLAIN, fastmath={"contract"})
def _record(lines: Lines, k: int, count: np.uint64, out: Forces) -> None:
    """Write down what each section bears, and where the base touches its line."""
    sheet, section, value, flag = out.sheet, out.section, lines.value, lines.flag
    filled = out.sections[k]
    for i in range(count):
        if not sheet[SHARE + i] > 0.0:
            continue
        section[k, filled, 0], section[k, filled, 3] = sheet[S + i], sheet[DEEP + i]
        section[k, filled, 1], section[k, filled, 2] = sheet[FORCE + i], sheet[SHEARING + i]
        filled += 1
        if sheet[DEEP + i] > 0.0:
            row, edge = out.numbers[i, ROW], sheet[EDGE_AT + i]
            flag[row, TOUCHED] = 1
            value[row, LOW], value[row, HIGH] = edge + sheet[WET_FROM + i], edge + sheet[WET_TO + i]
            value[row, EDGE] = edge
            value[row, DEPTH], value[row, FALL] = sheet[EDGE_DEEP + i], sheet[FALLING + i]
            value[row, DEEP_NOW] = sheet[DEEP + i]
    out.sections[k] = filled


@compiled(**PLAIN, fastmath=SUMS)
def _sum_powers(
    model: Model, snow: Snow, state: State, spacing: float, count: np.uint64, sheet: FloatArray, power: FloatArray
) -> None:  # fmt: skip
    """Add up what the forces do, and what the snow gives back at tip and tail; find how fast the base's edges move."""
    V, lateral, normal = state.velocity, model.lateral, model.normal
    o0, o1, o2 = V[3], lateral[1] * V[4] + lateral[2] * V[5], normal[1] * V[4] + normal[2] * V[5]
    slipping = 1.0 - snow.compaction  # compaction that does not resist is done for nothing
    as_new = (snow.hardness + snow.excess) / snow.hardness
    rubbed, pressed, sheared, sprung, held, across, released = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        s, sp, cp, height, slope = sheet[S + i], sheet[SINE + i], sheet[COSINE + i], sheet[HEIGHT + i], sheet[RISE + i]
        F, weight, sliding, sine = sheet[FORCE + i], sheet[SHARE + i], sheet[SLIDING + i], sheet[TILT + i]
        n0, n1, n2, u0, u1, u2 = (
            sheet[N0 + i], sheet[N1 + i], sheet[N2 + i], sheet[U0 + i], sheet[U1 + i], sheet[U2 + i],
        )  # fmt: skip
        c0, c1, c2, h0, h1, h2 = (
            sheet[C0 + i], sheet[C1 + i], sheet[C2 + i], sheet[H0 + i], sheet[H1 + i], sheet[H2 + i],
        )  # fmt: skip
        rubbed += sheet[RUB + i] * sliding
        pressed += F * (c0 * n0 + c1 * n1 + c2 * n2) + sheet[RESIST + i] * sliding
        aslant = (sheet[NORMAL_AHEAD + i] * u0 + sp * u1 + cp * u2) * sheet[STEEP + i]
        by_twist = sheet[TWISTING + i] * sheet[MOMENT + i] / (1.0 - sine * sine) * sheet[SIZE + i]
        across -= F * aslant * (c0 * u0 + c1 * u1 + c2 * u2) + slipping * (F * sheet[CLIMB + i] + by_twist) * sliding
        # the edge that is down
        rate, arm, at = sheet[TWIST_RATE + i], sheet[ARM + i], sheet[REACH + i]
        i0, i1, i2, rolling = s - h0, at * cp - h1, height - at * sp - h2, rate * (at - arm)
        m0 = c0 + o1 * i2 - o2 * i1
        m1, m2 = c1 + o2 * i0 - o0 * i2 - sp * rolling, c2 + o0 * i1 - o1 * i0 - cp * rolling
        sheared += sheet[SHEARING + i] * (m0 * u0 + m1 * u1 + m2 * u2)
        # the base's edges, at -half and +half: their speed along the line
        half, flare, twisting = sheet[HALF + i], sheet[FLARE + i], sheet[TWISTING + i]
        y0, y1, y2 = sheet[Y0 + i], sheet[Y1 + i], sheet[Y2 + i]
        for way in (-1.0, 1.0):
            at = way * half
            i1, i2, rolling = at * cp - h1, height - at * sp - h2, rate * (at - arm)
            m0 = c0 + o1 * i2 - o2 * i1
            m1, m2 = c1 + o2 * i0 - o0 * i2 - sp * rolling, c2 + o0 * i1 - o1 * i0 - cp * rolling
            fl, tw = flare * way, at * twisting
            t1, t2 = fl * cp - tw * sp, slope - fl * sp - tw * cp
            b0, b1, b2 = n1 * t2 - n2 * t1, n2 - n0 * t2, n0 * t1 - n1
            moves = (m0 * b0 + m1 * b1 + m2 * b2) / (b0 * y0 + b1 * y1 + b2 * y2)
            if way < 0.0:
                sheet[RIGHT_MOVES + i] = moves
            else:
                sheet[LEFT_MOVES + i] = moves
        spring = 0.5 * sheet[SPRING + i]
        sprung += weight * spring
        passing = c0 + (c1 * sheet[D1 + i] + c2 * sheet[D2 + i]) / sheet[D0 + i]
        # new ground costs the whole work: on virgin snow k_u/H_V times as much
        given = spring * abs(passing) * (1.0 if (passing > 0.0) == (s < 0.0) else -as_new)
        released += given if weight < spacing else 0.0
        used = min(max(sheet[USED + i], -1.0), 1.0)
        held += sheet[HOLD + i] * used * used
    power[FRICTION] += rubbed
    power[NORMAL] += pressed
    power[SHEAR] += sheared
    power[SPRINGY] += sprung
    power[HELD] += 0.5 * snow.holding * held
    power[SIDEWAYS] += across
    power[RELEASED] += released


@compiled(**PLAIN, fastmath={"contract"})
def _cover_ground(snow: Snow, lines: Lines, count: np.uint64, sheet: FloatArray, numbers: PlaceArray) -> float:
    """Power (W) that the snow gains where the base's edges cover ground sideways, less what it gives back."""
    total = 0.0
    for i in range(count):
        if not (sheet[SHARE + i] > 0.0 and sheet[DEEP + i] > 0.0):
            continue
        row, wet_from, wet_to = numbers[i, ROW], sheet[WET_FROM + i], sheet[WET_TO + i]
        window = lines.flag[row, WINDOW] if lines.flag[row, KEPT] == 1 else FAR
        for which in range(2):
            if (wet_from > sheet[RIGHT + i]) if which == 0 else (wet_to < sheet[LEFT + i]):
                continue  # it ends at the water
            at, moves = (wet_from, -sheet[RIGHT_MOVES + i]) if which == 0 else (wet_to, sheet[LEFT_MOVES + i])
            total += sheet[SHARE + i] * moves * energy_at_edge(
                lines.cells, row, window, lines.value[row, CELL], lines.value[row, SLOPE], sheet[EDGE_AT + i] + at,
                sheet[EDGE_DEEP + i] + sheet[FALLING + i] * at, -1.0 if which == 0 else 1.0, moves > 0.0,
                snow.hardness, snow.excess,
            )  # fmt: skip
    return total


@compiled(**PLAIN, fastmath={"contract"})
def _add_tangents(model: Model, snow: Snow, k: int, count: np.uint64, out: Forces) -> None:
    """Add minus the tangent of the sections in contact."""
    sheet, dof = out.sheet, model.dof
    for i in range(count):
        if not (sheet[SHARE + i] > 0.0 and sheet[DEEP + i] > 0.0):
            continue
        e, sine, climb = out.numbers[i, ELEMENT], sheet[TILT + i], sheet[CLIMB + i]
        add_tangent(
            out.band, out.channels, out.corner, k, dof[e, 0], dof[e, 1], sheet[S + i], sheet[W0 + i], sheet[W1 + i],
            sheet[W2 + i], sheet[W3 + i], sheet[Z + i], sheet[N2 + i] + climb * sheet[T2 + i], sheet[U2 + i],
            sheet[STIFF0 + i], sheet[STIFF1 + i], sheet[STIFF2 + i], sheet[REACH + i] * sheet[LATERAL + i],
            1.0 / np.sqrt(1.0 - sine * sine), sheet[HOLD + i] / snow.holding if abs(sheet[USED + i]) < YIELDS else 0.0,
            climb, sheet[ASIDE + i],
        )  # fmt: skip
