"""The table of a study, one row for each point, and the counts of its outcomes."""

from __future__ import annotations

import csv
import io
from array import array
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import IO, Any, Final

from .._support.errors import ParameterError
from .._support.processes.kept_rows import Row
from .._support.spreadsheet_text import (
    SEPARATOR_NAMES,
    NoTextError,
    decimal_mark,
    decoded,
    most_frequent_separator,
    named_separator,
)
from .._support.units import Facts, Shown
from .._support.user_files import plain_bytes
from ..parameters import Quantity
from .rows import ROWS_OF_A_BLOCK, CsvRows, DatabaseRows, ParquetRows, StoredRows, csv_block, readers, row_of
from .writing import write_csv

MOST_ROWS_HELD: Final = 20_000
"""A table of more stays in its file, and rows are read as they are used (8 kB each in memory)."""
MOST_BYTES_HELD: Final = 1 << 24
MOST_BYTES_AT_ONCE: Final = 1 << 27
"""Largest table of another program, which is read as a whole (bytes)."""
"""Size of a CSV file; a larger one is not read at once."""
_HEAD: Final = 1 << 16
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
        Numbers, texts and switches. Of a table of more than 20,000 rows they are read from its file as they are used.
    varied
        The inputs that vary.
    counted
        Counts of the rows; None until they are requested.

    See Also
    --------
    skisnow.study
    """

    columns: tuple[str, ...]
    rows: Sequence[Row]
    varied: tuple[str, ...]
    counted: Tally | None = None

    def _repr_facts(self) -> Facts:
        counts = ", ".join(f"{outcome} {count}" for outcome, count in self.counts().items())
        rows = (("outcomes", counts), ("varied", ", ".join(self.varied)), ("columns", ", ".join(self.columns)))
        return Facts(f"of {len(self.rows)} points", rows)

    def answers(self) -> list[Row]:
        """Rows whose point could be computed."""
        return [row for row in self.rows if row["outcome"] != FAILED]

    def csv(self) -> str:
        """The table as text: numbers with all their digits, true and false, nothing if the value is missing."""
        stream = io.BytesIO()
        write_csv(stream, self.columns, ([row.get(name) for name in self.columns] for row in self.rows))
        return stream.getvalue().decode("utf-8")

    def counts(self) -> dict[str, int]:
        """Number of rows with each outcome, the most frequent first."""
        return self.tally().counts()

    def tally(self) -> Tally:
        """Outcomes, warnings and errors, counted."""
        return Tally.of(self.rows) if self.counted is None else self.counted


def read_table(path: str | Path, keys: Mapping[str, Quantity], *, varied: Sequence[str] = ()) -> StudyTable:
    """Read a study's table back.

    path: The file: CSV, or by the ending of its name SQLite or Parquet.
    keys: The study's inputs: the texts among them stay texts.
    varied: The inputs that vary.
    Raises ParameterError: it cannot be read, or is not a study's table.
    """
    path = Path(path)
    stored = stored_rows(path, keys)
    if stored is None:
        return StudyTable(*_read_at_once(path, keys), tuple(varied))
    columns, rows = stored
    _require_columns(path, columns)
    counted = Tally.of(rows)
    held = rows if len(rows) > MOST_ROWS_HELD else list(rows)
    return StudyTable(columns, held, tuple(varied), counted)


def stored_rows(
    path: Path, keys: Mapping[str, Quantity], begins: array[int] | None = None
) -> tuple[tuple[str, ...], StoredRows] | None:
    """Columns and rows that are read as they are used; None of a small CSV file, and of one of another program."""
    ending = path.suffix.lower()
    if ending in (".sqlite", ".parquet"):
        rows = DatabaseRows(path, keys) if ending == ".sqlite" else ParquetRows(path, keys)
        return rows.columns, rows
    try:
        if begins is None and path.stat().st_size <= MOST_BYTES_HELD:
            return None
        file = path.open("rb")
    except OSError as error:
        raise _unreadable_error(path, error) from error
    return large_csv(path, file, keys, begins)


def large_csv(
    path: Path, file: IO[bytes], keys: Mapping[str, Quantity], begins: array[int] | None = None
) -> tuple[tuple[str, ...], StoredRows] | None:
    """Columns and rows of a CSV file as `write_csv` writes it; None of any other, which is closed.

    file: open for reading.
    begins: as `write_csv` returned it; None: searched for.
    """
    try:
        rows = _large_csv(path, file, keys, begins)
    except BaseException:
        file.close()
        raise
    if rows is None:
        file.close()
    return rows


def _large_csv(
    path: Path, file: IO[bytes], keys: Mapping[str, Quantity], begins: array[int] | None
) -> tuple[tuple[str, ...], StoredRows] | None:
    try:
        head = file.readline().decode("utf-8")
        columns = tuple(next(csv.reader([head], strict=True)))
    except (UnicodeDecodeError, csv.Error, StopIteration):
        return None
    if not {"outcome", "study"} <= set(columns) or "\ufeff" in head:
        return None
    begins = _begins(file) if begins is None else begins
    cell_readers = readers(columns, keys, ".")
    whole = max(len(begins) - 2, 0)
    file.seek(begins[whole])
    last = csv_block(path, file.read(), columns, cell_readers, whole * ROWS_OF_A_BLOCK)
    count = whole * ROWS_OF_A_BLOCK + len(last)
    return columns, CsvRows(path, file, columns, cell_readers, begins, count)


def _begins(file: IO[bytes]) -> array[int]:
    """Start of each block of rows from the current position, and end of the last one. A text may contain line ends."""
    begins, place, rows, quotes = array("q", [file.tell()]), file.tell(), 0, 0
    for line in file:
        place += len(line)
        quotes += line.count(b'"')
        if quotes % 2 == 0:
            rows += 1
            if rows % ROWS_OF_A_BLOCK == 0:
                begins.append(place)
    if rows % ROWS_OF_A_BLOCK or quotes % 2:
        begins.append(place)
    return begins


def _read_at_once(path: Path, keys: Mapping[str, Quantity]) -> tuple[tuple[str, ...], list[Row]]:
    try:
        text = decoded(plain_bytes(path, most_bytes=MOST_BYTES_AT_ONCE)).text
        named = named_separator(text)
        separator = named if named in SEPARATOR_NAMES else most_frequent_separator(text[:_HEAD])
        stream = io.StringIO(text, newline="")
        skipped = len(stream.readline()[:1]) if named in SEPARATOR_NAMES else 0
        reader = csv.reader(stream, delimiter=str(separator))
        columns = tuple(next(reader, ()))
        _require_columns(path, columns)
        lines = [(reader.line_num + skipped, cells) for cells in reader if cells]
    except OSError as error:
        raise _unreadable_error(path, error) from error
    except (NoTextError, csv.Error) as error:
        raise ParameterError("{path} is not a table of a study: {error}").tag(
            "unknown_name", path=path, error=error
        ) from error
    mark = "." if separator == "," else decimal_mark([chain.from_iterable(row for _, row in lines)], separator=";")
    cell_readers = readers(columns, keys, mark)
    return columns, [row_of(f"{path}, line {line}", columns, cells, cell_readers) for line, cells in lines]


def _unreadable_error(path: Path, error: OSError) -> ParameterError:
    return ParameterError("{path} cannot be read: {reason}").tag(
        "cannot_read", path=path, reason=error.strerror or error
    )


def _require_columns(path: str | Path, columns: Sequence[str]) -> None:
    if not {"outcome", "study"} <= set(columns):
        raise ParameterError("{path} is not a table of a study: its first line names no columns outcome and study").tag(
            "unknown_name", path=path
        )


@dataclass(slots=True)
class Tally:
    """Counts of rows.

    outcomes: how many rows have each.
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
        for row in rows:
            tally.take(row["outcome"], row.get("warnings"), row.get("reason"), row.get("study"))
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

    def take(self, outcome: Any, warnings: Any, reason: Any, study: Any) -> None:
        """Count a row."""
        self.outcomes[str(outcome)] += 1
        if outcome == FAILED and self.first_failed is None:
            self.first_failed = (self.rows, reason)
        if warnings:
            self.warned += 1
            if self.first_warned is None:
                self.first_warned = (self.rows, warnings)
        self.studies.add(study)

    def counting(self, columns: Sequence[str], rows: Iterable[list[Any]]) -> Iterator[list[Any]]:
        """Rows as lists of the values of the columns, counted as they go by."""
        places = [columns.index(name) if name in columns else None for name in ("warnings", "reason", "study")]
        outcome = columns.index("outcome")
        for row in rows:
            self.take(row[outcome], *(None if place is None else row[place] for place in places))
            yield row
