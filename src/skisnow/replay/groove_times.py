"""When each piece of groove was made, and by which ski."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

FloatArray: TypeAlias = npt.NDArray[np.float64]

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
