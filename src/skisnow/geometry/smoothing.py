"""Smoothing of a surface to a length: the Gaussian filter of surface texture."""

from __future__ import annotations

import math
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]

HALVING: Final = math.sqrt(math.log(2.0) / math.pi)
"""α of ISO 16610-21: with it a wave of the cut-off length keeps half of its height."""


def smoothed(values: FloatArray, steps: tuple[float, float], *, cutoff: float) -> FloatArray:
    """Values over a grid without what is shorter than a length.

    Parameters
    ----------
    values
        (n, m) at evenly spaced places.
    steps
        Between the places along both axes (m), > 0.
    cutoff
        Length λ_c ≥ 0 (m) of the wave that keeps half of its height; one of twice the length keeps 84 %, one of half
        the length 6 %. 0: nothing is smoothed.

    Notes
    -----
    Weights w(t) = exp(-π (t/(α λ_c))²), α = √(ln 2/π), up to |t| = λ_c, along one axis after the other (ISO 16610-21).
    Near a border the value of the straight line through the weighted values: a plane stays a plane everywhere.

    Examples
    --------
    >>> plane = np.add.outer(np.arange(3.0), 2.0 * np.arange(4.0))
    >>> bool(np.allclose(smoothed(plane, (1.0, 1.0), cutoff=5.0), plane))
    True
    """
    if cutoff <= 0.0:
        return values
    return _along_first(_along_first(values, steps[0], cutoff).T, steps[1], cutoff).T


def _along_first(values: FloatArray, step: float, cutoff: float) -> FloatArray:
    """A straight line of weighted least squares through the neighbours of each place, taken at the place."""
    count = len(values)
    reach = min(math.ceil(cutoff / step), count - 1)
    sums, moments = np.zeros((3, count)), np.zeros((2, *values.shape))
    for k in range(-reach, reach + 1):
        weight = math.exp(-math.pi * (k * step / (HALVING * cutoff)) ** 2)
        here, there = slice(max(0, -k), count - max(0, k)), slice(max(0, k), count - max(0, -k))
        for power in range(3):
            sums[power, here] += weight * float(k) ** power
        for power in range(2):
            moments[power, here] += weight * float(k) ** power * values[there]
    determinant = sums[0] * sums[2] - sums[1] ** 2
    if reach == 0 or determinant.min() < 1e-12:  # the step is far longer than what is to go
        return values
    return np.asarray((sums[2, :, None] * moments[0] - sums[1, :, None] * moments[1]) / determinant[:, None])
