"""Forces of snow on the skis of a sledge, and their tangent, line by line.

The edge's own line in the snow surface gives the two directions along the snow: the shear acts across it, glide
friction and the resistance of compaction along it. An edge that runs in its own track does no work against the shear.

Each line meets the base in a plane section: from the edge that is down, the depth falls linearly across to the
waterline or to the other edge, whatever the angle between line and ski.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numba
import numpy as np
import numpy.typing as npt

from .lines import (
    ABOVE,
    ANCHORED,
    CELL,
    DEEP_ABOVE,
    DEEP_NOW,
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
    energy_at_edge,
    pressure,
)  # fmt: skip
from .model import PADDING, Model, Snow, State
from .tangent import CHANNELS, add_tangent

FloatArray: TypeAlias = npt.NDArray[np.float64]


FAR = 1 << 40
ZERO, ONE, TWO = np.uint64(0), np.uint64(1), np.uint64(2)

# columns of `work`, vectors in the ski's frame: the section's station, share of the spacing (m), half width, height of
# its middle, place in its element, sine and cosine of the twist, depth of the deepest edge, half width's slope,
# height's slope, twist's slope, the line's place from the boot, its direction ahead, its normal
S, SHARE, HALF, HEIGHT, Z, SINE, COSINE, DEEP, FLARE, RISE, TWISTING = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10
E0, E1, E2, D0, D1, D2, N0, N1, N2, MIDDLE = 11, 12, 13, 14, 15, 16, 17, 18, 19, 20
COLUMNS = 21
ROW, ELEMENT, FRONT, REAR = 0, 1, 2, 3  # columns of `numbers`

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
    work: FloatArray  # (ring, COLUMNS) sections in contact, of the ski that is looked at
    numbers: npt.NDArray[np.uint64]  # (ring, 4) their line, element, and places of its unknowns


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
        np.zeros((ring, COLUMNS)),
        np.zeros((ring, 4), np.uint64),
    )


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
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
    frame = np.empty((3, 3))  # of both skis in space: ahead, across the base to the left, away from the snow
    R, lateral, normal = state.turn, model.lateral, model.normal
    for a in range(3):
        frame[0, a] = R[a, 0]
        frame[1, a] = R[a, 1] * lateral[1] + R[a, 2] * lateral[2]
        frame[2, a] = R[a, 1] * normal[1] + R[a, 2] * normal[2]
    for k in range(2):
        met = _sections(model, snow.one_sided, lines, state, frame, k, look, out)
        _forces(model, snow, lines, state, k, met, tangent, look, out)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _sections(  # noqa: PLR0915 - one loop over lines: every call in it would cost as much as it does
    model: Model, one_sided: float, lines: Lines, state: State, skis: FloatArray, k: int, look: bool, out: Forces
) -> int:  # fmt: skip
    """Find the sections of ski k that lie over a line and below the surface; fill `work` and return how many."""
    side = model.middle[k, 1]
    R, place = state.turn, state.place
    c0, c1, c2 = place[0] + R[0, 1] * side, place[1] + R[1, 1] * side, place[2] + R[2, 1] * side
    x0, x1, x2 = skis[0, 0], skis[0, 1], skis[0, 2]
    l0, l1, l2 = skis[1, 0], skis[1, 1], skis[1, 2]
    m0, m1, m2 = skis[2, 0], skis[2, 1], skis[2, 2]
    table, node, frame, bend = model.table, model.node, lines.frame, state.bend[k]
    spacing, ring = lines.spacing[0], len(lines.flag) // 2
    per_spacing, sided = 1.0 / spacing, 1.0 / one_sided
    tail, tip = model.tail, model.tip
    most = len(table) - 1.000001
    step = (len(table) - 1) / (tip - tail)
    work, numbers, flag, value = out.work, out.numbers, lines.flag, lines.value
    met, filled = np.uint64(0), 0
    first, count = lines.first[k], lines.count[k]
    for c in range(count):
        at_ring = first + c
        row = np.uint64(k * ring + (at_ring if at_ring < ring else at_ring - ring))
        if look:
            flag[row, TOUCHED] = 0
        # the line in the ski's frame: place from the boot, direction ahead, normal
        a0, a1, a2 = frame[row, 0] - c0, frame[row, 1] - c1, frame[row, 2] - c2
        b0, b1, b2 = frame[row, 3], frame[row, 4], frame[row, 5]
        e0 = x0 * a0 + x1 * a1 + x2 * a2
        e1 = l0 * a0 + l1 * a1 + l2 * a2
        e2 = m0 * a0 + m1 * a1 + m2 * a2
        d0 = x0 * b0 + x1 * b1 + x2 * b2
        d1 = l0 * b0 + l1 * b1 + l2 * b2
        d2 = m0 * b0 + m1 * b1 + m2 * b2
        b0, b1, b2 = frame[row, 9], frame[row, 10], frame[row, 11]
        n0 = x0 * b0 + x1 * b1 + x2 * b2
        n1 = l0 * b0 + l1 * b1 + l2 * b2
        n2 = m0 * b0 + m1 * b1 + m2 * b2
        # where along the ski the edge that is down crosses the line
        forwards = 1.0 / d0
        gap = e0 + (e1 * d1 + e2 * d2) * forwards
        if gap > tip + spacing or gap < tail - spacing:
            continue
        toward, upwards = min(max(-n1 * sided, -1.0), 1.0) * d1 * forwards, d2 * forwards
        s = gap
        for _ in range(2):
            at = min(max((s - tail) * step, 0.0), most)
            i = np.uint64(at)
            j = i + ONE
            f = at - i
            s = (
                gap
                - toward * (table[i, 0] + f * (table[j, 0] - table[i, 0]))
                - upwards * (table[i, 2] + f * (table[j, 2] - table[i, 2]))
            )
        from_tail, from_tip = (s - tail) * per_spacing + 0.5, (tip - s) * per_spacing + 0.5
        share = min(max(from_tail, 0.0), 1.0) * min(max(from_tip, 0.0), 1.0)
        if share <= 0.0:
            continue
        s = min(max(s, tail), tip)
        at = min(max((s - tail) * step, 0.0), most)
        i = np.uint64(at)
        j = i + ONE
        f = at - i
        half = table[i, 0] + f * (table[j, 0] - table[i, 0])
        height = table[i, 2] + f * (table[j, 2] - table[i, 2])
        e = model.element[i]
        if s > node[e] and e > ZERO:
            e -= ONE
        h = node[e] - node[e + ONE]
        inverse = 1.0 / h
        z = (node[e] - s) * inverse
        y = 1.0 - z
        A, B = model.at[e, 0], model.at[e, 1]
        bw, bs, bt, cw, cs, ct = bend[A], bend[A + ONE], bend[A + TWO], bend[B], bend[B + ONE], bend[B + TWO]
        height += y * y * ((1.0 + 2.0 * z) * bw + h * z * bs) + z * z * ((3.0 - 2.0 * z) * cw - h * y * cs)
        phi = y * bt + z * ct
        # sine and cosine of the twist: the next terms are below 1e-9 at 0.3 rad
        q = phi * phi
        cp = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0)))
        sp = phi * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0))))
        middle = (e0 - s) * n0 + e1 * n1 + (e2 - height) * n2
        deep = middle + half * abs(sp * n2 - cp * n1)
        if look:
            section = out.section
            section[k, filled, 0], section[k, filled, 1], section[k, filled, 2] = s, 0.0, 0.0
            section[k, filled, 3] = deep
            filled += 1
        if deep <= 0.0:
            if look:
                # where its edge is: the anchor of a line is where the edge meets the surface, within a step
                edge_side = min(max((sp * n2 - cp * n1) * sided, -1.0), 1.0)
                reach = edge_side * half
                y0, y1, y2 = n1 * d2 - n2 * d1, n2 * d0 - n0 * d2, n0 * d1 - n1 * d0
                fl, tw = (table[i, 1] + f * (table[j, 1] - table[i, 1])) * edge_side, reach * (bt - ct) * inverse
                rise = table[i, 3] + f * (table[j, 3] - table[i, 3])
                rise += 6.0 * z * y * inverse * (bw - cw) - y * (1.0 - 3.0 * z) * bs - z * (3.0 * z - 2.0) * cs
                t1, t2 = fl * cp - tw * sp, rise - fl * sp - tw * cp
                k1, k2 = reach * cp - e1, height - reach * sp - e2
                beyond = (e0 - s) * d0 - k1 * d1 - k2 * d2
                value[row, EDGE_ABOVE] = (s - e0) * y0 + k1 * y1 + k2 * y2
                value[row, EDGE_ABOVE] += beyond * (y0 + t1 * y1 + t2 * y2) / (d0 + t1 * d1 + t2 * d2)
                value[row, DEEP_ABOVE] = deep
                flag[row, ANCHORED], flag[row, ABOVE] = 0, 1
            continue
        numbers[met, ROW], numbers[met, ELEMENT], numbers[met, FRONT], numbers[met, REAR] = row, e, A, B
        work[met, S], work[met, SHARE], work[met, HALF], work[met, HEIGHT] = s, share * spacing, half, height
        work[met, Z], work[met, SINE], work[met, COSINE], work[met, DEEP] = z, sp, cp, deep
        work[met, MIDDLE] = middle
        work[met, FLARE] = table[i, 1] + f * (table[j, 1] - table[i, 1])
        work[met, RISE] = (
            table[i, 3] + f * (table[j, 3] - table[i, 3])
            + 6.0 * z * y * inverse * (bw - cw) - y * (1.0 - 3.0 * z) * bs - z * (3.0 * z - 2.0) * cs
        )  # fmt: skip
        work[met, TWISTING] = (bt - ct) * inverse
        work[met, E0], work[met, E1], work[met, E2] = e0, e1, e2
        work[met, D0], work[met, D1], work[met, D2] = d0, d1, d2
        work[met, N0], work[met, N1], work[met, N2] = n0, n1, n2
        met += ONE
    if look:
        out.sections[k] = filled
    return int(met)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _forces(  # noqa: PLR0912, PLR0915 - as above
    model: Model, snow: Snow, lines: Lines, state: State, k: int, met: int, tangent: bool, look: bool, out: Forces
) -> None:  # fmt: skip
    """Add the forces on ski k from the sections in `work`."""
    V = state.velocity
    side = model.middle[k, 1]
    left1, left2, up1, up2 = model.lateral[1], model.lateral[2], model.normal[1], model.normal[2]
    # velocity of the boot, and turning, in the ski's frame
    v0, va, vb = V[0] - V[5] * side, V[1], V[2] + V[3] * side
    v1, v2 = left1 * va + left2 * vb, up1 * va + up2 * vb
    o0, o1, o2 = V[3], left1 * V[4] + left2 * V[5], up1 * V[4] + up2 * V[5]
    work, numbers, rate, force, power = out.work, out.numbers, state.bend_rate[k], out.bend[k], out.power
    cells, value, flag, node = lines.cells, lines.value, lines.flag, model.node
    hardness, excess = snow.hardness, snow.excess
    stiff = hardness + excess
    per_holding, sided = 1.0 / snow.holding, 1.0 / snow.one_sided
    friction2 = snow.friction_speed * snow.friction_speed
    spacing = lines.spacing[0]
    sums = np.empty(6)
    f0, f1, f2, g0, g1, g2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    filled = 0
    for m in range(met):
        row, A, B = numbers[m, ROW], numbers[m, FRONT], numbers[m, REAR]
        s, weight, half, height, z = work[m, S], work[m, SHARE], work[m, HALF], work[m, HEIGHT], work[m, Z]
        sp, cp, deep, middle = work[m, SINE], work[m, COSINE], work[m, DEEP], work[m, MIDDLE]
        flare, slope, twisting = work[m, FLARE], work[m, RISE], work[m, TWISTING]
        n0, n1, n2 = work[m, N0], work[m, N1], work[m, N2]
        d0, d1, d2 = work[m, D0], work[m, D1], work[m, D2]
        y0, y1, y2 = n1 * d2 - n2 * d1, n2 * d0 - n0 * d2, n0 * d1 - n1 * d0  # along the line, to the left
        # the edge that is down: where it is, its direction T, and the base's normal N there; (0, cp, -sp) points across
        # the base
        sine = sp * n2 - cp * n1
        edge_side = min(max(sine * sided, -1.0), 1.0)
        reach = edge_side * half
        fl, tw = flare * edge_side, reach * twisting
        t1, t2 = fl * cp - tw * sp, slope - fl * sp - tw * cp  # and 1 ahead
        aside = n2 * t1 - n1 * t2
        N = tw - slope * cp
        steep = 1.0 / (N * n0 + sp * n1 + cp * n2)
        fall = (N * y0 + sp * y1 + cp * y2) * steep  # of the depth, across to the left
        k1, k2 = reach * cp, height - reach * sp  # the edge from the boot, s ahead
        edge = (s - work[m, E0]) * y0 + (k1 - work[m, E1]) * y1 + (k2 - work[m, E2]) * y2
        # before the tip and behind the tail, the edge goes on along its own direction
        beyond = (work[m, E0] - s) * d0 + (work[m, E1] - k1) * d1 + (work[m, E2] - k2) * d2
        edge += beyond * (y0 + t1 * y1 + t2 * y2) / (d0 + t1 * d1 + t2 * d2)
        edge_depth = middle + reach * sine
        lateral = cp * y1 - sp * y2
        wide = lateral + fall * sine
        per_wide = 1.0 / wide
        low, high = -(half + reach) * per_wide, (half - reach) * per_wide
        low_wet, high_wet = True, True
        if abs(fall) > 1e-12:
            water = -edge_depth / fall
            if fall > 0.0 and water > low:
                low, low_wet = water, False
            elif fall < 0.0 and water < high:
                high, high_wet = water, False
        # a line that nothing has touched has no cells: its window lies far off
        window = flag[row, WINDOW] if flag[row, KEPT] == 1 else FAR
        cell = value[row, CELL]
        pressure(sums, cells, row, window, cell, low, high, edge_depth, fall, edge, hardness, excess)
        F, M = weight * sums[0], weight * sums[1]
        # directions in the surface: across the edge (u), and along it (s)
        u0, u1, u2 = n1 * t2 - n2 * t1, n2 - n0 * t2, n0 * t1 - n1
        size = 1.0 / np.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
        u0, u1, u2 = u0 * size, u1 * size, u2 * size
        s0, s1, s2 = u1 * n2 - u2 * n1, u2 * n0 - u0 * n2, u0 * n1 - u1 * n0
        # the edge holds where it first took hold, with up to its strength
        hold = snow.shear_stress * deep * weight
        used = (anchor_of(value, flag, row, edge, deep) - edge) * per_holding
        sticks = abs(used) < 1.0
        used = min(max(used, -1.0), 1.0)
        shear = hold * used
        # centre of pressure, on the base
        off = M / F if F > 0.0 else 0.0
        h0, h1, h2 = s + off * (y0 - fall * n0), k1 + off * (y1 - fall * n1), k2 + off * (y2 - fall * n2)
        h, y = node[numbers[m, ELEMENT]] - node[numbers[m, ELEMENT] + ONE], 1.0 - z
        w0, w1, w2, w3 = y * y * (1.0 + 2.0 * z), h * z * y * y, z * z * (3.0 - 2.0 * z), -h * z * z * y
        bend_rate = w0 * rate[A] + w1 * rate[A + ONE] + w2 * rate[B] + w3 * rate[B + ONE]
        twist_rate = y * rate[A + TWO] + z * rate[B + TWO]
        arm = reach + off * wide
        turning = twist_rate * arm
        c0 = v0 + o1 * h2 - o2 * h1
        c1 = v1 + o2 * h0 - o0 * h2 - sp * turning
        c2 = v2 + o0 * h1 - o1 * h0 + bend_rate - cp * turning
        sliding = c0 * s0 + c1 * s1 + c2 * s2
        rise = (N * s0 + sp * s1 + cp * s2) * steep  # of the depth, along the edge
        by_twist = twisting * M / (1.0 - sine * sine) * size
        resist = (F * rise + by_twist) * snow.compaction
        rub = -(snow.friction + snow.friction_by_speed * abs(sliding)) * F * sliding
        rub /= np.sqrt(sliding * sliding + friction2)
        push = resist + rub
        # normal force and what acts along the edge at the centre of pressure, shear at the edge
        a0, a1, a2 = F * n0 + push * s0, F * n1 + push * s1, F * n2 + push * s2
        z0, z1, z2 = shear * u0, shear * u1, shear * u2
        f0 += a0 + z0
        f1 += a1 + z1
        f2 += a2 + z2
        g0 += h1 * a2 - h2 * a1 + k1 * z2 - k2 * z1
        g1 += h2 * a0 - h0 * a2 + k2 * z0 - s * z2
        g2 += h0 * a1 - h1 * a0 + s * z1 - k1 * z0
        up = a2 + z2
        turn = -arm * (sp * a1 + cp * a2) - reach * (sp * z1 + cp * z2)
        force[A] += w0 * up
        force[A + ONE] += w1 * up
        force[A + TWO] += y * turn
        force[B] += w2 * up
        force[B + ONE] += w3 * up
        force[B + TWO] += z * turn
        if look:
            while out.section[k, filled, 0] != s:
                filled += 1
            out.section[k, filled, 1], out.section[k, filled, 2] = F, shear
            flag[row, TOUCHED] = 1
            value[row, LOW], value[row, HIGH], value[row, EDGE] = edge + low, edge + high, edge
            value[row, DEPTH], value[row, FALL], value[row, DEEP_NOW] = edge_depth, fall, deep
            power[FRICTION] += rub * sliding
            power[NORMAL] += F * (c0 * n0 + c1 * n1 + c2 * n2) + resist * sliding
            sideways = -F * (N * u0 + sp * u1 + cp * u2) * steep * (c0 * u0 + c1 * u1 + c2 * u2)
            if snow.compaction == 0.0:
                sideways -= (F * rise + by_twist) * sliding
            # the edge that is down (0), and ground that the base's edges cover or leave (right, left)
            for which in range(3):
                if (which == 1 and not low_wet) or (which == 2 and not high_wet):
                    continue
                way = edge_side if which == 0 else -1.0 if which == 1 else 1.0
                at = way * half
                i1, i2 = at * cp - h1, height - at * sp - h2
                i0 = s - h0
                rolling = twist_rate * (at - arm)
                m0 = c0 + o1 * i2 - o2 * i1
                m1 = c1 + o2 * i0 - o0 * i2 - sp * rolling
                m2 = c2 + o0 * i1 - o1 * i0 - cp * rolling
                if which == 0:
                    power[SHEAR] += shear * (m0 * u0 + m1 * u1 + m2 * u2)
                    continue
                fl, tw = flare * way, at * twisting
                t1, t2 = fl * cp - tw * sp, slope - fl * sp - tw * cp
                b0, b1, b2 = n1 * t2 - n2 * t1, n2 - n0 * t2, n0 * t1 - n1
                moves = (m0 * b0 + m1 * b1 + m2 * b2) / (b0 * y0 + b1 * y1 + b2 * y2)
                water = high if which == 2 else low
                gain = energy_at_edge(
                    cells, row, window, cell, value[row, SLOPE], edge + water, edge_depth + fall * water, way * moves >
                    0.0, hardness, excess,
                )  # fmt: skip
                sideways += weight * way * moves * gain
            power[SIDEWAYS] += sideways
            if weight < spacing:
                leaves = s < 0.0
                gain = sums[5] * 0.5
                passing = (c0 * d0 + c1 * d1 + c2 * d2) / d0
                if (passing > 0.0) != leaves:  # new ground costs the whole work: on virgin snow k_u/H_V times as much
                    gain *= stiff / hardness
                power[RELEASED] += (gain if leaves else -gain) * passing
            power[SPRINGY] += weight * 0.5 * sums[5]
            power[HELD] += 0.5 * hold * snow.holding * used * used
        if tangent:
            e = numbers[m, ELEMENT]
            cosine = 1.0 / np.sqrt(1.0 - sine * sine)
            add_tangent(
                out.band, out.channels, out.corner, k, model.dof[e, 0], model.dof[e, 1], s, w0, w1, w2, w3, z,
                n2 + rise * s2, u2, weight * sums[2], weight * sums[3], weight * sums[4], reach * lateral, cosine,
                hold * per_holding if sticks else 0.0, rise, aside,
            )  # fmt: skip
    # into the sledge's frame, about its origin
    p1, p2 = left1 * f1 + up1 * f2, left2 * f1 + up2 * f2
    out.rigid[0] += f0
    out.rigid[1] += p1
    out.rigid[2] += p2
    out.rigid[3] += g0 + side * p2
    out.rigid[4] += left1 * g1 + up1 * g2
    out.rigid[5] += left2 * g1 + up2 * g2 - side * f0
