"""Distances between two tracks: nearest place, equal arc length, equal time; their largest, mean and rms length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .nearest_place import NearestPlaces, Path
from .polyline import Polyline, interpolated

FloatArray = npt.NDArray[np.float64]

_SMOOTH: Final = 0.05
"""Below this change of the offset, in parts of its length, three Gauss points are exact to rounding."""
_GAUSS_AT: Final = 0.5 + np.sqrt(0.15) * np.array([-1.0, 0.0, 1.0])
_GAUSS_WEIGHT: Final = np.array([5.0, 8.0, 5.0]) / 18.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Apart(ShownFields):
    """Offsets at places along the measured track; between two of them the offset changes linearly.

    Attributes
    ----------
    arc_length : (k,) m
        Length of the measured track up to the place, not falling.
    offset : (k, d) m
        From the measured to the simulated track; NaN where there is none.
    """

    arc_length: FloatArray
    offset: FloatArray

    @property
    def distance(self) -> FloatArray:
        """Length of the offsets, (k,) (m); NaN where there is none."""
        return np.linalg.norm(self.offset, axis=1)


@dataclass(frozen=True, slots=True)
class Numbers:
    """Of distances along a track: the largest, where it is (arc length), mean and rms, over what arc length (m)."""

    max: float
    max_at: float
    mean: float
    rms: float
    compared: float


def numbers_of(apart: Apart) -> Numbers | None:
    """Largest, mean and rms distance; the means are integrals over the arc length.

    They are exact for offsets that change linearly:     ∫|δ| ds and ∫|δ|² ds, piece by piece, divided by the arc
    length. None where nothing was compared.
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
    return Numbers(
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
    mean[rough] = _closed_form(first[rough], change[rough] / size[rough, None], size[rough])
    return mean


def _closed_form(first: FloatArray, direction: FloatArray, size: FloatArray) -> FloatArray:
    begins = (first * direction).sum(axis=1)
    across = np.linalg.norm(first - begins[:, None] * direction, axis=1)
    return (_area(begins + size, across) - _area(begins, across)) / size


def _area(x: FloatArray, h: FloatArray) -> FloatArray:
    """∫ √(x² + h²) dx from 0."""
    safe = np.where(h > 0.0, h, 1.0)
    return 0.5 * (x * np.hypot(x, h) + np.where(h > 0.0, h**2 * np.arcsinh(x / safe), 0.0))


BoolArray = npt.NDArray[np.bool_]

FEWEST_PIECES: Final = 2048
"""Into which the measured track is cut at least, in equal lengths, before the nearest places are asked for."""
EXACTNESS: Final = 1e-7
"""Of the distance between two asked places, in parts of the measured track's length."""
_END: Final = 1e-9
"""Where the simulated track's end is passed, in the same parts."""
_ROUNDS: Final = 32
_MOST_PLACES: Final = 4_000_000


def nearest_apart(simulated: Path, measured: Polyline) -> Apart:
    """Offsets from places of the measured track to the nearest places of the simulated one.

    Places are the measured track's own points, places in equal steps between them, and more of them where the nearest
    place passes from one piece of the simulated track to another, halved until the distance there is linear within
    `EXACTNESS`. What is beyond an end of the simulated track has no offset.
    """
    arc_length = np.unique(np.concatenate([measured.arc_length, np.linspace(0.0, measured.length, FEWEST_PIECES + 1)]))
    at = measured.at_arc_length(arc_length)
    found = simulated.nearest(at)
    offset, beyond, where = found.foot - at, found.beyond, found.where
    open_ = np.flatnonzero((where[1:] != where[:-1]) | (beyond[1:] != beyond[:-1]))
    for _ in range(_ROUNDS):
        if not open_.size or len(arc_length) > _MOST_PLACES:
            break
        middle = 0.5 * (arc_length[open_] + arc_length[open_ + 1])
        at = measured.at_arc_length(middle)
        found = simulated.nearest(at)
        bent = _bent(offset, open_, found, at) > EXACTNESS * measured.length
        ends = (beyond[open_] != found.beyond) | (beyond[open_ + 1] != found.beyond)
        split = bent & ~(beyond[open_] & beyond[open_ + 1] & found.beyond)
        split = (split | ends) & (arc_length[open_ + 1] - arc_length[open_] > _END * measured.length)
        arc_length, offset = (
            np.insert(arc_length, open_ + 1, middle),
            np.insert(offset, open_ + 1, found.foot - at, axis=0),
        )
        beyond = np.insert(beyond, open_ + 1, found.beyond)
        left = (open_ + np.arange(len(open_)))[split]
        open_ = np.sort(np.concatenate([left, left + 1]))
    return Apart(arc_length, np.where(beyond[:, None], np.nan, offset))


def _bent(offset: FloatArray, first: npt.NDArray[np.intp], found: NearestPlaces, at: FloatArray) -> FloatArray:
    """How far the distance in the middle is from that of an offset that changes linearly (m)."""
    straight = 0.5 * np.linalg.norm(offset[first] + offset[first + 1], axis=1)
    return np.abs(np.linalg.norm(found.foot - at, axis=1) - straight)


def arc_length_apart(simulated: Polyline, measured: Polyline) -> Apart:
    """Offsets between places after the same arc length from the first points, up to the shorter track's length.

    At the points of both tracks, so that nothing is left out between them.
    """
    end = min(simulated.length, measured.length)
    arc_length = np.unique(np.concatenate([simulated.arc_length, measured.arc_length, [end]]))
    arc_length = arc_length[arc_length <= end]
    return Apart(arc_length, simulated.at_arc_length(arc_length) - measured.at_arc_length(arc_length))


def time_apart(simulated: Polyline, measured: Polyline, *, later: float = 0.0) -> Apart | None:
    """Offsets between places at the same time, at the times of both tracks, while both are on their way.

    Parameters
    ----------
    simulated, measured
        With times that do not fall.
    later
        The simulated track's time is the measured one's and this (s).

    Returns
    -------
    Apart or None
        None where they have no moment in common.
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
    return Apart(arc_length[order], interpolated(time, clock, simulated.place)[order] - place[order])
