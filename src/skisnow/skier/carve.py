"""Control of carved turns: skis that follow their path, edged like the lean; a skid where the snow no longer holds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, Protocol

from ..scenario.skier import Skier
from .control import GAIN_TIME, Balance
from .edges import Edges
from .plan import Gravity, Line, TurnsOverTime
from .posture import Command, Posture
from .seen import Seen
from .yaw import Body

EDGE_CHANGE: Final = 10.0
"""Corner frequency with which the planned turn goes from side to side (1/s) (found by trial)."""
EDGE_RATE: Final = 19.0
"""Corner frequency of the edge angle, and of what balance asks of it (1/s) (found by trial)."""
LOAD_RATE: Final = 25.0
"""Corner frequency of the filter of the loads (1/s) (found by trial)."""
LEAN_MORE: Final = 1.1
"""Capture point wanted, over that of balance (found by trial)."""
REACH: Final = 0.8
"""Share of half the stance that bounds the wanted centre of pressure (found by trial)."""
LAG: Final = 0.6
"""Way after which the path has the edge's curvature (m) (found by trial)."""
CORRECTION: Final = 0.12
"""By how much the loads may correct the planned place of the centre of mass (m) (found by trial)."""
TRUSTED_EDGE: Final = math.radians(10.0)
"""Edge angle (rad) above which the measured loads count fully; below it they count by its square."""
BY_EDGES: Final = 2.0
"""Gain of the edges over that of a skid (found by trial)."""
FORESIGHT_STEP, FORESIGHT_GROWTH, FORESIGHT_STEPS = 0.02, 1.09, 24
"""First step (s) of the plan ahead, ratio of each step to the one before, and their number: 1.5 s, 5 times the
pendulum's time. They grow, since what comes later counts less (modelling assumption)."""
SIGHT: Final = 2.0 / EDGE_CHANGE
"""Time ahead at which a line is looked at (s) (derived: the delay of the filter of the planned turn)."""
SLOWEST: Final = 2.0
"""Speed with which lag and turns are computed at least (m/s) (modelling assumption)."""


def _foresight() -> Iterator[tuple[float, float, float, tuple[float, float, float, float]]]:
    """Middle, end and length (s) of each step ahead, and the exact step of the filter of the planned turn.

    The filter is critically damped. Its step takes the distance from the plan and its rate to the same at the end.
    """
    end = 0.0
    for i in range(FORESIGHT_STEPS):
        step = FORESIGHT_STEP * FORESIGHT_GROWTH**i
        end += step
        u = EDGE_CHANGE * step
        fades = math.exp(-u)
        yield end - 0.5 * step, end, step, (
            fades * (1.0 + u), fades * step, -fades * EDGE_CHANGE * u, fades * (1.0 - u),
        )  # fmt: skip


_FORESIGHT: Final = tuple(_foresight())


@dataclass(slots=True)
class Underway:
    """State of a skier, now or predicted.

    time, x, y: (s), (m).
    heading, speed, acceleration: of its path: from the fall line (rad), (m/s), to the left (m/s²).
    """

    time: float
    x: float
    y: float
    heading: float
    speed: float
    acceleration: float


class Steering(Protocol):
    """Interface of steerings: desired acceleration to the left."""

    def acceleration(self, at: Underway, carving: float) -> float:
        """Desired acceleration to the left (m/s²); `carving`: size of that of a carve in balance."""


@dataclass(frozen=True, slots=True)
class CarvesOverTime:
    """The turns of a plan over time, each as a carve in balance."""

    plan: TurnsOverTime

    def acceleration(self, at: Underway, carving: float) -> float:
        """Acceleration (m/s²) of a carve in balance, to the side of the present turn."""
        return self.plan.sense(at.time) * carving


@dataclass(frozen=True, slots=True)
class Pursuit:
    """A line that the control follows with a time ahead (s), and the rate (1/s) of the return to it."""

    line: Line
    rate: float
    sight: float = SIGHT

    def acceleration(self, at: Underway, carving: float) -> float:
        """Acceleration (m/s²) that follows the line at the place `sight` (s) ahead, and returns to it."""
        del carving
        speed = at.speed
        turned = 0.5 * at.acceleration * self.sight / max(speed, 1.0)
        x = at.x + self.sight * speed * math.cos(at.heading + turned)
        y = at.y + self.sight * speed * math.sin(at.heading + turned)
        aside, slope, bend = self.line.at(x)
        along, level = math.atan(slope), 1.0 / math.sqrt(1.0 + slope * slope)
        off, turn = (y - aside) * level, at.heading + 2.0 * turned - along
        back = -(self.rate**2) * off - 2.0 * self.rate * speed * math.sin(turn)
        return speed**2 * bend * level**3 + back


@dataclass(slots=True)
class CarveControl:
    """Carved turns: the lean follows from the plan, the edge from the lean.

    Source: The page docs/methods/skier.md.
    """

    skier: Skier
    steering: Steering
    edges: Edges
    body: Body
    roll_inertia: float
    stance_width: float
    gravity: Gravity
    balance: Balance = field(default_factory=lambda: Balance(0.0, 0.0, 0.0, 0.0, 1.0))
    _turn: list[float] = field(default_factory=lambda: [0.0, 0.0])  # over that of a carve in balance, with its rate
    _growth: float = 0.0  # planned acceleration of the centre of mass aside
    _asked: float = 0.0  # acceleration that balance asks for
    _acceleration: float = 0.0  # acceleration of the feet to the left (m/s²)
    _correction: float = 0.0
    _slip: float = 0.0  # angle between skis and path, since the snow did not hold what was wanted (rad)
    _holds: float = field(init=False)  # share of the load aside, edged for balance
    _held: float = 1.0  # share of what the edges would take aside that the snow holds
    _foresight: tuple[float, float] = 0.0, 0.0  # wanted place of the capture point, and that in balance (m)
    _since: float = math.inf  # time since the plan was thought through (s)

    def __post_init__(self) -> None:
        self._holds = self.edges.holding(self._weight)

    @property
    def _weight(self) -> float:
        """Weight of the body (N)."""
        return self.body.mass * 9.81

    def command(self, seen: Seen, posture: Posture, dt: float) -> Command:
        """Command to the body until the next call, `dt` (s) later, so that it carves in balance."""
        now, height = seen.time + dt, self.body.height
        aside, rate = float(posture.numbers[1]), posture.aside_rate
        roll = self.roll_inertia * height**2 / (height**2 + aside**2)
        omega = math.sqrt(self.gravity.normal * height * self.body.mass / (roll + self.body.mass * height**2))
        self._since += dt
        if self._since > GAIN_TIME - 1e-9:
            self._since, self._foresight = 0.0, self._foreseen(now, seen, omega)
        else:  # its first step lasts as long
            wanted, planned = self._foresight
            self._foresight = planned + (wanted - planned) * math.exp(omega * dt), planned
        wanted, planned = self._foresight
        self._learn(seen, planned, posture.edge, omega, dt)
        wanted += self._correction / (1.0 + self.skier.leg_gain)  # it fades as errors do
        balanced, wanted = planned + self._correction, max(1.0, LEAN_MORE * self._held) * wanted
        if seen.lifted or not seen.bears:
            aside, rate = seen.aside, seen.aside_rate
        error = aside + rate / omega - wanted
        reach = REACH * self.stance_width / 2.0
        pressure = max(-reach, min(reach, (1.0 + self.skier.leg_gain) * error))
        self.balance = Balance(balanced, wanted, error, pressure, omega)
        edge = self._edge(now, seen, error, dt)
        self._growth = omega**2 * (aside - pressure - balanced)
        return Command((edge, edge), aside=self._growth, pressure=pressure, edge_rate=EDGE_RATE)

    def _underway(self, now: float, seen: Seen) -> tuple[Underway, float, float]:
        """State now, and accelerations (m/s²) of a carve in balance and with the largest edge angle.

        Both are limited by the one in balance at the largest lean.
        """
        speed, edges = seen.feet_speed, self.edges
        steepest = self.gravity.normal * math.tan(self.skier.greatest_lean)
        limit = speed**2 / (edges.radius * math.cos(edges.steepest(speed)))
        at = Underway(now, *seen.feet, seen.feet_course, speed, self._acceleration)
        return at, min(edges.carving_acceleration(speed), steepest), min(limit, steepest)

    def _foreseen(self, now: float, seen: Seen, omega: float) -> tuple[float, float]:
        """Target of the capture point, and the place of the centre of mass in balance now (m)."""
        actual, (turn, rate), acceleration = seen.feet_speed, self._turn, self._acceleration
        speed, lag, fading = max(actual, SLOWEST), self._lag(actual), self.skier.leg_gain * omega
        at, most, limit = self._underway(now, seen)
        load, total, before, first = self._weight, 0.0, 1.0, None
        steer, held, asked, share = self.steering.acceleration, self.edges.held, self._asked, 1.0 / max(most, 1e-3)
        sin, cos, exp = math.sin, math.cos, math.exp
        down, scale, holds = self.gravity.down, self.body.height / self.gravity.normal, self._holds * self.edges.gravity
        for middle, end, step, (a, b, c, d) in _FORESIGHT:
            at.time = now + middle
            planned = steer(at, most)
            planned = share * (limit if planned > limit else -limit if planned < -limit else planned)
            turn, rate = planned + a * (turn - planned) + b * rate, c * (turn - planned) + d * rate
            heading = at.heading
            slope, wanted = down * sin(heading), most * turn + asked * exp(-fading * middle)
            if abs(wanted + slope) > holds:
                wanted = held(wanted, slope, load)
            acceleration += (wanted - acceleration) * step / (lag + step)
            balanced = scale * (acceleration + slope)
            first = balanced if first is None else first
            weight = exp(-omega * end)
            total, before = total + (before - weight) * balanced, weight
            way, bend = step * actual, 0.5 * acceleration / speed * step
            at.x += way * cos(heading + bend)
            at.y += way * sin(heading + bend)
            at.heading, at.acceleration = heading + 2.0 * bend, acceleration
        return total / (1.0 - before), first or 0.0

    def _learn(self, seen: Seen, planned: float, edge: float, omega: float, dt: float) -> None:
        """Update the distance of balance from the plan by the loads, while both skis bear and are edged."""
        if not seen.bears or seen.lifted:
            self._correction *= 1.0 - _share_of(dt, LOAD_RATE)
            return
        found = seen.aside - seen.pressure - self._growth / omega**2 - planned
        known = min(1.0, (edge / TRUSTED_EDGE) ** 2) * found  # skis that hardly hold follow the feet
        self._correction += _share_of(dt, LOAD_RATE) * (max(-CORRECTION, min(CORRECTION, known)) - self._correction)

    def _edge(self, now: float, seen: Seen, error: float, dt: float) -> float:
        """Edge angle (rad), by a filter of the planned turn."""
        (turn, rate), speed, gravity = self._turn, seen.feet_speed, self.gravity.normal
        at, most, limit = self._underway(now, seen)
        planned = max(-limit, min(limit, self.steering.acceleration(at, most))) / max(most, 1e-3)
        rate += dt * (EDGE_CHANGE**2 * (planned - turn) - 2.0 * EDGE_CHANGE * rate)
        self._turn = [turn + rate * dt, rate]
        asked = BY_EDGES * self.skier.edge_gain * gravity * error / self.body.height
        self._asked += _share_of(dt, EDGE_RATE) * (max(-most, min(most, asked)) - self._asked)
        ahead = most * self._turn[0] + self._asked
        lag = LAG / max(speed, SLOWEST)
        slope = self.gravity.down * math.sin(seen.feet_course)
        held = self.edges.held(ahead, slope, self._weight)
        self._held = (held + slope) / (ahead + slope) if held != ahead else 1.0
        self._acceleration += (held - self._acceleration) * dt / (lag + dt)
        grip = (ahead + slope) / gravity
        self._slip = min(abs(seen.slip), math.inf if self.edges.slips(grip, self._weight) else self._slip)
        return self.edges.angle(ahead, grip, max(speed, SLOWEST), self._weight)

    def _lag(self, speed: float) -> float:
        """Until the path has the curvature that is wanted (s): skis that slip aside have to come round first."""
        return LAG / max(speed, SLOWEST) + self._slip * speed / (self.gravity.normal * self._holds)


def _share_of(dt: float, rate: float) -> float:
    """Share of a step towards its input by a filter of first order with that corner frequency (rad/s)."""
    return dt / (dt + 1.0 / rate)
