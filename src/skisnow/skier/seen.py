"""State that a skier measures: lean, loads, speed, slip, from the moments of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Protocol

from .._support.arrays import FloatArray
from ..geometry.vectors import Vector, applied, combined, cross, dot, minus, plus, times, unit

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
    rotation, spin = moment.rotation.tolist(), moment.velocity[3:].tolist()
    boots, wrench = moment.boots.tolist(), moment.wrench.tolist()
    upright = normal.tolist()
    up = combined(upright, rotation)
    middle, direction, rate, turning = (times(0.5, plus(boots[0][i], boots[1][i])) for i in (0, 1, 4, 5))
    tilt = dot(direction, up)
    ahead = unit(minus(direction, times(tilt, up)))
    left = cross(up, ahead)
    forces, moments = ([combined(wrench[k][i : i + 3], boots[k][1:4]) for k in (0, 1)] for i in (0, 3))
    centre = (centre_of_mass[0], 0.0, centre_of_mass[1])
    leg = minus(centre, middle)
    leg_rate = minus(cross(spin, leg), rate)
    loads, total = [dot(force, up) for force in forces], plus(*forces)
    load = loads[0] + loads[1]
    half = minus(boots[0][0], middle)  # from the middle to the left boot
    twist = plus(cross(half, minus(*forces)), plus(*moments))
    bears = load > BEARING * weight
    down, aside = (combined(each, rotation) for each in _down_and_left(upright))
    way = plus(moment.velocity[:3].tolist(), cross(spin, centre))
    step = minus(way, leg_rate)  # velocity of the feet
    feet, mass = (dot(step, down), dot(step, aside)), (dot(way, down), dot(way, aside))
    course = math.atan2(feet[1], feet[0])
    heading = math.atan2(dot(ahead, aside), dot(ahead, down))
    position = moment.position.tolist()
    place, foot = (plus(position, applied(rotation, each)) for each in (centre, middle))
    lean = math.atan2(dot(leg, left), dot(leg, up))
    hip = math.atan2(math.cos(lean) * left[0] - math.sin(lean) * up[0], ahead[0])
    return Seen(
        time=moment.time,
        aside=dot(leg, left),
        aside_rate=dot(leg_rate, left),
        ahead=dot(leg, ahead),
        ahead_rate=dot(leg_rate, ahead),
        height=dot(leg, up),
        pressure=max(-FARTHEST, min(FARTHEST, dot(twist, ahead) / load)) if bears else 0.0,
        left=loads[0],
        right=loads[1],
        across=dot(total, left),
        along=dot(total, ahead),
        moment=dot(twist, up),
        place=(place[0], place[1]),
        speed=math.hypot(*mass),
        course=math.atan2(mass[1], mass[0]),
        feet=(foot[0], foot[1]),
        feet_speed=math.hypot(*feet),
        feet_course=course,
        heading=heading,
        turn_rate=dot(plus(spin, turning), up),
        slip=math.remainder(heading - course, 2.0 * math.pi),
        body_heading=heading + hip,
        body_rate=dot(spin, up),
        yaw_inertia=yaw_inertia,
        edge=(_edge(boots[0], up), _edge(boots[1], up)),
        bears=bears,
        lifted=bears and min(loads) < LIFTED * load,
        pitching=dot(leg, up) * dot(total, ahead) - load * dot(leg, ahead) - dot(twist, left),
        pitch=math.asin(max(-1.0, min(1.0, tilt))),
    )


def _edge(boot: list[Vector], up: Vector) -> float:
    """Edge angle (rad) of one boot, given by position, axes ahead, left and up, and two rates."""
    return math.atan2(-dot(boot[2], up), dot(boot[3], up))


def _down_and_left(normal: Vector) -> tuple[Vector, Vector]:
    """Unit vectors in the surface with this normal: towards x as seen from above, and to the left."""
    down = unit((normal[2], 0.0, -normal[0]))
    return down, cross(normal, down)
