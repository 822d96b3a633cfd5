"""Plan of a skier for the next 1.2 s: a line through gates, turns over time, or a side-slip."""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Final, Protocol

import numpy as np

from .._support.arrays import FloatArray
from ..scenario.skier import Skier
from ..track.course import Course
from .seen import Seen

STEP: Final = 0.04
"""Time (s) between the moments of a plan (modelling assumption)."""
AHEAD: Final = STEP * (np.arange(30) + 0.5)
"""Moments of a plan, counted from now (s)."""
SLOWEST: Final = 1.5
"""Speed (m/s) with which a plan is computed at least (modelling assumption)."""
STEEPEST_COURSE: Final = 1.2
"""Greatest course (rad) at which a line down the slope is joined (modelling assumption)."""
TABLE_STEP: Final = 0.05
"""Step (m) of the table of a line (modelling assumption)."""
JOINS: Final = 0.32
"""Share of the way between two apexes that is left at least to join the line (found by trial)."""
SETTLES: Final = 2.5
"""Rate (1/s) at which a side-slip comes to its speed, and its greatest deceleration (m/s²) (modelling assumption)."""
CHANGES: Final = 0.5
"""Time (s) over which a side-slip begins and stops, since the body leans ahead of the force (modelling assumption)."""
STANDS: Final = 0.15
"""Speed (m/s) below which a side-slip that stops has stopped."""
BACK: Final = 2.0
"""Rate (1/s) at which turns over time go back to their course (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class Gravity:
    """Acceleration by gravity along the snow's normal and down the slope (m/s²)."""

    normal: float
    down: float


@dataclass(frozen=True, slots=True)
class Planned:
    """Force to the left over mass (m/s²) and course (rad) at the moments `AHEAD`.

    `heading` of the skis (rad), if the plan states it; otherwise it follows from the slip. `stands`: the skier has
    stopped and stands still. `slides`: factor on the slip that braking needs; 0: none. `carves`: acceleration (m/s²) of
    the widest carve now; 0: the skis do not carve.
    """

    force: FloatArray
    course: FloatArray
    heading: float | None = None
    stands: bool = False
    slides: FloatArray | float = 1.0
    carves: float = 0.0


class Plan(Protocol):
    """Interface of plans of turns."""

    def ahead(self, seen: Seen, gravity: Gravity) -> Planned:
        """Planned forces and courses from an observed state onwards."""


class Line(Protocol):
    """Interface of lines over a course."""

    def at(self, x: float) -> tuple[float, float, float]:
        """Place aside (m), slope and second derivative (1/m) at a place down the slope (m)."""


@dataclass(frozen=True, slots=True)
class TurnsOverTime:
    """Alternate turns to the left and right, the first one half as long; straight on after the last.

    >>> plan = TurnsOverTime(Skier(first_turn=1.0, turn_time=2.0, turns=1.5, turn_angle=0.5))
    >>> [round(plan.course(time)[0], 3) for time in (0.5, 1.5, 2.0, 3.0, 4.0, 9.0)]
    [0.0, 0.25, 0.5, 0.0, -0.5, -0.5]
    """

    skier: Skier

    def sense(self, time: float) -> float:
        """1 for a turn to the left, -1 to the right, 0 for none, at a time (s)."""
        done = (time - self.skier.first_turn) / self.skier.turn_time
        if not 0.0 <= done < self.skier.turns:
            return 0.0
        side = 1.0 if math.floor(done + 0.5) % 2 == 0 else -1.0
        return side if self.skier.first_to_left else -side

    def course(self, time: float) -> tuple[float, float]:
        """Course (rad) and its rate (rad/s) at a time (s)."""
        skier = self.skier
        done = min((time - skier.first_turn) / skier.turn_time, skier.turns)
        most = skier.turn_angle if skier.first_to_left else -skier.turn_angle
        if done <= 0.0:
            return 0.0, 0.0
        rate = math.pi / skier.turn_time * (done < skier.turns)
        if done < 0.5:
            return 0.5 * most * (1.0 - math.cos(2.0 * math.pi * done)), most * rate * math.sin(2.0 * math.pi * done)
        phase = math.pi * (done - 0.5)
        return most * math.cos(phase), -most * rate * math.sin(phase)

    def ahead(self, seen: Seen, gravity: Gravity) -> Planned:
        """Planned turns from now on, with a gradual return from the present course to that of the turns."""
        course, rate = np.array([self.course(seen.time + later) for later in AHEAD]).T
        back = (seen.course - self.course(seen.time)[0]) * np.exp(-BACK * AHEAD)
        speed = max(seen.speed, SLOWEST)
        course = course + back
        return Planned(speed * (rate - BACK * back) + gravity.down * np.sin(course), course)


class HalfWaves:
    """A line of half waves from apex to apex.

    apexes: x, y (m), x rising, at least two.
    """

    def __init__(self, apexes: Sequence[tuple[float, float]]) -> None:
        self.apexes = apexes
        self._starts = [x for x, _ in apexes[:-1]]
        self._waves = [(x0, x1, y0, math.pi / (x1 - x0), 0.5 * (y1 - y0)) for (x0, y0), (x1, y1) in pairwise(apexes)]

    def at(self, x: float) -> tuple[float, float, float]:
        """Place aside (m), slope and second derivative (1/m) at a place down the slope (m)."""
        start, end, aside, rate, half = self._waves[max(bisect.bisect_left(self._starts, x) - 1, 0)]
        within = start <= x <= end
        phase = rate * (x - start) if within else 0.0 if x < start else math.pi
        cosine = math.cos(phase)
        bend = half * rate**2 * cosine if within else 0.0
        return aside + half * (1.0 - cosine), half * rate * math.sin(phase), bend


@dataclass(frozen=True, slots=True)
class SideSlip:
    """Skis across the fall line that slide down it at a speed (m/s), until they stop from a time (s) on."""

    speed: float
    stops_after: float

    def ahead(self, seen: Seen, gravity: Gravity) -> Planned:
        """Force up the slope that brings the slip to its speed or stops it, with the speed that it leaves."""
        side, heading = math.copysign(1.0, seen.heading), math.copysign(0.5 * math.pi, seen.heading)
        down = side * seen.speed * math.sin(seen.heading - seen.course)
        slope = gravity.down * abs(math.sin(seen.heading))
        stops, force = seen.time >= self.stops_after, []
        for time in seen.time + AHEAD:
            more = min(SETTLES, 0.8 + 1.5 * down) * (down > 0.0) if stops else SETTLES * (down - self.speed)
            share = min(1.0, (time - stops * self.stops_after) / CHANGES)
            force.append(slope + share * (max(0.3, min(6.0, slope + more)) - slope))
            down = max(0.0, down + STEP * (slope - force[-1]))
        stands = stops and seen.speed < STANDS
        return Planned(side * np.array(force), np.full(len(AHEAD), heading), heading, stands)


class RecedingLine:
    """A path from where the skier is to the next apex of a line that is far enough, and on along the line.

    line: up to its last apex; behind it the turns go on.
    apexes: x, y (m) of its start and apexes, x rising.

    The path to the apex is a polynomial of fifth order with place, course and planned curvature of now, and those of
    the line at the apex: the planned curvature is continuous, and nothing has to lead back to the line. The first one
    begins straight.
    """

    def __init__(self, line: Line, apexes: Sequence[tuple[float, float]]) -> None:
        self.apexes = with_run_out(apexes)
        end = apexes[-1][0]
        last = self.apexes[-1][0]
        self._first = apexes[0][0]
        self._quintic: tuple[float, float, list[float]] | None = None  # its start and way (m), coefficients (m)
        x = np.arange(apexes[0][0], last + 15.0, TABLE_STEP)
        beyond = HalfWaves(self.apexes[len(apexes) - 1 :])
        rows = np.array([line.at(float(each)) if each < end else beyond.at(float(each)) for each in x])
        course = np.arctan(rows[:, 1])
        self._course, self._bend = course.tolist(), rows[:, 2].tolist()
        self._curvature = (rows[:, 2] * np.cos(course) ** 3).tolist()
        ways = [x1 - x0 for (x0, _), (x1, _) in pairwise(self.apexes)]
        self._last_way = ways[-1]
        until = (place - JOINS * max(ways[i : i + 2]) for i, (place, _) in enumerate(self.apexes[1:]))
        self._join_before = list(accumulate(until, max))  # x (m) before which each apex but the start is joined

    def at(self, x: float) -> tuple[float, float]:
        """Course (rad) and curvature (1/m) of the line at a place down the slope (m)."""
        place = min(max((x - self._first) / TABLE_STEP, 0.0), len(self._course) - 2.0)
        i = int(place)
        share, course, curvature = place - i, self._course, self._curvature
        return (
            course[i] + share * (course[i + 1] - course[i]),
            curvature[i] + share * (curvature[i + 1] - curvature[i]),
        )

    def ahead(self, seen: Seen, gravity: Gravity) -> Planned:
        """Planned force and course along the joining path and then the line, at the present speed."""
        x, y = seen.place
        until = self._join(x, y, max(-STEEPEST_COURSE, min(STEEPEST_COURSE, seen.course)))
        assert self._quintic is not None
        _, way, (_, c1, c2, c3, c4, c5) = self._quintic
        speed = max(seen.speed, SLOWEST)
        step, square, down = STEP * speed, speed**2, gravity.down
        place = x + 0.5 * step * math.cos(seen.course)
        force, course = [], []
        for _ in AHEAD:
            if place < until:
                u = (place - x) / way
                slope = (c1 + u * (2 * c2 + u * (3 * c3 + u * (4 * c4 + 5 * u * c5)))) / way
                bend = (2 * c2 + u * (6 * c3 + u * (12 * c4 + 20 * u * c5))) / way**2
                along, curvature = math.atan(slope), bend / (1.0 + slope**2) ** 1.5
            else:
                along, curvature = self.at(place)
            force.append(square * curvature + down * math.sin(along))
            course.append(along)
            place += step * math.cos(along)
        return Planned(np.array(force), np.array(course))

    def _join(self, x: float, y: float, course: float) -> float:
        """Find the path to the next apex that can be joined, store it, and return the apex's x (m)."""
        place, aside = self._next_apex(x)
        i = min(max(round((place - self._first) / TABLE_STEP), 0), len(self._bend) - 1)
        way = place - x
        a0, a1, end = y, math.tan(course) * way, self._bend_at(i) * way**2
        a2 = 0.0
        if self._quintic is not None:
            first, before, c = self._quintic
            u = (x - first) / before
            a2 = (c[2] + 3 * c[3] * u + 6 * c[4] * u**2 + 10 * c[5] * u**3) * (way / before) ** 2
        d0 = aside - a0 - a1 - a2
        d1 = -a1 - 2.0 * a2
        d2 = end - 2.0 * a2
        rest = (10 * d0 - 4 * d1 + 0.5 * d2, -15 * d0 + 7 * d1 - d2, 6 * d0 - 3 * d1 + 0.5 * d2)
        self._quintic = (x, way, [a0, a1, a2, *rest])
        return place

    def _bend_at(self, i: int) -> float:
        """Second derivative (1/m) at a row of the table, of the turn behind it."""
        return self._bend[min(i + 1, len(self._bend) - 1)]

    def _next_apex(self, x: float) -> tuple[float, float]:
        """Place (m) along and across the line of the next apex far enough from x; after the last, one as far on."""
        i = bisect.bisect_right(self._join_before, x) + 1
        if i < len(self.apexes):
            return self.apexes[i]
        place, aside = self.apexes[-1]
        return max(place, x) + self._last_way, aside


def with_run_out(apexes: Sequence[tuple[float, float]], *, turns: int = 3) -> list[tuple[float, float]]:
    """Apexes with some more behind the last one, from side to side as the last two: the last turn is like the rest."""
    found = list(apexes)
    (x0, y0), (x1, y1) = found[-2], found[-1]
    for number in range(1, turns + 1):
        found.append((x1 + number * (x1 - x0), y0 if number % 2 else y1))
    return found


def apexes_of(course: Course, skier: Skier, start: tuple[float, float], gravity: float) -> list[tuple[float, float]]:
    """Start and apexes of a line past the turning poles; at a wanted speed it leaves room for the lean."""
    gates = [start, *(gate.turning for gate in course.gates)]
    found = [start]
    for i, gate in enumerate(course.gates, 1):
        others = [gates[k] for k in (i - 1, i + 1) if (k > 0 or len(gates) < 3) and k < len(gates)]
        way = min(abs(gate.turning[0] - other[0]) for other in others)
        half = 0.5 * max(abs(gate.turning[1] - other[1]) for other in others)
        aside = clearance(skier, half, way, gravity)
        found.append((gate.turning[0], gate.turning[1] + (aside if gate.side == "left" else -aside)))
    return found


def clearance(skier: Skier, half: float, way: float, gravity: float) -> float:
    """Distance (m) of the line of the centre of mass from a pole that its feet pass at the skier's clearance.

    The turn is half a wave of so much aside and way (m), under gravity along the normal (m/s²). Without a wanted speed
    it is the clearance.
    """
    aside = skier.pole_clearance
    for _ in range(6):
        lean = min(1.0, skier.brakes_to**2 * (half + aside) * (math.pi / way) ** 2 / gravity)
        aside = max(0.05, skier.pole_clearance - 0.6 * lean)
    return aside
