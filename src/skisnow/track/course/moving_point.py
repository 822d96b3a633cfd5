"""A point that moves in a course's plane: from a measured track, and the times at which it crosses a line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.errors import ParameterError
from ..._support.messages import Message, template
from ..projection import GeodeticPoint
from ..track import Track
from .course import Course

FloatArray: TypeAlias = npt.NDArray[np.float64]

HALVINGS: Final = 60
"""Number of bisections of the interval between two points, for a time of a crossing accurate to rounding."""


@dataclass(frozen=True, slots=True)
class Crossing:
    """One crossing of a line.

    Attributes
    ----------
    time
        Time (s) on the points' clock.
    aside
        Position (m) along the line, from its origin.
    speed
        Speed (m/s) in the plane.
    forward
        True if it crosses in the given direction, False if against it.
    doubt
        Difference (s) from the time of a straight path between the two points, as the uncertainty.
    """

    time: float
    aside: float
    speed: float
    forward: bool
    doubt: float


class MovingPoint:
    """A point that moves in a plane: places at times, interpolated by cubics with its velocities.

    Parameters
    ----------
    time
        (n,), rising (s), n ≥ 2.
    place
        (n, 2) (m).
    velocity
        (n, 2) (m/s) (default: differences of second order, exact for a constant acceleration).
    """

    def __init__(self, time: FloatArray, place: FloatArray, velocity: FloatArray | None = None) -> None:
        self.time, self.place = np.asarray(time, float), np.asarray(place, float)
        if len(self.time) < 2 or not np.all(np.diff(self.time) > 0.0):
            raise ParameterError(
                Message("gates need two places or more at rising times; this track has fewer"), code="no_times"
            )
        order: Literal[1, 2] = 2 if len(self.time) > 2 else 1
        differences = np.gradient(self.place, self.time, axis=0, edge_order=order)
        self.velocity = differences if velocity is None else np.where(np.isfinite(velocity), velocity, differences)

    def crossings(self, origin: FloatArray, along: FloatArray, across: FloatArray) -> list[Crossing]:
        """Every crossing of the line through `origin` (2,) along `across`, in their order.

        `along` and `across` are unit vectors (2,), square to each other. A point on the line counts as beyond it.
        """
        beyond = (self.place - origin) @ along >= 0.0
        return [
            self._crossing(int(i), origin, along, across) for i in np.flatnonzero(np.diff(beyond.astype(np.int8)) != 0)
        ]

    def _crossing(self, i: int, origin: FloatArray, along: FloatArray, across: FloatArray) -> Crossing:
        step = float(self.time[i + 1] - self.time[i])
        first, last = (float((self.place[j] - origin) @ along) for j in (i, i + 1))
        rates = (step * float(self.velocity[j] @ along) for j in (i, i + 1))
        forward = last >= 0.0
        high = _reached(first, last, *rates)
        place, velocity = self._at(i, high)
        straight = first / (first - last)
        return Crossing(
            time=float(self.time[i]) + high * step,
            aside=float((place - origin) @ across),
            speed=float(np.linalg.norm(velocity)),
            forward=forward,
            doubt=abs(high - straight) * step,
        )

    def _at(self, i: int, f: float) -> tuple[FloatArray, FloatArray]:
        """Place and velocity at the share f of the interval i, by Hermite's cubic."""
        h, e = float(self.time[i + 1] - self.time[i]), 1.0 - f
        before, behind, v, w = self.place[i], self.place[i + 1], h * self.velocity[i], h * self.velocity[i + 1]
        place = e * e * (1.0 + 2.0 * f) * before + f * f * (3.0 - 2.0 * f) * behind + f * e * e * v - f * f * e * w
        rate = 6.0 * f * e * (behind - before) + e * (1.0 - 3.0 * f) * v + f * (3.0 * f - 2.0) * w
        return place, rate / h


def _reached(first: float, last: float, rate: float, last_rate: float) -> float:
    """Share of an interval at which Hermite's cubic from `first` to `last` changes its sign as they do."""
    low, high, forward = 0.0, 1.0, last >= 0.0
    for _ in range(HALVINGS):
        f = 0.5 * (low + high)
        e = 1.0 - f
        place = e * e * (1.0 + 2.0 * f) * first + f * f * (3.0 - 2.0 * f) * last + f * e * (e * rate - f * last_rate)
        low, high = (low, f) if (place >= 0.0) is forward else (f, high)
    return high


_OTHER_UNIT: Final = {
    True: template(
        "the track {name} is in degrees, the course {source} in metres. Give the course as the track is: GPX with "
        "waypoints, or CSV with x_m and y_m; or turn the track into the slope's frame first"
    ),
    False: template(
        "the track {name} is in metres, the course {source} in degrees. Give the course as the track is: GPX with "
        "waypoints, or CSV with x_m and y_m; or turn the track into the slope's frame first"
    ),
}


def track_point(track: Track, course: Course) -> MovingPoint:
    """Moving point of a track: its usable horizontal places at rising times, from the course's origin.

    Raises
    ------
    ParameterError
        The axes of the track differ from those of the course, or it has fewer than two usable places.
    """
    degrees = track.axes == "east_north_up"
    if degrees != (course.axes == "east_north_up"):
        raise ParameterError(
            Message(_OTHER_UNIT[degrees], name=track.name, source=course.source), code="different_units"
        )
    if course.latitude_deg is not None and course.longitude_deg is not None and degrees:
        track = track.at_origin(GeodeticPoint(course.latitude_deg, course.longitude_deg))
    good = track.usable & np.isfinite(track.place[:, :2]).all(axis=1)
    time, place = track.time[good], track.place[good, :2]
    rises = np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0.0]) if len(time) else np.zeros(0, bool)
    return MovingPoint(time[rises], place[rises])
