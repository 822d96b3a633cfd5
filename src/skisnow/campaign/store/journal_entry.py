"""Entries of a journal: new and written ones, their rows in the database, and their checksums."""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from hashlib import sha256
from typing import Any, Final, Literal, TypeAlias

from sqlalchemy import Connection, RowMapping, func, insert, select

from ..._support.user_files import json_value
from .rows import TIME, entry_damage_error, require_type
from .schema import journal_entry

Action: TypeAlias = Literal["describe", "add", "correct", "cancel", "undo"]

DESCRIPTION: Final = "campaign.toml"
"""Name of the file and of the only cell of an entry with the campaign's description."""

SHARED_FIELDS: Final = ("action", "file", "test", "position", "about", "who", "why", "once")
"""Fields that an entry and its row share."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewEntry:
    """A new entry to be written.

    action: describe (all of campaign.toml), add (a row), correct (one cell of a row), cancel (a test), undo.
    file, test: the table's file and the test's name; ``""`` for a description.
    cells: texts by column.
    position: number of an added row within its test; it defines the order of the rows.
    about: sequence of the entry that is corrected or undone.
    who, why: as in corrections.csv; for a cancellation its reason.
    once: unique text of this entry from the writer; an entry that is sent again is not written twice.
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
    """A written entry.

    sequence: rising number in this store.
    at: time in UTC (ISO 8601).
    uid: identifier in all stores. Entries sorted by it have the same order everywhere, and none precedes an entry that
        its writer knew.
    """

    sequence: int
    at: str
    uid: str = ""

    @property
    def is_from_file(self) -> bool:
        """True if it has the cells of a stored file instead of entered ones."""
        return self.action == "add" and self.position is None


def parse_entry(row: RowMapping) -> JournalEntry:
    """Convert a row to an entry and verify its checksum; StoreError if the row is damaged."""
    entry = readable_entry(row)
    if row["sha256"] != entry_sha256({str(name): value for name, value in row.items()}):
        raise entry_damage_error(row["sequence"], row["journal_id"])
    return entry


def readable_entry(row: RowMapping) -> JournalEntry:
    """Entry of a row, without a check of its checksum; StoreError if a value has a wrong type."""
    values: dict[str, Any] = {name: row[name] for name in (*SHARED_FIELDS, "sequence", "at", "uid")}
    try:
        for name in ("action", "file", "test", "at", "who", "why", "uid"):
            require_type(values[name], str)
        for name in ("sequence", "position", "about"):
            if values[name] is not None or name == "sequence":
                require_type(values[name], int)
        stored_cells = json_value(require_type(row["cells"], str))
        cells = {require_type(column, str): require_type(cell, str) for column, cell in stored_cells.items()}
    except (TypeError, ValueError, AttributeError) as error:
        raise entry_damage_error(row["sequence"], row["journal_id"]) from error
    return JournalEntry(**values, cells=cells)


_SUMMED_COLUMNS: Final = (
    "sequence", "journal_id", "at", "who", "action", "file", "test", "position", "about", "why", "once", "uid",
)  # fmt: skip
"""Columns other than the cells, in the order of the checksum; additions need a migration."""


def entry_sha256(row: Mapping[str, object]) -> str:
    """SHA-256 of all fields of an entry, given by the names of its columns.

    >>> row = {name: None for name in ("at", "who", "about")} | {"sequence": 1, "cells": "{}"}
    >>> entry_sha256(row) == entry_sha256(row | {"who": ""}), len(entry_sha256(row))
    (False, 64)
    """
    digest = sha256()
    for name in (*_SUMMED_COLUMNS, "cells"):
        data = as_bytes(row.get(name))
        digest.update(b"-;" if data is None else b"%d;%b" % (len(data), data))
    return digest.hexdigest()


def as_bytes(value: object) -> bytes | None:
    """UTF-8 of the text of a value, as SQLite casts it to a BLOB; bytes and None stay."""
    if value is None or isinstance(value, bytes):
        return value
    return str(value).encode(errors="surrogatepass")


NUMBER_DIGITS: Final = 10
_RANDOM_BYTES: Final = 10


def now() -> str:
    """Current time in UTC (ISO 8601)."""
    return datetime.now(UTC).strftime(TIME)


def next_sequence(connection: Connection) -> int:
    """Largest sequence number of an entry in the store plus 1; 1 for an empty store."""
    query = select(func.coalesce(func.max(journal_entry.c.sequence), 0) + 1)
    return int(connection.execute(query).scalar_one())


def uid_of_file(journal_id: str, file: str, test: str) -> str:
    """Uid of the entry with the cells of a stored file, the same in all stores and before all others.

    >>> uid_of_file("0123456789ab", "shear.csv", "7")
    '0000000000-3e589431636df79bdf44'
    """
    said = sha256(b"\0".join(part.encode() for part in (journal_id, file, test)))
    return f"{0:0{NUMBER_DIGITS}d}-{said.hexdigest()[: 2 * _RANDOM_BYTES]}"


def number_of_uid(uid: str) -> int:
    """Sequence that an entry with this uid got in the store where it was written; 0 for one from a file."""
    digits = uid[:NUMBER_DIGITS]
    return int(digits) if digits.isdecimal() else 0


def write_entry(
    connection: Connection, journal_id: str, entry: NewEntry, *, at: str | None = None, uid: str | None = None
) -> JournalEntry:
    """Write a new entry and return it; `at` and `uid`: its time and uid (default: now, and a new one)."""
    sequence = next_sequence(connection)
    uid = uid or f"{sequence:0{NUMBER_DIGITS}d}-{secrets.token_hex(_RANDOM_BYTES)}"
    plain = {name: getattr(entry, name) for name in SHARED_FIELDS}
    written = JournalEntry(**plain, cells=dict(entry.cells), at=at or now(), sequence=sequence, uid=uid)
    insert_entries(connection, journal_id, [written])
    return written


def insert_entries(connection: Connection, journal_id: str, entries: Sequence[JournalEntry]) -> None:
    """Write entries as rows with their checksums; times, uids and sequences stay."""
    rows: list[dict[str, Any]] = []
    for entry in entries:
        row = {name: getattr(entry, name) for name in (*SHARED_FIELDS, "sequence", "at", "uid")}
        row |= {"journal_id": journal_id, "cells": json.dumps(dict(entry.cells), ensure_ascii=False)}
        rows.append({**row, "sha256": entry_sha256(row)})
    if rows:
        connection.execute(insert(journal_entry), rows)
