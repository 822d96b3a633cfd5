"""Local cubic least squares: place, velocity and acceleration at each point from the points in a window of time.

This is the Savitzky-Golay filter (1964, doi 10.1021/ac60214a047) for uneven spacing: every window is fitted by weighted
least squares at its times, to places and to recorded velocities.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, IntArray

TERMS: Final = 4
"""Coefficients of a cubic."""
FEWEST_POINTS: Final = 6
"""Minimum number of points in a window: four for the cubic, and two for its scatter."""
_RIDGE: Final = 1e-13
"""Share of its trace that is added to a matrix of normal equations; regular ones have eigenvalues above 10⁻³."""
_CENTRES_APART: Final = 0.05
"""Length of the intervals of time that share one fit, in half windows."""
_CROWDED: Final = 80
"""Number of points in a window above which neighbouring points share a fit."""
_CHUNK: Final = 8192
"""Number of points that are processed together, so that their moments stay in the cache."""


@dataclass(frozen=True, slots=True)
class WeightedValues:
    """Values (n, d) with weights (n,); a point with weight 0 is not fitted."""

    values: FloatArray
    weight: FloatArray


@dataclass(frozen=True, slots=True)
class LocalCubic:
    """Fits in all windows, in the variable τ = (t − t_i)/h about each point.

    coefficients: (n, 4, d), coefficients of τ⁰ to τ³, that of τ⁰ relative to the point's value; NaN if a window has too
        few points.
    covariance: (n, 4, 4), covariance of the coefficients of one coordinate, for values with the variance 1/weight.
    place_misfit, rate_misfit: (n,), weighted sums of squared residuals of places and of velocities, over all
        coordinates.
    place_count, rate_count: (n,), number of points in the window with a weight above 0.
    """

    coefficients: FloatArray
    covariance: FloatArray
    place_misfit: FloatArray
    rate_misfit: FloatArray
    place_count: IntArray
    rate_count: IntArray


def local_cubic(
    time: FloatArray,
    windows: tuple[IntArray, IntArray],
    half: float,
    place: WeightedValues,
    rate: WeightedValues | None,
) -> LocalCubic:
    """Fit every window. If points are dense, neighbours within 1/40 of a window share a fit.

    time: (n,) s, never falling.
    windows: (n,), (n,), first point of each window, and the one after its last.
    half: s, scale of τ, half of a window.
    place, rate: places (m), and velocities (m/s) or None.
    """
    first, last = windows
    centre_of, centres = _centres(time, windows, half)
    pieces = []
    for start in range(0, len(centres), _CHUNK):
        chunk = centres[start : start + _CHUNK]
        sums = _Moments(len(chunk), place.values.shape[1])
        for offset in range(int((first[chunk] - chunk).min()), int((last[chunk] - chunk).max())):
            sums.add(time, (chunk, first[chunk], last[chunk], offset), half, place, rate)
        pieces.append(_solve(sums, half))
    fits = LocalCubic(*(np.concatenate(parts) for parts in zip(*pieces, strict=True)))
    return fits if len(centres) == len(time) else _shift_fits(fits, (time, half), centres, centre_of, place.values)


def _centres(time: FloatArray, windows: tuple[IntArray, IntArray], half: float) -> tuple[IntArray, IntArray]:
    """Number (n,) of the centre of each point, and the points that are centres (m,).

    A dense interval of time has one centre. Points whose windows differ at a gap or an end do not share one.
    """
    first, last = windows
    cell = np.floor((time - time[0]) / (_CENTRES_APART * half))
    begins = np.ones(len(time), dtype=bool)
    crowded = np.minimum(last - first, np.roll(last - first, 1))[1:] > _CROWDED
    same_part = (np.diff(first) < _CROWDED) & (np.diff(last) < _CROWDED)
    begins[1:] = ~((np.diff(cell) == 0.0) & crowded & same_part)
    starts = np.flatnonzero(begins)
    ends = np.append(starts[1:], len(time)) - 1
    return np.cumsum(begins) - 1, (starts + ends) // 2


def _shift_fits(
    fits: LocalCubic, scale: tuple[FloatArray, float], centres: IntArray, centre_of: IntArray, values: FloatArray
) -> LocalCubic:
    """Fits about each point from the fits about the centres: the same cubics in a shifted variable."""
    time, half = scale
    tau = (time - time[centres][centre_of]) / half
    shift = np.zeros((len(time), TERMS, TERMS))
    for row in range(TERMS):
        for column in range(row, TERMS):
            shift[:, row, column] = comb(column, row) * tau ** (column - row)
    coefficients = shift @ fits.coefficients[centre_of]
    coefficients[:, 0] += values[centres][centre_of] - values
    covariance = shift @ fits.covariance[centre_of] @ shift.transpose(0, 2, 1)
    return LocalCubic(
        coefficients,
        covariance,
        fits.place_misfit[centre_of],
        fits.rate_misfit[centre_of],
        fits.place_count[centre_of],
        fits.rate_count[centre_of],
    )


class _Moments:
    """Sums over the windows of all points for the normal equations of the local cubics: weights, values and rates."""

    def __init__(self, count: int, coordinates: int) -> None:
        self.place = np.zeros((2 * TERMS - 1, count))
        self.place_values = np.zeros((TERMS, count, coordinates))
        self.place_squares = np.zeros(count)
        self.rate = np.zeros((2 * TERMS - 3, count))
        self.rate_values = np.zeros((TERMS - 1, count, coordinates))
        self.rate_squares = np.zeros(count)
        self.place_count = np.zeros(count, dtype=np.int64)
        self.rate_count = np.zeros(count, dtype=np.int64)

    def add(
        self,
        time: FloatArray,
        where: tuple[IntArray, IntArray, IntArray, int],
        half: float,
        place: WeightedValues,
        rate: WeightedValues | None,
    ) -> None:
        """Add the point with the number ``offset`` above each point if it is in its window."""
        point, first, last, offset = where
        other = np.clip(point + offset, 0, len(time) - 1)
        inside = (point + offset >= first) & (point + offset < last)
        tau = (time[other] - time[point]) / half
        weight = np.where(inside, place.weight[other], 0.0)
        apart = place.values[other] - place.values[point]
        self.place_count += weight > 0.0
        self.place_squares += weight * np.einsum("nd,nd->n", apart, apart)
        _add_powers(self.place, self.place_values, tau, weight, apart)
        if rate is not None:
            weight = np.where(inside, rate.weight[other], 0.0)
            faster = rate.values[other]
            self.rate_count += weight > 0.0
            self.rate_squares += weight * np.einsum("nd,nd->n", faster, faster)
            _add_powers(self.rate, self.rate_values, tau, weight, faster)


def _add_powers(
    moments: FloatArray, products: FloatArray, tau: FloatArray, weight: FloatArray, values: FloatArray
) -> None:
    power = weight.copy()
    for exponent in range(len(moments)):
        moments[exponent] += power
        if exponent < len(products):
            products[exponent] += power[:, None] * values
        power *= tau


def _solve(sums: _Moments, half: float) -> tuple[npt.NDArray[np.generic], ...]:
    """Solve the normal equations; return the fields of a LocalCubic."""
    order = np.arange(TERMS)
    of_place = np.moveaxis(sums.place[order[:, None] + order], -1, 0)
    of_rate = np.zeros_like(of_place)
    below = np.arange(1, TERMS)
    slopes = np.multiply.outer(below, below) / half**2  # derivatives of τ^p and τ^q by time: p q τ^(p+q-2) / h²
    of_rate[:, 1:, 1:] = slopes * np.moveaxis(sums.rate[below[:, None] + below - 2], -1, 0)
    right_place = np.moveaxis(sums.place_values, 0, 1)
    right_rate = np.zeros_like(right_place)
    right_rate[:, 1:] = below[:, None] / half * np.moveaxis(sums.rate_values, 0, 1)
    enough = sums.place_count >= FEWEST_POINTS
    covariance = np.full_like(of_place, np.nan)
    normal = (of_place + of_rate)[enough]
    ridge = _RIDGE * np.trace(normal, axis1=1, axis2=2)
    covariance[enough] = np.linalg.inv(normal + ridge[:, None, None] * np.eye(TERMS))
    coefficients = covariance @ (right_place + right_rate)
    return (
        coefficients,
        covariance,
        _misfit(sums.place_squares, coefficients, of_place, right_place),
        _misfit(sums.rate_squares, coefficients, of_rate, right_rate),
        sums.place_count,
        sums.rate_count,
    )


def _misfit(squares: FloatArray, coefficients: FloatArray, normal: FloatArray, right: FloatArray) -> FloatArray:
    """Σ w (y − Xβ)² = Σ w y² − 2 β·b + βᵀ N β, for the observations of one kind."""
    explained = np.einsum("nkd,nkd->n", coefficients, 2.0 * right - normal @ coefficients)
    return np.maximum(squares - explained, 0.0)
