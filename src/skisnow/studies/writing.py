"""The table of a study into its file, row after row: CSV, SQLite or Parquet by its name."""

from __future__ import annotations

import csv
import io
import itertools
import json
import sqlite3
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import IO, Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.sqlite_file import connect
from .._support.staging import cannot_write, place_to_write
from .rows import ROWS_OF_A_BLOCK, cell, cells, require_pyarrow

ValueRows: TypeAlias = Callable[[], Iterable[list[Any]]]
"""Starts at the first row with every call; each row has a value for every column."""
Writer: TypeAlias = Callable[[Path, Sequence[str], ValueRows], "array[int] | None"]

ROWS_OF_A_GROUP: Final = 10 * ROWS_OF_A_BLOCK
"""Rows of a group of a Parquet file: some megabytes."""
_DATABASE_TYPES: Final[tuple[tuple[frozenset[type], str], ...]] = (
    (frozenset({bool}), "BOOLEAN"),
    (frozenset({int}), "INTEGER"),
    (frozenset({int, float}), "REAL"),
    (frozenset({list}), "JSON"),
    (frozenset({str}), "TEXT"),
)


def write_table(path: Path, columns: Sequence[str], rows: ValueRows) -> array[int] | None:
    """Write a table; it has its name when it is complete, and else nowhere.

    path: ends in .csv, .sqlite or .parquet.
    rows: values in the order of the columns; read twice for SQLite and Parquet, whose columns have types.
    Returns: offsets in a CSV file at which each block of rows begins.
    """
    return writer_of(path)(path, columns, rows)


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


def write_csv(file: IO[bytes], columns: Sequence[str], rows: Iterable[list[Any]]) -> array[int]:
    """Write a CSV table; gives where (bytes) each block of rows begins, and where the last one ends."""
    begins, place, rows = array("q"), 0, iter(rows)
    block: list[Sequence[str]] = [columns]
    while block:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(block)
        data = text.getvalue().encode()
        file.write(data)
        place += len(data)
        begins.append(place)
        block = [cells(row) for row in itertools.islice(rows, ROWS_OF_A_BLOCK)]
    return begins


def _write_csv_file(path: Path, columns: Sequence[str], rows: ValueRows) -> array[int]:
    with place_to_write(path) as place, place.open("wb") as file:
        return write_csv(file, columns, rows())


def _write_database(path: Path, columns: Sequence[str], rows: ValueRows) -> None:
    kinds = _kinds(columns, rows())
    of_columns = (kinds[name] for name in columns)
    types = [next((name for taken, name in _DATABASE_TYPES if own and own <= taken), "") for own in of_columns]
    named = ", ".join(f'"{name}" {kind}'.rstrip() for name, kind in zip(columns, types, strict=True))
    with place_to_write(path) as place:
        try:
            _insert_rows(connect(place), named, len(columns), rows())
        except sqlite3.Error as error:
            raise cannot_write(path, OSError(str(error))) from error


def _insert_rows(database: sqlite3.Connection, named: str, count: int, rows: Iterable[list[Any]]) -> None:
    try:
        database.execute("pragma journal_mode = off")  # a file that is not complete goes away anyhow
        database.execute(f"create table study ({named})")
        database.execute("begin")
        marks = ", ".join("?" * count)
        as_sql = ([json.dumps(value) if isinstance(value, list) else value for value in row] for row in rows)
        database.executemany(f"insert into study values ({marks})", as_sql)
        database.execute("commit")
    finally:
        database.close()


def _write_parquet(path: Path, columns: Sequence[str], rows: ValueRows) -> None:
    arrow = require_pyarrow()
    kinds = _kinds(columns, rows())
    schema = arrow.schema([(name, _arrow_type(arrow, kinds[name])) for name in columns])
    mixed = [_arrow_type(arrow, kinds[name]) == arrow.string() and kinds[name] - {str} for name in columns]
    source = iter(rows())
    with place_to_write(path) as place, arrow.parquet.ParquetWriter(place, schema) as writer:
        while block := list(itertools.islice(source, ROWS_OF_A_GROUP)):
            arrays = [
                arrow.array([_as_arrow(value, text=bool(text)) for value in values], type=field.type)
                for values, field, text in zip(zip(*block, strict=True), schema, mixed, strict=True)
            ]
            writer.write_batch(arrow.record_batch(arrays, schema=schema))


def _as_arrow(value: Any, *, text: bool) -> Any:
    return cell(value) if text and value is not None and not isinstance(value, str) else value


def _arrow_type(arrow: Any, kinds: frozenset[type]) -> Any:
    for taken, kind in (
        ({bool}, arrow.bool_()),
        ({int}, arrow.int64()),
        ({int, float}, arrow.float64()),
        ({list}, arrow.list_(arrow.float64())),
    ):
        if kinds and kinds <= taken:
            return kind
    return arrow.string()


def _kinds(columns: Sequence[str], rows: Iterable[list[Any]]) -> dict[str, frozenset[type]]:
    """The types of the values of each column, without None."""
    types_of_columns: list[set[type]] = [set() for _ in columns]
    for row in rows:
        for kinds, value in zip(types_of_columns, row, strict=True):
            kinds.add(type(value))
    return {name: frozenset(kinds - {type(None)}) for name, kinds in zip(columns, types_of_columns, strict=True)}


WRITERS: Final[Mapping[str, Writer]] = {".csv": _write_csv_file, ".sqlite": _write_database, ".parquet": _write_parquet}
"""By the ending of the name."""
