"""One entry of a journal: what is to be written down, what was, and how it is read from its row."""

from __future__ import annotations

import json
import secrets
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from hashlib import sha256
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from sqlalchemy import Connection, RowMapping, func, insert, select

from ..._support.errors import StoreError
from ..._support.user_files import json_value
from .rows import TIME, damaged, require_integer, text_of
from .schema import journal_entry

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

Action: TypeAlias = Literal["describe", "add", "correct", "cancel", "undo"]

DESCRIPTION: Final = "campaign.toml"
"""The file, and the only cell, of an entry that describes the campaign."""

SHARED_FIELDS: Final = ("action", "file", "test", "position", "about", "who", "why", "once")
"""What an entry and its row have alike."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewEntry:
    """What is to be written down.

    Attributes
    ----------
    action
        describe (the whole of campaign.toml), add (a row), correct (one cell of a row), cancel (a test), undo.
    file, test
        The table's file and the test's name; ``""`` for a description.
    cells
        Texts by column.
    position
        Place of an added row within its test; rows are given back in this order, however late one was filled in.
    about
        The sequence of the entry that is corrected or undone.
    who, why
        As corrections.csv has them; why a test was cancelled.
    once
        Any text that the writer gives to this entry alone: sent again, it is not written down a second time.
    """

    action: Action
    file: str
    test: str = ""
    cells: Mapping[str, str] = field(default_factory=dict)
    position: int | None = None
    about: int | None = None
    who: str = ""
    why: str = ""
    once: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class JournalEntry(NewEntry):
    """What was written down.

    Attributes
    ----------
    sequence
        Its number in this store, which rises.
    at
        When, in UTC (ISO 8601).
    uid
        What it is called in every store that has it; entries sorted by it are in the same order everywhere, and none
        stands before one that its writer knew.
    """

    sequence: int
    at: str
    uid: str = ""

    @property
    def is_from_file(self) -> bool:
        """Whether it says what a stored file says, and nobody entered it."""
        return self.action == "add" and self.position is None


def parse_entry(row: RowMapping) -> JournalEntry:
    """An entry from its row.

    Raises
    ------
    StoreError
        It holds what was never written there.
    """
    entry = readable_entry(row)
    if row["sha256"] != entry_sha256({str(name): value for name, value in row.items()}):
        raise _damaged(row)
    return entry


def readable_entry(row: RowMapping) -> JournalEntry:
    """An entry from its row, whether or not that is what was written down; errors as in `parse_entry`."""
    values: dict[str, Any] = {name: row[name] for name in (*SHARED_FIELDS, "sequence", "at", "uid")}
    try:
        for name in ("action", "file", "test", "at", "who", "why", "uid"):
            text_of(values[name])
        for name in ("sequence", "position", "about"):
            if values[name] is not None or name == "sequence":
                require_integer(values[name])
        cells = {text_of(column): text_of(cell) for column, cell in json_value(text_of(row["cells"])).items()}
    except (TypeError, ValueError, AttributeError) as error:
        raise _damaged(row) from error
    return JournalEntry(**values, cells=cells)


def _damaged(row: RowMapping) -> StoreError:
    return damaged(f"The entry {row['sequence']} of the campaign in entry {row['journal_id']}")


_SUMMED_COLUMNS: Final = (
    "sequence",
    "journal_id",
    "at",
    "who",
    "action",
    "file",
    "test",
    "position",
    "about",
    "why",
    "once",
    "uid",
)
"""Columns beside the cells, in the order in which they are summed; only ever added to with a migration."""


def entry_sha256(row: Mapping[str, object]) -> str:
    """The SHA-256 of all that an entry says, by the names of its columns.

    >>> row = {name: None for name in ("at", "who", "about")} | {"sequence": 1, "cells": "{}"}
    >>> entry_sha256(row) == entry_sha256(row | {"who": ""}), len(entry_sha256(row))
    (False, 64)
    """
    digest = sha256()
    for name in (*_SUMMED_COLUMNS, "cells"):
        data = as_bytes(row.get(name))
        digest.update(b"-;" if data is None else b"%d;%b" % (len(data), data))
    return digest.hexdigest()


def entry_sums(row: Mapping[str, object]) -> str:
    """A CRC-32 of each part, as JSON: they show where an entry is damaged that no longer has its SHA-256."""
    return json.dumps({"entry": _field_sums(row), "cells": _cell_sums(row)}, ensure_ascii=False)


def damaged_parts(row: Mapping[str, object], sums: bytes) -> Iterator[tuple[str, str | None]]:
    """The parts that are not what was summed: "entry" or "cells" and the column.

    With None for the column: "cells" that cannot be taken apart, "sums" that cannot be read.
    """
    try:
        stored_sums = json_value(sums.decode())
        by_kind = {kind: dict(stored_sums[kind]) for kind in ("entry", "cells")}
        if not by_kind["entry"].keys() <= row.keys():
            raise ValueError("a column that no entry has")
    except (AttributeError, ValueError, TypeError, KeyError):
        yield "sums", None
        return
    try:
        current_sums = {"entry": _field_sums(row), "cells": _cell_sums(row)}
    except ValueError:
        current_sums = {"entry": _field_sums(row), "cells": by_kind["cells"]}
        yield "cells", None
    for kind, sums_of_kind in by_kind.items():
        names = [*sums_of_kind, *(name for name in current_sums[kind] if name not in sums_of_kind)]
        yield from ((kind, name) for name in names if current_sums[kind].get(name) != sums_of_kind.get(name))


def parse_cells(row: Mapping[str, object]) -> dict[str, str]:
    """The cells of an entry as their bytes say them, what is no text in them replaced.

    Raises
    ------
    ValueError
        They cannot be taken apart.
    """
    data = as_bytes(row.get("cells")) or b""
    cells = json_value(data.decode(errors="replace"))
    if not isinstance(cells, dict) or not all(isinstance(cell, str) for cell in cells.values()):
        raise ValueError("the cells are not texts by their columns")
    return {str(column): str(cell) for column, cell in cells.items()}


def _field_sums(row: Mapping[str, object]) -> dict[str, str]:
    return {name: _crc32(as_bytes(row.get(name))) for name in _SUMMED_COLUMNS}


def _cell_sums(row: Mapping[str, object]) -> dict[str, str]:
    return {column: _crc32(cell.encode()) for column, cell in parse_cells(row).items()}


def _crc32(data: bytes | None) -> str:
    return "none" if data is None else f"{zlib.crc32(data):08x}"


def as_bytes(value: object) -> bytes | None:
    """A value as SQLite casts it to a BLOB."""
    if value is None or isinstance(value, bytes):
        return value
    return str(value).encode(errors="surrogatepass")


NUMBER_DIGITS: Final = 10
_RANDOM_BYTES: Final = 10


def now() -> str:
    """The time in UTC (ISO 8601)."""
    return datetime.now(UTC).strftime(TIME)


def next_sequence(connection: Connection) -> int:
    """The number of the entry that is written next."""
    query = select(func.coalesce(func.max(journal_entry.c.sequence), 0) + 1)
    return int(connection.execute(query).scalar_one())


def new_uid(sequence: int) -> str:
    """What an entry is called that is written down with this number."""
    return f"{sequence:0{NUMBER_DIGITS}d}-{secrets.token_hex(_RANDOM_BYTES)}"


def uid_of_file(journal_id: str, file: str, test: str) -> str:
    """What the entry is called that says what a stored file says: the same in every store, before all others.

    >>> uid_of_file("0123456789ab", "shear.csv", "7")
    '0000000000-3e589431636df79bdf44'
    """
    said = sha256(b"\0".join(part.encode() for part in (journal_id, file, test)))
    return f"{0:0{NUMBER_DIGITS}d}-{said.hexdigest()[: 2 * _RANDOM_BYTES]}"


def number_of_uid(uid: str) -> int:
    """The number that an entry had where it was written."""
    digits = uid[:NUMBER_DIGITS]
    return int(digits) if digits.isdecimal() else 0


def write_entry(
    connection: Connection, journal_id: str, entry: NewEntry, *, at: str | None = None, uid: str | None = None
) -> JournalEntry:
    """Write a new entry down; ``at`` and ``uid`` where they are not to be of now."""
    sequence = next_sequence(connection)
    return insert_entry(connection, journal_id, entry, sequence, at or now(), uid or new_uid(sequence))


def insert_entry(
    connection: Connection, journal_id: str, entry: NewEntry, sequence: int, at: str, uid: str
) -> JournalEntry:
    """Write an entry down under a number and a uid."""
    plain = {name: getattr(entry, name) for name in SHARED_FIELDS}
    written = JournalEntry(**plain, cells=dict(entry.cells), at=at, sequence=sequence, uid=uid)
    insert_entries(connection, journal_id, [written])
    return written


def insert_entries(connection: Connection, journal_id: str, entries: Sequence[JournalEntry]) -> None:
    """Write entries down as they are, with their sums."""
    if entries:
        connection.execute(insert(journal_entry), [_row(journal_id, entry) for entry in entries])


def _row(journal_id: str, entry: JournalEntry) -> dict[str, Any]:
    row = {name: getattr(entry, name) for name in (*SHARED_FIELDS, "sequence", "at", "uid")}
    row |= {"journal_id": journal_id, "cells": json.dumps(dict(entry.cells), ensure_ascii=False)}
    return {**row, "sha256": entry_sha256(row), "sums": entry_sums(row)}
