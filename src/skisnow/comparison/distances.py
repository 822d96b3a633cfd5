"""Offsets between two tracks by nearest place, at equal arc length and at equal time, and their statistics."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.errors import ParameterError
from .._support.units import ShownFields
from ..track.track import Track
from .nearest_place import Path

_SMOOTH: Final = 0.05
"""Below this change of the offset, in parts of its length, three Gauss points are exact to rounding."""
_GAUSS_AT: Final = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])
_GAUSS_WEIGHT: Final = np.array([5.0, 8.0, 5.0]) / 18.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OffsetSeries(ShownFields):
    """Offsets at places along the measured track; between two of them the offset changes linearly.

    arc_length: (k,) m, length of the measured track up to the place, not falling.
    offset: (k, d) m, from the measured to the simulated track; NaN if missing.
    """

    arc_length: FloatArray
    offset: FloatArray

    @property
    def distance(self) -> FloatArray:
        """Length of the offsets, (k,) (m); NaN if missing."""
        return np.linalg.norm(self.offset, axis=1)


@dataclass(frozen=True, slots=True)
class DistanceStatistics:
    """Statistics (m) of distances along a track: largest, its arc length, mean, rms, and compared arc length."""

    max: float
    max_at: float
    mean: float
    rms: float
    compared: float


def distance_statistics(apart: OffsetSeries) -> DistanceStatistics | None:
    """Largest, mean and rms distance; the means are integrals over the arc length.

    They are exact for offsets that change linearly: ∫|δ| ds and ∫|δ|² ds, piece by piece, divided by the arc length.
    None if nothing was compared.
    """
    distance = apart.distance
    whole = np.isfinite(distance[:-1]) & np.isfinite(distance[1:])
    weight = np.where(whole, np.diff(apart.arc_length), 0.0)
    compared = float(weight.sum())
    if not compared > 0.0:
        return None
    first, last, weight = apart.offset[:-1][whole], apart.offset[1:][whole], weight[whole]
    square = ((first**2).sum(axis=1) + (first * last).sum(axis=1) + (last**2).sum(axis=1)) / 3.0
    largest = int(np.nanargmax(distance))
    return DistanceStatistics(
        max=float(distance[largest]),
        max_at=float(apart.arc_length[largest]),
        mean=float(weight @ mean_lengths(first, last)) / compared,
        rms=float(np.sqrt(weight @ square / compared)),
        compared=compared,
    )


def mean_lengths(first: FloatArray, last: FloatArray) -> FloatArray:
    """Mean length (n,) of vectors that change linearly from the first (n, d) to the last (n, d).

    With w the change, x = δ·w/|w| and h the part of δ across w: ∫ √(x² + h²) dx / |w| in closed form.

    >>> mean_lengths(np.array([[0.0, 0.0], [-1.0, 0.0]]), np.array([[3.0, 4.0], [1.0, 0.0]]))
    array([2.5, 0.5])
    """
    change = last - first
    size = np.linalg.norm(change, axis=1)
    longest = np.maximum(np.linalg.norm(first, axis=1), np.linalg.norm(last, axis=1))
    between = first[:, None, :] + _GAUSS_AT[:, None] * change[:, None, :]
    mean = np.linalg.norm(between, axis=2) @ _GAUSS_WEIGHT
    rough = size > _SMOOTH * longest
    direction = change[rough] / size[rough, None]
    begins = (first[rough] * direction).sum(axis=1)
    across = np.linalg.norm(first[rough] - begins[:, None] * direction, axis=1)
    mean[rough] = (_area(begins + size[rough], across) - _area(begins, across)) / size[rough]
    return mean


def _area(x: FloatArray, h: FloatArray) -> FloatArray:
    """∫ √(x² + h²) dx from 0."""
    safe = np.where(h > 0.0, h, 1.0)
    return 0.5 * (x * np.hypot(x, h) + np.where(h > 0.0, h**2 * np.arcsinh(x / safe), 0.0))


FEWEST_PIECES: Final = 2048
"""Minimum number of equal pieces of the measured track for which nearest places are computed."""
EXACTNESS: Final = 1e-7
"""Accuracy of the distance between two computed places, relative to the measured track's length."""
_END: Final = 1e-9
"""Accuracy of the place at which the simulated track ends, relative to the measured track's length."""
_ROUNDS: Final = 32
_MOST_PLACES: Final = 4_000_000


def nearest_offsets(simulated: Path, measured: Polyline) -> OffsetSeries:
    """Offsets from places of the measured track to the nearest places of the simulated one.

    Places are the points of the measured track and equal steps between them. Where the nearest place changes from one
    piece of the simulated track to another, steps are halved until the distance is linear within `EXACTNESS`. Places
    beyond an end of the simulated track have no offset.
    """
    arc_length = np.unique(np.concatenate([measured.arc_length, np.linspace(0.0, measured.length, FEWEST_PIECES + 1)]))
    at = measured.at_arc_length(arc_length)
    nearest = simulated.nearest(at)
    offset, beyond, where = nearest.foot - at, nearest.beyond, nearest.where
    open_ = np.flatnonzero((where[1:] != where[:-1]) | (beyond[1:] != beyond[:-1]))
    for _ in range(_ROUNDS):
        if not open_.size or len(arc_length) > _MOST_PLACES:
            break
        middle = 0.5 * (arc_length[open_] + arc_length[open_ + 1])
        at = measured.at_arc_length(middle)
        nearest = simulated.nearest(at)
        linear = 0.5 * np.linalg.norm(offset[open_] + offset[open_ + 1], axis=1)
        bent = np.abs(nearest.distance - linear) > EXACTNESS * measured.length
        ends = (beyond[open_] != nearest.beyond) | (beyond[open_ + 1] != nearest.beyond)
        split = bent & ~(beyond[open_] & beyond[open_ + 1] & nearest.beyond)
        split = (split | ends) & (arc_length[open_ + 1] - arc_length[open_] > _END * measured.length)
        arc_length, offset = (
            np.insert(arc_length, open_ + 1, middle),
            np.insert(offset, open_ + 1, nearest.foot - at, axis=0),
        )
        beyond = np.insert(beyond, open_ + 1, nearest.beyond)
        left = (open_ + np.arange(len(open_)))[split]
        open_ = np.sort(np.concatenate([left, left + 1]))
    return OffsetSeries(arc_length, np.where(beyond[:, None], np.nan, offset))


def arc_length_offsets(simulated: Polyline, measured: Polyline) -> OffsetSeries:
    """Offsets at the points of both tracks between places after equal arc length, up to the end of the shorter."""
    end = min(simulated.length, measured.length)
    arc_length = np.unique(np.concatenate([simulated.arc_length, measured.arc_length, [end]]))
    arc_length = arc_length[arc_length <= end]
    return OffsetSeries(arc_length, simulated.at_arc_length(arc_length) - measured.at_arc_length(arc_length))


def time_offsets(simulated: Polyline, measured: Polyline, *, later: float = 0.0) -> OffsetSeries | None:
    """Offsets between places at the same time, at the times of both tracks, while both are on their way.

    simulated, measured: tracks with times that do not fall.
    later: time of the simulated track minus that of the measured one (s).
    Returns: None if their times do not overlap.
    """
    clock = simulated.time - later
    begin, end = max(clock[0], measured.time[0]), min(clock[-1], measured.time[-1])
    if end < begin:
        return None
    own = (measured.time >= begin) & (measured.time <= end)
    other = np.concatenate([clock[(clock > begin) & (clock < end)], [begin, end]])
    time = np.concatenate([measured.time[own], other])
    arc_length = np.concatenate([measured.arc_length[own], np.interp(other, measured.time, measured.arc_length)])
    place = np.concatenate([measured.place[own], measured.at_time(other)])
    order = np.lexsort((arc_length, time))  # several points at one time stay in their order
    return OffsetSeries(arc_length[order], interpolate(time, clock, simulated.place)[order] - place[order])


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Polyline(ShownFields):
    """Straight pieces in the order of time.

    place: (n, d) m, places; d = 2 from above, or 3.
    time: (n,) s, times of the places.
    arc_length: (n,) m, length of the pieces up to each place.
    """

    place: FloatArray
    time: FloatArray
    arc_length: FloatArray

    @property
    def length(self) -> float:
        """Length of all pieces (m)."""
        return float(self.arc_length[-1])

    def at_arc_length(self, arc_length: FloatArray) -> FloatArray:
        """Places (k, d) at arc lengths (k,) (m)."""
        return interpolate(arc_length, self.arc_length, self.place)

    def at_time(self, time: FloatArray) -> FloatArray:
        """Places (k, d) at times (k,) (s)."""
        return interpolate(time, self.time, self.place)


def polyline(place: FloatArray, time: FloatArray) -> Polyline:
    """Join places (n, d) by straight pieces."""
    return Polyline(place, time, arc_lengths(place))


def arc_lengths(place: FloatArray) -> FloatArray:
    """Length (n,) of the straight pieces through places (n, d) up to each of them (m).

    >>> arc_lengths(np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]]))
    array([0., 5., 6.])
    """
    steps = np.linalg.norm(np.diff(place, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def interpolate(at: FloatArray, abscissa: FloatArray, values: FloatArray) -> FloatArray:
    """Linear interpolation (k, d) of the columns of values (n, d) over a rising abscissa (n,) at (k,)."""
    return np.stack([np.interp(at, abscissa, column) for column in values.T], axis=1)


def compared_points(track: Track, *, dimensions: int) -> BoolArray:
    """True (n,) for points that are usable and have all coordinates."""
    return track.usable & np.isfinite(track.place[:, :dimensions]).all(axis=1)


def track_polyline(track: Track, *, dimensions: int) -> Polyline:
    """The usable points of a track, joined."""
    points = compared_points(track, dimensions=dimensions)
    line = polyline(track.place[points][:, :dimensions], track.time[points])
    if not line.length > 0.0:
        raise ParameterError(
            "{name}: {usable} of its {count} points can be used, all in one place. A comparison needs "
            "two points in different places; give a longer track"
        ).tag("one_place", name=track.name, usable=int(points.sum()), count=len(track))
    return line
