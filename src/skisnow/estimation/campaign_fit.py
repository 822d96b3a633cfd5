"""Estimation of `campaign_model`: ln H, g and δ of each series, and the spreads that groups of series share.

An outer round linearises ê at the present values, takes one step of s², and reduces the readings of each series to the
normal equations of (ln H, g, δ). ln H has no prior, so it is eliminated (Schur complement). The inner rounds are the
EM algorithm of τ, σ_g and g_0 on the remaining 2 × 2 equations; they look at no reading.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import MM
from .readings import Readings, ReadingUncertainty

_ROUNDS: Final = 40
_SPREAD_ROUNDS: Final = 10
_SPREADS_SETTLED: Final = 3e-3
_SCATTER_SETTLED: Final = 0.01
_HARDNESS_SETTLED: Final = 1e-5
_LOST: Final = 1e-2
"""Change of ln H in the last round above which a series has no estimate."""
_LEAST_SEATING2: Final = 1e-14
_LEAST_LAYERING2: Final = 1e-8
_SCATTER2_LIMITS: Final = (1e-8, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Priors:
    """Weak priors of the spreads: each is scaled inverse chi-squared about a value, with degrees of freedom.

    seating, seating_series: τ (m), and the number of series with this spread that the prior counts as. A campaign may
        state its own τ.
    layering, layering_series: σ_g, and the number of series.
    mean_layering: standard deviation of g_0 about 1, the value of even snow.
    scatter, rebound, readings: s, the relative scatter of the rebound, and the number of readings that each of these
        priors counts as.
    """

    seating: float = 0.05 * MM
    seating_series: float = 1.0
    layering: float = 0.1
    layering_series: float = 3.0
    mean_layering: float = 0.1
    scatter: float = 0.05
    rebound: float = 0.05
    readings: float = 0.2


class Spreads(NamedTuple):
    """Spreads of each group of series.

    seating2: τ² (m²), variance of the depth zero.
    mean_exponent, layering2: mean g_0 and variance σ_g² of the exponent g.
    scatter2: s², variance of the relative scatter of the force.
    """

    seating2: FloatArray
    mean_exponent: FloatArray
    layering2: FloatArray
    scatter2: FloatArray


class Freedom(NamedTuple):
    """Degrees of freedom of τ, σ_g and s of each group, and the variance of g_0."""

    seating: FloatArray
    layering: FloatArray
    scatter: FloatArray
    mean_exponent_variance: FloatArray


class FittedSeries(NamedTuple):
    """ln H, g, δ of each series, covariance and its part from scatter; misfit, degrees of freedom; group spreads."""

    of_series: tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
    misfit: FloatArray
    free: FloatArray
    spreads: Spreads
    freedom: Freedom


class _LinearisedModel(NamedTuple):
    """Model linearised at the present estimate: dê/dln V (m; V: volume), residual (m), weight (1/m²) by reading."""

    slope: FloatArray
    residual: FloatArray
    weight: FloatArray


class _Reduced(NamedTuple):
    """Normal equations of (g, δ) of each series after the elimination of ln H, and the terms that give ln H."""

    hh: FloatArray
    hg: FloatArray
    hd: FloatArray
    rh: FloatArray
    gg: FloatArray
    gd: FloatArray
    dd: FloatArray
    right_g: FloatArray
    right_d: FloatArray


@dataclass(frozen=True, slots=True)
class _Posterior:
    """Means and covariances of (g, δ) of each series with the present spreads."""

    g: FloatArray
    d: FloatArray
    Cgg: FloatArray
    Cgd: FloatArray
    Cdd: FloatArray


class SeriesFit:
    """Iterative fit of the campaign's model to all series at once.

    ``seen`` is the mask of the readings in contact, ``n_groups`` the number of groups; the rest as in `fit_campaign`.
    """

    def __init__(
        self,
        readings: Readings,
        hardness: FloatArray,
        uncertainty: ReadingUncertainty,
        priors: Priors,
        *,
        seen: BoolArray,
        counts: BoolArray,
        group: IntArray,
        n_groups: int,
    ) -> None:
        self._readings, self._priors, self._counts, self._group, self._n_groups = (
            readings, priors, counts.astype(float), group, n_groups,
        )  # fmt: skip
        self._seen = seen.astype(float)
        self._largest = np.log(readings.load[readings.largest])
        self._share = np.log(readings.load) - self._largest[readings.series]
        self._depth2 = uncertainty.depth**2
        self._load2 = (uncertainty.load / readings.load) ** 2
        self._n_series = self._total(np.ones(readings.n_series))
        self._n_seen = readings.sums(self._seen)
        self._h, self._g, self._d = np.log(hardness), np.ones_like(hardness), np.zeros_like(hardness)
        self._spreads = Spreads(
            *(np.full(n_groups, prior) for prior in (priors.seating**2, 1.0, priors.layering**2, priors.scatter**2))
        )

    def solve(self) -> FittedSeries:
        """Iterate until the spreads and ln H of the counted series have settled."""
        determined = np.zeros_like(self._h)
        scatter_moved = 1.0
        with np.errstate(all="ignore"):  # a series without a solution becomes NaN and is separated at the end
            for round_ in range(_ROUNDS):
                line = self._linearise()
                if round_:
                    scatter_moved = self._scatter_step(line, self._n_seen - determined)
                    line = line._replace(weight=self._reading_weights(line.slope))
                reduced = self._eliminate_hardness(line)
                posterior, spreads_moved = self._spread_rounds(reduced)
                step = reduced.rh - reduced.hg * (posterior.g - self._g) - reduced.hd * (posterior.d - self._d)
                step = np.clip(step / reduced.hh, -0.5, 0.5)
                self._h = self._h + step
                self._g = np.clip(self._g + np.clip(posterior.g - self._g, -0.3, 0.3), 0.3, 3.0)
                self._d = posterior.d
                data = posterior.Cgg * reduced.gg + 2.0 * posterior.Cgd * reduced.gd + posterior.Cdd * reduced.dd
                determined = 1.0 + data
                moved = np.abs(np.where(self._counts > 0, np.nan_to_num(step), 0.0)).max(initial=0.0)
                if moved < _HARDNESS_SETTLED and spreads_moved < _SPREADS_SETTLED and scatter_moved < _SCATTER_SETTLED:
                    break
            return self._fitted_series(line, reduced, posterior, self._n_seen - determined, step)

    def _total(self, values: FloatArray) -> FloatArray:
        """Sum a quantity of the counted series over each group."""
        counted = np.where(self._counts > 0, values, 0.0)
        if self._n_groups == 1:
            return np.array([counted.sum()])
        totals: FloatArray = np.bincount(self._group, weights=counted, minlength=self._n_groups).astype(np.float64)
        return totals

    def _to_series(self, values: FloatArray) -> FloatArray:
        """Values of the groups, shape (groups,), repeated for each series."""
        return values if self._n_groups == 1 else values[self._group]

    def _to_readings(self, values: FloatArray) -> FloatArray:
        """Values of the groups, shape (groups,), repeated for each reading."""
        return values if self._n_groups == 1 else values[self._group][self._readings.series]

    def _linearise(self) -> _LinearisedModel:
        """Model linearised at the present estimate: depth by ln V, residual and weight of each reading."""
        readings, series = self._readings, self._readings.series
        volume = np.exp((self._largest - self._h)[series] + self._g[series] * self._share)
        depth = readings.depth_at_volume(volume)
        slope = volume / readings.area_at_depth(depth)
        return _LinearisedModel(
            slope, readings.penetration_depth - depth - self._d[series], self._reading_weights(slope)
        )

    def _reading_weights(self, slope: FloatArray) -> FloatArray:
        """Inverse variances (1/m²) of the depths, 0 for readings without contact; slope: de/d ln V (m)."""
        load2 = self._g[self._readings.series] ** 2 * self._load2
        return self._seen / (self._depth2 + slope**2 * (load2 + self._to_readings(self._spreads.scatter2)))

    def _scatter_step(self, line: _LinearisedModel, free: FloatArray) -> float:
        """One Newton step on 1/Q towards Q + ν₀ s₀²/s² = free readings + ν₀: Paule and Mandel with a prior."""
        sums, priors, scatter2 = self._readings.sums, self._priors, self._spreads.scatter2
        weighted = line.weight * line.residual
        prior = priors.readings * priors.scatter**2 / scatter2
        Q = self._total(sums(weighted * line.residual)) + prior
        fall = self._total(sums((weighted * line.slope) ** 2)) + prior / scatter2
        free_of_group = np.maximum(self._total(free), np.where(self._n_series > 0, 0.5, 0.0)) + priors.readings
        low, high = np.maximum(0.2 * scatter2, _SCATTER2_LIMITS[0]), np.minimum(5.0 * scatter2, _SCATTER2_LIMITS[1])
        moved = np.clip(scatter2 + (Q / free_of_group - 1.0) * Q / fall, low, high)
        self._spreads = self._spreads._replace(scatter2=moved)
        return float(np.abs(moved / scatter2 - 1.0).max())

    def _eliminate_hardness(self, line: _LinearisedModel) -> _Reduced:
        """Normal equations of exponent g and depth zero δ of each series without ln H, and the terms that give ln H."""
        sums, share = self._readings.sums, self._share
        by_slope = line.weight * line.slope
        by_slope2 = by_slope * line.slope
        by_share = by_slope2 * share
        along = by_slope * line.residual
        hh, hg, hd = sums(by_slope2), -sums(by_share), -sums(by_slope)
        gg, gd, dd = sums(by_share * share), sums(by_slope * share), sums(line.weight)
        rh, rg, rd = -sums(along), sums(along * share), sums(line.weight * line.residual)
        a, b = hg / hh, hd / hh
        gg, gd, dd = gg - a * hg, gd - a * hd, dd - b * hd
        right_g = rg - a * rh + gg * self._g + gd * self._d
        right_d = rd - b * rh + gd * self._g + dd * self._d
        return _Reduced(hh, hg, hd, rh, gg, gd, dd, right_g, right_d)

    def _posterior(self, reduced: _Reduced) -> _Posterior:
        """Means and covariances of g and δ (m) of each series, with the present spreads."""
        of_g, of_d = self._to_series(1.0 / self._spreads.layering2), self._to_series(1.0 / self._spreads.seating2)
        gg, dd = reduced.gg + of_g, reduced.dd + of_d
        determinant = gg * dd - reduced.gd**2
        Cgg, Cgd, Cdd = dd / determinant, -reduced.gd / determinant, gg / determinant
        right_g = reduced.right_g + of_g * self._to_series(self._spreads.mean_exponent)
        return _Posterior(Cgg * right_g + Cgd * reduced.right_d, Cgd * right_g + Cdd * reduced.right_d, Cgg, Cgd, Cdd)

    def _spread_rounds(self, reduced: _Reduced) -> tuple[_Posterior, float]:
        """Estimate τ, σ_g and g_0 by EM at this linearisation; the last posterior and relative change."""
        for _ in range(_SPREAD_ROUNDS):
            posterior = self._posterior(reduced)
            previous, self._spreads = self._spreads, self._spreads_of(posterior)
            changes = (new / old - 1.0 for new, old in zip(self._spreads[:3:2], previous[:3:2], strict=True))
            moved = max(float(np.abs(change).max()) for change in changes)
            if moved < _SPREADS_SETTLED:
                break
        return posterior, moved

    def _spreads_of(self, posterior: _Posterior) -> Spreads:
        """Variances of depth zero and of the exponent g, and its mean, of each group, by priors and posterior."""
        priors, spreads, m = self._priors, self._spreads, self._n_series
        seating2 = priors.seating_series * priors.seating**2 + self._total(posterior.d**2 + posterior.Cdd)
        precision = priors.mean_layering**-2
        mean = precision + self._total(posterior.g) / spreads.layering2
        mean = mean / (precision + m / spreads.layering2)
        deviation2 = (posterior.g - self._to_series(mean)) ** 2
        layering2 = priors.layering_series * priors.layering**2 + self._total(deviation2 + posterior.Cgg)
        return spreads._replace(
            seating2=np.maximum(seating2 / (priors.seating_series + m), _LEAST_SEATING2),
            mean_exponent=mean,
            layering2=np.maximum(layering2 / (priors.layering_series + m), _LEAST_LAYERING2),
        )

    def _fitted_series(
        self,
        line: _LinearisedModel,
        reduced: _Reduced,
        posterior: _Posterior,
        degrees_of_freedom: FloatArray,
        last_step: FloatArray,
    ) -> FittedSeries:
        """Values of ln H, g, δ and covariances by series; NaN where the `last_step` of ln H is too large."""
        a, b = reduced.hg / reduced.hh, reduced.hd / reduced.hh
        Chg = -(a * posterior.Cgg + b * posterior.Cgd)
        Chd = -(a * posterior.Cgd + b * posterior.Cdd)
        Chh = 1.0 / reduced.hh - a * Chg - b * Chd
        C = np.stack((Chh, Chg, Chd, Chg, posterior.Cgg, posterior.Cgd, Chd, posterior.Cgd, posterior.Cdd), axis=-1)
        lost = ~(np.abs(last_step) < _LOST) | ~np.isfinite(C).all(axis=-1)
        C = C.reshape(-1, 3, 3)
        sums = self._readings.sums
        J = (-line.slope, line.slope * self._share, np.ones_like(line.slope))
        scatter2 = line.weight**2 * line.slope**2 * self._to_readings(self._spreads.scatter2)
        # Σ_j of the products of J, so that no reading needs its own C J
        middle = np.empty((len(C), 3, 3))
        for i in range(3):
            for k in range(i, 3):
                middle[:, i, k] = middle[:, k, i] = sums(scatter2 * J[i] * J[k])
        of_series = (self._h, self._g, self._d, C, np.einsum("mik,mkl,mil->mi", C, middle, C))
        for values in of_series:
            values[lost] = np.nan
        misfit = self._readings.sums(line.weight * line.residual**2)
        return FittedSeries(
            of_series, misfit, degrees_of_freedom, self._spreads, self._freedom(line, posterior, degrees_of_freedom)
        )

    def _freedom(self, line: _LinearisedModel, posterior: _Posterior, free: FloatArray) -> Freedom:
        """Degrees of freedom of each spread: twice the Fisher information of its logarithm (prior and data)."""
        priors, sums = self._priors, self._readings.sums
        of_d = 1.0 - posterior.Cdd / self._to_series(self._spreads.seating2)
        of_g = 1.0 - posterior.Cgg / self._to_series(self._spreads.layering2)
        share = self._to_readings(self._spreads.scatter2) * line.slope**2 * line.weight
        readings = self._total(self._n_seen)
        free_share = np.maximum(self._total(free), 0.0) / np.maximum(readings, 1.0)
        precision = priors.mean_layering**-2 + self._total(of_g) / self._spreads.layering2
        return Freedom(
            priors.seating_series + self._total(of_d**2),
            priors.layering_series + self._total(of_g**2),
            priors.readings + self._total(sums(share**2)) * free_share,
            1.0 / precision,
        )
