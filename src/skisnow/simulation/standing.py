"""Why a sledge does not come to rest where it is to start, in words."""

from __future__ import annotations

import math

import numpy as np

from ..scenario.slope_surface import down_and_left
from .run_setup import Setup, hardness_at_start


def why_no_start(setup: Setup) -> str:
    """Whether its weight passes beside what the skis can carry, or the search failed without that."""
    ahead, left = weight_meets_base(setup)
    right_end, left_end = _carried_across(setup)
    if not -right_end <= left <= left_end:
        side, reach = ("left", left_end) if left > left_end else ("right", right_end)
        return (
            "the sledge cannot stand at its start: on this slope, at this heading, its weight passes "
            f"{abs(left):.3g} m to the {side} of the boots' middle, and the skis carry to {reach:.3g} m there. Lower "
            "sledge.centre_of_mass_height_m, widen sledge.stance_width_m, or bring start.heading_deg nearer to 0"
        )
    front, rear = setup.scenario.ski.contact_points
    if not rear <= ahead <= front:
        side, reach = ("before", front) if ahead > front else ("behind", -rear)
        return (
            "the sledge cannot stand at its start: on this slope, at this heading, its weight passes "
            f"{abs(ahead):.3g} m {side} the boots, and the skis carry to {reach:.3g} m there. Change "
            "sledge.centre_of_mass_forward_m, or lower sledge.centre_of_mass_height_m"
        )
    return (
        "the search for the sledge at rest, from which the run starts, did not come to an end, although its weight "
        "falls between the skis. Take a smaller sledge.edge_angle_deg, softer snow, or a lower "
        "sledge.centre_of_mass_height_m, and please report the scenario"
    )


def weight_meets_base(setup: Setup) -> tuple[float, float]:
    """Where the line of gravity through the centre of mass meets the bases' level: ahead and left of the boots (m).

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


def _carried_across(setup: Setup) -> tuple[float, float]:
    """How far to the right and left skis can stand on the snow (m): at most from their edges to the waterline."""
    ski, angle = setup.scenario.ski, setup.scenario.sledge.edge_angle
    width, length = float(ski.width.max()), float(ski.station[0] - ski.station[-1])
    tangent = max(math.tan(abs(angle)), 1e-9)
    # all of the weight on one ski; a sledge that leans may double it
    hardness = hardness_at_start(setup.scenario)
    depth = math.sqrt(4.0 * setup.numbers["load_N"] * tangent / (hardness * 0.8 * length))
    side, wet = setup.scenario.sledge.stance_width / 2.0, min(2.0 * depth / tangent, width)
    beyond = wet - width / 2.0
    return (side + beyond, side + width / 2.0) if angle > 0.0 else (side + width / 2.0, side + beyond)
