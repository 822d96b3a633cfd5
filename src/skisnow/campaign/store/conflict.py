"""Conflicts between two stores: tests about which each store has entries that the other does not have."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from typing import Final, Literal, TypeAlias

from sqlalchemy import Connection, select

from .journal import DESCRIPTION, JournalEntry, parse_entry
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
    """Entries of two stores about one test, in the order of their uids; they are not transferred if they contradict.

    campaign, name: id and name of the campaign; "" without a name.
    file, test: table and test of the entries; for a description ``campaign.toml`` and ``""``.
    common, entries_here, entries_there: entries of both stores, and those of only one.
    uid_here, uid_there: uids of the entries of the campaign by their sequence.
    """

    campaign: str
    name: str
    file: str
    test: str
    common: tuple[JournalEntry, ...]
    entries_here: tuple[JournalEntry, ...]
    entries_there: tuple[JournalEntry, ...]
    uid_here: Mapping[int, str]
    uid_there: Mapping[int, str]

    @property
    def entries(self) -> tuple[JournalEntry, ...]:
        """Entries that only one of the two stores has, those of this store first."""
        return (*self.entries_here, *self.entries_there)

    @property
    def id(self) -> str:
        """Identifier by which the user chooses a side; it changes if one side gets another entry."""
        parts = (self.campaign, self.file, self.test, *(entry.uid for entry in self.entries))
        return sha256("\0".join(parts).encode()).hexdigest()[:_ID_DIGITS]

    @property
    def is_agreed(self) -> bool:
        """True if the entries of both sides are compatible without a choice."""
        if self.file == DESCRIPTION:
            return self.entries_here[-1].cells == self.entries_there[-1].cells
        actions = {entry.action for entry in self.entries}
        if actions == {"correct"}:
            return not self.contested
        here, there = _entry_counts(self.entries_here, self.uid_here), _entry_counts(self.entries_there, self.uid_there)
        return "add" not in actions and here == there

    @property
    def contested(self) -> list[tuple[str, str]]:
        """Cells that both sides corrected differently: uid of the row's entry, and column."""
        here, there = _new_cells(self.entries_here, self.uid_here), _new_cells(self.entries_there, self.uid_there)
        return sorted(cell for cell in here.keys() & there.keys() if here[cell] != there[cell])

    @property
    def kind(self) -> Kind:
        """Kind of the conflict by its entries: "described", "begun twice", "added to", "cancelled" and so on."""
        actions = {entry.action for entry in self.entries}
        added = [any(entry.action == "add" for entry in side) for side in (self.entries_here, self.entries_there)]
        if self.file == DESCRIPTION:
            return "described"
        if all(added):
            return "added to" if any(entry.action == "add" for entry in self.common) else "begun twice"
        if "cancel" in actions:
            return "cancelled"
        if "undo" in actions:
            return "taken back"
        return "corrected" if self.contested else "added to"

    @property
    def what(self) -> str:
        """Sentence on what the two stores contradict each other in."""
        return _KINDS[self.kind]

    @property
    def choices(self) -> tuple[Side, ...]:
        """Sides that can be kept: "here", "there", and also "both" if neither contradicts the other."""
        together = self.kind == "begun twice" or (self.kind == "cancelled" and not self.contested)
        return ("here", "there", "both") if together else ("here", "there")

    @property
    def here(self) -> list[str]:
        """A line for each entry that only this store has, oldest first."""
        return self._lines(self.entries_here, self.uid_here)

    @property
    def there(self) -> list[str]:
        """A line for each entry that only the other store has, oldest first."""
        return self._lines(self.entries_there, self.uid_there)

    def _lines(self, entries: Sequence[JournalEntry], uids: Mapping[int, str]) -> list[str]:
        """One line per entry with its author, time and action."""
        by_uid = {entry.uid: entry for entry in (*self.common, *self.entries)}
        subjects = [(entry, by_uid.get(uids.get(entry.about or 0, ""))) for entry in entries]
        return [f"{entry.who or 'somebody'}, {entry.at}: {_entry_words(entry, about)}" for entry, about in subjects]

    def __str__(self) -> str:
        """Text with id, campaign, test and kind of the conflict, and a line for each entry of both sides."""
        subject = f"{self.file}, {self.test}" if self.test else self.file
        lines = [f"{self.id}  {self.name} ({self.campaign}), {subject}: {self.what}"]
        lines += [f"    here: {line}" for line in self.here]
        return "\n".join([*lines, *(f"    there: {line}" for line in self.there)])


def _entry_counts(entries: Sequence[JournalEntry], uids: Mapping[int, str]) -> Counter[tuple[object, ...]]:
    """Number of entries with the same action, subject, cells and reason, whatever their number in the journal."""
    return Counter(
        (entry.action, uids.get(entry.about or 0), tuple(sorted(entry.cells.items())), entry.why) for entry in entries
    )


def open_conflicts(here: Connection, there: Connection, journal_id: str) -> Iterator[Conflict]:
    """Conflicts of a journal: tests about which entries of only one store contradict those of only the other."""
    of_here, of_there = entry_index(here, journal_id), entry_index(there, journal_id)
    for subject in of_here.written_on_both(of_there):
        on_here, on_there = (
            entries_by_uid(store, journal_id, (uid for uid, about in index.subject.items() if about == subject))
            for store, index in ((here, of_here), (there, of_there))
        )
        uids_here, uids_there = {entry.uid for entry in on_here}, {entry.uid for entry in on_there}
        conflict = Conflict(
            journal_id,
            "",
            *subject,
            common=tuple(entry for entry in on_here if entry.uid in uids_there),
            entries_here=tuple(entry for entry in on_here if entry.uid not in uids_there),
            entries_there=tuple(entry for entry in on_there if entry.uid not in uids_here),
            uid_here=of_here.uid,
            uid_there=of_there.uid,
        )
        if not conflict.is_agreed:
            yield conflict


def _new_cells(entries: Sequence[JournalEntry], uids: Mapping[int, str]) -> dict[tuple[str, str], str]:
    """Text of each corrected cell after the last correction, by uid of the row's entry and column."""
    return {
        (uids.get(entry.about or 0, ""), column): text
        for entry in entries
        if entry.action == "correct"
        for column, text in entry.cells.items()
    }


def _entry_words(entry: JournalEntry, about: JournalEntry | None) -> str:
    """English words for an entry's action; `about`: the entry that it corrects or takes back, if known."""
    if entry.action == "describe":
        return f"described the campaign: {_shorten_text(entry.cells[DESCRIPTION])}"
    if entry.action == "cancel":
        return f"cancelled it: {_shorten_text(entry.why)}"
    if entry.action == "undo":
        return f"took back: {_entry_words(about, None)}" if about is not None else "took an entry back"
    if entry.action == "correct":
        row = f"row {about.position + 1}, " if about is not None and about.position is not None else ""
        corrected = []
        for key, text in entry.cells.items():  # a cell of a stored file, or a column of the row that is corrected
            place = "line {}, {}".format(*cell_of(key)) if "/" in key else f"{row}{key}"
            corrected.append(f"{place} to {text!r}")
        return f"corrected {', '.join(corrected)}"
    cells = ", ".join(f"{column} {text}" for column, text in entry.cells.items() if text and text != entry.test)
    return f"added row {(entry.position or 0) + 1}: {_shorten_text(cells)}"


def _shorten_text(text: str) -> str:
    """Text in one line, cut with "…" at the maximum length."""
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
    """Index of the entries of a journal in a store, empty without the journal; StoreError if an entry has no uid."""
    columns, index = journal_entry.c, EntryIndex()
    query = select(columns.uid, columns.sequence, columns.file, columns.test).where(columns.journal_id == journal_id)
    for uid, sequence, file, test in connection.execute(query):
        if not isinstance(uid, str):
            raise entry_damage_error(sequence, journal_id)
        index.subject[uid], index.sequence[uid], index.uid[sequence] = (file, test), sequence, uid
    return index


def entries_by_uid(connection: Connection, journal_id: str, uids: Iterable[str]) -> list[JournalEntry]:
    """Entries of a journal with these uids, sorted by uid. Raises StoreError: an entry is damaged."""
    wanted = sorted(uids)
    entries: list[JournalEntry] = []
    for first in range(0, len(wanted), _ENTRIES_PER_QUERY):
        some = journal_entry.c.uid.in_(wanted[first : first + _ENTRIES_PER_QUERY])
        query = select(journal_entry).where(journal_entry.c.journal_id == journal_id, some)
        entries += [parse_entry(row) for row in connection.execute(query).mappings()]
    return sorted(entries, key=lambda entry: entry.uid)


def shared_journals(here: Connection, there: Connection) -> Iterator[str]:
    """Sorted ids of the journals that can be compared: their campaign is stored in both stores, or in neither."""
    journals = {id_ for store in (here, there) for id_ in store.execute(select(journal.c.id)).scalars()}
    stored_here, stored_there = (set(store.execute(select(campaign.c.id)).scalars()) for store in (here, there))
    for id_ in sorted(journals):
        if (id_ in stored_here) == (id_ in stored_there):
            yield id_
