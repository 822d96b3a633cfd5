"""A site of an analysed campaign as a snow pit, which other people's formats know."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.units import MM
from ..campaign.snow_pit import DepthTemperature, ForceProfile, LayerDensity, PlateValue, SnowPit
from ..estimation.observations import HARDNESS_KEY, STRESS_KEY

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..campaign.records import Campaign, DensitySamples, PenetrationTests, ShearTests
    from ..campaign.snow_micro_pen import SnowMicroPenProfile
    from ..estimation import Analysis
    from ..estimation.snow_micro_pen import EvaluatedRecording

BLOCK: Final = 1.0 * MM
"""Forces of a SnowMicroPen are given as means over it (modelling assumption): a pit holds hundreds, not thousands."""
_NO_DEPTH: Final = "Densities and temperatures were noted without a depth and stand at the surface."


def site_pit(analysis: Analysis, site: str) -> SnowPit:
    """Snow pit of a site of a campaign.

    Densities of density.csv and beside experiments, and the mean ``snow_temperature_C``, have no depth in a campaign
    and are put at the surface, which the comment says. Forces are those of the used recordings of a SnowMicroPen, from
    the surface on.

    Raises
    ------
    ParameterError
        The campaign has no such site; the message names those that it has.
    """
    campaign = analysis.campaign
    sites = {name for table in _tables(campaign) for name in table[0]}
    if site not in sites:
        raise ParameterError(
            Message("{name} has no site {site!r}; it has {sites}", name=campaign.name, site=site, sites=sorted(sites)),
            code="no_data",
        )
    temperatures, air = _notes(campaign, site, "snow_temperature_C"), _notes(campaign, site, "air_temperature_C")
    densities = tuple(_densities(campaign, site))
    profiles = tuple(_recordings(analysis, site))
    first = profiles[0][0] if profiles else None
    return SnowPit(
        name=site,
        time=min(_times(campaign, site), default=""),
        observer=", ".join(campaign.observers),
        comment=f"{campaign.name}. {_NO_DEPTH}" if densities or temperatures else campaign.name,
        region=campaign.place,
        latitude_deg=None if first is None else first.latitude_deg,
        longitude_deg=None if first is None else first.longitude_deg,
        elevation=None if first is None else first.height,
        air_temperature_C=math.fsum(air) / len(air) if air else _station_air(analysis, site),
        densities=densities,
        temperatures=(DepthTemperature(0.0, math.fsum(temperatures) / len(temperatures)),) if temperatures else (),
        forces=tuple(_forces(profile, evaluated) for profile, evaluated in profiles),
        snow_hardness=_plate_value(analysis, HARDNESS_KEY, site),
        failure_shear_stress=_plate_value(analysis, STRESS_KEY, site),
    )


def sites_of(campaign: Campaign) -> tuple[str, ...]:
    """Every site that a table of the campaign names, in alphabetical order."""
    return tuple(sorted({name for table in _tables(campaign) for name in table[0]}))


def _tables(campaign: Campaign) -> Iterator[tuple[tuple[str, ...], Mapping[str, tuple[str, ...]]]]:
    """Site and further columns of each row of each table."""
    if campaign.penetration is not None:
        tests = campaign.penetration
        yield tuple(tests.site[index] for index in tests.series_of_reading.tolist()), tests.further
    for table in (campaign.shear, campaign.density, campaign.drop_cone, campaign.snow_micro_pen):
        if table is not None:
            yield table.site, table.further


def _cells(campaign: Campaign, site: str, column: str) -> Iterator[str]:
    for sites, further in _tables(campaign):
        for name, cell in zip(sites, further.get(column, ()), strict=False):
            if name == site and cell:
                yield cell


def _station_air(analysis: Analysis, site: str) -> float | None:
    """Mean at the site's experiments by the weather station; None where it is not known."""
    found = () if analysis.weather is None else analysis.weather.site_means()
    mean = next((means["air_temperature_C"] for name, _, means in found if name == site), math.nan)
    return mean if math.isfinite(mean) else None


def _notes(campaign: Campaign, site: str, column: str) -> list[float]:
    """Numbers of a column that is kept as text; each was checked when it was read."""
    return [float(cell.replace(",", ".")) for cell in _cells(campaign, site, column)]


def _times(campaign: Campaign, site: str) -> list[str]:
    return [cell for cell in _cells(campaign, site, "time") if cell[:4].isdigit()]


def _densities(campaign: Campaign, site: str) -> Iterator[LayerDensity]:
    """Every sample of density.csv; then densities beside experiments that are not one of them, each once."""
    tables = campaign.density, campaign.penetration, campaign.shear
    sampled, *beside = ([] if table is None else list(_densities_of(table, site)) for table in tables)
    others = {density: None for densities in beside for density in densities if density not in sampled}
    for density in (*sampled, *others):
        yield LayerDensity(0.0, density)


def _densities_of(table: DensitySamples | PenetrationTests | ShearTests, site: str) -> Iterator[float]:
    for name, density, reason in zip(table.site, table.snow_density.tolist(), table.cancelled, strict=True):
        if name == site and not reason and math.isfinite(density):
            yield density


def _recordings(analysis: Analysis, site: str) -> Iterator[tuple[SnowMicroPenProfile, EvaluatedRecording]]:
    pen = analysis.snow_micro_pen
    if pen is not None:
        for index, evaluated in enumerate(pen.evaluated):
            if pen.recordings.site[index] == site and evaluated.is_used:
                yield pen.recordings.profile(index), evaluated


def _forces(profile: SnowMicroPenProfile, evaluated: EvaluatedRecording) -> ForceProfile:
    size = max(round(BLOCK / profile.sample_distance), 1)
    force = profile.force[round(evaluated.surface / profile.sample_distance) :]
    means = force[: len(force) // size * size].reshape(-1, size).mean(axis=1)
    depths = (profile.depth[: len(means) * size : size]) + 0.5 * size * profile.sample_distance
    return ForceProfile("SnowMicroPen", depths, means.clip(min=0.0))  # CAAML knows no pull


def _plate_value(analysis: Analysis, quantity: str, site: str) -> PlateValue | None:
    for row in analysis.site_means:
        if row.quantity == quantity and row.site == site and math.isfinite(row.own.value):
            ends = (row.own.low, row.own.high)
            return PlateValue(row.own.value, row.n, ends if all(map(math.isfinite, ends)) else None)
    return None
