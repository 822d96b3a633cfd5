"""Small tables of measurements: CSV with units in the header's names."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TableFile:
    """Cells as they stand in a file.

    Attributes
    ----------
    name
        The file's, for messages.
    columns
        Names of the first line.
    rows
        Line number and cells of each line that is not blank.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]

    def require(self, columns: tuple[str, ...]) -> None:
        """Refuse a table without these columns, or without rows."""
        missing = [name for name in columns if name not in self.columns]
        if missing:
            raise ParameterError(
                f"{self.name}, row 1: there is no column {missing[0]} among {', '.join(self.columns)}; needed are "
                f"{', '.join(columns)}"
            )
        if not self.rows:
            raise ParameterError(f"{self.name} has no rows below its header")

    def texts(self, column: str) -> list[str]:
        """The cells of a column, which must not be empty."""
        place = self.columns.index(column)
        found = []
        for row, cells in self.rows:
            text = cells[place] if place < len(cells) else ""
            if not text:
                raise ParameterError(f"{self.name}, row {row}, column {column}: the cell is empty")
            found.append(text)
        return found

    def numbers(self, column: str, *, may_be_empty: bool = False) -> FloatArray:
        """The numbers of a column, NaN where a cell may be empty and is."""
        place = self.columns.index(column)
        found = []
        for row, cells in self.rows:
            text = cells[place] if place < len(cells) else ""
            if not text and may_be_empty:
                found.append(math.nan)
                continue
            try:
                number = float(text)
            except ValueError:
                number = math.nan
            if not math.isfinite(number):
                raise ParameterError(
                    f"{self.name}, row {row}, column {column}: {text!r} is no finite number; write one with a decimal "
                    "point, without its unit"
                )
            found.append(number)
        return np.array(found)


def read_table(path: Path) -> TableFile:
    """Read a table separated by commas, semicolons or tabs.

    Raises
    ------
    ParameterError
        The file cannot be read, is no text, or is empty.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ParameterError(f"{path} cannot be read: {error.strerror or error}. Check the path") from error
    except UnicodeDecodeError as error:
        raise ParameterError(f"{path} is not UTF-8 text ({error.reason}). Save it as CSV in UTF-8") from error
    lines = text.splitlines()
    if not lines or not lines[0].strip():
        raise ParameterError(f"{path} is empty, or its first line is; a header with the columns' names is needed")
    separator = max(",;\t", key=lines[0].count)
    cells = list(csv.reader(lines, delimiter=separator))
    columns = tuple(cell.strip() for cell in cells[0])
    rows = tuple(
        (number, tuple(cell.strip() for cell in line))
        for number, line in enumerate(cells[1:], start=2)
        if any(cell.strip() for cell in line)
    )
    return TableFile(str(path), columns, rows)
