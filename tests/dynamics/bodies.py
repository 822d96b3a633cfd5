"""Bodies on one and three skis, and bodies without skis to speak of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from skisnow import Scenario
from skisnow.dynamics import Body

from .sledges import body_of

FloatArray = npt.NDArray[np.float64]
NO_STANCE = 1e-9
"""Between the middles of two skis (m) that are to lie at one place."""


def cross_matrix(v: FloatArray) -> FloatArray:
    """Of v × ."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def without_skis(scenario: Scenario) -> tuple[FloatArray, float, FloatArray]:
    """Mass matrix (6, 6), mass (kg) and first moment (kg m) of a sledge alone."""
    sledge = scenario.sledge
    centre = np.array([sledge.centre_of_mass[0], 0.0, sledge.centre_of_mass[1]])
    arm = np.hstack([np.eye(3), -cross_matrix(centre)])
    inertia = sledge.mass * arm.T @ arm
    inertia[3:, 3:] += np.diag(sledge.inertia)
    return inertia, sledge.mass, sledge.mass * centre


def on_one_ski(scenario: Scenario) -> Body:
    """The sledge on a single ski under its middle: half of two skis at one place."""
    alone, mass, moment = without_skis(scenario)
    pair = body_of(scenario, sledge=replace(scenario.sledge, stance_width=NO_STANCE))
    return replace(
        pair,
        inertia=(alone + pair.inertia) / 2.0,
        mass=(mass + pair.mass) / 2.0,
        first_moment=(moment + pair.first_moment) / 2.0,
        skis=pair.skis[:1],
    )


def on_three_skis(scenario: Scenario) -> Body:
    """The sledge on its two skis and one between them."""
    alone, mass, moment = without_skis(scenario)
    sides, middle = body_of(scenario), on_one_ski(scenario)
    return replace(
        sides,
        inertia=sides.inertia + middle.inertia - alone,
        mass=sides.mass + middle.mass - mass,
        first_moment=sides.first_moment + middle.first_moment - moment,
        skis=(sides.skis[0], middle.skis[0], sides.skis[1]),
    )


def rigid(body: Body, inertia: FloatArray) -> Body:
    """The same skis without mass to speak of, on a body with this inertia about its origin, its centre of mass."""
    light = tuple(
        replace(ski, mass=1e-9 * ski.mass, coupling=np.zeros_like(ski.coupling), damping=0.0) for ski in body.skis
    )
    matrix = np.diag([body.mass] * 3 + [0.0] * 3)
    matrix[3:, 3:] = np.diag(inertia)
    return replace(body, inertia=matrix, first_moment=np.zeros(3), skis=light, drag=0.0)
