"""Plan of hybrid turns: the skier skids up to the fall line, carves behind it, and changes edges."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .plan import AHEAD, SLOWEST, STEEPEST_COURSE, STEP, Gravity, Line, Planned, RecedingLine
from .seen import Seen

FADES_FROM, FADES_TO = math.radians(20.0), math.radians(5.0)
"""Courses before the fall line between which the slip of the skid fades to 0 (found by trial)."""
CARVES_TO: Final = 0.7
"""Course behind the fall line up to which a turn is carved, over the greatest course of the line (found by trial)."""
BLADE: Final = math.radians(3.0)
"""Slip below which a carve begins (measured: a ski follows its edge below 1 to 3°)."""
BEGINS: Final = math.radians(6.0)
"""Course before the fall line from which a carve can begin (modelling assumption)."""
BEGINS_BEFORE: Final = 0.8
"""Course up to which a carve can begin, over the one up to which it lasts (modelling assumption)."""
LEAST_FORCE: Final = 1.0
"""Planned force over mass (m/s²) from which a turn can be carved (modelling assumption)."""
BLEND: Final = 3
"""Moments of a plan over which the force goes over to that of the carve (modelling assumption)."""
STEEPEST_SINE: Final = 0.85
"""Sine of the lean in balance up to which a carve gets tighter with the speed (modelling assumption)."""
LEAST_RADIUS, MOST_RADIUS = 0.6, 1.6
"""Range of the radius of a carve over that of one in balance (modelling assumption)."""
LEARNS: Final = 0.2
"""Share by which the radius of a carve follows that of the path from plan to plan (modelling assumption)."""


class CarvedLine(RecedingLine):
    """A line on which each turn is skidded up to the fall line and carved behind it.

    radius: of the ski's sidecut (m).

    The slip fades before the fall line while the edges are still flat. Below 3° of slip the skis follow their edges,
    which then take the lean of the body. From 0.7 of the greatest course of the line on the skier changes edges,
    without slip to the old side, and skids into the next turn. Source: the page docs/methods/skier.md.
    """

    def __init__(self, line: Line, apexes: Sequence[tuple[float, float]], radius: float) -> None:
        super().__init__(line, apexes)
        self._sidecut, self._share = radius, 1.0  # radius of the present carve over the one in balance
        self._until = CARVES_TO * max(map(abs, self._course))  # course (rad) up to which a carve lasts
        self._side = 0.0  # of the carve: 1 to the left, -1 to the right, 0 for none
        self._left = 0.0  # side of the turn whose carve has ended

    def ahead(self, seen: Seen, gravity: Gravity) -> Planned:
        """The line, with the force of a carve behind the fall line."""
        planned = super().ahead(seen, gravity)
        self._begin_or_end(seen, planned.force)
        if self._left:
            return replace(planned, slides=np.where(np.sign(planned.force) == self._left, 0.0, 1.0))
        if self._side:
            self._learn(seen, gravity)
            bend = self._bend_of(seen.course, self._radius(seen.speed, gravity))
            self._quintic = (seen.place[0], 1.0, [0.0, 0.0, 0.5 * bend, 0.0, 0.0, 0.0])
        return self._carved(planned, seen, gravity)

    def _begin_or_end(self, seen: Seen, force: FloatArray) -> None:
        """A carve begins at the fall line once the skis hardly slip, and ends where its course is reached."""
        if self._left * force[0] <= 0.0:
            self._left = 0.0
        if self._side and self._side * seen.course > self._until:
            self._side, self._left, self._share = 0.0, self._side, 1.0
        if self._side or self._left or abs(seen.slip) > BLADE or abs(force[0]) < LEAST_FORCE:
            return
        side = _side_of(force)
        if -BEGINS < side * seen.course < BEGINS_BEFORE * self._until:
            self._side = side

    def _radius(self, speed: float, gravity: Gravity) -> float:
        """Radius (m) of a carve at a speed (m/s): R cos ϑ with the lean in balance, sin ϑ = v²/(R g), times a share."""
        sine = min(STEEPEST_SINE, speed**2 / (self._sidecut * gravity.normal))
        return self._share * self._sidecut * math.sqrt(1.0 - sine**2)

    def _learn(self, seen: Seen, gravity: Gravity) -> None:
        """Adjust the share to the radius of the path of this carve."""
        rate = self._side * seen.turn_rate
        if abs(seen.slip) < BLADE and rate > 0.0:
            share = self._share * seen.speed / (rate * self._radius(seen.speed, gravity))
            self._share += LEARNS * (max(LEAST_RADIUS, min(MOST_RADIUS, share)) - self._share)

    def _bend_of(self, course: float, radius: float) -> float:
        """Second derivative (1/m) of the path of a carve with a radius (m)."""
        slope = math.tan(max(-STEEPEST_COURSE, min(STEEPEST_COURSE, course)))
        return self._side / radius * (1.0 + slope**2) ** 1.5

    def _carved(self, planned: Planned, seen: Seen, gravity: Gravity) -> Planned:
        """The plan with the force and the course of a carve from the fall line to its end."""
        force, course = planned.force.copy(), planned.course.copy()
        side, speed = self._side or _side_of(force), max(seen.speed, SLOWEST)
        radius = self._radius(speed, gravity)
        before = -side * course
        turns = np.sign(force) == side
        share = np.clip((before - FADES_TO) / (FADES_FROM - FADES_TO), 0.0, 1.0)
        slides = np.where(turns, share**2 * (3.0 - 2.0 * share), 1.0)
        begins = np.flatnonzero((before < FADES_TO) & turns)
        first = 0 if self._side else int(begins[0]) if len(begins) else len(AHEAD)
        at = seen.course if self._side or first == len(AHEAD) else float(course[first])
        i = first
        while i < len(AHEAD) and side * at <= self._until:
            carved = side * speed**2 / radius + gravity.down * math.sin(at)
            weight = 1.0 if self._side else min(1.0, (i - first + 1) / BLEND)
            force[i] += weight * (carved - force[i])
            course[i], slides[i] = at, 0.0
            at += STEP * speed * side / radius
            i += 1
        slides[i:] = np.where(turns[i:], 0.0, 1.0)
        least = self._side * speed**2 / self._sidecut
        return replace(planned, force=force, course=course, slides=slides, carves=least)

    def _bend_at(self, i: int) -> float:
        """Second derivative (1/m) at an apex, where the line must not be tighter than the ski carves."""
        return max(-1.0 / self._sidecut, min(1.0 / self._sidecut, super()._bend_at(i)))


def _side_of(force: FloatArray) -> float:
    """Side of the next turn of a plan: 1 to the left, -1 to the right."""
    return math.copysign(1.0, float(force[:10].sum()))
