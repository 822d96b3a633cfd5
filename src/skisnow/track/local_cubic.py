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
        of_place, of_rate = (_Moments(len(chunk), place.values.shape[1], terms) for terms in (TERMS, TERMS - 1))
        for offset in range(int((first[chunk] - chunk).min()), int((last[chunk] - chunk).max())):
            other = np.clip(chunk + offset, 0, len(time) - 1)
            inside = (chunk + offset >= first[chunk]) & (chunk + offset < last[chunk])
            tau = (time[other] - time[chunk]) / half
            apart = place.values[other] - place.values[chunk]
            of_place.add(tau, np.where(inside, place.weight[other], 0.0), apart)
            if rate is not None:
                of_rate.add(tau, np.where(inside, rate.weight[other], 0.0), rate.values[other])
        pieces.append(_solve(of_place, of_rate, half))
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
    of_windows = ("place_misfit", "rate_misfit", "place_count", "rate_count")
    return LocalCubic(coefficients, covariance, *(getattr(fits, name)[centre_of] for name in of_windows))


class _Moments:
    """Sums over the windows of all points for the normal equations of the local cubics, of places or of rates."""

    def __init__(self, count: int, coordinates: int, terms: int) -> None:
        self.moments = np.zeros((2 * terms - 1, count))
        self.products = np.zeros((terms, count, coordinates))
        self.squares = np.zeros(count)
        self.count = np.zeros(count, dtype=np.int64)

    def add(self, tau: FloatArray, weight: FloatArray, values: FloatArray) -> None:
        """Add one weighted value to each window, at τ."""
        self.count += weight > 0.0
        self.squares += weight * np.einsum("nd,nd->n", values, values)
        power = weight.copy()
        for exponent in range(len(self.moments)):
            self.moments[exponent] += power
            if exponent < len(self.products):
                self.products[exponent] += power[:, None] * values
            power *= tau


def _solve(place: _Moments, rate: _Moments, half: float) -> tuple[npt.NDArray[np.generic], ...]:
    """Solve the normal equations; return the fields of a LocalCubic."""
    order = np.arange(TERMS)
    of_place = np.moveaxis(place.moments[order[:, None] + order], -1, 0)
    of_rate = np.zeros_like(of_place)
    below = np.arange(1, TERMS)
    slopes = np.multiply.outer(below, below) / half**2  # derivatives of τ^p and τ^q by time: p q τ^(p+q-2) / h²
    of_rate[:, 1:, 1:] = slopes * np.moveaxis(rate.moments[below[:, None] + below - 2], -1, 0)
    right_place = np.moveaxis(place.products, 0, 1)
    right_rate = np.zeros_like(right_place)
    right_rate[:, 1:] = below[:, None] / half * np.moveaxis(rate.products, 0, 1)
    enough = place.count >= FEWEST_POINTS
    covariance = np.full_like(of_place, np.nan)
    normal = (of_place + of_rate)[enough]
    ridge = _RIDGE * np.trace(normal, axis1=1, axis2=2)
    covariance[enough] = np.linalg.inv(normal + ridge[:, None, None] * np.eye(TERMS))
    coefficients = covariance @ (right_place + right_rate)
    place_misfit = _misfit(place.squares, coefficients, of_place, right_place)
    rate_misfit = _misfit(rate.squares, coefficients, of_rate, right_rate)
    return coefficients, covariance, place_misfit, rate_misfit, place.count, rate.count


def _misfit(squares: FloatArray, coefficients: FloatArray, normal: FloatArray, right: FloatArray) -> FloatArray:
    """Σ w (y − Xβ)² = Σ w y² − 2 β·b + βᵀ N β, for the observations of one kind."""
    explained = np.einsum("nkd,nkd->n", coefficients, 2.0 * right - normal @ coefficients)
    return np.maximum(squares - explained, 0.0)
