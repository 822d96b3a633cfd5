"""Tracks: places at times, with accuracies and quality flags; the rules of the flags."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from types import MappingProxyType
from typing import Final, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.errors import ParameterError
from .._support.messages import Message, template
from .._support.units import Facts, Shown, amount, ends
from .projection import GeodeticPoint, place_from_origin

Axes: TypeAlias = Literal["file", "east_north_up", "slope"]


@dataclass(frozen=True, eq=False, repr=False)
class Track(Shown):
    """Points in the order of their file; doubtful points stay and are flagged.

    Attributes
    ----------
    name
        Name for messages and figures (default: the name of the file).
    time : (n,) s
        Time from the first point, on the time scale of the file.
    place : (n, 3) m
        Places in the track's frame; NaN for a missing height or place.
    speed : (n,) m/s
        Recorded speed; NaN if missing.
    velocity : (n, 3) m/s or None
        Recorded velocity in the track's frame; NaN if missing (a course over ground has no vertical component).
    place_sd : (n, 3) m or None
        Standard deviation of each coordinate stated by the receiver; NaN if missing.
    speed_sd : (n,) m/s or None
        Standard deviation of the speed stated by the receiver.
    solution : (n,) of "fixed", "float", "code", "", or None
        Kind of solution of each place, see `skisnow.track.track`; None if unknown.
    odometer : (n,) m or None
        Distance recorded by the device.
    start : datetime or None
        Date and time of the first point, with the zone of the file; None without a date.
    time_scale
        ``"UTC"``, ``"GPS"``, ``"JST"``, ``"local"`` (of the file, without a date or zone).
    frame
        Description of the axes: those of a slope, or the local projection with its origin.
    flags
        Code of each quality flag to (n,) bool: True for flagged points.
    axes
        Meaning of x, y and z: ``"file"`` (local metres of the file), ``"east_north_up"``, or ``"slope"``.
    slope_angle : rad or None
        Inclination of the plane of x and y, if the axes are those of a slope; 0 if z is vertical; None if unknown.
    origin
        Origin of the axes on the ellipsoid; None for local metres.
    first_time : s
        Time of the first point in the file if its times are in seconds, otherwise 0.
    speed_kind
        Description of the speed: along the path, over the ground, or unknown.
    further_columns
        Columns of the file that were not read, by name.
    left_out
        Kind of record to number: records that are not used, such as sentences with a wrong checksum and points before
        the first fix.
    notes
        Sentences on how the file was read.

    See Also
    --------
    skisnow.read_track
    skisnow.track_summary
    """

    name: str
    time: FloatArray
    place: FloatArray
    speed: FloatArray
    time_scale: str
    frame: str = Message("x, y, z of the file, in m")
    velocity: FloatArray | None = None
    place_sd: FloatArray | None = None
    speed_sd: FloatArray | None = None
    solution: SolutionArray | None = None
    odometer: FloatArray | None = None
    start: datetime | None = None
    flags: Mapping[str, BoolArray] = field(default_factory=dict)
    axes: Axes = "file"
    slope_angle: float | None = None
    origin: GeodeticPoint | None = None
    first_time: float = 0.0
    speed_kind: str = "as recorded"
    further_columns: tuple[str, ...] = ()
    left_out: Mapping[Message, int] = field(default_factory=dict)
    notes: tuple[Message, ...] = ()

    def __len__(self) -> int:
        return len(self.time)

    def _repr_facts(self) -> Facts:
        """Title, and rows with points, flags, ranges of places and speeds, start and frame."""
        flagged = ", ".join(f"{count} {code}" for code, count in self.flagged.items())
        duration = float(self.time[-1] - self.time[0]) if len(self.time) else 0.0
        rows = (
            ("points", f"{len(self)} in {amount(duration, 's')}{f', flagged: {flagged}' if flagged else ''}"),
            *((f"{axis}", ends(self.place[:, k], "m")) for k, axis in enumerate("xyz")),
            ("speed", f"{ends(self.speed, 'm/s')} ({self.speed_kind})"),
            ("start", "no date" if self.start is None else f"{self.start} ({self.time_scale})"),
            ("frame", self.frame),
        )
        return Facts(repr(self.name), rows)

    @property
    def flagged(self) -> dict[str, int]:
        """Number of flagged points by flag; flags without points are omitted."""
        return {code: int(np.sum(where)) for code, where in self.flags.items() if np.any(where)}

    def at_origin(self, origin: GeodeticPoint) -> Track:
        """The same track in east, north, up from another origin.

        Velocities and standard deviations stay: the axes of two origins 1 km apart differ by 0.009°.

        Raises ParameterError: the track is in local metres, and its position on the ellipsoid is unknown.
        """
        if self.axes != "east_north_up" or self.origin is None:
            raise ParameterError(
                "the track {name} is in local metres ({frame}), not in east, north and up from an origin. Read it "
                "from a file with latitude and longitude."
            ).tag("no_origin", name=self.name, frame=self.frame)
        frame = self.frame.replace(str(self.origin), str(origin))
        return replace(self, place=place_from_origin(self.place, self.origin, origin), origin=origin, frame=frame)

    @property
    def usable(self) -> BoolArray:
        """(n,) bool: points with a horizontal place and without a flag that excludes."""
        usable = np.asarray(np.isfinite(self.place[:, :2]).all(axis=1))
        for code, where in self.flags.items():
            if code in FLAGS and FLAGS[code].excludes:
                usable &= ~where
        return usable


FASTEST: Final = 75.0
"""Speed (m/s) above which a step is impossible: the fastest run ever skied had 71 m/s (modelling assumption)."""
GAP_FACTOR: Final = 5.0
"""Shortest gap, in median intervals between points."""

_CONTINUED: Final = 1.5
"""Longest pause, in median intervals, after which a segment continues the one before."""


@dataclass(frozen=True, slots=True)
class PointFlag:
    """A quality flag: its code, the sentence that explains it, and True if `Track.usable` excludes the point."""

    code: str
    sentence: str
    excludes: bool


_ALL: Final = (
    PointFlag("no_fix", "The receiver had no fix, or the file has no place for this point.", True),
    PointFlag("missing_height", "The point has a place but no height.", False),
    PointFlag("repeated_time", "The point has the same time stamp as the one before it.", True),
    PointFlag(
        "rounded_time", "The file's time stamps are coarser than its points: spread over the time of each stamp.", False
    ),
    PointFlag("not_finite", "A cell of the point is nan, inf or the like: it counts as blank.", False),
    PointFlag("new_segment", "The file begins a new segment here: nothing is computed across.", False),
    PointFlag("gap", "The time since the point before is much longer than the usual interval.", False),
    PointFlag("jump", "A single point far off: the speed out to it and back again is impossible.", True),
    PointFlag("impossible_step", "The speed to this point is impossible, and no single point explains it.", False),
    PointFlag("negative_speed", "The speed is below zero, as devices write that have none; it counts as none.", False),
    PointFlag(
        "float_solution", "By the carrier's phase, but not fixed to whole cycles: decimetres that wander.", False
    ),
    PointFlag("code_solution", "Only by the code, in a track that has the carrier's phase elsewhere: metres.", False),
)
FLAGS: Final[Mapping[str, PointFlag]] = MappingProxyType({flag.code: flag for flag in _ALL})
"""Every flag by its code, in the order in which they are listed."""


def point_flags(
    time: FloatArray,
    place: FloatArray,
    fix: BoolArray,
    negative_speed: BoolArray,
    *,
    solution: SolutionArray | None = None,
    segment: IntArray | None = None,
    rounded: BoolArray | None = None,
    not_finite: BoolArray | None = None,
) -> dict[str, BoolArray]:
    """Flags of every code, each (n,) bool.

    time: (n,) s, times that never fall.
    place: (n, 3) m, places; NaN if missing.
    fix: (n,) bool, True if the receiver had a fix.
    negative_speed: (n,) bool, True if the recorded speed was below zero.
    solution: (n,) or None, kind of solution of each place, as in `Track`. Code solutions are flagged only if other
        points of the track are phase solutions.
    segment: (n,) or None, number of the segment of each point. A segment that continues the one before, at most 1.5
        usual intervals later and at a possible speed, is not flagged: some programs begin a segment for each lap.
    rounded, not_finite: (n,) bool or None, points whose time stamp was rounded, and points with a cell that is not a
        finite number.
    """
    flags = {code: np.zeros(len(time), bool) for code in FLAGS}
    placed = fix & np.isfinite(place[:, :2]).all(axis=1)
    flags["no_fix"] = ~placed
    flags["missing_height"] = placed & np.isnan(place[:, 2])
    flags["negative_speed"] = negative_speed
    if rounded is not None:
        flags["rounded_time"] = rounded
    if not_finite is not None:
        flags["not_finite"] = not_finite
    steps = np.diff(time)
    flags["repeated_time"][1:] = steps == 0.0
    if np.any(steps > 0.0):
        flags["gap"][1:] = steps > GAP_FACTOR * np.median(steps[steps > 0.0])
    sure = np.flatnonzero(placed & ~flags["repeated_time"])
    flags["jump"][sure], flags["impossible_step"][sure] = _impossible_points(time[sure], place[sure, :2])
    flags["new_segment"] = apart = _segment_starts(time, place, sure, segment)
    for code in ("gap", "jump", "impossible_step"):
        flags[code] &= ~apart
    if solution is not None:
        flags["float_solution"] |= solution == "float"
        flags["code_solution"] |= (solution == "code") & _has_carrier_phase(solution)
    return flags


def _segment_starts(time: FloatArray, place: FloatArray, sure: IntArray, segment: IntArray | None) -> BoolArray:
    """First points (n,) bool of segments that do not continue the one before."""
    apart = np.zeros(len(time), bool)
    if segment is None or len(sure) < 2:
        return apart
    steps = np.diff(time[sure])
    lengths = np.hypot(*np.diff(place[sure, :2], axis=0).T)
    continued = (steps <= _CONTINUED * np.median(steps)) & (lengths <= FASTEST * steps)
    apart[sure[1:][(np.diff(segment[sure]) != 0) & ~continued]] = True
    return apart


def _impossible_points(time: FloatArray, place: FloatArray) -> tuple[BoolArray, BoolArray]:
    """True (n,) for points that jump out and back, and for the other points reached at an impossible speed."""
    lengths = np.hypot(*np.diff(place, axis=0).T)
    fast = lengths > FASTEST * np.diff(time)
    last = len(time) - 1
    jumps = _jumps(time, place, lengths)
    if last > 1 and fast[0] and not fast[1] and 1 not in jumps:
        jumps.insert(0, 0)  # the first point alone is far from all that follow
    if last > 1 and fast[-1] and last - 1 not in jumps:
        jumps.append(last)
    jump = np.isin(np.arange(len(time)), jumps)
    step = np.zeros(len(time), bool)
    step[1:] = fast & ~jump[1:] & ~jump[:-1]
    return jump, step


def _jumps(time: FloatArray, place: FloatArray, lengths: FloatArray) -> list[int]:
    """Indices of inner points with an impossible path through them and a possible, less than half as long one past."""
    over = lengths[:-1] + lengths[1:]
    past = np.hypot(*(place[2:] - place[:-2]).T)
    most = FASTEST * (time[2:] - time[:-2])
    jumps: list[int] = []
    for point in (np.flatnonzero((over > most) & (past <= most) & (past < 0.5 * over)) + 1).tolist():
        if not jumps or jumps[-1] != point - 1:  # a good point between two jumps looks like one
            jumps.append(point)
    return jumps


Solution: TypeAlias = Literal["", "fixed", "float", "code"]
"""Kind of solution of a point; empty if unknown, or without a fix."""
SOLUTIONS: Final[tuple[Solution, ...]] = get_args(Solution)[1:]
"""Kinds of solutions, the most accurate first."""
SolutionArray: TypeAlias = npt.NDArray[np.str_]


def solution_array(solutions: Sequence[Solution]) -> SolutionArray | None:
    """Kinds of solutions of all points (n,); None if all are unknown.

    >>> solution_array(["fixed", ""]), solution_array(["", ""])
    (array(['fixed', ''], dtype='<U5'), None)
    """
    return np.array(solutions, dtype="<U5") if any(solutions) else None


def solution_counts(solution: SolutionArray | None) -> dict[str, int] | None:
    """Number of points by kind of solution; None if all are unknown or code solutions.

    >>> solution_counts(np.array(["fixed", "float", "fixed"]))
    {'fixed': 2, 'float': 1}
    """
    if solution is None or not _has_carrier_phase(solution):
        return None
    counts = {name: int(np.sum(solution == name)) for name in SOLUTIONS}
    return {name: count for name, count in counts.items() if count}


_INEXACT: Final = {
    (True, True): template(
        "{name}: of {points} points {floating} float (decimetres off) and {code} by the code alone (metres off); the "
        "others are fixed"
    ),
    (True, False): template("{name}: of {points} points {floating} float (decimetres off); the others are fixed"),
    (False, True): template("{name}: of {points} points {code} by the code alone (metres off); the others are fixed"),
}
"""Warning of float solutions, of code solutions, or of both."""


def inexact_sentence(name: str, solution: SolutionArray | None) -> Message | None:
    """Warning if only some points of a track are fixed solutions, otherwise None.

    >>> inexact_sentence("a.ubx", np.array(["fixed", "float", "code", "fixed"]))
    'a.ubx: of 4 points 1 float (decimetres off) and 1 by the code alone (metres off); the others are fixed'
    """
    counts = solution_counts(solution) or {}
    floating, code = counts.get("float", 0), counts.get("code", 0)
    if not (floating or code) or not counts.get("fixed"):
        return None
    sentence = _INEXACT[floating > 0, code > 0]
    return Message(sentence, name=name, points=sum(counts.values()), floating=floating, code=code)


def _has_carrier_phase(solution: SolutionArray) -> bool:
    """True if any point has a fixed or float solution."""
    return bool(np.isin(solution, ("fixed", "float")).any())
