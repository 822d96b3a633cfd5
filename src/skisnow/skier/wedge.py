"""Wedge to a stop: toe-in from the brake that is needed, and a regulator over hips, edges and the load's place."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from scipy.linalg import solve_continuous_are

from .._support.arrays import FloatArray
from ..scenario.skier import Skier
from .control import AIR, FIRST_GRIP, FORCE_TIME, ROLLING, STOPPED, Balance, Smoothed, standing
from .edges import ForceMap
from .plan import Gravity
from .posture import AHEAD, ASIDE, LEFT_EDGE, RIGHT_EDGE, RIGHT_TOE, STANCE, Command, Posture
from .seen import Seen
from .yaw import Body

PREFERRED_TOE, GREATEST_TOE = math.radians(25.0), math.radians(30.0)
"""Toe-in of a ski: with more of it edges are flatter and grip less by accident; and its limit (rad)."""
GREATEST_EDGE: Final = math.radians(45.0)
"""Edge angle of a wedge (rad)."""
BRAKE, SHARE_OF_BRAKE = 1.5, 0.4
"""Deceleration wanted (m/s²), at most this share of that with the greatest toe-in and edge (modelling assumptions)."""
SLOW: Final = 1.0
"""Speed (m/s) below which it brakes less, down to 30 %."""
MORE_EDGE: Final = 0.4
"""Share by which the edges grow once it stands."""
TIP, BETWEEN_TIPS = 0.72, 0.1
"""From boot to tip, and between the tips (m)."""
OPENS_WITH: Final = 1.1
"""Force of a ski while the wedge opens, over that at the preferred toe-in: more makes it grip at a small toe-in."""
GATE = math.radians(6.0), math.radians(11.0)
"""Toe-in (rad) from which the edges differ, and from which in full."""
SCALES = (1.5, 0.7, 0.15, 1.0, 0.5, 2.0, 0.06, 0.4)
"""Errors that cost alike: place aside (m), its rate (m/s), skis and body (rad, rad/s), load (m, m/s)."""
COSTS, HIPS = (60.0, 40.0, 3.0), 0.35
"""Inputs that cost alike: difference of the edges' forces (N), hips (N m), the load (m/s²); and the hip angle (rad)."""
PIVOTED, DAMPING = 1.3, 3.0
"""Yaw inertia of the skis (kg m²), and the damping of their yaw (N m s) (modelling assumptions)."""
BY_EDGES: Final = 0.7
"""Gain of the edges on the error of balance."""
GRIP_TIME: Final = 0.3
"""Over which the grip is learnt (s)."""
SOLVED_EVERY: Final = 8
"""Periods between two solutions of the regulator."""


@dataclass(slots=True)
class WedgeControl:
    """A wedge that brakes to a stop down the fall line; `grip` is measured over computed force of the snow.

    Source: The page docs/methods/skier.md.
    """

    skier: Skier
    snow: ForceMap
    body: Body
    roll_inertia: float
    stance_width: float
    gravity: Gravity
    grip: float = FIRST_GRIP
    balance: Balance = field(default_factory=lambda: Balance(0.0, 0.0, 0.0, 0.0, 1.0))
    _force: Smoothed = field(default_factory=lambda: Smoothed(2.0 * FORCE_TIME))
    _balanced: Smoothed = field(default_factory=lambda: Smoothed(0.4 * FORCE_TIME))
    _shift: Smoothed = field(default_factory=lambda: Smoothed(1.3 * FORCE_TIME))
    _load: list[float] = field(default_factory=lambda: [0.0, 0.0])  # place to the left (m) and its rate
    _gain: FloatArray = field(default_factory=lambda: np.zeros((3, 8)))
    _calls: int = 0
    _start_aside: float | None = None
    _held_edges: tuple[float, float] | None = None

    def command(self, seen: Seen, posture: Posture, dt: float) -> Command:
        """Command to the body for the next `dt` (s), so that the wedge brakes to a stop."""
        if self._start_aside is None:
            self._start_aside = seen.place[1]
        if seen.speed < STOPPED or (self._held_edges is not None and seen.speed < 3.0 * STOPPED):
            return self._stand(seen, posture)
        self._held_edges = None
        toe, force, wanted = self._opened(seen, posture)
        self._learn(seen, toe, dt)
        difference, torque = self._regulate(seen, posture, toe, force, dt)
        self._balance(seen, posture, toe, difference, dt)
        edges = self._edges(toe, force, difference)
        self._shift.step(max(-0.25, min(0.25, seen.height * seen.along / max(seen.load, 100.0))), dt)
        shift = 100.0 * (self._shift.value - float(posture.numbers[AHEAD])) - 20.0 * float(posture.rates[AHEAD])
        return Command(
            edge=edges,
            hip_torque=torque,
            ahead=max(-12.0, min(12.0, shift)),
            aside=self.balance.rate**2
            * (float(posture.numbers[ASIDE]) - self.balance.balanced - self.balance.pressure),
            pressure=self.balance.pressure,
            toe=(-wanted, wanted),
            stance=max(self.stance_width, 2.0 * TIP * math.sin(max(toe, wanted)) + BETWEEN_TIPS),
        )

    def _stand(self, seen: Seen, posture: Posture) -> Command:
        """Command that stops all joints, with the edges a little steeper."""
        if self._held_edges is None:
            self._held_edges = float(posture.numbers[LEFT_EDGE]), float(posture.numbers[RIGHT_EDGE])
        more = 0.5 * MORE_EDGE * (self._held_edges[1] - self._held_edges[0])
        return standing(seen, posture, (self._held_edges[0] - more, self._held_edges[1] + more))

    def _held_by(self, edge: float) -> float:
        """Force (N) that the snow can exert on one ski at an edge angle (rad)."""
        return self.grip * self.snow.force(edge, 0.5 * self.body.mass * self.gravity.normal)

    def _opened(self, seen: Seen, posture: Posture) -> tuple[float, float, float]:
        """Toe-in now (rad), force of one ski (N) and toe-in to move to (rad)."""
        mass, slope = self.body.mass, self.gravity.down - ROLLING * self.gravity.normal - AIR * seen.speed**2
        most = self._held_by(GREATEST_EDGE)
        brake = min(BRAKE, SHARE_OF_BRAKE * max(0.0, 2.0 * math.sin(GREATEST_TOE) * most / mass - slope))
        needed = mass * max(0.0, slope + brake * min(1.0, max(0.3, seen.speed / SLOW)))
        preferred = max(self._held_by(math.radians(3.0)), min(most, needed / (2.0 * math.sin(PREFERRED_TOE))))
        wanted = min(GREATEST_TOE, math.asin(min(0.95, needed / (2.0 * preferred))))
        toe = float(posture.numbers[RIGHT_TOE])
        wanted = max(wanted, toe) if seen.speed < SLOW else wanted  # it does not close while it comes to rest
        force = max(20.0, min(most, needed / (2.0 * math.sin(max(toe, 0.1)))))
        if toe < 0.9 * wanted:
            force = min(force, OPENS_WITH * preferred)
        return toe, force * min(1.0, (toe / 0.12) ** 2), wanted

    def _learn(self, seen: Seen, toe: float, dt: float) -> None:
        """Adjust the estimated grip of the snow to the measured deceleration."""
        if not seen.bears or toe < 0.12 or seen.speed < SLOW:
            return
        expected = self.snow.force(seen.edge[0], seen.left) + self.snow.force(seen.edge[1], seen.right)
        found = (-seen.along - ROLLING * seen.load) / max(expected * math.sin(toe), 30.0)
        self.grip += dt / GRIP_TIME * (max(0.4, min(2.0, found)) - self.grip)

    def _regulate(self, seen: Seen, posture: Posture, toe: float, force: float, dt: float) -> tuple[float, float]:
        """Side force of the left edge less the right one (N), and hip torque (N m); also shifts the load sideways."""
        if self._calls % SOLVED_EVERY == 0:
            brake = max(20.0, 2.0 * force * math.sin(toe))
            self._gain = regulator(self.body, brake, float(posture.numbers[STANCE]), max(toe, 0.05))
        self._calls += 1
        off = max(-0.4, min(0.4, seen.place[1] - (self._start_aside or 0.0)))
        way = seen.speed * math.sin(seen.course)
        state = np.array(
            [off, way, seen.heading, seen.turn_rate, seen.body_heading, seen.body_rate, self._load[0], self._load[1]]
        )
        inputs = -self._gain @ state
        open_ = min(1.0, max(0.0, (toe - GATE[0]) / (GATE[1] - GATE[0])))
        open_ *= open_ * (3.0 - 2.0 * open_)
        moved = float(inputs[2]) if open_ > 0.5 else -20.0 * self._load[0] - 9.0 * self._load[1]
        rate = max(-0.8, min(0.8, self._load[1] + dt * max(-12.0, min(12.0, moved))))
        most = 0.25 * float(posture.numbers[STANCE])
        place = self._load[0] + rate * dt
        self._load = [place, rate] if abs(place) < most else [math.copysign(most, place), 0.0]
        torque = max(-self.skier.hip_torque, min(self.skier.hip_torque, float(inputs[1])))
        return open_ * max(-1.7 * force, min(1.7 * force, float(inputs[0]))), torque

    def _balance(self, seen: Seen, posture: Posture, toe: float, difference: float, dt: float) -> None:
        """Update the balance sideways: capture point of the body, and centre of pressure that brings it back."""
        gravity, height = self.gravity.normal, self.body.height
        blade = max(0.0, min(1.0, 1.5 - seen.speed / 0.5))
        rate = 1.0 / math.sqrt(self.roll_inertia / (self.body.mass * gravity * height) + blade * height / gravity)
        if seen.bears:
            aside = seen.across / max(seen.load, 100.0) - blade * posture.acceleration / gravity
            self._balanced.step(seen.height * aside, dt)
        pushed = self._force.step(-math.cos(toe) * difference, dt)
        wanted = seen.height * pushed / (self.body.mass * gravity) + self._load[0]
        error = float(posture.numbers[ASIDE]) + posture.aside_rate / rate - wanted
        reach = 0.85 * float(posture.numbers[STANCE]) / 2.0
        pressure = max(-reach, min(reach, self._load[0] + (1.0 + self.skier.leg_gain) * error))
        self.balance = Balance(self._balanced.value, wanted, error, pressure, rate)

    def _edges(self, toe: float, force: float, difference: float) -> tuple[float, float]:
        """Edge angles (rad) that give the force, its difference and what balance asks for besides."""
        full = min(1.0, max(0.0, (toe - GATE[0]) / (GATE[1] - GATE[0])))
        push = BY_EDGES * self.body.mass * self.gravity.normal * self.balance.error / self.body.height
        difference = max(-1.9 * force, min(1.9 * force, difference - full * push / math.cos(toe)))
        load = 0.5 * self.body.mass * self.gravity.normal
        side = self.balance.pressure / self.stance_width
        loads = load * max(0.3, 1.0 + 2.0 * side), load * max(0.3, 1.0 - 2.0 * side)
        found = [
            min(GREATEST_EDGE, self.snow.edge(max(0.0, each), (n,), self.grip))
            for each, n in zip((force + 0.5 * difference, force - 0.5 * difference), loads, strict=True)
        ]
        return -found[0], found[1]


def regulator(body: Body, brake: float, stance: float, toe: float) -> FloatArray:
    """Gain (3, 8): minus its product with the state are difference of forces, hip torque and the load's acceleration.

    State: place aside, yaw of skis and body, place of the load, each with its rate.
    """
    sin, cos = math.sin(toe), math.cos(toe)
    a, b = np.zeros((8, 8)), np.zeros((8, 3))
    for place in (0, 2, 4, 6):
        a[place, place + 1] = 1.0
    a[1, 2], a[3, 3], a[5, 6] = -brake / body.mass, -DAMPING / PIVOTED, -brake / body.yaw
    b[1, 0] = -cos / body.mass
    b[3, 0], b[3, 1] = 0.5 * stance * sin / PIVOTED, 1.0 / PIVOTED
    b[5, 1], b[7, 2] = -1.0 / body.yaw, 1.0
    cost = np.diag([1.0 / each**2 for each in SCALES])
    cost[np.ix_((2, 4), (2, 4))] += np.array([[1.0, -1.0], [-1.0, 1.0]]) / HIPS**2
    inputs = np.diag([1.0 / each**2 for each in COSTS])
    return np.asarray(np.linalg.solve(inputs, b.T @ solve_continuous_are(a, b, cost, inputs)))
