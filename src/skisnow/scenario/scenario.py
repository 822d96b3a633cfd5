"""A scenario: everything that a simulated turn follows from, SI, radians.

Each field declares its key in a file with unit, range, origin of the default, and size for a search.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import DEGREE, STANDARD_GRAVITY, Facts, Shown, amount
from ..parameters import Allowed, Label, Quantity, Search, Word, require_declared
from ..ski import Ski, ski_names
from ..ski.beam import CLAMP_LENGTH
from ..track.course import Course, on_slope
from .boots import Boots
from .contact import Contact
from .run_settings import Solver, Start, Stop
from .skier import Skier
from .sledge import Air, RigidSledge, Shear
from .slope import Plane, Profile
from .terrain import Slope, Terrain, extent_of


def course_on_slope(course: Course, slope: Slope) -> Course:
    """The course converted to the slope's x and y (m)."""
    return on_slope(course, slope_angle=slope.angle if isinstance(slope, Plane) else None)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Scenario(Shown):
    """Input of a run: slope, snow, sledge, ski, start and end.

    Attributes
    ----------
    slope
        A plane, a measured profile or measured terrain.
    contact, shear, air
        Snow with friction; the law of its shear strength; drag.
    sledge
        The rigid part with its edge angle, without the skis.
    ski, camber_rounding, stiffness_factor, clamp_length, footprint_stiffness, damping_ratio
        The ski of both sides, the length over which its camber levels out (m; None: the ski's own), the factors of its
        EI and GJ, the length that its binding keeps straight (m) or supports with a stiffness (N/m²; None: rigid),
        damping of its first bending mode.
    boots
        Where the boots are against the sledge, or in the slope, over time or distance; None: they stay.
    start, stop, solver
        Where it begins, when it ends, how it is computed.
    gravity
        (m/s²), > 0.
    course
        Gates whose passing a run reports; a course in degrees is projected on the slope. None: no gates.
    skier
        Who moves the boots, keeps balance and steers; None without a skier.

    See Also
    --------
    skisnow.scenario
    skisnow.simulate
    """

    slope: Annotated[
        Plane | Profile | Terrain,
        Word(
            "slope.kind",
            "a plane, a measured profile of heights, or a grid of them",
            label=Message("shape of the slope"),
            choices=("plane", "profile", "grid"),
            default="plane",
            origin="choice: the simpler one",
            word_of=lambda slope: {Plane: "plane", Profile: "profile"}.get(type(slope), "grid"),
        ),
    ]
    contact: Contact
    air: Air
    sledge: RigidSledge
    ski: Annotated[
        Ski,
        Word(
            "ski.name",
            "a ski of the catalogue",
            label=Message("ski"),
            word_of=lambda ski: ski.name if ski.name in ski_names() else None,
        ),
        Word(
            "ski.file",
            "the path of a ski file, instead of a name",
            label=Message("file of the ski"),
            word_of=lambda ski: None if ski.name in ski_names() else ski.name,
            names_file=True,
        ),
    ]
    camber_rounding: Annotated[
        float | None,
        Quantity(
            "ski.camber_rounding_mm",
            "length before each contact point over which the camber levels out; default: the ski's own",
        ),
        Label(Message("rounding of the camber")),
        Allowed(1.0, 1000.0),
    ] = None
    stiffness_factor: Annotated[
        float,
        Quantity("ski.stiffness_factor", "factor of the ski's EI and GJ"),
        Label(Message("stiffness factor")),
        Allowed(0.01, 100.0, origin="the ski as it is given"),
        Search(0.5, 0.1, 10.0, logarithmic=True),
    ] = 1.0
    clamp_length: Annotated[
        float,
        Quantity("ski.clamp_length_m", "length of ski that boot and binding keep straight"),
        Label(Message("clamp length")),
        Allowed(0.0, origin="choice: about a boot's sole"),
    ] = CLAMP_LENGTH
    footprint_stiffness: Annotated[
        float | None,
        Quantity(
            "ski.footprint_stiffness_N_per_mm2",
            "stiffness of boot and binding under each metre of the clamp length, against bending; default: rigid",
        ),
        Label(Message("footprint stiffness")),
        Allowed(0.0, 1e4, above=True),
    ] = None
    damping_ratio: Annotated[
        float,
        Quantity("ski.damping_ratio", "damping ratio of the ski's first bending mode"),
        Label(Message("damping ratio of the ski")),
        Allowed(0.0, 1.0, origin="choice: a lightly damped beam"),
    ] = 0.02
    boots: Annotated[
        Boots | None,
        Word(
            "boots.file",
            "poses of the boots over time or distance (CSV, .mot or .sto); default: they stay where the sledge has "
            "them",
            word_of=lambda boots: boots and boots.source,
            names_file=True,
        ),
    ] = None
    start: Start
    stop: Stop
    shear: Shear = field(default_factory=Shear)
    solver: Solver = field(default_factory=Solver)
    gravity: Annotated[
        float,
        Quantity("slope.gravity_m_per_s2", "acceleration of gravity"),
        Label(Message("gravity"), symbol="g"),
        Allowed(0.0, 100.0, above=True, origin="the value that the skiing literature computes with"),
    ] = STANDARD_GRAVITY
    course: Course | None = None
    skier: Skier | None = None

    def __post_init__(self) -> None:
        if self.contact.snow.failure_shear_stress is None:
            raise ParameterError("the snow ({source}) has no failure shear stress S_f; a turn needs it: give one").tag(
                "no_data", source=self.contact.snow.source
            )
        if self.stop.duration is None and self.stop.length is None:
            raise ParameterError("the run has no end: give a duration or a length").tag("no_data")
        require_declared(self)
        if self.camber_rounding is not None:
            object.__setattr__(self, "ski", self.ski.camber_rounded(self.camber_rounding))
        _require_sound(self)
        if self.course is not None and self.course.axes != "metres":
            object.__setattr__(self, "course", course_on_slope(self.course, self.slope))

    def with_(self, **changes: Any) -> Scenario:
        """Copy of the scenario with other parts or values.

        changes: Parts by the names of the attributes above, and ``snow``: a `SnowProperties`, whose unloading ratio
            is used if it has one, or the name of a published snow. ``ski`` may be a name or a file, too. Numbers by the
            keys of a scenario file without their section, in the units in their names.
        Raises ParameterError: a name is not a part and no key (the nearest is named), a value is outside its range, or
            parts do not go together.

        Examples
        --------
        >>> from skisnow import load_scenario
        >>> turn = load_scenario("carved-46m").with_(ski="slalom", snow="race-piste", edge_angle_deg=35, duration_s=2.0)
        >>> turn.ski.name, round(turn.contact.snow.snow_hardness / 1e9, 2), turn.stop.duration
        ('slalom', 0.21, 2.0)
        """
        from .building import changed_scenario

        return changed_scenario(self, changes)

    @property
    def flexing_ski(self) -> Ski:
        """The ski with EI and GJ times `stiffness_factor`."""
        return self.ski.stiffened(self.stiffness_factor)

    def _repr_facts(self) -> Facts:
        """Title, and rows with slope, snow, sledge, ski, boots, skier, start, course, end and solver."""
        contact, sledge, start, solver = self.contact, self.sledge, self.start, self.solver
        slope = amount(self.slope.angle / DEGREE, "°") if isinstance(self.slope, Plane) else repr(self.slope)
        end = [(self.stop.duration, "s"), (self.stop.length, "m")]
        friction = f"μ = {amount(contact.friction)} + {amount(contact.friction_by_speed, 's/m')} v"
        if contact.friction_law is not None:
            friction = f"μ of {contact.friction_law.source}"
        rows = (
            ("slope", slope),
            ("snow", replace(contact.snow, unloading_ratio=contact.unloading_ratio).in_words),
            ("friction", f"{friction}, drag area {amount(self.air.drag_area, 'm²')}"),
            ("sledge", f"{amount(sledge.mass, 'kg')}, edge angle {amount(sledge.edge_angle / DEGREE, '°')}"),
            ("ski", repr(self.ski).strip("<>")),
            *([("boots", repr(self.boots).strip("<>"))] if self.boots is not None else []),
            *([("skier", f"steers by {self.skier.steers}")] if self.skier is not None else []),
            ("start", f"{amount(start.speed, 'm/s')}, heading {amount(start.heading / DEGREE, '°')}"),
            *([("course", repr(self.course).strip("<>"))] if self.course is not None else []),
            ("end", " or ".join(amount(value, unit) for value, unit in end if value is not None)),
            ("solver", f"{solver.method}, {'fixed steps of' if solver.fixed else 'from'} {solver.step * 1e3:.4g} ms"),
        )
        return Facts("sledge on two skis", rows)


def _require_sound(scenario: Scenario) -> None:
    """Reject parts of a scenario that contradict each other."""
    _require_room(scenario)
    skier, sledge = scenario.skier, scenario.sledge
    if skier is None:
        return
    if sledge.edge_angle != 0.0:
        raise ParameterError("sledge.edge_angle_deg is {degrees:g}; the skier sets the edges itself: write 0").tag(
            "contradiction", degrees=math.degrees(sledge.edge_angle)
        )
    if scenario.boots is not None:
        raise ParameterError("boots.file and [skier] both move the boots; remove one of them").tag("contradiction")
    if skier.steers == "gates" and scenario.course is None:
        raise ParameterError('skier.steers is "gates" without a course; give course.name or course.file').tag(
            "contradiction"
        )
    if skier.longest_leg <= sledge.centre_of_mass[1]:
        raise ParameterError(
            "skier.longest_leg_m is {longest_leg:g}, and sledge.centre_of_mass_height_m {centre_of_mass:g}; the leg "
            "must be longer than that"
        ).tag("out_of_range", longest_leg=skier.longest_leg, centre_of_mass=sledge.centre_of_mass[1])


def _require_room(scenario: Scenario) -> None:
    """Reject skis that overlap side by side, and an edge angle, friction or place with which no run can start."""
    sledge, ski, shear, start = scenario.sledge, scenario.ski, scenario.shear, scenario.start
    width = float(ski.width.max())
    if sledge.stance_width < width * (1.0 - 1e-9):  # the width of a ski file is rounded on its way to metres
        raise ParameterError(
            "the stance width is {stance:g} m; the ski {name} is {width:.3g} m wide, and two must have room side "
            "by side: {width:.3g} m or more"
        ).tag("contradiction", stance=sledge.stance_width, name=ski.name, width=width)
    most = 2.0 * min(float(ski.station[0]), -float(ski.station[-1]))
    if scenario.clamp_length >= most:
        raise ParameterError(
            "the clamp length is {clamp_length:g} m; the ski {name} allows less than {most:.3g} m. Write 0 for a "
            "binding that bends with the ski"
        ).tag("contradiction", clamp_length=scenario.clamp_length, name=ski.name, most=most)
    friction = scenario.contact.friction_at(start.speed)
    if friction < 0.0:
        raise ParameterError(
            "the friction at the start's speed, μ_0 + μ_1 v, is {friction:.3g}; below 0 it would drive the ski"
        ).tag("contradiction", friction=friction)
    if abs(sledge.edge_angle) < shear.smallest_cutting_angle:
        edge_angle, least = math.degrees(abs(sledge.edge_angle)), math.degrees(shear.smallest_cutting_angle)
        raise ParameterError(
            "the edge angle is {edge_angle:.3g}°; machining needs {least:.3g}° or more, β + 2 "
            "shear.least_shear_plane_deg: use a larger edge angle or another shear.law"
        ).tag("contradiction", edge_angle=edge_angle, least=least)
    for name, place, (first, last) in zip("xy", (start.x, start.y), extent_of(scenario.slope), strict=True):
        if not first <= place <= last:
            raise ParameterError(
                "the start, {name} = {place:g} m, is off the slope, which reaches from {first:g} to {last:g} m there"
            ).tag("contradiction", name=name, place=place, first=first, last=last)
