"""Rows of a large table, read from its file as they are used, and their cells from value to text and back."""

from __future__ import annotations

import csv
import io
import itertools
import json
import sqlite3
import weakref
from abc import abstractmethod
from array import array
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, Final, TypeAlias

from .._support.environment import import_extra
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.kept_rows import Row
from .._support.spreadsheet_text import protect_from_formulas, remove_protection
from .._support.sqlite_file import connect, first_damage, place_reason, require_schema, require_sound_pages
from .._support.user_files import json_value, own_json
from ..parameters import Quantity
from .points import LazySequence

ROWS_OF_A_BLOCK: Final = 1000
"""Rows that are read at once: a few megabytes."""


class StoredRows(LazySequence):
    """Rows in their order; the block that was read last is remembered."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._last: tuple[int, list[Row]] = (-1, [])

    @abstractmethod
    def block(self, number: int) -> list[Row]:
        """Rows from `number` times `ROWS_OF_A_BLOCK` on."""

    def __len__(self) -> int:
        """Number of rows."""
        return self._count

    def point(self, number: int) -> Row:
        """The row of one point."""
        block, row = divmod(number, ROWS_OF_A_BLOCK)
        if self._last[0] != block:
            self._last = (block, self.block(block))
        return self._last[1][row]

    def __iter__(self) -> Iterator[Row]:
        """Block after block."""
        for number in range(-(-self._count // ROWS_OF_A_BLOCK)):
            yield from self.block(number)


class CsvRows(StoredRows):
    """Rows of a CSV file in UTF-8.

    path: for messages.
    file: it stays open.
    columns, readers: names of the columns, and the function from cells to values.
    begins: where each block of rows begins (bytes), and where the last one ends.
    count: how many rows there are.
    """

    def __init__(
        self,
        path: Path,
        file: IO[bytes],
        columns: Sequence[str],
        readers: Sequence[Reader],
        begins: Sequence[int],
        count: int,
    ) -> None:
        super().__init__(count)
        self._path, self._file, self._columns, self._readers, self._begins = path, file, columns, readers, begins
        weakref.finalize(self, file.close)

    def block(self, number: int) -> list[Row]:
        """Rows of one block, read from the CSV file."""
        begin, end = self._begins[number : number + 2]
        self._file.seek(begin)
        return csv_block(
            self._path, self._file.read(end - begin), self._columns, self._readers, number * ROWS_OF_A_BLOCK
        )


def csv_block(path: Path, data: bytes, columns: Sequence[str], readers: Sequence[Reader], before: int) -> list[Row]:
    """The rows of some lines of a CSV file."""
    first = before + 2  # behind the names; right as long as no text has a line end
    try:
        lines = list(csv.reader(io.StringIO(data.decode("utf-8"), newline="")))
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError("{path} is not a table of a study, from about line {first} on: {error}").tag(
            "unknown_name", path=path, first=first, error=error
        ) from error
    return [row_of(f"{path}, line {number}", columns, line, readers) for number, line in enumerate(lines, start=first)]


class DatabaseRows(StoredRows):
    """Rows of the table `study` of an SQLite file, in the order of their rowid."""

    def __init__(self, path: Path, keys: Mapping[str, Quantity]) -> None:
        self._path = path
        with self._table_errors():
            self._database = connect(path, mode="ro")
        weakref.finalize(self, self._database.close)
        with self._table_errors():
            require_schema(self._database, {"study": ("outcome", "study")})
            require_sound_pages(self._database)
            declared = self._database.execute("select name, type from pragma_table_info('study')").fetchall()
            numbers = [number for (number,) in self._database.execute("select rowid from study order by rowid")]
        super().__init__(len(numbers))
        self._firsts = array("q", numbers[::ROWS_OF_A_BLOCK])
        self.columns = tuple(name for name, _ in declared)
        self._kinds = [kind for _, kind in declared]
        self._texts = [is_text(name, keys) for name in self.columns]

    @contextmanager
    def _table_errors(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, UnicodeDecodeError) as error:  # the latter where a name in the schema is not a text
            damage = first_damage(self._database) if hasattr(self, "_database") else None
            raise _table_error(self._path, place_reason(error) or damage or error) from error

    def block(self, number: int) -> list[Row]:
        """Rows of one block, read from the database."""
        query = "select * from study where rowid >= ? order by rowid limit ?"
        with self._table_errors():
            rows = self._database.execute(query, (self._firsts[number], ROWS_OF_A_BLOCK)).fetchall()
        first = number * ROWS_OF_A_BLOCK + 1
        return [self._make_row(place, row) for place, row in enumerate(rows, start=first)]

    def _make_row(self, place: int, values: Sequence[Any]) -> Row:
        try:
            row = dict(zip(self.columns, map(_as_python, values, self._kinds), strict=True))
        except ValueError as error:
            raise _table_error(self._path, f"row {place}: {error}") from error
        require_kinds(f"{self._path}, row {place}", row, self._texts)
        return row


def _table_error(path: Path, why: object) -> ParameterError:
    return ParameterError(
        "{path} cannot be read as a study's table: {reason}. Put back a copy, or remove it and run the study again"
    ).tag("cannot_read", path=path, reason=why)


def _as_python(value: Any, kind: str) -> Any:
    """Python value of a cell of the database, by the declared type of its column."""
    if value is None:
        return None
    if kind == "BOOLEAN" and value in (0, 1):
        return bool(value)
    return own_json(value) if kind == "JSON" and isinstance(value, str) else value


class ParquetRows(StoredRows):
    """Rows of a Parquet file; the row group that was read last is remembered."""

    def __init__(self, path: Path, keys: Mapping[str, Quantity]) -> None:
        parquet = require_pyarrow().parquet
        self._path = path
        with self._table_errors():
            self._file = parquet.ParquetFile(path)
            super().__init__(self._file.metadata.num_rows)
            self.columns = tuple(self._file.schema_arrow.names)
            metadata = self._file.metadata
            ends = [0]
            for group in range(metadata.num_row_groups):
                ends.append(ends[-1] + metadata.row_group(group).num_rows)
            self._groups = list(itertools.pairwise(ends))
        self._texts = [is_text(name, keys) for name in self.columns]
        self._read: tuple[int, Any] = (-1, None)

    @contextmanager
    def _table_errors(self) -> Iterator[None]:
        try:
            yield
        except (
            OSError,
            ValueError,
            TypeError,
            NotImplementedError,
            MemoryError,
        ) as error:  # and what pyarrow makes of them
            raise _table_error(self._path, " ".join(str(error).split())) from error

    def block(self, number: int) -> list[Row]:
        """Rows of one block, read from the Parquet file."""
        first = number * ROWS_OF_A_BLOCK
        last = min(first + ROWS_OF_A_BLOCK, len(self))
        rows: list[Row] = []
        for group, (begin, end) in enumerate(self._groups):
            if begin < last and end > first:
                with self._table_errors():
                    if self._read[0] != group:
                        self._read = (group, self._file.read_row_group(group))
                    rows += self._read[1].slice(max(first - begin, 0), last - max(first, begin)).to_pylist()
        for place, row in enumerate(rows, start=first + 1):
            require_kinds(f"{self._path}, row {place}", row, self._texts)
        return rows


def require_pyarrow() -> Any:
    """The library of Parquet files."""
    pyarrow, _ = (
        import_extra(module, extra="parquet", what=Message("A table in Parquet"))
        for module in ("pyarrow", "pyarrow.parquet")
    )
    return pyarrow


TEXTS: Final = ("outcome", "ski_name", "warnings", "reason", "study")
BLANK: Final = ("warnings", "reason")
"""Texts that are empty where there is nothing to say; of all others an empty cell is not a value."""

Reader: TypeAlias = Callable[[str], Any]


def cell(value: Any) -> str:
    """Numbers with all their digits, true and false, nothing if the value is missing.

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


def readers(columns: Sequence[str], keys: Mapping[str, Quantity], mark: str) -> list[Reader]:
    """Functions that convert the cells of each column; `mark` is the decimal mark."""
    return [_cell_reader(name, keys, mark) for name in columns]


def row_of(place: str, columns: Sequence[str], cells: Sequence[str], readers: Sequence[Reader]) -> Row:
    """A row by the names of its columns."""
    if len(cells) != len(columns):
        raise ParameterError(
            "{place}: a row of this table has {n_columns} cells, this line has {n_cells}. Remove the line"
        ).tag("wrong_number_of_cells", place=place, n_columns=len(columns), n_cells=len(cells))
    try:
        return {name: read(text) for name, text, read in zip(columns, cells, readers, strict=True)}
    except (ValueError, TypeError):
        name, text = next(
            (name, text) for name, text, read in zip(columns, cells, readers, strict=True) if _is_unreadable(read, text)
        )
        raise ParameterError("{place}: {name} is {text!r}; it must be a number. Correct or remove it").tag(
            "wrong_kind", place=place, name=name, text=text
        ) from None


def _is_unreadable(read: Reader, text: str) -> bool:
    try:
        read(text)
    except (ValueError, TypeError):
        return True
    return False


def is_text(name: str, keys: Mapping[str, Quantity]) -> bool:
    """True for a column of texts; all others contain numbers, switches, or lists of numbers."""
    return name in TEXTS or (name in keys and keys[name].kind == "text")


def require_kinds(place: str, row: Row, texts: Sequence[bool]) -> None:
    """Check that values of a database row are texts where marked, otherwise numbers, switches, lists or None."""
    for (name, value), text in zip(row.items(), texts, strict=True):
        if value is None or (isinstance(value, str) if text else _is_number(value)):
            continue
        if not text and isinstance(value, list) and all(map(_is_number, value)):
            continue
        kind = Message("a text") if text else Message("a number, a switch or a list of numbers")
        raise ParameterError("{place}: {name} is {value!r}. Allowed: {allowed}. Correct or remove it").tag(
            "out_of_range", place=place, name=name, value=str(value)[:80], allowed=kind
        )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)


def _cell_reader(name: str, keys: Mapping[str, Quantity], mark: str) -> Reader:
    if is_text(name, keys):
        empty = "" if name in BLANK else None
        return lambda text: remove_protection(text) if text else empty
    number = int if name in keys and keys[name].kind == "whole number" else float

    def read(text: str) -> Any:
        if text == "":
            return None
        if text[0] in "[tTfF":
            return _switch_or_list(text)
        return number(text if mark == "." else text.replace(",", "."))

    return read


def _switch_or_list(text: str) -> bool | list[float]:
    if text.startswith("["):
        return [float(number) for number in json_value(text)]
    if text.lower() not in ("true", "false"):
        raise ValueError(text)
    return text.lower() == "true"


def cells(values: Iterable[Any]) -> list[str]:
    """The cells of a row."""
    return [cell(value) for value in values]
