"""Numbers, days and times in cells of text.

A file writes decimal points or decimal commas, never both: in a file with decimal commas 1.234 could be a thousand.
"""

from __future__ import annotations

import re
from datetime import date, datetime, time
from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.spreadsheet_text import decimal_mark, is_number, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..records import FloatArray

__all__ = ["decimal_mark", "is_number", "number", "numbers"]

_BETWEEN: Final = "\x1f"  # the unit separator: in no number


def numbers(cells: Sequence[str], mark: str) -> FloatArray:
    """Read a column of cells; NaN where a cell is blank or no finite number.

    The whole column at once where it is plain, cell by cell where it is not.
    """
    together = _BETWEEN.join(cells)
    if together.isascii() and "_" not in together and not (mark == "," and "." in together):
        try:
            values = np.array(_all_numbers(together.replace(",", ".").split(_BETWEEN) if mark == "," else cells))
        except ValueError:
            return np.array([number(cell, mark) for cell in cells])
        values[~np.isfinite(values)] = np.nan
        return values
    return np.array([number(cell, mark) for cell in cells])


def _all_numbers(cells: Sequence[str]) -> list[float]:
    try:
        return list(map(float, cells))
    except ValueError:
        return [float(cell or "nan") for cell in cells]


_CLOCK: Final = r"(?:[ T,]+(?:um )?(?P<hour>\d{1,2})[:.](?P<minute>\d{2})(?:[:.](?P<second>\d{2}))?(?: Uhr)?)?"
_DAY_FIRST: Final = re.compile(rf"(?P<day>\d{{1,2}})\. ?(?P<month>\d{{1,2}})\. ?(?P<year>\d{{4}}|\d{{2}}){_CLOCK}")
_SLASHES: Final = re.compile(rf"(?P<day>\d{{1,2}})/(?P<month>\d{{1,2}})/(?P<year>\d{{4}}){_CLOCK}")
_CLOCK_ALONE: Final = re.compile(r"\d{1,2}:\d{2}(:\d{2})?")


def iso_moment(cell: str) -> str | None:
    """A day, a day and time, or a time of day as ISO 8601 writes it; None where it is none, or could be two.

    Written with points the day comes first; with slashes it is read only where the order cannot be mistaken.

    >>> [iso_moment(cell) for cell in ("23.11.2026", "23.11.2026 9:05", "2026-11-23T09:05", "09:05")]
    ['2026-11-23', '2026-11-23T09:05:00', '2026-11-23T09:05', '09:05']
    >>> [iso_moment(cell) for cell in ("11/23/2026", "3/4/2026", "31.11.2026", "gestern")]
    ['2026-11-23', None, None, None]
    """
    text = " ".join(cell.split())
    found = _DAY_FIRST.fullmatch(text) or _SLASHES.fullmatch(text)
    try:
        if found is not None:
            return _written(found, slashes="/" in text)
        if _CLOCK_ALONE.fullmatch(text):
            time.fromisoformat(text.rjust(len("09:05") if text.count(":") == 1 else len("09:05:00"), "0"))
        elif re.match(r"\d{4}-", text):
            datetime.fromisoformat(text)
        else:
            return None
    except ValueError:
        return None
    return text


def _written(found: re.Match[str], *, slashes: bool) -> str | None:
    day, month, year = (int(found[name]) for name in ("day", "month", "year"))
    if slashes and day != month:
        if day <= 12 and month <= 12:
            return None
        if month > 12:
            day, month = month, day
    of_day = date(year + 2000 if year < 100 else year, month, day).isoformat()
    if found["hour"] is None:
        return of_day
    clock = time(int(found["hour"]), int(found["minute"]), int(found["second"] or 0))
    return f"{of_day}T{clock.isoformat()}"
