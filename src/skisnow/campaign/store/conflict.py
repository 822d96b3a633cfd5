"""Conflicts between two stores: tests about which each store has entries that the other does not have."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Final, Literal, TypeAlias

from sqlalchemy import Connection, select

from .journal_entry import DESCRIPTION, JournalEntry, parse_entry
from .rows import entry_damage_error
from .schema import campaign, journal, journal_entry
from .stored_tables import cell_of

Side: TypeAlias = Literal["here", "there", "both"]
Kind: TypeAlias = Literal["described", "begun twice", "added to", "cancelled", "corrected", "taken back"]
_ID_DIGITS: Final = 8
_LONGEST: Final = 80

_KINDS: Final[dict[Kind, str]] = {
    "described": "the campaign was described differently",
    "begun twice": "a test of this name was begun in both",
    "added to": "rows were added in both",
    "cancelled": "it was cancelled in one and changed in the other",
    "taken back": "an entry was taken back in one, and the other has further entries",
    "corrected": "the same cell was corrected differently",
}


@dataclass(frozen=True, slots=True)
class Conflict:
    """A conflict: contradicting entries of two stores about one test, which are not transferred.

    id: identifier of the conflict for a choice; it changes if one side changes.
    campaign, name: id and name of the campaign.
    file, test: table and test of the entries; for a description ``campaign.toml`` and ``""``.
    what: kind of conflict in words.
    here, there: entries that only one store has, one line each, oldest first.
    choices: sides that can be kept.
    """

    id: str
    campaign: str
    name: str
    file: str
    test: str
    what: str
    here: tuple[str, ...]
    there: tuple[str, ...]
    choices: tuple[Side, ...]

    def __str__(self) -> str:
        """The conflict in a few lines."""
        subject = f"{self.file}, {self.test}" if self.test else self.file
        lines = [f"{self.id}  {self.name} ({self.campaign}), {subject}: {self.what}"]
        lines += [f"    {side}: {line}" for side in ("here", "there") for line in getattr(self, side)]
        return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Divergence:
    """Entries about one test in the order of their uids: those of both stores, and those of only one."""

    journal_id: str
    subject: Subject
    common: tuple[JournalEntry, ...]
    here: tuple[JournalEntry, ...]
    there: tuple[JournalEntry, ...]
    uid_here: Mapping[int, str]
    uid_there: Mapping[int, str]

    @property
    def id(self) -> str:
        """Identifier for a choice, which changes with the entries of both sides."""
        parts = (self.journal_id, *self.subject, *(entry.uid for side in (self.here, self.there) for entry in side))
        said = sha256("\0".join(parts).encode())
        return said.hexdigest()[:_ID_DIGITS]

    @property
    def is_agreed(self) -> bool:
        """True if the entries of both sides are compatible without a choice."""
        if self.subject[0] == DESCRIPTION:
            return self.here[-1].cells == self.there[-1].cells
        entries = (*self.here, *self.there)
        if all(entry.action == "correct" for entry in entries):
            return not self.contested
        return not any(entry.action == "add" for entry in entries) and self._counts("here") == self._counts("there")

    @property
    def contested(self) -> list[tuple[str, str]]:
        """Cells that both sides corrected differently: uid of the row's entry, and column."""
        here, there = _corrected(self.here, self.uid_here), _corrected(self.there, self.uid_there)
        return sorted(cell for cell in here.keys() & there.keys() if here[cell] != there[cell])

    @property
    def kind(self) -> Kind:
        """Kind of the conflict."""
        actions = {entry.action for entry in (*self.here, *self.there)}
        added = [any(entry.action == "add" for entry in side) for side in (self.here, self.there)]
        if self.subject[0] == DESCRIPTION:
            return "described"
        if all(added):
            return "added to" if any(entry.action == "add" for entry in self.common) else "begun twice"
        if "cancel" in actions:
            return "cancelled"
        if "undo" in actions:
            return "taken back"
        return "corrected" if self.contested else "added to"

    @property
    def choices(self) -> tuple[Side, ...]:
        """Choices for the user: "here", "there", and also "both" if neither contradicts the other."""
        together = self.kind == "begun twice" or (self.kind == "cancelled" and not self.contested)
        return ("here", "there", "both") if together else ("here", "there")

    def in_words(self, name: str) -> Conflict:
        """The conflict as text for the user, with the name of the campaign."""
        entries_by_uid = {entry.uid: entry for entry in (*self.common, *self.here, *self.there)}
        return Conflict(
            id=self.id,
            campaign=self.journal_id,
            name=name,
            file=self.subject[0],
            test=self.subject[1],
            what=_KINDS[self.kind],
            here=tuple(_entry_line(entry, self.uid_here, entries_by_uid) for entry in self.here),
            there=tuple(_entry_line(entry, self.uid_there, entries_by_uid) for entry in self.there),
            choices=self.choices,
        )

    def _counts(self, side: Literal["here", "there"]) -> Counter[tuple[object, ...]]:
        entries, uids = (self.here, self.uid_here) if side == "here" else (self.there, self.uid_there)
        return Counter(
            (entry.action, uids.get(entry.about or 0), tuple(sorted(entry.cells.items())), entry.why)
            for entry in entries
        )


def open_divergences(here: Connection, there: Connection, journal_id: str) -> Iterator[Divergence]:
    """Tests about which the entries that only one store has contradict those that only the other has."""
    of_here, of_there = entry_index(here, journal_id), entry_index(there, journal_id)
    for subject in of_here.written_on_both(of_there):
        on_here, on_there = entries_about(here, journal_id, subject), entries_about(there, journal_id, subject)
        uids_here, uids_there = {entry.uid for entry in on_here}, {entry.uid for entry in on_there}
        divergence = Divergence(
            journal_id,
            subject,
            common=tuple(entry for entry in on_here if entry.uid in uids_there),
            here=tuple(entry for entry in on_here if entry.uid not in uids_there),
            there=tuple(entry for entry in on_there if entry.uid not in uids_here),
            uid_here=of_here.uid,
            uid_there=of_there.uid,
        )
        if not divergence.is_agreed:
            yield divergence


def _corrected(entries: Sequence[JournalEntry], uids: Mapping[int, str]) -> dict[tuple[str, str], str]:
    """Last correction of each cell among the entries."""
    return {
        (uids.get(entry.about or 0, ""), column): text
        for entry in entries
        if entry.action == "correct"
        for column, text in entry.cells.items()
    }


def _entry_line(entry: JournalEntry, uids: Mapping[int, str], entries_by_uid: Mapping[str, JournalEntry]) -> str:
    about = entries_by_uid.get(uids.get(entry.about or 0, ""))
    return f"{entry.who or 'somebody'}, {entry.at}: {_entry_words(entry, about)}"


def _entry_words(entry: JournalEntry, about: JournalEntry | None) -> str:
    if entry.action == "describe":
        return f"described the campaign: {_shorten_text(entry.cells[DESCRIPTION])}"
    if entry.action == "cancel":
        return f"cancelled it: {_shorten_text(entry.why)}"
    if entry.action == "undo":
        return f"took back: {_entry_words(about, None)}" if about is not None else "took an entry back"
    if entry.action == "correct":
        return "corrected " + ", ".join(_cell(key, text, about) for key, text in entry.cells.items())
    cells = ", ".join(f"{column} {text}" for column, text in entry.cells.items() if text and text != entry.test)
    return f"added row {(entry.position or 0) + 1}: {_shorten_text(cells)}"


def _cell(key: str, text: str, about: JournalEntry | None) -> str:
    """Correction of a cell in words, with the line of the file for a stored campaign."""
    if "/" in key:
        line, column = cell_of(key)
        return f"line {line}, {column} to {text!r}"
    row = f"row {about.position + 1}, " if about is not None and about.position is not None else ""
    return f"{row}{key} to {text!r}"


def _shorten_text(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= _LONGEST else f"{words[:_LONGEST]}…"


Subject: TypeAlias = tuple[str, str]
"""File and test of an entry."""
_ENTRIES_PER_QUERY = 500


@dataclass(slots=True)
class EntryIndex:
    """Index of the entries of a journal in one store: subject and sequence by uid, uid by sequence."""

    subject: dict[str, Subject] = field(default_factory=dict)
    sequence: dict[str, int] = field(default_factory=dict)
    uid: dict[int, str] = field(default_factory=dict)

    def missing_in(self, other: EntryIndex) -> set[str]:
        """Uids of the entries that the other store does not have."""
        return self.subject.keys() - other.subject.keys()

    def written_on_both(self, other: EntryIndex) -> list[Subject]:
        """Sorted tests about which each store has entries that the other does not have."""
        here = {self.subject[uid] for uid in self.missing_in(other)}
        return sorted(here & {other.subject[uid] for uid in other.missing_in(self)})


def entry_index(connection: Connection, journal_id: str) -> EntryIndex:
    """Index of the entries of a journal in a store; empty if it does not have the journal.

    Raises StoreError: an entry has no uid.
    """
    columns, index = journal_entry.c, EntryIndex()
    query = select(columns.uid, columns.sequence, columns.file, columns.test).where(columns.journal_id == journal_id)
    for uid, sequence, file, test in connection.execute(query):
        if not isinstance(uid, str):
            raise entry_damage_error(sequence, journal_id)
        index.subject[uid], index.sequence[uid], index.uid[sequence] = (file, test), sequence, uid
    return index


def entries_by_uid(connection: Connection, journal_id: str, uids: Iterable[str]) -> list[JournalEntry]:
    """Entries in the order of their uids, with verified checksums."""
    wanted = sorted(uids)
    entries: list[JournalEntry] = []
    for first in range(0, len(wanted), _ENTRIES_PER_QUERY):
        some = journal_entry.c.uid.in_(wanted[first : first + _ENTRIES_PER_QUERY])
        query = select(journal_entry).where(journal_entry.c.journal_id == journal_id, some)
        entries += [parse_entry(row) for row in connection.execute(query).mappings()]
    return sorted(entries, key=lambda entry: entry.uid)


def entries_about(connection: Connection, journal_id: str, subject: Subject) -> list[JournalEntry]:
    """Every entry about one test, in the order of their uids."""
    columns = journal_entry.c
    of_subject = (columns.journal_id == journal_id, columns.file == subject[0], columns.test == subject[1])
    rows = connection.execute(select(journal_entry).where(*of_subject)).mappings()
    return sorted((parse_entry(row) for row in rows), key=lambda entry: entry.uid)


def shared_journals(here: Connection, there: Connection) -> Iterator[str]:
    """Ids of the journals that can be compared: of campaigns in entry, or stored in both stores."""
    journals = {id_ for store in (here, there) for id_ in store.execute(select(journal.c.id)).scalars()}
    stored_here, stored_there = (set(store.execute(select(campaign.c.id)).scalars()) for store in (here, there))
    for id_ in sorted(journals):
        if (id_ in stored_here) == (id_ in stored_there):
            yield id_
