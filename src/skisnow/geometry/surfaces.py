"""Surfaces of a slope z(x, y): planes and grids with bicubic patches, and smoothing of measured heights."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import ShownFields

EVEN = 1e-9
"""Share of the spacing by which places of a grid may lie unevenly: rounding."""


@dataclass(frozen=True, slots=True)
class Plane:
    """The plane z = 0: the slope's own axes, x down the fall line, y left, z out of the snow (m)."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Grid(ShownFields):
    """Values over evenly spaced places, joined by smooth patches.

    x, y: places (m), (n,) and (m,), evenly spaced and rising; one place in x or y: the same at every x or y.
    values: (n, m): height (m), or another quantity over the place in its unit.
    Raises ParameterError: places are not evenly spaced and rising, shapes do not fit, or a number is not finite.

    Ferguson's bicubic patches with slopes from central differences: value and slope are continuous, a plane is exact.
    Beyond the border a height continues along its slope, another quantity with its last value.
    """

    x: FloatArray
    y: FloatArray
    values: FloatArray

    def __post_init__(self) -> None:
        for name in ("x", "y", "values"):
            array = np.array(getattr(self, name), float, ndmin=2 if name == "values" else 1)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
            if not np.all(np.isfinite(array)):
                raise ParameterError("Grid: {name} contains a number that is not finite").tag("not_a_number", name=name)
        for name, places in (("x", self.x), ("y", self.y)):
            _require_even(name, places)
        if self.values.shape != (len(self.x), len(self.y)):
            raise ParameterError(
                "Grid: values have shape {shape}; for {n_x} places in x and {n_y} in y it must be {needed}"
            ).tag(
                "wrong_shape",
                shape=str(self.values.shape),
                n_x=len(self.x),
                n_y=len(self.y),
                needed=str((len(self.x), len(self.y))),
            )

    @property
    def steps(self) -> tuple[float, float]:
        """Spacing of the places in x and in y (m); 1 for a single place."""
        x, y = (float(np.ptp(places)) / (len(places) - 1) if len(places) > 1 else 1.0 for places in (self.x, self.y))
        return x, y

    def heights(self, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
        """Heights (m) at places x, y (m, of shapes that go together); beyond the border along its slope."""
        return self._extrapolated(x, y)[0]

    def gradients(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """dz/dx and dz/dy at places x, y (m); beyond the border those of the border."""
        _, along_x, along_y = self._extrapolated(x, y)
        return along_x, along_y

    def values_at(self, x: npt.ArrayLike, y: npt.ArrayLike) -> FloatArray:
        """Values of a grid at places x, y (m); beyond the border its last value."""
        return self._patched(x, y)[0]

    def _patched(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Value, dz/dx, dz/dy, and the change of the value beyond the border along these slopes; 0 inside."""
        at = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        steps, first = self.steps, (self.x[0], self.y[0])
        counts = self.values.shape
        where = [(coordinate.ravel() - start) / step for coordinate, start, step in zip(at, first, steps, strict=True)]
        inside = [np.clip(coordinate, 0.0, count - 1.0) for coordinate, count in zip(where, counts, strict=True)]
        value, per_x, per_y = interpolate_patches(self.values, *inside)
        beyond = (where[0] - inside[0]) * per_x + (where[1] - inside[1]) * per_y
        shape = at[0].shape
        slopes = (per_x / steps[0], per_y / steps[1])
        return value.reshape(shape), slopes[0].reshape(shape), slopes[1].reshape(shape), beyond.reshape(shape)

    def _extrapolated(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Value, dz/dx and dz/dy at places (m); beyond the border the value continues with the slope of the border."""
        value, along_x, along_y, beyond = self._patched(x, y)
        return value + beyond, along_x, along_y

    @classmethod
    def along(cls, x: npt.ArrayLike, values: npt.ArrayLike) -> Grid:
        """Values over x (n,), the same at every y: a profile."""
        return cls(np.asarray(x, float), np.zeros(1), np.asarray(values, float)[:, None])


def _require_even(name: str, places: FloatArray) -> None:
    """Reject places (m) that are no row, or that do not rise in equal steps."""
    if places.ndim != 1 or not len(places):
        raise ParameterError("Grid: {name} must be a row of one place or more, its shape is {shape}").tag(
            "wrong_shape", name=name, shape=str(places.shape)
        )
    step = np.diff(places)
    if len(step) and (step.min() <= 0.0 or np.ptp(step) > EVEN * len(step) * np.abs(places).max()):
        raise ParameterError("Grid: places in {name} must rise evenly; their steps go from {min:g} to {max:g} m").tag(
            "not_rising", name=name, min=step.min(), max=step.max()
        )


IntArray: TypeAlias = npt.NDArray[np.intp]


class _Weights(NamedTuple):
    """Weights of the two ends of a cell along one axis: factors of their values and of their slopes."""

    value: tuple[FloatArray, FloatArray]
    slope: tuple[FloatArray, FloatArray]


def interpolate_patches(values: FloatArray, u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values of a grid (n, m) at places u, v in cells, and their slopes along both axes for each step of the grid.

    values: (n, m) at the places 0 to n - 1 and 0 to m - 1.
    u, v: places (k,) in steps of the grid, inside it.

    Cubic Hermite in both directions without a twist at the corners; slopes at the places are central differences, at a
    border those of the parabola through three values.

    A parabola comes back: 1.5² = 2.25, with the slope 3.

    >>> interpolate_patches(np.arange(4.0)[:, None] ** 2, np.array([1.5]), np.zeros(1))
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

    x, y = _hermite_weights(along), _hermite_weights(across)
    return both(x, y), both(_hermite_slope(along), y), both(x, _hermite_slope(across))


def _cell(at: FloatArray, count: int) -> tuple[tuple[IntArray, IntArray], FloatArray]:
    """Indices of both ends of each place's cell along an axis, and the share of the cell before the place."""
    low = np.clip(np.floor(at), 0, max(count - 2, 0)).astype(np.intp)
    return (low, np.minimum(low + 1, count - 1)), np.clip(at - low, 0.0, 1.0)


def _slope(values: FloatArray, row: IntArray, column: IntArray, axis: int) -> FloatArray:
    """Differences of the values per step along an axis: central inside, of a parabola (or chord of two) at a border."""
    count, at = values.shape[axis], (row, column)[axis]

    def value(place: IntArray) -> FloatArray:
        within = np.minimum(np.maximum(place, 0), count - 1)
        return np.asarray(values[within, column] if axis == 0 else values[row, within])

    if count == 1:
        return np.zeros(at.shape)
    if count == 2:
        return value(np.ones_like(at)) - value(np.zeros_like(at))
    here, ahead, behind = value(at), value(at + 1), value(at - 1)
    first = 0.5 * (4.0 * ahead - 3.0 * here - value(at + 2))
    last = 0.5 * (3.0 * here - 4.0 * behind + value(at - 2))
    inside = 0.5 * (ahead - behind)
    return np.where(at == 0, first, np.where(at == count - 1, last, inside))


def _hermite_weights(f: FloatArray) -> _Weights:
    """Weights of the ends of a cell for the value of the cubic at its share f (0 to 1)."""
    e = 1.0 - f
    return _Weights((e * e * (1.0 + 2.0 * f), f * f * (3.0 - 2.0 * f)), (f * e * e, -f * f * e))


def _hermite_slope(f: FloatArray) -> _Weights:
    """Weights of the ends of a cell for the slope of the cubic at its share f, per step."""
    e = 1.0 - f
    return _Weights((-6.0 * f * e, 6.0 * f * e), (e * (1.0 - 3.0 * f), f * (3.0 * f - 2.0)))


HALVING: Final = math.sqrt(math.log(2.0) / math.pi)
"""α of ISO 16610-21: with it a wave of the cut-off length keeps half of its height."""


def smoothed(values: FloatArray, steps: tuple[float, float], *, cutoff: float) -> FloatArray:
    """Values over a grid after a Gaussian filter that removes waves shorter than a length.

    values: (n, m) at evenly spaced places.
    steps: between the places along both axes (m), > 0.
    cutoff: length λ_c ≥ 0 (m) of the wave that keeps half of its height; one of twice the length keeps 84 %, one of
        half the length 6 %. 0: nothing is smoothed.

    Weights w(t) = exp(-π (t/(α λ_c))²), α = √(ln 2/π), up to |t| = λ_c, along one axis after the other (ISO 16610-21).
    Near a border the value of the straight line through the weighted values: a plane stays a plane everywhere.

    >>> plane = np.add.outer(np.arange(3.0), 2.0 * np.arange(4.0))
    >>> bool(np.allclose(smoothed(plane, (1.0, 1.0), cutoff=5.0), plane))
    True
    """
    if cutoff <= 0.0:
        return values
    return _local_lines(_local_lines(values, steps[0], cutoff).T, steps[1], cutoff).T


def _local_lines(values: FloatArray, step: float, cutoff: float) -> FloatArray:
    """Values along the first axis, each replaced by the line fitted to its neighbours by weighted least squares."""
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
