"""Estimates of each penetration series, quality flags that need them, and the experiments that are included."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np

from .._support.arrays import BoolArray, FloatArray, index_names
from .._support.messages import Message
from .._support.units import N_PER_MM3, ShownFields
from ..campaign.problems import Problem
from ..campaign.records import Campaign, PenetrationTests
from ..campaign.screening import flag_problems, screen_penetration, screen_shear
from ..geometry import GeometryForm
from .campaign_model import DEFAULT_PRIORS, CampaignModel
from .hardness import DEFINITIONS, Hardness, hardness, hardness_at_largest_load, shear_stress
from .layering import layered
from .readings import Readings, ReadingUncertainty, readings_of
from .spread_groups import fit_in_groups
from .unloading import NOT_FALLING, Unloading, unloading

FEWEST_FOR_OUTLIERS: Final = 5
OUTLIER_DISTANCE: Final = 3.5
"""Iglewicz and Hoaglin (1993): a modified z score above 3.5 is a potential outlier."""
NORMAL_MAD: Final = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""


@dataclass(frozen=True, slots=True, repr=False)
class Screened(ShownFields):
    """Quality flags of each experiment by code, and which experiments are used (masks over the experiments).

    ``estimates`` of the penetration series; their spreads come from the used series.
    """

    flags: Mapping[str, BoolArray]
    used: BoolArray
    estimates: SeriesEstimates | None = None

    def codes(self) -> list[list[str]]:
        """Codes of the flags of each experiment, in the order of `QUALITY_FLAGS`."""
        codes_of: list[list[str]] = [[] for _ in range(len(self.used))]
        for code, mask in self.flags.items():
            for index in np.flatnonzero(mask).tolist():
                codes_of[index].append(code)
        return codes_of


def screened_penetration(campaign: Campaign, *, geometry: GeometryForm) -> Screened:
    """Quality flags of the penetration experiments, also those that need the hardness, and which of them are used."""
    tests = campaign.penetration
    if tests is None:
        return Screened({}, np.zeros(0, dtype=bool))
    flags = dict(screen_penetration(campaign, geometry=geometry))
    readings = readings_of(tests, campaign.tools, geometry=geometry)
    H_V = hardness_at_largest_load(readings, DEFINITIONS["H_V"])

    def used() -> BoolArray:
        return _mask_of_used(flags, campaign, len(tests)) & np.isfinite(H_V)

    flags["layered"] = layered(readings, np.where(used(), H_V, np.nan), reading_uncertainty(campaign))
    flags["hardness_outlier"] = hardness_outliers(H_V, used(), tests.site)
    estimates = series_estimates(campaign, tests, readings, counts=used(), not_falling=flags[NOT_FALLING])
    flags["rebound_unresolved"] = estimates.unloading.is_unresolved
    return Screened(flags, used(), estimates)


def screened_shear(campaign: Campaign) -> Screened:
    """Quality flags of the shear experiments and which of them are used."""
    tests = campaign.shear
    if tests is None:
        return Screened({}, np.zeros(0, dtype=bool))
    flags = dict(screen_shear(campaign))
    defined = np.isfinite(shear_stress(campaign, tests).value)
    return Screened(flags, _mask_of_used(flags, campaign, len(tests)) & defined)


def hardness_outliers(hardness: FloatArray, used: BoolArray, site: Sequence[str]) -> BoolArray:
    """Mask of used series with |ln H_V - site median| > 3.5 × 1.4826 × MAD, at sites with five or more used series."""
    outlier = np.zeros(len(hardness), dtype=bool)
    logs = np.log(hardness, out=np.zeros_like(hardness), where=used)
    names, site_of = index_names(site)
    order = np.argsort(site_of, kind="stable")
    bounds = np.searchsorted(site_of[order], np.arange(len(names) + 1))
    for start, stop in pairwise(bounds.tolist()):
        members = order[start:stop]
        members = members[used[members]]
        if len(members) < FEWEST_FOR_OUTLIERS:
            continue
        distance = np.abs(logs[members] - np.median(logs[members]))
        mad = float(np.median(distance))
        if mad > 0:
            outlier[members] = distance > OUTLIER_DISTANCE * NORMAL_MAD * mad
    return outlier


def screened_both(campaign: Campaign, *, geometry: GeometryForm) -> tuple[Screened, Screened]:
    """The penetration and the shear experiments, screened."""
    return screened_penetration(campaign, geometry=geometry), screened_shear(campaign)


def quality_flags(
    campaign: Campaign, *, geometry: GeometryForm = "extended", screened: tuple[Screened, Screened] | None = None
) -> list[Problem]:
    """Every quality flag of a campaign as a problem of severity ``flag``, the one that needs the hardness included.

    ``screened`` is the result of `screened_both`, if already computed.
    """
    penetration, shear = screened or screened_both(campaign, geometry=geometry)
    problems = flag_problems(campaign, penetration.flags, shear.flags, geometry=geometry)
    tests = campaign.penetration
    if tests is None:
        return problems
    H_V = hardness_at_largest_load(readings_of(tests, campaign.tools, geometry=geometry), DEFINITIONS["H_V"])
    values = {
        name: Message("H_V = {H_V:.4g} N/mm³", H_V=H) for name, H in zip(tests.experiment, H_V / N_PER_MM3, strict=True)
    }
    return [
        replace(problem, value=values[problem.experiment or ""]) if problem.code == "hardness_outlier" else problem
        for problem in problems
    ]


def _mask_of_used(flags: Mapping[str, BoolArray], campaign: Campaign, count: int) -> BoolArray:
    """True for each experiment without any flag that the campaign excludes."""
    excluded = np.zeros(count, dtype=bool)
    for code, mask in flags.items():
        if code in campaign.excluding:
            excluded |= mask
    return ~excluded


@dataclass(frozen=True, repr=False)
class SeriesEstimates(ShownFields):
    """Estimates of m series: the model, the hardness of each definition by its symbol, and the unloading."""

    model: CampaignModel
    hardness: dict[str, Hardness]
    unloading: Unloading


def reading_uncertainty(campaign: Campaign) -> ReadingUncertainty:
    """Standard uncertainties of a reading that the campaign states; 0 where it does not."""
    return ReadingUncertainty(campaign.depth_uncertainty or 0.0, campaign.load_uncertainty or 0.0)


def series_estimates(
    campaign: Campaign,
    tests: PenetrationTests,
    readings: Readings,
    *,
    counts: BoolArray | None = None,
    not_falling: BoolArray | None = None,
) -> SeriesEstimates:
    """Estimates of all series: campaign model, hardness by each definition, and unloading.

    counts: mask of the series that the spreads are estimated from (default: all).
    not_falling: mask of the series whose unloading is omitted (default: none).
    """
    priors = DEFAULT_PRIORS if campaign.seating is None else replace(DEFAULT_PRIORS, seating=campaign.seating)
    model = fit_in_groups(
        readings,
        hardness_at_largest_load(readings, DEFINITIONS["H_V"]),
        reading_uncertainty(campaign),
        labels={"site": tests.site, "tool": tests.tool},
        counts=counts,
        priors=priors,
    )
    H = {symbol: hardness(readings, definition, model) for symbol, definition in DEFINITIONS.items()}
    bad = np.zeros(len(tests), dtype=np.bool_) if not_falling is None else not_falling
    return SeriesEstimates(model, H, unloading(tests, readings, H["H_V"], model, bad))
