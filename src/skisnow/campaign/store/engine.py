"""Database of the store: connections, transactions, schema of a file, error messages.

`server` opens a store on a server. In a file every connection has foreign keys switched on and waits for others, and
every commit is on the disk before it returns (``synchronous=FULL``). Each operation opens and closes a connection;
threads share none.
"""

from __future__ import annotations

import errno
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, Engine, ExceptionContext, NullPool, create_engine, event
from sqlalchemy.exc import DBAPIError

from ..._support import sqlite_file
from ..._support.errors import StoreError
from ..._support.messages import Message, template
from ..._support.sqlite_file import connect
from .schema import APPLICATION_ID, metadata
from .server import ServerAddress, StorePlace, lock_for_writing, needs_migration, open_server, reason

_DAMAGED: Final = Message("the file is damaged; restore a backup, or export the readable part")
_NO_STORE: Final = Message("this file is not a store; name another file")
_NOT_ALLOWED: Final = Message("access is not allowed; change the permissions or name another place")
_NO_TEXT: Final = "Could not decode to UTF-8"
_SYSTEM_REASONS: Final = {
    errno.ENOSPC: sqlite_file.NO_ROOM,
    errno.EDQUOT: sqlite_file.NO_ROOM,
    errno.EROFS: sqlite_file.READ_ONLY,
    errno.EACCES: _NOT_ALLOWED,
    errno.EPERM: _NOT_ALLOWED,
}


_FAILURES: Final = {
    "not_read": template("{place} could not be read: {reason}."),
    "not_written": template("{place} could not be written: {reason}."),
    "not_synchronised": template("{place} could not be synchronised: {reason}."),
    "not_stored": template("{place} could not store the campaign: {reason}."),
    "not_usable": template("{place} cannot be used as a store: {reason}."),
}
"""Template of each code of a `StoreError` from a database or file system."""


@contextmanager
def database_errors(store: StorePlace, code: str) -> Iterator[None]:
    """Convert database errors to a `StoreError` with a remedy and a code of `_FAILURES`."""
    try:
        yield
    except (DBAPIError, sqlite3.Error, UnicodeDecodeError) as error:
        store = getattr(getattr(error, "orig", None) or error, "skisnow_place", store)
        if isinstance(error, UnicodeDecodeError):  # SQLite's message contains damaged text from the schema
            why: str = _DAMAGED
        elif isinstance(store, ServerAddress):
            why = reason(error, store)
        else:
            why = _file_reason(getattr(error, "orig", error), store)
        place = Message("The store {store}", store=store)
        raise StoreError(_FAILURES[code]).tag(code, place=place, reason=why) from error


def _file_reason(error: BaseException, path: Path) -> str:
    """Reason why a store in a file cannot be used, with a remedy."""
    message, code = str(error), sqlite_file.primary_code(error)
    if code == sqlite3.SQLITE_NOTADB:
        return _NO_STORE
    if code == sqlite3.SQLITE_CORRUPT or message.startswith(_NO_TEXT):
        damage = _find_damage(path)
        return Message("{reason} ({damage})", reason=_DAMAGED, damage=damage) if damage else _DAMAGED
    return sqlite_file.place_reason(error) or message


def _find_damage(path: Path) -> str | None:
    """First damage of a store's file; None without one, and also if SQLite cannot read the file."""
    with suppress(sqlite3.Error), closing(connect(path, mode="ro")) as database:
        return sqlite_file.first_damage(database)
    return None


@contextmanager
def file_errors(place: Path, code: str) -> Iterator[None]:
    """Convert file system errors to a `StoreError` with a remedy and a code of `_FAILURES`."""
    try:
        yield
    except OSError as error:
        why = _SYSTEM_REASONS.get(error.errno or 0, error.strerror or str(error))
        raise StoreError(_FAILURES[code]).tag(code, place=error.filename or place, reason=why) from error


@contextmanager
def reading(engine: Engine) -> Iterator[Connection]:
    """Connection that reads a snapshot of the store, independent of other writers; it cannot commit."""
    with (
        engine.connect() as connection
    ):  # ended by a rollback, which works even on damaged files, where COMMIT does not
        if not is_file(connection):
            connection.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)
        yield connection


@contextmanager
def writing(engine: Engine) -> Iterator[Connection]:
    """Connection in one transaction that has the write lock from its start; it is undone after an exception."""
    with engine.connect() as connection, connection.execution_options(skisnow_begin="IMMEDIATE").begin():
        if not is_file(connection):
            lock_for_writing(connection)
        yield connection


@contextmanager
def savepoint(connection: Connection) -> Iterator[None]:
    """Savepoint: after a failure inside, the transaction stays usable; a server would abort it otherwise."""
    if is_file(connection):
        yield
    else:
        with connection.begin_nested():
            yield


def is_file(connection: Connection) -> bool:
    """True for an SQLite file, False for a server."""
    return connection.dialect.name == "sqlite"


def open_engine(place: StorePlace, *, create: bool, busy_timeout_s: float) -> Engine:
    """Connect to the database and bring its schema up to date.

    Raises StoreError: it is not a store, is from a newer program, is damaged, or cannot be written if necessary.
    """
    with database_errors(place, "not_usable"):
        if isinstance(place, ServerAddress):
            engine = open_server(place, create=create, busy_timeout_s=busy_timeout_s)
        else:
            engine = _open_file(place, create=create, busy_timeout_s=busy_timeout_s)

    def remember_place(context: ExceptionContext) -> None:  # so that messages name the right one of two stores
        context.original_exception.skisnow_place = place  # type: ignore[attr-defined]

    event.listen(engine, "handle_error", remember_place)
    return engine


def _open_file(path: Path, *, create: bool, busy_timeout_s: float) -> Engine:
    """Engine of a store's file, brought up to date; read-only folders are allowed; rejects another schema."""
    engine = _engine(path, "rwc" if create else "rw", busy_timeout_s)
    try:
        is_outdated = _is_outdated(engine, path)
    except DBAPIError as error:
        # A write-ahead log needs a file next to the store. If the folder is read-only and there is no log, no process
        # is writing, and SQLite can read the file as immutable.
        log = path.with_name(path.name + "-wal")
        forbidden = sqlite_file.primary_code(error.orig or error) in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY)
        if not forbidden or not path.exists() or (log.exists() and log.stat().st_size > 0):
            raise
        engine = _engine(path, "ro&immutable=1", busy_timeout_s)
        is_outdated = _is_outdated(engine, path)
    if is_outdated:
        _bring_up_to_date(engine, path, busy_timeout_s)
    with reading(engine) as connection:  # all tables must exist, with all columns
        database: Any = connection.connection.driver_connection
        try:
            sqlite_file.require_schema(
                database, {name: table.columns.keys() for name, table in metadata.tables.items()}
            )
        except sqlite3.DatabaseError as error:
            if sqlite_file.place_reason(error) is not None:
                raise
            raise StoreError("{path} is damaged: {error}. Put a backup in its place.").tag(
                "damaged", path=path, error=error
            ) from error
    return engine


def _engine(path: Path, mode: sqlite_file.Mode, busy_timeout_s: float) -> Engine:
    """SQLAlchemy engine whose connections use foreign keys, full synchronisation and skisnow's own BEGIN."""

    def open_file() -> sqlite3.Connection:
        connection = connect(path, mode=mode, timeout_s=busy_timeout_s)
        try:
            connection.execute("PRAGMA foreign_keys = ON")
            connection.execute("PRAGMA synchronous = FULL")
        except BaseException:
            connection.close()
            raise
        return connection

    engine = create_engine("sqlite://", creator=open_file, poolclass=NullPool)

    def begin(connection: Connection) -> None:
        # The driver's own BEGIN comes late and never before DDL; with isolation_level None it stays out of the way.
        connection.exec_driver_sql(f"BEGIN {connection.get_execution_options().get('skisnow_begin', 'DEFERRED')}")

    event.listen(engine, "begin", begin)
    return engine


def _revision(connection: Connection, path: Path) -> str | None:
    """Revision of the store; None for a file without tables."""
    tables = set(connection.exec_driver_sql("SELECT name FROM sqlite_master WHERE type = 'table'").scalars())
    if not tables - {"alembic_version"}:
        return None
    if connection.exec_driver_sql("PRAGMA application_id").scalar_one() != APPLICATION_ID:
        raise StoreError("{path} is an SQLite database of another program, not a store; name another file.").tag(
            "other_database", path=path
        )
    versions = connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalars().all()
    if len(versions) != 1 or not isinstance(versions[0], str):
        raise StoreError("{path} is damaged: its version is missing. Restore a backup.").tag("damaged", path=path)
    return versions[0]


def _is_outdated(engine: Engine, path: Path) -> bool:
    """True if the store needs a migration; StoreError if it is damaged, of another program or of an unknown schema."""
    with reading(engine) as connection:
        return needs_migration(_revision(connection, path), path)


def _bring_up_to_date(engine: Engine, path: Path, busy_timeout_s: float) -> None:
    """Create the tables of an empty store, or run the missing migrations, in one transaction."""
    from .migrations import upgrade

    _use_write_ahead_log(engine, busy_timeout_s)
    with engine.connect() as connection:
        # Some migrations rebuild tables, which foreign keys would prevent. They can only be switched off outside of a
        # transaction, and are checked before its end.
        connection.connection.cursor().execute("PRAGMA foreign_keys = OFF")
        with connection.execution_options(skisnow_begin="IMMEDIATE").begin():
            if not needs_migration(_revision(connection, path), path):
                return  # another process was faster
            upgrade(connection)
            if connection.exec_driver_sql("PRAGMA foreign_key_check").first() is not None:
                raise StoreError(
                    "{path} contains rows with invalid references; it was not changed. Restore a backup."
                ).tag("damaged", path=path)


def _use_write_ahead_log(engine: Engine, busy_timeout_s: float) -> None:
    """Switch the file to write-ahead logging, which it then keeps; SQLite does not wait for others here by itself."""
    give_up = time.monotonic() + busy_timeout_s
    while True:
        try:
            with engine.connect() as connection:
                connection.connection.cursor().execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if sqlite_file.primary_code(error) != sqlite3.SQLITE_BUSY or time.monotonic() > give_up:
                raise
        time.sleep(0.01)
