"""Rows of a batch on disk: kept as they come, so that an interruption at any moment keeps what was finished."""

from __future__ import annotations

import json
import sqlite3
import weakref
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Self, TypeAlias

from ..errors import OutputError, ParameterError
from ..files import cannot_write
from ..given import own_json
from .former_rows import fingerprint_of_text, rows_of_text

Row: TypeAlias = dict[str, Any]
NumberedText: TypeAlias = tuple[int, str]
"""A point's number and its row as JSON text on one line."""

_TABLES: Final = """
create table about (name text primary key, value text not null) without rowid;
create table rows (number integer primary key, row text not null);
"""
_FORM: Final = "skisnow rows 2"
_BUSY: Final = (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED)


class KeptRows:
    """The finished rows of one batch, in an SQLite file. Without a path they are only remembered.

    A row is written as soon as it is finished, and a kill at any moment loses none that `add` has taken. One process at
    a time has the file. What a computer that lost its power had not yet on its disk is computed again.

    Attributes
    ----------
    path
        The file, None: in memory.
    columns
        Where they are given a row is kept as the list of their values, half as long; what it has besides is left out.
    """

    def __init__(self, path: Path | None = None, *, columns: Sequence[str] | None = None) -> None:
        self.path = path
        self.columns = None if columns is None else tuple(columns)
        self._database = sqlite3.connect(
            ":memory:" if path is None else path, timeout=0.0, isolation_level=None, check_same_thread=False
        )
        weakref.finalize(self, self._database.close)
        if path is None:
            self._database.executescript(_TABLES)

    @classmethod
    def opened(
        cls,
        path: Path,
        fingerprint: str,
        *,
        columns: Sequence[str] | None = None,
        about: Mapping[str, str] | None = None,
    ) -> Self:
        """Open the file of a batch, or begin it; a file of the former format is brought into this one.

        Parameters
        ----------
        path
            The file; its folder is made where it is missing.
        fingerprint
            Changes with anything that the rows follow from.
        columns
            As the attribute.
        about
            What else is kept of the batch with a new file.

        Raises
        ------
        ParameterError
            The file belongs to another batch: its fingerprint differs; or it is none of rows.
        OutputError
            It cannot be written, or another run is writing it.
        """
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(path, error) from error
        kept = {"form": _FORM, "fingerprint": fingerprint, **(about or {})}
        if columns is not None:
            kept["columns"] = json.dumps(list(columns))
        if _is_text(path):
            cls._bring_over(path, kept, columns)
        return cls._begun(path, kept, columns)

    @classmethod
    def read(cls, path: Path) -> Self:
        """Open the file of a batch as it is, whatever its fingerprint.

        Raises
        ------
        ParameterError
            There is none, or it is none of rows.
        OutputError
            It cannot be opened, or another run is writing it.
        """
        if not path.is_file():
            raise ParameterError(f"{path} cannot be read: there is no such file. Check the path")
        found = cls(path)
        try:
            with _told(path):
                found._take()
                columns = found.about().get("columns")
            found.columns = None if columns is None else tuple(own_json(columns))
        except BaseException:
            found.close()
            raise
        return found

    @classmethod
    def _begun(cls, path: Path, about: Mapping[str, str], columns: Sequence[str] | None) -> Self:
        with _told(path):
            found = cls(path, columns=columns)
        try:
            with _told(path):
                found._take(about)
                kept = found.about()
            if kept["fingerprint"] != about["fingerprint"]:
                raise _another(path)
        except BaseException:
            found.close()
            raise
        return found

    @classmethod
    def _bring_over(cls, path: Path, about: Mapping[str, str], columns: Sequence[str] | None) -> None:
        """Rows of a text file go to a database beside it, which then takes its place."""
        former = fingerprint_of_text(path)
        if former is None:
            raise _damaged(path)
        if former not in ("", about["fingerprint"]):
            raise _another(path)
        beside = path.with_name(f"{path.name}.new")
        forget(beside)
        with rows_of_text(path) as rows:
            new = cls._begun(beside, about, columns)
            try:
                new.add((number, new.form(text)) for number, text in _sound(rows))
            finally:
                new.close()
            beside.replace(path)

    def _take(self, about: Mapping[str, str] | None = None) -> None:
        """Take the file for this process alone, and begin it where it is new."""
        run = self._database.execute
        run("pragma locking_mode = exclusive")  # before the log: it then needs no memory shared with other processes
        run("pragma journal_mode = wal")
        run("pragma synchronous = normal")
        run("begin exclusive")
        with self._database:  # which commits, or rolls back
            if about is not None and not run("select count(*) from sqlite_master").fetchone()[0]:
                for statement in _TABLES.split(";\n"):
                    run(statement)
                self._database.executemany("insert into about values (?, ?)", about.items())
            if self.about().get("form") != _FORM:
                raise sqlite3.DatabaseError("it has another form")

    def about(self) -> dict[str, str]:
        """What was kept of the batch when it was begun."""
        return dict(self._database.execute("select name, value from about"))

    def add(self, rows: Iterable[NumberedText]) -> int:
        """Keep rows, all of them or none: after this call a kill does not lose them. Gives their number.

        Raises
        ------
        OutputError
            The file cannot be written.
        """
        new = list(rows)
        with _told(self.path):
            self._database.execute("begin")
            with self._database:
                self._database.executemany("insert into rows values (?, ?)", new)
        return len(new)

    def form(self, text: str) -> str:
        """The row of a JSON object as it is kept."""
        return text if self.columns is None else json_text([own_json(text).get(name) for name in self.columns])

    def __len__(self) -> int:
        """How many rows are finished."""
        return int(self._database.execute("select count(*) from rows").fetchone()[0])

    def __contains__(self, number: object) -> bool:
        """Whether the row of a point is finished."""
        return self._database.execute("select 1 from rows where number = ?", (number,)).fetchone() is not None

    def numbers(self) -> Iterator[int]:
        """The finished points, in rising order."""
        return (number for (number,) in self._database.execute("select number from rows order by number"))

    def row(self, number: int) -> Row:
        """The row of a finished point."""
        ((text,),) = self._database.execute("select row from rows where number = ?", (number,)).fetchall()
        return self._row(text)

    def rows(self) -> Iterator[tuple[int, Row]]:
        """Points with their rows, in rising order."""
        return ((number, self._row(text)) for number, text in self.texts())

    def values(self) -> Iterator[list[Any]]:
        """The values of the columns of every finished point, in rising order."""
        return (own_json(text) for _, text in self.texts())

    def texts(self) -> Iterator[NumberedText]:
        """Points with their rows as they are kept, in rising order."""
        return iter(self._database.execute("select number, row from rows order by number"))

    def _row(self, text: str) -> Row:
        found = own_json(text)
        return found if self.columns is None else dict(zip(self.columns, found, strict=True))

    def close(self) -> None:
        """Leave the file for a later start."""
        self._database.close()

    def remove(self) -> None:
        """The batch is done and its rows stand elsewhere."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)  # while nobody else has it
        self.close()
        if self.path is not None:
            forget(self.path)


def forget(path: Path) -> None:
    """Remove the file of a batch, and the log of what a killed run had not yet brought into it."""
    for name in (path.name, f"{path.name}-wal", f"{path.name}-shm"):
        path.with_name(name).unlink(missing_ok=True)


def row_text(row: Row | list[Any]) -> str:
    """A row as JSON on one line."""
    return json_text(row)


def json_text(value: Any) -> str:
    """JSON on one line."""
    return json.dumps(value, ensure_ascii=True, separators=(",", ":"))


def _is_text(path: Path) -> bool:
    """Whether a file is there that is neither empty nor a database. It is not opened where it may be one in use."""
    try:
        if not path.is_file() or path.stat().st_size == 0:
            return False
    except OSError as error:
        raise cannot_write(path, error) from error
    probe = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=0.0)
    try:
        probe.execute("select count(*) from sqlite_master")
    except sqlite3.DatabaseError as error:
        return error.sqlite_errorcode == sqlite3.SQLITE_NOTADB
    finally:
        probe.close()
    return False


def _sound(rows: Iterator[NumberedText]) -> Iterator[NumberedText]:
    for number, text in rows:
        try:
            own_json(text)
        except ValueError:
            return
        yield number, text


@contextmanager
def _told(path: Path | None) -> Iterator[None]:
    """Errors of the database in words."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        place = path or Path("memory")
        code = getattr(error, "sqlite_errorcode", None)
        if code is not None and code & 0xFF in _BUSY:
            raise OutputError(
                f"{place} is being written by another run of this study. Wait for it or stop it"
            ) from None
        if isinstance(error, sqlite3.OperationalError):
            raise cannot_write(place, OSError(str(error))) from error
        raise _damaged(place) from error


def _another(path: Path) -> ParameterError:
    return ParameterError(
        f"{path} holds the finished points of another study, or of this one before its inputs, one of its files or "
        "skisnow changed. Undo the change to go on with them, or remove that file to begin anew"
    )


def _damaged(path: Path) -> ParameterError:
    return ParameterError(
        f"{path} stands where finished points are kept, and is damaged or no file of such. Remove it to begin anew, or "
        "move it away"
    )
