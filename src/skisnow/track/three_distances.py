"""Three ways to say how far a simulated track is from a measured one: nearest place, equal arc length, equal time."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from .apart import Apart
from .nearest_place import NearestPlaces, Path
from .polyline import Polyline, interpolated

FloatArray = npt.NDArray[np.float64]
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
