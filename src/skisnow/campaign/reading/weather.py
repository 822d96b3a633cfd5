"""The weather file that campaign.toml names: it lies beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..._support.errors import FieldDataError
from ..problems import error
from ..smet import smet_series
from ..weather_records import CampaignWeather
from .campaign_file import CAMPAIGN_FILE

if TYPE_CHECKING:
    from ..weather_records import WeatherSettings
    from .raw_files import RawFiles

ENDING: Final = ".smet"


def campaign_weather(settings: WeatherSettings, files: RawFiles) -> CampaignWeather | None:
    """Read the station's file; None where none is named, or where it cannot be read, which is reported."""
    name = settings.file
    if not name:
        return None
    if "/" in name or "\\" in name or not name.lower().endswith(ENDING):
        _refuse(files, name, "the name of a .smet file in the campaign's folder")
        return None
    before = len(files.found)
    data = files.read(name)
    if data is None:
        if len(files.found) == before:
            _refuse(files, name, "a file of this name in the campaign's folder")
        return None
    try:
        return CampaignWeather(smet_series(name, data), settings)
    except FieldDataError as failure:
        files.found.extend(failure.problems)  # type: ignore[arg-type]
        return None


def _refuse(files: RawFiles, name: str, allowed: str) -> None:
    action = "Lay the file beside campaign.toml, or correct its name."
    files.found.append(
        error("unreadable_file", CAMPAIGN_FILE, column="weather.file", value=name, allowed=allowed, action=action)
    )
