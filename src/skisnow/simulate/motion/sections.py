"""Where the base meets the snow's lines: for each line the section of the ski that lies over it.

The edge's own line in the snow surface gives the two directions along the snow. Each line meets the base in a plane
section: from the edge that is down, the depth falls linearly across to the waterline or to the other edge, whatever
the angle between line and ski.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN

# isort: off
from .columns import (
    ASIDE, AT, BS, BT, BW, CLIMB, COSINE, CS, CT, CW, D0, D1, D2, DEEP, E0, E1, E2, EDGE_AT, EDGE_DEEP, FALLING,
    FLARE, GAP, HALF, HEIGHT, K1, K2, LATERAL, LEFT, LENGTH, N0, N1, N2, NORMAL_AHEAD, PER_FALL, REACH, RIGHT, RISE,
    S, SHARE, SINE, SIZE, STEEP, T0, T1, T2, TILT, TOWARD, TWISTING, U0, U1, U2, UPWARDS, VS, VT, VW, WATERLINE,
    WET_FROM, WET_TO, WIDE, WS, WT, WW, Y0, Y1, Y2, Z,
)  # fmt: skip

# isort: on
from .lines import FLAT, Lines
from .model import Model, State

FloatArray: TypeAlias = npt.NDArray[np.float64]
PlaceArray: TypeAlias = npt.NDArray[np.uint64]

ZERO, ONE, TWO = np.uint64(0), np.uint64(1), np.uint64(2)
ROW, ELEMENT, FRONT, REAR = ZERO, ONE, TWO, np.uint64(3)
"""Columns of `numbers`: the line, the section's element, places of its unknowns before and behind."""


@compiled(**PLAIN, fastmath={"contract"})
def find_sections(
    model: Model, one_sided: float, lines: Lines, state: State, skis: FloatArray, k: int, begin: int, n: np.uint64,
    sheet: FloatArray, numbers: PlaceArray,
) -> None:  # fmt: skip
    """Fill `sheet` and `numbers` for `n` lines of ski k from number `begin` on, from the tail.

    A line that the ski does not reach gets no share. `skis` (3, 3) are the skis' directions in space.
    """
    side = model.middle[k, 1]
    R, place = state.turn, state.place
    tail, tip = model.tail, model.tip
    most = len(model.table) - 1.000001
    step = (len(model.table) - 1) / (tip - tail)
    c0, c1, c2 = place[0] + R[0, 1] * side, place[1] + R[1, 1] * side, place[2] + R[2, 1] * side
    _take_lines(lines, k, begin, n, c0, c1, c2, skis, sheet, numbers)
    _cross(n, 1.0 / one_sided, tail, step, most, sheet)
    for _ in range(2):
        for i in range(n):
            j = np.uint64(sheet[AT + i])
            f = sheet[AT + i] - j
            sheet[HALF + i] = model.table[j, 0] + f * (model.table[j + ONE, 0] - model.table[j, 0])
            sheet[HEIGHT + i] = model.table[j, 2] + f * (model.table[j + ONE, 2] - model.table[j, 2])
        for i in range(n):
            s = sheet[GAP + i] - sheet[TOWARD + i] * sheet[HALF + i] - sheet[UPWARDS + i] * sheet[HEIGHT + i]
            sheet[S + i] = s
            at = (s - tail) * step
            at = at if at > 0.0 else 0.0
            sheet[AT + i] = at if at < most else most
    _share(n, tail, tip, 1.0 / lines.spacing[0], lines.spacing[0], sheet)
    _look_up(model, state, k, n, sheet, numbers)
    _cut(n, 1.0 / one_sided, sheet)


@compiled(**PLAIN, fastmath={"contract"})
def _take_lines(
    lines: Lines, k: int, begin: int, n: np.uint64, c0: float, c1: float, c2: float, skis: FloatArray,
    sheet: FloatArray, numbers: PlaceArray,
) -> None:  # fmt: skip
    """Bring the lines into the ski's frame, whose boot is at c."""
    ring, frame = len(lines.flag) // 2, lines.frame
    first = lines.first[k] + begin
    for i in range(n):
        at_ring = first + np.int64(i)
        row = np.uint64(k * ring + (at_ring if at_ring < ring else at_ring - ring))
        numbers[i, ROW] = row
        sheet[E0 + i], sheet[E1 + i], sheet[E2 + i] = frame[row, 0] - c0, frame[row, 1] - c1, frame[row, 2] - c2
        sheet[D0 + i], sheet[D1 + i], sheet[D2 + i] = frame[row, 3], frame[row, 4], frame[row, 5]
        sheet[N0 + i], sheet[N1 + i], sheet[N2 + i] = frame[row, 9], frame[row, 10], frame[row, 11]
    x0, x1, x2 = skis[0, 0], skis[0, 1], skis[0, 2]
    l0, l1, l2 = skis[1, 0], skis[1, 1], skis[1, 2]
    m0, m1, m2 = skis[2, 0], skis[2, 1], skis[2, 2]
    for i in range(n):
        a0, a1, a2 = sheet[E0 + i], sheet[E1 + i], sheet[E2 + i]
        sheet[E0 + i] = x0 * a0 + x1 * a1 + x2 * a2
        sheet[E1 + i] = l0 * a0 + l1 * a1 + l2 * a2
        sheet[E2 + i] = m0 * a0 + m1 * a1 + m2 * a2
        b0, b1, b2 = sheet[D0 + i], sheet[D1 + i], sheet[D2 + i]
        d0, d1, d2 = x0 * b0 + x1 * b1 + x2 * b2, l0 * b0 + l1 * b1 + l2 * b2, m0 * b0 + m1 * b1 + m2 * b2
        sheet[D0 + i], sheet[D1 + i], sheet[D2 + i] = d0, d1, d2
        b0, b1, b2 = sheet[N0 + i], sheet[N1 + i], sheet[N2 + i]
        n0, n1, n2 = x0 * b0 + x1 * b1 + x2 * b2, l0 * b0 + l1 * b1 + l2 * b2, m0 * b0 + m1 * b1 + m2 * b2
        sheet[N0 + i], sheet[N1 + i], sheet[N2 + i] = n0, n1, n2
        sheet[Y0 + i], sheet[Y1 + i], sheet[Y2 + i] = n1 * d2 - n2 * d1, n2 * d0 - n0 * d2, n0 * d1 - n1 * d0


@compiled(**PLAIN, fastmath={"contract"})
def _cross(n: np.uint64, sided: float, tail: float, step: float, most: float, sheet: FloatArray) -> None:
    """Find where along the ski's straight axis the edge that is down crosses the lines."""
    for i in range(n):
        d1, d2 = sheet[D1 + i], sheet[D2 + i]
        forwards = 1.0 / sheet[D0 + i]
        gap = sheet[E0 + i] + (sheet[E1 + i] * d1 + sheet[E2 + i] * d2) * forwards
        sheet[GAP + i] = gap
        tilt = min(max(-sheet[N1 + i] * sided, -1.0), 1.0)
        sheet[TOWARD + i] = tilt * abs(tilt) * (3.0 - 2.0 * abs(tilt)) * d1 * forwards
        sheet[UPWARDS + i] = d2 * forwards
        at = (gap - tail) * step
        at = at if at > 0.0 else 0.0  # also where it is not a number
        sheet[AT + i] = at if at < most else most


@compiled(**PLAIN, fastmath={"contract"})
def _share(n: np.uint64, tail: float, tip: float, per_spacing: float, spacing: float, sheet: FloatArray) -> None:
    """Give each line its share of the spacing, whole but for those at tip and tail."""
    for i in range(n):
        s = sheet[S + i]
        from_tail, from_tip = (s - tail) * per_spacing + 0.5, (tip - s) * per_spacing + 0.5
        sheet[SHARE + i] = min(max(from_tail, 0.0), 1.0) * min(max(from_tip, 0.0), 1.0) * spacing
        sheet[S + i] = min(max(s, tail), tip)


@compiled(**PLAIN, fastmath={"contract"})
def _look_up(model: Model, state: State, k: int, n: np.uint64, sheet: FloatArray, numbers: PlaceArray) -> None:
    """Look up the ski's shape, its bend and how that changes."""
    table, node, place, bend, rate = model.table, model.node, model.at, state.bend[k], state.bend_rate[k]
    for i in range(n):
        s = sheet[S + i]
        j = np.uint64(sheet[AT + i])
        f = sheet[AT + i] - j
        sheet[HALF + i] = table[j, 0] + f * (table[j + ONE, 0] - table[j, 0])
        sheet[FLARE + i] = table[j, 1] + f * (table[j + ONE, 1] - table[j, 1])
        sheet[HEIGHT + i] = table[j, 2] + f * (table[j + ONE, 2] - table[j, 2])
        sheet[RISE + i] = table[j, 3] + f * (table[j + ONE, 3] - table[j, 3])
        e = model.element[j]
        if s > node[e] and e > ZERO:
            e -= ONE
        h = node[e] - node[e + ONE]
        sheet[LENGTH + i], sheet[Z + i] = h, (node[e] - s) / h
        A, B = place[e, 0], place[e, 1]
        numbers[i, ELEMENT], numbers[i, FRONT], numbers[i, REAR] = e, A, B
        sheet[BW + i], sheet[BS + i], sheet[BT + i] = bend[A], bend[A + ONE], bend[A + TWO]
        sheet[CW + i], sheet[CS + i], sheet[CT + i] = bend[B], bend[B + ONE], bend[B + TWO]
        sheet[VW + i], sheet[VS + i], sheet[VT + i] = rate[A], rate[A + ONE], rate[A + TWO]
        sheet[WW + i], sheet[WS + i], sheet[WT + i] = rate[B], rate[B + ONE], rate[B + TWO]


@compiled(**PLAIN, fastmath={"contract"})
def _bend(n: np.uint64, sheet: FloatArray) -> None:
    """Bend the sections with the beam: height and rise of the base, sine and cosine of its twist, depth."""
    for i in range(n):
        z, h = sheet[Z + i], sheet[LENGTH + i]
        y, inverse = 1.0 - z, 1.0 / h
        bw, bs, bt, cw, cs, ct = (
            sheet[BW + i], sheet[BS + i], sheet[BT + i], sheet[CW + i], sheet[CS + i], sheet[CT + i],
        )  # fmt: skip
        bent = y * y * ((1.0 + 2.0 * z) * bw + h * z * bs) + z * z * ((3.0 - 2.0 * z) * cw - h * y * cs)
        sheet[HEIGHT + i] += bent
        sheet[RISE + i] += 6.0 * z * y * inverse * (bw - cw) - y * (1.0 - 3.0 * z) * bs - z * (3.0 * z - 2.0) * cs
        sheet[TWISTING + i] = (bt - ct) * inverse
        phi = y * bt + z * ct
        # sine and cosine of the twist: the next terms are below 1e-9 at 0.3 rad
        q = phi * phi
        sheet[COSINE + i] = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0)))
        sheet[SINE + i] = phi * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0))))


@compiled(**PLAIN, fastmath={"contract"})
def _cut(n: np.uint64, sided: float, sheet: FloatArray) -> None:
    """Cut the base with the lines: the edge that is down, its directions, and where the base is wet."""
    _bend(n, sheet)
    for i in range(n):
        s, half, height, slope = sheet[S + i], sheet[HALF + i], sheet[HEIGHT + i], sheet[RISE + i]
        sp, cp, twisting = sheet[SINE + i], sheet[COSINE + i], sheet[TWISTING + i]
        n0, n1, n2 = sheet[N0 + i], sheet[N1 + i], sheet[N2 + i]
        y0, y1, y2 = sheet[Y0 + i], sheet[Y1 + i], sheet[Y2 + i]
        # the edge that is down: where it is, its direction T, and the base's normal N there; (0, cp, -sp) points across
        # the base
        middle = (sheet[E0 + i] - s) * n0 + sheet[E1 + i] * n1 + (sheet[E2 + i] - height) * n2
        sine = sp * n2 - cp * n1
        deep = middle + half * abs(sine)
        # of a level base it does not go aside as the base rolls: the hold of the snow would be drawn along, and a run
        # straight down begin to swing by itself
        tilt = min(max(sine * sided, -1.0), 1.0)
        edge_side = tilt * abs(tilt) * (3.0 - 2.0 * abs(tilt))
        reach = edge_side * half
        edge_depth = middle + reach * sine
        fl, tw = sheet[FLARE + i] * edge_side, reach * twisting
        t1, t2 = fl * cp - tw * sp, slope - fl * sp - tw * cp  # and 1 ahead
        normal = tw - slope * cp
        steep = 1.0 / (normal * n0 + sp * n1 + cp * n2)
        fall = (normal * y0 + sp * y1 + cp * y2) * steep  # of the depth, across to the left
        k1, k2 = reach * cp, height - reach * sp  # the edge from the boot, s ahead
        edge = (s - sheet[E0 + i]) * y0 + (k1 - sheet[E1 + i]) * y1 + (k2 - sheet[E2 + i]) * y2
        # before the tip and behind the tail, the edge goes on along its own direction
        d0, d1, d2 = sheet[D0 + i], sheet[D1 + i], sheet[D2 + i]
        beyond = (sheet[E0 + i] - s) * d0 + (sheet[E1 + i] - k1) * d1 + (sheet[E2 + i] - k2) * d2
        edge += beyond * (y0 + t1 * y1 + t2 * y2) / (d0 + t1 * d1 + t2 * d2)
        lateral = cp * y1 - sp * y2
        wide = lateral + fall * sine
        right, left = -(half + reach) / wide, (half - reach) / wide
        down = fall if abs(fall) > FLAT else FLAT
        per_fall = 1.0 / down
        water = -edge_depth * per_fall
        sheet[WATERLINE + i], sheet[PER_FALL + i] = water, per_fall
        # directions in the surface: across the edge (u), and along it (t)
        u0, u1, u2 = n1 * t2 - n2 * t1, n2 - n0 * t2, n0 * t1 - n1
        size = 1.0 / np.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
        u0, u1, u2 = u0 * size, u1 * size, u2 * size
        s0, s1, s2 = u1 * n2 - u2 * n1, u2 * n0 - u0 * n2, u0 * n1 - u1 * n0
        sheet[TILT + i], sheet[DEEP + i], sheet[EDGE_DEEP + i], sheet[REACH + i] = sine, deep, edge_depth, reach
        sheet[K1 + i], sheet[K2 + i], sheet[EDGE_AT + i], sheet[FALLING + i] = k1, k2, edge, fall
        sheet[NORMAL_AHEAD + i], sheet[STEEP + i], sheet[LATERAL + i], sheet[WIDE + i] = normal, steep, lateral, wide
        sheet[RIGHT + i], sheet[LEFT + i] = right, left
        sheet[WET_FROM + i] = max(right, water) if down > 0.0 else right
        sheet[WET_TO + i] = left if down > 0.0 else min(left, water)
        sheet[U0 + i], sheet[U1 + i], sheet[U2 + i] = u0, u1, u2
        sheet[T0 + i], sheet[T1 + i], sheet[T2 + i] = s0, s1, s2
        sheet[SIZE + i], sheet[ASIDE + i] = size, n2 * t1 - n1 * t2
        sheet[CLIMB + i] = (normal * s0 + sp * s1 + cp * s2) * steep  # of the depth, along the edge
