"""The recordings that snow_micro_pen.csv names: their files lie beside it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from ..._support.errors import FieldDataError
from ..._support.units import MM
from ..problems import error
from ..smet import CampaignWeather, smet_series
from ..snow_micro_pen import snow_micro_pen_profile
from ..snow_micro_pen_records import SnowMicroPenRecordings
from .campaign_file import CAMPAIGN_FILE
from .table_forms import SNOW_MICRO_PEN

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..problems import Problem
    from ..smet import WeatherSettings
    from ..snow_micro_pen_records import SnowMicroPenSettings
    from .campaign_files import RawFiles
    from .columns import Table

ENDING: Final = ".pnt"


def recording_contents(table: Table | None, files: RawFiles) -> dict[str, bytes]:
    """Read and check every file that the table names; what is wrong is reported with the row that names it."""
    found: dict[str, bytes] = {}
    if table is None or table.absent:
        return found
    for name in (SNOW_MICRO_PEN.key, "file"):
        files.found.extend(_twice(table, name))
    for row, name in enumerate(table.names["file"].cells()):
        if name and name not in found:
            data = _content(table, row, name, files)
            if data is not None:
                found[name] = data
    return found


def _content(table: Table, row: int, name: str, files: RawFiles) -> bytes | None:
    if "/" in name or "\\" in name or not name.lower().endswith(ENDING):
        action = "Write the file's name alone, and lay the file beside the tables."
        allowed = "the name of a .PNT file in the campaign's folder"
        files.found.append(_refusal(table, row, "file", "unreadable_file", allowed, action))
        return None
    before = len(files.found)
    data = files.read(name)
    if data is None and len(files.found) == before:
        action = "Lay the file beside the tables, correct its name, or take the row out."
        allowed = "a file of this name in the campaign's folder"
        files.found.append(_refusal(table, row, "file", "unreadable_file", allowed, action))
    if data is None:
        return None
    try:
        snow_micro_pen_profile(name, data)
    except FieldDataError as failure:
        problems: list[Problem] = failure.problems  # type: ignore[assignment]
        recording = table.names[SNOW_MICRO_PEN.key][row]
        files.found.extend(replace(problem, experiment=recording) for problem in problems)
        return None
    return data


def _twice(table: Table, column: str) -> list[Problem]:
    """A recording or a file that an earlier row names, too: it would count again."""
    first: dict[str, int] = {}
    found = []
    for row, name in enumerate(table.names[column].cells()):
        reference = first.setdefault(name, row)
        if name and reference != row:
            allowed = f"each {column} once; row {int(table.row[reference])} has it, too"
            action = "Correct the cell, or take one of the rows out."
            found.append(_refusal(table, row, column, "mixed_experiment", allowed, action))
    return found


def _refusal(table: Table, row: int, column: str, code: str, allowed: str, action: str) -> Problem:
    return error(
        code,
        SNOW_MICRO_PEN.file,
        row=int(table.row[row]),
        column=column,
        experiment=table.names[SNOW_MICRO_PEN.key][row] or None,
        value=table.names[column][row],
        allowed=allowed,
        action=action,
    )


def snow_micro_pen_recordings(
    table: Table, contents: Mapping[str, bytes], settings: SnowMicroPenSettings
) -> SnowMicroPenRecordings:
    """Make the recordings of a table without an error."""
    file = table.names["file"].cells()
    return SnowMicroPenRecordings(
        recording=table.names["recording"].cells(),
        site=table.names["site"].cells(),
        spot=table.names["spot"].cells(),
        file=file,
        surface=table.numbers["surface_mm"] * MM,
        cancelled=table.names["status"].cells(),
        row=table.row,
        contents=tuple(contents[name] for name in file),
        settings=settings,
        further=table.further,
    )


WEATHER_ENDING: Final = ".smet"


def campaign_weather(settings: WeatherSettings, files: RawFiles) -> CampaignWeather | None:
    """Read the station's file; None where none is named, or where it cannot be read, which is reported."""
    name = settings.file
    if not name:
        return None
    if "/" in name or "\\" in name or not name.lower().endswith(WEATHER_ENDING):
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
