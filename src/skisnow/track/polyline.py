"""A track as places joined by straight pieces, with the arc length along them and the times at them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.errors import ParameterError
from .track import Track

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Polyline(ShownFields):
    """Straight pieces in the order of time.

    Attributes
    ----------
    place : (n, d) m
        d = 2 from above, or 3.
    time : (n,) s
        At the places.
    arc_length : (n,) m
        Length of the pieces up to each place.
    """

    place: FloatArray
    time: FloatArray
    arc_length: FloatArray

    @property
    def length(self) -> float:
        """Of all pieces (m)."""
        return float(self.arc_length[-1])

    def at_arc_length(self, arc_length: FloatArray) -> FloatArray:
        """Places (k, d) at ways (k,) (m)."""
        return interpolated(arc_length, self.arc_length, self.place)

    def at_time(self, time: FloatArray) -> FloatArray:
        """Places (k, d) at times (k,) (s)."""
        return interpolated(time, self.time, self.place)


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


def interpolated(at: FloatArray, known: FloatArray, values: FloatArray) -> FloatArray:
    """Each column of values (n, d) over known (n,), which does not fall, linearly at (k,); (k, d)."""
    return np.stack([np.interp(at, known, column) for column in values.T], axis=1)


def compared_points(track: Track, *, dimensions: int) -> npt.NDArray[np.bool_]:
    """Which points are usable and have all their coordinates, (n,)."""
    return track.usable & np.isfinite(track.place[:, :dimensions]).all(axis=1)


def polyline_of(track: Track, *, dimensions: int) -> Polyline:
    """The usable points of a track, joined.

    Raises
    ------
    ParameterError
        Fewer than two such points, or all in one place.
    """
    known = compared_points(track, dimensions=dimensions)
    line = polyline(track.place[known][:, :dimensions], track.time[known])
    if not line.length > 0.0:
        raise ParameterError(
            f"{track.name}: {int(known.sum())} of its {len(track)} points can be used, all in one place. A comparison "
            "needs two points in different places; give a longer track"
        )
    return line
