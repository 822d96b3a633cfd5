"""State that a skier measures: lean, loads, speed, slip, from the moments of a run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

import numpy as np

from .._support.arrays import FloatArray
from ..geometry.vectors import Vector, combined, cross, minus, plus, times, unit

BEARING: Final = 0.2
"""Share of the weight below which the loads tell nothing (modelling assumption: a leap has all but begun)."""
LIFTED: Final = 0.02
"""Share of the load below which a ski counts as lifted (modelling assumption)."""
FARTHEST: Final = 0.4
"""Greatest distance of a centre of pressure aside that is believed (m) (modelling assumption)."""


class Moment(Protocol):
    """The used attributes of a `skisnow.BootMoment`."""

    @property
    def time(self) -> float:
        """Present time (s)."""

    @property
    def until(self) -> float:
        """Time (s) at which the boots reach their target; `time` at the start."""

    @property
    def position(self) -> FloatArray:
        """Origin of the sledge in space (m), shape (3,)."""

    @property
    def rotation(self) -> FloatArray:
        """Axes of the sledge as columns, shape (3, 3)."""

    @property
    def velocity(self) -> FloatArray:
        """Velocity (m/s) and angular velocity (rad/s) in axes of the sledge, shape (6,)."""

    @property
    def boots(self) -> FloatArray:
        """Pose of each boot against the sledge: place, axes and velocities, shape (2, 6, 3)."""

    @property
    def wrench(self) -> FloatArray:
        """Force (N) and moment (N m) of each ski on its boot, in its axes, shape (2, 6)."""


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
    moment, pitching
        Moment of the snow on both boots about the normal, and on the body backwards about its centre of mass (N m).
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
    pitch
        Of the skis against the snow, tips up (rad).
    clearance, nearing, falls_with
        In the air: height of the feet over the snow (m), speed of the centre of mass towards it, now and at the landing
        (m/s); else 0.
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
    pitch: float = 0.0
    pitching: float = 0.0
    clearance: float = 0.0
    nearing: float = 0.0
    falls_with: float = 0.0

    @property
    def flies(self) -> bool:
        """True in the air."""
        return self.clearance > 0.0

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
    surface, position = _surface_axes(normal.tolist()), moment.position.tolist()
    frame = moment.rotation if surface is LEVEL else np.array(surface) @ moment.rotation
    boots = moment.boots @ frame.T  # these and the vectors below: down the slope, to the left, off the snow
    (force, twist), (force_right, twist_right) = (moment.wrench.reshape(2, 2, 3) @ boots[:, 1:4]).tolist()
    (forward, _, upward), (moved, spin) = frame.T.tolist(), (moment.velocity.reshape(2, 3) @ frame.T).tolist()
    middle, direction, *_, rate, turning = (0.5 * (boots[0] + boots[1])).tolist()
    centre = plus(times(centre_of_mass[0], forward), times(centre_of_mass[1], upward))
    leg = minus(centre, middle)
    leg_rate, way = minus(cross(spin, leg), rate), plus(moved, cross(spin, centre))
    step = minus(way, leg_rate)  # velocity of the feet
    place, foot = (plus(position, combined(each, surface)) for each in (centre, middle))
    heading, course = (math.atan2(each[1], each[0]) for each in (direction, step))
    cosine, sine = math.cos(heading), math.sin(heading)
    left_boot, right_boot = boots.tolist()
    half = minus(left_boot[0], middle)  # from the middle to the left boot
    both = plus(cross(half, minus(force, force_right)), plus(twist, twist_right))
    (ahead, aside), (ahead_rate, aside_rate), (along, across), (rolling, tilting), (body_ahead, body_left) = (
        (cosine * each[0] + sine * each[1], cosine * each[1] - sine * each[0])
        for each in (leg, leg_rate, plus(force, force_right), both, forward)
    )
    left, right, height = force[2], force_right[2], leg[2]
    load, length = left + right, math.hypot(aside, height)
    bears = load > BEARING * weight
    return Seen(
        time=moment.time,
        aside=aside,
        aside_rate=aside_rate,
        ahead=ahead,
        ahead_rate=ahead_rate,
        height=height,
        pressure=max(-FARTHEST, min(FARTHEST, rolling / load)) if bears else 0.0,
        left=left,
        right=right,
        across=across,
        along=along,
        moment=both[2],
        place=(place[0], place[1]),
        speed=math.hypot(way[0], way[1]),
        course=math.atan2(way[1], way[0]),
        feet=(foot[0], foot[1]),
        feet_speed=math.hypot(step[0], step[1]),
        feet_course=course,
        heading=heading,
        turn_rate=spin[2] + turning[2],
        slip=math.remainder(heading - course, 2.0 * math.pi),
        body_heading=heading + math.atan2((height * body_left - aside * forward[2]) / length, body_ahead),
        body_rate=spin[2],
        yaw_inertia=yaw_inertia,
        edge=(math.atan2(-left_boot[2][2], left_boot[3][2]), math.atan2(-right_boot[2][2], right_boot[3][2])),
        bears=bears,
        lifted=bears and min(left, right) < LIFTED * load,
        pitching=height * along - load * ahead - tilting,
        pitch=math.asin(max(-1.0, min(1.0, direction[2]))),
    )


LEVEL: Final = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
"""Axes of a level surface."""


def _surface_axes(normal: Vector) -> Sequence[Vector]:
    """Unit vectors of a surface with this normal: towards x as seen from above, to the left, off it."""
    if normal[2] == 1.0:
        return LEVEL
    down = unit((normal[2], 0.0, -normal[0]))
    return down, cross(normal, down), normal
