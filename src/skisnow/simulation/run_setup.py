"""A scenario made ready to run: numbers of the solver chosen, snow placed, sledge set down on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, SolverError
from ..contact import Laws, Runner, SnowContact, SnowField
from ..contact.snow_field import PART_ALONG
from ..dynamics import Dynamics, Ended, StepControl
from ..dynamics.motion import LONGEST_STEP, DynamicsState
from ..geometry.surfaces import Grid
from ..geometry.vectors import cross
from ..scenario import Plane, Scenario, SnowMap, Solver
from ..scenario.terrain import down_and_left, extent_of, heights_of, normals_of, surface_of
from ..ski.beam import clamped
from ..skier import BalancedSkier
from .moving_boots import SAME_TIME, BootControl, BootDrive, StrengthDrive, TableControl
from .run import Strength
from .sledge_body import sledge_body

ELEMENTS: Final = 36
"""Finite elements over a ski at least, 5 cm each; near the ends of the sidecut there are three for each."""
LINE_SPACING: Final = 0.02
"""Largest spacing (m) of the snow's lines."""
FAST: Final = 10.0
"""Times the tolerance, to which the fast method controls a step's error."""
FAST_ELEMENTS: Final = 24
"""Finite elements of the fast method over a ski at least."""
FAST_SPACING: Final = 0.025
"""Largest spacing (m) of the snow's lines of the fast method."""
FAST_LONGEST: Final = 10e-3
"""Longest step (s) of the fast method (that of outputs)."""
FAST_GROOVE: Final = 3.0
"""Times the groove's tolerance, to which the fast method simplifies grooves."""
FAST_PART: Final = 0.015
"""Path along a ski (m) over which the fast method advances its history at once."""
FLOATING_DEPTH: Final = 0.1
"""Depth (m) by which a flat base must carry the sledge, or it has sunk from the start."""
SET_DOWN: Final = 0.1
"""Distance (m) of the boots past a border that still counts as on it: a sledge may start there and settle."""
AT_REST: Final = 1e-6
"""Last step (m) of Newton's method that counts as equilibrium."""
TIPPED: Final = math.radians(60.0)
"""Angle between the sledge and the snow's normal at which it has tipped over (modelling assumption)."""
PITCHED: Final = math.radians(40.0)
"""Angle between the length of a sledge on the snow and the surface at which it has tipped over (modelling assumption).

Beyond it a ski is on its shovel or tail: a line across the snow meets its base more than once.
"""
_UP: Final = np.array([0.0, 0.0, 1.0])


@dataclass(slots=True)
class Setup:
    """A run in progress: its scenario, dynamics, snow, beam nodes (m), solver choices, and drives."""

    scenario: Scenario
    dynamics: Dynamics
    snow: SnowField
    node: FloatArray
    numbers: dict[str, float]
    static_residual: float
    drive: BootDrive | None = None
    strength: StrengthDrive | None = None
    _before_output: DynamicsState | None = None

    @property
    def drives(self) -> tuple[BootDrive | StrengthDrive, ...]:
        """Controls of the run, each with its own period."""
        return tuple(drive for drive in (self.drive, self.strength) if drive is not None)

    def advance(self, until: float, distance: float, *, is_over: Callable[[], bool] = lambda: False) -> Ended:
        """Step to a time (s).

        Drives are called at their own times. An output between these leaves no trace: the steps after it begin at the
        state before it, so that the outputs do not change the run.

        until: time to reach.
        distance: distance run so far (m).
        is_over: called at each time at which a drive is due; True: stop there.
        """
        drives = self.drives
        if not drives:
            return self.dynamics.advance(until)
        while until - self.dynamics.time > SAME_TIME:
            for drive in drives:
                if self.dynamics.time > drive.until - SAME_TIME:
                    drive.move(self.dynamics, distance)
            due = min(drive.until for drive in drives)
            if due > until + SAME_TIME:
                self._before_output = self._before_output or self.dynamics.state()
                return self.dynamics.advance(until)
            if self._before_output is not None:
                self.dynamics.restore(self._before_output)
                self._before_output = None
            before, ended = self.place, self.dynamics.advance(due)
            if ended is not Ended.REACHED or is_over():
                return ended
            distance += math.dist(before, self.place)
        return Ended.REACHED

    @property
    def place(self) -> FloatArray:
        """Vector of the middle between the boots, in space (m), (3,)."""
        if self.drive is None:
            return self.dynamics.position
        left, right = self.dynamics.boots[:, 0]
        return self.dynamics.position + self.dynamics.rotation @ (0.5 * (left + right))

    @property
    def velocity(self) -> FloatArray:
        """Present velocity of the middle between the boots, in space (m/s), (3,)."""
        rotation, rates = self.dynamics.rotation, self.dynamics.velocity
        if self.drive is None:
            return rotation @ rates[:3]
        left, right = self.dynamics.boots
        middle = 0.5 * (left + right)
        return np.asarray(rotation @ (rates[:3] + cross(rates[3:].tolist(), middle[0].tolist()) + middle[4]))

    @property
    def attitude(self) -> FloatArray:
        """Axes of the sledge as columns, (3, 3); if nothing carries the boots, of a level between their skis."""
        if self.drive is None or not self.drive.held:
            return self.dynamics.rotation
        normal = self.slope_normal(*self.place[:2].tolist())
        ahead = self.dynamics.boots[:, 1].mean(axis=0)
        ahead -= (ahead @ normal) * normal
        ahead /= np.linalg.norm(ahead)
        return np.column_stack([ahead, np.cross(normal, ahead), normal])

    @property
    def speed(self) -> float:
        """Speed of the boots' middle (m/s)."""
        return math.hypot(*(self.dynamics.velocity[:3] if self.drive is None else self.velocity).tolist())

    @property
    def tilt(self) -> tuple[float, float]:
        """Angles between the sledge's axis upwards and the snow's normal, its axis ahead and the surface (rad)."""
        ahead, _, up = (self._slope_at_boots()[1] @ self.attitude).tolist()
        return math.acos(min(1.0, max(-1.0, up))), math.asin(min(1.0, abs(ahead)))

    @property
    def height(self) -> float:
        """Height of the boots' middle above the slope (m)."""
        return float(self.place[2] - self._slope_at_boots()[0])

    @property
    def sinks(self) -> bool:
        """True if the snow cannot carry the sledge even with its bases flat and ten centimetres deep."""
        ski = self.scenario.ski
        length = float(ski.station[0] - ski.station[-1])
        area = length * float(np.mean(ski.at(np.linspace(float(ski.station[-1]), float(ski.station[0]), 101)).width))
        start = self.scenario.start
        hardness = self.scenario.contact.hardness_at(start.x, start.y)
        return self.numbers["load_N"] > hardness * area * FLOATING_DEPTH

    @property
    def past_end(self) -> bool:
        """True if tips or boots are beyond the end or a side of the slope."""
        if isinstance(self.scenario.slope, Plane):
            return False
        boots, ahead = self.place[:2], self.attitude[:2, 0]
        low, high = np.transpose(extent_of(self.scenario.slope))
        tips = boots + float(self.node[0]) * ahead
        aside = np.maximum(low - boots, boots - high).max()
        return bool(np.any(tips < low) or np.any(tips > high) or aside > SET_DOWN)

    def residual_depth(self, deepest: FloatArray) -> FloatArray:
        """Depth (m) of the groove that remains where the snow was pressed to the depths `deepest` (m)."""
        law = self.snow.penetration
        ratio = 1.0 - 1.0 / self.scenario.contact.unloading_ratio
        return deepest * ratio if law is None else law.residual_depth(deepest)

    def slope_normal(self, x: float, y: float) -> FloatArray:
        """Unit normal (3,) of the slope at a place (m)."""
        return normals_of(self.scenario.slope, x, y)

    def _slope_at_boots(self) -> tuple[float, FloatArray]:
        """Height (m) and normal of the slope at the boots; on a plane 0 and the upward axis."""
        if isinstance(self.scenario.slope, Plane):
            return 0.0, _UP
        x, y = self.place[:2].tolist()
        return float(heights_of(self.scenario.slope, x, y)), self.slope_normal(x, y)


def set_up(
    scenario: Scenario,
    snow: SnowField | None = None,
    *,
    laws: Laws | None = None,
    boots: BootControl | None = None,
    strength_along: Strength | None = None,
) -> Setup:
    """Choose the settings of the solver, create the snow or reuse the given one, and set the sledge down on it."""
    setup = laid_out(scenario, snow, laws=laws)
    setup.drive = _boot_drive(scenario, boots)
    setup.strength = None if strength_along is None else StrengthDrive(strength_along, setup.snow)
    speed, hip = scenario.start.speed, 0.0
    if setup.drive is not None:
        skier = _skier_of(setup.drive.control)
        if skier is not None:  # the start's heading is that of the skis
            hip = skier.hip
            forward, left, up = setup.dynamics.rotation.T
            ahead = math.cos(hip) * forward + math.sin(hip) * left
            setup.dynamics.move_to(setup.dynamics.position, np.column_stack([ahead, np.cross(up, ahead), up]))
        if setup.drive.held:
            setup.dynamics.move_to(np.zeros(3), np.eye(3))
            speed = 0.0
        setup.drive.begin(setup.dynamics)
    setup.static_residual = setup.dynamics.find_equilibrium()
    setup.dynamics.begin(np.array([speed * math.cos(hip), -speed * math.sin(hip), 0.0, 0.0, 0.0, 0.0]))
    return setup


def _skier_of(boots: object) -> BalancedSkier | None:
    """Skier that moves the boots, or to which their control passes its moments on."""
    return next((each for each in (boots, getattr(boots, "skier", None)) if isinstance(each, BalancedSkier)), None)


def no_start(setup: Setup) -> SolverError:
    """Error for a sledge without an equilibrium, with the place of its weight and the reach of its skis."""
    ahead, left = weight_meets_base(setup)
    front, rear = setup.scenario.ski.contact_points
    side = 0.5 * (setup.scenario.sledge.stance_width + float(setup.scenario.ski.width.max()))
    return SolverError(
        "the sledge falls over at its start: on this slope, at this heading, its weight passes {ahead:.3g} m ahead of "
        "the boots' middle and {left:.3g} m to its left. The skis carry from {rear:.3g} to {front:.3g} m ahead and up "
        "to {side:.3g} m to each side, less where the snow gives way. Lower sledge.centre_of_mass_height_m, widen "
        "sledge.stance_width_m, bring start.heading_deg nearer to 0, or use harder snow"
    ).tag("no_start", ahead=ahead, left=left, front=front, rear=rear, side=side)


def weight_meets_base(setup: Setup) -> tuple[float, float]:
    """Point where the vertical through the centre of mass meets the bases' level: ahead and left (m).

    As the sledge was set down, before it leans.
    """
    start = setup.scenario.start
    normal = setup.slope_normal(start.x, start.y)
    down, aside = down_and_left(normal)
    forward = math.cos(start.heading) * down + math.sin(start.heading) * aside
    gravity, centre = setup.dynamics.body.gravity, setup.dynamics.body.first_moment / setup.dynamics.body.mass
    pulls = np.array([gravity @ forward, gravity @ np.cross(normal, forward), gravity @ normal])
    ahead, left, _ = centre - pulls * centre[2] / pulls[2]
    return float(ahead), float(left)


def _boot_drive(scenario: Scenario, boots: BootControl | None) -> BootDrive | None:
    """Drive of the boots by a function, the scenario's skier or its file; None without one; rejects two of them."""
    if boots is not None:
        if scenario.boots is not None:
            raise ParameterError("the boots move by boots.file and by a function; give one of them").tag(
                "contradiction"
            )
        if scenario.skier is not None and _skier_of(boots) is None:
            raise ParameterError(
                "boots: the scenario has a skier, whose control moves the boots. Use the scenario without it, "
                "scenario.with_(skier=None), or a BalancedSkier."
            ).tag("contradiction")
        return BootDrive(boots)
    if scenario.skier is not None:
        return BootDrive(BalancedSkier(scenario))
    if scenario.boots is None:
        return None
    return BootDrive(TableControl(scenario.boots), held=scenario.boots.frame == "slope")


def laid_out(scenario: Scenario, snow: SnowField | None = None, *, laws: Laws | None = None) -> Setup:
    """Setup with the sledge above the snow, before any motion; `snow` is reused with its tracks if given."""
    load, depth, wavelength = _contact(scenario)
    solver, air = scenario.solver, scenario.air
    length = float(scenario.ski.station[0] - scenario.ski.station[-1])
    elements, spacing = _mesh(solver, length, wavelength)
    ski = clamped(scenario.flexing_ski, scenario.clamp_length, elements, scenario.footprint_stiffness, finer_ends=True)
    angle = scenario.slope.angle if isinstance(scenario.slope, Plane) else 0.0  # axes on a plane are inclined
    body = sledge_body(
        scenario.sledge, ski, damping_ratio=scenario.damping_ratio,
        gravity=scenario.gravity * np.array([math.sin(angle), 0.0, -math.cos(angle)]),
        drag=0.5 * air.density * air.drag_area, drag_height=air.centre_of_pressure_height,
    )  # fmt: skip
    snow = snow or _snow_field(scenario, laws or Laws())
    runner = Runner.of(scenario.ski, nodes=ski.node)
    contact = SnowContact(snow, [runner, runner], spacing=spacing)
    fast = solver.method == "fast"
    control = StepControl(
        first=solver.step, fixed=solver.fixed, tolerance=solver.tolerance * (FAST if fast else 1.0),
        longest=FAST_LONGEST if fast else LONGEST_STEP,
    )  # fmt: skip
    dynamics = Dynamics(body, contact, *_start(scenario, depth), control)
    numbers = {"elements": float(elements), "line_spacing_m": spacing, "load_N": load}
    return Setup(scenario, dynamics, snow, ski.node, numbers, math.inf)


def _mesh(solver: Solver, length: float, wavelength: float) -> tuple[int, float]:
    """Number of elements of a ski and spacing (m) of the lines, as given or by its length and 1/λ of its contact (m).

    A flat base meets each new line with a jolt: short waves need close lines.
    """
    fast = solver.method == "fast"
    least, per_wave = (FAST_ELEMENTS, 2.0) if fast else (ELEMENTS, 3.0)
    largest, lines_per_wave = (FAST_SPACING, 8.0) if fast else (LINE_SPACING, 10.0)
    elements, spacing = max(least, math.ceil(per_wave * length / wavelength)), min(largest, wavelength / lines_per_wave)
    return solver.elements or elements, solver.line_spacing or spacing


def _contact(scenario: Scenario) -> tuple[float, float, float]:
    """Load of one ski at the start along the normal (N), edge depth if rigid, decay length 1/λ (m)."""
    ski, sledge, start = scenario.flexing_ski, scenario.sledge, scenario.start
    station = np.asarray(ski.station)
    at = ski.at(np.linspace(float(station[-1]), float(station[0]), 101))
    length = float(station[0] - station[-1])
    mass = sledge.mass / 2.0 + float(np.mean(at.mass_per_length)) * length
    load = mass * scenario.gravity * abs(float(normals_of(scenario.slope, start.x, start.y)[2]))
    hardness, hardest = scenario.contact.hardness_at(start.x, start.y), scenario.contact.greatest_hardness
    tangent = math.tan(abs(sledge.edge_angle))
    width = float(np.mean(at.width))
    flat = load / (hardness * 0.8 * length * width)
    depth = max(flat, math.sqrt(2.0 * load * tangent / (hardness * 0.8 * length)))
    stiffness = hardest * min(depth * math.sqrt(hardness / hardest) / max(tangent, 1e-9), width)
    wavelength = (4.0 * float(np.mean(at.bending_stiffness)) / stiffness) ** 0.25
    return load, depth, wavelength


def _snow_field(scenario: Scenario, laws: Laws) -> SnowField:
    """Snow of a scenario, with its snow map and with the given laws instead of the scenario's."""
    contact, fast = scenario.contact, scenario.solver.method == "fast"
    over_place, stress = contact.snow_map, contact.snow.failure_shear_stress or 0.0
    hardness, friction_share = (over_place.hardness, over_place.friction_share) if over_place else (None, None)
    carries_side_force = laws.penetration is not None and laws.penetration.along_base_normal
    return SnowField(
        snow_hardness=hardness or contact.snow.snow_hardness,
        failure_shear_stress=0.0 if carries_side_force else stress,
        unloading_ratio=contact.unloading_ratio,
        friction=laws.friction or contact.glide_friction,
        friction_acts_on=contact.friction_acts_on,
        friction_direction=contact.friction_direction,
        shear=laws.shear or (None if carries_side_force else scenario.shear.of(stress)),
        strength_share=_strength_share(over_place),
        friction_share=friction_share or 1.0,
        residual_ratio=scenario.shear.residual_ratio,
        slip_weakening=scenario.shear.slip_weakening,
        shear_bearing=scenario.shear.bearing,
        penetration=laws.penetration or contact.penetration,
        damping=contact.damping,
        delayed_share=contact.delayed_share,
        retardation_time=contact.retardation_time,
        delayed_spacing=scenario.solver.delayed_spacing,
        surface=surface_of(scenario.slope),
        compaction_resistance=contact.compaction_resistance,
        shear_displacement=contact.shear_displacement,
        knot_area=scenario.solver.groove_tolerance * (FAST_GROOVE if fast else 1.0),
        part_along=FAST_PART if fast else PART_ALONG,
    )


def _strength_share(snow_map: SnowMap | None) -> float | Grid:
    """S_f of the snow map over its mean, at each place; 1 without a map of S_f."""
    if snow_map is None or snow_map.failure_shear_stress is None or snow_map.mean_stress is None:
        return 1.0
    grid = snow_map.failure_shear_stress
    return Grid(grid.x, grid.y, grid.values / snow_map.mean_stress)


def _start(scenario: Scenario, depth: float) -> tuple[FloatArray, FloatArray]:
    """Place and rotation of the sledge on the slope at its start, as deep as rigid skis would be."""
    start = scenario.start
    normal = normals_of(scenario.slope, start.x, start.y)
    down, left = down_and_left(normal)
    ahead = math.cos(start.heading) * down + math.sin(start.heading) * left
    height = float(heights_of(scenario.slope, start.x, start.y))
    half = float(scenario.ski.at(0.0).width) / 2.0
    above = half * math.sin(abs(scenario.sledge.edge_angle)) - depth
    return np.array([start.x, start.y, height]) + above * normal, np.column_stack(
        [ahead, np.cross(normal, ahead), normal]
    )
