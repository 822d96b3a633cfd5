"""Checks of the force laws: parameters that no snow can have, and angles that look like degrees."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError

RIGHT_ANGLE = math.pi / 2.0


def require_above_zero(owner: object, **parameters: float) -> None:
    """Refuse a parameter that is not a finite number above 0."""
    for name, value in parameters.items():
        if not (math.isfinite(value) and value > 0):
            raise ParameterError(
                "{kind}: {name} is {value!r}; it must be a finite number above 0",
                code="out_of_range",
                kind=type(owner).__name__,
                name=name,
                value=value,
            )


def require_not_below_zero(owner: object, **parameters: float) -> None:
    """Refuse a parameter that is not a finite number of at least 0."""
    for name, value in parameters.items():
        if not (math.isfinite(value) and value >= 0):
            raise ParameterError(
                "{kind}: {name} is {value!r}; it must be a finite number, 0 or above",
                code="out_of_range",
                kind=type(owner).__name__,
                name=name,
                value=value,
            )


def require_finite(owner: object, **parameters: float) -> None:
    """Reject a parameter that is not a finite number."""
    for name, value in parameters.items():
        if not math.isfinite(value):
            raise ParameterError(
                "{kind}: {name} is {value!r}; it must be a finite number",
                code="not_a_number",
                kind=type(owner).__name__,
                name=name,
                value=value,
            )


def edge_angles(edge_angle: npt.ArrayLike) -> FloatArray:
    """The edge angles as an array, refused unless all are in 0 ≤ ϑ ≤ π/2 rad."""
    angle = np.asarray(edge_angle, float)
    # to one part in 10⁹: 90° through a unit conversion is a right angle
    wrong = ~((angle >= 0.0) & (angle <= RIGHT_ANGLE * (1.0 + 1e-9)))
    if np.any(wrong):
        first = float(angle[wrong].flat[0])
        raise ParameterError(
            "edge angle is {edge_angle!r} rad; it must be between 0 and π/2 rad (0° and 90°): an angle in degrees "
            "must be converted with math.radians",
            code="out_of_range",
            edge_angle=first,
        )
    return angle
