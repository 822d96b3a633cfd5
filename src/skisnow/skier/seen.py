"""State that a skier measures: lean, loads, speed, slip, from the moments of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from .._support.arrays import FloatArray, cross
from ..scenario.terrain import down_and_left

BEARING: Final = 0.2
"""Share of the weight below which the loads tell nothing (modelling assumption: a leap has all but begun)."""
LIFTED: Final = 0.02
"""Share of the load below which a ski counts as lifted (modelling assumption)."""
FARTHEST: Final = 0.4
"""Greatest distance of a centre of pressure aside that is believed (m) (modelling assumption)."""


class Moment(Protocol):
    """The used attributes of a `skisnow.BootMoment`."""

    @property
    def time(self) -> float: ...  # noqa: D102
    @property
    def until(self) -> float: ...  # noqa: D102
    @property
    def position(self) -> FloatArray: ...  # noqa: D102
    @property
    def rotation(self) -> FloatArray: ...  # noqa: D102
    @property
    def velocity(self) -> FloatArray: ...  # noqa: D102
    @property
    def boots(self) -> FloatArray: ...  # noqa: D102
    @property
    def wrench(self) -> FloatArray: ...  # noqa: D102


@dataclass(frozen=True, slots=True)
class Seen:
    """Observation, in axes along the mean ski, to its left and out of the snow; angles are positive to the left.

    Attributes
    ----------
    time
        (s).
    aside, aside_rate, ahead, ahead_rate, height
        Offset of the centre of mass from the middle of the feet: to the left and ahead (m), their rates (m/s), above.
    pressure
        How far the centre of pressure is to the left of that middle (m); 0 where nothing bears.
    left, right
        Loads of the skis (N).
    across, along
        Force of the snow to the left and ahead (N).
    moment
        Moment of the snow on both boots about the normal (N m).
    place, speed, course
        Centre of mass: x, y (m), (m/s), heading of its path from the fall line (rad).
    feet, feet_speed, feet_course
        The same of the middle of the feet.
    heading, turn_rate, slip
        Skis: from the fall line (rad), its rate (rad/s), heading less the course of the feet (rad).
    body_heading, body_rate, yaw_inertia
        Body: from the fall line (rad), its rate (rad/s), moment of inertia (kg m²).
    edge
        Edge angles of the left and the right ski against the snow (rad).
    bears, lifted
        True if the loads contain information, and True if one ski is off the snow.
    """

    time: float
    aside: float
    aside_rate: float
    ahead: float
    ahead_rate: float
    height: float
    pressure: float
    left: float
    right: float
    across: float
    along: float
    moment: float
    place: tuple[float, float]
    speed: float
    course: float
    feet: tuple[float, float]
    feet_speed: float
    feet_course: float
    heading: float
    turn_rate: float
    slip: float
    body_heading: float
    body_rate: float
    yaw_inertia: float
    edge: tuple[float, float]
    bears: bool
    lifted: bool

    @property
    def load(self) -> float:
        """Load of both skis (N)."""
        return self.left + self.right


def seen_at(
    moment: Moment, centre_of_mass: tuple[float, float], normal: FloatArray, weight: float, yaw_inertia: float
) -> Seen:
    """State that the skier measures at a moment.

    moment: moment of the run.
    centre_of_mass: in the body: ahead and up (m).
    normal: normal of the snow, (3,).
    weight: weight of the skier (N).
    yaw_inertia: moment of inertia of the body (kg m²).
    """
    rotation, boots, spin = moment.rotation, moment.boots, moment.velocity[3:]
    up = normal @ rotation
    mean = 0.5 * (boots[0] + boots[1])
    ahead = mean[1]
    ahead = ahead - (ahead @ up) * up
    ahead /= math.hypot(*ahead.tolist())
    left = cross(up, ahead)
    force, turning = (
        np.einsum("kca,kc->ka", boots[:, 1:4], part) for part in (moment.wrench[:, :3], moment.wrench[:, 3:])
    )
    middle = mean[0]
    centre = np.array([centre_of_mass[0], 0.0, centre_of_mass[1]])
    leg = centre - middle
    leg_rate = cross(spin, leg) - mean[4]
    loads, total = force @ up, force.sum(axis=0)
    load = float(loads.sum())
    twist = (cross(boots[:, 0] - middle, force) + turning).sum(axis=0)
    bears = load > BEARING * weight
    down, aside = (each @ rotation for each in down_and_left(normal))
    way = moment.velocity[:3] + cross(spin, centre)
    step = way - leg_rate  # velocity of the feet
    course = math.atan2(step @ aside, step @ down)
    heading = math.atan2(ahead @ aside, ahead @ down)
    place, foot = moment.position + rotation @ centre, moment.position + rotation @ middle
    lean = math.atan2(leg @ left, leg @ up)
    hip = math.atan2(math.cos(lean) * left[0] - math.sin(lean) * up[0], ahead[0])
    return Seen(
        time=moment.time,
        aside=float(leg @ left),
        aside_rate=float(leg_rate @ left),
        ahead=float(leg @ ahead),
        ahead_rate=float(leg_rate @ ahead),
        height=float(leg @ up),
        pressure=max(-FARTHEST, min(FARTHEST, float(twist @ ahead) / load)) if bears else 0.0,
        left=float(loads[0]),
        right=float(loads[1]),
        across=float(total @ left),
        along=float(total @ ahead),
        moment=float(twist @ up),
        place=(float(place[0]), float(place[1])),
        speed=math.hypot(way @ down, way @ aside),
        course=math.atan2(way @ aside, way @ down),
        feet=(float(foot[0]), float(foot[1])),
        feet_speed=math.hypot(step @ down, step @ aside),
        feet_course=course,
        heading=heading,
        turn_rate=float((spin + mean[5]) @ up),
        slip=math.remainder(heading - course, 2.0 * math.pi),
        body_heading=heading + hip,
        body_rate=float(spin @ up),
        yaw_inertia=yaw_inertia,
        edge=(_edge(boots[0], up), _edge(boots[1], up)),
        bears=bears,
        lifted=bears and bool(loads.min() < LIFTED * load),
    )


def _edge(boot: FloatArray, up: FloatArray) -> float:
    return math.atan2(-float(boot[2] @ up), float(boot[3] @ up))
