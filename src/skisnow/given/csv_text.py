"""Tables of users as comma-separated text: cells by column and row, every refusal with its place."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from .errors import GivenError
from .plain_file import plain_text

MOST_CSV_BYTES: Final = 1 << 26


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
    """

    path: Path
    row: int
    cells: dict[str, str]
    action: str

    def number(self, column: str) -> float:
        """A finite number.

        Raises
        ------
        GivenError
            It is none.
        """
        cell = self.cells[column]
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.refused(column, "is no finite number")
        return value

    def refused(self, column: str, what: str, *, action: str = "") -> GivenError:
        """The error of a cell."""
        place = f"{self.path}, row {self.row}, column {column}"
        return GivenError(f"{place}: {self.cells[column]!r} {what}; {action or self.action}")


def csv_rows(path: str | Path, columns: Sequence[str], *, further: Sequence[str] = (), action: str) -> list[CsvRow]:
    """The rows of a table that are not blank.

    Parameters
    ----------
    path
        UTF-8 text, comma-separated, a first line with the names of the columns.
    columns, further
        Columns that must be there, and those that may be; others are not read.
    action
        What to do where it is refused.

    Raises
    ------
    GivenError
        The file cannot be read, is no CSV, lacks a column, or has more cells in a row than columns.
    """
    path = Path(path)
    text = plain_text(path, most_bytes=MOST_CSV_BYTES)
    try:
        return list(_rows(path, csv.reader(io.StringIO(text)), columns, further, action))
    except csv.Error as error:
        raise GivenError(f"{path} is no CSV text ({error}); {action}") from error


def _rows(
    path: Path, lines: Iterator[list[str]], columns: Sequence[str], further: Sequence[str], action: str
) -> Iterator[CsvRow]:
    head = [cell.strip() for cell in next(lines, [])]
    missing = [name for name in columns if name not in head]
    if missing:
        raise GivenError(f"{path}, row 1: there is no column {missing[0]} among {', '.join(head)}; {action}")
    twice = [name for name in (*columns, *further) if head.count(name) > 1]
    if twice:
        raise GivenError(f"{path}, row 1: the column {twice[0]} stands there twice; keep one of them")
    places = {name: head.index(name) for name in (*columns, *further) if name in head}
    for row, cells in enumerate(lines, start=2):
        if any(cell.strip() for cell in cells[len(head) :]):
            raise GivenError(
                f"{path}, row {row}: {len(cells)} cells stand under {len(head)} names of columns, as a decimal comma "
                f"makes them; {action}"
            )
        if any(cell.strip() for cell in cells):
            found = {name: cells[at].strip() if at < len(cells) else "" for name, at in places.items()}
            yield CsvRow(path, row, found, action)
