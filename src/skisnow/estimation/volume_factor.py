"""The factor b of F = b H_V V with H_V of Eqn 1: its dilution by errors, and the factor without it.

x = H_V V of a reading carries errors of its own depth and of the last one, which defines H_V. With the variance w of
ln x the mean of x F is exp(w/2) times too large and that of x² exp(2 w) times, so that least squares give a b below 1
even where the law holds: *regression dilution*. Layering changes x by the factor u = (F/F₇)^(g_0 - 1). Both are
corrected:

    b = Σ (x/u) F exp(-w/2) / Σ (x/u)² exp(-2 w)

with w from the spreads of `campaign_model`; the exponents also have the third cumulant of the layering, which is
skewed. The error comes from the scatter between series (Student's t, m - 1 degrees of freedom).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from .._support.display import ShownFields
from .._support.units import CONFIDENCE
from ..statistics.combined_uncertainty import expanded_factor
from .campaign_model import CONTACT_STEPS

if TYPE_CHECKING:
    from .campaign_model import CampaignModel
    from .readings import Readings

FloatArray = npt.NDArray[np.float64]

_LARGEST_VARIANCE: Final = 0.2
"""Of ln x, above which the correction is no longer small and a reading is omitted."""


@dataclass(frozen=True, slots=True, repr=False)
class VolumeFactor(ShownFields):
    """The factor b of n series.

    Attributes
    ----------
    n
        Number of series.
    raw, expected_raw
        By least squares, and the value that these estimate where F = H_V V holds, with these errors and layers.
    value, low, high
        Corrected, and its 95 % interval, NaN with one series.
    """

    n: int
    raw: float
    expected_raw: float
    value: float
    low: float
    high: float


def volume_factor(readings: Readings, hardness: FloatArray, model: CampaignModel) -> VolumeFactor:
    """The factor b of the series that have a hardness (N/m³, of Eqn 1) and an estimate of the model."""
    known = np.isfinite(hardness) & np.isfinite(model.log_hardness)
    if not known.any():
        return VolumeFactor(0, *[float("nan")] * 5)
    readings, hardness, model = readings.of(known), hardness[known], model.of(known)
    F, x = readings.load, hardness[readings.series] * readings.displaced_volume
    w, usable = _error_variance(readings, model)
    layers = np.exp((model.spreads.mean_exponent[model.group][readings.series] - 1.0) * _log_share(readings))
    even = x / layers
    skew = _layering_skewness(model)[readings.series] * _log_share(readings) ** 3
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


def _log_share(readings: Readings) -> FloatArray:
    log = np.log(readings.load)
    return log - log[readings.largest][readings.series]


def _layering_skewness(model: CampaignModel) -> FloatArray:
    """Third moment of g about g_0 in the group of each series: exponents of layered snow are skewed."""
    cubes = (model.exponent - model.spreads.mean_exponent[model.group]) ** 3
    n_groups = len(model.spreads.mean_exponent)
    number = np.bincount(model.group, minlength=n_groups)
    return (np.bincount(model.group, weights=cubes, minlength=n_groups) / np.maximum(number, 1))[model.group]


def _error_variance(readings: Readings, model: CampaignModel) -> tuple[FloatArray, FloatArray]:
    """Variance w of ln(H_V V/F) of each reading, 0 of the last, and a mask of the usable readings."""
    series, last, uncertainty = readings.series, readings.largest, model.uncertainty
    volume = readings.displaced_volume
    per_depth = np.divide(readings.contact_area, volume, out=np.zeros_like(volume), where=volume > 0)
    group = model.group[series]
    own = model.spreads.scatter2[group] + (uncertainty.load / readings.load) ** 2 + (per_depth * uncertainty.depth) ** 2
    seating2 = model.spreads.seating2[group] * (per_depth - per_depth[last][series]) ** 2
    w = own + own[last][series] + seating2 + model.spreads.layering2[group] * _log_share(readings) ** 2
    w[last] = 0.0
    contact = readings.penetration_depth > CONTACT_STEPS * 12.0**0.5 * uncertainty.depth
    usable = contact & (w < _LARGEST_VARIANCE)
    if usable.sum() == len(last):  # none but the last readings, which are exact by definition
        usable[:] = False
    return np.where(usable, w, 0.0), usable.astype(float)
