"""SQLite files of skisnow: the only place that opens them, their checks, and the advice after an error."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final, Literal, TypeAlias
from urllib.parse import quote

Mode: TypeAlias = Literal["ro", "rw", "rwc", "ro&immutable=1"]
Tables: TypeAlias = "Mapping[str, Sequence[str]]"
"""Names of tables with those of their columns."""

NO_ROOM: Final = "there is no room left on the disk; free some space and try again"
READ_ONLY: Final = "it is read-only; allow writing to the file and its folder, or name another place"
_LOCKED: Final = "another program has kept it locked for too long; wait until that one is done and try again"
_DISK: Final = "the disk could not be read or written; check it and the space left on it"
_PLACE_REASONS: Final = {
    sqlite3.SQLITE_FULL: NO_ROOM,
    sqlite3.SQLITE_READONLY: READ_ONLY,
    sqlite3.SQLITE_PERM: READ_ONLY,
    sqlite3.SQLITE_BUSY: _LOCKED,
    sqlite3.SQLITE_LOCKED: _LOCKED,
    sqlite3.SQLITE_CANTOPEN: "it cannot be opened; the file and its folder must exist and be readable and writable",
    sqlite3.SQLITE_IOERR: _DISK,
}
"""Errors of the place, not of the file's content."""


def connect(place: Path | None, *, mode: Mode = "rwc", timeout_s: float = 0.0) -> sqlite3.Connection:
    """Open an SQLite file, None: a database in memory. No transaction begins automatically; threads may share it.

    Raises sqlite3.Error: the file cannot be opened; much damage shows only when it is read.
    """
    uri = ":memory:"
    if place is not None:
        name = quote(os.fsencode(place.absolute().as_posix()))
        uri = f"file://{'' if name.startswith('/') else '/'}{name}?mode={mode}"
    return sqlite3.connect(
        uri,
        uri=place is not None,
        timeout=timeout_s,
        isolation_level=None,
        check_same_thread=False,
    )


def require_schema(database: sqlite3.Connection, tables: Tables) -> None:
    """Raise a `sqlite3.DatabaseError` if one of the tables or of their columns is missing."""
    for table, columns in tables.items():
        query = "select count(*) from sqlite_master where type = 'table' and name = ?"
        if database.execute(query, (table,)).fetchone() != (1,):
            raise sqlite3.DatabaseError(f"the table {table} is missing")
        present = {name for (name,) in database.execute("select name from pragma_table_info(?)", (table,))}
        for column in columns:
            if column not in present:
                raise sqlite3.DatabaseError(f"the column {column} of the table {table} is missing")


def require_sound_pages(database: sqlite3.Connection) -> None:
    """Raise a `sqlite3.DatabaseError` if SQLite's quick check, which reads all pages once, finds damage."""
    (message,) = database.execute("pragma quick_check(1)").fetchone()
    if message != "ok":
        raise sqlite3.DatabaseError(str(message))


def primary_code(error: BaseException) -> int:
    """SQLite's result code of an error, without its extension; 0 without one."""
    code: int = getattr(error, "sqlite_errorcode", 0)
    return code & 0xFF


def place_reason(error: BaseException) -> str | None:
    """Reason in words why a file's place cannot be used, with the fix; None if the error is in the file's content."""
    return _PLACE_REASONS.get(primary_code(error))


def first_damage(database: sqlite3.Connection) -> str | None:
    """First finding of SQLite's integrity check, which takes a while, to report an error; None without a finding."""
    with suppress(sqlite3.Error, UnicodeDecodeError):
        (message,) = database.execute("pragma integrity_check(1)").fetchone()
        return None if message == "ok" else " ".join(str(message).split())
    return None
