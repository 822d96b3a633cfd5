"""Geometry of a replay: edges of the skis in space, times of the groove, unit quaternions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from ..simulation.sledge_body import base_lateral, base_normal, rotation

if TYPE_CHECKING:
    from .replay import Replay

FloatArray: TypeAlias = npt.NDArray[np.float64]


def ski_edges(replay: Replay, frame: int, *, exaggeration: float = 1.0) -> FloatArray:
    """Both edges of both skis' bases in space (m): (ski, station, edge (0 left, 1 right), 3).

    Parameters
    ----------
    replay
        What is shown.
    frame
        Number of the moment, 0 to n - 1.
    exaggeration
        Factor on bending and twist, the shape of the unloaded base kept; 1: as it is.

    Notes
    -----
    With x ahead, l across the base to the left and n away from the snow, a ski's base at station s has its middle at
    s x + (h + w) n from the boot and its edges at ± b/2 (cos φ l - sin φ n) beside: h the unloaded base, w the bending,
    b the width, φ the twist. The stations do not come nearer as a ski bends.
    """
    skis = replay.skis
    place, across, away, ahead = _boots(replay, frame)
    twist = exaggeration * skis.twist[frame][..., None]
    height = skis.base_height + exaggeration * skis.bending[frame]
    middle = place[:, None, :] + skis.station[:, None] * ahead[:, None] + height[..., None] * away[:, None]
    half = skis.half_width[:, None] * (np.cos(twist) * across[:, None] - np.sin(twist) * away[:, None])
    return np.stack([middle + half, middle - half], axis=2)


def _boots(replay: Replay, frame: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Place of each boot (2, 3) in space (m), and its axes across the base to the left, off it, and ahead."""
    skis = replay.skis
    if skis.boots is not None:
        axes = np.stack([rotation(each).T for each in skis.boots.attitude[frame]])
        return skis.boots.place[frame], axes[:, 1], axes[:, 2], axes[:, 0]
    turn = rotation(replay.attitude[frame])
    own = (base_lateral(skis.edge_angle), base_normal(skis.edge_angle), np.array([1.0, 0.0, 0.0]))
    across, away, ahead = (np.broadcast_to(turn @ axis, (len(skis.middle), 3)) for axis in own)
    return replay.place[frame] + skis.middle @ turn.T, across, away, ahead


def nearest_frame(replay: Replay, time: float) -> int:
    """Number of the moment nearest to a time (s)."""
    return int(np.argmin(np.abs(replay.time - time)))


_NEIGHBOURS: Final = 2


def groove_times(middle: FloatArray, time: FloatArray, track: FloatArray) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Time (k,) at which a boot passed each piece, and the ski (k,) whose boot came nearest.

    Parameters
    ----------
    middle
        (k, 3) of the pieces (m).
    time
        (n,) of the run (s), n ≥ 1.
    track
        (n, 2, 3) of the loaded edges under the boots (m).

    Notes
    -----
    Between two outputs the boot is taken to go straight. A piece ahead of the boot's last place, or behind its first,
    gets the last or the first time. Where a path crosses itself the nearer passage counts.

    Examples
    --------
    >>> track = np.array([[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]], [[2.0, 1.0, 0.0], [2.0, -1.0, 0.0]]])
    >>> when, ski = groove_times(np.array([[0.5, -0.99, 0.0], [3.0, 1.0, 0.0]]), np.array([0.0, 1.0]), track)
    >>> when.tolist(), ski.tolist()
    ([0.25, 1.0], [1, 0])
    """
    passages = [_passage(middle, time, track[:, ski]) for ski in range(2)]
    nearer = np.asarray(passages[1][1] < passages[0][1], dtype=np.int64)
    return np.where(nearer == 1, passages[1][0], passages[0][0]), nearer


def _passage(middle: FloatArray, time: FloatArray, track: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Time (k,) of the nearest passage, and its distance (k,)."""
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

    Examples
    --------
    >>> quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])  # about z, to the left
    >>> quaternions(quarter).round(6).tolist()
    [[0.707107, 0.0, 0.0, 0.707107]]
    """
    if not len(matrices):
        return np.zeros((0, 4))
    return continuous(np.roll(Rotation.from_matrix(np.array(matrices)).as_quat(canonical=True), 1, axis=1))


def continuous(found: FloatArray) -> FloatArray:
    """The same rotations by quaternions (n, 4) of which none is opposite to the one before."""
    turned = np.sum(found[1:] * found[:-1], axis=1) < 0.0
    return np.asarray(found * np.cumprod(np.append(1.0, np.where(turned, -1.0, 1.0)))[:, None])
