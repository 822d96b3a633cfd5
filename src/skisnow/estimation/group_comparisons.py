"""Ratios of the means of two sites, tools, observers or days, from the intervals of the experiments.

The logarithm of experiment i is the effect of its group, of its site where groups other than sites are compared, the
scatter of the snow from spot to spot with the variance σ², and a measuring error with the known variance v_i:

    ln x_i = μ_group(i) + μ_site(i) + spot + error,    V_i = σ² + v_i.

v_i is from the interval of the experiment, so for H_V from the campaign's model. Least squares give the effects;
σ² = (RSS - Σ (1 - h_i) v_i)/(N - rank), at least 0, with the leverages h_i (method of moments). A ratio has the
variance Σ a_i² V_i, a the weights of the observations in it, and Student's factor of N - rank degrees of freedom. Where
Bartlett's test finds that the groups scatter differently, each has its own σ² and the factor is that of Welch and
Satterthwaite. Two groups that were not tested at a common site have no ratio, unless the groups are the sites.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final, NamedTuple

import numpy as np
from scipy.special import stdtr

from .._support.arrays import BoolArray, FloatArray, index_names
from .._support.units import CONFIDENCE
from ..campaign.records import Campaign, PenetrationTests, ShearTests
from ..statistics.combined_uncertainty import expanded_factor, welch_satterthwaite
from ..statistics.f_tests import compact_letters, holm_corrected, tests_per_group
from .hardness import shear_stress
from .screening import Screened
from .spread_groups import bartlett

DIFFERENCE: Final = 0.2
"""Relative difference of two groups that a campaign is to detect (default of `skisnow.analyse`)."""
POWER: Final = 0.8
LEVEL: Final = 0.05
OWN_SCATTER_LEVEL: Final = 0.2
"""p of Bartlett's test below which each group has its own scatter."""
_ESTIMABLE: Final = 1e-8
_DAY: Final = re.compile(r"\d{4}-\d{2}-\d{2}")
_OBSERVER: Final = ("observer", "operator")


@dataclass(frozen=True, slots=True)
class GroupComparison:
    """Ratio of the geometric means of two groups (a over b).

    quantity, by: ``H_V`` or ``S_f``; ``site``, ``tool``, ``observer`` or ``day``.
    n_a, n_b: used experiments of each group.
    ratio, interval, p: with 95 % interval and test against 1, of this pair; NaN where the scatter is unknown.
    p_holm, n_pairs: p corrected for the number of pairs of this quantity and kind of group (Holm 1979, Scand. J. Stat.
        6, 65-70).
    n_needed: experiments in each group that would detect the difference of the analysis with a power of 80 % at 5 %,
        given the pooled scatter; None where the scatter is unknown.
    """

    quantity: str
    by: str
    group_a: str
    group_b: str
    n_a: int
    n_b: int
    ratio: float
    interval: FloatArray
    p: float
    n_needed: int | None
    p_holm: float = float("nan")
    n_pairs: int = 0


class Measured(NamedTuple):
    """Logarithms of the used values of one quantity, variances of their errors, and labels by kind of group."""

    quantity: str
    logs: FloatArray
    error2: FloatArray
    labels: dict[str, list[str]]


def measured(
    quantity: str, value: FloatArray, interval: FloatArray, used: BoolArray, labels: dict[str, tuple[str, ...]]
) -> Measured:
    """Take the used values above 0; an experiment without an interval counts as free of error."""
    taken = np.flatnonzero(used & (value > 0) & np.isfinite(value))
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.log(interval[taken, 1] / value[taken])
    error2 = (np.nan_to_num(half, nan=0.0, posinf=0.0, neginf=0.0) / expanded_factor(np.inf, CONFIDENCE)) ** 2
    chosen = {by: [names[index] for index in taken.tolist()] for by, names in labels.items()}
    return Measured(quantity, np.log(value[taken]), error2, chosen)


def group_labels(tests: PenetrationTests | ShearTests, tool: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """Site, tool, observer and day of each experiment; ``""`` where the file does not name it."""
    first = tests.first[:-1].tolist() if hasattr(tests, "first") else range(len(tests))
    further = {name.casefold(): cells for name, cells in tests.further.items()}
    labels = {"site": tests.site, "tool": tool}
    observer = next((further[name] for name in _OBSERVER if name in further), None)
    if observer is not None:
        labels["observer"] = tuple(observer[index].strip() for index in first)
    if "time" in further:
        days = (_DAY.match(further["time"][index].strip()) for index in first)
        labels["day"] = tuple(match[0] if match else "" for match in days)
    return labels


def compare_groups(data: Measured, by: str, difference: float = DIFFERENCE) -> tuple[GroupComparison, ...]:
    """Compare every pair of groups, in alphabetical order; groups other than sites at their common sites.

    by: kind of group: a key of ``data.labels``.
    difference: relative difference that ``n_needed`` is for, > 0.
    """
    labelled = np.flatnonzero([bool(label) for label in data.labels[by]])
    if labelled.size == 0:
        return ()
    groups = [data.labels[by][index] for index in labelled.tolist()]
    sites = [data.labels["site"][index] for index in labelled.tolist()] if by != "site" else None
    fit = _EffectsFit(data.logs[labelled], data.error2[labelled], groups, sites)
    needed = None if not fit.scatter > 0 else tests_per_group(fit.scatter, ratio=1.0 + difference, power=POWER)
    pairs = [(a, b) for a, b in combinations(np.argsort(fit.names).tolist(), 2) if fit.is_estimable(a, b)]
    ratios = [fit.ratio(a, b) for a, b in pairs]
    corrected = holm_corrected(np.array([p for _, _, p in ratios]))
    n_pairs = int(np.isfinite(corrected).sum())
    return tuple(
        GroupComparison(
            data.quantity, by, fit.names[a], fit.names[b], int(fit.n[a]), int(fit.n[b]), *ratio, needed, p, n_pairs
        )
        for (a, b), ratio, p in zip(pairs, ratios, corrected.tolist(), strict=True)
    )


def compare_campaign(
    campaign: Campaign, penetration: Screened | None, shear: Screened | None, *, difference: float = DIFFERENCE
) -> tuple[GroupComparison, ...]:
    """Comparisons of every pair of sites, tools, observers and days, for H_V and S_f of used experiments."""
    quantities = []
    if penetration is not None and penetration.estimates is not None and campaign.penetration is not None:
        H = penetration.estimates.hardness["H_V"]
        labels = group_labels(campaign.penetration, campaign.penetration.tool)
        quantities.append(measured("H_V", H.value, H.interval, penetration.used, labels))
    if shear is not None and campaign.shear is not None:
        S = shear_stress(campaign, campaign.shear)
        labels = group_labels(campaign.shear, campaign.shear.plate)
        quantities.append(measured("S_f", S.value, S.interval, shear.used, labels))
    return tuple(pair for data in quantities for by in data.labels for pair in compare_groups(data, by, difference))


def letters_of_groups(pairs: Sequence[GroupComparison], names: Sequence[str]) -> dict[str, str]:
    """Letters of the groups: two share one where their pair is not shown to differ after Holm's correction."""
    place = {name: index for index, name in enumerate(names)}
    differ = np.zeros((len(names), len(names)), dtype=np.bool_)
    for pair in pairs:
        if pair.group_a in place and pair.group_b in place and pair.p_holm < LEVEL:
            a, b = place[pair.group_a], place[pair.group_b]
            differ[a, b] = differ[b, a] = True
    return dict(zip(names, compact_letters(differ), strict=True))


class _EffectsFit:
    """Least-squares fit of group effects (and site effects) to means of the cells of group and site."""

    def __init__(self, logs: FloatArray, error2: FloatArray, groups: list[str], sites: list[str] | None) -> None:
        self.names, self._group = index_names(groups)
        blocks, block = index_names(sites) if sites is not None else ([], np.zeros(len(groups), dtype=np.int64))
        n_groups, n_blocks = len(self.names), len(blocks)
        cells, cell = np.unique(self._group * max(n_blocks, 1) + block, return_inverse=True)
        self.n = np.bincount(self._group, minlength=n_groups)
        count = np.bincount(cell).astype(float)
        mean, error2 = np.bincount(cell, logs) / count, np.bincount(cell, error2) / count
        within = np.bincount(cell, (logs - mean[cell]) ** 2)
        self._of_cell = cells // max(n_blocks, 1)
        design = np.zeros((len(cells), n_groups + n_blocks))
        design[np.arange(len(cells)), self._of_cell] = 1.0
        if n_blocks:
            design[np.arange(len(cells)), n_groups + cells % n_blocks] = 1.0
        normal = design.T @ (count[:, None] * design)
        inverse = np.linalg.pinv(normal, hermitian=True)
        self._projection = normal @ inverse
        weights = design @ inverse
        effects = inverse @ (design.T @ (count * mean))
        self._effects = effects
        free = count - count * np.einsum("ck,ck->c", weights, design)
        squares = within + count * (mean - design @ effects) ** 2
        self._spread(squares, free, error2, n_groups)
        self._weights = np.sqrt(count)[:, None] * weights
        self._variance = self._scatter2[self._of_cell] + error2

    def _spread(self, squares: FloatArray, free: FloatArray, error2: FloatArray, n_groups: int) -> None:
        """Set σ² of each group without measurement error, and its freedom; pooled unless groups' scatters differ."""
        degrees = max(round(float(free.sum()), 6), 0.0)
        self.degrees = degrees
        error_squares = float(free @ error2)
        Q, f, u2 = (
            np.bincount(self._of_cell, values, minlength=n_groups).astype(np.float64)
            for values in (squares, free, free * error2)
        )
        with np.errstate(invalid="ignore", divide="ignore"):
            pooled = max(float(squares.sum()) - error_squares, 0.0) / degrees if degrees > 0.5 else np.nan
            own = np.maximum(Q - u2, 0.0) / f
        enough = f > 0.5
        self.is_pooled = not bartlett(Q, f, fewest=1.0).p < OWN_SCATTER_LEVEL
        self._scatter2 = np.full(n_groups, pooled) if self.is_pooled else np.where(enough, own, pooled)
        self._freedom = np.where(enough & (not self.is_pooled), f, degrees)
        self.scatter = float(np.sqrt(pooled + error2.mean())) if degrees > 0.5 else float("nan")

    def is_estimable(self, a: int, b: int) -> bool:
        """True if the data determine the difference of two groups."""
        off = self._projection[:, a] - self._projection[:, b]
        off[a] -= 1.0
        off[b] += 1.0
        return bool(np.abs(off).max() < _ESTIMABLE)

    def ratio(self, a: int, b: int) -> tuple[float, FloatArray, float]:
        """Ratio a/b, its 95 % interval, and p."""
        difference = float(self._effects[a] - self._effects[b])
        parts = (self._weights[:, a] - self._weights[:, b]) ** 2 * self._variance
        variance = float(parts.sum())
        if not variance > 0:
            return float(np.exp(difference)), np.full(2, np.nan), float("nan")
        degrees = self.degrees
        if not self.is_pooled:
            by_group = np.bincount(self._of_cell, parts, minlength=len(self.names))
            degrees = float(welch_satterthwaite(by_group, self._freedom))
        half = float(expanded_factor(degrees, CONFIDENCE)) * variance**0.5
        p = 2.0 * float(stdtr(degrees, -abs(difference) / variance**0.5))
        return float(np.exp(difference)), np.exp([difference - half, difference + half]), p
