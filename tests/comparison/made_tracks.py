"""Tracks whose distances are known by hand."""

from collections.abc import Sequence
from datetime import datetime

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.track.track import Track


def build_track(
    place: FloatArray | Sequence[Sequence[float]],
    time: FloatArray | Sequence[float] | None = None,
    *,
    name: str = "made",
    start: datetime | None = None,
    time_scale: str = "local",
    first_time: float = 0.0,
) -> Track:
    """A track through places (n, 2 or 3) at times (n,), left out: one second apart."""
    points = np.asarray(place, dtype=float)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.full(len(points), np.nan)])
    clock = np.arange(len(points), dtype=float) if time is None else np.asarray(time, dtype=float)
    return Track(
        name=name, time=clock, place=points, speed=np.full(len(points), np.nan), time_scale=time_scale,
        frame="made by hand", start=start, first_time=first_time,
    )  # fmt: skip


def arc(radius: float, angle: FloatArray) -> FloatArray:
    """Places on a circle about (0, 0), (n, 2)."""
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def slalom(along: FloatArray) -> FloatArray:
    """A winding, falling line without any symmetry, (n, 3)."""
    return np.column_stack(
        [along, 5.0 * np.sin(along / 6.0) + 0.02 * along**1.5, -0.2 * along + 0.3 * np.cos(along / 9.0)]
    )


def turned(place: FloatArray, angle: float, move: Sequence[float]) -> FloatArray:
    """Places (n, 3) turned to the left by an angle (rad) about the first one, and moved."""
    sine, cosine = np.sin(angle), np.cos(angle)
    matrix = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    return (place - place[0]) @ matrix.T + place[0] + np.asarray(move, dtype=float)
