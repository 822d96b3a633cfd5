"""Ferguson's bicubic patches over evenly spaced places, as the compiled core has them (src/core/snow/surface.cpp)."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.intp]


class Patched(NamedTuple):
    """Values at places, and their slopes along both axes for each step of the grid."""

    value: FloatArray
    slope_x: FloatArray
    slope_y: FloatArray


class _Weights(NamedTuple):
    """Weights of the two ends of a cell along one axis: what multiplies their values, and their slopes."""

    value: tuple[FloatArray, FloatArray]
    slope: tuple[FloatArray, FloatArray]


def patched(values: FloatArray, u: FloatArray, v: FloatArray) -> Patched:
    """Values (n, m) between their places.

    Parameters
    ----------
    values
        (n, m) at the places 0 to n - 1 and 0 to m - 1.
    u, v
        Places (k,) in steps of the grid, inside it.

    Notes
    -----
    Cubic Hermite in both directions without a twist at the corners; slopes at the places are central differences, at a
    border those of the parabola through three values.

    Examples
    --------
    A parabola comes back: 1.5² = 2.25, with the slope 3.

    >>> found = patched(np.arange(4.0)[:, None] ** 2, np.array([1.5]), np.zeros(1))
    >>> found.value, found.slope_x, found.slope_y
    (array([2.25]), array([3.]), array([0.]))
    """
    rows, along = _cell(u, values.shape[0])
    columns, across = _cell(v, values.shape[1])
    corners = [(i, j, rows[i], columns[j]) for i in (0, 1) for j in (0, 1)]
    at = [(values[row, column], _slope(values, row, column, 0), _slope(values, row, column, 1))
          for _, _, row, column in corners]  # fmt: skip

    def both(over_x: _Weights, over_y: _Weights) -> FloatArray:
        total = np.zeros_like(u)
        for (i, j, _, _), (value, rise_x, rise_y) in zip(corners, at, strict=True):
            total += over_y.value[j] * (over_x.value[i] * value + over_x.slope[i] * rise_x)
            total += over_x.value[i] * over_y.slope[j] * rise_y
        return total

    x, y = _hermite(along), _hermite(across)
    return Patched(both(x, y), both(_hermite_slope(along), y), both(x, _hermite_slope(across)))


def _cell(at: FloatArray, count: int) -> tuple[tuple[IntArray, IntArray], FloatArray]:
    """Both ends of the cells that places are in, and the shares of the way between them."""
    low = np.clip(np.floor(at), 0, max(count - 2, 0)).astype(np.intp)
    return (low, np.minimum(low + 1, count - 1)), np.clip(at - low, 0.0, 1.0)


def _slope(values: FloatArray, row: IntArray, column: IntArray, axis: int) -> FloatArray:
    """For each step, by differences: central inside; at a border the parabola's, or the chord's of two values."""
    count, at = values.shape[axis], (row, column)[axis]

    def value(place: IntArray) -> FloatArray:
        within = np.clip(place, 0, count - 1)
        return np.asarray(values[within, column] if axis == 0 else values[row, within])

    if count == 1:
        return np.zeros(at.shape)
    if count == 2:
        return value(np.ones_like(at)) - value(np.zeros_like(at))
    first = 0.5 * (4.0 * value(at + 1) - 3.0 * value(at) - value(at + 2))
    last = 0.5 * (3.0 * value(at) - 4.0 * value(at - 1) + value(at - 2))
    inside = 0.5 * (value(at + 1) - value(at - 1))
    return np.where(at == 0, first, np.where(at == count - 1, last, inside))


def _hermite(f: FloatArray) -> _Weights:
    e = 1.0 - f
    return _Weights((e * e * (1.0 + 2.0 * f), f * f * (3.0 - 2.0 * f)), (f * e * e, -f * f * e))


def _hermite_slope(f: FloatArray) -> _Weights:
    e = 1.0 - f
    return _Weights((-6.0 * f * e, 6.0 * f * e), (e * (1.0 - 3.0 * f), f * (3.0 * f - 2.0)))
