"""The section ``weather`` of results.json."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from ..campaign.weather_records import CampaignWeather
    from .weather import WeatherAtTests

Json: TypeAlias = dict[str, Any]


def weather_results(weather: CampaignWeather, found: WeatherAtTests) -> Json:
    """The station, a row for each experiment and one for each site; NaN stands where nothing is known."""
    series = weather.series
    columns = {"kind": found.kind, "experiment": found.experiment, "site": found.site, "time": found.time}
    rows = [dict(zip(columns, cells, strict=True)) for cells in zip(*columns.values(), strict=True)]
    for key, values in found.quantities.items():
        for row, value in zip(rows, values.tolist(), strict=True):
            row[key] = value
    return {
        "file": series.file,
        "station": series.station,
        "latitude_deg": series.latitude_deg,
        "longitude_deg": series.longitude_deg,
        "altitude_m": series.altitude,
        "utc_offset_h": weather.utc_offset,
        "longest_gap_h": weather.settings.longest_gap_h,
        "experiments": rows,
        "sites": [{"site": site, "n": n, **means} for site, n, means in found.site_means()],
    }
