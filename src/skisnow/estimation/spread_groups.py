"""Groups of series with separate spreads, where one spread does not fit the whole campaign.

`campaign_model` has one seating τ and one relative scatter s. Where some sites or tools are several times noisier than
the others, their intervals would be too narrow and those of the others too wide. Bartlett's test (1937, Proc. R. Soc.
A 160, 268-282, doi 10.1098/rspa.1937.0109) compares the spreads of sites and of tools; where they differ beyond chance
and by a clear factor, the model is fitted again with the spreads of each site or tool.

Where noisier series are mixed with quieter ones at the same site and with the same tool, no label separates them. Then
the sums of squares of the series do: a mixture of two scaled chi-squared distributions (EM algorithm; Dempster, Laird
and Rubin 1977, J. R. Stat. Soc. B 39, 1-38) sorts the series into two classes, each with its own spreads.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.special import chdtrc, expit, gammaln

from .._support.arrays import BoolArray, FloatArray, index_names
from .._support.messages import Message
from .campaign_fit import Priors
from .campaign_model import DEFAULT_PRIORS, CampaignModel, fit_campaign
from .readings import Readings, ReadingUncertainty

LEVEL: Final = 1e-3
"""Spreads are compared at this level."""
CLEAR_FACTOR: Final = 2.0
"""Between the largest and the smallest spread of the groups; less does not justify spreads of each group."""
FEWEST_DEGREES: Final = 5.0
"""Degrees of freedom that a group needs to take part in the test."""
OVERDISPERSED: Final = 1.5
"""Spread of the sums of squares of the series over that of one scatter, above which two classes are tried."""
LIKELIHOOD_GAIN: Final = 20.0
"""Twice the gain in log likelihood that two classes need over one (3 parameters more)."""
SMALLEST_CLASS: Final = 0.1
"""Share of the series; a smaller class is a few outliers."""
LEAST_SHARE: Final = 0.3
"""Share of τ² that an offset must leave to the data to take part in the sorting."""
SCATTER_CLASSES: Final = ("quieter series", "noisier series")
LISTED_SERIES: Final = 5
"""Names of series in a warning."""
_EM_ROUNDS: Final = 60


@dataclass(frozen=True, slots=True)
class SpreadTest:
    """Bartlett's test that groups have one spread: p, and the largest over the smallest standard deviation."""

    p: float
    factor: float


def fit_in_groups(
    readings: Readings,
    hardness: FloatArray,
    uncertainty: ReadingUncertainty,
    *,
    labels: Mapping[str, Sequence[str]],
    counts: BoolArray | None = None,
    priors: Priors = DEFAULT_PRIORS,
) -> CampaignModel:
    """Fit the campaign's model with common spreads, or with those of each group of the clearest grouping.

    Without a clear grouping by label, series that are clearly noisier than the others are a group (``scatter``).

    labels: candidate groupings: the name of the grouping, and the label of each series.
    """
    model = fit_campaign(readings, hardness, uncertainty, counts=counts, priors=priors)
    usable = model.counts & np.isfinite(model.log_hardness)
    squares, degrees, _ = _offset_squares(model)
    clear = []
    for grouping, label in labels.items():
        names, index = index_names(label)
        for Q, f in ((model.misfit, model.free), (squares, degrees)):  # the scatter s, and the seating τ
            sums = (np.bincount(index[usable], values[usable]).astype(np.float64) for values in (Q, f))
            test = bartlett(*sums, fewest=FEWEST_DEGREES)
            if test.p < LEVEL and test.factor > CLEAR_FACTOR:  # beyond chance, and by a clear factor
                clear.append((test.p, grouping, names, index))
    if clear:
        _, grouping, names, index = min(clear, key=lambda entry: entry[0])
    elif (sorted_ := noisier_series(model)) is not None:
        grouping, names, index = "scatter", list(SCATTER_CLASSES), sorted_.astype(np.int64)
    else:
        return model
    apart = fit_campaign(readings, hardness, uncertainty, counts=counts, group=index, priors=priors)
    return replace(apart, grouped_by=grouping, group_names=tuple(names))


def _offset_squares(model: CampaignModel) -> tuple[FloatArray, FloatArray, FloatArray]:
    """δ² of each series as a sum of squares with degrees of freedom, and its share of τ².

    Under the model the estimate of δ has the variance τ² B, B = 1 - C_δδ/τ²: the share that the prior leaves to the
    data.
    """
    seating2 = model.spreads.seating2[0]
    share = 1.0 - model.covariance[:, 2, 2] / seating2
    return share * model.offset**2 / seating2, share**2, share


def noisier_series(model: CampaignModel) -> BoolArray | None:
    """Mask of the series whose scatter is clearly larger than that of the others; None without two clear classes.

    ``model`` has one group. The sum of squared residuals of a series is its scale times chi-squared, and so is δ².
    Of two classes with their own scales and shares, each series belongs to the more probable one.
    """
    usable = model.counts & np.isfinite(model.log_hardness) & (model.free > 1.0)
    squares, degrees = model.misfit[usable], model.free[usable]
    if usable.sum() < 2 * FEWEST_DEGREES or squares.min() <= 0.0:
        return None
    scaled = squares * degrees.sum() / squares.sum()
    if np.mean((scaled - degrees) ** 2 / (2.0 * degrees)) < OVERDISPERSED:
        return None
    of_offset, free_offset, share = (values[usable] for values in _offset_squares(model))
    seen = (share > LEAST_SHARE) & (of_offset > 0.0)
    sums = [(squares, degrees), (np.where(seen, of_offset, 0.0), np.where(seen, free_offset, 0.0))]
    probability, gain, factor = _two_classes(sums)
    if gain < LIKELIHOOD_GAIN or factor < CLEAR_FACTOR or not SMALLEST_CLASS < probability.mean() < 1 - SMALLEST_CLASS:
        return None
    noisier = np.zeros(len(usable), dtype=np.bool_)
    noisier[usable] = probability > 0.5
    return noisier


def noisier_series_warning(model: CampaignModel, names: Sequence[str]) -> tuple[Message, ...]:
    """Warning that lists the noisier of all series (`names`) if the model fits two classes of scatter; otherwise ()."""
    if model.grouped_by != "scatter":
        return ()
    noisier = np.flatnonzero(model.counts & (model.group == 1)).tolist()
    quieter, larger = np.sqrt(model.spreads.scatter2).tolist()
    return (
        Message(
            "{n} of {total} series scatter {factor:.2g} times as much as the others, at the same sites and with the "
            "same tools ({first}): they have wider intervals. Check for another observer, gauge or tool.",
            n=len(noisier),
            total=int(model.counts.sum()),
            factor=larger / quieter,
            first=[names[index] for index in noisier[:LISTED_SERIES]] + ["…"] * (len(noisier) > LISTED_SERIES),
        ),
    )


def _two_classes(sums: Sequence[tuple[FloatArray, FloatArray]]) -> tuple[FloatArray, float, float]:
    """Probability of the noisier class, twice the gain in log likelihood, and the factor between the first scatters.

    ``sums`` are independent sums of squares with their degrees of freedom; those with 0 contain no information.
    """
    noisier = np.where(sums[0][0] / sums[0][1] > np.median(sums[0][0] / sums[0][1]), 0.9, 0.1)
    for _ in range(_EM_ROUNDS):
        large, small = _class_variances(sums, noisier), _class_variances(sums, 1.0 - noisier)
        share = float(np.clip(noisier.mean(), 0.01, 0.99))
        in_large = np.log(share) + _log_density(sums, large)
        in_small = np.log1p(-share) + _log_density(sums, small)
        noisier = expit(in_large - in_small)
    one = _log_density(sums, _class_variances(sums, np.ones_like(noisier)))
    gain = 2.0 * float(np.sum(np.logaddexp(in_large, in_small) - one))
    return noisier, gain, float(np.sqrt(large[0] / small[0]))


def _class_variances(sums: Sequence[tuple[FloatArray, FloatArray]], weight: FloatArray) -> list[float]:
    """Variance of each kind of residual over the series, weighted by their probability of the class."""
    return [float(weight @ squares) / max(float(weight @ degrees), 1e-300) for squares, degrees in sums]


def _log_density(sums: Sequence[tuple[FloatArray, FloatArray]], scales: Sequence[float]) -> FloatArray:
    """Logarithm of the density of the sums of squares, scale times chi-squared."""
    density = np.zeros(len(sums[0][0]))
    for (squares, degrees), scale in zip(sums, scales, strict=True):
        present = degrees > 0.0
        half, y = 0.5 * degrees[present], squares[present] / (2.0 * max(scale, 1e-300))
        density[present] += (half - 1.0) * np.log(y) - y - gammaln(half) - np.log(2.0 * max(scale, 1e-300))
    return density


def bartlett(squares: FloatArray, degrees: FloatArray, *, fewest: float) -> SpreadTest:
    """Bartlett's test from the sums of squares of the groups; only those with ``fewest`` degrees of freedom or more."""
    enough = degrees >= fewest
    Q, f = squares[enough], degrees[enough]
    if len(f) < 2 or Q.min() <= 0.0:
        return SpreadTest(1.0, 1.0)
    total, variance = f.sum(), Q / f
    statistic = total * np.log(Q.sum() / total) - f @ np.log(variance)
    correction = 1.0 + ((1.0 / f).sum() - 1.0 / total) / (3.0 * (len(f) - 1.0))
    p = float(chdtrc(len(f) - 1.0, statistic / correction))
    return SpreadTest(p, float(np.sqrt(variance.max() / variance.min())))
