"""A skier that moves the boots of a run: it measures its state, decides and moves its body."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from ..dynamics import BootPose
from ..scenario import Plane, Scenario
from ..scenario.skier import Skier
from ..scenario.terrain import down_and_left, heights_of, normals_of
from ..track.course import Course
from .carve import CarveControl, CarvesOverTime, Pursuit, Steering
from .control import Balance, Controller, SkidControl, standing
from .edges import Edges, ForceMap
from .hybrid import CarvedLine
from .plan import Gravity, HalfWaves, Line, Plan, RecedingLine, SideSlip, TurnsOverTime, apexes_of
from .posture import ASIDE, HIP, LEFT_EDGE, RIGHT_EDGE, Posture, require_command
from .seen import Moment, Seen, seen_at
from .wedge import WedgeControl
from .yaw import FACES_DOWN, Body

BuiltIn: TypeAlias = SkidControl | CarveControl | WedgeControl
HELD_AT_START = 1.3
"""Force that the edges of a side-slip hold at the start, over what the slope asks for (modelling assumption)."""
LEVEL = np.array([0.0, 0.0, 1.0])
"""Normal of a plane slope in its own axes."""
TOUCHED: Final = 0.003
"""Height of the feet over the snow (m) at which a flight ends (modelling assumption)."""
GREATEST_PRESSED = 2.0
"""Greatest acceleration (m/s²) by the bend of the slope that the skier counts with (modelling assumption)."""


@dataclass(frozen=True, slots=True)
class BalanceRecord:
    """Input and output of the control at one moment.

    Attributes
    ----------
    seen
        Measured state.
    balance
        Plan and command of the built-in control; None with another controller.
    posture
        Numbers of the posture at the end of the period.
    """

    seen: Seen
    balance: Balance | None
    posture: FloatArray


@dataclass(slots=True, eq=False)
class BalancedSkier:
    """Moves the boots of a run as a scenario's skier; `skisnow.simulate` takes it for a scenario that has one.

    Parameters
    ----------
    scenario
        Scenario with a skier, whose numbers the control uses.
    controller
        Replaces the built-in control.

    Attributes
    ----------
    records
        Input and output of the control at each moment.
    control
        Name of the controller's class.

    Raises
    ------
    ParameterError
        The scenario has no skier.

    Notes
    -----
    Between two calls boots move with even acceleration: their velocities are continuous.

    References
    ----------
    The page docs/methods/skier.md.
    """

    scenario: Scenario = field(repr=False)
    controller: Controller | None = field(default=None, repr=False)
    records: list[BalanceRecord] = field(default_factory=list, repr=False)
    control: str = field(init=False)
    skier: Skier = field(init=False)
    posture: Posture = field(init=False, repr=False)
    _flies_from: float = field(init=False, repr=False)  # height of the feet (m)
    _on_plane: Gravity | None = field(init=False, repr=False, default=None)

    def __post_init__(self) -> None:
        scenario = self.scenario
        if scenario.skier is None:
            raise ParameterError("BalancedSkier: the scenario has no skier; give Scenario.with_(skier=Skier())").tag(
                "no_data"
            )
        self.skier, sledge = scenario.skier, scenario.sledge
        half = float(scenario.ski.at(0.0).width) / 2.0
        # the steepest ski that bears stands on the edges of its widest sections
        self._flies_from = 0.5 * scenario.ski.tip_width * math.sin(self.skier.greatest_edge)
        self.posture = Posture(self.skier, sledge.centre_of_mass, sledge.stance_width, half)
        self.controller = self.controller or self._built_in()
        self.control = type(self.controller).__qualname__

    def _built_in(self) -> BuiltIn:
        """Controller that the scenario's skier steers by: gates, a wedge, a side-slip, or turns over time."""
        course = self.scenario.course
        if self.skier.steers == "gates" and course is not None:
            apexes = self.apexes(course)
            return self.follow(HalfWaves(apexes), apexes)
        if self.skier.steers == "wedge":
            body, gravity = self._body()
            sledge = self.scenario.sledge
            snow = ForceMap.of(self.scenario)
            return WedgeControl(self.skier, snow, body, sledge.inertia[0], sledge.stance_width, gravity)
        if self.skier.steers == "side-slip":
            return self._across()
        turns = TurnsOverTime(self.skier)
        return self.skidding(turns) if self.skier.brakes_to else self._carve_control(CarvesOverTime(turns))

    def _across(self) -> SkidControl:
        """The control of a side-slip, whose start leans and edges the skis against the slope."""
        control = self.skidding(SideSlip(self.skier.brakes_to, self.skier.stops_after))
        gravity, mass, side = control.gravity, control.body.mass, math.copysign(1.0, self.scenario.start.heading)
        self.posture.numbers[ASIDE] = side * control.body.height * gravity.down / gravity.normal
        half = 0.5 * mass * gravity.normal
        edge = side * control.snow.edge(HELD_AT_START * mass * gravity.down, (half, half), control.grip)
        self.posture.numbers[[LEFT_EDGE, RIGHT_EDGE]] = edge
        return control

    def follow(self, line: Line, apexes: Sequence[tuple[float, float]]) -> BuiltIn:
        """The control that follows a line with these apexes (m): skidding to a wanted speed, without one carving.

        A skier who skids starts as between two turns, with the body facing down the slope.
        """
        if self.skier.brakes_to:
            radius = self.scenario.ski.sidecut_radius_of_edge_line
            carved, heading = self.skier.carves, self.scenario.start.heading
            facing = heading - max(-FACES_DOWN, min(FACES_DOWN, heading))
            self.posture.numbers[HIP] = max(-self.skier.greatest_hip, min(self.skier.greatest_hip, facing - heading))
            return self.skidding(CarvedLine(line, apexes, radius) if carved else RecedingLine(line, apexes))
        return self._carve_control(Pursuit(line, self.skier.line_rate))

    def skidding(self, plan: Plan) -> SkidControl:
        """Controller of skidded turns that follow a plan."""
        body, gravity = self._body()
        snow, sledge = ForceMap.of(self.scenario), self.scenario.sledge
        return SkidControl(self.skier, plan, snow, body, sledge.inertia[0], sledge.stance_width, gravity)

    def _carve_control(self, steering: Steering) -> CarveControl:
        """Controller of carved turns along a steering, with the scenario's edges, body and gravity."""
        body, gravity = self._body()
        edges, sledge = Edges.of(self.scenario, gravity.normal, self.skier), self.scenario.sledge
        return CarveControl(self.skier, steering, edges, body, sledge.inertia[0], sledge.stance_width, gravity)

    def _body(self) -> tuple[Body, Gravity]:
        """Body of the scenario's sledge, and gravity at its start."""
        start, sledge = self.scenario.start, self.scenario.sledge
        body = Body(sledge.mass, sledge.inertia[1], sledge.inertia[2], sledge.centre_of_mass[1])
        return body, self._stand_on(start.x, start.y)[1]

    def apexes(self, course: Course) -> list[tuple[float, float]]:
        """Start and apexes (m) of its line through a course."""
        start = self.scenario.start
        gravity = self._stand_on(start.x, start.y)[1].normal
        return apexes_of(course, self.skier, (start.x, start.y), gravity)

    def _stand_on(self, x: float, y: float) -> tuple[FloatArray, Gravity]:
        """Normal of the snow (3,), and gravity plus the acceleration by its bend at the last recorded speed."""
        slope, gravity = self.scenario.slope, self.scenario.gravity
        if isinstance(slope, Plane):
            self._on_plane = self._on_plane or Gravity(gravity * math.cos(slope.angle), gravity * math.sin(slope.angle))
            return LEVEL, self._on_plane
        normal = normals_of(slope, x, y)
        down = -gravity * float(down_and_left(normal)[0][2])
        return normal, Gravity(gravity * float(normal[2]) + self._pressed(x, y), down)

    def _pressed(self, x: float, y: float) -> float:
        """Acceleration off the snow (m/s²) that the slope's bend, over a ski's length, gives at the present speed."""
        if not self.records:
            return 0.0
        seen = self.records[-1].seen
        ahead = np.array([math.cos(seen.course), math.sin(seen.course)])
        half = self.scenario.ski.length / 2.0
        behind, before = (normals_of(self.scenario.slope, *(np.array([x, y]) + d * ahead)) for d in (-half, half))
        bend = float((behind - before)[:2] @ ahead) / (2.0 * half)
        return max(-GREATEST_PRESSED, min(GREATEST_PRESSED, seen.speed**2 * bend))

    def _in_flight(self, moment: Moment, seen: Seen) -> Seen:
        """The observation; in the air against the snow at the place of the landing, which Newton's laws give."""
        slope, gravity, sledge = self.scenario.slope, self.scenario.gravity, self.scenario.sledge
        flown = bool(self.records) and self.records[-1].seen.flies
        if isinstance(slope, Plane) or (seen.bears and not flown):
            return seen
        feet = moment.position + moment.rotation @ moment.boots[:, 0].mean(axis=0)
        flies = flown and seen.load < sledge.mass * gravity  # edged skis bear with their boots some centimetres up
        if feet[2] - heights_of(slope, *feet[:2]) < (TOUCHED if flies else self._flies_from):
            return seen
        velocity, landing, fall = moment.rotation @ moment.velocity[:3], feet.copy(), 0.0
        for _ in range(5):
            drop = float(feet[2] - heights_of(slope, *landing[:2]))
            fall = (velocity[2] + math.sqrt(max(0.0, velocity[2] ** 2 + 2.0 * gravity * drop))) / gravity
            landing[:2] = feet[:2] + fall * velocity[:2]
        landing[2] = heights_of(slope, *landing[:2])
        normal = normals_of(slope, *landing[:2])
        clearance, nearing = float((feet - landing) @ normal), -float(velocity @ normal)
        return replace(
            seen_at(moment, sledge.centre_of_mass, normal, sledge.mass * gravity, sledge.inertia[2]),
            clearance=clearance,
            nearing=nearing,
            falls_with=math.sqrt(max(0.0, nearing**2 + 2.0 * gravity * float(normal[2]) * clearance)),
        )

    @property
    def hip(self) -> float:
        """Yaw of the body against the skis, to the left (rad)."""
        return float(self.posture.numbers[HIP])

    @property
    def period(self) -> float:
        """Time from call to call (s)."""
        return self.skier.control_period

    def __call__(self, moment: Moment) -> Sequence[BootPose]:
        """Target of the boots at the end of the moment."""
        dt = moment.until - moment.time
        if dt > 0.0:
            self.decide(moment, dt)
        return self.posture.poses()

    def decide(self, moment: Moment, dt: float) -> None:
        """Observe the moment, get the controller's command, and move the boots over a period `dt` (s)."""
        sledge, control = self.scenario.sledge, self.controller
        assert control is not None
        normal, gravity = self._stand_on(*moment.position[:2].tolist())
        weight = sledge.mass * self.scenario.gravity
        seen = self._in_flight(moment, seen_at(moment, sledge.centre_of_mass, normal, weight, sledge.inertia[2]))
        built_in = control if isinstance(control, BuiltIn) else None
        if built_in is not None:
            built_in.gravity = gravity
        if built_in is not None and seen.flies:
            command = standing(seen, self.posture, (self.posture.edge, float(self.posture.numbers[RIGHT_EDGE])))
        else:
            command = control.command(seen, self.posture, dt)
            if built_in is None:
                require_command(command, moment.time)
        balance = None if built_in is None else built_in.balance
        self.posture.step(command, seen, dt)
        self.records.append(BalanceRecord(seen, balance, self.posture.numbers.copy()))
