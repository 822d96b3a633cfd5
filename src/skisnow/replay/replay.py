"""Arrays of a replay: motion, shape and load of the skis, groove and slope; and their geometry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from .._support.arrays import FloatArray, IntArray
from .._support.errors import ParameterError
from ..track.track import Track

FEWEST_POINTS: Final = 2


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayBoots:
    """Moving boots: place (n, 2, 3) in space (m), and unit quaternion w, x, y, z (n, 2, 4).

    The quaternion rotates x ahead, y left across the base and z off the base into space.
    """

    place: FloatArray
    attitude: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplaySkier:
    """A skier: height (m) and weight (N) of the body, and drawn joints (n, 17, 3).

    The joints are relative to the middle between the boots, in the body's axes (m) and in the order of
    `skisnow.replay.skier.JOINTS`.
    """

    height: float
    weight: float
    joints: FloatArray


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayTerrain:
    """A slope of measured heights around a run.

    x, y: evenly spaced rising places (m), shapes (p,) and (q,).
    height: height of the snow at these places (m), shape (p, q), linear between them.
    grade: mean dz/dx and dz/dy, for the snow beyond these places.
    """

    x: FloatArray
    y: FloatArray
    height: FloatArray
    grade: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplaySkis:
    """Two equal skis on a sledge; histories have the indices time, ski (0 left, 1 right), station from tip to tail.

    station, half_width, base_height: position from the boot, half of the width, height of the unloaded base above that
        at the boot (m), shape (m,).
    middle: place of each ski's boot in the sledge's frame (m), shape (2, 3).
    edge_angle: edge angle of both skis against the sledge, positive: left edge down (rad).
    bending, twist: deflection of the base away from the snow (m), growth of the edge angle (rad), relative to the boot,
        (n, 2, m).
    edge_depth: depth of the lower edge below the undisturbed surface, negative above it (m), (n, 2, m).
    force_per_length: normal force of the snow per length (N/m), (n, 2, m).
    force: total force of the snow in space: normal force, shear and friction (N), (n, 2, 3).
    normal_force: component of the total force along the snow's normal (N), (n, 2).
    boots: moving boots, which determine the places of the skis (default: `middle` and `edge_angle`).
    """

    station: FloatArray
    half_width: FloatArray
    base_height: FloatArray
    middle: FloatArray
    edge_angle: float
    bending: FloatArray
    twist: FloatArray
    edge_depth: FloatArray
    force_per_length: FloatArray
    force: FloatArray
    normal_force: FloatArray
    boots: ReplayBoots | None = None


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayGroove:
    """Pieces of groove, each a short line across the path.

    middle, left: place on the undisturbed surface (m), and unit vector along the piece to the left, (k, 3).
    width, depth, residual_depth: width, maximum depth, residual depth (m), (k,).
    time: time when the boot, which has the load, passed the piece (s), (k,).
    ski: index of its ski, (k,): 0 left, 1 right.
    spacing: distance of pieces along the path (m), which is also their length.
    """

    middle: FloatArray
    left: FloatArray
    width: FloatArray
    depth: FloatArray
    residual_depth: FloatArray
    time: FloatArray
    ski: IntArray
    spacing: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ReplayTrack:
    """A measured track in the run's axes: name, place (t, 3) in m, time (t,) in s on the run's clock if known."""

    name: str
    place: FloatArray
    time: FloatArray | None = None


def measured_track(track: Track, *, starts_at: float = 0.0) -> ReplayTrack:
    """Measured track for a replay, without points that have no place.

    track: track in the run's axes: x down the fall line, y left, z out of the snow.
    starts_at: time of the run at the first point (s).
    Raises ParameterError: the axes are east, north and up, or fewer than two points have a place.
    """
    if track.axes == "east_north_up":
        raise ParameterError(
            "{track} is in east, north and up; a run is in the axes of the slope. Turn it with slope_frame first"
        ).tag("wrong_axes", track=track.name)
    placed = np.isfinite(track.place[:, :2]).all(axis=1)
    if placed.sum() < FEWEST_POINTS:
        raise ParameterError("{track} has {points} points with a place; a line needs {fewest}").tag(
            "too_few_points", track=track.name, points=placed.sum(), fewest=FEWEST_POINTS
        )
    return ReplayTrack(name=track.name, place=track.place[placed], time=track.time[placed] + starts_at)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Replay:
    """A run as arrays in SI units and radians.

    title, facts: title, and lines of name and value for the reader.
    tilt: angle of the shown plane's x axis below the horizontal (rad): the inclination of a plane; 0 on a profile and a
        terrain, whose axes are horizontal and vertical.
    centre_of_mass_height: height of the centre of mass above the bases (m).
    time: times (s), shape (n,).
    place, attitude: place of the middle between the boots (m), (n, 3); unit quaternion w, x, y, z from sledge to space,
        (n, 4).
    speed, curvature, heading: speed (m/s), 1/turn radius (1/m), heading from the fall line (rad), positive left, (n,).
    depth: depth of the loaded edge under the boot below the undisturbed surface (m), (n, 2).
    skis, groove: shape and load of the skis, and their groove.
    profile: distance and height of a measured slope (m), shape (p, 2).
    track: measured track.
    gates: feet of the gates' poles on the snow (m), (g, 3), in the order of the course.
    gate_times: time from the start of the run to each gate (s), (g,); NaN for a gate that was not crossed.
    terrain: measured heights over the place; without terrain and profile the slope is the plane z = 0.
    skier: skier of the run.
    """

    title: str
    facts: tuple[tuple[str, str], ...]
    tilt: float
    centre_of_mass_height: float
    time: FloatArray
    place: FloatArray
    attitude: FloatArray
    speed: FloatArray
    curvature: FloatArray
    heading: FloatArray
    depth: FloatArray
    skis: ReplaySkis
    groove: ReplayGroove
    profile: FloatArray | None = None
    track: ReplayTrack | None = None
    gates: FloatArray | None = None
    gate_times: FloatArray | None = None
    terrain: ReplayTerrain | None = None
    skier: ReplaySkier | None = None


_NEIGHBOURS: Final = 2


def groove_times(middle: FloatArray, time: FloatArray, track: FloatArray) -> tuple[FloatArray, IntArray]:
    """Time (k,) at which a boot passed each piece of groove, and index (k,) of the ski with the nearest boot.

    middle: places of the pieces (m), (k, 3).
    time: times of the run (s), (n,), n ≥ 1.
    track: places of the loaded edges under the boots (m), (n, 2, 3).

    The boot moves straight between two outputs. A piece ahead of the boot's last place, or behind its first, gets the
    last or the first time. If a path crosses itself, the nearer passage counts.

    >>> track = np.array([[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]], [[2.0, 1.0, 0.0], [2.0, -1.0, 0.0]]])
    >>> when, ski = groove_times(np.array([[0.5, -0.99, 0.0], [3.0, 1.0, 0.0]]), np.array([0.0, 1.0]), track)
    >>> when.tolist(), ski.tolist()
    ([0.25, 1.0], [1, 0])
    """
    passages = [_passage_times(middle, time, track[:, ski]) for ski in range(2)]
    nearer = np.asarray(passages[1][1] < passages[0][1], dtype=np.int64)
    return np.where(nearer == 1, passages[1][0], passages[0][0]), nearer


def _passage_times(middle: FloatArray, time: FloatArray, track: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Time (k,) at which a boot's track (n, 3) passes nearest to each piece of groove, and the distance (k,) (m)."""
    if len(time) < _NEIGHBOURS or not len(middle):
        return np.full(len(middle), time[0]), np.linalg.norm(middle - track[0], axis=1)
    nearest = np.asarray(cKDTree(track).query(middle)[1], dtype=np.int64)
    before = np.clip(nearest[:, None] + np.array([-1, 0]), 0, len(time) - 2)  # the step that ends there, and the next
    start, step = track[before], track[before + 1] - track[before]
    length2 = np.maximum(np.sum(step**2, axis=2), 1e-30)
    share = np.clip(np.sum((middle[:, None] - start) * step, axis=2) / length2, 0.0, 1.0)
    distance = np.linalg.norm(start + share[..., None] * step - middle[:, None], axis=2)
    better = np.argmin(distance, axis=1)
    rows = np.arange(len(middle))
    chosen = before[rows, better]
    when = time[chosen] + share[rows, better] * (time[chosen + 1] - time[chosen])
    return when, distance[rows, better]


def quaternions(matrices: FloatArray) -> FloatArray:
    """Unit quaternions (n, 4), w, x, y, z, of rotation matrices (n, 3, 3); none is opposite to the one before.

    >>> quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])  # about z, to the left
    >>> quaternions(quarter).round(6).tolist()
    [[0.707107, 0.0, 0.0, 0.707107]]
    """
    if not len(matrices):
        return np.zeros((0, 4))
    turns = np.roll(Rotation.from_matrix(np.array(matrices)).as_quat(canonical=True), 1, axis=1)
    turned = np.sum(turns[1:] * turns[:-1], axis=1) < 0.0
    return np.asarray(turns * np.cumprod(np.append(1.0, np.where(turned, -1.0, 1.0)))[:, None])


def rotation_of(quaternion: FloatArray) -> Rotation:
    """Rotations by unit quaternions w, x, y, z, shape (4,) or (n, 4)."""
    return Rotation.from_quat(np.roll(quaternion, -1, axis=-1))
