"""Gates passed or missed, and the times, of a point that moves in a course's plane."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.messages import Message, template
from ..._support.units import Facts, Shown, ShownFields, amount
from ..projection import GeodeticPoint
from ..track import Track
from .course import Course, Gate, GateLine

GateOutcome: TypeAlias = Literal["passed", "straddled", "missed", "backwards", "not_reached"]

FARTHEST: Final = 50.0
"""Largest distance (m) from the turning pole at which a crossing of the gate's line counts."""
CLIMB_BACK: Final = 120.0
"""Longest time (s) after a missed gate within which it can still be passed (modelling assumption)."""
BESIDE: Final = 2.0
"""Time (s) between the crossings of the parts of one racer."""
STRADDLED: Final = template("The turning pole of gate {gate} was straddled: it passed between the skis.")
STRADDLED_OUTER: Final = template("The outer pole of gate {gate} was straddled: it passed between the skis.")
TO_THE_RIGHT: Final = template("Gate {gate} was missed: {distance:.2f} m to the right of its turning pole.")
TO_THE_LEFT: Final = template("Gate {gate} was missed: {distance:.2f} m to the left of its turning pole.")
BEYOND: Final = template("Gate {gate} was missed: {distance:.2f} m beyond its outer pole.")


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Passage(ShownFields):
    """Outcome of one gate.

    gate: The gate.
    outcome: "passed": feet and ski tips crossed the gate's line between the poles; "straddled": with a pole between
        them; "missed": outside the poles; "backwards": against the course only; "not_reached".
    words: The outcome as a sentence.
    time: Time (s), on the track's clock, at which the middle crossed the line; None if it did not.
    speed: Horizontal speed (m/s) at that time.
    clearance: Smallest distance (m) of a foot or tip from a pole on the line; below 0 outside of the gate.
    doubt: Uncertainty (s) of the time due to the unknown path between points.
    """

    gate: Gate
    outcome: GateOutcome
    words: Message
    time: float | None = None
    speed: float | None = None
    clearance: float | None = None
    doubt: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True, repr=False, eq=False)
class CourseResult(Shown):
    """A course and the outcome of each gate.

    Attributes
    ----------
    course
        The course.
    passages
        One for each gate, in their order.
    start_time
        Time (s) of the track's first point, from which times are counted.

    See Also
    --------
    skisnow.time_gates
    """

    course: Course
    passages: tuple[Passage, ...]
    start_time: float = 0.0

    @property
    def passed(self) -> int:
        """Number of gates that were passed."""
        return sum(passage.outcome == "passed" for passage in self.passages)

    @property
    def missed(self) -> tuple[str, ...]:
        """Names of the gates that were not passed."""
        return tuple(passage.gate.name for passage in self.passages if passage.outcome != "passed")

    @property
    def times(self) -> tuple[float | None, ...]:
        """Time at each gate (s), None where its line was not crossed."""
        return tuple(passage.time for passage in self.passages)

    @property
    def fault(self) -> Passage | None:
        """First gate that was not passed; None if all were passed."""
        return next((passage for passage in self.passages if passage.outcome != "passed"), None)

    def _repr_facts(self) -> Facts:
        """Title with the number of gates passed; rows with the course, the time between gates, and the first fault."""
        first, last = self.passages[0].time, self.passages[-1].time
        rows = [("course", repr(self.course).strip("<>"))]
        if first is not None and last is not None:
            rows.append(("first to last gate", amount(last - first, "s")))
        if self.fault is not None:
            rows.append(("first fault", self.fault.words))
        return Facts(f"{self.passed} of {len(self.passages)} gates passed", tuple(rows))


def passages(course: Course, middle: MovingPoint, parts: Mapping[str, MovingPoint]) -> CourseResult:
    """Determine the outcome of each gate.

    course: Course in the coordinates of the points.
    middle: Point whose crossing is the time at a gate.
    parts: Points that must cross the line between the poles, by name: both feet and both ski tips (FIS ICR 661.4.1).
        Empty: only the middle must cross it.

    Notes
    -----
    Gates are passed in their order. After a crossing outside of its poles a gate can still be passed within two minutes
    by climbing back (661.4.1). The line ends at the poles (661.4.1.1, 661.4.1.2); without an outer pole it is
    unlimited, as in a slalom with single poles (804.3). A crossing against the course does not count.
    """
    results: list[Passage] = []
    after = float("-inf")
    for gate, line in zip(course.gates, course.lines, strict=True):
        passage = _find_passage(gate, line, after, middle, parts or {"track": middle})
        after = after if passage.time is None else max(after, passage.time)
        results.append(passage)
    return CourseResult(course=course, passages=tuple(results), start_time=float(middle.time[0]))


def _find_passage(
    gate: Gate, line: GateLine, after: float, middle: MovingPoint, parts: Mapping[str, MovingPoint]
) -> Passage:
    """First crossing after a time (s) that passes the gate, else the first forward one, or the reason for none."""
    crossings = middle.crossings(line)
    near = [crossing for crossing in crossings if crossing.time > after and abs(crossing.aside) <= FARTHEST]
    tried = [crossing for crossing in near if crossing.forward]
    tried = [crossing for crossing in tried if crossing.time <= tried[0].time + CLIMB_BACK]
    if not tried:
        if any(0.0 < crossing.aside < line.width for crossing in near):
            words = Message("Gate {gate} was crossed against the course only.", gate=gate.name)
            return Passage(gate=gate, outcome="backwards", words=words)
        return Passage(gate=gate, outcome="not_reached", words=Message("Gate {gate} was not reached.", gate=gate.name))
    results = [_judge_crossing(gate, line, crossing, parts) for crossing in tried]
    return next((crossing for crossing in results if crossing.outcome == "passed"), results[0])


def _judge_crossing(gate: Gate, line: GateLine, at: Crossing, parts: Mapping[str, MovingPoint]) -> Passage:
    """Passage of a gate at one crossing, with the clearance (m) to the nearer pole."""
    aside = {name: _lateral_position(line, at, part) for name, part in parts.items()}
    low, high = min(aside.values()), max(aside.values())
    clearance = min(low, line.width - high)
    outcome, words = _verdict(gate, line, low, high)
    if outcome == "missed":
        clearance = high if high <= 0.0 else line.width - low
    return Passage(
        gate=gate, outcome=outcome, words=words, time=at.time, speed=at.speed, clearance=clearance, doubt=at.doubt
    )


def _lateral_position(line: GateLine, at: Crossing, part: MovingPoint) -> float:
    """Position (m) along the line at which a part crossed it at about that time; that of the middle if it did not."""
    crossings = [crossing for crossing in part.crossings(line) if crossing.forward]
    crossings = [crossing for crossing in crossings if abs(crossing.time - at.time) <= BESIDE]
    return min(crossings, key=lambda crossing: abs(crossing.time - at.time)).aside if crossings else at.aside


def _verdict(gate: Gate, line: GateLine, low: float, high: float) -> tuple[GateOutcome, Message]:
    """Outcome and sentence, from the places (m) along the gate's line between which the skier crossed it."""
    if low > 0.0 and high < line.width:
        return "passed", Message("Gate {gate} was passed.", gate=gate.name)
    for place, straddled in ((0.0, STRADDLED), (line.width, STRADDLED_OUTER)):
        if low <= place <= high and low < high:
            return "straddled", Message(straddled, gate=gate.name)
    if high > 0.0:
        return "missed", Message(BEYOND, gate=gate.name, distance=low - line.width)
    return "missed", Message(TO_THE_RIGHT if gate.side == "left" else TO_THE_LEFT, gate=gate.name, distance=abs(high))


HALVINGS: Final = 60
"""Number of bisections of the interval between two points, for a time of a crossing accurate to rounding."""


@dataclass(frozen=True, slots=True)
class Crossing:
    """One crossing of a line.

    time: time (s) on the points' clock.
    aside: position (m) along the line, from its origin.
    speed: speed (m/s) in the plane.
    forward: True if it crosses in the given direction, False if against it.
    doubt: difference (s) from the time of a straight path between the two points, as the uncertainty.
    """

    time: float
    aside: float
    speed: float
    forward: bool
    doubt: float


class MovingPoint:
    """A point that moves in a plane: places at times, interpolated by cubics with its velocities.

    time: (n,), rising (s), n ≥ 2.
    place: (n, 2) (m).
    velocity: (n, 2) (m/s) (default: differences of second order, exact for a constant acceleration).
    """

    def __init__(self, time: FloatArray, place: FloatArray, velocity: FloatArray | None = None) -> None:
        self.time, self.place = np.asarray(time, float), np.asarray(place, float)
        if len(self.time) < 2 or not np.all(np.diff(self.time) > 0.0):
            raise ParameterError("gates need two places or more at rising times; this track has fewer").tag("no_times")
        order: Literal[1, 2] = 2 if len(self.time) > 2 else 1
        differences = np.gradient(self.place, self.time, axis=0, edge_order=order)
        self.velocity = differences if velocity is None else np.where(np.isfinite(velocity), velocity, differences)

    def crossings(self, line: GateLine) -> list[Crossing]:
        """Every crossing of a gate's line, of any width, in their order; a point on the line counts as beyond it."""
        beyond = (self.place - line.pole) @ line.along >= 0.0
        return [self._crossing(int(i), line) for i in np.flatnonzero(np.diff(beyond.astype(np.int8)) != 0)]

    def _crossing(self, i: int, line: GateLine) -> Crossing:
        """Crossing of a gate's line between the points i and i + 1, interpolated; it assumes that there is one."""
        step = float(self.time[i + 1] - self.time[i])
        first, last = (float((self.place[j] - line.pole) @ line.along) for j in (i, i + 1))
        rates = (step * float(self.velocity[j] @ line.along) for j in (i, i + 1))
        forward = last >= 0.0
        high = _reached(first, last, *rates)
        place, velocity = self._at(i, high)
        straight = first / (first - last)
        return Crossing(
            time=float(self.time[i]) + high * step,
            aside=float((place - line.pole) @ line.across),
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


def track_point(track: Track, course: Course) -> MovingPoint:
    """Moving point of a track: its usable horizontal places at rising times, from the course's origin.

    Raises ParameterError: the axes of the track differ from those of the course, or it has fewer than two usable
        places.
    """
    degrees = track.axes == "east_north_up"
    if degrees != (course.axes == "east_north_up"):
        raise ParameterError(
            "of the track {name} and the course {source} one is in degrees, the other in metres. Give the course as "
            "the track is: GPX with waypoints, or CSV with x_m and y_m; or turn the track into the slope's frame first"
        ).tag("different_units", name=track.name, source=course.source)
    if course.latitude_deg is not None and course.longitude_deg is not None and degrees:
        track = track.at_origin(GeodeticPoint(course.latitude_deg, course.longitude_deg))
    good = track.usable & np.isfinite(track.place[:, :2]).all(axis=1)
    time, place = track.time[good], track.place[good, :2]
    rises = np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0.0]) if len(time) else np.zeros(0, bool)
    return MovingPoint(time[rises], place[rises])
