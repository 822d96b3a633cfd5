"""Journals of campaigns in entry (event sourcing); each entry is on the disk before it is acknowledged.

A journal is an append-only list of entries. Readings, corrections, cancellations and undo operations are entries.
Nothing is overwritten, and `replayed` computes the current campaign from all entries.

Corrections of a campaign that is stored byte for byte are in a journal with that campaign's id. Its first entry about a
test has the cells of the file.
"""

from __future__ import annotations

import secrets
from collections.abc import Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from typing import Any, Final

from sqlalchemy import ColumnElement, Connection, Select, and_, func, insert, select
from sqlalchemy.exc import DatabaseError

from ..._support.errors import ParameterError, StoreError
from ..._support.messages import Message
from ..._support.user_files import toml_values
from .engine import database_errors, reading, savepoint, writing
from .journal_entry import DESCRIPTION, JournalEntry, NewEntry, now, parse_entry, uid_of_file, write_entry
from .rows import damage_error, require_type
from .schema import campaign, journal, journal_entry
from .store import Store

_STORED: Final = select(campaign.c.id)
_ENTERED: Final = select(journal.c.id).where(journal.c.id.not_in(_STORED))
"""Ids of stored campaigns, whose journals have corrections, and of campaigns in entry."""


class OvertakenError(StoreError):
    """There is a newer entry about the same test than the writer has seen; nothing was stored."""


@dataclass(frozen=True, slots=True)
class JournalHead:
    """Summary of a campaign in entry.

    id: 12 hexadecimal digits.
    name: name from its description; "" if missing or damaged.
    begun_at, last_at: times of the begin and of the last entry (UTC, ISO 8601).
    n_entries: number of its entries.
    """

    id: str
    name: str
    begun_at: str
    n_entries: int
    last_at: str


class Journals:
    """Reads and writes the journals of a store: append-only lists of changes to its campaigns."""

    def __init__(self, store: Store) -> None:
        self._engine = store.engine
        self._path = store.path

    def begin(self, description: str, *, who: str = "", once: str | None = None) -> str:
        """Begin a campaign with the text of its campaign.toml; return the journal's id.

        Another call with the same ``once`` returns the id of the same campaign.
        """
        id_ = secrets.token_hex(6) if once is None else sha256(once.encode()).hexdigest()[:12]
        with database_errors(self._path, "not_written"), writing(self._engine) as connection:
            if once is not None and connection.execute(select(journal.c.id).where(journal.c.id == id_)).first():
                return id_
            connection.execute(insert(journal).values(id=id_, begun_at=now()))
            entry = NewEntry(action="describe", file=DESCRIPTION, cells={DESCRIPTION: description}, who=who)
            write_entry(connection, id_, entry)
        return id_

    def list(self) -> tuple[JournalHead, ...]:
        """Summaries of the journals of all campaigns in entry, oldest first."""
        query = (
            select(
                journal.c.id,
                journal.c.begun_at,
                func.count(journal_entry.c.sequence),
                func.coalesce(func.max(journal_entry.c.at), journal.c.begun_at),
            )
            .join_from(journal, journal_entry, isouter=True)
            .where(journal.c.id.in_(_ENTERED))
            .group_by(journal.c.id)
            .order_by(journal.c.begun_at, journal.c.id)
        )
        with database_errors(self._path, "not_read"), reading(self._engine) as connection:
            rows = connection.execute(query).all()
            return tuple(_journal_head(entered_name(connection, row[0]), *row) for row in rows)

    def entries(self, id: str, *, after: int = 0) -> tuple[JournalEntry, ...]:
        """Entries of a campaign in entry with a sequence above `after`, oldest first.

        The order is that of their uids, which is the same in all stores; without synchronisation it is the order of
        writing.

        Raises StoreError: the journal is unknown.
        """
        return self._entries_after(id, after, _ENTERED)

    def corrections(self, id: str, *, after: int = 0) -> tuple[JournalEntry, ...]:
        """Entries about a campaign that is stored byte for byte, with a sequence above `after`, oldest first.

        Raises StoreError: the campaign is unknown.
        """
        return self._entries_after(id, after, _STORED)

    def _entries_after(self, id_: str, after: int, ids: Select[Any]) -> tuple[JournalEntry, ...]:
        """Entries of a campaign after number `after`, in the order of their UIDs; rejects an unknown id."""
        with database_errors(self._path, "not_read"), reading(self._engine) as connection:
            _require_id(connection, ids, id_)
            query = select(journal_entry).where(journal_entry.c.journal_id == id_, journal_entry.c.sequence > after)
            rows = connection.execute(query).mappings()
            return tuple(sorted(map(parse_entry, rows), key=lambda entry: entry.uid))

    def append(self, id: str, entry: NewEntry, *, seen: int) -> JournalEntry:
        """Write an entry, which is on the disk when this returns; an entry that was sent before is returned.

        seen: last sequence of the entry's test that the writer has seen; 0 for a new test.
        Raises OvertakenError: there is a later entry about the same test.
        Raises StoreError: the journal is unknown, or the entry to correct or undo is.
        """
        with database_errors(self._path, "not_written"), writing(self._engine) as connection:
            _require_id(connection, _ENTERED, id)
            if (earlier := _earlier_entry(connection, id, entry)) is not None:
                return earlier
            _require_current(connection, id, entry, seen)
            _require_entry_of_test(connection, id, entry)
            return write_entry(connection, id, entry)

    def correct(self, id: str, entry: NewEntry, *, seen: int, standing: Mapping[str, str]) -> JournalEntry:
        """Write a correction, cancellation or undo of a campaign that is stored byte for byte, or add an attachment.

        id: complete id of the campaign.
        entry: entry about one test; ``about`` of a correction is filled in.
        seen: as in `append`.
        standing: all cells of the test in the files, which are written before the first entry about it.
        Raises OvertakenError: there is a later entry about the same test.
        Raises StoreError: the campaign is unknown, or the entry to undo is.
        """
        with database_errors(self._path, "not_written"), writing(self._engine) as connection:
            _require_id(connection, _STORED, id)
            if (earlier := _earlier_entry(connection, id, entry)) is not None:
                return earlier
            _require_current(connection, id, entry, seen)
            if connection.execute(select(journal.c.id).where(journal.c.id == id)).first() is None:
                connection.execute(insert(journal).values(id=id, begun_at=now()))
            if entry.action != "add":  # an added photo or position is in no file
                added = journal_entry.c.action == "add"
                query = select(journal_entry.c.sequence).where(_is_about_test(id, entry), added)
                base = connection.execute(query).scalars().first()
                if base is None:
                    file, test = entry.file, entry.test
                    original = NewEntry(action="add", file=file, test=test, cells=standing, why="as the file has it")
                    base = write_entry(connection, id, original, uid=uid_of_file(id, file, test)).sequence
                entry = replace(entry, about=base) if entry.action == "correct" else entry
            _require_entry_of_test(connection, id, entry)
            return write_entry(connection, id, entry)


def _journal_head(name: str, id_: Any, begun_at: Any, n_entries: Any, last_at: Any) -> JournalHead:
    """Head of a campaign in entry from columns of the database; a damage error if one has another type."""
    try:
        require_type(n_entries, int)
        for text in (id_, begun_at, last_at):
            require_type(text, str)
    except TypeError as error:
        raise damage_error(Message("The campaign in entry {id}", id=id_)) from error
    return JournalHead(id_, name, begun_at, n_entries, last_at)


def _require_id(connection: Connection, ids: Select[Any], id_: str) -> None:
    """Raise a `StoreError` if an id is not one of those that a query selects."""
    if id_ not in set(connection.execute(ids).scalars()):
        raise StoreError("The store keeps no campaign with the id {id!r}; the list of campaigns names all.").tag(
            "unknown_id", id=id_
        )


def _is_about_test(id_: str, entry: NewEntry) -> ColumnElement[bool]:
    """SQL condition: the entry is in this campaign and about the same test."""
    columns = journal_entry.c
    return and_(columns.journal_id == id_, columns.file == entry.file, columns.test == entry.test)


def _earlier_entry(connection: Connection, id_: str, entry: NewEntry) -> JournalEntry | None:
    """Entry of the store with the same ``once``: the writer sent the new one before; None without one."""
    if entry.once is None:
        return None
    query = select(journal_entry).where(journal_entry.c.journal_id == id_, journal_entry.c.once == entry.once)
    row = connection.execute(query).mappings().first()
    return None if row is None else parse_entry(row)


def _require_current(connection: Connection, id_: str, entry: NewEntry, seen: int) -> None:
    """Raise OvertakenError if the test has a newer entry than sequence `seen`, the last that the writer has seen."""
    query = select(journal_entry).where(_is_about_test(id_, entry), journal_entry.c.sequence > seen)
    row = connection.execute(query.order_by(journal_entry.c.sequence.desc())).mappings().first()
    if row is not None:
        subject = f"{entry.file}, {entry.test}" if entry.test else entry.file
        raise OvertakenError(
            "Nothing was stored: {who} changed {subject} meanwhile ({at}). Check its present state, then enter the "
            "missing values again."
        ).tag("overtaken", who=row["who"] or Message("somebody"), subject=subject, at=row["at"])


def _require_entry_of_test(connection: Connection, id_: str, entry: NewEntry) -> None:
    """Raise a `StoreError` if the entry to correct or undo is not one about the same test."""
    if entry.about is None:
        return
    query = select(journal_entry.c.sequence).where(_is_about_test(id_, entry), journal_entry.c.sequence == entry.about)
    if connection.execute(query).first() is None:
        raise StoreError("{test} has no entry {about} that could be corrected or undone.").tag(
            "no_entry", test=entry.test, about=entry.about
        )


def entered_name(connection: Connection, journal_id: str) -> str:
    """Name in the campaign's last description; "" if missing or damaged."""
    columns = journal_entry.c
    descriptions = select(journal_entry).where(columns.journal_id == journal_id, columns.file == DESCRIPTION)
    try:
        with savepoint(connection):
            entries = [parse_entry(row) for row in connection.execute(descriptions).mappings()]
        last = max(entries, key=lambda entry: entry.uid, default=None)
        name = toml_values(last.cells[DESCRIPTION]).get("name") if last is not None else ""
    except (StoreError, ParameterError, KeyError, DatabaseError, UnicodeDecodeError):
        return ""
    return " ".join(name.split()) if isinstance(name, str) else ""
