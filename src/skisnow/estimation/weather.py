"""Weather at the time of each experiment, from the readings of a station."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta, timezone
from typing import Any, Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray, index_names
from .._support.units import HOUR, PERCENT, ZERO_CELSIUS, Facts, Shown
from ..campaign.records import Campaign
from ..campaign.smet import CampaignWeather

QUANTITIES: Final = {
    "air_temperature_C": ("TA", 1.0, -ZERO_CELSIUS),
    "relative_humidity_percent": ("RH", 1.0 / PERCENT, 0.0),
    "snow_surface_temperature_C": ("TSS", 1.0, -ZERO_CELSIUS),
    "wind_speed_m_per_s": ("VW", 1.0, 0.0),
    "incoming_short_wave_W_per_m2": ("ISWR", 1.0, 0.0),
}
"""What is taken of a station: its name in SMET, and factor and offset from SI."""
Json: TypeAlias = dict[str, Any]


@dataclass(frozen=True, slots=True, repr=False)
class WeatherAtTests(Shown):
    """The weather at m experiments, in the order of the files, penetration before shear; NaN where it is not known.

    ``time`` is that of each experiment as its file has it; ``quantities`` have the units of their names.
    """

    kind: tuple[str, ...]
    experiment: tuple[str, ...]
    site: tuple[str, ...]
    time: tuple[str, ...]
    quantities: Mapping[str, FloatArray]

    def _repr_facts(self) -> Facts:
        count = int(np.isfinite(np.stack(list(self.quantities.values()))).any(axis=0).sum())
        return Facts(f"at {count} of {len(self.experiment)} experiments")

    def site_means(self) -> Iterator[tuple[str, int, dict[str, float]]]:
        """Each site with the number of its experiments with known weather, and their means."""
        names, site_of = index_names(self.site)
        for index, name in enumerate(names):
            mine = {key: values[site_of == index] for key, values in self.quantities.items()}
            finite = {key: values[np.isfinite(values)] for key, values in mine.items()}
            means = {key: float(values.mean()) if len(values) else math.nan for key, values in finite.items()}
            yield name, max(map(len, finite.values())), means


def weather_at_tests(campaign: Campaign) -> WeatherAtTests | None:
    """Interpolate the station's readings to the time of each experiment; None where the campaign has no weather.

    An experiment has weather if the column ``time`` of one of its rows contains a day and a time of day.

    Source: The page docs/files/campaign.md.
    """
    weather = campaign.weather
    if weather is None:
        return None
    rows = list(_experiments(campaign))
    moments = np.array([_moment(time, weather.utc_offset) for *_, time in rows], dtype=float)
    gap = weather.settings.longest_gap_h * HOUR
    quantities = {
        key: weather.series.at(moments, name, longest_gap=gap) * factor + offset
        for key, (name, factor, offset) in QUANTITIES.items()
    }
    kinds, experiments, sites, times = (tuple(column) for column in zip(*rows, strict=True)) if rows else ((),) * 4
    return WeatherAtTests(kinds, experiments, sites, times, quantities)


def _experiments(campaign: Campaign) -> Iterator[tuple[str, str, str, str]]:
    """Kind, name, site and time of each experiment."""
    if campaign.penetration is not None:
        tests = campaign.penetration
        cells = tests.further.get("time", ("",) * len(tests.load))
        for index, (experiment, site) in enumerate(zip(tests.experiment, tests.site, strict=True)):
            own = cells[int(tests.first[index]) : int(tests.first[index + 1])]
            yield "penetration", experiment, site, next(filter(None, own), "")
    if campaign.shear is not None:
        sheared = campaign.shear
        cells = sheared.further.get("time", ("",) * len(sheared))
        yield from zip(("shear",) * len(sheared), sheared.experiment, sheared.site, cells, strict=True)


def _moment(text: str, utc_offset: float) -> float:
    """Seconds since 1970, UTC; NaN unless the text is a day with a time of day."""
    if "T" not in text and " " not in text:
        return math.nan
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        return math.nan
    zone = timezone(timedelta(hours=utc_offset))
    return (moment if moment.tzinfo else moment.replace(tzinfo=zone)).timestamp()


def weather_results(weather: CampaignWeather, at_tests: WeatherAtTests) -> Json:
    """The station, a row for each experiment and one for each site; NaN for unknown values."""
    series = weather.series
    names = {"kind": at_tests.kind, "experiment": at_tests.experiment, "site": at_tests.site, "time": at_tests.time}
    columns = names | {key: tuple(values.tolist()) for key, values in at_tests.quantities.items()}
    rows = [dict(zip(columns, cells, strict=True)) for cells in zip(*columns.values(), strict=True)]
    return {
        "file": series.file,
        "station": series.station,
        "latitude_deg": series.latitude_deg,
        "longitude_deg": series.longitude_deg,
        "altitude_m": series.altitude,
        "utc_offset_h": weather.utc_offset,
        "longest_gap_h": weather.settings.longest_gap_h,
        "experiments": rows,
        "sites": [{"site": site, "n": n, **means} for site, n, means in at_tests.site_means()],
    }
