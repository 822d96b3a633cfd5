"""Weather of a station from SMET, the ASCII format of MeteoIO and SNOWPACK (WSL Institute SLF), versions 0.9 to 1.2.

A header with place, time zone, fields and units precedes a row for each time. Values are SI: K, m/s, W/m², and 1 for
the relative humidity. ``units_offset`` and ``units_multiplier`` are applied, ``nodata`` becomes NaN. Since version 1.1
the multiplier comes first (value × multiplier + offset); before, the offset did ((value + offset) × multiplier).
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import MAXYEAR, MINYEAR, UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Annotated, Final, NoReturn

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import FieldDataError
from .._support.messages import Message
from .._support.spreadsheet_text import number
from .._support.units import Facts, Shown
from .._support.user_files.text_files import ContentError, plain_bytes
from ..parameters import Allowed, Declared, Quantity
from ..parameters.quantity import LARGEST
from .problems import error

MOST_BYTES: Final = 256 * 2**20
_NEEDED: Final = ("station_id", "nodata", "fields")
_READ: Final = (*_NEEDED, "station_name", "latitude", "longitude", "altitude", "tz", "units_offset", "units_multiplier")
_TIME: Final = "timestamp"
_COMMENT: Final = re.compile("[#;].*")
_VERSIONS: Final = ("0.9", "0.95", "0.99", "1.0", "1.1", "1.2")
_OFFSET_FIRST: Final = _VERSIONS[:4]
_ZONES: Final = (-14.0, 14.0)
"""Hours east of Greenwich that a clock may show."""
_CELSIUS: Final = Message("State units_offset = 273.15 if °C.")
_UNITS: Final = Message("State units_offset and units_multiplier.")
_PLAUSIBLE: Final = {
    **dict.fromkeys(("TA", "TD", "TSS", "TSG"), (180.0, math.inf, Message("a median above 180 K"), _CELSIUS)),
    "RH": (-0.05, 1.2, Message("a median from 0 to 1"), Message("State units_multiplier = 0.01 if %.")),
    "VW": (0.0, math.inf, Message("a median from 0 m/s"), _UNITS),
    "ISWR": (-50.0, math.inf, Message("a median from -50 W/m²"), _UNITS),
}
"""By field: limits of the median in SI, the allowed medians in words, and what is missing in the header."""
_GAPS: Final = (-999.0, -9999.0, -99999.0)
"""Numbers that loggers write for a missing value."""


@dataclass(frozen=True, slots=True, repr=False)
class StationSeries(Shown):
    """Readings of a weather station, in rising time.

    file, station: name of the file; ``station_name``, else ``station_id``.
    latitude_deg, longitude_deg, altitude: place of the station (degree, m); None if not in the header.
    utc_offset: offset of the file's times from UTC, hours east of Greenwich.
    time: (n,) seconds since 1970-01-01, UTC.
    fields: columns by their names in the file in capitals, in SI; NaN for missing values.
    """

    file: str
    station: str
    latitude_deg: float | None
    longitude_deg: float | None
    altitude: float | None
    utc_offset: float
    time: FloatArray = field(repr=False)
    fields: Mapping[str, FloatArray] = field(repr=False)

    def _repr_facts(self) -> Facts:
        """Station, number of rows, first and last time (UTC) and fields, for the representation."""
        ends = [
            datetime.fromtimestamp(seconds, UTC).strftime("%Y-%m-%d %H:%M") for seconds in self.time[[0, -1]].tolist()
        ]
        return Facts(f"{self.station!r}: {len(self.time)} rows, {ends[0]} to {ends[1]} UTC, {', '.join(self.fields)}")

    def at(self, moments: FloatArray, name: str, *, longest_gap: float) -> FloatArray:
        """A field at some times (s since 1970, UTC), linear between neighbours; NaN outside and over longer gaps."""
        values = self.fields.get(name, np.full(len(self.time), math.nan))
        finite = np.isfinite(values)
        time, values = self.time[finite], values[finite]
        if not len(time):
            return np.full(len(moments), math.nan)
        after = np.searchsorted(time, moments)
        low, high = np.clip(after - 1, 0, None), np.clip(after, None, len(time) - 1)
        exact = time[high] == moments
        inside = exact | ((after > 0) & (after < len(time)) & (time[high] - time[low] <= longest_gap))
        return np.where(inside, np.interp(moments, time, values), math.nan)


def read_smet(path: str | Path) -> StationSeries:
    """Read a SMET file in ASCII.

    Raises FieldDataError: the file cannot be read, is not SMET in ASCII, lacks a key of the header, or has an invalid
        row, time or number; the message names the line.
    """
    path = Path(path)
    try:
        data = plain_bytes(path, most_bytes=MOST_BYTES)
    except ContentError as failure:
        allowed, action = Message("a weather file in SMET"), Message("Check its name and folder.")
        problem = error("unreadable_file", path.name, value=failure.what, allowed=allowed, action=action)
        raise FieldDataError([problem]) from failure
    return parse_smet(path.name, data)


def parse_smet(name: str, data: bytes) -> StationSeries:
    """Parse the bytes of a SMET file; errors as `read_smet`."""
    return _Reading(name, data).series()


class _Reading:
    """Parser of one SMET file; each error is a FieldDataError that names the line."""

    def __init__(self, file: str, data: bytes) -> None:
        self._file = file
        try:
            text = data.decode("utf-16" if data.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        self._lines = text.splitlines()
        first = self._lines[0].split() if self._lines else []
        if len(first) < 3 or first[0] != "SMET" or first[2] != "ASCII":
            value = self._lines[0][:80] if self._lines else "nothing"
            action = Message("Export the station's data as SMET in ASCII.")
            self._refuse(1, "", value, Message("SMET, a version and ASCII"), action)
        if first[1] not in _VERSIONS:
            allowed = Message("a version among {versions}", versions=list(_VERSIONS))
            self._refuse(1, "", first[1], allowed, Message("Export it in one of these."))
        self._version = first[1]
        self._header, self._data = self._split()

    def _refuse(self, line: int, column: str, value: str, allowed: Message, action: Message) -> NoReturn:
        """Raise a FieldDataError with one problem at a line and, unless it is "", a column."""
        problem = error(
            "unreadable_file", self._file, row=line, column=column or None, value=value, allowed=allowed, action=action
        )
        raise FieldDataError([problem])

    def _split(self) -> tuple[dict[str, tuple[int, str]], int]:
        """Line and text of each key of the header, and the line of ``[DATA]``, below which the rows begin."""
        header: dict[str, tuple[int, str]] = {}
        for row, line in enumerate(self._lines, start=1):
            plain = _COMMENT.sub("", line).strip()
            if plain.upper() == "[DATA]":
                return header, row
            key, equals, value = plain.partition("=")
            key, value = key.strip().lower(), value.strip()
            if equals and key in _READ and header.get(key, (row, value))[1] != value:
                allowed = Message("{value} as in row {row}", value=header[key][1], row=header[key][0])
                self._refuse(row, key, value, allowed, Message("Remove one of them."))
            if equals:
                header[key] = (row, value)
        allowed, action = Message("a header and then [DATA]"), Message("The file is cut off; copy it again.")
        return self._refuse(len(self._lines), "", "no [DATA]", allowed, action)

    def series(self) -> StationSeries:
        """Station and readings in SI by field; rejects missing keys, other units and invalid rows."""
        for key in _NEEDED:
            if key not in self._header:
                allowed = Message("the key {key} in the header", key=key)
                self._refuse(self._data, key, "nothing", allowed, Message("Add it."))
        line, listed = self._header["fields"]
        names = [_TIME if name.lower() == _TIME else name.upper() for name in listed.split()]
        if _TIME not in names or len(set(names)) != len(names):
            allowed = Message("different names, {time} among them", time=_TIME)
            self._refuse(line, "fields", listed[:80], allowed, Message("Correct the header."))
        offset = self._number_of("tz", 0.0)
        low, high = _ZONES
        if not low <= offset <= high:
            row, text = self._header["tz"]
            allowed = Message("hours from {low:g} to {high:g}", low=low, high=high)
            self._refuse(row, "tz", text[:80], allowed, Message("Correct the time zone."))
        times, table = self._times_and_values(names, offset)
        nodata = self._number_of("nodata", -999.0)
        values = self._in_si(np.where(table == nodata, math.nan, table), names)
        self._require_no_gap(names, table, values)
        self._require_plausible(names, values)
        columns = {name: column for name, column in zip(names, values.T, strict=True) if name != _TIME}
        place = [self._number_of(key, math.nan) for key in ("latitude", "longitude", "altitude")]
        latitude, longitude, altitude = (None if math.isnan(number) or number == nodata else number for number in place)
        for key, value, largest in (("latitude", latitude, 90.0), ("longitude", longitude, 180.0)):
            if value is not None and abs(value) > largest:
                allowed = Message("degrees from {low:g} to {high:g}", low=-largest, high=largest)
                self._refuse(self._header[key][0], key, f"{value:g}", allowed, Message("Correct the place."))
        station = self._header.get("station_name", self._header["station_id"])[1]
        return StationSeries(self._file, station, latitude, longitude, altitude, offset, times, columns)

    def _in_si(self, table: FloatArray, names: Sequence[str]) -> FloatArray:
        """Table of the readings converted to SI by ``units_offset`` and ``units_multiplier`` of the header."""
        offsets = self._numbers_by_field("units_offset", 0.0, names)
        factors = self._numbers_by_field("units_multiplier", 1.0, names)
        with np.errstate(over="ignore", invalid="ignore"):
            offset_first = self._version in _OFFSET_FIRST
            values = (table + offsets) * factors if offset_first else table * factors + offsets
        huge = ~np.isnan(table) & ~(np.abs(values) <= LARGEST)
        if huge.any():
            name = names[int(np.argmax(huge.any(axis=0)))]
            allowed = Message("numbers to ±{largest:g} in SI", largest=LARGEST)
            action = Message("Correct units_offset, units_multiplier or the numbers.")
            self._refuse(self._header["fields"][0], name, "a larger number", allowed, action)
        return values

    def _require_plausible(self, names: Sequence[str], values: FloatArray) -> None:
        """Reject °C read as K and % read as shares, by the median, so that a few faulty values pass."""
        for name, column in zip(names, values.T, strict=True):
            valid = column[np.isfinite(column)]
            if name not in _PLAUSIBLE or not valid.size:
                continue
            low, high, allowed, action = _PLAUSIBLE[name]
            with np.errstate(over="ignore"):
                median = float(np.median(valid))
            if not low <= median <= high:
                line = self._header["fields"][0]
                self._refuse(line, name, f"median {median:g}", allowed, action)

    def _require_no_gap(self, names: Sequence[str], table: FloatArray, values: FloatArray) -> None:
        """Reject numbers that loggers write for missing values, such as -999, if the header states another one."""
        for name, raw, column in zip(names, table.T, values.T, strict=True):
            gaps = raw[np.isin(raw, _GAPS) & (column < _PLAUSIBLE[name][0])] if name in _PLAUSIBLE else raw[:0]
            if gaps.size:
                line, text = self._header["nodata"]
                allowed = Message("{number} for missing values", number=text)
                action = Message("State nodata = {gap}.", gap=f"{gaps[0]:g}")
                self._refuse(line, name, f"{gaps[0]:g}", allowed, action)

    def _number_of(self, key: str, default: float) -> float:
        """Number of a key of the header, or `default` if the key is missing."""
        if key not in self._header:
            return default
        line, text = self._header[key]
        return self._number(line, key, text)

    def _number(self, line: int, column: str, text: str) -> float:
        """Number of a text; rejects what is not a finite number."""
        value = number(text)
        if math.isnan(value):
            self._refuse(line, column, text[:80], Message("a finite number"), Message("Correct the number."))
        return value

    def _numbers_by_field(self, key: str, default: float, names: Sequence[str]) -> list[float]:
        """Numbers of a header's key, one for each field; `default` for all if the key is missing."""
        if key not in self._header:
            return [default] * len(names)
        line, text = self._header[key]
        numbers = [self._number(line, key, part) for part in text.split()]
        if len(numbers) != len(names):
            allowed = Message("{count}, one for each field", count=len(names))
            self._refuse(line, key, f"{len(numbers)} numbers", allowed, Message("Correct the header."))
        return numbers

    def _times_and_values(self, names: Sequence[str], offset: float) -> tuple[FloatArray, FloatArray]:
        """Times (s since 1970) and values (rows, fields); rejects unsorted times and a file without rows."""
        zone, place = timezone(timedelta(hours=offset)), names.index(_TIME)
        times: list[float] = []
        table: list[list[float]] = []
        for row, line in enumerate(self._lines[self._data :], start=self._data + 1):
            cells = _COMMENT.sub("", line).split()
            if not cells:
                continue
            if len(cells) != len(names):
                allowed = Message("{count}, one for each field", count=len(names))
                self._refuse(row, "", f"{len(cells)} cells", allowed, Message("Correct the row."))
            moment = self._moment(row, cells[place], zone)
            if times and moment <= times[-1]:
                allowed = Message("a later time than the row before")
                self._refuse(row, _TIME, cells[place], allowed, Message("Sort the rows."))
            times.append(moment)
            cells[place] = "0"
            table.append([self._number(row, name, cell) for name, cell in zip(names, cells, strict=True)])
        if not times:
            allowed = Message("at least one row below [DATA]")
            self._refuse(self._data, "", "no row", allowed, Message("Export the station's data again."))
        return np.array(times), np.array(table)

    def _moment(self, line: int, text: str, zone: timezone) -> float:
        """Seconds since 1970 of an ISO time, in `zone` if it states none; rejects other texts and years."""
        try:
            time = datetime.fromisoformat(text)
            moment = (time if time.tzinfo else time.replace(tzinfo=zone)).astimezone(UTC)
        except (ValueError, OverflowError):
            allowed = Message("a time such as 2026-02-03T09:10")
            self._refuse(line, _TIME, text[:80], allowed, Message("Correct the time."))
        if not MINYEAR < moment.year < MAXYEAR:  # so that each zone has this time
            allowed = Message("a year between {first} and {last}", first=MINYEAR, last=MAXYEAR)
            self._refuse(line, _TIME, text[:80], allowed, Message("Correct the time."))
        return moment.timestamp()


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class WeatherSettings(Declared):
    """The section ``[weather]`` of campaign.toml."""

    file: Annotated[
        str | None, Quantity("file", "name of a SMET file in the campaign's folder; default: no weather")
    ] = None
    utc_offset_h: Annotated[
        float | None,
        Quantity(
            "utc_offset_h",
            "hours that the clock of the column `time` is ahead of UTC, where a time does not say it; default: as in "
            "the station's file",
        ),
        Allowed(-14.0, 14.0),
    ] = None
    longest_gap_h: Annotated[
        float,
        Quantity("longest_gap_h", "between readings of the station that are farther apart nothing is interpolated"),
        Allowed(0.0),
    ] = 3.0


@dataclass(frozen=True, slots=True, repr=False)
class CampaignWeather(Shown):
    """Readings of a station, and the campaign's settings for them."""

    series: StationSeries
    settings: WeatherSettings

    def _repr_facts(self) -> Facts:
        """Title of the station's series, for the representation."""
        return self.series._repr_facts()

    @property
    def utc_offset(self) -> float:
        """Offset of the campaign's times from UTC (h)."""
        offset = self.settings.utc_offset_h
        return self.series.utc_offset if offset is None else offset
