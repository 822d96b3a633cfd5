"""The table of a study into its file: CSV, SQLite or Parquet by its name."""

from __future__ import annotations

import csv
import itertools
import json
import sqlite3
from collections.abc import Callable, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any, Final, TypeAlias

from .._support.errors import ParameterError
from .._support.sqlite_file import connect
from .._support.staging import cannot_write, place_to_write
from .rows import ROWS_OF_A_BLOCK, TableRows, cell, require_pyarrow

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


def write_table(path: Path, rows: TableRows) -> None:
    """Write a table; it has its name when it is complete, and else nowhere.

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
    """Text of a value in a column of several types."""
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
