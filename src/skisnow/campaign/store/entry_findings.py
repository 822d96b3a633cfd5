"""Search for damage in what was entered: which file, test, row and column it is in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

from sqlalchemy import Connection, LargeBinary, cast, select
from sqlalchemy.exc import DatabaseError

from ..._support.errors import StoreError
from ..._support.user_files import natural_number
from .engine import is_file
from .entry_sums import as_bytes, cells_of, differing, entry_sha256
from .finding import Finding
from .journal_entry import readable_entry
from .schema import journal_entry

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    _Row: TypeAlias = Mapping[str, bytes | None]

_LONGEST: Final = 60
_BACKUP: Final = "put a backup in its place"
_CHECKSUM: Final = "its checksum is damaged, what it says is sound"


def findings_of_entries(connection: Connection) -> Iterator[Finding]:
    """Check each entry, read as bytes: what is no text any more is named as well."""
    rows = list(_as_bytes(connection))
    places = {row["sequence"]: row["position"] for row in rows}
    for row in rows:
        about = row if row["about"] is None else {**row, "position": places.get(row["about"])}
        damage = list(_of_sums(row))
        if row["sha256"] is None or not damage:
            yield from _of_form(connection, row)
        yield from (_finding(row, _place(about, column), what) for column, what in damage)


def _as_bytes(connection: Connection) -> Iterator[_Row]:
    columns = journal_entry.c
    if is_file(connection):
        asked = select(*(cast(column, LargeBinary).label(column.name) for column in columns))
    else:
        asked = select(*columns)  # a server holds nothing in a text that is none
    for row in connection.execute(asked.order_by(columns.sequence)).mappings().all():
        yield {str(name): as_bytes(value) for name, value in row.items()}


def _of_form(connection: Connection, row: _Row) -> Iterator[Finding]:
    """What was never written down, whatever its checksum."""
    asked = select(journal_entry).where(journal_entry.c.sequence == int(_text(row["sequence"])))
    try:
        found = connection.execute(asked).mappings().first()
        if found is None:
            yield _finding(row, _place(row, None), "it is not found by its number")
        else:
            readable_entry(found)
    except StoreError as error:
        yield Finding(_text(row["journal_id"]), None, str(error))
    except (DatabaseError, UnicodeDecodeError):
        yield _finding(row, _place(row, None), "it holds what is no text")


def _of_sums(row: _Row) -> Iterator[tuple[str | None, str]]:
    """What is damaged: its column, None for the entry itself, and in words."""
    if row["sha256"] is None or row["sums"] is None:
        yield None, "it has no checksum"
        return
    is_whole = _text(row["sha256"]) == entry_sha256(row)
    parts = list(differing(row, row["sums"]))
    if is_whole and ("cells", None) in parts:
        return  # it was so when it was summed
    if is_whole == bool(parts):
        yield None, _CHECKSUM
        return
    for kind, name in parts:
        if kind == "cells" and name is not None:
            yield name, _of_cell(row, name)
        elif kind == "cells":
            yield None, "its cells cannot be read"
        elif kind == "sums":
            yield None, "neither what it says nor its checksums are as they were written down"
        else:
            yield None, f"its {name} is not what was written down; {_short(_text(row[name or '']))} stands there"


def _of_cell(row: _Row, column: str) -> str:
    text = cells_of(row).get(column)
    return "the cell is gone" if text is None else f"{_short(text)} is not what was written down"


def _place(row: _Row, column: str | None) -> str:
    """Test, row and column in words. The cells of a stored campaign say their line themselves."""
    test, position, line = _text(row["test"]), row["position"], ""
    if position is not None:
        before = natural_number(_text(position))
        line = "" if before is None else str(before + 1)
    elif column is not None and "/" in column:
        line, _, column = column.partition("/")
    named = (("test ", test), ("row ", line), ("column ", column))
    return ", ".join(word + text for word, text in named if text)


def _finding(row: _Row, place: str, what: str) -> Finding:
    number = _text(row["sequence"])
    where = f"{place}: " if place else ""
    return Finding(_text(row["journal_id"]), _text(row["file"]) or None, f"{where}{what} (entry {number}); {_BACKUP}")


def _short(text: str) -> str:
    return repr(text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…")


def _text(data: bytes | None) -> str:
    return "" if data is None else data.decode(errors="replace")
