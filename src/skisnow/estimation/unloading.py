"""Unloading: how steep the force falls where the discs are taken off one by one.

Snow of the hypoplastic law (`skisnow.forces.penetration.HypoplasticPoint`) that was pressed to the depth e_m under F_m
gives the tool that came back by d the pressure H_V ε_m - k_u d where that is above 0. Its force is that of
the depth e_m - κ d of the loading, κ = k_u/H_V, whatever its shape:

    F = H_V V(e_m - κ d),    d = (e_m - ê(V_m F/F_m)) / κ,    V_m = V(e_m).

A flat tool falls along a straight line, an edged one along (1 - κ d/e_m)². The law is linear in the rebound ratio
s = H_V/k_u: the depth is e = e_0 - s g with g = e_m - ê(V_m F/F_m). Each series is fitted in (e_0, s) with its reading
under the largest load among the others, at depths less its offset δ of the depth zero (`campaign_model`). The variance
of a depth is

    u_e² + (s dê/dF u_F)² + r² d²

with gauge and load as in `hardness` and the relative scatter r of the rebound, which all series of a group share (Paule
and Mandel 1982, with a weak prior). The variance of s is that of the line plus (ds/dδ)² times the variance of δ: an
offset δ changes g in proportion to δ/e_m. The gauge error of e_m moves the line and, as -δ does, g; both parts are
added before they are squared. Intervals of k_u/H_V are the reciprocals of those of s. The whole module is our modelling
assumption: the paper names the steepness and prints neither method nor value.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import ShownFields
from ..campaign.records import PenetrationTests, UnloadingReadings
from ..statistics.combined_uncertainty import random_effects_mean
from .campaign_model import CampaignModel
from .comparisons import own_mean
from .hardness import Hardness
from .readings import Readings

NOT_FALLING: Final = "unloading_not_falling"
"""The quality flag that excludes a series here, and nowhere else."""
_FITTED: Final = 2
"""e_0 and s."""
_ROUNDING: Final = 1e-9
"""Relative error of an exact depth: rounding of double precision."""
_ITERATIONS: Final = 60
_SETTLED: Final = 1e-4
_LARGEST_SHARE: Final = 0.9
"""Largest offset as a share of the largest depth."""


@dataclass(frozen=True, slots=True, repr=False)
class Unloading(ShownFields):
    """Unloading of m series; NaN for a series without a result.

    n_readings: readings of the unloading branch, one number per series.
    rebound_ratio, rebound_ratio_error, rebound_ratio_interval: s = H_V/k_u, 0 for rigid-plastic and 1 for elastic snow,
        its standard error and 95 % interval (m, 2); the last two need two readings.
    unloading_ratio, unloading_ratio_interval: k_u/H_V and its 95 % interval (m, 2); the interval is NaN where that of s
        reaches 0.
    unloading_stiffness, unloading_stiffness_interval: k_u (N/m³) with H_V of Eqn 1, and its 95 % interval (m, 2).
    below_step: mask of the series that rebounded by less than one step of the gauge. Rounding is not an independent
        error there, so the interval of s is the bound that one step allows, and k_u/H_V has no upper end.
    rebound_scatter, rebound_freedom: r, the relative scatter of the rebound, and its degrees of freedom, by group of
        the model; NaN if not unloaded.
    """

    n_readings: IntArray
    rebound_ratio: FloatArray
    rebound_ratio_error: FloatArray
    rebound_ratio_interval: FloatArray
    unloading_ratio: FloatArray
    unloading_ratio_interval: FloatArray
    unloading_stiffness: FloatArray
    unloading_stiffness_interval: FloatArray
    below_step: BoolArray
    rebound_scatter: FloatArray
    rebound_freedom: FloatArray

    @property
    def is_unresolved(self) -> BoolArray:
        """Series whose rebound ratio could be 0, or that have too few readings to resolve it."""
        return np.isfinite(self.rebound_ratio) & ~np.isfinite(self.unloading_ratio_interval).all(axis=1)


@dataclass(frozen=True, slots=True)
class SiteUnloading:
    """Mean unloading of the n used series of a site (None: of all sites, as draws from one snow).

    ratio, low, high: k_u/H_V, the harmonic mean over the series, which keeps the mean rebound, and its 95 % interval,
        NaN where the rebound could be 0 or one series leaves it open; the ratio is NaN where nothing came back on
        average.
    low_rebound, high_rebound: 95 % interval of the mean of H_V/k_u.
    stiffness, stiffness_low, stiffness_high: k_u (N/m³), the geometric mean over the series whose tool rebounded, and
        its 95 % interval from their scatter.
    """

    site: str | None
    n: int
    ratio: float
    low: float
    high: float
    low_rebound: float
    high_rebound: float
    stiffness: float
    stiffness_low: float
    stiffness_high: float

    @property
    def is_resolved(self) -> bool:
        """True if both ends of the ratio are known; only such a ratio is passed to a snow."""
        return bool(np.isfinite([self.ratio, self.low, self.high]).all())


def unloading(
    tests: PenetrationTests, readings: Readings, hardness: Hardness, model: CampaignModel, bad: BoolArray
) -> Unloading:
    """Fit the unloading of every series.

    readings: their readings under rising loads; ``tests.unloading`` follows the one under the largest load, or begins
        with another reading under it.
    model: model of the campaign, for the depth zeros.
    bad: mask over the series: those that are omitted, because their loads do not fall.
    """
    m, back = len(tests), tests.unloading
    chosen = np.zeros(m, dtype=np.bool_) if back is None else (back.count > 0) & ~bad & np.isfinite(model.offset)
    s, error, half, bound = np.full((4, m), np.nan)
    scatter, freedom = np.full((2, len(model.spreads.scatter2)), np.nan)
    if back is not None and chosen.any():
        fit = _fit(_unloading_branch(readings, back, chosen), model, chosen)
        s[chosen], error[chosen], half[chosen], bound[chosen], scatter, freedom = fit
    below_step = np.abs(s) < bound
    half = np.where(below_step & np.isfinite(half), bound, half)
    ends = np.stack((s - half, s + half), axis=-1)
    ratio, ratio_ends = _stiffness_ratio(s, ends)
    stiffness = ratio * hardness.value
    with np.errstate(invalid="ignore", divide="ignore"):  # half-widths of logarithms add as squares
        half = np.hypot(np.log(ratio_ends / ratio[:, None]), np.log(hardness.interval / hardness.value[:, None]))
    return Unloading(
        n_readings=np.zeros(m, dtype=np.int64) if back is None else back.count,
        rebound_ratio=s,
        rebound_ratio_error=error,
        rebound_ratio_interval=ends,
        unloading_ratio=ratio,
        unloading_ratio_interval=ratio_ends,
        unloading_stiffness=stiffness,
        unloading_stiffness_interval=stiffness[:, None] * np.exp(half * np.array([-1.0, 1.0])),
        below_step=below_step,
        rebound_scatter=scatter,
        rebound_freedom=freedom,
    )


def _unloading_branch(readings: Readings, back: UnloadingReadings, chosen: BoolArray) -> Readings:
    """The chosen series from their largest load on; a second reading under it takes the place of the first."""
    again = back.load[back.first[:-1][chosen]] == readings.load[readings.largest[chosen]]
    taken = chosen[back.series_of_reading]
    count = back.count[chosen]
    begin = np.concatenate(([0], np.cumsum(count)))[:-1][~again]
    return Readings(
        load=np.insert(back.load[taken], begin, readings.load[readings.largest[chosen]][~again]),
        penetration_depth=np.insert(
            back.penetration_depth[taken], begin, readings.penetration_depth[readings.largest[chosen]][~again]
        ),
        edge_angle=readings.edge_angle[chosen],
        first=(first := np.concatenate(([0], np.cumsum(count + ~again)))),
        largest=first[:-1],
        tool=readings.tool[chosen],
        tools=readings.tools,
    )


class _Branch(NamedTuple):
    """The law e = e_0 - s g at depths less the offset: g, dg/dδ, known variance, and d² of each reading (m, m²)."""

    g: FloatArray
    g_by_offset: FloatArray
    known_variance: FloatArray
    rebound2: FloatArray


def _fit(branch: Readings, model: CampaignModel, chosen: BoolArray) -> tuple[FloatArray, ...]:
    """For each series s, its error, half 95 % interval, s of a gauge step; for each group r and degrees of freedom."""
    series, group = branch.series, model.group[chosen]
    law = _linearise_unloading(
        branch, np.minimum(model.offset[chosen], _LARGEST_SHARE * branch.penetration_depth[branch.largest]), model
    )
    scatter2, freedom = _scatter(branch, law, model, group, model.counts[chosen])
    of_rebound = scatter2[group][series] * law.rebound2
    weight = 1.0 / (law.known_variance + of_rebound)
    s, spread, residual = _line(branch, law.g, weight)
    dg = _centred(branch, law.g, weight)
    with np.errstate(invalid="ignore", divide="ignore"):
        own = branch.sums((weight * dg) ** 2 * of_rebound) / spread**2
        changed = weight * _centred(branch, law.g_by_offset, weight)
        by_offset = -branch.sums(changed * (residual + s[series] * dg)) / spread
        offset = model.parts(2).of(chosen).times(by_offset**2)
        # the gauge error of the deepest reading acts on the line and, as -δ, on g
        top = branch.largest
        by_top = -weight[top] * dg[top] / spread
        gauge = ((by_top - by_offset) ** 2 - by_top**2) * model.uncertainty.depth**2
        parts = offset._replace(variance=1.0 / spread + offset.variance + gauge)
        error = np.where(branch.sums(np.ones(branch.n)) > _FITTED, np.sqrt(parts.variance), np.nan)
        half = model.factor(parts, group, (own, freedom[group])) * error
    step = 12.0**0.5 * model.uncertainty.depth
    return s, error, half, step / np.maximum.reduceat(law.g, branch.first[:-1]), np.sqrt(scatter2), freedom


def _linearise_unloading(branch: Readings, offset: FloatArray, model: CampaignModel) -> _Branch:
    """Unloading as e = e_0 - s g: g (m), dg/dδ, known variance and (s g)² (m²) of each reading."""
    top, series, uncertainty = branch.largest[branch.series], branch.series, model.uncertainty
    deepest = (branch.penetration_depth - offset[series])[top]
    share = branch.load / branch.load[top]
    volume = branch.volume_at_depth(deepest) * share
    loading_depth = branch.depth_at_volume(volume)
    area = branch.area_at_depth(loading_depth)
    g = deepest - loading_depth
    per_newton = np.divide(volume, area * branch.load)  # dê/dF = V/(A F)
    g_by_offset = np.divide(branch.area_at_depth(deepest) * share, area) - 1.0
    s, _, _ = _line(branch, g, np.ones(branch.n))
    s = np.clip(s, 0.0, 1.0)[series]
    floor = (_ROUNDING * deepest) ** 2  # a series without any error keeps finite weights
    return _Branch(
        g, g_by_offset, uncertainty.depth**2 + (s * per_newton * uncertainty.load) ** 2 + floor, (s * g) ** 2
    )


def _scatter(
    branch: Readings, law: _Branch, model: CampaignModel, group: IntArray, counts: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """r² of the rebound of each group and its degrees of freedom: Σ w r_j² + ν₀ r₀²/r² = n - 2 m + ν₀."""
    n_groups, priors = len(model.spreads.scatter2), model.priors

    def total(values: FloatArray) -> FloatArray:
        counted = np.where(counts & np.isfinite(values), values, 0.0)
        return np.bincount(group, weights=counted, minlength=n_groups).astype(float)

    n = branch.sums(np.ones(branch.n))
    free, readings = total(np.maximum(n - _FITTED, 0.0)), total(branch.sums((law.rebound2 > 0).astype(float)))
    scatter2 = np.full(n_groups, priors.rebound**2)
    for _ in range(_ITERATIONS):
        weight = 1.0 / (law.known_variance + scatter2[group][branch.series] * law.rebound2)
        _, _, residual = _line(branch, law.g, weight)
        prior = priors.readings * priors.rebound**2 / scatter2
        Q = total(branch.sums(weight * residual**2)) + prior
        fall = total(branch.sums((weight * residual) ** 2 * law.rebound2)) + prior / scatter2
        moved = np.maximum(scatter2 + (Q / (free + priors.readings) - 1.0) * Q / fall, 0.2 * scatter2)
        settled = np.abs(moved - scatter2) <= _SETTLED * moved
        scatter2 = moved
        if settled.all():
            break
    share = scatter2[group][branch.series] * law.rebound2 * weight
    return scatter2, priors.readings + total(branch.sums(share**2)) * free / np.maximum(readings, 1.0)


def _centred(branch: Readings, values: FloatArray, weight: FloatArray) -> FloatArray:
    """Values less the weighted mean of their series."""
    return values - (branch.sums(weight * values) / branch.sums(weight))[branch.series]


def _line(branch: Readings, g: FloatArray, weight: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Slope s (m,) of e = e_0 - s g by weighted least squares, Σ w (g - ḡ)² of each series, and the residuals."""
    dg, de = (_centred(branch, values, weight) for values in (g, branch.penetration_depth))
    spread = branch.sums(weight * dg**2)
    with np.errstate(invalid="ignore", divide="ignore"):
        s = -branch.sums(weight * dg * de) / spread
    return s, spread, de + s[branch.series] * dg


def _stiffness_ratio(s: FloatArray, ends: FloatArray) -> tuple[FloatArray, FloatArray]:
    """k_u/H_V = 1/s and its interval; NaN where s or an end of its interval is not above 0."""
    ratio = np.divide(1.0, s, out=np.full(s.shape, np.nan), where=s > 0)
    positive = (ends[..., 0] > 0)[..., None]
    turned = np.divide(1.0, ends[..., ::-1], out=np.full(ends.shape, np.nan), where=positive & (ends > 0))
    return ratio, turned


def site_unloading(series: Unloading, used: BoolArray, site: Sequence[str]) -> tuple[SiteUnloading, ...]:
    """The mean of each site in alphabetical order, then of all together; empty without a used series."""
    counts = used & np.isfinite(series.rebound_ratio)
    names = np.array(site, dtype=object)
    if not counts.any():
        return ()
    sites = sorted(set(names[counts].tolist()))
    return (
        *(_mean(series, counts & (names == name), names, name) for name in sites),
        _mean(series, counts, names, None),
    )


def _mean(series: Unloading, chosen: BoolArray, names: npt.NDArray[np.object_], site: str | None) -> SiteUnloading:
    """Mean of the series with a standard error; without such a series the plain mean without an interval."""
    with_error = chosen & np.isfinite(series.rebound_ratio_error)
    low, high = np.nan, np.nan
    if not with_error.any():
        s = float(series.rebound_ratio[chosen].mean())
    elif with_error.sum() == 1:
        s = float(series.rebound_ratio[with_error][0])
        low, high = series.rebound_ratio_interval[with_error][0].tolist()
    else:
        s, low, high, _ = random_effects_mean(series.rebound_ratio[with_error], series.rebound_ratio_error[with_error])
    ratio, ends = _stiffness_ratio(np.array([s]), np.array([[low, high]]))
    back = chosen & np.isfinite(series.unloading_stiffness)
    own = own_mean(series.unloading_stiffness[back], names[back].tolist(), geometric=True)
    n = int(with_error.sum() or chosen.sum())
    return SiteUnloading(
        site=site,
        n=n,
        ratio=float(ratio[0]),
        low=float(ends[0, 0]),
        high=float(ends[0, 1]),
        low_rebound=low,
        high_rebound=high,
        stiffness=own.value,
        stiffness_low=own.low,
        stiffness_high=own.high,
    )
