"""Text and tables in files of tracks: decoding, separation into cells, times of the points."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Final

import numpy as np

from ..._support.arrays import BoolArray, FloatArray, IntArray
from ..._support.csv_text import UnreadableTextError, inspect_csv
from ..._support.messages import Message
from ..._support.spreadsheet_text import NoTextError, decoded
from .recording import track_error


def decode_text(data: bytes, name: str) -> str:
    """Decode UTF-8, UTF-16 with byte order mark, or Windows-1252; all line ends become line feeds.

    All byte order marks are removed: concatenated files have several.

    Raises FieldDataError: the bytes are not text.
    """
    try:
        return "\n".join(decoded(data).text.replace("\ufeff", "").splitlines())
    except NoTextError as error:
        allowed = Message("text in UTF-8, UTF-16 with byte order mark, or Windows-1252; or FIT or UBX")
        action = Message("The file is neither text nor a known format of receivers; export it as CSV, GPX or FIT.")
        raise track_error("unreadable_file", name, allowed, action, value=error.place) from error


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells of a table: the header, and rows with the line of the file at which each begins."""

    header: tuple[str, ...]
    header_line: int
    lines: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    separator: str


def split_cells(text: str, name: str) -> Cells:
    """Split a CSV file into cells by the most frequent of comma, semicolon and tab, or by a first line ``sep=;``.

    Raises FieldDataError: there is no header, a quote is never closed, a cell is too long, or there are too many
        columns.
    """
    lines: list[int] = []
    rows: list[tuple[str, ...]] = []
    try:
        csv_text = inspect_csv(text.encode())
        for lines_of_chunk, records in csv_text.records():
            lines += lines_of_chunk
            rows += (tuple(map(str.strip, cells)) for cells in records)
    except UnreadableTextError as error:
        row = None if error.row is None else f"row {error.row}"
        raise track_error("unreadable_file", name, error.allowed, error.action, place=row, value=error.value) from error
    if not rows:
        raise track_error("empty_file", name, Message("a header and rows"), Message("The file is empty."))
    return Cells(rows[0], lines[0], tuple(lines[1:]), tuple(rows[1:]), csv_text.separator)


def moment(cell: str) -> datetime | None:
    """Date and time in a cell by ISO 8601, converted to UTC if it has a zone; None if it is not a date and time.

    >>> moment("2022-12-27T16:51:14.5+01:00").isoformat()
    '2022-12-27T15:51:14.500000+00:00'
    """
    if len(cell) < len("2022-12-27T15:51") or not cell.isascii():
        return None
    regular = re.sub(r"(:\d\d:)60", r"\g<1>59", cell, count=1)  # a leap second is second 60
    try:
        time = datetime.fromisoformat(regular) + timedelta(seconds=regular != cell)
        return time if time.tzinfo is None else time.astimezone(UTC)
    except (ValueError, OverflowError):
        return None


LEAST_SHARE: Final = 0.3
"""Smallest share of points that do not begin a stamp in a file with rounded stamps (modelling assumption)."""
LEAST_ADVANCE: Final = 0.5
"""Smallest share of the path within stamps, relative to an even motion, of advancing points (modelling assumption)."""
_EVEN: Final = 1.01
"""Steps between stamps up to this many units count as one unit: no stamp is missing."""


def spread_times(time: FloatArray, place: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Times with the points of each stamp spread until the next stamp, and which points were moved.

    time: (n,) s, never falling.
    place: (n, 2) m, horizontal places, NaN if unknown.
    Returns: times (n,) (s), and (n,) bool. Without rounded stamps: the times given, and no point.

    >>> place = np.column_stack([np.arange(6.0), np.zeros(6)])
    >>> spread_times(np.array([0.0, 1.0, 1.0, 2.0, 2.0, 3.0]), place)[0].round(9).tolist()
    [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    """
    unmoved = time, np.zeros(len(time), dtype=bool)
    begins = np.r_[True, np.diff(time) > 0.0] if len(time) else np.zeros(0, dtype=bool)
    if np.count_nonzero(begins) < 2 or np.count_nonzero(~begins) < LEAST_SHARE * len(time):
        return unmoved
    if _advance(place, begins) < LEAST_ADVANCE:
        return unmoved
    first = np.flatnonzero(begins)
    unit = float(np.median(np.diff(time[first])))
    spread = time.copy()
    missing = np.flatnonzero(np.diff(time[first]) > _EVEN * unit) + 1
    count = float(np.median(np.diff(np.append(first, len(time)))))
    for block in np.split(np.arange(len(first)), missing):
        begin = int(first[block[0]])
        end = int(first[block[-1] + 1]) if block[-1] + 1 < len(first) else len(time)
        spread[begin:end] = _block_times(time[first[block]], first[block] - begin, end - begin, (unit, count))
    return np.maximum.accumulate(spread), spread != time


def _advance(place: FloatArray, begins: BoolArray) -> float:
    """Length of the path within stamps relative to its expected share; 0 if nothing moves."""
    steps = np.hypot(*np.diff(place, axis=0).T)
    finite = np.isfinite(steps)
    whole = float(np.sum(steps[finite]))
    if not 0.0 < whole < np.inf:
        return 0.0
    within = finite & ~begins[1:]
    if not within.any():
        return 0.0
    return float(np.sum(steps[within])) / whole / (np.count_nonzero(within) / np.count_nonzero(finite))


def _block_times(stamps: FloatArray, first: IntArray, size: int, usual: tuple[float, float]) -> FloatArray:
    """Times of the points of consecutive stamps: at an even rate if all stamps agree with one, else stamp by stamp.

    stamps, first: (m,), stamps (s), and the number of the first point of each.
    size: number of points.
    usual: unit of the stamps (s), and the usual number of points in a stamp.
    """
    unit, count = usual
    step = unit / count
    if len(stamps) > 2:
        step = float(np.polyfit(first[1:], stamps[1:], 1)[0])
    even = step * np.arange(size)
    crossings = stamps[1:] - even[first[1:]] if len(stamps) > 1 else np.array([stamps[0] + unit - step * size])
    if np.ptp(crossings) <= max(1.5 * step, 1e-6 * unit):
        return np.asarray(even + float(np.max(crossings)))
    times = np.empty(size)
    ends = np.append(first[1:], size)
    for stamp, begin, end in zip(stamps, first, ends, strict=True):
        points = end - begin
        own = unit / points if begin > 0 and end < size else min(step, unit / points)
        shift = unit - own * points if begin == 0 else 0.0
        times[begin:end] = stamp + shift + own * np.arange(points)
    return times


DAY: Final = 86_400.0
"""Seconds."""
EPOCH: Final = datetime(1899, 12, 30)
"""Day 0 of spreadsheets with the date system 1900, for all dates since March 1900."""
YEARS_1904: Final = 1462
"""Days by which day 0 of the date system 1904 is later."""
DATES: Final = (20_000.0, 80_000.0)
"""Serial numbers of the years 1954 to 2119."""
LONGEST_STEP: Final = 2e-4
"""Steps between points up to this are days, 17 s; as seconds they would be 5,000 points a second."""


def convert_serial_dates(values: FloatArray) -> tuple[FloatArray, datetime | None, Message | None]:
    """Seconds, the moment of the first value if the numbers are dates, and a note; numbers of seconds stay.

    values: (n,), numbers in a column of times.
    """
    steps = np.diff(values)
    steps = steps[steps > 0.0]
    if not len(steps) or float(np.median(steps)) > LONGEST_STEP:
        return values, None, None
    seconds = np.round(DAY * (values - values[0]), 3)
    if np.all((values >= DATES[0]) & (values <= DATES[1])):
        start = EPOCH + timedelta(milliseconds=round(float(values[0]) * DAY * 1000.0))
        note = Message(
            "Times are read as serial numbers of a spreadsheet, in days since {epoch:%Y-%m-%d}. With the date system "
            "1904 they are {days} days later.",
            epoch=EPOCH,
            days=YEARS_1904,
        )
        return seconds, start, note
    if np.all((values >= 0.0) & (values < 2.0)):
        return seconds + round(float(values[0]) * DAY, 3), None, Message("Times are read as fractions of a day.")
    return values, None, None
