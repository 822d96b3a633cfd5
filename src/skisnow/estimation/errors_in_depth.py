"""The model table with errors in depth and load, and the factor b without its dilution by errors.

The paper's fit takes H of each series from its last reading, as if that were exact, and puts all error into the load.
Here H_V of each series comes from all its readings, together with the offset of its depth zero (`campaign_model`), with
errors in depth and load. H_e and H_A come from all readings likewise, at the depths less the offset. The rows are then
fitted to these depths, each reading weighed by its effective variance (Orear 1982),

    (s F̂)² + u_F² + (dF̂/de · u_e)²,

with the campaign's own relative scatter s. Rows, bounds and units are those of `models`.

The factor b of F = b H_V V with H_V of Eqn 1: x = H_V V of a reading carries errors of two depths: that of the reading
and that of the last one, which defines H_V. With the variance w of ln x the mean of x F is exp(w/2) times too large and
that of x² exp(2 w) times, so that least squares give a b below 1 even where the law holds: *regression dilution*.
Layering changes x by the factor u = (F/F₇)^(g_0 - 1). Both are corrected:

    b = Σ (x/u) F exp(-w/2) / Σ (x/u)² exp(-2 w)

with w from the spreads of `campaign_model`; the exponents also have the third cumulant of the layering, which is
skewed. The error comes from the scatter between series (Student's t, m - 1 degrees of freedom).

Notes
-----
H of a series absorbs the level of b(ϑ) at its own edge angle, here as in the paper: the rows show how the *shape* of
the force over depth changes with the angle, not how the force does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray
from .._support.units import CONFIDENCE, ShownFields
from ..statistics.bounded import condensed, non_negative_fits
from ..statistics.combined_uncertainty import expanded_factor
from .campaign_model import CONTACT_STEPS, CampaignModel
from .hardness import DEFINITIONS, hardness_of_all_readings
from .models import MODELS, EndBasis, Model, ModelFit, end_basis, fit_model, weighted_columns
from .readings import Readings, ReadingUncertainty

_EXACT_SHARE: Final = 1e-6
"""Smallest variance of a reading as a share of the median one (modelling assumption)."""
_ITERATIONS: Final = 12
_BLOCK: Final = 8192
"""Readings whose columns fit a core's cache."""


@dataclass(frozen=True, repr=False)
class FittedHardness(ShownFields):
    """Hardness of m series from all their readings.

    readings: the readings at the depths less the offset of their series, where the model has an estimate.
    value: H by definition (SI).
    scatter: relative scatter s of each series about F = H_V V.
    """

    readings: Readings
    value: dict[str, FloatArray]
    scatter: FloatArray

    def of(self, chosen: BoolArray) -> FittedHardness:
        """Readings and hardness of the chosen series only (mask over the m series)."""
        value = {symbol: H[chosen] for symbol, H in self.value.items()}
        return FittedHardness(self.readings.of(chosen), value, self.scatter[chosen])


def fitted_hardness(readings: Readings, model: CampaignModel) -> FittedHardness:
    """Hardness of each series by the three definitions H_V, H_e (per depth) and H_A (per contact area).

    H_V is that of the campaign's model; the others come from all readings of a series, at depths less the offset.
    """
    moved = readings.less_offset(np.nan_to_num(model.offset))
    estimates = {
        symbol: hardness_of_all_readings(moved, definition, model.uncertainty)
        for symbol, definition in DEFINITIONS.items()
    }
    value = {symbol: H for symbol, (H, _) in estimates.items()}
    value["H_V"] = np.where(np.isfinite(model.log_hardness), model.hardness, value["H_V"])
    return FittedHardness(moved, value, estimates["H_V"][1])


def fit_models_with_depth_errors(fitted: FittedHardness, uncertainty: ReadingUncertainty) -> tuple[ModelFit, ...]:
    """Fit the nine candidate models (`MODELS`) with weights for errors of load and depth (effective variance).

    The rmse are those of the load (N) without weights, for comparison with `models.fit_models`.
    """
    readings, hardnesses, scatters = fitted.readings, fitted.value, fitted.scatter[np.isfinite(fitted.scatter)]
    scatter = float(np.sqrt(np.mean(scatters**2))) if scatters.size else 0.0
    fits: list[ModelFit] = []
    bases = {symbol: end_basis(readings, H) for symbol, H in hardnesses.items()}
    # derivatives with depth of the four regressors: dA/de replaces A, and A, which is dV/de, replaces V
    # a line contact (cylinder at e = 0) has an infinite dA/de: no depth, no information
    growth = np.where(np.isfinite(readings.area_growth), readings.area_growth, 0.0)
    slopes_of = {
        symbol: weighted_columns(readings, H, growth, readings.contact_area) for symbol, H in hardnesses.items()
    }
    for model in MODELS:
        basis = bases[model.hardness]
        slopes = slopes_of[model.hardness]
        weight = _effective_weights(readings, readings.load, np.zeros(readings.n), uncertainty, scatter)
        previous = np.full(4, np.nan)
        for _ in range(_ITERATIONS if model.n_parameters else 0):
            ends = _weighted_ends(basis, model, readings.load, weight)
            weight = _effective_weights(readings, basis.columns @ ends, slopes @ ends, uncertainty, scatter)
            if np.allclose(ends, previous, rtol=1e-6, atol=0.0):
                break
            previous = ends
        of_load = condensed(basis.columns, readings.load, weights=weight)
        fits.append(fit_model(readings, basis, model, of_load))
    return tuple(fits)


def _weighted_ends(basis: EndBasis, model: Model, load: FloatArray, weight: FloatArray) -> FloatArray:
    """End values (4,) of the coefficients by a weighted fit; its normal equations suffice before the final fit."""
    projection, fixed = basis.projection(model), basis.offset(model)
    products = np.zeros((4, 5))
    for first in range(0, len(load), _BLOCK):
        part = slice(first, first + _BLOCK)
        columns = basis.columns[part].T
        weighted = columns * weight[part]
        products[:, :4] += weighted @ columns.T
        products[:, 4] += weighted @ load[part]
    gram, moment = products[:, :4], products[:, 4] - products[:, :4] @ fixed
    fitted = non_negative_fits((projection.T @ gram @ projection)[None], (moment @ projection)[None])[0]
    return fixed + projection @ fitted


def _effective_weights(
    readings: Readings, force: FloatArray, force_slope: FloatArray, uncertainty: ReadingUncertainty, scatter: float
) -> FloatArray:
    """Inverse effective variance (1/N²) of each reading; `force_slope`: dF̂/de (N/m)."""
    variance = (scatter * force) ** 2 + uncertainty.load**2 + (force_slope * uncertainty.depth) ** 2
    least, most = float(variance.min()), float(variance.max())
    if most <= 0.0:
        return np.ones(readings.n)
    if least < _EXACT_SHARE * most:  # a reading of force 0 must not count as exact
        variance = np.maximum(variance, _EXACT_SHARE * float(np.median(variance[variance > 0])))
    return 1.0 / variance


_LARGEST_VARIANCE: Final = 0.2
"""Variance of ln x above which a reading is omitted, because its correction is not small."""


@dataclass(frozen=True, slots=True, repr=False)
class VolumeFactor(ShownFields):
    """Factor b of F = b H_V V, estimated from n series.

    n: number of series.
    raw, expected_raw: by least squares, and the value that these estimate if F = H_V V is true, with these errors and
        layers.
    value, low, high: corrected, and its 95 % interval, NaN with one series.
    """

    n: int
    raw: float
    expected_raw: float
    value: float
    low: float
    high: float


def volume_factor(readings: Readings, hardness: FloatArray, model: CampaignModel) -> VolumeFactor:
    """Estimate b of F = b H_V V from the series with a hardness (N/m³, of Eqn 1) and an estimate of the model."""
    estimated = np.isfinite(hardness) & np.isfinite(model.log_hardness)
    if not estimated.any():
        return VolumeFactor(0, *[float("nan")] * 5)
    readings, hardness, model = readings.of(estimated), hardness[estimated], model.of(estimated)
    F, x = readings.load, hardness[readings.series] * readings.displaced_volume
    w, usable = _error_variance(readings, model)
    layers = np.exp((model.spreads.mean_exponent[model.group][readings.series] - 1.0) * _log_load_ratio(readings))
    even = x / layers
    # exponents of layered snow are skewed: third moment of g about g_0 in the group of each series
    cubes = (model.exponent - model.spreads.mean_exponent[model.group]) ** 3
    totals = np.bincount(model.group, weights=cubes, minlength=len(model.spreads.mean_exponent))
    number = np.bincount(model.group, minlength=len(totals))
    skew = (totals / np.maximum(number, 1))[model.group][readings.series] * _log_load_ratio(readings) ** 3
    mean, square = w / 2.0 + skew / 6.0, 2.0 * w + 8.0 * skew / 6.0  # logarithms of the means of e^ε and e^2ε
    above = readings.sums(usable * even * F * np.exp(-mean))
    below = readings.sums(usable * even**2 * np.exp(-square))
    m = readings.n_series
    with np.errstate(invalid="ignore", divide="ignore"):
        value = float(above.sum() / below.sum())
        error = np.sqrt(((above - value * below) ** 2).sum() * m / np.float64(m - 1)) / below.sum()
    half = float(expanded_factor(m - 1.0, CONFIDENCE) * error)
    law = F * layers  # the value of x without errors where b = 1; readings that are not usable count as they are
    expected = np.where(usable > 0, law * F * np.exp(mean), x * F).sum()
    expected /= np.where(usable > 0, law**2 * np.exp(square), x**2).sum()
    return VolumeFactor(m, float((x @ F) / (x @ x)), float(expected), value, value - half, value + half)


def _log_load_ratio(readings: Readings) -> FloatArray:
    """Logarithm (n,) of the load of each reading over the largest load of its series."""
    log = np.log(readings.load)
    return log - log[readings.largest][readings.series]


def _error_variance(readings: Readings, model: CampaignModel) -> tuple[FloatArray, FloatArray]:
    """Variance w of ln(H_V V/F) of each reading, 0 of the last, and a mask of the usable readings."""
    series, last, uncertainty = readings.series, readings.largest, model.uncertainty
    volume = readings.displaced_volume
    per_depth = np.divide(readings.contact_area, volume, out=np.zeros_like(volume), where=volume > 0)
    group = model.group[series]
    own = model.spreads.scatter2[group] + (uncertainty.load / readings.load) ** 2 + (per_depth * uncertainty.depth) ** 2
    seating2 = model.spreads.seating2[group] * (per_depth - per_depth[last][series]) ** 2
    w = own + own[last][series] + seating2 + model.spreads.layering2[group] * _log_load_ratio(readings) ** 2
    w[last] = 0.0
    contact = readings.penetration_depth > CONTACT_STEPS * 12.0**0.5 * uncertainty.depth
    usable = contact & (w < _LARGEST_VARIANCE)
    if usable.sum() == len(last):  # none but the last readings, which are exact by definition
        usable[:] = False
    return np.where(usable, w, 0.0), usable.astype(float)
