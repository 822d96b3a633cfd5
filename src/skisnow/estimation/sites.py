"""What each site has, whether one is harder than another, and how many tests would show it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.content import numbered
from ..statistics.two_groups import ratio_of_means, tests_per_group
from .comparisons import OwnValue, own_mean

if TYPE_CHECKING:
    from collections.abc import Sequence

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SiteMean:
    """Mean of the n used experiments of one site (``quantity`` as a key of the results, in its unit)."""

    quantity: str
    site: str
    n: int
    own: OwnValue


def site_means(quantity: str, values: FloatArray, site: Sequence[str], *, geometric: bool) -> tuple[SiteMean, ...]:
    """The mean of each site with its interval from the scatter between its experiments, in alphabetical order."""
    names, site_of = numbered(site)
    found = []
    for index, name in enumerate(names):
        mine = values[site_of == index]
        found.append(SiteMean(quantity, name, len(mine), own_mean(mine, [name] * len(mine), geometric=geometric)))
    return tuple(found)


@dataclass(frozen=True, slots=True)
class SiteComparison:
    """Ratio of the geometric means of two sites (a over b).

    Attributes
    ----------
    quantity
        ``H_V`` or ``S_f``.
    ratio, interval, p
        Welch's test on logarithms; NaN where a site has fewer than two tests.
    n_for_10_percent
        Tests at each site that would detect ±10 % with a power of 80 % at 5 %, given the scatter within the two sites;
        None where the scatter is unknown.
    """

    quantity: str
    site_a: str
    site_b: str
    ratio: float
    interval: FloatArray
    p: float
    n_for_10_percent: int | None


def compare_sites(quantity: str, values: FloatArray, site: Sequence[str]) -> tuple[SiteComparison, ...]:
    """Compare every pair of sites by the used experiments (values above 0 alone), in alphabetical order."""
    positive = values > 0
    names, site_of = numbered([name for name, use in zip(site, positive.tolist(), strict=True) if use])
    logs = np.log(values[positive])
    groups = {name: logs[site_of == index] for index, name in enumerate(names)}
    return tuple(_compare(quantity, (a, groups[a]), (b, groups[b])) for a, b in combinations(sorted(groups), 2))


def _compare(quantity: str, a: tuple[str, FloatArray], b: tuple[str, FloatArray]) -> SiteComparison:
    result = ratio_of_means(a[1], b[1])
    dof = len(a[1]) + len(b[1]) - 2
    pooled = float("nan")
    if dof > 0:
        squares = sum(float(np.sum((logs - logs.mean()) ** 2)) for logs in (a[1], b[1]))
        pooled = float(np.sqrt(squares / dof))
    needed = tests_per_group(pooled) if pooled > 0 else None
    return SiteComparison(quantity, a[0], b[0], result.ratio, np.asarray(result.interval), result.p, needed)
