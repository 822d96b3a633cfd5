"""Why a sledge finds no equilibrium to start from, and the largest value with which it stands."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from .._support.errors import SolverError
from .._support.messages import Message, template
from .._support.units import DEGREE
from ..scenario import RigidSledge
from ..scenario.terrain import down_and_left
from .run_setup import AT_REST, PITCHED, TIPPED, Setup, hardness_at_start, laid_out

HALVINGS: Final = 6
"""Halvings of the range in which the largest value with which a sledge stands is searched for."""
_LOWEST: Final = 0.02
"""Share of its value below which that search does not look."""
_BESIDE: Final = {
    "left": template(
        "the sledge falls over at its start: on this slope, at this heading, its weight passes {away:.3g} m to the "
        "left of the boots' middle, and the skis carry to {reach:.3g} m there. Lower sledge.centre_of_mass_height_m, "
        "widen sledge.stance_width_m, or bring start.heading_deg nearer to 0"
    ),
    "right": template(
        "the sledge falls over at its start: on this slope, at this heading, its weight passes {away:.3g} m to the "
        "right of the boots' middle, and the skis carry to {reach:.3g} m there. Lower sledge.centre_of_mass_height_m, "
        "widen sledge.stance_width_m, or bring start.heading_deg nearer to 0"
    ),
    "before": template(
        "the sledge falls over at its start: on this slope, at this heading, its weight passes {away:.3g} m before the "
        "boots, and the skis carry to {reach:.3g} m there. Change sledge.centre_of_mass_forward_m, or lower "
        "sledge.centre_of_mass_height_m"
    ),
    "behind": template(
        "the sledge falls over at its start: on this slope, at this heading, its weight passes {away:.3g} m behind the "
        "boots, and the skis carry to {reach:.3g} m there. Change sledge.centre_of_mass_forward_m, or lower "
        "sledge.centre_of_mass_height_m"
    ),
}


def no_start(setup: Setup) -> SolverError:
    """Error for a sledge without an equilibrium, with a value with which it does not fall.

    Where the weight passes between the skis, the snow below them may still give way: the sledge leans, which moves its
    weight further out. Above some height of the centre of mass nothing stops that.
    """
    ahead, left = weight_meets_base(setup)
    right_end, left_end = _carried_across(setup)
    front, rear = setup.scenario.ski.contact_points
    beside = {
        "left": (left, left_end),
        "right": (-left, right_end),
        "before": (ahead, front),
        "behind": (-ahead, -rear),
    }
    for side, (away, reach) in beside.items():
        if away > reach:
            return SolverError(Message(_BESIDE[side], away=away, reach=reach)).tag("no_start", side=side)
    sledge = setup.scenario.sledge
    forward, height = sledge.centre_of_mass
    tries: dict[str, tuple[float, Callable[[float], RigidSledge]]] = {
        "sledge.centre_of_mass_height_m": (height, lambda x: replace(sledge, centre_of_mass=(forward, x))),
        "sledge.centre_of_mass_forward_m": (forward, lambda x: replace(sledge, centre_of_mass=(x, height))),
        "sledge.edge_angle_deg": (sledge.edge_angle / DEGREE, lambda x: replace(sledge, edge_angle=x * DEGREE)),
    }
    for key, (value, sledge_with) in tries.items():
        stands_with = largest_standing(setup, value, sledge_with)
        if stands_with is not None:
            return SolverError(
                "the sledge falls over at its start: its weight passes between the skis, but leans it further as the "
                "snow gives way. It stands with a {key} of {stands_with:g}; the scenario has {value:.3g}. Take that, "
                "or harder snow"
            ).tag("no_start", key=key, stands_with=stands_with, value=value)
    return SolverError(
        "the search for the sledge at rest, from which the run starts, did not come to an end, although its weight "
        "falls between the skis. Take a smaller sledge.edge_angle_deg, a stiffer ski, softer snow, or a lower "
        "sledge.centre_of_mass_height_m, and please report the scenario"
    ).tag("no_start")


def largest_standing(setup: Setup, value: float, sledge_with: Callable[[float], RigidSledge]) -> float | None:
    """Largest number below `value` with which the sledge does not fall over, by bisection, to two digits; None: none.

    sledge_with: sledge with a number in place of the scenario's value, such as its height of the centre of mass.

    Sledges with boots that move are not tried: their control decides where the weight is.
    """
    if setup.drive is not None or value == 0.0 or not _rests_upright(setup, sledge_with(_LOWEST * value)):
        return None
    low, high = _LOWEST, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if _rests_upright(setup, sledge_with(middle * value)) else (low, middle)
    return _two_digits(low * value)


def _rests_upright(setup: Setup, sledge: RigidSledge) -> bool:
    trial = laid_out(replace(setup.scenario, sledge=sledge), setup.snow)
    rests = trial.dynamics.find_equilibrium() <= AT_REST
    leaning, pitching = trial.tilt
    return rests and leaning <= TIPPED and pitching <= PITCHED


def _two_digits(value: float) -> float:
    """Value rounded to two digits towards 0, so that the sledge does not fall with it."""
    step = 10.0 ** (math.floor(math.log10(abs(value))) - 1)
    return float(f"{math.trunc(value / step) * step:.2g}")


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


def _carried_across(setup: Setup) -> tuple[float, float]:
    """Largest distance (m) right and left at which snow can support the skis: from edges to waterline."""
    ski, angle = setup.scenario.ski, setup.scenario.sledge.edge_angle
    width, length = float(ski.width.max()), float(ski.station[0] - ski.station[-1])
    tangent = max(math.tan(abs(angle)), 1e-9)
    # all of the weight on one ski; a sledge that leans may double it
    hardness = hardness_at_start(setup.scenario)
    depth = math.sqrt(4.0 * setup.numbers["load_N"] * tangent / (hardness * 0.8 * length))
    side, wet = setup.scenario.sledge.stance_width / 2.0, min(2.0 * depth / tangent, width)
    beyond = wet - width / 2.0
    return (side + beyond, side + width / 2.0) if angle > 0.0 else (side + width / 2.0, side + beyond)
