"""Tables of users as text: cells by column and row, decimal commas and semicolons too, every refusal with its place."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Final

from .errors import ParameterError
from .spreadsheet_text import column_names, decimal_mark, most_frequent_separator, number
from .user_files import plain_text

MOST_CSV_BYTES: Final = 1 << 26
_HEAD: Final = 1 << 16


@dataclass(frozen=True, slots=True)
class CsvRow:
    """One row of a table.

    Attributes
    ----------
    path, row
        File and row, the header being row 1.
    cells
        By column, without blanks around them.
    action
        What to do where a cell is refused.
    mark
        The decimal mark of the file's numbers.
    """

    path: Path
    row: int
    cells: dict[str, str]
    action: str
    mark: str = "."

    def number(self, column: str) -> float:
        """A finite number.

        Raises
        ------
        ParameterError
            It is none.
        """
        value = number(self.cells[column], self.mark)
        if not math.isfinite(value):
            raise self.refused(column, "is no finite number")
        return value

    def refused(self, column: str, what: str, *, action: str = "") -> ParameterError:
        """The error of a cell."""
        place = f"{self.path}, row {self.row}, column {column}"
        return ParameterError(f"{place}: {self.cells[column]!r} {what}; {action or self.action}")


def csv_rows(path: str | Path, columns: Sequence[str], *, further: Sequence[str] = (), action: str) -> Iterator[CsvRow]:
    """The rows of a table that are not blank, one after the other: a wrong row is rejected before the next is read.

    Parameters
    ----------
    path
        UTF-8 text with a first line of the names of the columns; comma, semicolon or tab, and with the last two a
        decimal point or comma.
    columns, further
        Columns that must be there, and those that may be, in any case of letters; others are not read.
    action
        What to do where it is refused.

    Raises
    ------
    ParameterError
        The file cannot be read, is no CSV, lacks a column, or has more cells in a row than columns.
    """
    path = Path(path)
    text = plain_text(path, most_bytes=MOST_CSV_BYTES)
    separator = most_frequent_separator(text[:_HEAD])
    lines: Iterator[list[str]] = csv.reader(io.StringIO(text), delimiter=separator)
    mark = "."
    try:
        if separator != ",":
            every = list(lines)
            mark, lines = decimal_mark([chain.from_iterable(every[1:])], separator=separator), iter(every)
        yield from _rows(path, lines, columns, further, action, mark)
    except csv.Error as error:
        raise ParameterError(f"{path} is no CSV text ({error}); {action}") from error


def _rows(
    path: Path, lines: Iterator[list[str]], columns: Sequence[str], further: Sequence[str], action: str, mark: str
) -> Iterator[CsvRow]:
    head = column_names(next(lines, []), (*columns, *further))
    missing = [name for name in columns if name not in head]
    if missing:
        raise ParameterError(f"{path}, row 1: there is no column {missing[0]} among {', '.join(head)}; {action}")
    twice = [name for name in (*columns, *further) if head.count(name) > 1]
    if twice:
        raise ParameterError(f"{path}, row 1: the column {twice[0]} stands there twice; keep one of them")
    places = {name: head.index(name) for name in (*columns, *further) if name in head}
    for row, cells in enumerate(lines, start=2):
        if any(cell.strip() for cell in cells[len(head) :]):
            raise ParameterError(
                f"{path}, row {row}: {len(cells)} cells stand under {len(head)} names of columns, as a decimal comma "
                f"makes them; {action}"
            )
        if any(cell.strip() for cell in cells):
            found = {name: cells[at].strip() if at < len(cells) else "" for name, at in places.items()}
            yield CsvRow(path, row, found, action, mark)
