"""What a scenario must hold to, whether it comes from a file or from Python."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Final

from ...errors import ParameterError
from ...units import DEGREE, MM
from .slope import Profile

if TYPE_CHECKING:
    from .scenario import Scenario

GREATEST_EDGE_ANGLE: Final = math.radians(85.0)
"""(rad): at 90° an edge bears nothing."""
STEPS: Final = (1e-6, 5e-3)
"""Shortest and longest first step (s): below, rounding counts; above, a ski's first bending mode is not resolved."""


def require_sound(scenario: Scenario) -> None:
    """Refuse what cannot be computed, or would be nonsense if it were.

    Raises
    ------
    ParameterError
        The first thing that is wrong: what it is, what is allowed, what to do.
    """
    for complaint in (*_numbers(scenario), *_together(scenario)):
        raise ParameterError(complaint)


def _numbers(scenario: Scenario) -> Iterator[str]:
    solver, contact, air = scenario.solver, scenario.contact, scenario.air
    shortest, longest = STEPS
    yield from _outside("the edge angle", scenario.sledge.edge_angle, -GREATEST_EDGE_ANGLE, GREATEST_EDGE_ANGLE, DEGREE)
    yield from _outside("the first step", solver.step, shortest, longest, 1e-3, "ms")
    yield from _outside("the tolerance", solver.tolerance, 1e-12, 0.01, MM, "mm")
    yield from _outside("the output interval", solver.output_interval, 1e-4, 1.0, 1e-3, "ms")
    yield from _outside("the unloading ratio k_u/H_V", contact.unloading_ratio, 1.0, 1000.0)
    yield from _outside("the friction at rest", contact.friction, 0.0, 1.0)
    yield from _outside("the drag area", air.drag_area, 0.0, 10.0, 1.0, "m²")
    yield from _outside("the air's density", air.density, 0.0, 2.0, 1.0, "kg/m³")
    yield from _outside("the damping ratio", scenario.damping_ratio, 0.0, 1.0)
    yield from _outside("the start's speed", scenario.start.speed, 0.0, 100.0, 1.0, "m/s")
    yield from _outside("gravity", scenario.gravity, 1e-6, 100.0, 1.0, "m/s²")
    if solver.method == "fast" and not solver.fixed:
        yield (
            'solver.fixed is false beside solver.method = "fast", which has no control of the error: its steps are '
            'fixed. Leave solver.fixed out or write true, or take solver.method = "ros2"'
        )
    for name, value in (("duration", scenario.stop.duration), ("length", scenario.stop.length)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            yield f"the run's {name} is {value:g}; it must be a finite number above 0"


def _outside(
    name: str, value: float, lowest: float, highest: float, unit: float = 1.0, symbol: str = ""
) -> Iterator[str]:
    if not lowest <= value <= highest:
        shown = [f"{each / unit:.6g}" for each in (value, lowest, highest)]
        ending = f" {symbol or ('degrees' if unit == DEGREE else '')}".rstrip()
        yield f"{name} is {shown[0]}; allowed is from {shown[1]} to {shown[2]}{ending}"


def _together(scenario: Scenario) -> Iterator[str]:
    sledge, ski, start = scenario.sledge, scenario.ski, scenario.start
    width = float(ski.width.max())
    if sledge.stance_width < width * (1.0 - 1e-9):  # the width of a ski file is rounded on its way to metres
        yield (
            f"the stance width is {sledge.stance_width:g} m; the ski {ski.name} is {width:.3g} m wide, and two "
            f"must have room side by side: {width:.3g} m or more"
        )
    most = 2.0 * min(float(ski.station[0]), -float(ski.station[-1]))
    if not 0.0 <= scenario.clamp_length < most:
        yield (
            f"the clamp length is {scenario.clamp_length:g} m; the ski {ski.name} allows less than {most:.3g} m. Write "
            "0 for a binding that bends with the ski"
        )
    friction = scenario.contact.friction + scenario.contact.friction_by_speed * start.speed
    if friction < 0.0:
        yield f"the friction at the start's speed, μ_0 + μ_1 v, is {friction:.3g}; below 0 it would drive the ski"
    if isinstance(scenario.slope, Profile):
        first, last = scenario.slope.ends
        if not first <= start.x <= last:
            yield f"the start, x = {start.x:g} m, is off the profile, which reaches from {first:g} to {last:g} m"
