"""What a journal comes to: the tests of a campaign as they stand now, each with its history."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from .journal import DESCRIPTION

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .journal import JournalEntry


@dataclass(slots=True)
class GrownRow:
    """A row of a table: as it was entered, what was corrected since, and what its cells are now."""

    entered: JournalEntry
    corrections: list[JournalEntry] = field(default_factory=list)

    @property
    def cells(self) -> dict[str, str]:
        """The cells as they are now."""
        now = dict(self.entered.cells)
        for correction in self.corrections:
            now.update(correction.cells)
        return now


@dataclass(slots=True)
class GrownTest:
    """A test, sample or experiment: its rows in order, why it was cancelled if it was, every entry about it."""

    file: str
    name: str
    rows: list[GrownRow] = field(default_factory=list)
    cancelling: JournalEntry | None = None
    history: list[JournalEntry] = field(default_factory=list)
    undone: set[int] = field(default_factory=set)

    @property
    def last(self) -> int:
        """Sequence of the last entry about it: what `Journals.append` is to be told as seen."""
        return self.history[-1].sequence if self.history else 0

    @property
    def cancelled(self) -> str:
        """Why it was cancelled, ``""`` where it was not."""
        return self.cancelling.why if self.cancelling is not None else ""

    @property
    def undoable(self) -> JournalEntry | None:
        """The last entry that still counts, which is the one that can be undone."""
        counting = (each for each in reversed(self.history) if each.action != "undo")
        return next((each for each in counting if each.sequence not in self.undone), None)

    def row_at(self, position: int) -> GrownRow | None:
        """The row at a place within the test."""
        return next((row for row in self.rows if row.entered.position == position), None)


@dataclass(slots=True)
class GrownCampaign:
    """A campaign that is being entered, as it is now. ``tests`` are keyed by file and name, in the order of entry."""

    description: str = ""
    described: int = 0
    tests: dict[tuple[str, str], GrownTest] = field(default_factory=dict)

    def of_file(self, file: str) -> list[GrownTest]:
        """The tests of one table that have a row."""
        return [test for test in self.tests.values() if test.file == file and test.rows]

    def test(self, file: str, name: str) -> GrownTest:
        """A test by its name; an empty one where there is none yet."""
        return self.tests.get((file, name)) or GrownTest(file, name)


def grown(entries: Iterable[JournalEntry]) -> GrownCampaign:
    """Put a journal's entries, oldest first, together. What was undone is left out, but stays in the history."""
    entries = tuple(entries)
    campaign = GrownCampaign()
    undone = {entry.about for entry in entries if entry.action == "undo"}
    rows: dict[int, GrownRow] = {}
    for entry in entries:
        if entry.file == DESCRIPTION:
            campaign.described = entry.sequence
            campaign.description = entry.cells[DESCRIPTION]
            continue
        key = (entry.file, entry.test)
        test = campaign.tests.setdefault(key, GrownTest(*key))
        test.history.append(entry)
        if entry.sequence in undone:
            test.undone.add(entry.sequence)
        else:
            _take(test, rows, entry)
    for test in campaign.tests.values():
        test.rows.sort(key=lambda row: (row.entered.position or 0, row.entered.sequence))
    return campaign


def _take(test: GrownTest, rows: dict[int, GrownRow], entry: JournalEntry) -> None:
    if entry.action == "add":
        rows[entry.sequence] = GrownRow(entry)
        test.rows.append(rows[entry.sequence])
    elif entry.action == "correct" and entry.about in rows:
        rows[entry.about].corrections.append(entry)
    elif entry.action == "cancel":
        test.cancelling = entry
