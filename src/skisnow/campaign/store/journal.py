"""Journals of campaigns in entry (event sourcing): entries, their rows in the database, and their checksums.

A journal is an append-only list of entries. Readings, corrections, cancellations and undo operations are entries.
Nothing is overwritten, and `replayed` computes the current campaign from all entries. Each entry is on the disk before
it is acknowledged.

Corrections of a campaign that is stored byte for byte are in a journal with that campaign's id. Its first entry about a
test has the cells of the file.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from hashlib import sha256
from typing import Any, Final, Literal, Protocol, TypeAlias

from sqlalchemy import ColumnElement, Connection, Engine, RowMapping, Select, and_, func, insert, select
from sqlalchemy.exc import DatabaseError

from ..._support.errors import ParameterError, StoreError
from ..._support.messages import Message
from ..._support.user_files.json_text import json_value
from ..._support.user_files.text_files import toml_values
from .engine import database_errors, reading, savepoint, writing
from .rows import TIME, damage_error, entry_damage_error, require_type
from .schema import campaign, journal, journal_entry
from .server import StorePlace

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


class OpenStore(Protocol):
    """Parts of an open `Store` that its journals use: its place, and the connections to its database."""

    path: StorePlace
    engine: Engine


class Journals:
    """Reads and writes the journals of a store: append-only lists of changes to its campaigns."""

    def __init__(self, store: OpenStore) -> None:
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
            if (earlier := _earlier_entry(connection, id, entry, seen)) is not None:
                return earlier
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
            if (earlier := _earlier_entry(connection, id, entry, seen)) is not None:
                return earlier
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


def _earlier_entry(connection: Connection, id_: str, entry: NewEntry, seen: int) -> JournalEntry | None:
    """Entry of the store with the same ``once``, if the writer sent the new one before; None for a new one.

    Raises OvertakenError: the test has a newer entry than sequence `seen`, the last that the writer has seen.
    """
    if entry.once is not None:
        sent = select(journal_entry).where(journal_entry.c.journal_id == id_, journal_entry.c.once == entry.once)
        earlier = connection.execute(sent).mappings().first()
        if earlier is not None:
            return parse_entry(earlier)
    query = select(journal_entry).where(_is_about_test(id_, entry), journal_entry.c.sequence > seen)
    row = connection.execute(query.order_by(journal_entry.c.sequence.desc())).mappings().first()
    if row is not None:
        subject = f"{entry.file}, {entry.test}" if entry.test else entry.file
        raise OvertakenError(
            "Nothing was stored: {who} changed {subject} meanwhile ({at}). Check its present state, then enter the "
            "missing values again."
        ).tag("overtaken", who=row["who"] or Message("somebody"), subject=subject, at=row["at"])
    return None


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
