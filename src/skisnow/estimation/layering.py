"""Hardness that changes with depth: test of a series for layering, and a linear profile fitted to each series.

A series whose snow grows harder or softer below follows, near enough, F = H_V V₇ (V/V₇)^(1 + κ/2), with V₇ = F₇/H_V at
the largest load and κ = 0 for F = H_V V. κ is fitted together with H_V and the offset δ of the depth zero. Both bend
the curve, so seven readings leave much of κ open. `campaign_model` has the same law with spreads of the whole campaign;
here each series is tested for itself. The whole module is our modelling assumption.

Linear profile: the pressure is p = H_0 ε (1 + γ ε/e₇) with the hardness H_0 at the surface, (1 + γ) times as much at
the depth e₇ of the largest load, and γ = 0 for F = H_V V. Over the tool

    F = H_0 (V + γ W/e₇),    W = ∫ ε² dA = 2 ∫ V de,

V and W up to the depth of the reading. The fit estimates H = F/V at e₇, γ and δ, all of which bend the curve; δ has a
prior about 0 with the standard deviation `SEATING_SD`. Seven readings leave much of γ open; the mean over a site is
narrower.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.units import CONFIDENCE, MM, ShownFields
from ..statistics.combined_uncertainty import expanded_factor
from .comparisons import SiteValue, site_values
from .readings import Readings, ReadingUncertainty

SEATING_SD: Final = 0.1 * MM
"""Offsets of the depth zero that count as seating in a test for layering; more bends the curve too far."""
_PRIOR: Final = SEATING_SD**-2
SHOWS: Final = 0.99
"""Layering is flagged where this interval of g leaves out 1: one series in a hundred of even snow."""
FEWEST_READINGS: Final = 5
"""With fewer, nothing is flagged: three numbers are fitted."""
_ITERATIONS: Final = 40
_MINIMUM_DETERMINANT: Final = 1e-14
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(2)
"""Exact where V grows as e or e², on flat and edged tools; 0.3 % off on a cylinder."""
_SETTLED: Final = 1e-3
"""Change of ln H, γ, depths and relative one of the scatter at the end: less than a hundredth of the standard error."""
_LITTLE_SCATTER: Final = 1e-6
"""Scatter of 0.1 %, squared: where it is less, its own changes do not count."""
_LIMITS: Final = (-0.9, 20.0)
"""Of γ: below, the pressure would not grow with depth."""


def layered(readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty) -> BoolArray:
    """Mask of the series whose load exponent differs clearly from 1; depth zeros may be off by some `SEATING_SD`."""
    enough = readings.sums(np.ones(readings.n)) >= FEWEST_READINGS
    usable = enough & np.isfinite(hardness) & (hardness > 0)
    flagged = np.zeros(readings.n_series, dtype=np.bool_)
    if not usable.any():
        return flagged
    exponent, error, dof = layering(readings.of(usable), hardness[usable], uncertainty)
    with np.errstate(invalid="ignore"):
        flagged[usable] = np.abs(exponent - 1.0) > expanded_factor(dof, SHOWS) * error
    return flagged


def layering(
    readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Load exponent g of each series (1: even snow), its standard error and their degrees of freedom; NaN: no solution.

    Fits e = ê(V) + δ, ln V = ln V₇ + g ln(F/F₇), g = 1/(1 + κ/2), to each series by weighted Gauss-Newton, κ = 2/g - 2,
    from ``hardness`` (N/m³), g = 1 and δ = 0. The variance of a reading is u_e² + (dê/dln V)² (s² + (g u_F/F)²) with s
    of the series itself. The prior of δ is normal about 0 with `SEATING_SD`.
    """
    series, largest = readings.series, np.log(readings.load[readings.largest])
    log_share = np.log(readings.load) - largest[series]

    def line(b: FloatArray, scatter2: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residual, dê/d ln V and weight of each reading at b = (ln H_V, g, δ)."""
        volume = np.exp(largest[series] - b[0][series] + b[1][series] * log_share)
        depth = readings.depth_at_volume(volume)
        slope = volume / readings.area_at_depth(depth)
        load2 = (b[1][series] * uncertainty.load / readings.load) ** 2
        variance = uncertainty.depth**2 + slope**2 * (load2 + scatter2[series])
        weight = np.divide(1.0, variance, out=np.zeros_like(variance), where=variance > 0)
        return readings.penetration_depth - depth - b[2][series], slope, weight

    def newton(b: FloatArray, scatter2: FloatArray) -> tuple[FloatArray, FloatArray]:
        residual, slope, weight = line(b, scatter2)
        J = (-slope, slope * log_share, np.ones_like(slope))
        return _gauss_newton_step(readings, J, residual, weight, b[2])

    b = np.stack((np.log(hardness), np.ones(readings.n_series), np.zeros(readings.n_series)))
    scatter2 = np.full(readings.n_series, 1e-4)
    step = np.full_like(b, np.inf)
    with np.errstate(all="ignore"):  # series without a solution run through as NaN and are separated at the end
        for _ in range(_ITERATIONS):
            step, _ = newton(b, scatter2)
            b = b + np.clip(step, [[-0.5], [-0.3], [-np.inf]], [[0.5], [0.3], [np.inf]])
            b[1] = np.clip(b[1], 0.1, 5.0)
            previous, scatter2 = scatter2, _scatter_step(readings, scatter2, *line(b, scatter2), b[2])
            drift = np.abs(scatter2 - previous) / (scatter2 + 1e-12)
            if np.nanmax(np.maximum(np.abs(step[:2]).max(axis=0), drift), initial=0.0) < 1e-6:
                break
        _, inverse = newton(b, scatter2)
        error = np.where(np.abs(step[:2]).max(axis=0) < 1e-4, np.sqrt(inverse[:, 1, 1]), np.nan)
        dof = _degrees_of_freedom(readings)
        return b[1], error, np.where(dof >= 1.0, dof, np.nan)


def _gauss_newton_step(
    readings: Readings, J: tuple[FloatArray, ...], residual: FloatArray, weight: FloatArray, offset: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Step (3, m) of the three parameters and the inverse (m, 3, 3) of the normal matrix, with the prior of δ.

    ``J`` has the derivatives of the depths by the parameters, one per reading; ``offset`` is δ of each series.
    """
    sums = readings.sums
    normal = np.array([[sums(weight * J[i] * J[k]) for k in range(3)] for i in range(3)])
    gain = np.array([sums(weight * J[i] * residual) for i in range(3)])
    normal[2, 2] += _PRIOR
    gain[2] -= _PRIOR * offset
    inverse = inverse_of_each(np.moveaxis(normal, 2, 0))
    return np.einsum("mik,km->im", inverse, gain), inverse


def _scatter_step(
    readings: Readings,
    scatter2: FloatArray,
    residual: FloatArray,
    slope: FloatArray,
    weight: FloatArray,
    offset: FloatArray,
) -> FloatArray:
    """s² of each series after a Newton step on 1/Q towards Q = Σ r²/σ² = degrees of freedom (Paule and Mandel 1982)."""
    Q = readings.sums(weight * residual**2) + _PRIOR * offset**2
    fall = readings.sums((weight * residual * slope) ** 2)
    moved = scatter2 + (Q / _degrees_of_freedom(readings) - 1.0) * Q / fall
    return np.clip(np.where(fall > 0, moved, 0.0), 1e-12, 10.0)


def _degrees_of_freedom(readings: Readings) -> FloatArray:
    """Readings of each series less two: the prior determines δ."""
    return readings.sums(np.ones(readings.n)) - 2.0


def inverse_of_each(normal: FloatArray) -> FloatArray:
    """Inverse of each (3, 3), scaled to a unit diagonal in between; NaN where it is singular."""
    root = np.sqrt(np.einsum("mii->mi", normal))
    scale = root[:, :, None] * root[:, None, :]
    scaled = np.where(scale > 0, normal / scale, np.nan)
    regular = np.isfinite(scaled).all(axis=(1, 2))
    scaled[~regular] = np.eye(3)
    regular &= np.linalg.det(scaled) > _MINIMUM_DETERMINANT
    scaled[~regular] = np.eye(3)
    inverse = np.linalg.inv(scaled) / scale
    inverse[~regular] = np.nan
    return np.asarray(inverse, dtype=float)


@dataclass(frozen=True, slots=True, repr=False)
class GrowingHardness(ShownFields):
    """Results of m series; NaN with fewer than five readings or where the fit did not converge.

    surface_hardness: H_0 (N/m³).
    growth, growth_interval: γ and its 95 % interval (m, 2), which is one of ln(1 + γ): there the errors hardly depend
        on γ.
    """

    surface_hardness: FloatArray
    growth: FloatArray
    growth_interval: FloatArray


def growing_hardness(readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty) -> GrowingHardness:
    """Fit (ln H, γ, δ) to each series by weighted Gauss-Newton, from ``hardness`` (N/m³) and even snow.

    Error model and weights are those of `layering`.
    """
    m = readings.n_series
    H_0, growth, error = np.full((3, m), np.nan)
    enough = readings.sums(np.ones(readings.n)) >= FEWEST_READINGS
    usable = enough & np.isfinite(hardness) & (hardness > 0)
    if usable.any():
        fit = _GrowthFit(readings.of(usable), hardness[usable], uncertainty)
        H_0[usable], growth[usable], error[usable] = fit.solve()
    with np.errstate(invalid="ignore"):
        log, error = np.log1p(growth), error / (1.0 + growth)
        dof = np.where(usable, _degrees_of_freedom(readings), np.nan)
        half = expanded_factor(dof, CONFIDENCE) * error
        interval = np.expm1(np.stack((log - half, log + half), axis=-1))
    return GrowingHardness(H_0, growth, interval)


def site_growth(growth: GrowingHardness, used: BoolArray, site: Sequence[str]) -> tuple[SiteValue, ...]:
    """γ of each site, then of all together, from the geometric means of 1 + γ."""
    means = site_values(1.0 + growth.growth, used, site)
    return tuple(replace(row, value=row.value - 1.0, low=row.low - 1.0, high=row.high - 1.0) for row in means)


def second_moment(readings: Readings, penetration_depth: FloatArray) -> FloatArray:
    """W = 2 ∫ V de (m⁴) of each reading's tool down to a depth (m): over the wedge L e³/(3 tan ϑ), flat L W e²."""
    total = np.zeros_like(penetration_depth)
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += weight * readings.volume_at_depth(0.5 * (1.0 + node) * penetration_depth)
    return total * penetration_depth


class _GrowthFit:
    """Linearised fit of (ln H, γ, δ) of all series that have not converged."""

    def __init__(self, readings: Readings, hardness: FloatArray, uncertainty: ReadingUncertainty) -> None:
        self._readings, self._uncertainty = readings, uncertainty
        self._deepest = readings.penetration_depth[readings.largest]
        at_top = second_moment(readings, readings.penetration_depth)[readings.largest]
        self._k = at_top / (readings.displaced_volume[readings.largest] * self._deepest)
        self._b = np.stack((np.log(hardness), np.zeros_like(hardness), np.zeros_like(hardness)))
        self._scatter2 = np.full_like(hardness, 1e-4)
        self._depth = readings.depth_at_volume(readings.load / hardness[readings.series])

    def solve(self) -> FloatArray:
        """H_0, γ and its standard error (3, m); NaN where the iteration did not converge."""
        estimates = np.full((3, self._readings.n_series), np.nan)
        left = np.arange(self._readings.n_series)
        with np.errstate(all="ignore"):  # series without an answer run through as NaN and are left out at the end
            for _ in range(_ITERATIONS):
                at_end, answer = self._step()
                estimates[:, left[at_end]] = answer[:, at_end]
                left = left[~at_end]
                if not left.size:
                    break
                self._keep(~at_end)
        return estimates

    def _keep(self, going_on: BoolArray) -> None:
        """Continue with the masked series only."""
        of_reading = going_on[self._readings.series]
        self._readings, self._depth = self._readings.of(going_on), self._depth[of_reading]
        self._deepest, self._k = self._deepest[going_on], self._k[going_on]
        self._b, self._scatter2 = self._b[:, going_on], self._scatter2[going_on]

    def _step(self) -> tuple[BoolArray, FloatArray]:
        """One step of all series; returns the mask of converged ones, and H_0, γ and its error (3, m) before it."""
        residual, J, slope, weight, moved = self._line()
        low, high = _LIMITS
        step, inverse = _gauss_newton_step(self._readings, J, residual, weight, self._b[2])
        scatter2 = _scatter_step(self._readings, self._scatter2, residual, slope, weight, self._b[2])
        scatter2 = np.sqrt(scatter2 * self._scatter2)  # half a step on logarithms: whole ones oscillate
        drift = np.abs(scatter2 - self._scatter2) / (scatter2 + _LITTLE_SCATTER)
        changed = np.maximum(np.abs(step[:2]).max(axis=0), drift)
        at_end = (changed < _SETTLED) & (self._readings.sums((moved > _SETTLED).astype(float)) == 0)
        growth = self._b[1]
        answer = np.stack((np.exp(self._b[0]) / (1.0 + growth * self._k), growth, np.sqrt(inverse[:, 1, 1])))
        self._b = self._b + np.clip(step, [[-0.5], [-0.3], [-np.inf]], [[0.5], [0.3], [np.inf]])
        self._b[1] = np.clip(self._b[1], low, high)
        self._scatter2 = scatter2
        return at_end & (growth > low) & (growth < high), answer

    def _line(self) -> tuple[FloatArray, tuple[FloatArray, ...], FloatArray, FloatArray, FloatArray]:
        """Of each reading: residual, derivatives by (ln H, γ, δ), F/(dF/de), weight, and change of the depth.

        One Newton step of ln F over ln e towards the depth that the law has under the load.
        """
        readings, series = self._readings, self._readings.series
        growth, deepest, k = self._b[1][series], self._deepest[series], self._k[series]
        surface = np.exp(self._b[0][series]) / (1.0 + growth * k)
        volume = readings.volume_at_depth(self._depth)
        bent = second_moment(readings, self._depth) / deepest
        force = volume + growth * bent
        slope = force / (readings.area_at_depth(self._depth) + 2.0 * growth * volume / deepest)
        moved = slope / self._depth * np.log(readings.load / (surface * force))
        self._depth = self._depth * np.exp(np.clip(moved, -1.0, 1.0))
        load2 = (self._uncertainty.load / readings.load) ** 2
        variance = self._uncertainty.depth**2 + slope**2 * (load2 + self._scatter2[series])
        by_growth = -slope * (bent / force - k / (1.0 + growth * k))
        residual = readings.penetration_depth - self._depth - self._b[2][series]
        return residual, (-slope, by_growth, np.ones_like(slope)), slope, 1.0 / variance, np.abs(moved)
