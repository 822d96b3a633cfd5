"""Warnings about a scenario: implausible values, values outside measured ranges, known limits of the model."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from typing import Final

from .._support.errors import RangeWarning
from .._support.messages import Message
from .._support.units import DEGREE, MM, N_PER_MM3, in_degrees_if_radians
from ..forces.parameter_checks import (
    DRAG_AREA,
    FAILURE_SHEAR_STRESS,
    GLIDE_FRICTION,
    PENETRATION_EDGE_ANGLE,
    SNOW_HARDNESS,
)
from ..ski import Ski
from ..snow.properties import GREATEST_LIKELY_HARDNESS
from .scenario import Scenario
from .slope import Plane


def implausible_values(scenario: Scenario) -> tuple[str, ...]:
    """Warnings about a scenario, none of which stops it."""
    return (
        *model_limits(scenario.ski).values(),
        *_values_in_other_units(scenario),
        *_outside_ranges(scenario),
        *_incomplete_boot_poses(scenario),
    )


def _values_in_other_units(scenario: Scenario) -> Iterator[str]:
    """Warnings for angles that were probably given in radians, and for a hardness that probably was in N/m³."""
    angles = {"sledge.edge_angle_deg": scenario.sledge.edge_angle}
    if isinstance(scenario.slope, Plane):
        angles["slope.angle_deg"] = scenario.slope.angle
    for name, angle in angles.items():
        degrees_read = math.degrees(angle)
        meant = in_degrees_if_radians(abs(degrees_read))
        if meant is not None:
            yield Message(
                "{name} is {value:.4g}: that looks like radians. If it is, write {degrees:.4g}",
                name=name,
                value=degrees_read,
                degrees=math.copysign(meant, degrees_read),
            )
    hardness = scenario.contact.snow.snow_hardness / N_PER_MM3
    if hardness > GREATEST_LIKELY_HARDNESS:
        yield Message(
            "snow.H_V_N_per_mm3 is {hardness:.4g}: is it in N/m³? If it is, write {converted:.4g}",
            hardness=hardness,
            converted=hardness / N_PER_MM3,
        )


def _incomplete_boot_poses(scenario: Scenario) -> Iterator[str]:
    """Warning if the poses in boots.file do not cover the whole run; empty if they do."""
    boots = scenario.boots
    if boots is None:
        return
    end, unit = (scenario.stop.duration, "s") if boots.over == "time" else (scenario.stop.length, "m")
    first, last = float(boots.at[0]), float(boots.at[-1])
    if end is not None and (first > 0.0 or last < end):
        yield Message(
            "boots.file ({source}) has poses from {first:g} to {last:g} {unit} of a run from 0 to {end:g} {unit}: "
            "before and after them the boots rest",
            source=boots.source,
            first=first,
            last=last,
            end=end,
            unit=unit,
        )


ABOUT: Final = Message("a simulated run")


def _outside_ranges(scenario: Scenario) -> list[str]:
    """Warnings for hardness, stress, edge angle, friction or drag area outside their measured or usual ranges."""
    contact = scenario.contact
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        SNOW_HARDNESS.warn_outside(contact.snow.snow_hardness, ABOUT)
        FAILURE_SHEAR_STRESS.warn_outside(contact.snow.failure_shear_stress or math.nan, ABOUT)
        PENETRATION_EDGE_ANGLE.warn_outside(abs(scenario.sledge.edge_angle), ABOUT)
        if contact.friction > 0.0 or contact.friction_law is not None:  # 0 is friction switched off
            GLIDE_FRICTION.warn_outside(contact.friction_at(scenario.start.speed), ABOUT)
        if scenario.air.drag_area > 0.0:
            DRAG_AREA.warn_outside(scenario.air.drag_area, ABOUT)
    return [warning.message.message for warning in caught if isinstance(warning.message, RangeWarning)]


def model_limits(ski: Ski) -> dict[str, Message]:
    """Warnings by code: `edge_radius_unmeasured`, `side_edge_without_radius`."""
    limits = {}
    if ski.edge_radius > 0.0:
        limits["edge_radius_unmeasured"] = Message(
            "edge_radius_mm of ski {name} is {radius:.3g}: no measurement relates the radius of an edge to its grip; "
            "skisnow subtracts the depth that the rounding removes",
            name=ski.name,
            radius=ski.edge_radius / MM,
        )
    elif abs(ski.side_edge - math.pi / 2.0) > 1e-9:
        limits["side_edge_without_radius"] = Message(
            "side_edge_deg of ski {name} is {side:.4g}: it changes nothing, because it acts only with edge_radius_mm",
            name=ski.name,
            side=ski.side_edge / DEGREE,
        )
    return limits
