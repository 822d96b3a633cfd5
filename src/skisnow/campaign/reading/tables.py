"""Reader of one table of a campaign: applies corrections, splits it into columns, and checks each cell."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

import numpy as np

from ..._support.arrays import IntArray
from ..._support.csv_text import CsvText, Records, UnreadableTextError
from ..._support.messages import Message
from ..._support.spreadsheet_text import SEPARATOR_NAMES, decimal_mark
from ..problems import Problem, error, warning
from .campaign_files import RawFiles
from .columns import Collector, DateCollector, NameCollector, NumberCollector, Rows, Table, TextCollector
from .corrections import STATUS, Corrector
from .header import Header, check_header, column_units, split_header
from .table_forms import TableForm

DATES: Final = ("time", "when")
"""Names of columns with days and times."""
MOST_ERRORS: Final = 10_000
"""Number of errors above which the rest of a table is not read."""


@dataclass(frozen=True, slots=True)
class Cells:
    """A table in memory: its columns, and the text of each cell.

    columns: names of the columns.
    lines: line of each row in the file that an export of the table writes.
    rows: cells of each row, with a decimal point.
    """

    columns: tuple[str, ...]
    lines: Sequence[int]
    rows: Sequence[list[str]]


def read_table(form: TableForm, files: RawFiles, progress: Callable[[str], None] | None = None) -> Table | None:
    """Read one table, with its corrections applied, and check each cell.

    files: files of the campaign; its headings and corrections are used, and problems are added to it.
    progress: called with a text on the number of rows read so far.
    Returns the table, or None if no row can be read. After an error its columns can have gaps.
    """
    text = files.csv_text(form)
    if form.file in files.absent:
        for corrections in files.corrections.get(form.file, {}).values():
            allowed = Message("a readable file of this campaign")
            files.problems.extend(wrong.mismatch("file", wrong.file, allowed) for wrong in corrections)
    if text is None:
        return None
    reading: TableReading | None = None
    readable = True
    errors = counted = 0
    try:
        for lines, rows in text.records():
            errors += sum(problem.severity == "error" for problem in files.problems[counted:])
            counted = len(files.problems)
            if errors > MOST_ERRORS and rows:
                allowed = Message("at most {most_errors} errors in a table", most_errors=MOST_ERRORS)
                action = Message("The rest was not read. Correct the rows above, or check that this is the right file.")
                value = f"{errors} errors above it"
                raise UnreadableTextError(row=lines[0], value=value, allowed=allowed, action=action)
            if reading is None and rows:
                reading = TableReading(form, files, split_header(lines, rows), text)
            if reading is not None and rows:
                reading.take(lines, rows)
                if progress is not None:
                    progress(f"{form.file}: {len(reading):,} rows")
    except UnreadableTextError as failure:
        files.report_unreadable(form.file, failure)
        readable = False
    if reading is not None:
        return reading.finish(readable=readable)
    if readable:
        files.problems.append(_empty_error(form, "nothing"))
    return None


def table_of_cells(form: TableForm, cells: Cells, files: RawFiles) -> Table | None:
    """Convert and check a table in memory with applied corrections; None without rows. Errors leave gaps in columns."""
    reading = TableReading(form, files, Header(cells.columns, 1))
    reading.take(list(cells.lines), list(cells.rows))
    return reading.finish(readable=True)


def _empty_error(form: TableForm, what: str) -> Problem:
    """Error for a table without header or rows; `what` is the value it shows."""
    action = Message("Fill the file, or remove it from the campaign.")
    return error("empty_file", form.file, value=what, allowed=Message("a header and at least one row"), action=action)


class TableReading:
    """Collects the rows of a table in chunks and converts them to a `Table`.

    header, corrector: header with the names of the columns, and the object that applies corrections.
    conversions: conversion of each column whose unit is stated.
    """

    def __init__(self, form: TableForm, files: RawFiles, header: Header, text: CsvText | None = None) -> None:
        """Begin a table; numbers have decimal points without `text`, the file with the decimal mark."""
        self._form, self._problems, self._headings = form, files.problems, header.columns
        self.conversions, self._unstated = column_units(form, header, files.headings, files.problems)
        self._file_header = Header(tuple(files.headings.name(form, heading) for heading in header.columns), header.row)
        mark = "."
        if text is not None:
            mark = _decimal_mark_of(form, self._file_header, text)
            for value in [SEPARATOR_NAMES[text.separator]] * (text.separator != ",") + ["decimal comma"] * (
                mark == ","
            ):
                allowed = Message("commas between cells and decimal points, in the plain form")
                action = Message("It was read as found; no action is needed.")
                note = warning("separator", form.file, value=value, allowed=allowed, action=action, needs_action=False)
                files.problems.append(note)
        files.problems.extend(check_header(form, self._file_header))
        corrections = files.corrections.get(form.file, {})
        corrected = (correction.column for of_one_row in corrections.values() for correction in of_one_row)
        columns = self._file_header.columns
        adds_status = STATUS in form.optional and STATUS not in columns and STATUS in corrected
        self.header = Header((*columns, STATUS), self._file_header.row) if adds_status else self._file_header
        self.corrector = Corrector(form, self.header, corrections, mark=mark, problems=files.problems)
        self._row: list[IntArray] = []
        self._met_rows = False
        present = self.header.position
        self._names = {name: NameCollector(name, required=name in form.names) for name in form.names + form.optional}
        self._numbers = {
            column.name: NumberCollector(column, mark, self.conversions.get(column.name)) for column in form.numbers
        }
        interpreted = (set(self._names) | set(self._numbers)) - set(form.further)
        self._further = {
            name: DateCollector(name) if name in DATES else TextCollector()
            for name in present
            if name not in interpreted
        }
        collectors: list[tuple[str, Collector]] = [*self._names.items(), *self._numbers.items(), *self._further.items()]
        self._collectors = [(present[name], collector) for name, collector in collectors if name in present]

    def __len__(self) -> int:
        return sum(map(len, self._row))

    def take(self, lines: list[int], rows: list[list[str]]) -> None:
        """Correct, check and store some rows with their lines of the file."""
        self._met_rows = True
        lines, rows = self._without_surplus(lines, rows)
        self.corrector.apply(lines, rows)
        if not rows:
            return
        width = len(self.header.columns)
        if min(map(len, rows)) < width:
            rows = [cells + [""] * (width - len(cells)) for cells in rows]
        columns = list(zip(*rows, strict=True))
        key_position = self.header.position.get(self._form.key)
        keys = columns[key_position] if key_position is not None else ("",) * len(rows)
        about = Rows(self._form.file, lines, keys, self._problems)
        self._row.append(np.array(lines, dtype=np.int64))
        for position, collector in self._collectors:
            collector.take(columns[position], about)

    def _without_surplus(self, lines: list[int], rows: list[list[str]]) -> Records:
        """Remove and report rows with a cell below an unnamed column; blank cells there are ignored."""
        width = len(self._file_header.columns)
        unnamed = [index for index, name in enumerate(self._file_header.columns) if not name]
        if not unnamed and max(map(len, rows)) <= width:
            return lines, rows
        action = Message("Name the column in the header, or put the cell with a separator or decimal comma in quotes.")
        good: Records = ([], [])
        for line, cells in zip(lines, rows, strict=True):
            surplus = chain(cells[width:], (cells[index] for index in unnamed if index < len(cells)))
            first = next(filter(None, map(str.strip, surplus)), None)
            if first is None:
                good[0].append(line)
                good[1].append(cells[:width])
            else:
                allowed = Message("{width} cells, one below each column name", width=width - len(unnamed))
                self._problems.append(
                    error("unreadable_file", self._form.file, row=line, value=first, allowed=allowed, action=action)
                )
        return good

    def finish(self, *, readable: bool) -> Table | None:
        """The table from all records, None without any; reports problems that only the whole file shows."""
        self.corrector.finish()
        for collector in self._further.values():
            if isinstance(collector, DateCollector):
                self._problems.extend(collector.problems(self._form.file))
        if readable and not self._met_rows and not self._form.may_be_empty:
            self._problems.append(_empty_error(self._form, "a header only"))
        if not len(self) and not self._form.may_be_empty:
            return None
        count = len(self)
        present = self.header.position
        return Table(
            form=self._form,
            row=np.concatenate(self._row) if self._row else np.zeros(0, dtype=np.int64),
            names={name: collector.column(count) for name, collector in self._names.items()},
            numbers={name: collector.column(count) for name, collector in self._numbers.items()},
            further={name: collector.column() for name, collector in self._further.items()},
            absent=frozenset(name for name in self._form.required if name not in present),
            headings=self._headings,
            unstated=self._unstated,
        )


def _decimal_mark_of(form: TableForm, header: Header, text: CsvText) -> str:
    """Decimal mark of a CSV table, point or comma: that of its first numbers with a fraction."""
    number_columns = {column.name for column in form.numbers}
    positions = [index for index, name in enumerate(header.columns) if name in number_columns]
    try:
        numbers = (
            [cells[index] for cells in rows for index in positions if index < len(cells)] for _, rows in text.records()
        )
        return decimal_mark(numbers, separator=text.separator)
    except UnreadableTextError:
        return "."  # what is unreadable is reported where the records are read
