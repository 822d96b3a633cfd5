"""Control of a skier from theory: capture point, edge from the force map, learnt grip, yaw by a regulator."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Final, Protocol

import numpy as np

from .._support.arrays import FloatArray
from ..scenario.skier import Skier
from .edges import ForceMap
from .plan import AHEAD, Gravity, Plan, Planned
from .posture import AHEAD as AHEAD_OF_FEET
from .posture import LEFT_TOE, RIGHT_TOE, STANCE, Command, Posture
from .seen import Seen
from .yaw import Body, heading_ahead, yaw_gain, yaw_state

FORCE_TIME: Final = 0.05
"""Time (s) over which the measured force is smoothed, half a bounce of the body on the snow (modelling assumption)."""
BLADE_TIME: Final = 0.03
"""Time (s) over which it is known whether a ski is a blade or a slider (modelling assumption)."""
BLADE, SLIDER = math.radians(1.0), math.radians(3.5)
"""Slip (rad) below which a ski follows its edge, and above which it slides (measured: between 1 and 3°)."""
LEARNS_FROM: Final = math.radians(5.0)
"""Slip (rad) above which a ski shows its grip (modelling assumption)."""
GRIP_TIME: Final = 0.05
"""Time (s) over which the grip is learnt (found by trial: with 0.3 fewer disturbed starts succeed)."""
FIRST_GRIP: Final = 0.9
"""Measured over computed force in a skid (0.8 to 0.95 at slips of 3 to 20°)."""
GAIN_TIME: Final = 0.02
"""Time (s) between two plans, with a solution for the yaw (modelling assumption)."""
EDGE_AHEAD: Final = 0.06
"""Time (s) by which the edge leads, since its filter lags (derived: two over the filter's rate)."""
REACH: Final = 0.85
"""Share of half the stance that bounds the wanted centre of pressure (modelling assumption)."""
BY_EDGE: Final = 0.03
"""Shift of the pressure by the loaded edges to the inside, half a ski's width (m)."""
SLIDING: Final = math.radians(12.0)
"""Edge angle below which it stays under twice the slip, so that a ski does not grip by accident (rule of thumb)."""
STEEPEST: Final = math.radians(34.0)
"""Edge angle with which the learnt grip limits the planned force: steeper ones hold hardly more on weak, hard snow
(found by trial: of four starts there 34° passes three, 40 and 46° two)."""
CARRIED: Final = 0.8
"""Share of the skis' heading to which a blade carries the body along (modelling assumption)."""
LEAST_SHARE: Final = 0.6
"""Share of the widest carve's force below which a carve's edges are flattened until the skis slide, since carving skis
would throw the body to the outside (found by trial: 0.8 leaves fewer carves)."""
LEAST_CARVE: Final = math.radians(3.0)
"""Edge angle of a carve at least (rad) (modelling assumption)."""
BOUND: Final = 12.75
"""Greatest acceleration that the edges are set for, 1.3 g (m/s²) (modelling assumption)."""
ROLLING: Final = 0.05
"""Share of the load that friction takes along the skis (modelling assumption)."""
AIR: Final = 0.004
"""Deceleration by the air over the square of the speed (1/m) (modelling assumption)."""
STOPPED, STANDING_EDGE, HOLDS = 0.2, math.radians(5.0), 20.0
"""Speed (m/s) below which a skier who stops holds all joints, the edge angle (rad) at least, and its rate (1/s)."""


class Controller(Protocol):
    """Moves a skier: `skisnow.simulate` takes one.

    Called every ``skier.control_period_ms`` with the observed state, the posture and the period (s).
    """

    def command(self, seen: Seen, posture: Posture, dt: float) -> Command:
        """Command to the body for the next `dt` (s), from its observed state and posture."""


@dataclass(slots=True)
class Smoothed:
    """First-order low-pass filter with a time constant (s) and its present value."""

    time: float
    value: float = 0.0

    def step(self, value: float, dt: float) -> float:
        """Advance the filter by `dt` (s) towards a value, and return its new value."""
        self.value += (1.0 - math.exp(-dt / self.time)) * (value - self.value)
        return self.value


@dataclass(slots=True)
class Balance:
    """Position of balance at one moment.

    balanced: where the centre of mass would be in balance by the measured force, to the left of the feet (m).
    wanted, error: place that the capture point is to have, and how far it is to the left of it (m).
    pressure: centre of pressure that follows (m).
    rate: rate of the pendulum (1/s).
    """

    balanced: float
    wanted: float
    error: float
    pressure: float
    rate: float


@dataclass(slots=True)
class SkidControl:
    """Control of a skier in skidded turns: slip brakes, edge angles steer, the centre of pressure keeps balance.

    Source: The page docs/methods/skier.md.
    """

    skier: Skier
    plan: Plan
    snow: ForceMap
    body: Body
    roll_inertia: float
    stance_width: float
    gravity: Gravity
    grip: float = FIRST_GRIP
    balance: Balance = field(default_factory=lambda: Balance(0.0, 0.0, 0.0, 0.0, 1.0))
    slip: float = 0.0
    _blade: Smoothed = field(default_factory=lambda: Smoothed(BLADE_TIME, 0.5))
    _balanced: Smoothed = field(default_factory=lambda: Smoothed(FORCE_TIME))
    _gain: FloatArray = field(default_factory=lambda: np.zeros((2, 7)))
    _since: float = math.inf
    _planned: Planned = field(init=False)

    def command(self, seen: Seen, posture: Posture, dt: float) -> Command:
        """Command to the body for the next `dt` (s), so that it skids along its plan."""
        self._learn(seen, posture)
        self._since += dt
        if self._since > GAIN_TIME - 1e-9:
            self._since = 0.0
            self._look_ahead(seen)
        planned = self._planned
        if planned.stands:
            edge = math.copysign(max(abs(posture.edge), STANDING_EDGE), posture.edge)
            return standing(seen, posture, (edge, edge))
        soon = float(np.interp(EDGE_AHEAD + self._since, AHEAD, planned.force))
        self.balance = self._balance(seen, posture, soon, dt)
        edge = self._edge(seen, posture, soon)
        torque, shift = self._yaw(seen, posture)
        return Command(
            edge=(edge, edge),
            hip_torque=torque,
            ahead=shift,
            aside=self.balance.rate**2 * (seen_aside(seen, posture) - self.balance.balanced - self.balance.pressure),
            pressure=self.balance.pressure,
            load=self.body.mass * self.gravity.normal,
        )

    def _look_ahead(self, seen: Seen) -> None:
        """Plan, limited by the largest lean and the grip, with its slip and the gain of the yaw."""
        found, normal = self.plan.ahead(seen, self.gravity), self.gravity.normal
        most = normal * math.tan(self.skier.greatest_lean)
        outer = self.skier.outer_share * self.body.mass * normal
        inner = self.body.mass * normal - outer
        holds = self.grip * (self.snow.force(STEEPEST, outer) + self.snow.force(STEEPEST, inner))
        most = min(most, holds / self.body.mass)
        self._planned = planned = replace(found, force=np.clip(found.force, -most, most))
        slips = self._slips(seen, planned) * planned.slides
        self.slip = float(slips[0])
        if not planned.stands:
            heading = heading_ahead(planned, slips, normal, self.body.height, seen.speed)
            self._gain = yaw_gain(planned, heading, slips, self.body, normal, seen.speed)

    def _slips(self, seen: Seen, planned: Planned) -> FloatArray:
        """Angle of the skis against the path (rad) that brakes as much as is needed, over the plan."""
        skier, force = self.skier, np.abs(planned.force)
        slope = 0.95 * self.gravity.down - ROLLING * self.gravity.normal - AIR * seen.speed**2
        brake = max(0.0, skier.braking * (seen.speed - skier.brakes_to) + slope)
        most = max(3.0, float(force.max()))
        more = max(0.0, (brake - 0.6 * most * skier.least_slip) / (0.5 * most))
        slip = np.minimum(skier.greatest_slip, skier.least_slip + more * np.minimum(1.0, force / most))
        slip = np.minimum(slip, skier.least_slip + math.radians(4.0) * force)
        share = np.clip((force - 0.3) / 1.2, 0.0, 1.0)
        return np.asarray(slip * np.sign(planned.force) * share**2 * (3.0 - 2.0 * share))

    def _balance(self, seen: Seen, posture: Posture, soon: float, dt: float) -> Balance:
        """Capture point, and the centre of pressure that leads it to where the plan has it."""
        gravity, height = self.gravity.normal, self.body.height
        slides = min(1.0, max(0.0, (abs(seen.slip) - BLADE) / (SLIDER - BLADE)))
        blade = self._blade.step(1.0 - (1.0 if abs(posture.edge) < BLADE else slides), dt)
        aside = float(posture.numbers[1])
        leant = height**2 / (height**2 + aside**2)
        rate = 1.0 / math.sqrt(
            self.roll_inertia * leant / (self.body.mass * gravity * height) + blade * height / gravity
        )
        if seen.bears:
            now = seen.height * (seen.across / seen.load - blade * posture.acceleration / gravity)
            self._balanced.step(now, dt)
        weights, force = np.exp(-rate * AHEAD), self._planned.force
        mean, first = float(weights @ force / weights.sum()), float(force[0])
        foreseen = (first + (mean - first) * math.exp(rate * self._since)) / math.cos(self.slip)  # the first one lasts
        share = math.tanh(soon / (0.15 * gravity))
        outer = share * (BY_EDGE - (self.skier.outer_share - 0.5) * self.stance_width)
        wanted = seen.height * foreseen / gravity + outer
        moving = seen.aside_rate if seen.lifted or not seen.bears else posture.aside_rate
        error = seen_aside(seen, posture) + moving / rate - wanted
        reach = REACH * self.stance_width / 2.0
        pressure = max(-reach, min(reach, outer + (1.0 + self.skier.leg_gain) * error))
        return Balance(self._balanced.value, wanted, error, pressure, rate)

    def _edge(self, seen: Seen, posture: Posture, soon: float) -> float:
        """Edge angle (rad) that gives the planned force, with the correction for balance."""
        mass, gravity = self.body.mass, self.gravity.normal
        asked = soon / math.cos(self.slip) + self.skier.edge_gain * gravity * self.balance.error / max(seen.height, 0.1)
        asked = max(-BOUND, min(BOUND, asked))
        if asked * self._planned.carves > LEAST_SHARE * self._planned.carves**2:
            side, lean = math.copysign(1.0, asked), abs(math.atan2(float(posture.numbers[1]), self.body.height))
            return side * max(LEAST_CARVE, lean + side * self.balance.error)
        outer = self.skier.outer_share * mass * gravity  # planned loads: measured ones would feed a bounce back
        angle = self.snow.edge(mass * abs(asked), (outer, mass * gravity - outer), self.grip)
        if abs(posture.edge) < SLIDING and self._planned.heading is None:
            angle = min(angle, max(math.radians(0.2), 2.0 * seen.slip * math.copysign(1.0, asked)))
        return math.copysign(angle, asked)

    def _learn(self, seen: Seen, posture: Posture) -> None:
        """Adjust the estimated grip to the measured side force, while the skis slide in the sense of their edges."""
        edge, dt = posture.edge, self.skier.control_period
        if not seen.bears or abs(seen.slip) < LEARNS_FROM or abs(edge) < BLADE or edge * seen.slip <= 0.0:
            return
        mean = 0.5 * (seen.edge[0] + seen.edge[1])
        expected = self.snow.force(mean, seen.left) + self.snow.force(mean, seen.right)
        found = max(0.3, min(2.5, abs(seen.across) / max(expected, 50.0)))
        self.grip += min(1.0, dt / GRIP_TIME) * (found - self.grip)

    def _yaw(self, seen: Seen, posture: Posture) -> tuple[float, float]:
        """Torque of the hips (N m) and acceleration of the shift (m/s²)."""
        torque, shift = -self._gain @ yaw_state(seen, float(posture.numbers[0]), float(posture.rates[0]))
        hip, most = seen.body_heading - seen.heading, self.skier.hip_torque
        torque = max(-most, min(most, float(torque)))
        over = hip - max(-self.skier.greatest_hip, min(self.skier.greatest_hip, hip))
        if over != 0.0:
            torque += 300.0 * over + 25.0 * (seen.body_rate - seen.turn_rate)
        if self._blade.value > 0.5 and abs(posture.edge) > math.radians(3.0):  # a blade carries the body along
            apart, turn = seen.body_heading - CARRIED * seen.heading, seen.body_rate - CARRIED * seen.turn_rate
            torque = self.body.yaw * (60.0 * apart + 12.0 * turn)
        return torque, float(shift)


def standing(seen: Seen, posture: Posture, edge: tuple[float, float]) -> Command:
    """Command that stops all joints, at edge angles (rad) of the left and right ski."""
    left, right = (float(posture.numbers[place]) for place in (LEFT_TOE, RIGHT_TOE))
    return Command(
        edge=edge,
        ahead=-HOLDS * float(posture.rates[AHEAD_OF_FEET]),
        aside=-HOLDS * posture.aside_rate,
        pressure=seen.pressure,
        toe=(left, right),
        stance=float(posture.numbers[STANCE]),
        edge_rate=8.0,
    )


def seen_aside(seen: Seen, posture: Posture) -> float:
    """Centre of mass to the left of the feet (m): as planned, as seen while a ski is lifted."""
    return seen.aside if seen.lifted or not seen.bears else float(posture.numbers[1])
