"""Entries as rows of the store: how one is written, and what it is called in every store that has it.

An entry's uid begins with the number that it had in the store where it was written, ten digits, and goes on with a
random part. A store's next number is above that of each entry that it holds, also of those that came from other stores:
so uids rise along whatever a writer knew (Lamport's clock), and sorting by them gives one order in all stores.
"""

from __future__ import annotations

import json
import secrets
from datetime import UTC, datetime
from hashlib import sha256
from typing import TYPE_CHECKING, Any, Final

from sqlalchemy import Connection, func, insert, select

from .entry_sums import entry_sha256, entry_sums
from .journal_entry import PLAIN, JournalEntry, NewEntry
from .rows import TIME
from .schema import journal_entry

if TYPE_CHECKING:
    from collections.abc import Sequence

NUMBER_DIGITS: Final = 10
_RANDOM_BYTES: Final = 10


def now() -> str:
    """The time in UTC (ISO 8601)."""
    return datetime.now(UTC).strftime(TIME)


def next_sequence(connection: Connection) -> int:
    """The number of the entry that is written next."""
    asked = select(func.coalesce(func.max(journal_entry.c.sequence), 0) + 1)
    return int(connection.execute(asked).scalar_one())


def new_uid(sequence: int) -> str:
    """What an entry is called that is written down with this number."""
    return f"{sequence:0{NUMBER_DIGITS}d}-{secrets.token_hex(_RANDOM_BYTES)}"


def file_uid(journal_id: str, file: str, test: str) -> str:
    """What the entry is called that says what a stored file says: the same in every store, before all others.

    >>> file_uid("0123456789ab", "shear.csv", "7")
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
    plain = {name: getattr(entry, name) for name in PLAIN}
    written = JournalEntry(**plain, cells=dict(entry.cells), at=at, sequence=sequence, uid=uid)
    insert_entries(connection, journal_id, [written])
    return written


def insert_entries(connection: Connection, journal_id: str, entries: Sequence[JournalEntry]) -> None:
    """Write entries down as they are, with their sums."""
    if entries:
        connection.execute(insert(journal_entry), [_row(journal_id, entry) for entry in entries])


def _row(journal_id: str, entry: JournalEntry) -> dict[str, Any]:
    row = {name: getattr(entry, name) for name in (*PLAIN, "sequence", "at", "uid")}
    row |= {"journal_id": journal_id, "cells": json.dumps(dict(entry.cells), ensure_ascii=False)}
    return {**row, "sha256": entry_sha256(row), "sums": entry_sums(row)}
