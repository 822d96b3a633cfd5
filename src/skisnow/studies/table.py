"""The table of a study, one row for each point, as CSV: its cells from value to text and back."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.processes.kept_rows import Row
from .._support.spreadsheet_text import (
    SEPARATOR_NAMES,
    NoTextError,
    csv_text,
    decimal_mark,
    decoded,
    most_frequent_separator,
    named_separator,
    protect_from_formulas,
    remove_protection,
)
from .._support.units import Facts, Shown
from .._support.user_files.json_text import json_value
from .._support.user_files.text_files import plain_bytes
from ..parameters import Quantity

_MOST_BYTES: Final = 1 << 28
FAILED = "error"
"""The outcome of a point that could not be asked."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StudyTable(Shown):
    """Rows in the order of the points, each by the names of the columns; None if the value is missing.

    Attributes
    ----------
    columns
        The names, inputs first.
    rows
        Numbers, texts and switches.
    varied
        The inputs that vary.

    See Also
    --------
    skisnow.study
    """

    columns: tuple[str, ...]
    rows: Sequence[Row]
    varied: tuple[str, ...]

    def _repr_facts(self) -> Facts:
        """Title with the number of points, and rows with counts of outcomes, inputs and columns."""
        counts = ", ".join(f"{outcome} {count}" for outcome, count in self.counts().items())
        rows = (("outcomes", counts), ("varied", ", ".join(self.varied)), ("columns", ", ".join(self.columns)))
        return Facts(f"of {len(self.rows)} points", rows)

    def answers(self) -> list[Row]:
        """Rows whose point could be computed."""
        return [row for row in self.rows if row["outcome"] != FAILED]

    def csv(self) -> str:
        """Text of the table as CSV: numbers with all digits, true and false, empty cells for missing values."""
        return csv_text([self.columns, *([cell(row.get(name)) for name in self.columns] for row in self.rows)])

    def counts(self) -> dict[str, int]:
        """Number of rows with each outcome, the most frequent first."""
        counts = Counter(str(row["outcome"]) for row in self.rows)
        return dict(sorted(counts.items(), key=lambda pair: (-pair[1], pair)))


def read_table(path: str | Path, keys: Mapping[str, Quantity], *, varied: Sequence[str] = ()) -> StudyTable:
    """Read a study's table from its file.

    path: The CSV file, also one that a spreadsheet program saved with decimal commas.
    keys: The study's inputs: the texts among them stay texts.
    varied: The inputs that vary.
    Raises ParameterError: it cannot be read, or is not a study's table.
    """
    path = Path(path)
    try:
        text = decoded(plain_bytes(path, most_bytes=_MOST_BYTES)).text
        stream, named, skipped = io.StringIO(text, newline=""), named_separator(text), 0
        if named in SEPARATOR_NAMES:
            separator, skipped = str(named), len(stream.readline()[:1])
        else:
            separator = most_frequent_separator(text)
        reader = csv.reader(stream, delimiter=separator)
        columns = tuple(next(reader, ()))
        _require_columns(path, columns)
        lines = [(reader.line_num + skipped, cells) for cells in reader if cells]
    except (NoTextError, csv.Error) as error:
        raise ParameterError("{path} is not a table of a study: {error}").tag(
            "unknown_name", path=path, error=error
        ) from error
    mark = "." if separator == "," else decimal_mark([[cell for _, cells in lines for cell in cells]], separator=";")
    cell_readers = [_cell_reader(name, keys, mark) for name in columns]
    values = (read_cells(f"{path}, line {line}", columns, cells, cell_readers) for line, cells in lines)
    return StudyTable(columns, [dict(zip(columns, row, strict=True)) for row in values], tuple(varied))


def _require_columns(path: Path, columns: Sequence[str]) -> None:
    """Reject a table without the columns outcome and study."""
    if not {"outcome", "study"} <= set(columns):
        raise ParameterError("{path} is not a table of a study: its first line names no columns outcome and study").tag(
            "unknown_name", path=path
        )


TEXTS: Final = ("outcome", "ski_name", "warnings", "reason", "study")
BLANK: Final = ("warnings", "reason")
"""Texts that are empty where there is nothing to say; of all others an empty cell is not a value."""

Reader: TypeAlias = Callable[[str], Any]


def cell(value: Any) -> str:
    """Text of a value in a CSV table: all digits, true or false, empty for None; formulas are made harmless.

    >>> [cell(value) for value in (None, 0.1, 3, True, [1.0, 2.5], "=1")]
    ['', '0.1', '3', 'true', '[1.0, 2.5]', "'=1"]
    """
    kind = type(value)
    if kind is float:
        return repr(value)
    if value is None:
        return ""
    if kind is str:
        return protect_from_formulas(value)
    if kind is bool:
        return "true" if value else "false"
    if isinstance(value, list | tuple):
        return json.dumps(list(value))
    return repr(value)


def read_cells(place: str, columns: Sequence[str], cells: Sequence[str], readers: Sequence[Reader]) -> list[Any]:
    """Values of a row from its cells, one reader for each; `place` names the row in errors."""
    if len(cells) != len(columns):
        raise ParameterError(
            "{place}: a row of this table has {n_columns} cells, this line has {n_cells}. Remove the line"
        ).tag("wrong_number_of_cells", place=place, n_columns=len(columns), n_cells=len(cells))
    values = []
    for name, text, read in zip(columns, cells, readers, strict=True):
        try:
            values.append(read(text))
        except (ValueError, TypeError):
            raise ParameterError("{place}: {name} is {text!r}; it must be a number. Correct or remove it").tag(
                "wrong_kind", place=place, name=name, text=text
            ) from None
    return values


def _cell_reader(name: str, keys: Mapping[str, Quantity], mark: str) -> Reader:
    """Function that converts a cell's text to a text, number, switch or list, by the column's name."""
    if name in TEXTS or (name in keys and keys[name].kind == "text"):
        empty = "" if name in BLANK else None
        return lambda text: remove_protection(text) if text else empty
    number = int if name in keys and keys[name].kind == "whole number" else float

    def read(text: str) -> Any:
        if text == "":
            return None
        if text[0] in "[tTfF":
            if text[0] == "[":
                return [float(number) for number in json_value(text)]
            if text.lower() not in ("true", "false"):
                raise ValueError(text)
            return text.lower() == "true"
        return number(text if mark == "." else text.replace(",", "."))

    return read
