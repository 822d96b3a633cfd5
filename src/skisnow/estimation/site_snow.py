"""The snow of one site of an analysed campaign, or of all of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError
from .._support.units import MM, N_PER_MM2, N_PER_MM3
from ..snow import SnowProperties
from ..snow.mean_snow import (
    known_sites,
    mean_snow,
    site_in_words,
    site_named,
    with_measured_displacement,
    with_measured_unloading,
)

if TYPE_CHECKING:
    from ..campaign.records import Campaign
    from .parts import PenetrationAnalysis, ShearAnalysis

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
TextArray = npt.NDArray[np.object_]


def site_snow(
    campaign: Campaign,
    penetration: PenetrationAnalysis | None,
    shear: ShearAnalysis | None,
    site: str | None,
    unloading_ratio: float | None,
) -> SnowProperties:
    """The means over the used experiments of a site, as `skisnow.snow_from_results` reads them from results.json."""
    pressed, sheared = _pressed(penetration, campaign), _sheared(shear, campaign)
    site = site_of_campaign(campaign, site)
    hardness, stress = (_of(site, *known) for known in (pressed, sheared))
    name = campaign.name
    if not hardness.size:
        sites = sorted({str(each) for each in pressed[1]})
        raise ParameterError(f"{name} has no used penetration experiment{known_sites(site, sites)}")
    source = f"{name}, {site_in_words(site)}: {hardness.size} penetration and {stress.size} shear experiments"
    snow = mean_snow(hardness / N_PER_MM3, stress / N_PER_MM2, source=source, where=name)
    turned = next((each for each in shear.site_displacement if each.site == site), None) if shear else None
    if turned is not None:
        snow = with_measured_displacement(snow, turned.value / MM, (turned.low / MM, turned.high / MM))
    if unloading_ratio is not None:
        return replace(snow, unloading_ratio=unloading_ratio)
    found = () if penetration is None else penetration.site_unloading
    ratio = next((each for each in found if each.site == site and each.is_resolved), None)
    return snow if ratio is None else with_measured_unloading(snow, ratio.ratio, (ratio.low, ratio.high))


def _pressed(found: PenetrationAnalysis | None, campaign: Campaign) -> tuple[FloatArray, TextArray]:
    """H_V (N/m³) and site of each used penetration experiment that has one."""
    tests = campaign.penetration
    if found is None or tests is None:
        return np.zeros(0), np.zeros(0, dtype=object)
    return _used(found.hardness["H_V"].value, found.screened.used, tests.site)


def _sheared(found: ShearAnalysis | None, campaign: Campaign) -> tuple[FloatArray, TextArray]:
    """S_f (N/m²) and site of each used shear experiment that has one."""
    tests = campaign.shear
    if found is None or tests is None:
        return np.zeros(0), np.zeros(0, dtype=object)
    return _used(found.stress.value, found.screened.used, tests.site)


def _used(value: FloatArray, used: BoolArray, site: tuple[str, ...]) -> tuple[FloatArray, TextArray]:
    there = used & np.isfinite(value)
    return value[there], np.array(site, dtype=object)[there]


def _of(site: str | None, value: FloatArray, sites: TextArray) -> FloatArray:
    return value if site is None else value[sites == site]


def site_of_campaign(campaign: Campaign, site: str | None) -> str | None:
    """The campaign's own name of a site, see `skisnow.snow.mean_snow.site_named`."""
    tables = (tests for tests in (campaign.penetration, campaign.shear) if tests is not None)
    return site_named(site, (name for tests in tables for name in tests.site))
