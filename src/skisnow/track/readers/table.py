"""Tracks in CSV with one row for each point, in local metres or in latitude and longitude."""

from __future__ import annotations

import dataclasses
import itertools
import math
import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Final, NamedTuple

import numpy as np

from ..._support.arrays import BoolArray, FloatArray
from ..._support.messages import Message, count_message, joined
from ..._support.spreadsheet_text import decimal_mark, number
from .recording import FARTHEST, Recording, is_not_finite, track_error
from .text import Cells, convert_serial_dates, moment, split_cells

TIMES: Final = ("time_s", "time")
LOCAL: Final = ("x_m", "y_m", "z_m")
GEODETIC: Final = ("lat", "lon", "alt_m")
SPEED: Final = "speed_m_per_s"
ODOMETER: Final = "dist_m"
LOCAL_SD: Final = ("x_sd_m", "y_sd_m", "z_sd_m")
GEODETIC_SD: Final = ("east_sd_m", "north_sd_m", "up_sd_m")
SPEED_SD: Final = "speed_sd_m_per_s"
COLUMNS: Final = (*TIMES, *LOCAL, *GEODETIC, SPEED, ODOMETER, *LOCAL_SD, *GEODETIC_SD, SPEED_SD)
"""Every column that is read."""
_IN_EVERY_ROW: Final = Message("in every row")
_FORMS: Final = "time_s, x_m, y_m[, z_m, speed_m_per_s] or time, lat, lon[, alt_m, speed_mps]"


def read_table(text: str, name: str) -> Recording:
    """The recording in a CSV file.

    Raises FieldDataError: a column is missing or repeated, a cell is not a number or a time, or a row has more cells
        than the header.
    """
    table = _Table.of(_below_preamble(split_cells(text, name)), name)
    table.require_columns()
    is_geodetic = table.is_geodetic
    time, start, note = table.time()
    first_time = float(time[0]) if start is None and len(time) else 0.0
    place = table.vectors(GEODETIC if is_geodetic else LOCAL)
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
        speed=table.vectors((SPEED,))[:, 0],
        speed_kind="as the device gives it" if is_geodetic else "along the path",
        place_sd=table.vectors(sd) if any(column in table.columns for column in sd) else None,
        speed_sd=table.numbers_if_present(SPEED_SD),
        odometer=table.numbers_if_present(ODOMETER),
        further_columns=table.further_columns,
        columns={
            axis: table.heading(column) for axis, column in zip("xyz", GEODETIC if is_geodetic else LOCAL, strict=True)
        },
        not_finite=table.not_finite,
        notes=() if note is None else (note,),
    )


class _Column(NamedTuple):
    """Place of a column among the cells of a row, and the size of its unit in the unit that is read."""

    place: int
    factor: float


@dataclass(eq=False)
class _Table:
    """Cells with the file's name and decimal mark, the columns that are read, and the rows with `nan` or `inf`.

    hemispheres: places of the columns whose letters give the signs of latitude and longitude.
    """

    cells: Cells
    name: str
    mark: str
    is_geodetic: bool
    columns: dict[str, _Column]
    used: set[str]
    hemispheres: set[int]
    not_finite: BoolArray

    @classmethod
    def of(cls, cells: Cells, name: str) -> _Table:
        """Build a table with rows as long as its header."""
        place = f"row {cells.header_line}"
        if sum(map(bool, cells.header)) == 1:
            allowed = Message("headings separated by comma, semicolon or tab in the first row")
            raise track_error("missing_column", name, allowed, place=place, value=cells.header[0])
        is_geodetic = _is_geodetic(cells.header, name, place)
        columns = _columns(cells.header, is_geodetic, name, place)
        width = len(cells.header)
        for line, row in zip(cells.lines, cells.rows, strict=True):
            beyond = next(filter(None, row[width:]), None)
            if beyond is None:
                continue
            allowed = count_message("{count} cell, as in the header", "{count} cells, as in the header", count=width)
            action = Message("A decimal comma in a file separated by commas looks like this; separate by semicolons.")
            raise track_error("too_many_cells", name, allowed, action, place=f"row {line}", value=beyond)
        blanks = [("",) * missing for missing in range(width, 0, -1)]
        rows = tuple(row + blanks[len(row)] if len(row) < width else row[:width] for row in cells.rows)
        places = [column.place for column in columns.values()]
        filled = (row[place] for place in places for row in rows if row[place])
        mark = "." if cells.separator == "," else decimal_mark([filled], separator=cells.separator)
        cells = dataclasses.replace(cells, rows=rows)
        return cls(cells, name, mark, is_geodetic, columns, set(), set(), np.zeros(len(rows), dtype=bool))

    @property
    def further_columns(self) -> tuple[str, ...]:
        """Headings of the columns that were not used."""
        used = {self.columns[name].place for name in self.used} | self.hemispheres
        return tuple(heading for place, heading in enumerate(self.cells.header) if place not in used)

    def heading(self, column: str) -> str:
        """Heading of a column in the file; its name if the file does not have it."""
        return self.cells.header[self.columns[column].place] if column in self.columns else column

    def require_columns(self) -> None:
        """Reject a table without two coordinates and a time."""
        coordinates = GEODETIC[:2] if self.is_geodetic else LOCAL[:2]
        absent = [column for column in coordinates if column not in self.columns]
        if not any(column in self.columns for column in TIMES):
            absent.append("time" if self.is_geodetic else "time_s")
        if absent:
            place, value = f"row {self.cells.header_line}", ", ".join(self.cells.header)
            allowed, action = Message("the columns {forms}", forms=_FORMS), Message("Name the column in the header.")
            raise track_error("missing_column", self.name, allowed, action, place=place, column=absent[0], value=value)

    def column(self, name: str) -> list[str]:
        """Cells of a column that the file has, which then counts as used."""
        self.used.add(name)
        place = self.columns[name].place
        return [row[place] for row in self.cells.rows]

    def numbers(self, name: str) -> FloatArray:
        """Column of numbers (n,); NaN for blank cells, and for `nan` and `inf`, which are flagged."""
        cells = self.column(name)
        filled = [place for place, cell in enumerate(cells) if cell]
        values = np.full(len(cells), np.nan)
        values[filled] = [number(cells[place], self.mark) for place in filled]
        for place in (place for place in filled if math.isnan(values[place])):
            if not is_not_finite(cells[place]):
                mark = Message("a decimal comma") if self.mark == "," else Message("a decimal point")
                allowed = Message("a finite number with {mark}, or nothing", mark=mark)
                raise self._cell_error("not_a_number", place, name, cells[place], allowed)
            self.not_finite[place] = True
        return self._signed(name, values * self.columns[name].factor)

    def _signed(self, name: str, values: FloatArray) -> FloatArray:
        """Latitudes or longitudes (n,), negative in rows that a column of hemispheres names S or W."""
        letters = _HEMISPHERES.get(name)
        if letters is None:
            return values
        for place, heading in enumerate(self.cells.header):
            cells = np.array([row[place].upper() for row in self.cells.rows])
            if _HEMISPHERE.search(heading) and np.isin(cells, (*letters, "")).all() and np.any(cells != ""):
                self.hemispheres.add(place)
                return np.where(cells == letters[1], -np.abs(values), values)
        return values

    def numbers_if_present(self, name: str) -> FloatArray | None:
        """Numbers of a column; None if the table has no such column."""
        return self.numbers(name) if name in self.columns else None

    def vectors(self, names: tuple[str, ...]) -> FloatArray:
        """Columns side by side, NaN where one is absent."""
        absent = np.full(len(self.cells.rows), np.nan)
        return np.column_stack([self.numbers(name) if name in self.columns else absent for name in names])

    def time(self) -> tuple[FloatArray, datetime | None, Message | None]:
        """Seconds, the moment of the first row if the column has dates, and a note on how it was read."""
        name = next(column for column in TIMES if column in self.columns)
        cells = self.column(name)
        if name == "time_s" or not cells or not math.isnan(number(cells[0], self.mark)):
            seconds = np.array([number(cell, self.mark) for cell in cells]) * self.columns[name].factor
            for place in np.flatnonzero(~(np.abs(seconds) <= FARTHEST * 100.0)).tolist():
                raise self._time_error(place, name, cells[place])
            return (seconds, None, None) if name == "time_s" else convert_serial_dates(seconds)
        moments = [moment(cell) for cell in cells]
        for place, read in enumerate(moments):
            if read is None:
                raise self._time_error(place, name, cells[place])
        times = [read for read in moments if read is not None]
        for place, (one, other) in enumerate(itertools.pairwise(times)):
            if (one.tzinfo is None) != (other.tzinfo is None):
                raise self._time_error(place + 1, name, cells[place + 1], Message("all with a zone, or all without"))
        return np.array([(read - times[0]).total_seconds() for read in times]), times[0], None

    def _time_error(self, place: int, column: str, cell: str, also: str = _IN_EVERY_ROW) -> Exception:
        """Error for a cell that is no time, with the accepted forms; `also` is a further condition."""
        what = (
            Message("a number in {unit}", unit=_unit(column, self.columns[column].factor))
            if column == "time_s"
            else Message("seconds, or a date and time such as 2022-12-27T15:51:14.2Z,")
        )
        code = "not_a_number" if column == "time_s" else "not_a_time"
        return self._cell_error(code, place, column, cell, joined([what, also]))

    def _cell_error(self, code: str, place: int, column: str, cell: str, allowed: Message) -> Exception:
        """Error for a cell, with its row, its column's heading and its text."""
        row = f"row {self.cells.lines[place]}"
        return track_error(code, self.name, allowed, place=row, column=self.heading(column), value=cell)


_HEMISPHERE: Final = re.compile(r"(?<![^\W_])(?:n[\W_]?s|e[\W_]?w)(?![^\W_])|hemi", re.IGNORECASE)
"""Heading of a column with the letters of hemispheres: N/S, EW, Latitude hemisphere."""
_HEMISPHERES: Final = {"lat": ("N", "S"), "lon": ("E", "W")}
_METRES: Final = (
    dict.fromkeys(("", "m", "meter", "metres", "meters"), 1.0)
    | dict.fromkeys(("ft", "feet"), 0.3048)
    | {"cm": 0.01, "mm": 0.001}
)
_DEGREES: Final = dict.fromkeys(("", "°", "deg", "degrees", "grad"), 1.0)
_SPEEDS: Final = (
    dict.fromkeys(("m/s", "mps", "m_s", "m_per_s", "ms-1"), 1.0)
    | dict.fromkeys(("km/h", "kmh", "kph", "km_h", "km_per_h"), 1.0 / 3.6)
    | dict.fromkeys(("kn", "kt", "kts", "knots"), 1852.0 / 3600.0)
    | {"mph": 0.44704, "cm/s": 0.01}
)
_SECONDS: Final = (
    dict.fromkeys(("s", "sec", "sek", "seconds", "sekunden"), 1.0)
    | dict.fromkeys(("ms", "msec"), 1e-3)
    | {"us": 1e-6, "\u03bcs": 1e-6, "ns": 1e-9}
)
_TIME_WORDS: Final = ("time", "timestamp", "zeit", "zeitstempel", "t")
_HEIGHT_WORDS: Final = ("alt", "altitude", "ele", "elevation", "height", "höhe", "gps altitude")
_WORDS: Final[dict[str, tuple[tuple[str, ...], dict[str, float]]]] = {
    "time": (_TIME_WORDS, {"": 1.0}),
    "time_s": (_TIME_WORDS, _SECONDS),
    "x_m": (("x", "rechtswert", "east", "easting", "ost"), _METRES),
    "y_m": (("y", "hochwert", "north", "northing", "nord"), _METRES),
    "z_m": (("z", *_HEIGHT_WORDS), _METRES),
    "lat": (("lat", "latitude", "breite", "breitengrad", "gps latitude"), _DEGREES),
    "lon": (("lon", "lng", "long", "longitude", "länge", "längengrad", "gps longitude"), _DEGREES),
    "alt_m": (_HEIGHT_WORDS, _METRES),
    SPEED: (("speed", "velocity", "geschwindigkeit", "v", "ground speed", "speed over ground", "gps speed"), _SPEEDS),
}
"""Synonyms of each column in headings of other programs, and its units with their sizes."""
_HEADING: Final = re.compile(
    r"(?P<word>(?:gps|ground)[\s_]+[^\W\d_]+|speed[\s_]+over[\s_]+ground|[^\W\d_]+)"
    r"(?:[\s_]*[\[(/]\s*(?P<bracketed>[^\])]*?)\s*[\])]?|[\s_]+(?P<unit>\S+))?"
)


_MOST_ABOVE: Final = 50
"""Rows in which the headings are searched for (choice)."""


def _unit(column: str, factor: float) -> str:
    """Name of the unit that has this size.

    >>> _unit("time_s", 1e-3)
    'ms'
    """
    return next(unit for unit, size in _WORDS[column][1].items() if size == factor and unit)


def _below_preamble(cells: Cells) -> Cells:
    """Cells from the first row on that names a place and a time; all cells if no row does."""
    for place, row in enumerate((cells.header, *cells.rows[:_MOST_ABOVE])):
        named = {name for cell in row for name in (_column_name(cell), (_meaning(cell, COLUMNS) or ("",))[0])}
        if named & {*TIMES} and (named >= {*LOCAL[:2]} or named >= {*GEODETIC[:2]}):
            lines = (cells.header_line, *cells.lines)
            return dataclasses.replace(
                cells, header=row, header_line=lines[place], lines=lines[place + 1 :], rows=cells.rows[place:]
            )
    return cells


def _is_geodetic(headings: Sequence[str], name: str, place: str) -> bool:
    """True for latitude and longitude, False for local metres; exact column names have priority over synonyms.

    name, place: file and row in the error about a table that has both.
    """
    names = {_column_name(heading) for heading in headings}
    local, geodetic = bool(names & {*LOCAL[:2]}), bool(names & {*GEODETIC[:2]})
    if not local and not geodetic:
        local, geodetic = (any(_meaning(heading, form[:2]) for heading in headings) for form in (LOCAL, GEODETIC))
    if local and geodetic:
        action = Message("The file has places in metres and in degrees; take one of them away.")
        raise track_error("two_places", name, Message("the columns {forms}", forms=_FORMS), action, place=place)
    return geodetic


def _columns(headings: Sequence[str], is_geodetic: bool, name: str, place: str) -> dict[str, _Column]:
    """Columns by their names, from the headings of the file.

    Vague synonyms (one letter, or two words) count only if no other heading has the same meaning.

    Raises FieldDataError: two headings have the same meaning, or the only one with a meaning has an unknown unit.
    """
    meanings: dict[str, list[tuple[int, float, bool]]] = {}
    readable = [column for column in COLUMNS if column not in (LOCAL if is_geodetic else GEODETIC)]
    for place_in_row, heading in enumerate(headings):
        column, factor, is_vague = _column_name(heading), 1.0, False
        if column not in COLUMNS:
            meaning = _meaning(heading, readable)
            if meaning is None:
                continue
            column, factor, is_vague = meaning
        meanings.setdefault(column, []).append((place_in_row, factor, is_vague))
    if "time" in meanings:  # a time zone next to the time is not a time
        meanings["time_s"] = [reading for reading in meanings.get("time_s", []) if reading[1]]
    columns = {}
    for column, places in meanings.items():
        readings = [reading for reading in places if reading[1]] or places
        readings = [reading for reading in readings if not reading[2]] or readings
        if not readings:
            continue
        first, factor, _ = readings[0]
        if not factor:
            allowed = Message("the units {units}", units=", ".join(filter(None, _WORDS[column][1])))
            action = Message("Give one of these units in the heading, or rename a column of something else.")
            raise track_error("unknown_unit", name, allowed, action, place=place, column=column, value=headings[first])
        if len(readings) > 1:
            value = ", ".join(headings[reading[0]] for reading in readings)
            allowed, action = Message("each column once"), Message("Rename or remove one of them.")
            raise track_error("column_twice", name, allowed, action, place=place, column=column, value=value)
        columns[column] = _Column(first, factor)
    return columns


def _column_name(heading: str) -> str:
    """The column that a heading names, whatever its case and with spaces for underscores; else the heading.

    >>> [_column_name(heading) for heading in ("Time", "LAT", "Alt m", "Heart rate")]
    ['time', 'lat', 'alt_m', 'Heart rate']
    """
    name = re.sub(r"[\s_]+", "_", heading.strip()).casefold()
    return name if name in COLUMNS else heading


def _meaning(heading: str, columns: Sequence[str]) -> tuple[str, float, bool] | None:
    """Column of which a heading is a synonym, the size of its unit (0: unknown), and True for one letter or two words.

    >>> [_meaning(heading, COLUMNS) for heading in ("t (ms)", "GPS Latitude", "Elevation [fathoms]", "Heart rate")]
    [('time_s', 0.001, True), ('lat', 1.0, True), ('alt_m', 0.0, False), None]
    """
    match = _HEADING.fullmatch(" ".join(unicodedata.normalize("NFC", heading).split()).casefold())
    if match is None:
        return None
    unit = match["bracketed"] or match["unit"] or ""
    word = re.sub(r"[\s_]+", " ", match["word"])
    names = [name for name, (words, _) in _WORDS.items() if name in columns and word in words]
    is_vague = len(word) == 1 or " " in word
    for name in names:
        if unit in _WORDS[name][1]:
            return name, _WORDS[name][1][unit], is_vague
    if not names or (match["bracketed"] is None and is_vague and (unit or len(word) == 1)):
        return None
    return names[-1], 0.0, is_vague
