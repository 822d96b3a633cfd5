"""A control of moving boots that keeps a tall body in balance while it turns.

The body is an inverted pendulum over the skis. What it can do: stretch one leg and draw up the other, so that it leans
while its centre of mass stays level over the snow, and edge the skis, so that they turn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.messages import Message
from ..dynamics import BootPose
from ..scenario import Plane, Scenario
from ..scenario.skier import Skier
from ..scenario.terrain import down_and_left, normals_of
from .edges import Edges
from .legs import leg_poses
from .seen import Moment, Seen, seen_at
from .steering import LineThroughGates, Steering, TurnsOverTime, Underway

FloatArray: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BalanceRecord:
    """Input and output of the control at one moment.

    Attributes
    ----------
    time
        (s).
    seen
        Measured state.
    balanced, capture
        Where the centre of mass would be in balance, and the capture point that is wanted, from the middle of the feet
        to the left (m).
    edge_angle
        Against the snow (rad).
    """

    time: float
    seen: Seen
    balanced: float
    capture: float
    edge_angle: float


@dataclass(slots=True, eq=False)
class BalancedSkier:
    """Moves the boots of a run as a scenario's skier; `skisnow.simulate` takes it for a scenario that has one.

    Parameters
    ----------
    scenario
        With a skier, whose numbers the control has.

    Attributes
    ----------
    records
        Input and output of the control at each moment.

    Raises
    ------
    ParameterError
        The scenario has no skier.

    Notes
    -----
    With the centre of mass at the height z and ω² = m g z/(I + m z²), its place y aside of the feet obeys
    y'' = ω² (y - b - u): b would be in balance at the present acceleration, u is how far aside the centre of pressure
    is. Of the two movements the one that grows belongs to the capture point ξ = y + y'/ω; what it has to be is what is
    planned: ω ∫ exp(-ω s) b(t + s) ds. The legs bring u to where ξ - ξ_ref decays, as far as the stance allows, and
    edge angles help. A leg that bears more than asked gives way, as a damper does. Between two calls boots move with
    even acceleration: their velocities are continuous.

    References
    ----------
    The page docs/methods/skier.md.
    """

    scenario: Scenario
    records: list[BalanceRecord] = field(default_factory=list, repr=False)
    skier: Skier = field(init=False)
    steering: Steering = field(init=False)
    edges: Edges = field(init=False)
    _aside: list[float] = field(default_factory=lambda: [0.0, 0.0, 0.0])  # with its rates
    _edge: list[float] = field(default_factory=lambda: [0.0, 0.0])
    _turn: list[float] = field(default_factory=lambda: [0.0, 0.0])  # planned curvature over speed², with its rate
    _gives: float = 0.0  # rate aside by legs that give way (m/s)
    _pressure: float = 0.0  # asked for, from the middle of the feet to the left (m)
    _asked: float = 0.0  # acceleration that balance asks for
    _acceleration: float = 0.0  # acceleration of the feet to the left
    _correction: float = 0.0
    _slip: float = 0.0  # angle between skis and path, since the snow did not hold what was wanted (rad)
    _holds: float = field(init=False)  # share of the load aside, edged for balance
    _held: float = 1.0  # share of what the edges would take aside that the snow holds
    _gravity: float = field(init=False)
    _downhill: float = field(init=False)
    _rate: float = field(init=False)

    def __post_init__(self) -> None:
        if self.scenario.skier is None:
            raise ParameterError(
                Message("BalancedSkier: the scenario has no skier; give Scenario.with_(skier=Skier())"), code="no_data"
            )
        self.skier = self.scenario.skier
        self._stand_on(self.scenario.start.x, self.scenario.start.y)
        self.edges = Edges.of(self.scenario, self._gravity, self.skier)
        self._holds = self.edges.holding(self._weight)
        self.steering = self._steering()
        self._rate = self._rate_at(0.0)

    def _rate_at(self, aside: float) -> float:
        """Rate of the pendulum (1/s), its centre of mass so far aside (m): the more it leans, the less it rolls."""
        sledge, height = self.scenario.sledge, self._height
        roll = sledge.inertia[0] * height**2 / (height**2 + aside**2)
        return math.sqrt(self._gravity * height * sledge.mass / (roll + sledge.mass * height**2))

    def _stand_on(self, x: float, y: float) -> FloatArray:
        """Take gravity along the snow's normal and down the slope there; gives the normal (3,)."""
        slope, gravity = self.scenario.slope, self.scenario.gravity
        normal = normals_of(slope, x, y)
        if isinstance(slope, Plane):
            self._gravity, self._downhill = gravity * math.cos(slope.angle), gravity * math.sin(slope.angle)
        else:
            self._gravity = gravity * float(normal[2]) + self._pressed(x, y)
            self._downhill = -gravity * float(down_and_left(normal)[0][2])
        return normal

    def _pressed(self, x: float, y: float) -> float:
        """Acceleration off the snow (m/s²) that the slope's bend, over a ski's length, gives at the present speed."""
        if not self.records:
            return 0.0
        seen = self.records[-1].seen
        ahead = np.array([math.cos(seen.course), math.sin(seen.course)])
        half, most = self.scenario.ski.length / 2.0, self.skier.greatest_pressed
        behind, before = (normals_of(self.scenario.slope, *(np.array([x, y]) + d * ahead)) for d in (-half, half))
        bend = float((behind - before)[:2] @ ahead) / (2.0 * half)
        return max(-most, min(most, seen.speed**2 * bend))

    def _steering(self) -> Steering:
        course, start = self.scenario.course, self.scenario.start
        if self.skier.steers == "gates" and course is not None:
            return LineThroughGates(course, self.skier, (start.x, start.y))
        return TurnsOverTime(self.skier)

    @property
    def period(self) -> float:
        """Time from call to call (s)."""
        return self.skier.control_period

    @property
    def _height(self) -> float:
        return self.scenario.sledge.centre_of_mass[1]

    @property
    def _weight(self) -> float:
        """On level snow (N)."""
        return self.scenario.sledge.mass * self.scenario.gravity

    @property
    def _steepest(self) -> float:
        """Acceleration (m/s²) in balance at the greatest lean."""
        return self._gravity * math.tan(self.skier.greatest_lean)

    def __call__(self, moment: Moment) -> Sequence[BootPose]:
        """Where the boots shall be at the moment's end."""
        dt = moment.until - moment.time
        if dt > 0.0:
            normal = self._stand_on(*moment.position[:2].tolist())
            least = self.skier.bearing_share * self._weight
            seen = seen_at(moment, self._height, normal, least, self.skier.lifted_share)
            self._rate = self._rate_at(self._aside[0])
            wanted, planned = self._foreseen(moment.until, seen)
            self._learn(seen, planned, dt)
            wanted += self._correction / (1.0 + self.skier.leg_gain)  # it fades as errors do
            balanced, wanted = planned + self._correction, max(1.0, self.skier.lean_more * self._held) * wanted
            error = self._step_aside(seen, wanted, balanced, dt)
            self._step_edge(moment.until, seen, error, dt)
            self.records.append(BalanceRecord(moment.until, seen, balanced, wanted, self._edge[0]))
        stance, half = self.scenario.sledge.stance_width, float(self.scenario.ski.at(0.0).width) / 2.0
        (aside, rate, _), (edge, turning) = self._aside, self._edge
        moving = (aside, rate + self._gives)
        return leg_poses(moving, (edge, turning), self._height, stance, half, self.skier.blunt_edge)

    def _most(self, speed: float) -> float:
        """Acceleration of a carve in balance (m/s²)."""
        return min(self.edges.carving_acceleration(speed), self._steepest)

    def _planned(self, at: Underway, most: float) -> float:
        """Acceleration that is planned, over that of a carve in balance."""
        limit = self._limit(at.speed)
        return max(-limit, min(limit, self.steering.acceleration(at, most))) / max(most, 1e-3)

    def _limit(self, speed: float) -> float:
        """Greatest planned acceleration (m/s²): with the greatest edge angle."""
        return min(speed**2 / (self.edges.radius * math.cos(self.edges.greatest)), self._steepest)

    def _foreseen(self, now: float, seen: Seen) -> tuple[float, float]:
        """Where the capture point should be, and where the centre of mass would be in balance now (m)."""
        skier, step = self.skier, self.skier.foresight_step
        change, speed = skier.edge_change, max(seen.speed, skier.slowest)
        lag, fading = self._lag(seen.speed), skier.leg_gain * self._rate
        most, (turn, rate), acceleration = self._most(seen.speed), self._turn, self._acceleration
        at = Underway(now, *seen.place, seen.course, seen.speed, acceleration)
        total = weights = first = 0.0
        for i in range(round(skier.foresight / step)):
            later = (i + 0.5) * step
            at.time = now + later
            rate += step * (change**2 * (self._planned(at, most) - turn) - 2.0 * change * rate)
            turn += step * rate
            wished = most * turn + self._asked * math.exp(-fading * later)
            target = self.edges.held(wished, self._downhill * math.sin(at.heading), self._weight)
            acceleration += (target - acceleration) * step / (lag + step)
            balanced = self._height * (acceleration + self._downhill * math.sin(at.heading)) / self._gravity
            first = balanced if i == 0 else first
            weight = math.exp(-self._rate * later)
            total, weights = total + weight * balanced, weights + weight
            at.x += step * at.speed * math.cos(at.heading)
            at.y += step * at.speed * math.sin(at.heading)
            at.acceleration = acceleration
            at.heading += acceleration / speed * step
        return total / weights, first

    def _learn(self, seen: Seen, planned: float, dt: float) -> None:
        """How far balance is from the plan, by the loads while both skis bear and are edged."""
        if not seen.bears or seen.lifted:
            self._correction *= 1.0 - _share_of(dt, self.skier.load_filter)
            return
        most, edged = self.skier.correction, self._edge[0] / self.skier.trusted_edge
        found = seen.aside - seen.pressure - self._aside[2] / self._rate**2 - planned
        known = min(1.0, edged**2) * found  # skis that hardly hold follow the feet
        self._correction += _share_of(dt, self.skier.load_filter) * (max(-most, min(most, known)) - self._correction)

    def _step_aside(self, seen: Seen, wanted: float, balanced: float, dt: float) -> float:
        """Draw the capture point towards what is wanted; gives how far it is from it (m)."""
        skier, omega, (aside, rate, _) = self.skier, self._rate, self._aside
        free = seen.lifted or not seen.bears
        y, drift = (seen.aside, seen.aside_rate) if free else (aside, rate)
        error = y + drift / omega - wanted
        reach = skier.reach * self.scenario.sledge.stance_width / 2.0
        pressure = max(-reach, min(reach, (1.0 + skier.leg_gain) * error))
        growth = omega**2 * (y - pressure - balanced)
        back = min(1.0, skier.touch * dt) if free else 1.0  # a lifted ski is put down with the body as it is
        later = (1.0 - back) * rate + back * drift + growth * dt
        gives = skier.touch * (y - aside) if free else skier.leg_yielding * (seen.pressure - self._pressure)
        furthest = math.sqrt(skier.longest_leg**2 - self._height**2)
        place = aside + 0.5 * (rate + self._gives + later + gives) * dt
        self._aside, self._gives, self._pressure = (
            [max(-furthest, min(furthest, place)), later, growth],
            gives,
            pressure,
        )
        return error

    def _step_edge(self, now: float, seen: Seen, error: float, dt: float) -> None:
        """By critically damped filters: the planned turn, then the edge angle itself."""
        skier, (turn, rate), (edge, turning) = self.skier, self._turn, self._edge
        change, swift, most = skier.edge_change, skier.edge_filter, self._most(seen.speed)
        planned = self._planned(Underway(now, *seen.place, seen.course, seen.speed, self._acceleration), most)
        rate += dt * (change**2 * (planned - turn) - 2.0 * change * rate)
        self._turn = [turn + rate * dt, rate]
        asked = max(-most, min(most, skier.edge_gain * self._gravity * error / self._height))
        self._asked += _share_of(dt, skier.share_filter) * (asked - self._asked)
        ahead = most * self._turn[0] + self._asked
        lag = skier.lag / max(seen.speed, skier.slowest)
        slope = self._downhill * math.sin(seen.course)
        held = self.edges.held(ahead, slope, self._weight)
        self._held = (held + slope) / (ahead + slope) if held != ahead else 1.0
        self._acceleration += (held - self._acceleration) * dt / (lag + dt)
        grip = (ahead + slope) / self._gravity
        slip = abs(math.remainder(seen.heading - seen.course, 2.0 * math.pi))
        self._slip = slip if self.edges.slips(grip, self._weight) else min(self._slip, slip)
        wanted = self.edges.angle(ahead, grip, max(seen.speed, skier.slowest), self._weight)
        later = turning + (swift**2 * (wanted - edge) - 2.0 * swift * turning) * dt
        self._edge = [edge + 0.5 * (turning + later) * dt, later]

    def _lag(self, speed: float) -> float:
        """Until the path has the curvature that is wanted (s): skis that slip aside have to come round first."""
        most = self._gravity * self._holds
        return self.skier.lag / max(speed, self.skier.slowest) + self._slip * speed / most

    @property
    def edge_steps(self) -> FloatArray:
        """Changes of the edge angle from record to record (rad)."""
        return np.diff([each.edge_angle for each in self.records])


def _share_of(dt: float, rate: float) -> float:
    """Share of a step towards its input by a filter of first order with that corner frequency (rad/s)."""
    return dt / (dt + 1.0 / rate)
