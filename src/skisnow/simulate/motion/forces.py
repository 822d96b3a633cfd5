"""Forces of snow on the skis of a sledge, and their tangent, line by line.

The edge's own line in the snow surface gives the two directions along the snow: the shear acts across it, glide friction and the
resistance of compaction along it. An edge that runs in its own track does no work against the shear.

Each line meets the base in a plane section: from the edge that is down, the depth falls linearly across to the waterline or to
the other edge, whatever the angle between line and ski.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numba
import numpy as np
import numpy.typing as npt

from .lines import (
    ANCHOR,
    ANCHORED,
    CELL,
    DEPTH,
    EDGE,
    FALL,
    HIGH,
    KEPT,
    LOW,
    SLOPE,
    TOUCHED,
    WINDOW,
    Lines,
    energy_at_edge,
    pressure,
)  # fmt: skip
from .model import PADDING, Model, Snow, State

FloatArray: TypeAlias = npt.NDArray[np.float64]

CHANNELS = 6
"""Columns between beam and rigid body: depth, depth × s, roll, across, across × s, forwards."""

FAR = 1 << 40
ZERO, ONE, TWO = np.uint64(0), np.uint64(1), np.uint64(2)

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
    )


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def feel(model: Model, snow: Snow, lines: Lines, state: State, tangent: bool, look: bool, out: Forces) -> None:
    """Fill `out` with the forces at a state; with `tangent` also the tangent; with `look` also powers, and where lines are touched."""
    out.rigid[:] = 0.0
    out.bend[:] = 0.0
    if look:
        out.power[:] = 0.0
    if tangent:
        out.band[:] = 0.0
        out.channels[:] = 0.0
        out.corner[:] = 0.0
    R, V = state.turn, state.velocity
    x0, x1, x2 = R[0, 0], R[1, 0], R[2, 0]
    a1, a2, b1, b2 = model.lateral[1], model.lateral[2], model.normal[1], model.normal[2]
    l0, l1, l2 = R[0, 1] * a1 + R[0, 2] * a2, R[1, 1] * a1 + R[1, 2] * a2, R[2, 1] * a1 + R[2, 2] * a2
    m0, m1, m2 = R[0, 1] * b1 + R[0, 2] * b2, R[1, 1] * b1 + R[1, 2] * b2, R[2, 1] * b1 + R[2, 2] * b2
    v0 = R[0, 0] * V[0] + R[0, 1] * V[1] + R[0, 2] * V[2]
    v1 = R[1, 0] * V[0] + R[1, 1] * V[1] + R[1, 2] * V[2]
    v2 = R[2, 0] * V[0] + R[2, 1] * V[1] + R[2, 2] * V[2]
    o0 = R[0, 0] * V[3] + R[0, 1] * V[4] + R[0, 2] * V[5]
    o1 = R[1, 0] * V[3] + R[1, 1] * V[4] + R[1, 2] * V[5]
    o2 = R[2, 0] * V[3] + R[2, 1] * V[4] + R[2, 2] * V[5]
    sums = np.empty(6)
    f0, f1, f2, g0, g1, g2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    spacing = lines.spacing[0]
    ring = len(lines.flag) // 2
    places = len(model.table)
    step = (places - 1) / (model.tip - model.tail)
    table, node, at_row, frame = model.table, model.node, model.at, lines.frame
    cells, value, flag = lines.cells, lines.value, lines.flag
    hardness, excess = snow.hardness, snow.excess
    stiff = hardness + excess
    friction2 = snow.friction_speed * snow.friction_speed
    for k in range(2):
        # the boot, from the sledge's origin, and in space
        side = model.middle[k, 1]
        q0, q1, q2 = R[0, 1] * side, R[1, 1] * side, R[2, 1] * side
        c0, c1, c2 = state.place[0] + q0, state.place[1] + q1, state.place[2] + q2
        bend, rate, force = state.bend[k], state.bend_rate[k], out.bend[k]
        filled = 0
        for c in range(lines.count[k]):
            at_ring = lines.first[k] + c
            row = np.uint64(k * ring + (at_ring if at_ring < ring else at_ring - ring))
            e0, e1, e2 = frame[row, 0] - c0, frame[row, 1] - c1, frame[row, 2] - c2
            d0, d1, d2 = frame[row, 3], frame[row, 4], frame[row, 5]
            n0, n1, n2 = frame[row, 9], frame[row, 10], frame[row, 11]
            if look:
                flag[row, TOUCHED] = 0
            # where along the ski the edge that is down crosses the line
            forwards = 1.0 / (x0 * d0 + x1 * d1 + x2 * d2)
            gap = (e0 * d0 + e1 * d1 + e2 * d2) * forwards
            if gap > model.tip + spacing or gap < model.tail - spacing:
                continue
            across = (l0 * d0 + l1 * d1 + l2 * d2) * forwards
            upwards = (m0 * d0 + m1 * d1 + m2 * d2) * forwards
            toward = min(max(-(l0 * n0 + l1 * n1 + l2 * n2) / snow.one_sided, -1.0), 1.0) * across
            s = gap
            for _ in range(2):
                at = min(max((s - model.tail) * step, 0.0), places - 1.000001)
                i = np.uint64(at)
                j = i + ONE
                f = at - i
                s = (
                    gap
                    - toward * (table[i, 0] + f * (table[j, 0] - table[i, 0]))
                    - upwards * (table[i, 2] + f * (table[j, 2] - table[i, 2]))
                )
            from_tail, from_tip = (s - model.tail) / spacing + 0.5, (model.tip - s) / spacing + 0.5
            share = min(max(from_tail, 0.0), 1.0) * min(max(from_tip, 0.0), 1.0)
            if share <= 0.0:
                continue
            s = min(max(s, model.tail), model.tip)
            at = min(max((s - model.tail) * step, 0.0), places - 1.000001)
            i = np.uint64(at)
            j = i + ONE
            f = at - i
            half = table[i, 0] + f * (table[j, 0] - table[i, 0])
            height = table[i, 2] + f * (table[j, 2] - table[i, 2])
            e = model.element[i]
            if s > node[e] and e > ZERO:
                e -= ONE
            inverse = 1.0 / (node[e] - node[e + ONE])
            h = node[e] - node[e + ONE]
            z = (node[e] - s) * inverse
            y = 1.0 - z
            w0, w1, w2, w3 = y * y * (1.0 + 2.0 * z), h * z * y * y, z * z * (3.0 - 2.0 * z), -h * z * z * y
            A, B = at_row[e, 0], at_row[e, 1]
            bw, bs, bt, cw, cs, ct = bend[A], bend[A + ONE], bend[A + TWO], bend[B], bend[B + ONE], bend[B + TWO]
            height += w0 * bw + w1 * bs + w2 * cw + w3 * cs
            phi = y * bt + z * ct
            # sine and cosine of the twist: the next terms are below 1e-9 at 0.3 rad
            q = phi * phi
            cp = 1.0 - q * (0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0 - q / 40320.0)))
            sp = phi * (1.0 - q * (1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0 - q / 362880.0))))
            t0, t1, t2 = l0 * cp - m0 * sp, l1 * cp - m1 * sp, l2 * cp - m2 * sp  # across the base
            depth = (
                (e0 - s * x0 - height * m0) * n0 + (e1 - s * x1 - height * m1) * n1 + (e2 - s * x2 - height * m2) * n2
            )
            sine = -(t0 * n0 + t1 * n1 + t2 * n2)
            deep = depth + half * abs(sine)
            if look:
                out.section[k, filled, 0], out.section[k, filled, 3] = s, deep
                out.section[k, filled, 1], out.section[k, filled, 2] = 0.0, 0.0
                filled += 1
            if deep <= 0.0:
                if look:
                    flag[row, ANCHORED] = 0
                continue
            weight = share * spacing
            flare = table[i, 1] + f * (table[j, 1] - table[i, 1])
            slope = table[i, 3] + f * (table[j, 3] - table[i, 3])
            slope += 6.0 * z * y * inverse * (bw - cw) - y * (1.0 - 3.0 * z) * bs - z * (3.0 * z - 2.0) * cs
            twist_slope = (bt - ct) * inverse
            # the edge: where it is, its direction, and the plane of the base there
            edge_side = min(max(sine / snow.one_sided, -1.0), 1.0)
            reach = edge_side * half
            r0, r1, r2 = m0 * cp + l0 * sp, m1 * cp + l1 * sp, m2 * cp + l2 * sp  # normal to the base
            fl, tw = flare * edge_side, reach * twist_slope
            E0 = x0 + slope * m0 + fl * t0 - tw * r0
            E1 = x1 + slope * m1 + fl * t1 - tw * r1
            E2 = x2 + slope * m2 + fl * t2 - tw * r2
            N0, N1, N2 = E1 * t2 - E2 * t1, E2 * t0 - E0 * t2, E0 * t1 - E1 * t0
            y0, y1, y2 = frame[row, 6], frame[row, 7], frame[row, 8]
            steep = 1.0 / (N0 * n0 + N1 * n1 + N2 * n2)
            fall = (N0 * y0 + N1 * y1 + N2 * y2) * steep  # of the depth, across to the left
            p0, p1, p2 = s * x0 + height * m0, s * x1 + height * m1, s * x2 + height * m2  # from the boot
            edge = (p0 - e0) * y0 + (p1 - e1) * y1 + (p2 - e2) * y2
            lateral = t0 * y0 + t1 * y1 + t2 * y2
            edge += reach * lateral
            edge_depth = depth + reach * sine
            wide = lateral + fall * sine
            low, high = edge - (half + reach) / wide, edge + (half - reach) / wide
            low_wet, high_wet = True, True
            if fall > 1e-12 and edge - edge_depth / fall > low:
                low, low_wet = edge - edge_depth / fall, False
            elif fall < -1e-12 and edge - edge_depth / fall < high:
                high, high_wet = edge - edge_depth / fall, False
            # a line that nothing has touched has no cells: its window lies far off
            window = flag[row, WINDOW] if flag[row, KEPT] == 1 else FAR
            cell = value[row, CELL]
            pressure(sums, cells, row, window, cell, low - edge, high - edge, edge_depth, fall, edge, hardness, excess)
            F, M = weight * sums[0], weight * sums[1]
            # directions in the surface: across the edge, and along it
            u0, u1, u2 = n1 * E2 - n2 * E1, n2 * E0 - n0 * E2, n0 * E1 - n1 * E0
            size = 1.0 / np.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
            u0, u1, u2 = u0 * size, u1 * size, u2 * size
            s0, s1, s2 = u1 * n2 - u2 * n1, u2 * n0 - u0 * n2, u0 * n1 - u1 * n0
            # the edge holds where it first took hold, with up to its strength
            hold = snow.shear_stress * deep * weight
            used = (value[row, ANCHOR] - edge) / snow.holding if flag[row, ANCHORED] == 1 else 0.0
            sticks = abs(used) < 1.0 or snow.secant > 0.0
            used = min(max(used, -1.0), 1.0)
            shear = hold * used
            # centre of pressure: on the base, from the boot
            off = M / F if F > 0.0 else 0.0
            k0, k1, k2 = q0 + p0 + reach * t0, q1 + p1 + reach * t1, q2 + p2 + reach * t2  # edge, from the origin
            h0, h1, h2 = k0 + off * (y0 - fall * n0), k1 + off * (y1 - fall * n1), k2 + off * (y2 - fall * n2)
            bend_rate = w0 * rate[A] + w1 * rate[A + ONE] + w2 * rate[B] + w3 * rate[B + ONE]
            twist_rate = y * rate[A + TWO] + z * rate[B + TWO]
            arm = reach + off * wide
            turning = twist_rate * arm
            c3 = v0 + o1 * h2 - o2 * h1 + m0 * bend_rate - r0 * turning
            c4 = v1 + o2 * h0 - o0 * h2 + m1 * bend_rate - r1 * turning
            c5 = v2 + o0 * h1 - o1 * h0 + m2 * bend_rate - r2 * turning
            sliding = c3 * s0 + c4 * s1 + c5 * s2
            cosine2 = 1.0 - sine * sine
            rise = (N0 * s0 + N1 * s1 + N2 * s2) * steep  # of the depth, along the edge
            resist = F * rise + twist_slope * M / cosine2 * size
            resist *= snow.compaction
            rub = -(snow.friction + snow.friction_by_speed * abs(sliding)) * F * sliding
            rub /= np.sqrt(sliding * sliding + friction2)
            push = resist + rub
            # sum up: normal force and what acts along the edge at the centre of pressure, shear at the edge
            a0, aa1, aa2 = F * n0 + push * s0, F * n1 + push * s1, F * n2 + push * s2
            z0, z1, z2 = shear * u0, shear * u1, shear * u2
            f0 += a0 + z0
            f1 += aa1 + z1
            f2 += aa2 + z2
            g0 += h1 * aa2 - h2 * aa1 + k1 * z2 - k2 * z1
            g1 += h2 * a0 - h0 * aa2 + k2 * z0 - k0 * z2
            g2 += h0 * aa1 - h1 * a0 + k0 * z1 - k1 * z0
            up = m0 * (a0 + z0) + m1 * (aa1 + z1) + m2 * (aa2 + z2)
            turn = -arm * (r0 * a0 + r1 * aa1 + r2 * aa2) - reach * (r0 * z0 + r1 * z1 + r2 * z2)
            force[A] += w0 * up
            force[A + ONE] += w1 * up
            force[A + TWO] += y * turn
            force[B] += w2 * up
            force[B + ONE] += w3 * up
            force[B + TWO] += z * turn
            if look:
                out.section[k, filled - 1, 1], out.section[k, filled - 1, 2] = F, shear
                flag[row, TOUCHED] = 1
                value[row, LOW], value[row, HIGH], value[row, EDGE] = low, high, edge
                value[row, DEPTH], value[row, FALL] = edge_depth, fall
                j0, j1, j2 = k0 - h0, k1 - h1, k2 - h2
                rolling = twist_rate * (reach - arm)
                at_edge = (
                    (c3 + o1 * j2 - o2 * j1 - r0 * rolling) * u0
                    + (c4 + o2 * j0 - o0 * j2 - r1 * rolling) * u1
                    + (c5 + o0 * j1 - o1 * j0 - r2 * rolling) * u2
                )
                power = out.power
                power[SHEAR] += shear * at_edge
                power[FRICTION] += rub * sliding
                power[NORMAL] += F * (c3 * n0 + c4 * n1 + c5 * n2) + resist * sliding
                power[SIDEWAYS] -= F * (N0 * u0 + N1 * u1 + N2 * u2) * steep * (c3 * u0 + c4 * u1 + c5 * u2)
                if snow.compaction == 0.0:
                    power[SIDEWAYS] -= (F * rise + twist_slope * M / cosine2 * size) * sliding
                # ground that the base's edges cover or leave
                for at_left in range(2):
                    if (at_left == 0 and not low_wet) or (at_left == 1 and not high_wet):
                        continue
                    way = 1.0 if at_left == 1 else -1.0
                    beyond = way * half - reach
                    d_fl, d_tw = flare * way - fl, (way * half) * twist_slope - tw
                    D0, D1, D2 = E0 + d_fl * t0 - d_tw * r0, E1 + d_fl * t1 - d_tw * r1, E2 + d_fl * t2 - d_tw * r2
                    b0, bb1, bb2 = n1 * D2 - n2 * D1, n2 * D0 - n0 * D2, n0 * D1 - n1 * D0
                    i0, i1, i2 = j0 + beyond * t0, j1 + beyond * t1, j2 + beyond * t2
                    rolling = twist_rate * (way * half - arm)
                    moves = (
                        (c3 + o1 * i2 - o2 * i1 - r0 * rolling) * b0
                        + (c4 + o2 * i0 - o0 * i2 - r1 * rolling) * bb1
                        + (c5 + o0 * i1 - o1 * i0 - r2 * rolling) * bb2
                    ) / (b0 * y0 + bb1 * y1 + bb2 * y2)
                    there = edge_depth + fall * (beyond / wide)
                    place = high if at_left == 1 else low
                    gain = energy_at_edge(
                        cells, row, window, cell, value[row, SLOPE], place, there, way * moves > 0.0, hardness, excess
                    )
                    power[SIDEWAYS] += weight * way * moves * gain
                if share < 1.0:
                    leaves = from_tail < 1.0
                    gain = sums[5] * 0.5
                    if (
                        sliding > 0.0
                    ) != leaves:  # taking new ground costs the whole work, on virgin snow k_u/H_V times
                        gain *= stiff / hardness
                    power[RELEASED] += (gain if leaves else -gain) * sliding
                power[SPRINGY] += weight * 0.5 * sums[5]
                power[HELD] += 0.5 * hold * snow.holding * used * used
            if tangent:
                _add_tangent(
                    out, k, model.dof[e, 0], model.dof[e, 1], s, w0, w1, w2, w3, z,
                    n0 * m0 + n1 * m1 + n2 * m2 + rise * (s0 * m0 + s1 * m1 + s2 * m2), u0 * m0 + u1 * m1 + u2 * m2,
                    weight * sums[2], weight * sums[3], weight * sums[4], reach * lateral, 1.0 / np.sqrt(cosine2),
                    hold / snow.holding if sticks else 0.0,
                    rise,
                    (E0 * (n1 * x2 - n2 * x1) + E1 * (n2 * x0 - n0 * x2) + E2 * (n0 * x1 - n1 * x0))
                    / (E0 * x0 + E1 * x1 + E2 * x2),
                )  # fmt: skip
        out.sections[k] = filled
    out.rigid[0] = R[0, 0] * f0 + R[1, 0] * f1 + R[2, 0] * f2
    out.rigid[1] = R[0, 1] * f0 + R[1, 1] * f1 + R[2, 1] * f2
    out.rigid[2] = R[0, 2] * f0 + R[1, 2] * f1 + R[2, 2] * f2
    out.rigid[3] = R[0, 0] * g0 + R[1, 0] * g1 + R[2, 0] * g2
    out.rigid[4] = R[0, 1] * g0 + R[1, 1] * g1 + R[2, 1] * g2
    out.rigid[5] = R[0, 2] * g0 + R[1, 2] * g1 + R[2, 2] * g2


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
def _add_tangent(
    out: Forces, k: int, A: int, B: int, s: float, w0: float, w1: float, w2: float, w3: float, z: float,
    cn: float, cu: float, k0: float, k1: float, k2: float, reach: float, secant: float, ky: float, rise: float,
    aside: float,
) -> None:  # fmt: skip
    """Add minus the tangent of one section: depth and roll (k0, k1, k2, about the edge), and across (ky).

    A line feels the ski move along its base and along its edge: forwards, the depth grows by `rise`, and the edge comes to lie
    `aside` of the ski's axis. Without it a steadily carving ski would seem to be pushed across where it only follows its edge.
    """
    k2 = (k2 + 2.0 * reach * k1 + reach * reach * k0) * secant * secant
    k1 = (k1 + reach * k0) * secant
    corner = out.corner
    ks, ys = k0 * s, ky * s
    corner[k, 0, 0] += k0
    corner[k, 0, 1] += ks
    corner[k, 1, 1] += ks * s
    corner[k, 0, 2] += k1
    corner[k, 1, 2] += k1 * s
    corner[k, 2, 2] += k2
    corner[k, 3, 3] += ky
    corner[k, 3, 4] += ys
    corner[k, 4, 4] += ys * s
    corner[k, 0, 5] -= k0 * rise
    corner[k, 1, 5] -= ks * rise
    corner[k, 2, 5] -= k1 * rise
    corner[k, 3, 5] -= ky * aside
    corner[k, 4, 5] -= ys * aside
    corner[k, 5, 5] += k0 * rise * rise + ky * aside * aside
    # of the deflection: depth falls by cn, place across grows by cu
    y = 1.0 - z
    ww, wp = k0 * cn * cn + ky * cu * cu, -k1 * cn
    c0, c2, cy = -cn * k0, -cn * k1, cu * ky
    c5, t5 = -c0 * rise - cy * aside, -k1 * rise
    band, channels = out.band, out.channels
    if A >= 0:
        v0, v1 = w0 * ww, w1 * ww
        band[k, A, 0] += v0 * w0
        band[k, A + 1, 1] += v0 * w1
        band[k, A + 1, 0] += v1 * w1
        band[k, A + 2, 2] += y * w0 * wp
        band[k, A + 2, 1] += y * w1 * wp
        band[k, A + 2, 0] += y * y * k2
        channels[k, A, 0] += w0 * c0
        channels[k, A, 1] += w0 * c0 * s
        channels[k, A, 2] += w0 * c2
        channels[k, A, 3] += w0 * cy
        channels[k, A, 4] += w0 * cy * s
        channels[k, A, 5] += w0 * c5
        channels[k, A + 1, 0] += w1 * c0
        channels[k, A + 1, 1] += w1 * c0 * s
        channels[k, A + 1, 2] += w1 * c2
        channels[k, A + 1, 3] += w1 * cy
        channels[k, A + 1, 4] += w1 * cy * s
        channels[k, A + 1, 5] += w1 * c5
        channels[k, A + 2, 0] += y * k1
        channels[k, A + 2, 1] += y * k1 * s
        channels[k, A + 2, 2] += y * k2
        channels[k, A + 2, 5] += y * t5
        if B >= 0:
            band[k, B, 3] += v0 * w2
            band[k, B, 2] += v1 * w2
            band[k, B, 1] += y * w2 * wp
            band[k, B + 1, 4] += v0 * w3
            band[k, B + 1, 3] += v1 * w3
            band[k, B + 1, 2] += y * w3 * wp
            band[k, B + 2, 5] += z * w0 * wp
            band[k, B + 2, 4] += z * w1 * wp
            band[k, B + 2, 3] += y * z * k2
    if B >= 0:
        v2, v3 = w2 * ww, w3 * ww
        band[k, B, 0] += v2 * w2
        band[k, B + 1, 1] += v2 * w3
        band[k, B + 1, 0] += v3 * w3
        band[k, B + 2, 2] += z * w2 * wp
        band[k, B + 2, 1] += z * w3 * wp
        band[k, B + 2, 0] += z * z * k2
        channels[k, B, 0] += w2 * c0
        channels[k, B, 1] += w2 * c0 * s
        channels[k, B, 2] += w2 * c2
        channels[k, B, 3] += w2 * cy
        channels[k, B, 4] += w2 * cy * s
        channels[k, B, 5] += w2 * c5
        channels[k, B + 1, 0] += w3 * c0
        channels[k, B + 1, 1] += w3 * c0 * s
        channels[k, B + 1, 2] += w3 * c2
        channels[k, B + 1, 3] += w3 * cy
        channels[k, B + 1, 4] += w3 * cy * s
        channels[k, B + 1, 5] += w3 * c5
        channels[k, B + 2, 0] += z * k1
        channels[k, B + 2, 1] += z * k1 * s
        channels[k, B + 2, 2] += z * k2
        channels[k, B + 2, 5] += z * t5
