"""Columns of a table while it is read: names, numbers, texts and dates, with checks of each cell."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime, time
from functools import partial
from typing import Any, Final, Protocol

import numpy as np

from ..._support.arrays import BoolArray, FloatArray, IntArray
from ..._support.messages import Message
from ..._support.spreadsheet_text import is_number, number
from ...parameters import Quantity
from ...parameters.quantity import LARGEST, SMALLEST, beyond_reason
from ..problems import Problem, error, warning
from .headings import UnitConversion
from .table_forms import UNLOADING, TableForm, allowed_words


@dataclass(frozen=True, slots=True)
class Rows:
    """Some rows of a file: line and experiment's name (`key`) of each, and the list to which problems are added."""

    file: str
    line: Sequence[int]
    key: Sequence[str]
    problems: list[Problem]

    def refuse(self, code: str, index: int, column: str, value: str, allowed: Message, action: Message) -> None:
        """Add an error for the cell of a column in the row with this index, with its file, line and experiment."""
        row, name = self.line[index], self.key[index].strip() or None
        self.problems.append(
            error(code, self.file, row=row, column=column, experiment=name, value=value, allowed=allowed, action=action)
        )


class Collector(Protocol):
    """Collects the cells of one column, several rows at a time."""

    def take(self, cells: Sequence[str], rows: Rows) -> None:
        """Convert and store the column's cells in some rows; errors are added to the problems of the rows."""


@dataclass(frozen=True, slots=True)
class NameColumn:
    """A column of text with few distinct values: these values, and for each row the index of its value."""

    names: tuple[str, ...]
    code: IntArray

    @property
    def is_blank(self) -> BoolArray:
        """True (n,) for rows without a name."""
        blank = np.array([not name for name in self.names], dtype=np.bool_)
        return blank[self.code]

    def __getitem__(self, index: int) -> str:
        """Text of the cell in the row with this index."""
        return self.names[self.code[index]]

    def cells(self) -> tuple[str, ...]:
        """Texts of the cells of all rows."""
        return tuple(map(self.names.__getitem__, self.code.tolist()))


class _NameCodes(dict[str, int]):
    """Index of the name in a cell by the cell's text; names without outer blanks are numbered as they first appear."""

    def __init__(self) -> None:
        super().__init__()
        self.code_of_name: dict[str, int] = {}

    def __missing__(self, cell: str) -> int:
        code = self.code_of_name.setdefault(cell.strip(), len(self.code_of_name))
        self[cell] = code
        return code


class NameCollector:
    """Collects names; a required name must not be blank."""

    def __init__(self, column: str, *, required: bool) -> None:
        self._column = column
        self._required = required
        self._codes = _NameCodes()
        self._parts: list[IntArray] = []

    def take(self, cells: Sequence[str], rows: Rows) -> None:
        """Store names by number; a blank one is an error if the column is required."""
        code = np.fromiter(map(self._codes.__getitem__, cells), np.int64, len(cells))
        self._parts.append(code)
        blank = self._codes.code_of_name.get("")
        if self._required and blank is not None:
            allowed, action = Message("a non-empty name"), Message("Fill the cell.")
            for index in np.flatnonzero(code == blank).tolist():
                rows.refuse("out_of_range", index, self._column, "", allowed, action)

    def column(self, count: int) -> NameColumn:
        """Column of the collected names; `count` blank ones if the file does not have the column."""
        if not self._parts:
            return NameColumn(("",), np.zeros(count, dtype=np.int64))
        return NameColumn(tuple(self._codes.code_of_name), np.concatenate(self._parts))


class NumberCollector:
    """Collects numbers in the unit of the column's name; NaN for blank and invalid cells."""

    def __init__(self, column: Quantity, mark: str, unit: UnitConversion | None = None) -> None:
        self._column = column
        self._mark = mark
        self._unit = unit if unit is not None and unit.changes else None
        self._parts: list[FloatArray] = []

    def take(self, cells: Sequence[str], rows: Rows) -> None:
        """Convert and store numbers in the column's unit; text, required gaps and values out of range are errors."""
        values = numbers(cells, self._mark)
        name = self._column.name
        for index in np.flatnonzero(np.isnan(values)).tolist():
            cell = cells[index].strip()
            if cell or self._column.needed:
                allowed, action = allowed_words(self._column), self._how_to_write(cell)
                rows.refuse("not_a_number", index, name, cell, allowed, action)
        if self._unit is not None:
            with np.errstate(over="ignore"):
                values = self._unit.convert(values)
        outside = self._column.outside(values)
        for index in np.flatnonzero(outside).tolist():
            action = Message("Correct the cell; its unit is in the column's name.")
            cell = cells[index].strip() + (f" {self._unit.name}" if self._unit is not None else "")
            allowed = allowed_words(self._column)
            if beyond_reason(values[index]):
                allowed = Message(
                    "{allowed}; if it is not 0, with a size from {smallest:g} to {largest:g}",
                    allowed=allowed, smallest=SMALLEST, largest=LARGEST,
                )  # fmt: skip
            rows.refuse("out_of_range", index, name, cell, allowed, action)
        values[outside] = np.nan
        self._parts.append(values)

    def _how_to_write(self, cell: str) -> Message:
        """Advice for a cell that is not a number: enter it, change its decimal mark, or write it plainly."""
        if not cell:
            return Message("Enter the number.")
        if is_number(cell, "." if self._mark == "," else ","):
            return Message(
                "The decimal mark of this file is {mark!r}; {cell} could be a thousand. Write it as the other cells.",
                mark=self._mark,
                cell=cell,
            )
        return Message(
            "Write a plain number such as {example}, without unit, remark or thousands separator.",
            example=f"12{self._mark}5",
        )

    def column(self, count: int) -> FloatArray:
        """Numbers of the collected cells; `count` times NaN if the file does not have the column."""
        return np.concatenate(self._parts) if self._parts else np.full(count, np.nan)


class TextCollector:
    """Collects stripped texts; equal neighbours share an object."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def take(self, cells: Sequence[str], rows: Rows) -> None:  # noqa: ARG002
        """Store texts without surrounding spaces; none is an error."""
        once: dict[str, str] = {}
        self._texts.extend(once.setdefault(cell, cell) for cell in map(str.strip, cells))

    def column(self) -> tuple[str, ...]:
        """The column: one stripped text for each row."""
        return tuple(self._texts)


@dataclass(frozen=True, slots=True)
class Table:
    """A table as read from a file: n rows in its order, numbers in the units of the columns' names.

    form: required and allowed columns.
    row: line of the file of each row.
    names: required and interpreted optional text columns, also if the file does not have them.
    numbers: all columns of numbers of the form; NaN for blank, missing and invalid cells.
    further: other columns of the file, also unknown ones, as text.
    absent: required columns that the file does not have.
    headings: headings in the file.
    unstated: headings without a unit, by their columns of numbers.
    """

    form: TableForm
    row: IntArray
    names: Mapping[str, NameColumn]
    numbers: Mapping[str, FloatArray]
    further: Mapping[str, tuple[str, ...]]
    absent: frozenset[str]
    headings: tuple[str, ...]
    unstated: Mapping[str, str]

    def __len__(self) -> int:
        """Count the rows."""
        return len(self.row)

    def error(self, row: int, code: str, column: str, value: str, allowed: Message, action: Message) -> Problem:
        """Error, to be reported by the caller, for the cell of a column in the row with this index."""
        return error(code, **self._problem_place(row, column), value=value, allowed=allowed, action=action)

    def warning(
        self, row: int, code: str, column: str | None, value: str, allowed: Message, action: Message
    ) -> Problem:
        """Warning, to be reported by the caller, for the cell of a column in the row with this index."""
        return warning(code, **self._problem_place(row, column), value=value, allowed=allowed, action=action)

    def _problem_place(self, row: int, column: str | None) -> dict[str, Any]:
        """File, row, column and experiment of a problem at the table's row with this index."""
        experiment = self.names[self.form.key][row] or None
        return {"file": self.form.file, "row": int(self.row[row]), "column": column, "experiment": experiment}


class DateCollector(TextCollector):
    """Collects days and times in ISO 8601; unreadable ones are kept as text and reported in one warning."""

    def __init__(self, column: str) -> None:
        super().__init__()
        self._column = column
        self._iso_text: dict[str, str | None] = {"": ""}
        self._unread: list[tuple[int, str, str]] = []

    def take(self, cells: Sequence[str], rows: Rows) -> None:
        """Store dates as ISO 8601 where they are unambiguous; others stay as written and are recorded."""
        for index, cell in enumerate(map(str.strip, cells)):
            if cell not in self._iso_text:
                self._iso_text[cell] = iso_moment(cell)
            written = self._iso_text[cell]
            if written is None:
                self._unread.append((rows.line[index], cell, rows.key[index]))
            self._texts.append(cell if written is None else written)

    def problems(self, file: str) -> list[Problem]:
        """Warning of unreadable days and times, if any."""
        if not self._unread:
            return []
        line, cell, key = self._unread[0]
        more = f", and {len(self._unread) - 1} more like it" if len(self._unread) > 1 else ""
        dated = partial(warning, "unreadable_date", file, row=line, column=self._column, experiment=key.strip() or None)
        allowed = Message("a day such as 2026-11-23 or 23.11.2026, with or without a time such as 09:10")
        action = Message("Write it so; no estimate needs it, but the report does not name this day.")
        return [dated(value=f"{cell}{more}", allowed=allowed, action=action)]


def is_unloading_cell(cell: str) -> bool:
    """True if the cell marks a reading of the unloading, when discs are taken off."""
    return cell.strip().casefold() == UNLOADING


def is_unloading(branch: NameColumn) -> BoolArray:
    """Mask (n,) of the rows that are readings of the unloading."""
    return np.array(list(map(is_unloading_cell, branch.names)), dtype=np.bool_)[branch.code]


_BETWEEN: Final = "\x1f"  # the unit separator: in no number


def numbers(cells: Sequence[str], mark: str) -> FloatArray:
    """Numbers in a column of cells (n,); NaN for blank cells and for cells that are not a finite number."""
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
    """Numbers of cells, NaN for empty ones; ValueError if another cell is not a number."""
    try:
        return list(map(float, cells))
    except ValueError:
        return [float(cell or "nan") for cell in cells]


_CLOCK: Final = r"(?:[ T,]+(?:um )?(?P<hour>\d{1,2})[:.](?P<minute>\d{2})(?:[:.](?P<second>\d{2}))?(?: Uhr)?)?"
_DAY_FIRST: Final = re.compile(rf"(?P<day>\d{{1,2}})\. ?(?P<month>\d{{1,2}})\. ?(?P<year>\d{{4}}|\d{{2}}){_CLOCK}")
_SLASHES: Final = re.compile(rf"(?P<day>\d{{1,2}})/(?P<month>\d{{1,2}})/(?P<year>\d{{4}}){_CLOCK}")
_CLOCK_ALONE: Final = re.compile(r"\d{1,2}:\d{2}(:\d{2})?")


def iso_moment(cell: str) -> str | None:
    """Text of a day, a day and time, or a time of day in ISO 8601; None if it is invalid or ambiguous.

    With points the day comes first. With slashes it is read only if the order of day and month is unambiguous.

    >>> [iso_moment(cell) for cell in ("23.11.2026", "23.11.2026 9:05", "2026-11-23T09:05", "09:05")]
    ['2026-11-23', '2026-11-23T09:05:00', '2026-11-23T09:05', '09:05']
    >>> [iso_moment(cell) for cell in ("11/23/2026", "3/4/2026", "31.11.2026", "gestern")]
    ['2026-11-23', None, None, None]
    """
    text = " ".join(cell.split())
    match = _DAY_FIRST.fullmatch(text) or _SLASHES.fullmatch(text)
    try:
        if match is not None:
            return _iso_text(match, slashes="/" in text)
        if _CLOCK_ALONE.fullmatch(text):
            time.fromisoformat(text.rjust(len("09:05") if text.count(":") == 1 else len("09:05:00"), "0"))
        elif re.match(r"\d{4}-", text):
            datetime.fromisoformat(text)
        else:
            return None
    except ValueError:
        return None
    return text


def _iso_text(match: re.Match[str], *, slashes: bool) -> str | None:
    """ISO date (with time if given) of a day-month-year match; None if slashes leave day and month ambiguous."""
    day, month, year = (int(match[name]) for name in ("day", "month", "year"))
    if slashes and day != month:
        if day <= 12 and month <= 12:
            return None
        if month > 12:
            day, month = month, day
    of_day = date(year + 2000 if year < 100 else year, month, day).isoformat()
    if match["hour"] is None:
        return of_day
    clock = time(int(match["hour"]), int(match["minute"]), int(match["second"] or 0))
    return f"{of_day}T{clock.isoformat()}"
