"""Gates of a course, passed or missed by a run or by a measured track."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._support.arrays import FloatArray
from ..scenario.scenario import course_on_slope
from ..track.course import Course, CourseResult, MovingPoint, passages
from ..track.course.passages import track_point
from ..track.track import Track

if TYPE_CHECKING:
    from .run import Run


def time_gates(course: Course, moving: Run | Track) -> CourseResult:
    """Say which gates were passed, and when.

    Parameters
    ----------
    course
        In the metres of the run or track. A course in degrees is laid on a run's slope by its
        `fall_line_azimuth_deg`; a track in degrees is compared with it from the course's origin.
    moving
        A run, of which both feet and both ski tips must cross a gate's line; or a track, which is one point: that it
        straddled a pole it cannot tell.

    Returns
    -------
    CourseResult
        For each gate passed, straddled, missed, backwards or not reached, with time, speed and distance from the pole.

    Raises
    ------
    ParameterError
        There are fewer than two places, a track is in degrees and the course in metres or the reverse, or nothing says
        where x of the run points.

    See Also
    --------
    skisnow.read_course
    skisnow.read_track

    Notes
    -----
    The time at a gate is that at which the middle between the boots, or the track's point, crosses the line through its
    poles, on a cubic through the stored points with their velocities.

    References
    ----------
    The page docs/files/course.md.
    """
    if isinstance(moving, Track):
        return passages(course, track_point(moving, course), {})
    course = course_on_slope(course, moving.scenario.slope)
    middle = MovingPoint(moving.time, moving.place[:, :2], moving.velocity[:, :2])
    return passages(course, middle, racer_parts(moving))


def racer_parts(run: Run) -> dict[str, MovingPoint]:
    """Both feet and both ski tips, from above."""
    side, tip = run.scenario.sledge.stance_width / 2.0, float(run.scenario.ski.station[0])
    if run.boots is not None:
        return feet_and_tips(run.time, run.boots.place, run.boots.place + tip * run.boots.axes[:, :, 0])
    beside = np.array([[0.0, side, 0.0], [0.0, -side, 0.0]])
    feet, tips = (run.place[:, None] + np.einsum("nab,kb->nka", run.attitude, offsets)
                  for offsets in (beside, beside + np.array([tip, 0.0, 0.0])))  # fmt: skip
    return feet_and_tips(run.time, feet, tips)


def feet_and_tips(time: FloatArray, feet: FloatArray, tips: FloatArray) -> dict[str, MovingPoint]:
    """Points that must cross the line of a gate, from the places (n, 2, 3) of feet and tips (m) at times (n,) (s)."""
    return {
        f"{name} {part}": MovingPoint(time, place[:, ski, :2])
        for part, place in (("foot", feet), ("tip", tips))
        for ski, name in enumerate(("left", "right"))
    }


def run_gates(run: Run) -> CourseResult | None:
    """Result at the gates of the scenario's course; None without a course, or if the run has a single moment."""
    course = run.scenario.course
    return None if course is None or len(run.time) < 2 else time_gates(course, run)


class GatesAhead:
    """Which gate of a course comes next, while a run goes on."""

    def __init__(self, course: Course | None) -> None:
        self._lines = () if course is None else course.lines
        self._next = 0

    def is_over(self, place: FloatArray, clear: float) -> bool:
        """Whether a racer at a place (m) has the last gate behind it, by more than `clear` (m)."""
        while self._next < len(self._lines):
            line = self._lines[self._next]
            if float((place[:2] - line.pole) @ line.along) <= clear:
                return False
            self._next += 1
        return bool(self._lines)
