"""Days and times as people write them, to ISO 8601."""

from __future__ import annotations

import re
from datetime import date, datetime, time
from typing import TYPE_CHECKING, Final

from ..problems import warning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..problems import Problem
    from .columns import Rows

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


class DateCollector:
    """Collects days and times, written after ISO 8601; one that cannot be read stays as it is, and is reported once."""

    def __init__(self, column: str) -> None:
        self._column = column
        self._written: dict[str, str | None] = {"": ""}
        self._texts: list[str] = []
        self._unread: list[tuple[int, str, str]] = []

    def take(self, cells: Sequence[str], rows: Rows, found: list[Problem]) -> None:  # noqa: ARG002
        """See `Collector.take`."""
        for index, cell in enumerate(map(str.strip, cells)):
            if cell not in self._written:
                self._written[cell] = iso_moment(cell)
            written = self._written[cell]
            if written is None:
                self._unread.append((rows.line[index], cell, rows.key[index]))
            self._texts.append(cell if written is None else written)

    def problems(self, file: str) -> list[Problem]:
        """What could not be read, in one warning."""
        if not self._unread:
            return []
        line, cell, key = self._unread[0]
        more = f", and {len(self._unread) - 1} more like it" if len(self._unread) > 1 else ""
        return [
            warning(
                "unreadable_date",
                file,
                row=line,
                column=self._column,
                experiment=key.strip() or None,
                value=f"{cell}{more}",
                allowed="a day such as 2026-11-23 or 23.11.2026, with or without a time such as 09:10",
                action="Write it so; no estimate needs it, but the report does not name this day.",
            )
        ]

    def column(self) -> tuple[str, ...]:
        """Give the column."""
        return tuple(self._texts)
