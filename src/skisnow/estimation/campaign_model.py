"""One model of all penetration series of a campaign: hardness, layering and depth zero of each series.

Series i with the readings e_ij under the loads F_ij, F_i7 the largest of them:

    e_ij = ê(V_ij) + δ_i + error,    ln V_ij = ln(F_i7/H_i) + g_i ln(F_ij/F_i7),
    δ_i ~ N(0, τ²),    g_i ~ N(g_0, σ_g²),    variance of the error = u_e² + (dê/dln V)² (s² + (g u_F/F)²)

ê is the inverse of the tool's volume, u_e and u_F are the standard uncertainties of a depth and of a load. The spreads
τ (seating), σ_g (layering) and s (relative scatter of the force) belong to all series of a group, by default the whole
campaign. The campaign estimates them; weak priors keep them above 0 with few series. Each interval adds the parts that
the spreads cause and has Student's factor with the degrees of freedom of Welch and Satterthwaite. The model is ours:
docs/methods/intervals.md derives it and reports its coverage.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Final, NamedTuple

import numpy as np

from .._support.arrays import BoolArray, FloatArray, IntArray
from .._support.units import CONFIDENCE, ShownFields
from ..statistics.combined_uncertainty import expanded_factor, welch_satterthwaite
from .campaign_fit import Freedom, Priors, SeriesFit, Spreads
from .readings import Readings, ReadingUncertainty

FEWEST_READINGS: Final = 2
"""Readings in contact that a series needs."""
CONTACT_STEPS: Final = 0.75
"""Steps of the gauge above which a reading shows contact: a reading of 0 is the end of the scale, not a depth."""
_SPREADS: Final = ("seating", "layering", "scatter")
_OF_CAMPAIGN: Final = ("spreads", "freedom", "uncertainty", "priors", "grouped_by", "group_names")
_ENDS: Final = np.array([-1.0, 1.0])


DEFAULT_PRIORS: Final = Priors()


class Parts(NamedTuple):
    """Variance of an estimate of each series, and its parts that τ, σ_g and s cause."""

    variance: FloatArray
    seating: FloatArray
    layering: FloatArray
    scatter: FloatArray

    def times(self, factor: FloatArray) -> Parts:
        """Each part times a factor: the square of the number by which the estimate is multiplied."""
        return Parts(*(part * factor for part in self))

    def of(self, chosen: BoolArray) -> Parts:
        """Variance and parts of the chosen series only."""
        return Parts(*(part[chosen] for part in self))


@dataclass(frozen=True, repr=False)
class CampaignModel(ShownFields):
    """The fitted model of m series in G groups; NaN where a series has no estimate.

    log_hardness, exponent, offset: ln H_V (N/m³), g and δ (m).
    covariance: of these three, (m, 3, 3).
    scatter_parts: variances of these three that s causes, (m, 3).
    n_zero: readings at the end of the gauge's scale, which the fit leaves out.
    misfit, free: weighted sum of squared residuals, and the readings less the parameters that they determine.
    counts: mask of the series that the spreads are estimated from.
    group, spreads, freedom: index of the group of each series; spreads and their degrees of freedom, by group.
    uncertainty, priors: uncertainty of a reading, and priors of the spreads.
    grouped_by, group_names: ``campaign``, ``site`` or ``tool``, and the names of the groups.
    """

    log_hardness: FloatArray
    exponent: FloatArray
    offset: FloatArray
    covariance: FloatArray
    scatter_parts: FloatArray
    n_zero: IntArray
    misfit: FloatArray
    free: FloatArray
    counts: BoolArray
    group: IntArray
    spreads: Spreads
    freedom: Freedom
    uncertainty: ReadingUncertainty
    priors: Priors
    grouped_by: str = "campaign"
    group_names: tuple[str, ...] = ("",)

    def of(self, chosen: BoolArray) -> CampaignModel:
        """Keep the chosen series; groups and spreads stay."""
        by_series = [item.name for item in fields(self) if item.name not in _OF_CAMPAIGN]
        return replace(self, **{name: getattr(self, name)[chosen] for name in by_series})

    @property
    def hardness(self) -> FloatArray:
        """H_V (N/m³)."""
        return np.exp(self.log_hardness)

    @property
    def hardness_interval(self) -> FloatArray:
        """95 % interval of H_V (N/m³), (m, 2)."""
        return np.exp(self.log_hardness[:, None] + self.half_width(0)[:, None] * _ENDS)

    @property
    def offset_interval(self) -> FloatArray:
        """95 % interval of δ (m), (m, 2)."""
        return self.offset[:, None] + self.half_width(2)[:, None] * _ENDS

    def half_width(self, index: int) -> FloatArray:
        """Half of the 95 % interval of ln H_V (0), g (1) or δ (2)."""
        parts = self.parts(index)
        return self.factor(parts, self.group) * np.sqrt(parts.variance)

    def parts(self, index: int) -> Parts:
        """Variance of ln H_V (0), g (1) or δ (2) and its parts; the error of g_0 belongs to the part of σ_g."""
        C, layering2 = self.covariance, self.spreads.layering2[self.group]
        own = C[:, index, 1] ** 2 / layering2
        common = own / layering2 * self.freedom.mean_exponent_variance[self.group]
        return Parts(
            C[:, index, index] + common,
            C[:, index, 2] ** 2 / self.spreads.seating2[self.group],
            own + common,
            self.scatter_parts[:, index],
        )

    def factor(self, parts: Parts, group: IntArray, *further: tuple[FloatArray, FloatArray]) -> FloatArray:
        """Half-width of the 95 % interval over the standard error: Student's t with at least one degree of freedom.

        ``further`` are parts of the variance with their own degrees of freedom. Variance without a part counts as
        known.
        """
        pairs = [(getattr(parts, name), getattr(self.freedom, name)[group]) for name in _SPREADS]
        variances, degrees = (np.stack(values, axis=-1) for values in zip(*pairs, *further, strict=True))
        unexplained = np.maximum(parts.variance - variances.sum(axis=-1), 0.0)[..., None]
        variances = np.concatenate((variances, unexplained), axis=-1)
        degrees = np.concatenate((degrees, np.full(unexplained.shape, np.inf)), axis=-1)
        return expanded_factor(np.maximum(welch_satterthwaite(variances, degrees), 1.0), CONFIDENCE)


def fit_campaign(
    readings: Readings,
    hardness: FloatArray,
    uncertainty: ReadingUncertainty,
    *,
    counts: BoolArray | None = None,
    group: IntArray | None = None,
    priors: Priors = DEFAULT_PRIORS,
) -> CampaignModel:
    """Fit the model to all series.

    readings, uncertainty: the readings, and the standard uncertainties of one.
    hardness: H_V of Eqn 1 (N/m³), from which the iteration starts, (m,).
    counts: mask of the series that the spreads are estimated from (default: all). The others are fitted with these
        spreads.
    group: index of the group of each series (default: one group).
    """
    m = readings.n_series
    group = np.zeros(m, dtype=np.int64) if group is None else group
    contact = readings.penetration_depth > CONTACT_STEPS * 12.0**0.5 * uncertainty.depth
    n_contact = readings.sums(contact.astype(float))
    usable = np.isfinite(hardness) & (hardness > 0) & (n_contact >= FEWEST_READINGS)
    counts = usable if counts is None else usable & counts
    n_groups = int(group.max(initial=0)) + 1
    mine = readings.of(usable)
    seen = contact if usable.all() else contact[usable[readings.series]]
    counted, groups = counts[usable], group[usable]
    fit = SeriesFit(
        mine, hardness[usable], uncertainty, priors, seen=seen, counts=counted, group=groups, n_groups=n_groups
    ).solve()

    def everywhere(values: FloatArray) -> FloatArray:
        result = np.full((m, *values.shape[1:]), np.nan)
        result[usable] = values
        return result

    log_hardness, exponent, offset, covariance, scatter_parts = (everywhere(values) for values in fit.of_series)
    return CampaignModel(
        log_hardness=log_hardness,
        exponent=exponent,
        offset=offset,
        covariance=covariance,
        scatter_parts=scatter_parts,
        n_zero=(readings.sums(np.ones(readings.n)) - n_contact).astype(np.int64),
        misfit=everywhere(fit.misfit),
        free=everywhere(fit.free),
        counts=counts,
        group=group,
        spreads=fit.spreads,
        freedom=fit.freedom,
        uncertainty=uncertainty,
        priors=priors,
    )
