"""Tracks in CSV with one row for each point, in local metres or in latitude and longitude."""

from __future__ import annotations

import dataclasses
import difflib
import itertools
import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final

import numpy as np

from ..._support.arrays import BoolArray, FloatArray
from ..._support.messages import Message, joined
from ..._support.spreadsheet_text import number
from .recording import FARTHEST, Recording, is_not_finite, track_error
from .text import Cells, convert_serial_dates, decimal_mark_of, moment, require_width, split_cells

TIMES: Final = ("time_s", "time")
LOCAL: Final = ("x_m", "y_m", "z_m")
GEODETIC: Final = ("lat", "lon", "alt_m")
SPEEDS: Final = ("speed_m_per_s", "speed_mps")
ODOMETER: Final = "dist_m"
LOCAL_SD: Final = ("x_sd_m", "y_sd_m", "z_sd_m")
GEODETIC_SD: Final = ("east_sd_m", "north_sd_m", "up_sd_m")
SPEED_SD: Final = "speed_sd_m_per_s"
COLUMNS: Final = (*TIMES, *LOCAL, *GEODETIC, *SPEEDS, ODOMETER, *LOCAL_SD, *GEODETIC_SD, SPEED_SD)
"""Every column that is read."""
_IN_EVERY_ROW: Final = Message("in every row")
_FORMS: Final = "time_s, x_m, y_m[, z_m, speed_m_per_s] or time, lat, lon[, alt_m, speed_mps]"


def read_table(text: str, name: str) -> Recording:
    """The recording in a CSV file.

    Raises FieldDataError: a column is missing or repeated, a cell is not a number or a time, or a row has more cells
        than the header.
    """
    table = _Table.of(split_cells(text, name), name)
    is_geodetic = table.kind()
    table.require_rows()
    time, start, note = table.time()
    first_time = 0.0 if start is not None else float(time[0])
    place = table.vectors(GEODETIC if is_geodetic else LOCAL)
    speeds = [column for column in SPEEDS if column in table.header]
    sd = GEODETIC_SD if is_geodetic else LOCAL_SD
    return Recording(
        name=name,
        places_in_file=[f"row {line}" for line in table.cells.lines],
        time=time,
        place=place,
        is_geodetic=is_geodetic,
        time_scale="local" if start is None or start.tzinfo is None else "UTC",
        start=start,
        first_time=first_time,
        speed=table.numbers(speeds[0]) if speeds else None,
        speed_kind="as the device gives it" if is_geodetic else "along the path",
        place_sd=table.vectors(sd) if any(column in table.header for column in sd) else None,
        speed_sd=table.optional(SPEED_SD),
        odometer=table.optional(ODOMETER),
        further_columns=tuple(column for column in table.header if column not in table.used),
        columns=dict(zip("xyz", GEODETIC if is_geodetic else LOCAL, strict=True)),
        not_finite=table.not_finite,
        notes=() if note is None else (note,),
    )


@dataclass(eq=False)
class _Table:
    """Cells with the file's name and decimal mark, the columns used so far, and the rows with `nan` or `inf`."""

    cells: Cells
    name: str
    mark: str
    used: set[str]
    not_finite: BoolArray

    @classmethod
    def of(cls, cells: Cells, name: str) -> _Table:
        """Build a table with rows as long as its header; the case of known headings is ignored."""
        cells = dataclasses.replace(cells, header=tuple(map(_column_name, cells.header)))
        twice = [column for column in COLUMNS if cells.header.count(column) > 1]
        if twice:
            raise track_error(
                "column_twice",
                name,
                place=f"row {cells.header_line}",
                column=twice[0],
                allowed=Message("each column once"),
                action=Message("Rename or remove one of them."),
            )
        width = len(cells.header)
        require_width(cells, name)
        rows = tuple((row + ("",) * (width - len(row)))[:width] for row in cells.rows)
        places = [place for place, column in enumerate(cells.header) if column in COLUMNS]
        mark = decimal_mark_of((row[place] for place in places for row in rows), cells.separator)
        return cls(dataclasses.replace(cells, rows=rows), name, mark, set(), np.zeros(len(rows), dtype=bool))

    @property
    def header(self) -> tuple[str, ...]:
        return self.cells.header

    def kind(self) -> bool:
        """True if places are latitude and longitude, False if they are local metres."""
        local, geodetic = (any(column in self.header for column in form[:2]) for form in (LOCAL, GEODETIC))
        if local and geodetic:
            raise track_error(
                "two_places",
                self.name,
                place=f"row {self.cells.header_line}",
                allowed=Message("the columns {forms}", forms=_FORMS),
                action=Message("The file has places in metres and in degrees; take one of them away."),
            )
        for column in GEODETIC[:2] if geodetic else LOCAL[:2]:
            if column not in self.header:
                raise self._missing(column)
        if not any(column in self.header for column in TIMES):
            raise self._missing("time" if geodetic else "time_s")
        optional = {(GEODETIC if geodetic else LOCAL)[2]} | ({SPEEDS[0]} if not {*SPEEDS} & {*self.header} else set())
        for column in columns_by_synonym(self.header).values():
            if column in optional:  # heights or speeds would be lost
                raise self._missing(column)
        return geodetic

    def _missing(self, column: str) -> Exception:
        near = difflib.get_close_matches(column, self.header, n=1, cutoff=0.6)
        likely = columns_by_synonym(self.header)
        action = Message("Name the column in the header.")
        if likely:
            pairs = [Message("{name} for {heading!r}", name=name, heading=heading) for heading, name in likely.items()]
            action = joined([action, Message("Likely {pairs}.", pairs=pairs)])
        elif near:
            action = joined([action, Message("Did you mean {similar!r}?", similar=near[0])])
        return track_error(
            "missing_column",
            self.name,
            place=f"row {self.cells.header_line}",
            column=column,
            value=", ".join(self.header),
            allowed=Message("the columns {forms}", forms=_FORMS),
            action=action,
        )

    def require_rows(self) -> None:
        if not self.cells.rows:
            raise track_error(
                "empty_file",
                self.name,
                allowed=Message("a row for each point below the header"),
                action=Message("The file has a header only; was anything recorded?"),
            )

    def column(self, name: str) -> list[str]:
        self.used.add(name)
        place = self.header.index(name)
        return [row[place] for row in self.cells.rows]

    def numbers(self, name: str) -> FloatArray:
        """Column of numbers (n,); NaN for blank cells, and for `nan` and `inf`, which are flagged."""
        cells = self.column(name)
        values = np.array([number(cell, self.mark) for cell in cells])
        for place in np.flatnonzero(np.isnan(values)).tolist():
            if is_not_finite(cells[place]):
                self.not_finite[place] = True
            elif cells[place]:
                raise self._no_number(place, name, cells[place])
        return values

    def optional(self, name: str) -> FloatArray | None:
        return self.numbers(name) if name in self.header else None

    def vectors(self, names: tuple[str, ...]) -> FloatArray:
        """Columns side by side, NaN where one is absent."""
        absent = np.full(len(self.cells.rows), np.nan)
        return np.column_stack([self.numbers(name) if name in self.header else absent for name in names])

    def time(self) -> tuple[FloatArray, datetime | None, str | None]:
        """Seconds, the moment of the first row if the column has dates, and a note on how it was read."""
        name = next(column for column in TIMES if column in self.header)
        cells = self.column(name)
        if name == "time_s" or not math.isnan(number(cells[0], self.mark)):
            seconds = self._seconds(name, cells)
            return (seconds, None, None) if name == "time_s" else convert_serial_dates(seconds)
        moments = [moment(cell) for cell in cells]
        for place, read in enumerate(moments):
            if read is None:
                raise self._no_time(place, name, cells[place])
        times = [read for read in moments if read is not None]
        for place, (one, other) in enumerate(itertools.pairwise(times)):
            if (one.tzinfo is None) != (other.tzinfo is None):
                raise self._no_time(place + 1, name, cells[place + 1], Message("all with a zone, or all without"))
        return np.array([(read - times[0]).total_seconds() for read in times]), times[0], None

    def _seconds(self, name: str, cells: list[str]) -> FloatArray:
        values = np.array([number(cell, self.mark) for cell in cells])
        for place in np.flatnonzero(~(np.abs(values) <= FARTHEST * 100.0)).tolist():
            raise self._no_time(place, name, cells[place])
        return values

    def _no_time(self, place: int, column: str, cell: str, also: str = _IN_EVERY_ROW) -> Exception:
        what = (
            Message("seconds")
            if column == "time_s"
            else Message("seconds, or a date and time such as 2022-12-27T15:51:14.2Z,")
        )
        return track_error(
            "not_a_number" if column == "time_s" else "not_a_time",
            self.name,
            place=f"row {self.cells.lines[place]}",
            column=column,
            value=cell,
            allowed=joined([what, also]),
            action=Message("A point without a time cannot be put on a track; correct the cell."),
        )

    def _no_number(self, place: int, column: str, cell: str) -> Exception:
        mark = Message("a decimal comma") if self.mark == "," else Message("a decimal point")
        return track_error(
            "not_a_number",
            self.name,
            place=f"row {self.cells.lines[place]}",
            column=column,
            value=cell,
            allowed=Message("a finite number with {mark}, or nothing", mark=mark),
            action=Message("Correct the cell."),
        )


def _column_name(heading: str) -> str:
    """The column that a heading names, whatever its case and with spaces for underscores; else the heading.

    >>> [_column_name(heading) for heading in ("Time", "LAT", "Alt m", "Heart rate")]
    ['time', 'lat', 'alt_m', 'Heart rate']
    """
    name = re.sub(r"[\s_]+", "_", heading.strip()).casefold()
    return name if name in COLUMNS else heading


_METRES, _DEGREES = ("", "m"), ("", "°", "deg", "grad")
_WORDS: Final = {
    "time": (("zeit", "time", "t", "zeitstempel", "timestamp"), ("",)),
    "time_s": (("zeit", "time", "t"), ("s", "sec", "sek")),
    "x_m": (("x", "rechtswert", "east", "easting", "ost"), _METRES),
    "y_m": (("y", "hochwert", "north", "northing", "nord"), _METRES),
    "z_m": (("z",), _METRES),
    "lat": (("latitude", "breite", "breitengrad"), _DEGREES),
    "lon": (("lng", "long", "longitude", "länge", "längengrad"), _DEGREES),
    "alt_m": (("alt", "altitude", "elevation", "höhe", "height"), _METRES),
    "speed_m_per_s": (("speed", "v", "geschwindigkeit"), ("", "m/s")),
}
"""Synonyms of each column in headings of other programs, and the units that need no conversion."""
_HEADING: Final = re.compile(
    r"(?P<word>[^\W\d_]+)"
    r"(?:[\s_]*[\[(/]\s*(?P<bracketed>[^\])]*?)\s*[\])]?|[\s_]+(?P<unit>\S+))?"
)


def columns_by_synonym(headings: Sequence[str]) -> dict[str, str]:
    """Columns by headings that are synonyms; a heading with a different unit is not included.

    >>> columns_by_synonym(["Zeit [s]", "x (m)", "Y", "Geschwindigkeit [km/h]"])
    {'Zeit [s]': 'time_s', 'x (m)': 'x_m', 'Y': 'y_m'}
    """
    columns: dict[str, str] = {}
    for heading in headings:
        column = _column(" ".join(unicodedata.normalize("NFC", heading).split()).casefold())
        if column is not None and column not in columns.values() and column not in headings:
            columns[heading] = column
    return columns


def _column(heading: str) -> str | None:
    match = _HEADING.fullmatch(heading)
    if match is None:
        return None
    unit = match["bracketed"] or match["unit"] or ""
    return next((name for name, (words, units) in _WORDS.items() if match["word"] in words and unit in units), None)
