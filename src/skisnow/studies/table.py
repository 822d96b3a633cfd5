"""The table of a study, one row for each point, as CSV; counts of outcomes."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

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
)
from .._support.units import Facts, Shown
from .._support.user_files import plain_bytes
from ..parameters import Quantity
from .cells import cell, read_cells, readers

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
        return self.tally().counts()

    def tally(self) -> Tally:
        """Counts of outcomes, warnings and errors over the rows."""
        return Tally.of(self.rows)


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
    except OSError as error:
        raise _table_error(path, error.strerror or error) from error
    except (NoTextError, csv.Error) as error:
        raise ParameterError("{path} is not a table of a study: {error}").tag(
            "unknown_name", path=path, error=error
        ) from error
    mark = "." if separator == "," else decimal_mark([[cell for _, cells in lines for cell in cells]], separator=";")
    cell_readers = readers(columns, keys, mark)
    values = (read_cells(f"{path}, line {line}", columns, cells, cell_readers) for line, cells in lines)
    return StudyTable(columns, [dict(zip(columns, row, strict=True)) for row in values], tuple(varied))


def _table_error(path: Path, why: object) -> ParameterError:
    """Error for a table of a study that cannot be read."""
    return ParameterError(
        "{path} cannot be read as a study's table: {reason}. Put back a copy, or remove it and run the study again"
    ).tag("cannot_read", path=path, reason=why)


def _require_columns(path: Path, columns: Sequence[str]) -> None:
    """Reject a table without the columns outcome and study."""
    if not {"outcome", "study"} <= set(columns):
        raise ParameterError("{path} is not a table of a study: its first line names no columns outcome and study").tag(
            "unknown_name", path=path
        )


@dataclass(slots=True)
class Tally:
    """Counts of the rows of a table by outcome, warnings and errors.

    outcomes: number of rows by outcome.
    warned: how many carry warnings.
    first_failed, first_warned: number, 1 or more, and text of the first row that could not be computed, and of the
        first with warnings.
    studies: fingerprints of the studies of the rows.
    """

    outcomes: Counter[str] = field(default_factory=Counter)
    warned: int = 0
    first_failed: tuple[int, str] | None = None
    first_warned: tuple[int, str] | None = None
    studies: set[Any] = field(default_factory=set)

    @classmethod
    def of(cls, rows: Iterable[Mapping[str, Any]]) -> Tally:
        """Tally of rows by names."""
        tally = cls()
        for number, row in enumerate(rows, start=1):
            tally.outcomes[str(row["outcome"])] += 1
            tally.studies.add(row.get("study"))
            if row["outcome"] == FAILED and tally.first_failed is None:
                tally.first_failed = (number, str(row.get("reason")))
            if warnings := row.get("warnings"):
                tally.warned += 1
                tally.first_warned = tally.first_warned or (number, warnings)
        return tally

    @property
    def rows(self) -> int:
        """Number of counted rows."""
        return self.outcomes.total()

    @property
    def failed(self) -> int:
        """Number of rows that could not be computed."""
        return self.outcomes[FAILED]

    def counts(self) -> dict[str, int]:
        """Number of rows with each outcome, the most frequent first."""
        return dict(sorted(self.outcomes.items(), key=lambda pair: (-pair[1], pair)))
