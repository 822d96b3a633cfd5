"""Where a store is: a file, or a database on a PostgreSQL server, whose password no message tells."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, TypeAlias

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from ..._support.errors import StoreError

_SERVER: Final = re.compile(r"(postgresql|postgres)(\+psycopg)?://", re.IGNORECASE)
_SCHEME: Final = re.compile(r"[a-z][a-z0-9+.-]+://", re.IGNORECASE)
_FORM: Final = "postgresql://USER@HOST/DATABASE"


@dataclass(frozen=True, slots=True)
class ServerAddress:
    """A database on a server; as text it is the address without the password."""

    url: URL = field(repr=False)

    def __str__(self) -> str:
        """Say where it is, to people: user, host, port and database alone."""
        host = self.url.host or _first(self.url.query.get("host"))
        user = f"{self.url.username}@" if self.url.username else ""
        port = self.url.port or _first(self.url.query.get("port"))
        return f"postgresql://{user}{host}{f':{port}' if port else ''}/{self.url.database or ''}"


StorePlace: TypeAlias = "Path | ServerAddress"


def store_place(place: Path | str | ServerAddress) -> StorePlace:
    """Where a store is, from what was given: the path of a file, or ``postgresql://USER@HOST/DATABASE``.

    Raises
    ------
    StoreError
        An address that is neither; its text, which may hold a password, is not told.

    >>> str(store_place("postgresql://ada:secret@snow.example:5433/group"))
    'postgresql://ada@snow.example:5433/group'
    """
    if isinstance(place, ServerAddress):
        return place
    if isinstance(place, Path):
        if re.match(r"postgres(ql)?:/", str(place), re.IGNORECASE):
            raise StoreError(f"The address of a server is a text, not a path: give it as {_FORM!r}.")
        return place.absolute()
    if _SERVER.match(place):
        return ServerAddress(_server_url(place))
    if _SCHEME.match(place):
        raise StoreError(f"A store is a file or {_FORM}; another kind of address was given.")
    return Path(place).absolute()


def _server_url(text: str) -> URL:
    try:
        url = make_url(text).set(drivername="postgresql+psycopg")
    except (ArgumentError, ValueError):  # what they say quotes the address
        raise StoreError(
            f"The address of the server cannot be read; it has the form {_FORM}, and what is none of A–Z, 0–9, - . _ ~ "
            "in a user's name or a password is written as % and two hexadecimal digits."
        ) from None
    if not url.database:
        raise StoreError(f"The address of the server names no database; it has the form {_FORM}.")
    return url


def _first(value: str | tuple[str, ...] | None) -> str:
    return (value if isinstance(value, str) else value[0]) if value else ""
