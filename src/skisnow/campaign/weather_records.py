"""Weather of a station as a record of a campaign, and how it is taken over."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from .._support.display import Facts, Shown
from ..parameters import Quantity, require_declared
from .smet import StationSeries


@dataclass(frozen=True, slots=True, kw_only=True)
class WeatherSettings:
    """The section ``[weather]`` of campaign.toml."""

    file: Annotated[
        str | None, Quantity("file", "name of a SMET file in the campaign's folder; left out: no weather")
    ] = None
    utc_offset_h: Annotated[
        float | None,
        Quantity(
            "utc_offset_h",
            "hours that the clock of the column `time` is ahead of UTC, where a time does not say it; left out: as in "
            "the station's file",
            lowest=-14.0,
            highest=14.0,
        ),
    ] = None
    longest_gap_h: Annotated[
        float,
        Quantity(
            "longest_gap_h",
            "between readings of the station that are farther apart nothing is interpolated",
            lowest=0.0,
        ),
    ] = 3.0

    def __post_init__(self) -> None:
        require_declared(self)


@dataclass(frozen=True, slots=True, repr=False)
class CampaignWeather(Shown):
    """What a station measured, and how the campaign takes it."""

    series: StationSeries
    settings: WeatherSettings

    def _facts(self) -> Facts:
        return self.series._facts()

    @property
    def utc_offset(self) -> float:
        """Of the campaign's times (h)."""
        offset = self.settings.utc_offset_h
        return self.series.utc_offset if offset is None else offset
