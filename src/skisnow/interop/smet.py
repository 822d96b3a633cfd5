"""Weather of a station to SMET 1.1 in SI, and to CSV."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Final

from .._support.errors import ParameterError
from .._support.staging import write_file
from ..campaign.smet import StationSeries
from ..estimation.weather import QUANTITIES

NO_DATA: Final = -999.0


def write_smet(series: StationSeries, path: str | Path) -> Path:
    """Write all fields in SI, with the times in the file's own time zone.

    Raises ParameterError: a value is exactly -999, which means none.
    Raises OutputError: the file cannot be written.
    """
    write_file(path, smet_text(series))
    return Path(path)


def write_weather_csv(series: StationSeries, path: str | Path) -> Path:
    """Write the station's columns that a campaign uses: time with its zone, temperatures in °C, humidity in percent.

    Raises ParameterError: the station has no such quantity.
    Raises OutputError: the file cannot be written.
    """
    available = {key: made for key, made in QUANTITIES.items() if made[0] in series.fields}
    if not available:
        wanted = ", ".join(name for name, *_ in QUANTITIES.values())
        raise ParameterError(
            "{file} has no field of {wanted}; nothing was written", code="no_data", file=series.file, wanted=wanted
        )
    columns = [(series.fields[name] * factor + offset).tolist() for name, factor, offset in available.values()]
    rows = (
        ",".join((when, *("" if math.isnan(value) else f"{value:.10g}" for value in values)))
        for when, *values in zip(_times(series, zone=True), *columns, strict=True)
    )
    write_file(path, "\n".join((",".join(("time", *available)), *rows)) + "\n")
    return Path(path)


def smet_text(series: StationSeries) -> str:
    """Content of an SMET 1.1 file with all fields in SI."""
    return "\n".join(_smet(series)) + "\n"


def _smet(series: StationSeries) -> Iterator[str]:
    place = {
        "latitude": series.latitude_deg,
        "longitude": series.longitude_deg,
        "altitude": series.altitude,
    }
    yield "SMET 1.1 ASCII"
    yield "[HEADER]"
    name = re.sub("[#;]", " ", series.station)  # these begin a comment
    yield f"station_id = {''.join(name.split()) or 'station'}"
    yield f"station_name = {name}"
    yield from (f"{key} = {NO_DATA if value is None else value:.10g}" for key, value in place.items())
    yield f"nodata = {NO_DATA:g}"
    yield f"tz = {series.utc_offset:g}"
    yield f"fields = {' '.join(('timestamp', *series.fields))}"
    yield "[DATA]"
    columns = [column.tolist() for column in series.fields.values()]
    for when, *values in zip(_times(series, zone=False), *columns, strict=True):
        if NO_DATA in values:
            raise ParameterError(
                "{file} has a value of {no_data:g} at {when}, which means a missing value in SMET",
                code="out_of_range",
                file=series.file,
                no_data=NO_DATA,
                when=when,
            )
        yield " ".join((when, *(f"{NO_DATA if math.isnan(value) else value:.10g}" for value in values)))


def _times(series: StationSeries, *, zone: bool) -> Iterator[str]:
    own = timezone(timedelta(hours=series.utc_offset))
    for seconds in series.time.tolist():
        moment = datetime.fromtimestamp(seconds, UTC).astimezone(own)
        yield (moment if zone else moment.replace(tzinfo=None)).isoformat()
