"""Mutations of SQLite files: pages, and by statements cells, rows, columns, tables and the file's own numbers."""

import sqlite3
import tempfile
from contextlib import closing, suppress
from pathlib import Path
from random import Random
from typing import Final

from .binaries import bits, block, field
from .texts import Mutation

_VALUES: Final = (
    "NULL", "0", "-1", "1", "1e308", "-1e308", "9e999", "9223372036854775807", "-9223372036854775808", "1000000000",
    "''", "'x'", "'[]'", "'{}'", "'null'", "'nan'", "'[1e999]'", "x''", "x'00ff'", "CAST(x'ff' AS TEXT)",
    "zeroblob(5000000)", "'['||hex(zeroblob(50000))", "'2026-13-45'", "replace(hex(zeroblob(3000)),'0','[')", "'\"'",
    "'{\"a\":NaN}'", "CAST(x'2200' AS TEXT)", "-5", "2.5",
)  # fmt: skip
_PAGE: Final = 4096


def statements(rng: Random, data: bytes) -> bytes:
    """One to three changes by SQL; of what SQLite cannot open, of its bytes."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "x.sqlite"
        place.write_bytes(data)
        try:
            with closing(sqlite3.connect(place, isolation_level=None)) as database:
                database.execute("pragma journal_mode = delete")
                for _ in range(rng.randrange(1, 4)):
                    _change(rng, database)
        except (sqlite3.Error, UnicodeDecodeError):
            return bits(rng, data)
        return place.read_bytes()


def _change(rng: Random, database: sqlite3.Connection) -> None:
    tables = [name for (name,) in database.execute("select name from sqlite_master where type = 'table' order by name")]
    if not tables:
        return
    table = rng.choice(tables)
    columns = [name for _, name, *_ in database.execute(f'pragma table_info("{table}")')]
    column, other, value = rng.choice(columns), rng.choice(columns), rng.choice(_VALUES)
    one_row = f'where rowid = (select rowid from "{table}" order by rowid limit 1 offset {rng.randrange(5)})'
    each_row = rng.choice(("", one_row, one_row)) if _has_rowid(database, table) else ""
    kinds = (
        f'update or ignore "{table}" set "{column}" = {value} {each_row}',
        f'update or ignore "{table}" set "{column}" = {value} {each_row}',
        f'update or ignore "{table}" set "{column}" = substr("{column}", 2) {each_row}',
        f'update or ignore "{table}" set "{column}" = "{other}" {each_row}',
        f'delete from "{table}" {each_row}',
        f'insert or ignore into "{table}" select * from "{table}"',
        f'alter table "{table}" rename to "{table}x"',
        f'alter table "{table}" rename column "{column}" to "{column}x"',
        f'alter table "{table}" drop column "{column}"',
        f'alter table "{table}" add column extra',
        f'drop table "{table}"',
        f"pragma user_version = {rng.choice((0, 1, 99, -1))}",
        f"pragma application_id = {rng.choice((0, 1, -1))}",
        f'create view "{table}y" as select * from "{table}"; drop table "{table}"',
    )
    with suppress(sqlite3.Error):
        database.execute("pragma foreign_keys = off")
        database.execute("pragma ignore_check_constraints = on")
        database.executescript(rng.choice(kinds))


def _has_rowid(database: sqlite3.Connection, table: str) -> bool:
    try:
        database.execute(f'select rowid from "{table}" limit 1')
    except sqlite3.Error:
        return False
    return True


def schema(rng: Random, data: bytes) -> bytes:
    """The text of the schema is changed where it is stored."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "x.sqlite"
        place.write_bytes(data)
        change = rng.choice((
            "update sqlite_master set rootpage = rootpage + 1",
            "update sqlite_master set rootpage = 2 where type = 'table'",
            "update sqlite_master set sql = replace(sql, 'TEXT', 'BLOB')",
            "update sqlite_master set sql = substr(sql, 1, 30)",
            "update sqlite_master set sql = replace(sql, ',', ', x,')",
            "update sqlite_master set name = 'x' where type = 'index'",
            "delete from sqlite_master where type = 'index'",
            "update sqlite_master set sql = CAST(x'ff' AS TEXT)",
        ))  # fmt: skip
        try:
            with closing(sqlite3.connect(place, isolation_level=None)) as database:
                database.execute("pragma writable_schema = on")
                database.execute(change)
        except (sqlite3.Error, UnicodeDecodeError):
            return bits(rng, data)
        return place.read_bytes()


def page(rng: Random, data: bytes) -> bytes:
    """A piece of one page changes: its head, its list of cells, or its contents."""
    pages = max(1, len(data) // _PAGE)
    number = rng.randrange(pages)
    at = number * _PAGE + (100 if number == 0 else 0) + rng.choice((0, 3, 5, 8, 12, rng.randrange(_PAGE)))
    size = rng.choice((1, 1, 2, 4))
    return data[:at] + rng.randbytes(size) + data[at + size :]


def whole_pages(rng: Random, data: bytes) -> bytes:
    """A page is zero, doubled, swapped with another, or missing with all behind it."""
    pages = max(1, len(data) // _PAGE)
    one, other = rng.randrange(pages), rng.randrange(pages)
    parts = [data[_PAGE * number : _PAGE * (number + 1)] for number in range(pages)]
    how = rng.randrange(4)
    if how == 0:
        parts[one] = bytes(_PAGE)
    elif how == 1:
        parts[one] = parts[other]
    elif how == 2:
        parts[one], parts[other] = parts[other], parts[one]
    else:
        del parts[max(1, one) :]
    return b"".join(parts)


SQLITE: Final[tuple[Mutation, ...]] = (statements,) * 6 + (page, page, page, schema, whole_pages, bits, field, block)
