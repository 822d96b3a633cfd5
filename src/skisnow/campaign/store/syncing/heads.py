"""What a store has of a journal: the uids of its entries, by test."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

from sqlalchemy import Connection, select

from ..journal_entry import entry_of
from ..rows import damaged
from ..schema import campaign, journal, journal_entry

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from ..journal_entry import JournalEntry

Subject: TypeAlias = tuple[str, str]
"""File and test that an entry is about."""
_ASKED_AT_ONCE = 500


@dataclass(slots=True)
class Heads:
    """The entries of a journal in one store, by uid: what they are about, and their numbers there."""

    subject: dict[str, Subject] = field(default_factory=dict)
    sequence: dict[str, int] = field(default_factory=dict)
    uid: dict[int, str] = field(default_factory=dict)

    def missing_in(self, other: Heads) -> set[str]:
        """What is here and not there."""
        return self.subject.keys() - other.subject.keys()

    def written_on_both(self, other: Heads) -> list[Subject]:
        """The tests about which each side has what the other lacks, sorted."""
        here = {self.subject[uid] for uid in self.missing_in(other)}
        return sorted(here & {other.subject[uid] for uid in other.missing_in(self)})


def heads(connection: Connection, journal_id: str) -> Heads:
    """What a store has of a journal; nothing where it does not have it.

    Raises
    ------
    StoreError
        An entry has no uid.
    """
    columns, found = journal_entry.c, Heads()
    asked = select(columns.uid, columns.sequence, columns.file, columns.test).where(columns.journal_id == journal_id)
    for uid, sequence, file, test in connection.execute(asked):
        if not isinstance(uid, str):
            raise damaged(f"The entry {sequence} of the campaign in entry {journal_id}")
        found.subject[uid], found.sequence[uid], found.uid[sequence] = (file, test), sequence, uid
    return found


def entries_by_uid(connection: Connection, journal_id: str, uids: Iterable[str]) -> list[JournalEntry]:
    """Entries in the order of their uids, each checked to be what was written down."""
    wanted = sorted(uids)
    found: list[JournalEntry] = []
    for first in range(0, len(wanted), _ASKED_AT_ONCE):
        some = journal_entry.c.uid.in_(wanted[first : first + _ASKED_AT_ONCE])
        asked = select(journal_entry).where(journal_entry.c.journal_id == journal_id, some)
        found += [entry_of(row) for row in connection.execute(asked).mappings()]
    return sorted(found, key=lambda entry: entry.uid)


def entries_about(connection: Connection, journal_id: str, subject: Subject) -> list[JournalEntry]:
    """Every entry about one test, in the order of their uids."""
    columns = journal_entry.c
    of_subject = (columns.journal_id == journal_id, columns.file == subject[0], columns.test == subject[1])
    rows = connection.execute(select(journal_entry).where(*of_subject)).mappings()
    return sorted((entry_of(row) for row in rows), key=lambda entry: entry.uid)


def shared_journals(here: Connection, there: Connection) -> Iterator[str]:
    """The journals that can be compared: of campaigns that are entered, or stored in both stores."""
    of_here, of_there = _journals(here), _journals(there)
    stored_here, stored_there = _stored(here), _stored(there)
    for id_ in sorted(of_here | of_there):
        if (id_ in stored_here) == (id_ in stored_there):
            yield id_


def _journals(connection: Connection) -> set[str]:
    return set(connection.execute(select(journal.c.id)).scalars())


def _stored(connection: Connection) -> set[str]:
    return set(connection.execute(select(campaign.c.id)).scalars())
