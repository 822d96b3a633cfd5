"""PostgreSQL server of a group's store: connections, locks, schema, error messages.

One advisory lock makes writers wait for each other, as in SQLite. Every commit is on the server's disk before it
returns. A laptop that is closed during a transaction blocks others for at most a minute, until the server drops it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, TypeAlias

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url, text
from sqlalchemy.exc import ArgumentError

from ..._support.errors import StoreError
from ..._support.messages import Message
from .schema import APPLICATION_ID, MARK, REVISION

CONNECT_TIMEOUT_S: Final = 10
_SILENT_S: Final = 60
"""Longest silence of the other side (s), after which the connection is closed."""
_IDLE_S: Final = 300
"""Longest time (s) for which a transaction waits for its client, far longer than reading a large file."""
_CONNECTION: Final = {
    "connect_timeout": str(CONNECT_TIMEOUT_S),
    "keepalives_idle": "30",
    "keepalives_interval": "10",
    "keepalives_count": "3",
    "tcp_user_timeout": str(1000 * _SILENT_S),
    "client_encoding": "utf8",
    "application_name": "skisnow",
}

_STATES: Final = {
    "55P03": Message("another program has kept it locked for too long; wait until that one is done and try again"),
    "53100": Message("the server's disk is full; its administrator must free space"),
    "53300": Message("the server has too many connections; wait a little and try again"),
    "42501": Message("this user is not allowed to do that; the owner of the database can grant it"),
    "25006": Message("it is read-only; ask the server's administrator, or name another place"),
    "42P01": Message("a table of the store is missing; put a backup in its place"),
    "42703": Message("a column of the store is missing; put a backup in its place"),
    "25P03": Message("the server gave up waiting for this program; nothing half-written stays, do it again"),
}
_BROKEN: Final = Message("the connection to the server broke; nothing half-written stays, do it again")
_NOT_REACHED: Final = Message("the server cannot be reached; check that it runs, the network, the host and the port")
_CONNECTING: Final = (
    ("password authentication failed", Message("the user's name or the password is wrong")),
    ("no password supplied", Message("a password is wanted; put it into PGPASSWORD, or into the file ~/.pgpass")),
    (
        "no pg_hba.conf entry",
        Message("the server lets this user not in from this machine; a line of its pg_hba.conf would"),
    ),
    ("certificate", Message("the server's certificate was refused; check sslmode and sslrootcert in the address")),
    *(
        (part, _NOT_REACHED)
        for part in (
            "failed to resolve host", "could not translate host name", "Connection refused", "timeout expired",
            "No such file or directory", "timed out", "No route to host", "Network is unreachable",
        )
    ),
    *(
        (part, _BROKEN)
        for part in (
            "server closed the connection", "connection is lost", "connection is closed", "terminating connection",
        )
    ),
)  # fmt: skip
"""Parts of the driver's messages without an error code, and the texts that replace them; others stay as they are."""


def reason(error: BaseException, address: ServerAddress) -> str:
    """Reason of a database error in words, without the password."""
    cause = getattr(error, "orig", None) or error
    state = getattr(cause, "sqlstate", None)
    if state in _STATES:
        return _STATES[state]
    said = str(cause)
    if state is None or state.startswith(("08", "28", "3D", "57P")):
        for part, words in _CONNECTING:
            if part in said:
                return words
    line = next((line.strip() for line in said.splitlines() if line.strip()), type(cause).__name__)
    password = str(address.url.password or "")
    return (line.replace(password, "***") if password else line).rstrip(".")


def open_server(address: ServerAddress, *, create: bool, busy_timeout_s: float) -> Engine:
    """Connect to the database and bring its tables up to date; StoreError without psycopg or a store that it reads."""
    engine = _engine(address, busy_timeout_s)
    try:
        with engine.connect() as connection:
            encoding = connection.exec_driver_sql("SHOW server_encoding").scalar_one()
            if encoding != "UTF8":
                raise StoreError(
                    "The database {address} stores texts as {encoding}, which lacks letters; create one with: createdb "
                    "--encoding=UTF8 --template=template0 NAME"
                ).tag("wrong_encoding", address=address, encoding=encoding)
            revision = _revision(connection, address)
        if revision is None and not create:
            raise StoreError("There is no store at {address}; add a campaign first, or name another place.").tag(
                "no_store", address=address
            )
        if needs_migration(revision, address):
            _bring_up_to_date(engine, address)
    except BaseException:
        engine.dispose()
        raise
    return engine


def lock_for_writing(connection: Connection) -> None:
    """Acquire the write lock until the end of the transaction."""
    connection.execute(text("SELECT pg_advisory_xact_lock(:key)"), {"key": APPLICATION_ID})


def broken_references(connection: Connection) -> Iterator[tuple[str, str, int]]:
    """Tables with broken references: name, name of the referenced table, number of rows."""
    from sqlalchemy import and_, exists, func, select

    from .schema import metadata

    for table in metadata.sorted_tables:
        for constraint in table.foreign_key_constraints:
            parent = constraint.referred_table.alias()
            pairs = [(key.parent, parent.c[key.column.name]) for key in constraint.elements]
            held = exists().where(and_(*(here == there for here, there in pairs)))
            lost = select(func.count()).select_from(table).where(~held, and_(*(here.is_not(None) for here, _ in pairs)))
            number = connection.execute(lost).scalar_one()
            if number:
                yield table.name, constraint.referred_table.name, number


def _engine(address: ServerAddress, busy_timeout_s: float) -> Engine:
    """SQLAlchemy engine of a PostgreSQL server, with time limits per connection; StoreError without its driver."""
    defaults = {name: value for name, value in _CONNECTION.items() if name not in address.url.query}
    try:
        engine = create_engine(address.url, connect_args=defaults, pool_pre_ping=True, hide_parameters=True)
    except ModuleNotFoundError as missing:
        raise StoreError("A store on a server needs {name}; install it with: pip install 'skisnow[postgresql]'").tag(
            "not_installed", name=missing.name
        ) from None

    def set_up(connection: Any, _: object) -> None:
        connection.autocommit = True  # what is set inside a transaction ends with it
        with connection.cursor() as cursor:
            for name, value in (
                ("lock_timeout", f"{max(round(1000 * busy_timeout_s), 1)}ms"),
                ("synchronous_commit", "on"),
                ("idle_in_transaction_session_timeout", f"{_IDLE_S}s"),
                ("tcp_keepalives_idle", "30"),
                ("tcp_keepalives_interval", "10"),
                ("tcp_keepalives_count", "3"),
            ):
                cursor.execute("SELECT set_config(%s, %s, false)", (name, value))
        connection.autocommit = False

    event.listen(engine, "connect", set_up)
    return engine


def _revision(connection: Connection, address: ServerAddress) -> str | None:
    """Revision of the store; None for a database without tables."""
    query = text(
        "SELECT c.relname, obj_description(c.oid, 'pg_class') FROM pg_class c "
        "WHERE c.relnamespace = to_regnamespace(quote_ident(current_schema())) AND c.relkind IN ('r', 'p')"
    )
    tables = {row[0]: row[1] for row in connection.execute(query)}
    if not tables.keys() - {"alembic_version"}:
        return None
    if tables.get("campaign") != MARK or "alembic_version" not in tables:
        raise StoreError(
            "{address} contains tables of another program, not a store; create a separate database for the store."
        ).tag("other_database", address=address)
    versions = connection.exec_driver_sql("SELECT version_num FROM alembic_version").scalars().all()
    if len(versions) != 1:
        raise StoreError("{address} is damaged: its version is missing. Restore a backup.").tag(
            "damaged", address=address
        )
    return str(versions[0])


def needs_migration(revision: str | None, place: object) -> bool:
    """True if a store with that revision needs a migration; StoreError if this program does not know it."""
    if revision == REVISION:
        return False  # the usual case: alembic need not even be imported
    from .migrations import is_known

    if revision is not None and not is_known(revision):
        raise StoreError(
            "{place} has schema {revision}, which is unknown to this version of skisnow; it reads {known}. Update "
            "skisnow, or name another store."
        ).tag("unknown_schema", place=place, revision=revision, known=REVISION)
    return True


def _bring_up_to_date(engine: Engine, address: ServerAddress) -> None:
    """Migrate the schema under the write lock, unless another program already did."""
    from .migrations import upgrade

    with engine.begin() as connection:
        lock_for_writing(connection)
        if needs_migration(_revision(connection, address), address):  # else another program was faster
            upgrade(connection)


_SERVER: Final = re.compile(r"(postgresql|postgres)(\+psycopg)?://", re.IGNORECASE)
_SCHEME: Final = re.compile(r"[a-z][a-z0-9+.-]+://", re.IGNORECASE)
_FORM: Final = "postgresql://USER@HOST/DATABASE"


@dataclass(frozen=True, slots=True)
class ServerAddress:
    """Address of a database on a server; its text does not contain the password."""

    url: URL = field(repr=False)

    def __str__(self) -> str:
        """User, host, port and database."""
        host = self.url.host or _first_value(self.url.query.get("host"))
        user = f"{self.url.username}@" if self.url.username else ""
        port = self.url.port or _first_value(self.url.query.get("port"))
        return f"postgresql://{user}{host}{f':{port}' if port else ''}/{self.url.database or ''}"


StorePlace: TypeAlias = "Path | ServerAddress"


def store_place(place: Path | str | ServerAddress) -> StorePlace:
    """Parse the place of a store: the path of a file, or ``postgresql://USER@HOST/DATABASE``.

    Raises StoreError: the address is invalid; the message does not contain it, because it can have a password.

    >>> str(store_place("postgresql://ada:secret@snow.example:5433/group"))
    'postgresql://ada@snow.example:5433/group'
    """
    if isinstance(place, ServerAddress):
        return place
    if isinstance(place, Path):
        if re.match(r"postgres(ql)?:/", str(place), re.IGNORECASE):
            raise StoreError("The address of a server is a text, not a path: give it as {form!r}.").tag(
                "not_an_address", form=_FORM
            )
        return place.absolute()
    if _SERVER.match(place):
        return ServerAddress(_server_url(place))
    if _SCHEME.match(place):
        raise StoreError("A store is a file or {form}; another kind of address was given.").tag(
            "not_an_address", form=_FORM
        )
    return Path(place).absolute()


def _server_url(text: str) -> URL:
    """URL of a server's database; StoreError if the text is not an address or names no database."""
    try:
        url = make_url(text).set(drivername="postgresql+psycopg")
    except (ArgumentError, ValueError):  # their messages contain the address
        raise StoreError(
            "The address of the server cannot be read; it has the form {form}, and any other character than "
            "A–Z, 0–9, - . _ ~ in a user's name or a password is written as % and two hexadecimal "
            "digits."
        ).tag("not_an_address", form=_FORM) from None
    if not url.database:
        raise StoreError("The address of the server names no database; it has the form {form}.").tag(
            "no_database", form=_FORM
        )
    return url


def _first_value(value: str | tuple[str, ...] | None) -> str:
    """The text, or the first of several; "" without one."""
    return (value if isinstance(value, str) else value[0]) if value else ""
