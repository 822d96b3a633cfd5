"""Groups of series with their own spreads, where one spread for the whole campaign does not hold.

`campaign_model` has one seating τ and one relative scatter s. Where some sites or tools are several times noisier than
the others, their intervals would be too narrow and those of the others too wide. Bartlett's test (1937, Proc. R. Soc.
A 160, 268-282, doi 10.1098/rspa.1937.0109) compares the spreads of sites and of tools; where they differ beyond chance
and by a clear factor, the model is fitted again with the spreads of each site or tool.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from scipy.special import chdtrc

from .._support.content import numbered
from .campaign_model import DEFAULT_PRIORS, CampaignModel, fit_campaign

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .campaign_fit import Priors
    from .readings import Readings, ReadingUncertainty

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.int64]

LEVEL: Final = 1e-3
"""Spreads are compared at this level."""
CLEAR_FACTOR: Final = 2.0
"""Between the largest and the smallest spread of the groups; less does not justify spreads of each group."""
FEWEST_DEGREES: Final = 5.0
"""Degrees of freedom that a group needs to take part in the test."""


@dataclass(frozen=True, slots=True)
class SpreadTest:
    """Bartlett's test that groups have one spread: p, and the largest over the smallest standard deviation."""

    p: float
    factor: float

    @property
    def is_clear(self) -> bool:
        """Whether the spreads differ beyond chance and by a clear factor."""
        return self.p < LEVEL and self.factor > CLEAR_FACTOR


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

    Parameters
    ----------
    labels
        Candidate groupings: the name of the grouping, and the label of each series.
    readings, hardness, uncertainty, counts, priors
        As in `fit_campaign`.
    """
    model = fit_campaign(readings, hardness, uncertainty, counts=counts, priors=priors)
    clear = []
    for grouping, label in labels.items():
        names, index = numbered(label)
        tests = spread_tests(model, index) if len(names) > 1 else ()
        clear += [(test.p, grouping, names, index) for test in tests if test.is_clear]
    if not clear:
        return model
    _, grouping, names, index = min(clear, key=lambda entry: entry[0])
    apart = fit_campaign(readings, hardness, uncertainty, counts=counts, group=index, priors=priors)
    return replace(apart, grouped_by=grouping, group_names=tuple(names))


def spread_tests(model: CampaignModel, index: IntArray) -> tuple[SpreadTest, SpreadTest]:
    """Tests of the scatter s and of the seating τ between the groups of ``index`` (m,), of a model with one group."""
    known = model.counts & np.isfinite(model.log_hardness)
    seating2 = model.spreads.seating2[0]
    # Under the model the estimate of δ has the variance τ² B, B = 1 - C_δδ/τ²: what the prior leaves to the data.
    share = 1.0 - model.covariance[:, 2, 2] / seating2
    return (
        _bartlett(model.misfit[known], model.free[known], index[known]),
        _bartlett((share * model.offset**2 / seating2)[known], (share**2)[known], index[known]),
    )


def _bartlett(squares: FloatArray, degrees: FloatArray, index: IntArray) -> SpreadTest:
    """The test from sums of squares and degrees of freedom of the series."""
    Q, f = (np.bincount(index, weights=values) for values in (squares, degrees))
    enough = f >= FEWEST_DEGREES
    Q, f = Q[enough], f[enough]
    if len(f) < 2 or Q.min() <= 0.0:
        return SpreadTest(1.0, 1.0)
    total, variance = f.sum(), Q / f
    statistic = total * np.log(Q.sum() / total) - f @ np.log(variance)
    correction = 1.0 + ((1.0 / f).sum() - 1.0 / total) / (3.0 * (len(f) - 1.0))
    p = float(chdtrc(len(f) - 1.0, statistic / correction))
    return SpreadTest(p, float(np.sqrt(variance.max() / variance.min())))
