"""Steering of a skier: turns planned over time, or a line through gates."""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from typing import Protocol

from ..scenario.skier import Skier
from ..track.course import Course


@dataclass(slots=True)
class Underway:
    """Where a skier is, or will be.

    Attributes
    ----------
    time, x, y
        (s), (m).
    heading, speed, acceleration
        Of its path: from the fall line (rad), (m/s), to the left (m/s²).
    """

    time: float
    x: float
    y: float
    heading: float
    speed: float
    acceleration: float


class Steering(Protocol):
    """Says how to turn."""

    def acceleration(self, at: Underway, carving: float) -> float:
        """To the left (m/s²), where a carve in balance has so much of it."""


class Line(Protocol):
    """Lies over a course."""

    def at(self, x: float) -> tuple[float, float, float]:
        """Place aside (m), slope and second derivative (1/m) at a place down the slope (m)."""


@dataclass(frozen=True, slots=True)
class TurnsOverTime:
    """Turns to the left and to the right by turns, the first half a turn long, then straight on.

    Examples
    --------
    >>> plan = TurnsOverTime(Skier(first_turn=1.0, turn_time=2.0, turns=1.5))
    >>> [plan.sense(time) for time in (0.5, 1.5, 3.0, 4.5)]
    [0.0, 1.0, -1.0, 0.0]
    """

    skier: Skier

    def sense(self, time: float) -> float:
        """1 for a turn to the left, -1 to the right, 0 for none, at a time (s)."""
        done = (time - self.skier.first_turn) / self.skier.turn_time
        if not 0.0 <= done < self.skier.turns:
            return 0.0
        side = 1.0 if math.floor(done + 0.5) % 2 == 0 else -1.0
        return side if self.skier.first_to_left else -side

    def acceleration(self, at: Underway, carving: float) -> float:
        """That of a carve in balance, to one side or the other."""
        return self.sense(at.time) * carving


class LineThroughGates:
    """Half waves from apex to apex, each beside its turning pole, and a pursuit of them.

    Parameters
    ----------
    course
        With its gates down the slope, x rising.
    skier
        Its clearance from the poles and the time ahead at which it looks.
    start
        x, y (m) where it begins.

    Raises
    ------
    ParameterError
        The gates do not follow each other down the slope.
    """

    def __init__(self, course: Course, skier: Skier, start: tuple[float, float]) -> None:
        self.sight, self.stiffness = skier.sight, skier.line_rate
        apexes = [start]
        for gate in course.gates:
            aside = skier.pole_clearance if gate.side == "left" else -skier.pole_clearance
            apexes.append((gate.turning[0], gate.turning[1] + aside))
        self.apexes = [(float(x), float(y)) for x, y in apexes]
        self._places = [x for x, _ in self.apexes]

    def at(self, x: float) -> tuple[float, float, float]:
        """Place aside (m), slope and second derivative (1/m) of the line at a place down the slope (m)."""
        i = min(max(bisect.bisect_left(self._places, x) - 1, 0), len(self._places) - 2)
        (x0, y0), (x1, y1) = self.apexes[i : i + 2]
        rate, half = math.pi / (x1 - x0), 0.5 * (y1 - y0)
        phase = min(math.pi, max(0.0, rate * (x - x0)))
        bend = half * rate**2 * math.cos(phase) if x0 <= x <= x1 else 0.0
        return y0 + half * (1.0 - math.cos(phase)), half * rate * math.sin(phase), bend

    def acceleration(self, at: Underway, carving: float) -> float:
        """That of the line, a time ahead, and what leads back to it."""
        del carving
        return pursued(self, at, sight=self.sight, rate=self.stiffness)


def pursued(line: Line, at: Underway, *, sight: float, rate: float) -> float:
    """Acceleration to the left (m/s²) of a line, a time ahead (s), and what leads back to it at a rate (1/s)."""
    speed = at.speed
    turned = 0.5 * at.acceleration * sight / max(speed, 1.0)
    x = at.x + sight * speed * math.cos(at.heading + turned)
    y = at.y + sight * speed * math.sin(at.heading + turned)
    aside, slope, bend = line.at(x)
    along = math.atan(slope)
    off, turn = (y - aside) * math.cos(along), at.heading + 2.0 * turned - along
    back = -(rate**2) * off - 2.0 * rate * speed * math.sin(turn)
    return speed**2 * bend * math.cos(along) ** 3 + back
