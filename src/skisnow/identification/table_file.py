"""Small tables of measurements: CSV with units in the header's names."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .._support.csv_rows import MOST_CSV_BYTES
from .._support.errors import ParameterError
from .._support.spreadsheet_text import number
from .._support.user_files import plain_bytes
from ..parameters import Quantity
from ..track.readers.text import cells_of, decimal_mark_of, require_width, text_of

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TableFile:
    """Cells as they stand in a file.

    Attributes
    ----------
    name
        The file's, for messages.
    columns
        Names in the header.
    rows
        Line number and cells of each line that is not blank.
    header_row
        Line number of the header.
    mark
        Decimal point or comma.
    """

    name: str
    columns: tuple[str, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    header_row: int = 1
    mark: str = "."

    def require(self, columns: tuple[str, ...]) -> None:
        """Refuse a table without these columns, or without rows."""
        missing = [name for name in columns if name not in self.columns]
        if missing:
            raise ParameterError(
                f"{self.name}, row {self.header_row}: there is no column {missing[0]} among {', '.join(self.columns)}; "
                f"needed are {', '.join(columns)}"
            )
        if not self.rows:
            raise ParameterError(f"{self.name} has no rows below its header")

    def require_no_slip(self, known: tuple[str, ...]) -> None:
        """Refuse a column that is named nearly like one that is known and not there: it would not be read."""
        absent = [name for name in known if name not in self.columns]
        for name in self.columns:
            near = difflib.get_close_matches(name.lower(), absent, n=1, cutoff=0.75) if name not in known else []
            if near:
                raise ParameterError(
                    f"{self.name}, row {self.header_row}: there is a column {name}; is {near[0]} meant? Name it so, or "
                    "something quite different if it is not to be read"
                )

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

    def numbers(self, quantity: Quantity) -> FloatArray:
        """The numbers of a column, in the unit of its name; NaN where a cell may be empty and is."""
        column = quantity.name
        place = self.columns.index(column)
        found = []
        for row, cells in self.rows:
            text = cells[place] if place < len(cells) else ""
            if not text and not quantity.needed:
                found.append(math.nan)
                continue
            value = number(text, self.mark)
            if not math.isfinite(value):
                raise ParameterError(
                    f"{self.name}, row {row}, column {column}: {text!r} is no finite number; write one with a decimal "
                    f"{'comma, as others in the file' if self.mark == ',' else 'point'}, without its unit"
                )
            try:
                quantity.in_range(value)
            except ParameterError as error:
                raise ParameterError(f"{self.name}, row {row}: {error}") from None
            found.append(value)
        return np.array(found)


def read_table(path: Path) -> TableFile:
    """Read a table as spreadsheet programs write it: commas, semicolons or tabs, decimal points or commas.

    Raises
    ------
    ParameterError, FieldDataError
        The file cannot be read, is no text, or is empty.
    """
    data = plain_bytes(path, most_bytes=MOST_CSV_BYTES)
    cells = cells_of(text_of(data, str(path)), str(path))
    require_width(cells, str(path))
    mark = decimal_mark_of((cell for row in cells.rows for cell in row), cells.separator)
    return TableFile(str(path), cells.header, tuple(zip(cells.lines, cells.rows, strict=True)), cells.header_line, mark)
