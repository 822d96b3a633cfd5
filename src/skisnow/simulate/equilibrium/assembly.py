"""Forces and tangents of a clamped ski in snow, station by station from tip to tail.

Unknowns: the beam's degrees of freedom u; as border the depth of the boot b₀ (m), its slope along the ski b₁, and the
shear stress τ (N/m²) that the edge draws from the snow; and, one pair for each station whose groove carries a station
behind it, the edge depth and twist of that station, so that Newton's method sees how the afterbody hangs on the
forebody's groove.

A section at the station s (positive forward) has the depth d = b₀ + b₁ s - cos ϑ (h + w) of its middle, the edge angle
ϑ + φ and the edge depth e = d + (W/2) sin(ϑ + φ). ξ is the distance from the edge in the snow surface.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from ...ski.beam.banded import HALF_BANDWIDTH
from ..contact.strip import SUMS, add_interval

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

BORDER = 3
"""Unknowns of the border that are always there: b₀, b₁, τ."""
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
    side_force_bending: float
    twists: float
    bevel: float
    bevel_width: float
    pitch_of_force: float  # share with which the snow's force takes part in the balance of moments about the boot
    pitch_of_shear: float  # share of the side force


class System(NamedTuple):
    """The linearised equations: banded matrix, border, residuals; and what each station feels."""

    matrix: FloatArray  # (n, 11)
    columns: FloatArray  # (p, n), transposed
    rows: FloatArray  # (p, n)
    corner: FloatArray  # (p, p)
    residual: FloatArray  # (n,)
    border_residual: FloatArray  # (p,)
    depth: FloatArray  # (m,) edge depth e
    force: FloatArray  # (m,) snow force per length along the snow normal
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
        np.zeros(1, np.int64),
    )


class Groove(NamedTuple):
    """What the stations ahead have left, and which of them did it.

    Following the edge: the greatest depth at each place ξ across, counted from the edge. Following the path: the
    outline's steps, each from its left end outwards as deep as one station's base reaches, told as the depth that base
    would have at the path; bases are taken parallel to each other there.
    """

    left: FloatArray
    depth: FloatArray
    source: IntArray
    steps: IntArray  # (1,)


class Linked(NamedTuple):
    """Stations whose depth and twist are unknowns of the border."""

    station: IntArray  # (m,)
    column: IntArray  # (m,) border unknown of each station, 0 where not linked
    known: IntArray  # (1,)


class Section(NamedTuple):
    """One section of the ski in the snow."""

    half: float  # half its width
    sine: float
    cosine: float
    tangent: float  # of its own edge angle, twist included
    corner: float  # depth that the edge would have without a bevel
    depth: float  # of the edge
    reach: float  # of the base across, in the snow surface
    strip: float  # width of the bevelled strip
    rise: float  # of the strip against the base, per length


@compiled(error_model="numpy", inline="always")
def _base_depth(xi: float, section: Section) -> float:
    """Depth ε of the base at ξ (m): a straight line, but for the bevelled strip along the edge."""
    bevel = max(0.0, section.strip - xi / section.cosine) * section.rise
    return section.corner - xi * section.tangent - bevel


@compiled(error_model="numpy")
def _column_of(linked: Linked, source: int) -> int:
    """First border unknown of a source station; links it if it is new."""
    if linked.column[source] == 0:
        linked.station[linked.known[0]] = source
        linked.column[source] = BORDER + 2 * linked.known[0]
        linked.known[0] += 1
    return linked.column[source]


@compiled(error_model="numpy", inline="always")
def _link(pulls: FloatArray, column: int, xi: float, square: float, force: float, moment: float) -> None:
    """Note what a deeper groove at ξ does: force and ∫p ξ by the depth and the twist of the station that cut it."""
    k = column - BORDER
    pulls[k, 0] += force
    pulls[k, 1] += moment
    pulls[k + 1, 0] -= xi * square * force
    pulls[k + 1, 1] -= xi * square * moment


@compiled(error_model="numpy")
def _across_following_edge(
    sums: FloatArray,
    pulls: FloatArray,
    linked: Linked,
    groove: Groove,
    place: FloatArray,
    section: Section,
    conditions: Conditions,
) -> None:
    """Add up a section over the places at which the groove is kept."""
    square = 1.0 + section.tangent * section.tangent
    for k in range(len(place) - 1):
        start, spacing = place[k], place[k + 1] - place[k]
        length = min(place[k + 1], section.reach) - start
        if length <= 0.0:
            break
        depth0, depth1 = _base_depth(start, section), _base_depth(start + length, section)
        if depth0 <= 0.0 and depth1 <= 0.0:
            continue
        groove0 = groove.depth[k]
        groove1 = groove0 + length / spacing * (groove.depth[k + 1] - groove0)
        sums[5:] = 0.0
        add_interval(sums, start, length, depth0, depth1, groove0, groove1, conditions.hardness, conditions.excess)
        if sums[5] != 0.0:
            far, far_moment = (sums[6] - start * sums[5]) / spacing, (sums[7] - start * sums[6]) / spacing
            near_column, far_column = _column_of(linked, groove.source[k]), _column_of(linked, groove.source[k + 1])
            _link(pulls, near_column, start, square, sums[5] - far, sums[6] - far_moment)
            _link(pulls, far_column, place[k + 1], square, far, far_moment)


@compiled(error_model="numpy")
def _pass_along_edge(groove: Groove, place: FloatArray, station: int, section: Section) -> None:
    """Deepen the groove where this station lies deeper."""
    for k in range(len(place)):
        depth = _base_depth(place[k], section)
        if depth >= groove.depth[k]:
            groove.depth[k] = depth
            groove.source[k] = station


@compiled(error_model="numpy")
def _across_following_path(
    sums: FloatArray,
    pulls: FloatArray,
    linked: Linked,
    groove: Groove,
    offset: float,
    section: Section,
    conditions: Conditions,
) -> None:
    """Add up a section over the steps of the groove's outline, whose cross-section is taken parallel to the base."""
    low = 0.0
    level = section.corner - offset * np.tan(conditions.edge_angle)
    bevel_end = section.strip * section.cosine
    for piece in range(groove.steps[0] + 1):
        high = section.reach
        if piece < groove.steps[0]:
            high = min(high, max(low, groove.left[piece] + offset))
        deeper = groove.depth[piece - 1] - level if piece > 0 else FAR_ABOVE
        sums[5:] = 0.0
        for bevelled in range(2):
            start, end = (low, min(high, bevel_end)) if bevelled == 0 else (max(low, bevel_end), high)
            if end > start:
                depth0, depth1 = _base_depth(start, section), _base_depth(end, section)
                groove0, groove1 = depth0 + deeper, depth1 + deeper
                add_interval(
                    sums, start, end - start, depth0, depth1, groove0, groove1, conditions.hardness, conditions.excess
                )
        if sums[5] != 0.0:
            _link(pulls, _column_of(linked, groove.source[piece - 1]), 0.0, 0.0, sums[5], sums[6])
        low = max(low, high)


@compiled(error_model="numpy")
def _pass_along_path(groove: Groove, offset: float, station: int, section: Section, edge_angle: float) -> None:
    """Put this station's base into the outline: it covers the steps to its right that are less deep."""
    left = -offset
    level = section.corner + left * np.tan(edge_angle)
    kept, covered = 0, False
    for k in range(groove.steps[0]):
        deeper = groove.depth[k] > level
        covered = covered or (deeper and groove.left[k] <= left)
        if deeper or groove.left[k] < left:
            groove.left[kept], groove.depth[kept] = groove.left[k], groove.depth[k]
            groove.source[kept] = groove.source[k]
            kept += 1
    if not covered:
        k = kept
        while k > 0 and groove.left[k - 1] > left:
            groove.left[k], groove.depth[k] = groove.left[k - 1], groove.depth[k - 1]
            groove.source[k] = groove.source[k - 1]
            k -= 1
        groove.left[k], groove.depth[k], groove.source[k] = left, level, station
        kept += 1
    groove.steps[0] = kept


@compiled(error_model="numpy")
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


@compiled(error_model="numpy")
def _link_rows(sections: Sections, conditions: Conditions, u: FloatArray, linked: Linked, out: System) -> None:
    """The equations of the linked stations: their unknowns are what beam and boot give them, edge depth and twist."""
    cosine = np.cos(conditions.edge_angle)
    for k in range(linked.known[0]):
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


class Load(NamedTuple):
    """What the snow does to a section, per length of ski, and how it grows with depth, twist and τ."""

    normal: float  # force normal to the base
    moment: float  # growth of the edge angle
    normal_by_depth: float
    normal_by_twist: float
    normal_by_stress: float
    moment_by_depth: float
    moment_by_twist: float
    moment_by_stress: float
    force: float  # along the snow normal
    force_by_depth: float
    force_by_twist: float
    bite: float  # depth of the edge where it is below the surface


@compiled(error_model="numpy", inline="always")
def _section(
    sections: Sections, conditions: Conditions, i: int, u: FloatArray, border: FloatArray, boot_cosine: float
) -> Section:
    deflection, phi = 0.0, 0.0
    for k in range(6):
        j = sections.dof[i, k]
        if j >= 0:
            deflection += sections.deflection[i, k] * u[j]
            phi += sections.twist[i, k] * u[j] * conditions.twists
    angle = conditions.edge_angle + phi
    sine, cosine = np.sin(angle), np.cos(angle)
    half = 0.5 * sections.width[i]
    height = boot_cosine * (sections.base_height[i] + deflection)
    corner = border[0] + border[1] * sections.station[i] - height + half * sine
    strip = conditions.bevel_width if conditions.bevel > 0.0 else 0.0
    rise = sine - np.sin(angle - conditions.bevel)
    return Section(half, sine, cosine, sine / cosine, corner, corner - strip * rise, 2.0 * half * cosine, strip, rise)


@compiled(error_model="numpy", inline="always")
def _load(
    section: Section, conditions: Conditions, sums: FloatArray, stress: float, sine: float, cosine: float
) -> Load:
    """Combine the snow's force along its normal, from the sums across, with the shear stress that the edge draws.

    The force along the snow normal turns the section about its middle, with the lever W/2 cos at the edge and less
    inwards; the shear τ e acts at the edge. `sine` and `cosine` are those of the boot's edge angle.
    """
    lever, square = section.half * section.cosine, 1.0 + section.tangent * section.tangent
    force, moment = sums[0], sums[1] - lever * sums[0]
    force_d, force_phi = sums[2], lever * sums[2] - square * sums[3]
    moment_d = sums[3] - lever * sums[2]
    moment_phi = lever * sums[3] - square * sums[4] - lever * force_phi + section.half * section.sine * sums[0]
    held = 1.0 if section.depth > 0.0 else 0.0
    bite = held * section.depth
    up = conditions.side_force_bending * sine
    turn, turn_phi = (
        -conditions.side_force_bending * section.half * section.sine,
        -conditions.side_force_bending * lever,
    )
    return Load(
        cosine * force + up * stress * bite,
        moment + turn * stress * bite,
        cosine * force_d + up * stress * held,
        cosine * force_phi + up * stress * held * lever,
        up * bite,
        moment_d + turn * stress * held,
        moment_phi + (turn * held * lever + turn_phi * bite) * stress,
        turn * bite,
        force,
        force_d,
        force_phi,
        bite,
    )


@compiled(error_model="numpy", inline="always")
def _add_to_border(out: System, conditions: Conditions, load: Load, weight: float, s: float, stress: float) -> None:
    right, corner = out.border_residual, out.corner
    held = 1.0 if load.bite > 0.0 else 0.0
    force, shear = conditions.pitch_of_force, conditions.pitch_of_shear
    slope = force * load.force_by_depth + shear * stress * held
    right[0] += weight * load.force
    right[1] += weight * (force * load.force + shear * stress * load.bite) * s
    right[2] += weight * stress * load.bite
    corner[0, 0] += weight * load.force_by_depth
    corner[0, 1] += weight * load.force_by_depth * s
    corner[1, 0] += weight * slope * s
    corner[1, 1] += weight * slope * s * s
    corner[1, 2] += weight * shear * load.bite * s
    corner[2, 0] += weight * stress * held
    corner[2, 1] += weight * stress * held * s
    corner[2, 2] += weight * load.bite


@compiled(error_model="numpy", inline="always")
def _add_to_beam(
    out: System, sections: Sections, conditions: Conditions, load: Load, i: int, stress: float, cosine: float,
    lever: float,
) -> None:  # fmt: skip
    """Add the station's load to the beam's equations, and what beam and border do to it to the tangent."""
    weight, s, twists = sections.weight[i], sections.station[i], conditions.twists
    held = stress if load.bite > 0.0 else 0.0
    for a in range(6):
        j = sections.dof[i, a]
        if j < 0:
            continue
        bends, turns = sections.deflection[i, a], sections.twist[i, a] * twists
        w, t = weight * bends, weight * turns
        out.residual[j] -= w * load.normal + t * load.moment
        by_depth = w * load.normal_by_depth + t * load.moment_by_depth
        by_twist = w * load.normal_by_twist + t * load.moment_by_twist
        out.columns[0, j] -= by_depth
        out.columns[1, j] -= by_depth * s
        out.columns[2, j] -= w * load.normal_by_stress + t * load.moment_by_stress
        slope = weight * (load.force_by_twist * turns - load.force_by_depth * cosine * bends)
        out.rows[0, j] += slope
        deeper = weight * held * (lever * turns - cosine * bends)
        out.rows[1, j] += (conditions.pitch_of_force * slope + conditions.pitch_of_shear * deeper) * s
        out.rows[2, j] += deeper
        for b in range(6):
            jb = sections.dof[i, b]
            if jb >= 0:
                by_b = by_twist * sections.twist[i, b] * twists - by_depth * cosine * sections.deflection[i, b]
                out.matrix[j, jb - j + HALF_BANDWIDTH] -= by_b


@compiled(error_model="numpy")
def _add_pulls(
    out: System, sections: Sections, conditions: Conditions, pulls: FloatArray, used: int, i: int, cosine: float,
    lever: float,
) -> None:  # fmt: skip
    """Add what a deeper groove, cut by the linked stations, does to this station's load."""
    weight, s, twists = sections.weight[i], sections.station[i], conditions.twists
    for k in range(used):
        by_force, by_moment = pulls[k, 0], pulls[k, 1] - lever * pulls[k, 0]
        if by_force == 0.0 and by_moment == 0.0:
            continue
        c = BORDER + k
        out.corner[0, c] += weight * by_force
        out.corner[1, c] += weight * conditions.pitch_of_force * by_force * s
        for a in range(6):
            j = sections.dof[i, a]
            if j >= 0:
                normal, turn = cosine * sections.deflection[i, a] * by_force, sections.twist[i, a] * twists * by_moment
                out.columns[c, j] -= weight * (normal + turn)


@compiled(error_model="numpy")
def assemble(
    sections: Sections, conditions: Conditions, stiffness: FloatArray, u: FloatArray, border: FloatArray, out: System
) -> None:
    """Fill `out` at the state (u, border)."""
    _start(stiffness, u, out)
    sine, cosine, stress = np.sin(conditions.edge_angle), np.cos(conditions.edge_angle), border[2]
    n = len(sections.station)
    kept = max(n, len(sections.place))
    groove = Groove(np.zeros(kept), np.full(kept, FAR_ABOVE), np.zeros(kept, np.int64), np.zeros(1, np.int64))
    linked = Linked(np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(1, np.int64))
    sums, pulls = np.zeros(SUMS), np.zeros((2 * n, 2))
    for i in range(n):
        section = _section(sections, conditions, i, u, border, cosine)
        sums[:] = 0.0
        pulls[: 2 * linked.known[0]] = 0.0
        if conditions.groove_follows_path > 0.0:
            _across_following_path(sums, pulls, linked, groove, sections.offset[i], section, conditions)
            _pass_along_path(groove, sections.offset[i], i, section, conditions.edge_angle)
        else:
            _across_following_edge(sums, pulls, linked, groove, sections.place, section, conditions)
            _pass_along_edge(groove, sections.place, i, section)
        load = _load(section, conditions, sums, stress, sine, cosine)
        lever = section.half * section.cosine
        out.depth[i], out.force[i] = section.depth, load.force
        _add_to_border(out, conditions, load, sections.weight[i], sections.station[i], stress)
        _add_to_beam(out, sections, conditions, load, i, stress, cosine, lever)
        _add_pulls(out, sections, conditions, pulls, 2 * linked.known[0], i, cosine, lever)
    out.border_residual[0] -= conditions.load
    out.border_residual[1] -= conditions.moment
    out.border_residual[2] -= conditions.side_force
    _link_rows(sections, conditions, u, linked, out)
    out.used[0] = BORDER + 2 * linked.known[0]
