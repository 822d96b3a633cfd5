"""Rows of a batch on disk, each written when it is finished, so that an interruption loses none of them."""

from __future__ import annotations

import json
import sqlite3
import weakref
import zlib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Self, TypeAlias

from ..errors import OutputError, ParameterError
from ..messages import Message
from ..sqlite_file import connect, first_damage, place_reason, primary_code, require_sound_pages
from ..staging import cannot_write
from ..user_files.json_text import own_json

Row: TypeAlias = dict[str, Any]
"""Values of a point by name; a study keeps a list of values, whose names are an entry of the batch."""
NumberedText: TypeAlias = tuple[int, str]
"""A point's number and its row as JSON text on one line."""

_TABLES: Final = """
create table about (name text primary key, value text not null) without rowid;
create table rows (number integer primary key, row text not null, checksum integer not null);
"""
_FORM: Final = "skisnow rows 3"
_CHECKSUM: Final = "checksum"
"""Name in the table `about` of the checksum of all its other rows."""


class KeptRows:
    """Finished rows of one batch in an SQLite file; in memory without a path.

    Each row is written as soon as it is finished. A kill at any moment loses no row that `add` has accepted. Only one
    process at a time has the file open. After a power failure, rows that had not reached the disk are computed again.

    Every row has a checksum. The schema and the pages are checked at each opening, a checksum when its row is read: a
    damaged file is an error that names it, whatever is damaged in it.

    path: the file, None: in memory.
    """

    def __init__(self, path: Path | None = None) -> None:
        self.path = path
        self._database = connect(path)
        weakref.finalize(self, self._database.close)
        if path is None:
            self._database.executescript(_TABLES)

    @classmethod
    def opened(cls, path: Path, fingerprint: str, *, about: Mapping[str, str] | None = None) -> Self:
        """Open the file of a batch, or create it; ParameterError if it has another fingerprint.

        fingerprint: hash of everything that determines the rows.
        about: further entries by name that describe the batch, for a new file.
        """
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(path, error) from error
        return cls._locked(path, {"form": _FORM, "fingerprint": fingerprint, **(about or {})})

    @classmethod
    def read(cls, path: Path) -> Self:
        """Open the file of a batch as it is, whatever its fingerprint."""
        if not path.is_file():
            raise ParameterError("{path} cannot be read: the file does not exist. Check the path.").tag(
                "cannot_read", path=path
            )
        return cls._locked(path)

    @classmethod
    def _locked(cls, path: Path, about: Mapping[str, str] | None = None) -> Self:
        """Open and lock a file; with `about` a new one is created, and an existing one must have its fingerprint."""
        with _errors(path):
            rows = cls(path)
        try:
            with _errors(path, rows._database):
                rows._lock_and_begin(about)
                entries = rows.about()
            if about is not None and entries["fingerprint"] != about["fingerprint"]:
                raise ParameterError(
                    "{path} contains the finished points of another study, or of this one before its inputs, one of "
                    "its files or skisnow changed. Undo the change to continue them, or remove that file to start "
                    "again."
                ).tag("another_study", path=path)
        except BaseException:
            rows.close()
            raise
        return rows

    def _lock_and_begin(self, about: Mapping[str, str] | None = None) -> None:
        """Lock the file for this process, write tables and `about` if it is new, and check the form of an older one."""
        run = self._database.execute
        run("pragma locking_mode = exclusive")  # before the log: it then needs no memory shared with other processes
        run("pragma journal_mode = wal")
        run("pragma synchronous = normal")
        run("begin exclusive")
        with self._database:  # which commits, or rolls back
            if about is not None and not run("select count(*) from sqlite_master").fetchone()[0]:
                for statement in _TABLES.split(";\n"):
                    run(statement)
                whole = {**about, _CHECKSUM: _checksum_of(about)}
                self._database.executemany("insert into about values (?, ?)", whole.items())
            empty = KeptRows()
            if _statements(self._database) != _statements(empty._database):
                raise sqlite3.DatabaseError("it has other tables")
            if self.about().get("form") != _FORM:
                raise sqlite3.DatabaseError("it has another form")
            require_sound_pages(self._database)

    def about(self) -> dict[str, str]:
        """Entries that describe the batch, such as its fingerprint, by name."""
        entries = dict(self._run_query("select name, value from about"))
        if entries.pop(_CHECKSUM, None) != _checksum_of(entries):
            raise _damage_error(self.path, Message("the description of the batch has changed"))
        return entries

    def add(self, rows: Iterable[NumberedText]) -> int:
        """Store rows, all or none, so that a kill does not lose them; return their number."""
        new = list(rows)
        with _errors(self.path, self._database):
            self._database.execute("begin")
            with self._database:
                self._database.executemany(
                    "insert into rows values (?, ?, ?)",
                    ((number, text, _checksum(number, text)) for number, text in new),
                )
        return len(new)

    def __len__(self) -> int:
        """Number of finished rows."""
        ((count,),) = self._run_query("select count(*) from rows")
        return int(count)

    def __contains__(self, number: object) -> bool:
        """True if the row of a point is finished."""
        return bool(list(self._run_query("select 1 from rows where number = ?", number)))

    def numbers(self) -> Iterator[int]:
        """Numbers of the finished points, in rising order."""
        return (number for (number,) in self._run_query("select number from rows order by number"))

    def row(self, number: int) -> Row:
        """Values of the finished point with this number; a ParameterError if its row was changed."""
        ((_, text),) = self._select_checked_rows("where number = ?", number)
        row: Row = own_json(text)
        return row

    def rows(self) -> Iterator[tuple[int, Any]]:
        """Numbers of the finished points with their rows, in rising order."""
        return ((number, own_json(text)) for number, text in self.texts())

    def texts(self) -> Iterator[NumberedText]:
        """Numbers of the finished points with their rows as JSON text, in rising order."""
        return self._select_checked_rows("order by number")

    def _select_checked_rows(self, which: str, *parameters: object) -> Iterator[NumberedText]:
        """Numbers and JSON texts of rows chosen by SQL; a damage error if a checksum does not match."""
        for number, text, checksum in self._run_query(f"select number, row, checksum from rows {which}", *parameters):
            if not isinstance(text, str) or checksum != _checksum(number, text):
                raise _damage_error(self.path, Message("the row of point {point} has changed", point=number + 1))
            yield number, text

    def _run_query(self, query: str, *parameters: object) -> Iterator[tuple[Any, ...]]:
        """Records of a query one by one; errors of the database become those of the file."""
        with _errors(self.path, self._database):
            # `yield from` closes the cursor, which fails behind a closed database
            for record in self._database.execute(query, parameters):  # noqa: UP028
                yield record

    def close(self) -> None:
        """Close the file so that a later start can continue it."""
        self._database.close()

    def remove(self) -> None:
        """Close and delete the file of a completed batch whose rows were written elsewhere."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)  # while no one else has it
        self.close()
        if self.path is not None:
            forget(self.path)


def forget(path: Path) -> None:
    """Delete the file of a batch, and SQLite's auxiliary files that a killed run left."""
    for name in (path.name, f"{path.name}-wal", f"{path.name}-shm"):
        path.with_name(name).unlink(missing_ok=True)


def json_text(value: Any) -> str:
    """A value, such as a row, as JSON on one line."""
    return json.dumps(value, ensure_ascii=True, separators=(",", ":"))


def _statements(database: sqlite3.Connection) -> list[tuple[str, str]]:
    """Names of all tables of a database with the SQL statements that created them."""
    return database.execute("select name, sql from sqlite_master where sql is not null order by name").fetchall()


def _checksum(number: int, text: str) -> int:
    """CRC-32 of a point's number and the JSON text of its row."""
    return zlib.crc32(f"{number} {text}".encode("utf-8", "surrogatepass"))


def _checksum_of(about: Mapping[str, object]) -> str:
    """CRC-32, as text, of the values that describe the points."""
    return str(zlib.crc32(repr(sorted(about.items(), key=str)).encode("utf-8", "surrogatepass")))


@contextmanager
def _errors(path: Path | None, database: sqlite3.Connection | None = None) -> Iterator[None]:
    """Convert database errors in the block to errors of skisnow that name the file and the remedy."""
    try:
        yield
    except (sqlite3.DatabaseError, UnicodeDecodeError) as error:  # the latter where a name in the schema is not a text
        if primary_code(error) in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            raise OutputError("{path} is being written by another run of this study. Wait for it or stop it.").tag(
                "in_use", path=path
            ) from None
        if place_reason(error) is not None:
            raise cannot_write(path or Path("memory"), OSError(str(error))) from error
        damage = None if database is None else first_damage(database)
        raise _damage_error(path, Message("{reason}", reason=damage or error)) from error


def _damage_error(path: Path | None, why: Message) -> ParameterError:
    """Error that a file of finished points is damaged or something else, with the reason."""
    return ParameterError(
        "{path} is damaged, or it is not a file of finished points: {reason}. Remove it to compute its points again, "
        "or move it away."
    ).tag("damaged", path=path, reason=why)
