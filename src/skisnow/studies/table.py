"""The table of a study, one row for each point: CSV, SQLite or Parquet by the name of its file; counts of outcomes."""

from __future__ import annotations

import csv
import io
import itertools
import json
import sqlite3
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any, Final, TypeAlias

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
from .._support.sqlite_file import connect, first_damage, place_reason, require_schema, require_sound_pages
from .._support.staging import cannot_write, place_to_write
from .._support.units import Facts, Shown
from .._support.user_files import is_file, own_json, plain_bytes
from ..parameters import Quantity
from .rows import ROWS_OF_A_BLOCK, TableRows, cell, is_text, read_cells, readers, require_kinds, require_pyarrow

MOST_BYTES_AT_ONCE: Final = 1 << 27
"""Size of a CSV file; a larger one must be as skisnow writes it and is read line by line."""
_HEAD: Final = 1 << 16
FAILED = "error"
"""The outcome of a point that could not be asked."""


Writer: TypeAlias = Callable[[Path, TableRows], None]

ROWS_OF_A_GROUP: Final = 10 * ROWS_OF_A_BLOCK
"""Rows of a group of a Parquet file: some megabytes."""
_TYPES: Final[tuple[tuple[frozenset[type], str], ...]] = (
    (frozenset({bool}), "BOOLEAN"),
    (frozenset({int}), "INTEGER"),
    (frozenset({int, float}), "REAL"),
    (frozenset({list}), "JSON"),
    (frozenset({str}), "TEXT"),
)
"""Type of a column by the types of its values."""


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
        """Text of the table as CSV: numbers with all digits, true and false, empty cells for missing values."""
        return csv_text([self.columns, *([cell(row.get(name)) for name in self.columns] for row in self.rows)])

    def counts(self) -> dict[str, int]:
        """Number of rows with each outcome, the most frequent first."""
        return self.tally().counts()

    def tally(self) -> Tally:
        """Outcomes, warnings and errors, counted."""
        return Tally.of(self.rows) if self.counted is None else self.counted


def read_table(path: str | Path, keys: Mapping[str, Quantity], *, varied: Sequence[str] = ()) -> StudyTable:
    """Read a study's table from its file.

    path: The file: CSV, or by the ending of its name SQLite or Parquet.
    keys: The study's inputs: the texts among them stay texts.
    varied: The inputs that vary.
    Raises ParameterError: it cannot be read, or is not a study's table.
    """
    path = Path(path)
    read = {".sqlite": _read_database, ".parquet": _read_parquet}.get(path.suffix.lower(), _read_csv)
    rows = read(path, keys)
    return StudyTable(rows.columns, rows, tuple(varied), Tally.of(rows))


def _read_csv(path: Path, keys: Mapping[str, Quantity]) -> TableRows:
    try:
        file, separator, skipped = _open_csv(path)
        with file:
            reader = csv.reader(file, delimiter=separator)
            columns = tuple(next(reader, ()))
            _require_columns(path, columns)
            lines = ((reader.line_num + skipped, cells) for cells in reader if cells)
            mark = "."
            if separator != ",":
                every = list(lines)
                mark = decimal_mark([itertools.chain.from_iterable(row for _, row in every)], separator=";")
                lines = (pair for pair in every)
            cell_readers = readers(columns, keys, mark)
            rows = (read_cells(f"{path}, line {line}", columns, cells, cell_readers) for line, cells in lines)
            return TableRows(columns, rows)
    except OSError as error:
        raise _table_error(path, error.strerror or error) from error
    except (NoTextError, UnicodeDecodeError, csv.Error) as error:
        raise ParameterError("{path} is not a table of a study: {error}").tag(
            "unknown_name", path=path, error=error
        ) from error


def _open_csv(path: Path) -> tuple[IO[str], str, int]:
    """Text of a CSV file, its separator, and the number of skipped lines; a large file is as skisnow writes it."""
    if is_file(path) and path.stat().st_size > MOST_BYTES_AT_ONCE:
        return path.open(encoding="utf-8", newline=""), ",", 0
    text = decoded(plain_bytes(path, most_bytes=MOST_BYTES_AT_ONCE)).text
    stream, named = io.StringIO(text, newline=""), named_separator(text)
    if named in SEPARATOR_NAMES:
        return stream, str(named), len(stream.readline()[:1])
    return stream, most_frequent_separator(text[:_HEAD]), 0


def _read_database(path: Path, keys: Mapping[str, Quantity]) -> TableRows:
    """Rows of the table `study` of an SQLite file, in the order of their rowid."""
    database: sqlite3.Connection | None = None
    try:
        database = connect(path, mode="ro")
        require_schema(database, {"study": ("outcome", "study")})
        require_sound_pages(database)
        declared = database.execute("select name, type from pragma_table_info('study')").fetchall()
        kinds = [kind for _, kind in declared]
        records = database.execute("select * from study order by rowid")
        rows = (list(map(_as_python, record, kinds)) for record in records)
        return _checked_rows(path, tuple(name for name, _ in declared), rows, keys)
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the latter where a name in the schema is not a text
        damage = None if database is None else first_damage(database)
        raise _table_error(path, place_reason(error) or damage or error) from error
    finally:
        if database is not None:
            database.close()


def _as_python(value: Any, kind: str) -> Any:
    """Python value of a cell of the database, by the declared type of its column."""
    if kind == "BOOLEAN" and value in (0, 1):
        return bool(value)
    return own_json(value) if kind == "JSON" and isinstance(value, str) else value


def _read_parquet(path: Path, keys: Mapping[str, Quantity]) -> TableRows:
    parquet = require_pyarrow().parquet
    try:
        with parquet.ParquetFile(path) as file:
            batches = file.iter_batches(batch_size=ROWS_OF_A_BLOCK)
            rows = (list(row.values()) for batch in batches for row in batch.to_pylist())
            return _checked_rows(path, tuple(file.schema_arrow.names), rows, keys)
    except ParameterError:
        raise
    except (OSError, ValueError, TypeError, NotImplementedError, MemoryError) as error:  # and pyarrow's subclasses
        raise _table_error(path, " ".join(str(error).split())) from error


def _checked_rows(
    path: Path, columns: tuple[str, ...], rows: Iterable[Sequence[Any]], keys: Mapping[str, Quantity]
) -> TableRows:
    """Rows whose values are of the kinds of their columns."""
    _require_columns(path, columns)
    texts = [is_text(name, keys) for name in columns]

    def checked() -> Iterator[Sequence[Any]]:
        for number, values in enumerate(rows, start=1):
            require_kinds(f"{path}, row {number}", columns, values, texts)
            yield values

    return TableRows(columns, checked())


def _table_error(path: Path, why: object) -> ParameterError:
    return ParameterError(
        "{path} cannot be read as a study's table: {reason}. Put back a copy, or remove it and run the study again"
    ).tag("cannot_read", path=path, reason=why)


def _require_columns(path: Path, columns: Sequence[str]) -> None:
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


def write_table(path: Path, rows: TableRows) -> None:
    """Write a table of the format of its suffix; a file with its name is always complete.

    path: ends in .csv, .sqlite or .parquet.
    """
    writer_of(path)(path, rows)


def writer_of(path: Path) -> Writer:
    """Writer for the suffix of a file name."""
    ending = path.suffix.lower()
    if ending not in WRITERS:
        raise ParameterError("{path}: the name of a table ends in {writers}").tag(
            "wrong_ending", path=path, writers=list(WRITERS)
        )
    if ending == ".parquet":
        require_pyarrow()
    return WRITERS[ending]


def _write_csv(path: Path, rows: TableRows) -> None:
    with place_to_write(path) as place, place.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(rows.columns)
        writer.writerows(map(cell, values) for values in rows.values())


def _write_database(path: Path, rows: TableRows) -> None:
    named = ", ".join(f'"{name}" {kind}'.rstrip() for name, kind in _column_types(rows).items())
    marks = ", ".join("?" * len(rows.columns))
    as_sql = ([json.dumps(value) if isinstance(value, list) else value for value in row] for row in rows.values())
    with place_to_write(path) as place:
        try:
            with closing(connect(place)) as database:
                database.execute("pragma journal_mode = off")  # a file that is not complete goes away anyhow
                database.execute(f"create table study ({named})")
                database.execute("begin")
                database.executemany(f"insert into study values ({marks})", as_sql)
                database.execute("commit")
        except sqlite3.Error as error:
            raise cannot_write(path, OSError(str(error))) from error


def _write_parquet(path: Path, rows: TableRows) -> None:
    arrow = require_pyarrow()
    types = _column_types(rows)
    of_kinds = {
        "BOOLEAN": arrow.bool_(),
        "INTEGER": arrow.int64(),
        "REAL": arrow.float64(),
        "JSON": arrow.list_(arrow.float64()),
    }
    schema = arrow.schema([(name, of_kinds.get(kind, arrow.string())) for name, kind in types.items()])
    source = rows.values()
    with place_to_write(path) as place, arrow.parquet.ParquetWriter(place, schema) as writer:
        while block := list(itertools.islice(source, ROWS_OF_A_GROUP)):
            arrays = [
                arrow.array([value if kind else _as_text(value) for value in values], type=field.type)
                for values, field, kind in zip(zip(*block, strict=True), schema, types.values(), strict=True)
            ]
            writer.write_batch(arrow.record_batch(arrays, schema=schema))


def _as_text(value: Any) -> str | None:
    """Text of a value in a column that contains values of several types; None stays."""
    return value if value is None or isinstance(value, str) else cell(value)


def _column_types(rows: TableRows) -> dict[str, str]:
    """Type of each column; empty for one of several types or without values."""
    types_of_columns: list[set[type]] = [set() for _ in rows.columns]
    for values in rows.values():
        for types, value in zip(types_of_columns, values, strict=True):
            types.add(type(value))
    own = [types - {type(None)} for types in types_of_columns]
    kinds = [next((kind for allowed, kind in _TYPES if types and types <= allowed), "") for types in own]
    return dict(zip(rows.columns, kinds, strict=True))


WRITERS: Final[Mapping[str, Writer]] = {".csv": _write_csv, ".sqlite": _write_database, ".parquet": _write_parquet}
"""By the ending of the name."""
