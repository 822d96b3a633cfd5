"""Forces and tangents of a clamped ski in snow, station by station from tip to tail.

Unknowns: the beam's degrees of freedom u; as border the depth of the boot b₀ (m), its slope along the ski b₁, and the shear
stress τ (N/m²) that the edge draws from the snow; and, one pair for each station whose groove carries a station behind it,
the edge depth and twist of that station, so that Newton's method sees how the afterbody hangs on the forebody's groove.

A section at the station s (positive forward) has the depth d = b₀ + b₁ s - cos ϑ (h + w) of its middle, the edge angle
ϑ + φ and the edge depth e = d + (W/2) sin(ϑ + φ). ξ is the distance from the edge in the snow surface.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numba
import numpy as np
import numpy.typing as npt

from ..contact.strip import SUMS, add_interval

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

BORDER = 3
"""Unknowns of the border that are always there: b₀, b₁, τ."""
MOST_STEPS = 64
"""Places across the ski, or steps of the groove's outline, that are kept."""
FAR_ABOVE = -1e3
"""Depth (m) that stands for snow never touched."""


class Sections(NamedTuple):
    """Where the snow is felt, tip to tail; see `skisnow.ski.beam.clamped.Stations`."""

    station: FloatArray
    weight: FloatArray
    width: FloatArray
    base_height: FloatArray
    dof: IntArray
    deflection: FloatArray
    twist: FloatArray
    place: FloatArray  # (k,) ξ of the places across at which the groove is kept (m), rising from 0
    offset: (
        FloatArray  # of the edge from the path towards the inside of the turn (m), where the groove follows the path
    )


class Conditions(NamedTuple):
    """Snow, load and modelling choices, in SI; switches are 1.0 or 0.0."""

    edge_angle: float
    hardness: float
    excess: float  # k_u - H_V
    load: float
    moment: float
    side_force: float
    groove_follows_path: float
    side_force_bends: float
    twists: float
    bevel: float
    bevel_width: float


class System(NamedTuple):
    """The linearised equations: banded matrix, border columns and rows, corner, residuals; and what each station feels."""

    matrix: FloatArray  # (n, 11)
    columns: FloatArray  # (p, n), transposed
    rows: FloatArray  # (p, n)
    corner: FloatArray  # (p, p)
    residual: FloatArray  # (n,)
    border_residual: FloatArray  # (p,)
    depth: FloatArray  # (m,) edge depth e
    force: FloatArray  # (m,) snow force per length along the snow normal
    moment: FloatArray  # (m,) twisting moment per length of that force
    used: IntArray  # (1,) border unknowns in use


def new_system(size: int, stations: int) -> System:
    """Empty arrays for a ski with that many unknowns and stations."""
    border = BORDER + 2 * stations
    return System(
        np.zeros((size, 11)),
        np.zeros((border, size)),
        np.zeros((border, size)),
        np.zeros((border, border)),
        np.zeros(size),
        np.zeros(border),
        np.zeros(stations),
        np.zeros(stations),
        np.zeros(stations),
        np.zeros(1, np.int64),
    )


class Groove(NamedTuple):
    """What the stations ahead have left, and which of them did it.

    Following the edge: the greatest depth at each place ξ across, counted from the edge. Following the path: the outline's
    steps, each from its left end outwards as deep as one station's base would reach.
    """

    left: FloatArray
    depth: FloatArray
    source: IntArray
    count: IntArray  # (1,)


class Linked(NamedTuple):
    """Stations whose depth and twist are unknowns of the border."""

    station: IntArray  # (m,)
    column: IntArray  # (m,) border unknown of each station, 0 where not linked
    count: IntArray  # (1,)


@numba.njit(cache=True, error_model="numpy", inline="always")
def _base_depth(xi: float, corner: float, tangent: float, strip: float, rise: float, cosine: float) -> float:
    """Depth ε of the base at ξ (m): a straight line, but for the bevelled strip along the edge."""
    return corner - xi * tangent - max(0.0, strip - xi / cosine) * rise


@numba.njit(cache=True, error_model="numpy")
def _column_of(linked: Linked, source: int) -> int:
    """First border unknown of a source station; links it if it is new."""
    if linked.column[source] == 0:
        linked.station[linked.count[0]] = source
        linked.column[source] = BORDER + 2 * linked.count[0]
        linked.count[0] += 1
    return linked.column[source]


@numba.njit(cache=True, error_model="numpy", inline="always")
def _link(pulls: FloatArray, column: int, xi: float, square: float, force: float, moment: float) -> None:
    """Note what a deeper groove at ξ does: force and ∫p ξ by the depth and the twist of the station that cut it."""
    k = column - BORDER
    pulls[k, 0] += force
    pulls[k, 1] += moment
    pulls[k + 1, 0] -= xi * square * force
    pulls[k + 1, 1] -= xi * square * moment


@numba.njit(cache=True, error_model="numpy")
def _across_following_edge(
    sums: FloatArray, pulls: FloatArray, linked: Linked, groove: Groove, place: FloatArray, reach: float,
    corner: float, tangent: float, strip: float, rise: float, cosine: float, hardness: float, excess: float,
) -> None:  # fmt: skip
    """Add up a section over the places at which the groove is kept."""
    square = 1.0 + tangent * tangent
    for k in range(len(place) - 1):
        start = place[k]
        length = min(place[k + 1], reach) - start
        if length <= 0.0:
            break
        depth0 = _base_depth(start, corner, tangent, strip, rise, cosine)
        depth1 = _base_depth(start + length, corner, tangent, strip, rise, cosine)
        if depth0 <= 0.0 and depth1 <= 0.0:
            continue
        share = length / (place[k + 1] - start)
        groove0 = groove.depth[k]
        groove1 = groove0 + share * (groove.depth[k + 1] - groove0)
        sums[5:] = 0.0
        add_interval(sums, start, length, depth0, depth1, groove0, groove1, hardness, excess)
        if sums[5] != 0.0:
            spacing = place[k + 1] - start
            far, far_moment = (sums[6] - start * sums[5]) / spacing, (sums[7] - start * sums[6]) / spacing
            near = _column_of(linked, groove.source[k])
            _link(pulls, near, start, square, sums[5] - far, sums[6] - far_moment)
            next_one = _column_of(linked, groove.source[k + 1])
            _link(pulls, next_one, place[k + 1], square, far, far_moment)


@numba.njit(cache=True, error_model="numpy")
def _pass_along_edge(
    groove: Groove,
    place: FloatArray,
    station: int,
    corner: float,
    tangent: float,
    strip: float,
    rise: float,
    cosine: float,
) -> None:
    """Deepen the groove where this station lies deeper."""
    for k in range(len(place)):
        depth = _base_depth(place[k], corner, tangent, strip, rise, cosine)
        if depth >= groove.depth[k]:
            groove.depth[k] = depth
            groove.source[k] = station


@numba.njit(cache=True, error_model="numpy")
def _across_following_path(
    sums: FloatArray, pulls: FloatArray, linked: Linked, groove: Groove, offset: float, reach: float,
    corner: float, tangent: float, strip: float, rise: float, cosine: float, hardness: float, excess: float,
) -> None:  # fmt: skip
    """Add up a section over the steps of the groove's outline, whose cross-section is taken parallel to the base."""
    low = 0.0
    bevel_end = strip * cosine
    for piece in range(groove.count[0] + 1):
        high = reach
        if piece < groove.count[0]:
            high = min(reach, max(low, groove.left[piece] + offset))
        deeper = FAR_ABOVE
        if piece > 0:
            deeper = groove.depth[piece - 1] + (groove.left[piece - 1] + offset) * tangent - corner
        sums[5:] = 0.0
        for half in range(2):
            start, end = (low, min(high, bevel_end)) if half == 0 else (max(low, bevel_end), high)
            if end > start:
                depth0 = _base_depth(start, corner, tangent, strip, rise, cosine)
                depth1 = _base_depth(end, corner, tangent, strip, rise, cosine)
                add_interval(
                    sums, start, end - start, depth0, depth1, depth0 + deeper, depth1 + deeper, hardness, excess
                )
        if sums[5] != 0.0:
            column = _column_of(linked, groove.source[piece - 1])
            _link(pulls, column, 0.0, 0.0, sums[5], sums[6])
        low = max(low, high)


@numba.njit(cache=True, error_model="numpy")
def _pass_along_path(groove: Groove, offset: float, station: int, corner: float, tangent: float) -> None:
    """Put this station's base into the outline: it covers the steps to its right that are less deep."""
    left = -offset
    level = corner + left * tangent
    steps = groove.count[0]
    kept = 0
    covered = False
    for k in range(steps):
        old = groove.depth[k] + groove.left[k] * tangent
        if groove.left[k] <= left and old > level:
            covered = True
        if groove.left[k] < left or old > level:
            groove.left[kept], groove.depth[kept], groove.source[kept] = (
                groove.left[k],
                groove.depth[k],
                groove.source[k],
            )
            kept += 1
    if not covered and kept < MOST_STEPS:
        k = kept
        while k > 0 and groove.left[k - 1] > left:
            groove.left[k], groove.depth[k] = groove.left[k - 1], groove.depth[k - 1]
            groove.source[k] = groove.source[k - 1]
            k -= 1
        groove.left[k], groove.depth[k], groove.source[k] = left, corner, station
        kept += 1
    groove.count[0] = kept


@numba.njit(cache=True, error_model="numpy")
def _start(stiffness: FloatArray, u: FloatArray, out: System) -> None:
    """The beam alone: its banded matrix and its elastic forces; everything else zero."""
    size = len(u)
    for i in range(size):
        total = 0.0
        for k in range(11):
            out.matrix[i, k] = stiffness[i, k]
            j = i + k - 5
            if 0 <= j < size:
                total += stiffness[i, k] * u[j]
        out.residual[i] = total
    used = max(out.used[0], BORDER)
    out.columns[:used] = 0.0
    out.rows[:used] = 0.0
    out.corner[:used, :used] = 0.0
    out.border_residual[:] = 0.0


@numba.njit(cache=True, error_model="numpy")
def _link_rows(sections: Sections, conditions: Conditions, u: FloatArray, linked: Linked, out: System) -> None:
    """The equations of the linked stations: their unknowns are the edge depth and twist that beam and boot give them."""
    cosine = np.cos(conditions.edge_angle)
    for k in range(linked.count[0]):
        i, c = linked.station[k], BORDER + 2 * k
        phi = 0.0
        for a in range(6):
            j = sections.dof[i, a]
            if j >= 0:
                phi += sections.twist[i, a] * u[j] * conditions.twists
        lever = 0.5 * sections.width[i] * np.cos(conditions.edge_angle + phi)
        out.corner[c, c] = 1.0
        out.corner[c + 1, c + 1] = 1.0
        out.corner[c, 0] -= 1.0
        out.corner[c, 1] -= sections.station[i]
        for a in range(6):
            j = sections.dof[i, a]
            if j >= 0:
                twisted = sections.twist[i, a] * conditions.twists
                out.rows[c, j] += cosine * sections.deflection[i, a] - lever * twisted
                out.rows[c + 1, j] -= twisted


@numba.njit(cache=True, error_model="numpy")
def assemble(
    sections: Sections, conditions: Conditions, stiffness: FloatArray, u: FloatArray, border: FloatArray, out: System
) -> None:
    """Fill `out` at the state (u, border)."""
    _start(stiffness, u, out)
    matrix, columns, rows, corner, right = out.matrix, out.columns, out.rows, out.corner, out.border_residual
    boot_sine, boot_cosine = np.sin(conditions.edge_angle), np.cos(conditions.edge_angle)
    hardness, excess = conditions.hardness, conditions.excess
    bends, stress = conditions.side_force_bends, border[2]
    strip = conditions.bevel_width if conditions.bevel > 0.0 else 0.0
    groove = Groove(
        np.zeros(MOST_STEPS), np.full(MOST_STEPS, FAR_ABOVE), np.zeros(MOST_STEPS, np.int64), np.zeros(1, np.int64)
    )
    n_stations = len(sections.station)
    linked = Linked(np.zeros(n_stations, np.int64), np.zeros(n_stations, np.int64), np.zeros(1, np.int64))
    sums, pulls = np.zeros(SUMS), np.zeros((2 * n_stations, 2))
    local_d, local_phi = np.zeros(6), np.zeros(6)

    for i in range(n_stations):
        s, weight, half = sections.station[i], sections.weight[i], 0.5 * sections.width[i]
        deflection, phi = 0.0, 0.0
        for k in range(6):
            j = sections.dof[i, k]
            local_d[k], local_phi[k] = 0.0, 0.0
            if j >= 0:
                deflection += sections.deflection[i, k] * u[j]
                phi += sections.twist[i, k] * u[j] * conditions.twists
                local_d[k] = -boot_cosine * sections.deflection[i, k]
                local_phi[k] = sections.twist[i, k] * conditions.twists
        angle = conditions.edge_angle + phi
        sine, cosine = np.sin(angle), np.cos(angle)
        tangent, square = sine / cosine, 1.0 / (cosine * cosine)
        rise = sine - np.sin(angle - conditions.bevel)
        edge = border[0] + border[1] * s - boot_cosine * (sections.base_height[i] + deflection) + half * sine
        depth = edge - strip * rise
        reach = 2.0 * half * cosine

        sums[:] = 0.0
        pulls[: 2 * linked.count[0]] = 0.0
        if conditions.groove_follows_path > 0.0:
            offset = sections.offset[i]
            _across_following_path(
                sums, pulls, linked, groove, offset, reach, edge, tangent, strip, rise, cosine, hardness, excess
            )
            _pass_along_path(groove, offset, i, edge, tangent)
        else:
            place = sections.place
            _across_following_edge(
                sums, pulls, linked, groove, place, reach, edge, tangent, strip, rise, cosine, hardness, excess
            )
            _pass_along_edge(groove, place, i, edge, tangent, strip, rise, cosine)

        # the force along the snow normal turns the section about its middle: lever half·cos at the edge, less inwards
        lever = half * cosine
        force, moment = sums[0], sums[1] - lever * sums[0]
        force_d, force_phi = sums[2], lever * sums[2] - square * sums[3]
        moment_d = sums[3] - lever * sums[2]
        moment_phi = lever * sums[3] - square * sums[4] - lever * force_phi + half * sine * sums[0]
        out.depth[i], out.force[i], out.moment[i] = depth, force, moment
        for k in range(2 * linked.count[0]):
            by_force, by_moment = pulls[k, 0], pulls[k, 1] - lever * pulls[k, 0]
            if by_force != 0.0 or by_moment != 0.0:
                c = BORDER + k
                corner[0, c] += weight * by_force
                corner[1, c] += weight * by_force * s
                for a in range(6):
                    j = sections.dof[i, a]
                    if j >= 0:
                        columns[c, j] += weight * (local_d[a] * by_force - local_phi[a] * by_moment)

        # the edge draws the shear stress τ over its depth; what of it is normal to the base bends and twists too
        held = 1.0 if depth > 0.0 else 0.0
        bite = held * depth
        up, turn = bends * boot_sine, -bends * half * sine
        q, m = boot_cosine * force + up * stress * bite, moment + turn * stress * bite
        q_d, q_phi = boot_cosine * force_d + up * stress * held, boot_cosine * force_phi + up * stress * held * lever
        m_d = moment_d + turn * stress * held
        m_phi = moment_phi + turn * stress * held * lever - bends * lever * stress * bite
        right[0] += weight * force
        right[1] += weight * force * s
        right[2] += weight * stress * bite
        corner[0, 0] += weight * force_d
        corner[0, 1] += weight * force_d * s
        corner[1, 0] += weight * force_d * s
        corner[1, 1] += weight * force_d * s * s
        corner[2, 0] += weight * stress * held
        corner[2, 1] += weight * stress * held * s
        corner[2, 2] += weight * bite
        for a in range(6):
            j = sections.dof[i, a]
            if j < 0:
                continue
            w, t = weight * sections.deflection[i, a], weight * local_phi[a]
            out.residual[j] -= w * q + t * m
            columns[0, j] -= w * q_d + t * m_d
            columns[1, j] -= (w * q_d + t * m_d) * s
            columns[2, j] -= (w * up + t * turn) * bite
            slope = force_d * local_d[a] + force_phi * local_phi[a]
            rows[0, j] += weight * slope
            rows[1, j] += weight * slope * s
            rows[2, j] += weight * stress * held * (local_d[a] + lever * local_phi[a])
            for b in range(6):
                jb = sections.dof[i, b]
                if jb >= 0:
                    by_q, by_m = q_d * local_d[b] + q_phi * local_phi[b], m_d * local_d[b] + m_phi * local_phi[b]
                    matrix[j, jb - j + 5] -= w * by_q + t * by_m
    right[0] -= conditions.load
    right[1] -= conditions.moment
    right[2] -= conditions.side_force
    _link_rows(sections, conditions, u, linked, out)
    out.used[0] = BORDER + 2 * linked.count[0]
