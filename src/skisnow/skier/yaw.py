"""Yaw of skis and body: a time-varying linear-quadratic regulator over hip torque and the shift of the load."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .plan import STEP, Planned
from .posture import YIELDING_INERTIA
from .seen import Seen

SHEAR_SHIFT: Final = 0.46
"""Shift of the force across the skis over that of the load along them, measured over the snow of the race piste."""
SKI_INERTIA: Final = 1.2
"""Yaw inertia of both skis about the hips (kg m²) (measured by the moment on the boots); the legs give way besides."""
FRICTION_ARM: Final = 2.4
"""Yaw moment of the friction on the loaded outer ski (N m) (modelling assumption)."""
LEANT: Final = 40.0
"""Yaw moment on the body over its lean aside (N m/m) (modelling assumption)."""
GREATEST_MOMENT: Final = 30.0
"""Of what else turns the body (N m) (modelling assumption)."""
SLIP, HIPS, BODY_RATE, TORQUE, SHIFT, SHIFT_ACCELERATION, BODY = 0.06, 0.8, 6.0, 100.0, 0.12, 25.0, 0.4
"""Errors that cost alike: slip, hip angle (rad), body rate (rad/s), hip torque (N m), shift (m), its acceleration
(m/s²) and body heading (rad) (found by trial)."""
FACES_DOWN: Final = math.radians(35.0)
"""Course up to which the body faces down the slope, as the snow can hardly turn skis and body together; beyond it the
body turns along (rad) (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class Body:
    """Body of a skier: mass (kg), pitch and yaw inertia (kg m²), height of its centre of mass over the snow (m)."""

    mass: float
    pitch: float
    yaw: float
    height: float


def heading_ahead(planned: Planned, slip: FloatArray, gravity: float, height: float, speed: float) -> FloatArray:
    """Heading of the skis (rad) with a slip (rad) against the path of the feet, which swing out under the body."""
    if planned.heading is not None:
        return np.full(len(planned.force), planned.heading)
    swing = _rate(height / gravity * planned.force)
    return np.asarray(planned.course + slip - swing / max(speed, 2.0))


def yaw_gain(
    planned: Planned, heading: FloatArray, slip: FloatArray, body: Body, gravity: float, speed: float
) -> FloatArray:
    """Gain (2, 7): torque of the hips (N m) and acceleration of the shift (m/s²) are minus its product with the state.

    The state is that of `yaw_state`. Riccati's equation is solved backwards over the plan.
    """
    side = _rate(heading)
    aside = body.height * planned.force / gravity
    leant = (aside / np.hypot(aside, body.height)) ** 2
    turns = -_rate(body.pitch * side * leant) - FRICTION_ARM * np.tanh(planned.force / 2.0) - LEANT * aside
    turns = np.clip(turns, -GREATEST_MOMENT, GREATEST_MOMENT)
    force = body.mass * planned.force
    damping = 0.5 * np.minimum(40.0, 0.245 * np.abs(force) / (max(speed, 2.0) * np.maximum(np.abs(slip), 0.15)))
    eager = np.minimum(1.0, np.abs(planned.force) / 1.962) + 0.1
    step = _dynamics(force, turns, damping, body.yaw)
    costs = _costs(eager / SLIP**2, heading, planned.course - np.clip(planned.course, -FACES_DOWN, FACES_DOWN))
    ahead, gain, inverse, dot = 5.0 * costs[-1, :7, :7], np.zeros((2, 7)), np.empty((2, 2)), np.dot
    for cost, onward, back in zip(costs[::-1], step[::-1], step.transpose(0, 2, 1)[::-1], strict=True):
        both = dot(dot(back, ahead), onward)
        both += cost
        towards, (own, mixed, _, other) = both[7:, :7], both[7:, 7:].ravel().tolist()
        determinant = own * other - mixed**2
        inverse[0] = other / determinant, -mixed / determinant
        inverse[1] = -mixed / determinant, own / determinant
        gain = dot(inverse, towards)
        ahead = both[:7, :7] - dot(towards.T, gain)
    return gain


def _rate(values: FloatArray) -> FloatArray:
    """Rate of values at the moments of a plan, by central differences, three times faster than `numpy.gradient`."""
    rate = np.empty(len(values))
    rate[1:-1] = (values[2:] - values[:-2]) / (2.0 * STEP)
    rate[0], rate[-1] = (values[1] - values[0]) / STEP, (values[-1] - values[-2]) / STEP
    return rate


def yaw_state(seen: Seen, ahead: float, ahead_rate: float) -> FloatArray:
    """Heading of skis and body and their rates by turns, the shift and its rate, and 1."""
    skis, body = (math.remainder(each, 2.0 * math.pi) for each in (seen.heading, seen.body_heading))
    return np.array([skis, seen.turn_rate, body, seen.body_rate, ahead, ahead_rate, 1.0])


def _dynamics(force: FloatArray, turns: FloatArray, damping: FloatArray, inertia: float) -> FloatArray:
    """State after each step over state and inputs, (steps, 7, 9).

    The inertia with which hips give way counts twice: the body gets the moment that turns it.
    """
    rates, whole = np.zeros((len(force), 7, 9)), SKI_INERTIA + YIELDING_INERTIA
    rates[:, [0, 2, 4], [1, 3, 5]] = 1.0
    rates[:, 1, 4], rates[:, 1, 7] = SHEAR_SHIFT * force / whole, 1.0 / whole
    rates[:, 1, 1] = -np.minimum(1.0 / STEP, damping / whole)
    rates[:, 3] = YIELDING_INERTIA / inertia * rates[:, 1]
    rates[:, 3, 4] -= force / inertia
    rates[:, 3, 6], rates[:, 5, 8] = turns / inertia, 1.0
    rates[:, 3, 7] -= 1.0 / inertia
    rates[:, 0:5:2] += 0.5 * STEP * rates[:, 1:6:2]
    return np.eye(7, 9) + STEP * rates


def _costs(slip: FloatArray, heading: FloatArray, facing: FloatArray) -> FloatArray:
    """Cost of state and inputs at each step, (steps, 9, 9): the weight of the slip, headings of skis and body (rad)."""
    hips, body = 1.0 / HIPS**2, 1.0 / BODY**2
    q = np.zeros((len(slip), 9, 9))
    q[:, 0, 0], q[:, 2, 2] = slip + hips, hips + body
    q[:, 0, 2] = q[:, 2, 0] = -hips
    q[:, 0, 6] = q[:, 6, 0] = -slip * heading
    q[:, 2, 6] = q[:, 6, 2] = -body * facing
    q[:, 6, 6] = slip * heading**2 + body * facing**2
    q[:, [3, 4, 7, 8], [3, 4, 7, 8]] = [1.0 / each**2 for each in (BODY_RATE, SHIFT, TORQUE, SHIFT_ACCELERATION)]
    return q
