"""A measured track as a point that moves in a course's plane."""

from __future__ import annotations

import numpy as np

from ..._support.errors import ParameterError
from ..projection import GeodeticPoint
from ..track import Track
from .course import Course
from .crossings import MovingPoint


def track_point(track: Track, course: Course) -> MovingPoint:
    """Its usable places from above, at rising times, from the course's origin.

    Raises
    ------
    ParameterError
        It is in other axes than the course, or has fewer than two usable places.
    """
    degrees = track.axes == "east_north_up"
    if degrees != (course.axes == "east_north_up"):
        own, other = ("degrees", "metres") if degrees else ("metres", "degrees")
        raise ParameterError(
            f"the track {track.name} is in {own}, the course {course.source} in {other}. Give the course as the track "
            "is: GPX with waypoints, or CSV with x_m and y_m; or turn the track into the slope's frame first"
        )
    if course.latitude_deg is not None and course.longitude_deg is not None and degrees:
        track = track.at_origin(GeodeticPoint(course.latitude_deg, course.longitude_deg))
    good = track.usable & np.isfinite(track.place[:, :2]).all(axis=1)
    time, place = track.time[good], track.place[good, :2]
    rises = np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0.0]) if len(time) else np.zeros(0, bool)
    return MovingPoint(time[rises], place[rises])
