"""Snow pits of a campaign's sites."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from .._support.errors import ParameterError
from .._support.units import MM
from ..campaign.records import Campaign
from ..campaign.snow_micro_pen import SnowMicroPenProfile
from ..campaign.snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowPit
from ..estimation import Analysis
from ..estimation.regressions import HARDNESS_KEY, STRESS_KEY
from ..estimation.snow_micro_pen import EvaluatedRecording

BLOCK: Final = 1.0 * MM
"""Forces of a SnowMicroPen are given as means over it (modelling assumption): a pit holds hundreds, not thousands."""
_NO_DEPTH: Final = "{} without a depth are placed at the surface."
_NO_THICKNESS: Final = "The depth of densities without a thickness is that of the sample's middle."


def site_pit(analysis: Analysis, site: str) -> SnowPit:
    """Snow pit of a site of a campaign.

    Densities of experiments, those of density.csv without ``sample_depth_mm``, and the mean ``snow_temperature_C`` are
    put at the surface. The top of a sample is half its ``sample_thickness_mm`` above its middle; without a thickness
    the middle is given as its top. The comment states both. Forces are those of the used recordings of a SnowMicroPen,
    from the surface down.

    Raises ParameterError: the campaign has no such site; the message names those that it has.
    """
    campaign = analysis.campaign
    if site not in (sites := sites_of(campaign)):
        raise ParameterError("{name} has no site {site!r}; it has {sites}").tag(
            "no_data", name=campaign.name, site=site, sites=list(sites)
        )
    temperatures, air = (  # numbers, which the reader of the campaign has checked
        [float(cell.replace(",", ".")) for cell in _cells_of_site(campaign, site, f"{what}_temperature_C")]
        for what in ("snow", "air")
    )
    densities = tuple(_densities(campaign, site))
    profiles = tuple(_used_recordings(analysis, site))
    first = profiles[0][0] if profiles else None
    if not air and analysis.weather is not None:
        station = (means["air_temperature_C"] for name, _, means in analysis.weather.site_means() if name == site)
        air = [mean for mean in station if math.isfinite(mean)][:1]
    assumed = [_NO_DEPTH.format("Temperatures")] if temperatures else []
    assumed += [_NO_DEPTH.format("Densities")] if not all(layer.top or layer.thickness for layer in densities) else []
    assumed += [_NO_THICKNESS] if any(density.top and density.thickness is None for density in densities) else []
    return SnowPit(
        name=site,
        time=min((cell for cell in _cells_of_site(campaign, site, "time") if cell[:4].isdigit()), default=""),
        observer=", ".join(campaign.observers),
        comment=". ".join((campaign.name, " ".join(assumed))) if assumed else campaign.name,
        region=campaign.place,
        latitude_deg=None if first is None else first.latitude_deg,
        longitude_deg=None if first is None else first.longitude_deg,
        elevation=None if first is None else first.height,
        air_temperature_C=math.fsum(air) / len(air) if air else None,
        densities=densities,
        temperatures=(DepthTemperature(0.0, math.fsum(temperatures) / len(temperatures)),) if temperatures else (),
        forces=tuple(_mean_forces(profile, evaluated) for profile, evaluated in profiles),
        snow_hardness=_plate_value(analysis, HARDNESS_KEY, site),
        failure_shear_stress=_plate_value(analysis, STRESS_KEY, site),
    )


def sites_of(campaign: Campaign) -> tuple[str, ...]:
    """Every site that a table of the campaign names, in alphabetical order."""
    return tuple(sorted({name for table in _tables_with_sites(campaign) for name in table[0]}))


def _tables_with_sites(campaign: Campaign) -> Iterator[tuple[tuple[str, ...], Mapping[str, tuple[str, ...]]]]:
    """Site of each row, and further columns by name, of each table of the campaign."""
    if campaign.penetration is not None:
        tests = campaign.penetration
        yield tuple(tests.site[index] for index in tests.series_of_reading.tolist()), tests.further
    for table in (campaign.shear, campaign.density, campaign.drop_cone, campaign.snow_micro_pen):
        if table is not None:
            yield table.site, table.further


def _cells_of_site(campaign: Campaign, site: str, column: str) -> Iterator[str]:
    """Non-blank cells of a further column, in the rows of a site in all tables."""
    for sites, further in _tables_with_sites(campaign):
        for name, cell in zip(sites, further.get(column, ()), strict=False):
            if name == site and cell:
                yield cell


def _densities(campaign: Campaign, site: str) -> Iterator[LayerDensity]:
    """Used samples of density.csv, placed by their thickness if known; then the other densities of experiments."""
    sampled_densities: set[float] = set()
    if (table := campaign.density) is not None:
        columns = (table.sample_depth, table.sample_thickness, table.snow_density)
        rows = zip(table.site, table.cancelled, *(column.tolist() for column in columns), strict=True)
        for name, reason, depth, thickness, density in rows:
            if name == site and not reason:
                is_placed = math.isfinite(depth) and math.isfinite(thickness)
                top = max(depth - 0.5 * thickness, 0.0) if is_placed else np.nan_to_num(depth).item()
                sampled_densities.add(density)
                yield LayerDensity(top, density, thickness if is_placed else None)
    for tests in (campaign.penetration, campaign.shear):
        if tests is not None:
            for name, density, reason in zip(tests.site, tests.snow_density.tolist(), tests.cancelled, strict=True):
                if name == site and not reason and math.isfinite(density) and density not in sampled_densities:
                    sampled_densities.add(density)
                    yield LayerDensity(0.0, density)


def _used_recordings(analysis: Analysis, site: str) -> Iterator[tuple[SnowMicroPenProfile, EvaluatedRecording]]:
    """Profile and evaluation of each used recording at a site."""
    pen = analysis.snow_micro_pen
    if pen is not None:
        for index, evaluated in enumerate(pen.evaluated):
            if pen.recordings.site[index] == site and evaluated.is_used:
                yield pen.recordings.profile(index), evaluated


def _mean_forces(profile: SnowMicroPenProfile, evaluated: EvaluatedRecording) -> ForceProfile:
    """Mean forces (N) in blocks of equal length below the snow surface; pull counts as 0."""
    size = max(round(BLOCK / profile.sample_distance), 1)
    force = profile.force[round(evaluated.surface / profile.sample_distance) :]
    means = force[: len(force) // size * size].reshape(-1, size).mean(axis=1)
    depths = (profile.depth[: len(means) * size : size]) + 0.5 * size * profile.sample_distance
    return ForceProfile("SnowMicroPen", depths, means.clip(min=0.0))  # CAAML knows no pull


def _plate_value(analysis: Analysis, quantity: str, site: str) -> PlateValue | None:
    """Mean of a quantity at a site, with its interval if it is finite; None without a mean."""
    for row in analysis.site_means:
        if row.quantity == quantity and row.site == site and math.isfinite(row.own.value):
            ends = (row.own.low, row.own.high)
            return PlateValue(row.own.value, row.n, ends if all(map(math.isfinite, ends)) else None)
    return None
