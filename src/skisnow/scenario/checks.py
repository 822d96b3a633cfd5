"""Rules between the parts of a scenario; ranges of single numbers are in their declarations."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .._support.errors import ParameterError
from .._support.messages import Message
from .terrain import extent_of

if TYPE_CHECKING:
    from .scenario import Scenario


def require_sound(scenario: Scenario) -> None:
    """Reject parts of a scenario that contradict each other."""
    for complaint in _contradictions(scenario):
        raise ParameterError(complaint).tag("contradiction")
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


def _contradictions(scenario: Scenario) -> Iterator[Message]:
    sledge, ski, shear, start = scenario.sledge, scenario.ski, scenario.shear, scenario.start
    width = float(ski.width.max())
    if sledge.stance_width < width * (1.0 - 1e-9):  # the width of a ski file is rounded on its way to metres
        yield Message(
            "the stance width is {stance:g} m; the ski {name} is {width:.3g} m wide, and two must have room side "
            "by side: "
            "{width:.3g} m or more",
            stance=sledge.stance_width,
            name=ski.name,
            width=width,
        )
    most = 2.0 * min(float(ski.station[0]), -float(ski.station[-1]))
    if scenario.clamp_length >= most:
        yield Message(
            "the clamp length is {clamp_length:g} m; the ski {name} allows less than {most:.3g} m. Write 0 for a "
            "binding "
            "that bends with the ski",
            clamp_length=scenario.clamp_length,
            name=ski.name,
            most=most,
        )
    friction = scenario.contact.friction_at(start.speed)
    if friction < 0.0:
        yield Message(
            "the friction at the start's speed, μ_0 + μ_1 v, is {friction:.3g}; below 0 it would drive the ski",
            friction=friction,
        )
    if abs(sledge.edge_angle) < shear.smallest_cutting_angle:
        least = math.degrees(shear.smallest_cutting_angle)
        yield Message(
            "the edge angle is {edge_angle:.3g}°; machining needs {least:.3g}° or more, β + 2 "
            "shear.least_shear_plane_deg: use a larger edge angle or another shear.law",
            edge_angle=math.degrees(abs(sledge.edge_angle)),
            least=least,
        )
    for name, place, (first, last) in zip("xy", (start.x, start.y), extent_of(scenario.slope), strict=True):
        if not first <= place <= last:
            yield Message(
                "the start, {name} = {place:g} m, is off the slope, which reaches from {first:g} to {last:g} m there",
                name=name,
                place=place,
                first=first,
                last=last,
            )
