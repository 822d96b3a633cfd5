"""Parts of an `Analysis`: results of each kind of experiment, seating of each series, sites and their snow.

Seating: if the tool touches the snow at a gauge reading δ instead of 0, all depths of the series are δ too large: at
H_V = 10 N/mm³ and 45° a seating of 0.1 mm on 0.7 mm of depth already moves H_V by a third. Often the largest systematic
error.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from .._support.arrays import BoolArray, FloatArray, index_names
from .._support.messages import Message
from .._support.units import MM, N_PER_MM2, N_PER_MM3, Facts, Shown, amount, field_facts
from ..campaign.records import Campaign
from ..snow import SnowProperties
from ..snow.mean_snow import (
    mean_snow,
    no_used_experiment,
    site_in_words,
    site_named,
    with_measured_displacement,
    with_measured_unloading,
)
from .campaign_model import CampaignModel
from .comparisons import CampaignMean, SiteValue, own_mean
from .errors_in_depth import FittedHardness, VolumeFactor
from .group_comparisons import GroupComparison, letters_of_groups
from .hardness import Hardness, ShearDisplacement, ShearStress
from .layering import GrowingHardness
from .model_choice import NestedRows
from .models import Model, ModelFit
from .readings import Readings
from .screening import Screened
from .unloading import SiteUnloading, Unloading


@dataclass(frozen=True, repr=False)
class ModelTable(Shown):
    """The nine fitted rows with bootstrap intervals of a0, a1, b0, b1 by model ((4, 2) each); none where withheld."""

    fits: tuple[ModelFit, ...]
    intervals: dict[Model, FloatArray]

    def _repr_facts(self) -> Facts:
        """Title with the number of models, and for each model a row with its rmse (N)."""
        rows = tuple((fit.model.id, f"rmse {amount(fit.rmse, 'N')}") for fit in self.fits)
        return Facts(f"of {len(rows)} rows", rows)


@dataclass(frozen=True, repr=False)
class PenetrationAnalysis(Shown):
    """Results of the penetration experiments; arrays run over all m experiments, the table over the used ones.

    ``model`` is the campaign's model, ``hardness`` Eqn 1 of each definition by its symbol, ``seating_change`` its
    relative change without the depth zero, ``fitted`` the hardness from all readings of a series, ``growing`` one that
    grows with depth, ``unloading`` the estimates from readings while discs were taken off. ``table``,
    ``errors_in_depth``, ``volume_factor`` and ``selected`` are None where no experiment is used, ``selected`` also with
    too few series; ``warnings`` report this, and contain those of `fit_warnings`.
    """

    screened: Screened
    readings: Readings
    model: CampaignModel
    hardness: dict[str, Hardness]
    seating_change: FloatArray
    fitted: FittedHardness
    growing: GrowingHardness
    site_growth: tuple[SiteValue, ...]
    unloading: Unloading
    site_unloading: tuple[SiteUnloading, ...]
    table: ModelTable | None = None
    nested: tuple[NestedRows, ...] = ()
    selected: ModelFit | None = None
    errors_in_depth: ModelTable | None = None
    volume_factor: VolumeFactor | None = None
    warnings: tuple[str, ...] = ()

    def _repr_facts(self) -> Facts:
        return field_facts(self, {}, title=used_words(self.screened))


@dataclass(frozen=True, repr=False)
class ShearAnalysis(Shown):
    """Results of the shear experiments, over all experiments."""

    screened: Screened
    stress: ShearStress
    displacement: ShearDisplacement
    site_displacement: tuple[SiteValue, ...]

    def _repr_facts(self) -> Facts:
        return Facts(used_words(self.screened))


def used_words(screened: Screened) -> str:
    """Text such as "12 of 15 experiments used"."""
    return f"{int(screened.used.sum())} of {len(screened.used)} experiments used"


def seating_change(readings: Readings, offset: FloatArray) -> FloatArray:
    """V(e₇)/V(e₇ - δ) - 1: relative change of H_V of Eqn 1 when δ (m) is subtracted; NaN where no depth remains."""
    depth = readings.penetration_depth[readings.largest]
    left = depth - offset
    corrected = readings.volume_of_series(np.where(left > 0, left, 0.0))
    volume = readings.displaced_volume[readings.largest]
    return np.divide(volume, corrected, out=np.full(volume.shape, np.nan), where=(left > 0) & (corrected > 0)) - 1.0


TextArray = npt.NDArray[np.object_]


@dataclass(frozen=True, slots=True)
class SiteMean:
    """Mean of the n used experiments of one site (``quantity`` as a key of the results, in its unit).

    Sites share one of their ``letters`` where their pair is not shown to differ, after Holm's correction.
    """

    quantity: str
    site: str
    n: int
    own: CampaignMean
    letters: str = ""


def site_means(
    quantity: str, values: FloatArray, site: Sequence[str], *, geometric: bool, pairs: Sequence[GroupComparison] = ()
) -> tuple[SiteMean, ...]:
    """The mean of each site with its interval from the scatter between its experiments, in alphabetical order.

    ``pairs`` are the comparisons of the sites, for their letters.
    """
    names, site_of = index_names(site)
    means = [own_mean(values[site_of == index], [name] * int(np.sum(site_of == index)), geometric=geometric)
             for index, name in enumerate(names)]  # fmt: skip
    by_size = [names[index] for index in np.argsort([-mean.value for mean in means]).tolist()]
    letters = letters_of_groups(pairs, by_size) if len(names) > 1 else dict.fromkeys(names, "")
    return tuple(
        SiteMean(quantity, name, int(np.sum(site_of == index)), means[index], letters[name])
        for index, name in enumerate(names)
    )


def site_snow(
    campaign: Campaign,
    penetration: PenetrationAnalysis | None,
    shear: ShearAnalysis | None,
    site: str | None,
    unloading_ratio: float | None,
) -> SnowProperties:
    """Mean hardness and stress over a site's used experiments (None: all sites); rejects a site without hardness."""
    pressed = sheared = np.zeros(0), np.zeros(0, dtype=object)
    if penetration is not None and campaign.penetration is not None:
        used = penetration.screened.used
        pressed = _used(penetration.hardness["H_V"].value, used, campaign.penetration.site)
    if shear is not None and campaign.shear is not None:
        sheared = _used(shear.stress.value, shear.screened.used, campaign.shear.site)
    site = site_of_campaign(campaign, site)
    hardness, stress = (value if site is None else value[sites == site] for value, sites in (pressed, sheared))
    name = campaign.name
    if not hardness.size:
        sites = sorted({str(row) for row in pressed[1]})
        raise no_used_experiment(name, site, sites)
    source = f"{name}, {site_in_words(site)}: {hardness.size} penetration and {stress.size} shear experiments"
    snow = mean_snow(hardness / N_PER_MM3, stress / N_PER_MM2, source=source, where=name)
    turned = next((row for row in shear.site_displacement if row.site == site), None) if shear else None
    if turned is not None:
        snow = with_measured_displacement(snow, turned.value / MM, (turned.low / MM, turned.high / MM))
    if unloading_ratio is not None:
        return replace(snow, unloading_ratio=unloading_ratio)
    ratios = () if penetration is None else penetration.site_unloading
    ratio = next((row for row in ratios if row.site == site and row.is_resolved), None)
    return snow if ratio is None else with_measured_unloading(snow, ratio.ratio, (ratio.low, ratio.high))


def _used(value: FloatArray, used: BoolArray, site: tuple[str, ...]) -> tuple[FloatArray, TextArray]:
    """Values of the used experiments that have one, and the site of each."""
    there = used & np.isfinite(value)
    return value[there], np.array(site, dtype=object)[there]


def site_of_campaign(campaign: Campaign, site: str | None) -> str | None:
    """The campaign's own name of a site ("site C" for "C"); None or an unknown name is returned unchanged."""
    tables = (tests for tests in (campaign.penetration, campaign.shear) if tests is not None)
    return site_named(site, (name for tests in tables for name in tests.site))


def campaign_notes(campaign: Campaign) -> tuple[str, ...]:
    """Sentences about site names that nearly agree, snow data of sites without tests, and files that were not read."""
    unread = ", ".join(campaign.unread_files)
    note = Message("Not read, as no table of a campaign has this name: {listed}.", listed=unread)
    return (*_site_notes(campaign), *((note,) if unread else ()))


def _site_notes(campaign: Campaign) -> Iterator[str]:
    """Sentences about site names that differ only by capitals and spaces, then snow data of sites without any test."""
    tested = {site for tests in (campaign.penetration, campaign.shear) if tests is not None for site in tests.site}
    tables = {
        "density.csv": campaign.density,
        "drop_cone.csv": campaign.drop_cone,
        "snow_micro_pen.csv": campaign.snow_micro_pen,
    }
    sampled = {name: set(table.site) for name, table in tables.items() if table is not None}
    names: dict[str, set[str]] = {}
    for site in tested.union(*sampled.values()):
        names.setdefault("".join(site.split()).casefold(), set()).add(site)
    for variants in sorted(sorted(variants) for variants in names.values() if len(variants) > 1):
        listed = [repr(name) for name in variants]
        yield Message(
            "The names of the sites {listed} differ only by capitals or spaces; they count as different sites. Did "
            "you mean one site?",
            listed=listed,
        )
    for name, sites in sampled.items() if tested else ():  # without a test there are recordings or samples alone
        lost = sorted(sites - tested)
        if lost:
            listed = [repr(site) for site in lost]
            yield Message(
                "{name} describes {listed}, where no test was made: these rows are not included. Is a site misspelt?",
                name=name,
                listed=listed,
            )
