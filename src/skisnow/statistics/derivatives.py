"""Derivatives of a model by its parameters, by differences whose step the model itself chooses.

A step that is a fixed share of the parameter is wrong wherever a parameter is large beside the distance over which the
model changes: the place of a narrow peak, a period. Here the differences of a ladder of halved steps are extrapolated
to step zero (Ridders, 1982, Adv. Eng. Softw. 4, 75-76), and of all extrapolations the one that agrees best with its
neighbours is taken.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from .least_squares import FloatArray

Values: TypeAlias = "Callable[[FloatArray], FloatArray]"

_COARSE_STEP: Final = float(np.finfo(float).eps) ** (1.0 / 3.0)
"""Of a plain central difference: its truncation h² equals the rounding eps/h."""
_FIRST_STEP: Final = 0.1
"""The longest step of the ladder, as a share of the parameter, or of what changes the model by its own size."""
_RUNGS: Final = 9
_WORSE: Final = 4.0
_AT_ZERO: Final = 1e-6
"""A parameter not above this share of its scale lies at zero: the scale sets its step."""


@dataclass(frozen=True)
class Jacobian:
    """Derivatives (n, p) of n values by p parameters, and how far each may be off, (n, p) too."""

    values: FloatArray
    error: FloatArray


def coarse_jacobian(values: Values, b: FloatArray, scale: FloatArray) -> FloatArray:
    """Half the digits, at two evaluations for each parameter: good enough on the way to a solution."""
    return np.stack([_central(values, b, j, _COARSE_STEP * size) for j, size in enumerate(_sizes(b, scale))], axis=-1)


def jacobian(values: Values, b: FloatArray, scale: FloatArray) -> Jacobian:
    """All but the last digits, at up to 20 evaluations for each parameter.

    Parameters
    ----------
    values
        Function of the parameters that returns the n values of the model.
    b
        The parameters, shape (p,).
    scale
        Above 0, shape (p,): the size of a parameter that lies at 0.
    """
    here = float(np.linalg.norm(values(b)))
    coarse = np.linalg.norm(coarse_jacobian(values, b, scale), axis=0)
    reach = np.divide(here, coarse, out=np.full(len(b), np.inf), where=coarse > 0)
    columns = [
        _extrapolated(values, b, j, _FIRST_STEP * float(min(size, far)))
        for j, (size, far) in enumerate(zip(_sizes(b, scale), reach, strict=True))
    ]
    return Jacobian(*(np.stack(part, axis=-1) for part in zip(*columns, strict=True)))


def _sizes(b: FloatArray, scale: FloatArray) -> FloatArray:
    return np.where(np.abs(b) > _AT_ZERO * scale, np.abs(b), scale)


def _central(values: Values, b: FloatArray, j: int, size: float) -> FloatArray:
    above, below = b.copy(), b.copy()
    above[j] += size
    below[j] -= size
    with np.errstate(all="ignore"):  # a long step may leave the model's domain: it is not taken then
        return np.asarray((values(above) - values(below)) / (above[j] - below[j]))


def _extrapolated(values: Values, b: FloatArray, j: int, size: float) -> tuple[FloatArray, FloatArray]:
    """Column j, and its error, from the entry of Neville's tableau that agrees best with the two it comes from."""
    first = _central(values, b, j, size)
    best, error, least, above = first, np.full_like(first, np.inf), np.inf, [first]
    for rung in range(1, _RUNGS):
        row, closest = [_central(values, b, j, size / 2.0**rung)], np.inf
        for order, before in enumerate(above, start=1):
            with np.errstate(all="ignore"):
                row.append(row[-1] + (row[-1] - before) / (4.0**order - 1.0))
                apart = np.maximum(np.abs(row[-1] - row[-2]), np.abs(row[-1] - before))
                distance = float(np.linalg.norm(apart))
            closest = min(closest, distance)
            if distance < least:
                best, error, least = row[-1], apart, distance
        if closest > _WORSE * least:  # shorter steps only add rounding
            break
        above = row
    return best, error
