"""The model table with the error where it is: in depth as well as in load.

The paper's fit takes H of each series from its last reading, as if that were exact, and puts all error into the load.
Here H of each series comes from all its readings (`hardness.Hardness.fitted`), and a reading's residual is weighed by
its effective variance (Orear 1982),

    (s F̂)² + u_F² + (dF̂/de · u_e)²,

with the campaign's own relative scatter s. Rows, bounds and units are those of `models`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ..statistics.bounded import non_negative_fits
from .models import MODELS, EndBasis, Model, ModelFit, end_basis, fit_model

if TYPE_CHECKING:
    from .hardness import ReadingUncertainty
    from .readings import Readings

FloatArray = npt.NDArray[np.float64]


def pooled_scatter(scatter: FloatArray) -> float:
    """Root mean square of the series' relative scatters; series without one take no part, 0 if none has any."""
    known = scatter[np.isfinite(scatter)]
    return float(np.sqrt(np.mean(known**2))) if known.size else 0.0


def fit_models_with_depth_errors(
    readings: Readings,
    hardnesses: dict[str, FloatArray],
    uncertainty: ReadingUncertainty,
    scatter: float,
    *,
    n_iterations: int = 12,
) -> tuple[tuple[ModelFit, ...], dict[Model, FloatArray]]:
    """Fit the nine rows by effective variance; ``hardnesses`` are the fitted ones (SI).

    Returns the rows and the final weights of the readings (1/N²) of each, for the bootstrap. The rmse are in force and
    unweighted, to stand beside those of `models.fit_models`.
    """
    fits: list[ModelFit] = []
    weights: dict[Model, FloatArray] = {}
    bases = {symbol: end_basis(readings, H) for symbol, H in hardnesses.items()}
    for model in MODELS:
        basis = bases[model.hardness]
        slopes = _depth_slopes(readings, basis, hardnesses[model.hardness])
        weight = _weights(readings, readings.load, np.zeros(readings.n), uncertainty, scatter)
        previous = np.full(4, np.nan)
        for _ in range(n_iterations if model.n_parameters else 0):
            ends = _weighted_ends(basis, model, readings.load, weight)
            weight = _weights(readings, basis.columns @ ends, slopes @ ends, uncertainty, scatter)
            if np.allclose(ends, previous, rtol=1e-8, atol=0.0):
                break
            previous = ends
        fits.append(fit_model(readings, basis, model, weights=weight)[0])
        weights[model] = weight
    return tuple(fits), weights


def _weighted_ends(basis: EndBasis, model: Model, load: FloatArray, weight: FloatArray) -> FloatArray:
    """End values of a weighted fit by its normal equations: good enough on the way to the final factorised fit."""
    weighted = basis.columns * weight[:, None]
    projection, fixed = basis.projection(model), basis.offset(model)
    gram = weighted.T @ basis.columns
    moment = weighted.T @ load - gram @ fixed
    fitted = non_negative_fits((projection.T @ gram @ projection)[None], (moment @ projection)[None])[0]
    return fixed + projection @ fitted


def _depth_slopes(readings: Readings, basis: EndBasis, hardness: FloatArray) -> FloatArray:
    """d/de of the four regressors: dA/de and dV/de = A in the place of A and V."""
    span = basis.high - basis.low
    t = (readings.angle_of_reading - basis.low) / span if span > 0 else np.zeros(readings.n)
    H = hardness[readings.series]
    # a line contact (cylinder at e = 0) has an infinite dA/de: no depth, no information
    growth = np.where(np.isfinite(readings.area_growth), readings.area_growth, 0.0)
    da, db = H * growth, H * readings.contact_area
    return np.stack((da * (1.0 - t), da * t, db * (1.0 - t), db * t), axis=1)


def _weights(
    readings: Readings, force: FloatArray, force_slope: FloatArray, uncertainty: ReadingUncertainty, scatter: float
) -> FloatArray:
    variance = (scatter * force) ** 2 + uncertainty.load**2 + (force_slope * uncertainty.depth) ** 2
    if not np.any(variance > 0):
        return np.ones(readings.n)
    floor = 1e-6 * float(np.median(variance[variance > 0]))  # a reading of force 0 must not count as exact
    return 1.0 / np.maximum(variance, floor)
