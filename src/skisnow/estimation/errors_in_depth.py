"""The model table with the error where it is: in depth as well as in load.

The paper's fit takes H of each series from its last reading, as if that were exact, and puts all error into the load.
Here H_V of each series comes from all its readings, together with the offset of its depth zero (`campaign_model`), with
errors in depth and load. H_e and H_A come from all readings likewise, at the depths less the offset. The rows are then
fitted to these depths, each reading weighed by its effective variance (Orear 1982),

    (s F̂)² + u_F² + (dF̂/de · u_e)²,

with the campaign's own relative scatter s. Rows, bounds and units are those of `models`.

Notes
-----
H of a series absorbs the level of b(ϑ) at its own edge angle, here as in the paper: the rows show how the *shape* of
the force over depth changes with the angle, not how the force does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from ..statistics.bounded import condensed, non_negative_fits
from .hardness import DEFINITIONS, hardness_of_all_readings
from .models import MODELS, EndBasis, Model, ModelFit, end_basis, end_columns, fit_model

if TYPE_CHECKING:
    from .campaign_model import CampaignModel
    from .readings import Readings, ReadingUncertainty

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]


_EXACT_SHARE: Final = 1e-6
"""Of the median variance of a reading; none is taken to be smaller (modelling assumption)."""
_BLOCK: Final = 8192
"""Readings whose columns fit a core's cache."""


@dataclass(frozen=True, repr=False)
class FittedHardness(ShownFields):
    """Hardness of m series from all their readings.

    Attributes
    ----------
    readings
        The readings at the depths less the offset of their series.
    offset
        δ (m) that was subtracted; 0 where the model has no estimate.
    value
        H by definition (SI).
    interval
        (m, 2), 95 %, of H_V (N/m³).
    scatter
        Relative scatter s of each series about F = H_V V.
    """

    readings: Readings
    offset: FloatArray
    value: dict[str, FloatArray]
    interval: FloatArray
    scatter: FloatArray

    def of(self, chosen: BoolArray) -> FittedHardness:
        """Keep the chosen series."""
        value = {symbol: H[chosen] for symbol, H in self.value.items()}
        readings = self.readings.of(chosen)
        return FittedHardness(readings, self.offset[chosen], value, self.interval[chosen], self.scatter[chosen])


def fitted_hardness(readings: Readings, model: CampaignModel) -> FittedHardness:
    """H_V of each series by the campaign's model, H_e and H_A from all readings at the depths less the offset."""
    offset = np.nan_to_num(model.offset)
    moved = readings.less_offset(offset)
    estimates = {
        symbol: hardness_of_all_readings(moved, definition, model.uncertainty)
        for symbol, definition in DEFINITIONS.items()
    }
    value = {symbol: H for symbol, (H, _) in estimates.items()}
    value["H_V"] = np.where(np.isfinite(model.log_hardness), model.hardness, value["H_V"])
    return FittedHardness(moved, offset, value, model.hardness_interval, estimates["H_V"][1])


def pooled_scatter(scatter: FloatArray) -> float:
    """Root mean square of the series' relative scatters; series without one take no part, 0 if none has any."""
    known = scatter[np.isfinite(scatter)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0


def fit_models_with_depth_errors(
    fitted: FittedHardness, uncertainty: ReadingUncertainty, *, n_iterations: int = 12
) -> tuple[tuple[ModelFit, ...], dict[Model, FloatArray]]:
    """Fit the nine candidate models by effective variance.

    Returns the rows and the final weights of the readings (1/N²) of each, for the bootstrap. The rmse are in force and
    unweighted, to stand beside those of `models.fit_models`.
    """
    readings, hardnesses, scatter = fitted.readings, fitted.value, pooled_scatter(fitted.scatter)
    fits: list[ModelFit] = []
    weights: dict[Model, FloatArray] = {}
    bases = {symbol: end_basis(readings, H) for symbol, H in hardnesses.items()}
    slopes_of = {symbol: _depth_slopes(readings, H) for symbol, H in hardnesses.items()}
    for model in MODELS:
        basis = bases[model.hardness]
        slopes = slopes_of[model.hardness]
        weight = _weights(readings, readings.load, np.zeros(readings.n), uncertainty, scatter)
        previous = np.full(4, np.nan)
        for _ in range(n_iterations if model.n_parameters else 0):
            ends = _weighted_ends(basis, model, readings.load, weight)
            weight = _weights(readings, basis.columns @ ends, slopes @ ends, uncertainty, scatter)
            if np.allclose(ends, previous, rtol=1e-6, atol=0.0):
                break
            previous = ends
        of_load = condensed(basis.columns, readings.load, weights=weight)
        fits.append(fit_model(readings, basis, model, of_load))
        weights[model] = weight
    return tuple(fits), weights


def _weighted_ends(basis: EndBasis, model: Model, load: FloatArray, weight: FloatArray) -> FloatArray:
    """End values of a weighted fit by its normal equations: good enough before the final factorised fit."""
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


def _depth_slopes(readings: Readings, hardness: FloatArray) -> FloatArray:
    """d/de of the four regressors: dA/de and dV/de = A in the place of A and V."""
    # a line contact (cylinder at e = 0) has an infinite dA/de: no depth, no information
    growth = np.where(np.isfinite(readings.area_growth), readings.area_growth, 0.0)
    return end_columns(readings, hardness, growth, readings.contact_area)


def _weights(
    readings: Readings, force: FloatArray, force_slope: FloatArray, uncertainty: ReadingUncertainty, scatter: float
) -> FloatArray:
    variance = (scatter * force) ** 2 + uncertainty.load**2 + (force_slope * uncertainty.depth) ** 2
    least, most = float(variance.min()), float(variance.max())
    if most <= 0.0:
        return np.ones(readings.n)
    if least < _EXACT_SHARE * most:  # a reading of force 0 must not count as exact
        variance = np.maximum(variance, _EXACT_SHARE * float(np.median(variance[variance > 0])))
    return 1.0 / variance
