"""Posture of a skier over its skis, the limits of its joints, and the boot poses that follow from it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from numbers import Real
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import STANDARD_GRAVITY
from ..dynamics import BootPose
from ..geometry.vectors import Vector, axis_rows, combined, cross, minus, plus, times
from ..scenario.skier import Skier
from .seen import Seen

AHEAD, ASIDE, HIP, LEFT_EDGE, RIGHT_EDGE, LEFT_TOE, RIGHT_TOE, STANCE, RISE, PITCH = range(10)
"""Places in the numbers of a posture."""
BLUNT: Final = math.sin(math.radians(3.0))
"""Sine of the edge angle below which a ski counts as flat for its lift (modelling assumption)."""
MOMENT_TIME: Final = 0.01
"""Time (s) over which the snow's moment on the boots is smoothed (modelling assumption)."""
GREATEST_TURN: Final = 120.0
"""Greatest acceleration of the hip angle (rad/s²): keeps a shock of the snow out of the body (modelling assumption)."""
FASTEST_EDGE: Final = 7.0
"""Greatest rate of the edge angle, 400 °/s (rad/s) (modelling assumption)."""
TOUCH: Final = 20.0
"""Rate (1/s) at which a lifted ski is put down (modelling assumption)."""
OPENING: Final = 6.0
"""Corner frequency (1/s) of toe-in and stance (modelling assumption)."""
YIELDING_INERTIA: Final = 1.5
"""Inertia (kg m²) with which the skis give way to the snow about the hips (found by trial)."""
PITCHING_INERTIA: Final = 6.0
"""Inertia (kg m²) over the square of the sine of the lean, added in the hips: skis that turn under a leaning body pitch
it and move the load along them, which takes as much from their own (measured: 0.8 of the body's pitch inertia)."""
HIP_DAMPING: Final = 200.0
"""Hips' damping over the fourth power of the sine of the lean (N m s) (found by trial)."""
DAMPING: Final = 3e3
"""Of one leg that gives way to a load that it is not to bear (N s/m): snow under edged skis, some 2 · 10⁵ N/m, and the
body swing with it at a third of the critical damping."""
DAMPED_FROM: Final = math.radians(5.0)
"""Edge angle from which legs give way in full; the snow under flat skis is too stiff for it (derived: its stiffness
times the control's period over the damping is to stay below 1)."""
PITCH_DAMPING: Final = 700.0
"""Of ankles that give way to the snow (N m s): a body of 7.4 kg m² that rocks with 10 Hz on edged skis, at a third of
the critical damping."""
SETTLING, FASTEST_RISE = 3.0, 0.5
"""Rate (1/s) at which height and ankles go back to their own, and the height's greatest speed (m/s) (modelling
assumptions)."""
APPROACH: Final = 6.0 - math.sqrt(32.0)
"""Share of their clearance by which the skis near the snow in a period (derived: the most without an overshoot, since
half of a period's rate acts in the next)."""
LANDED: Final = 0.05
"""How much shorter than usual legs are when a landing is over (m) (modelling assumption)."""
ANKLES, LEVELS = math.radians(25.0), 25.0
"""Greatest pitch of skis against the body (rad), and its corner frequency in the air (1/s) (modelling assumptions)."""
FASTEST_SHIFT: Final = 25.0
"""Greatest acceleration of the centre of mass along the skis (m/s²) (found by trial: with 60 the loads peak)."""


@dataclass(frozen=True, slots=True)
class Command:
    """Command of a control to the body for the next period; angles in rad, positive to the left.

    Attributes
    ----------
    edge
        Edge angles of the left and the right ski that the body moves to.
    hip_torque
        That turns the skis against the body (N m); None: the hips are held.
    ahead
        Acceleration of the centre of mass along the skis (m/s²).
    aside
        Acceleration of the centre of mass to the left of the feet (m/s²).
    pressure
        Target of the centre of pressure, left of the feet's middle (m), which the legs yield towards.
    load
        Target load on both legs together (N), which legs and ankles yield towards; None: both are stiff.
    toe
        Angle of the left and the right ski from their mean heading.
    stance
        Distance of the boots (m); None: that of the sledge.
    edge_rate
        Corner frequency of the edge angle (1/s); None: the skier's.
    """

    edge: tuple[float, float]
    hip_torque: float | None = None
    ahead: float = 0.0
    aside: float = 0.0
    pressure: float = 0.0
    load: float | None = None
    toe: tuple[float, float] = (0.0, 0.0)
    stance: float | None = None
    edge_rate: float | None = None


def require_command(command: object, time: float) -> None:
    """Raise ParameterError unless a controller returned, at a time (s), a command of finite numbers."""
    if not isinstance(command, Command):
        raise ParameterError("at {time:g} s the controller returned a {kind}; return a skisnow.skier.Command").tag(
            "wrong_kind", time=time, kind=type(command).__name__
        )
    for each in fields(command):
        value, shape = getattr(command, each.name), (2,) if each.name in {"edge", "toe"} else ()
        if value is None and each.default is None:
            continue
        if np.shape(value) != shape or not all(isinstance(n, Real) and math.isfinite(n) for n in np.ravel(value)):
            raise ParameterError(
                "at {time:g} s the controller's {name} is {value}; give finite numbers, such as {example}"
            ).tag("not_a_number", time=time, name=each.name, value=str(value), example="(0.1, 0.1)" if shape else "0.1")


@dataclass(slots=True)
class Posture:
    """Pose of the boots against the body.

    Parameters
    ----------
    skier
        Its limits.
    centre
        Centre of mass in the body: ahead of the boots and above them at the start (m).
    stance, half_width
        Between the boots, and of a ski (m).

    Attributes
    ----------
    numbers, rates
        Centre of mass ahead of and to the left of the feet, yaw of the body against the skis, edge angles, toes,
        stance, rise of the centre of mass and pitch of the skis, and their rates.
    acceleration
        Acceleration of the centre of mass, relative to the feet, to the left, in the last period (m/s²).
    """

    skier: Skier
    centre: tuple[float, float]
    stance: float
    half_width: float
    numbers: FloatArray = field(init=False)
    rates: FloatArray = field(default_factory=lambda: np.zeros(10))
    acceleration: float = 0.0
    _moment: float = 0.0  # smoothed moment of the snow on the boots (N m)
    _lands: bool = False  # in the air, or legs still shorter than usual by a landing
    _gives: float = 0.0  # rate to the left by legs that give way (m/s)

    def __post_init__(self) -> None:
        self.numbers = np.zeros(10)
        self.numbers[STANCE] = self.stance

    @property
    def aside_rate(self) -> float:
        """Planned rate of the centre of mass to the left, without the yielding of the legs (m/s)."""
        return float(self.rates[ASIDE]) - self._gives

    @property
    def height(self) -> float:
        """Height (m) of the centre of mass over the feet."""
        return self.centre[1] + float(self.numbers[RISE])

    @property
    def edge(self) -> float:
        """Edge angle of the left ski (rad)."""
        return float(self.numbers[LEFT_EDGE])

    def poses(self) -> list[BootPose]:
        """Poses of the left and the right boot, with their rates."""
        ahead, aside, yaw, *edges_and_toes, stance, rise, pitch = self.numbers.tolist()
        ahead_rate, aside_rate, yaw_rate, *turns, stance_rate, rise_rate, pitch_rate = self.rates.tolist()
        height = self.centre[1] + rise
        lean, lean_rate = math.atan2(aside, height), (aside_rate * height - aside * rise_rate) / (height**2 + aside**2)
        (sl, cl), (sy, cy) = ((math.sin(angle), math.cos(angle)) for angle in (lean, yaw))
        body = ((cy, -sy, 0.0), (cl * sy, cl * cy, sl), (-sl * sy, -sl * cy, cl))
        origin = (self.centre[0], 0.0, self.centre[1])
        spin = minus(times(lean_rate, body[0]), (0.0, 0.0, yaw_rate))
        left, right, left_toe, right_toe = zip(edges_and_toes, turns, strict=True)
        skis = [self._ski(*left, *left_toe, pitch, pitch_rate, body)]
        alike = left == right and left_toe == right_toe
        skis.append(skis[0] if alike else self._ski(*right, *right_toe, pitch, pitch_rate, body))
        poses = []
        for side, (lift, lift_rate, axes, turning) in zip((0.5, -0.5), skis, strict=True):
            arm = combined((-ahead, side * stance - aside, lift - height), body)
            moving = combined((-ahead_rate, side * stance_rate - aside_rate, lift_rate - rise_rate), body)
            place, velocity, whole = np.array((plus(arm, origin), plus(moving, cross(spin, arm)), plus(spin, turning)))
            poses.append(BootPose.unchecked(place, axes, velocity, whole))
        return poses

    def _ski(
        self, edge: float, edge_rate: float, toe: float, toe_rate: float, pitch: float, pitch_rate: float,
        body: Sequence[Vector],
    ) -> tuple[float, float, FloatArray, Vector]:  # fmt: skip
        """Lift of a ski (m) and its rate (m/s), axes and angular velocity against the body, by angles (rad)."""
        sine = math.sin(edge)
        bent = math.hypot(sine, BLUNT)
        rows = axis_rows(edge, pitch, toe)
        turns_by = (pitch_rate * math.sin(toe), -pitch_rate * math.cos(toe), toe_rate)
        return (
            self.half_width * (bent - BLUNT),
            self.half_width * sine * math.cos(edge) * edge_rate / bent,
            np.array([combined(axis, body) for axis in rows]),
            combined(minus(turns_by, times(edge_rate, rows[0])), body),
        )

    def step(self, command: Command, seen: Seen, dt: float) -> None:
        """Move all joints over a period `dt` (s) by a command, as far as joints and legs allow."""
        self._step_aside(command, seen, dt)
        self._step_up(command, seen, dt)
        self._step_ankles(command, seen, dt)
        self._step_ahead(command.ahead, dt)
        if command.hip_torque is not None:
            self._step_hips(command.hip_torque, seen, dt)
        else:
            self.rates[HIP] = 0.0
        corner = command.edge_rate or self.skier.edge_rate
        for place, wanted in zip((LEFT_EDGE, RIGHT_EDGE), command.edge, strict=True):
            limit = self.skier.greatest_edge
            self._follow(place, max(-limit, min(limit, wanted)), corner, dt, fastest=FASTEST_EDGE)
        for place, wanted in zip((LEFT_TOE, RIGHT_TOE), command.toe, strict=True):
            self._follow(place, wanted, OPENING, dt)
        self._follow(STANCE, command.stance or self.stance, OPENING, dt)

    def _follow(self, place: int, wanted: float, corner: float, dt: float, *, fastest: float = math.inf) -> None:
        """Move a joint towards `wanted` over `dt` (s), critically damped, at most at the rate `fastest`."""
        value, rate = float(self.numbers[place]), float(self.rates[place])
        if value == wanted and rate == 0.0:
            return
        later = rate + dt * (corner**2 * (wanted - value) - 2.0 * corner * rate)
        later = max(-fastest, min(fastest, later))
        self.numbers[place] = value + 0.5 * (rate + later) * dt
        self.rates[place] = later

    def _step_ankles(self, command: Command, seen: Seen, dt: float) -> None:
        """Level the skis in the air; with legs that give way, yield to the moment that pitches the body."""
        pitch, rate = float(self.numbers[PITCH]), float(self.rates[PITCH])
        if seen.flies:
            self._follow(PITCH, max(-ANKLES, min(ANKLES, pitch - seen.pitch)), LEVELS, dt)
            return
        later = (0.0 if command.load is None else seen.pitching / PITCH_DAMPING) - SETTLING * pitch
        self.numbers[PITCH] = max(-ANKLES, min(ANKLES, pitch + 0.5 * (rate + later) * dt))
        self.rates[PITCH] = later

    def _step_aside(self, command: Command, seen: Seen, dt: float) -> None:
        """Step of the legs sideways, by balance and by the deviation of the load; a lifted ski is put down."""
        place, rate = float(self.numbers[ASIDE]), float(self.rates[ASIDE])
        free = seen.lifted or not seen.bears
        back = min(1.0, TOUCH * dt) if free else 0.0
        later = (1.0 - back) * self.aside_rate + back * seen.aside_rate + command.aside * dt
        gives = TOUCH * (seen.aside - place) if free else self._yielding(command) * (seen.pressure - command.pressure)
        most = math.sqrt(self.skier.longest_leg**2 - self.height**2)
        self.acceleration = (later + gives - rate) / dt
        self.numbers[ASIDE] = max(-most, min(most, place + 0.5 * (rate + later + gives) * dt))
        self.rates[ASIDE], self._gives = later + gives, gives

    def _step_up(self, command: Command, seen: Seen, dt: float) -> None:
        """Step of the legs upwards, by the deviation of the load.

        In the air they stretch for the landing, then take the skis to the snow's speed, and brake evenly after it. The
        stretch, the touch and the rise after it are those that the greatest load of the legs allows.
        """
        rise, rate = float(self.numbers[RISE]), float(self.rates[RISE])
        hardest = (self.skier.leg_load - 1.0) * STANDARD_GRAVITY
        touchdown = hardest * dt
        more = 0.0 if command.load is None else self._edged() * (command.load - seen.load) / (2.0 * DAMPING)
        later = max(-FASTEST_RISE, min(FASTEST_RISE, more - SETTLING * rise))
        left, sinks = self.height - self.skier.shortest_leg, rate < -touchdown
        self._lands = seen.flies or (self._lands and (sinks or rise < -LANDED))
        if seen.flies:
            longest = math.sqrt(self.skier.longest_leg**2 - float(self.numbers[ASIDE]) ** 2)
            stretched = min(longest - self.centre[1], seen.falls_with**2 / (2.0 * hardest))
            touching = max(touchdown, APPROACH / dt * seen.clearance) - seen.nearing
            later = min(FASTEST_RISE, SETTLING * (stretched - rise), max(touching, -TOUCH * left))
        if self._lands:
            ends = not sinks or left < 0.02
            braked = rate + dt * max(rate**2 / (2.0 * max(left, 0.02)) if sinks else 0.0, hardest if ends else 0.0)
            later = braked if sinks and not seen.flies else min(later, braked)
        self.numbers[RISE] = rise + 0.5 * (rate + later) * dt
        self.rates[RISE] = later

    def _edged(self) -> float:
        """Share of the damping of the legs that the edges allow, from 0 to 1."""
        edge = min(abs(float(self.numbers[LEFT_EDGE])), abs(float(self.numbers[RIGHT_EDGE])))
        return min(1.0, (edge / DAMPED_FROM) ** 2)

    def _yielding(self, command: Command) -> float:
        """Speed aside by legs that give way, over the error of the centre of pressure (1/s)."""
        least = self.skier.leg_yielding
        damped = 2.0 * self.centre[1] * (command.load or 0.0) / (DAMPING * self.stance**2)
        return least + self._edged() * max(0.0, damped - least)

    def _step_ahead(self, asked: float, dt: float) -> None:
        """Shift fore and aft over `dt` (s) by an acceleration (m/s²), within the skier's range and speed."""
        place, rate = float(self.numbers[AHEAD]), float(self.rates[AHEAD])
        fastest, farthest = self.skier.greatest_shift_speed, self.skier.greatest_shift
        ahead, behind = (min(fastest, _stops_within(farthest - side * place)) for side in (1.0, -1.0))
        later = rate + dt * max(-FASTEST_SHIFT, min(FASTEST_SHIFT, asked))
        later = max(-behind, min(ahead, later))
        self.numbers[AHEAD] = place + 0.5 * (rate + later) * dt
        self.rates[AHEAD] = later

    def _step_hips(self, torque: float, seen: Seen, dt: float) -> None:
        """Step the hips' angle about the leaning body by dt (s): by torque (N m), damping, the snow's moment on boots.

        Their rate is the one about the snow's normal over the cosine of the lean.
        """
        most, apart, aside = self.skier.hip_torque, seen.body_rate - seen.turn_rate, float(self.numbers[ASIDE])
        leant = aside**2 / (aside**2 + self.height**2)
        torque = max(-most, min(most, torque)) + HIP_DAMPING * leant**2 * apart
        self._moment += (1.0 - math.exp(-dt / MOMENT_TIME)) * (seen.moment - self._moment)
        inertia = YIELDING_INERTIA + PITCHING_INERTIA * leant
        turns = self._moment / seen.yaw_inertia - (torque + self._moment) / inertia
        wanted = (apart + dt * turns) / math.sqrt(1.0 - leant)
        rate = float(self.rates[HIP])
        later = rate + max(-GREATEST_TURN * dt, min(GREATEST_TURN * dt, wanted - rate))
        self.numbers[HIP] += 0.5 * (rate + later) * dt
        self.rates[HIP] = later


def _stops_within(way: float) -> float:
    """Speed (m/s) from which the shift stops on a way (m)."""
    return math.sqrt(max(0.0, 2.0 * FASTEST_SHIFT * way))
