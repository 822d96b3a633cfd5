"""The state that a journal's entries give when they are replayed (event sourcing): the tests, each with its history."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from ..reading.branches import is_unloading_cell
from ..reading.table_forms import BRANCH
from .journal_entry import DESCRIPTION

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .journal_entry import JournalEntry


@dataclass(slots=True)
class ReplayedRow:
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
class ReplayedTest:
    """A test, sample or experiment: its rows in order, why it was cancelled if it was, every entry about it."""

    file: str
    name: str
    rows: list[ReplayedRow] = field(default_factory=list)
    cancelling: JournalEntry | None = None
    history: list[JournalEntry] = field(default_factory=list)
    undone: set[int] = field(default_factory=set)

    @property
    def last(self) -> int:
        """Sequence of the last entry about it: what `Journals.append` takes as seen."""
        return max((entry.sequence for entry in self.history), default=0)

    @property
    def cancelled(self) -> str:
        """Why it was cancelled, ``""`` where it was not."""
        return self.cancelling.why if self.cancelling is not None else ""

    @property
    def undoable(self) -> JournalEntry | None:
        """The last entry that still counts, which is the one that can be undone; not what a file says."""
        counting = (each for each in reversed(self.history) if each.action != "undo" and not each.is_from_file)
        return next((each for each in counting if each.sequence not in self.undone), None)

    def row_under(self, load: str, branch: str = "") -> ReplayedRow | None:
        """The reading of a series under a load (N), of the loading or, with its word, of the unloading."""
        taken_off = is_unloading_cell(branch)
        return next(
            (
                row
                for row in self.rows
                if float(row.cells["load_N"]) == float(load)
                and is_unloading_cell(row.cells.get(BRANCH, "")) == taken_off
            ),
            None,
        )

    @property
    def next_position(self) -> int:
        """A place within the test that no row has had."""
        return max((entry.position + 1 for entry in self.history if entry.position is not None), default=0)


@dataclass(slots=True)
class ReplayedCampaign:
    """A campaign that is being entered, as it is now. ``tests`` are keyed by file and name, in the order of entry."""

    description: str = ""
    described: int = 0
    tests: dict[tuple[str, str], ReplayedTest] = field(default_factory=dict)

    def of_file(self, file: str) -> list[ReplayedTest]:
        """The tests of one table that have a row."""
        return [test for test in self.tests.values() if test.file == file and test.rows]

    def test(self, file: str, name: str) -> ReplayedTest:
        """A test by its name; an empty one where there is none yet."""
        return self.tests.get((file, name)) or ReplayedTest(file, name)


def replayed(entries: Iterable[JournalEntry], *, before: ReplayedCampaign | None = None) -> ReplayedCampaign:
    """Replay a journal's entries, oldest first. What was undone is left out, but stays in the history.

    Parameters
    ----------
    entries
        All entries, or those behind ``before``.
    before
        What the entries up to there came to; it is not changed. Only tests with new entries are replayed again.
    """
    campaign = replace(before, tests=dict(before.tests)) if before is not None else ReplayedCampaign()
    added: dict[tuple[str, str], list[JournalEntry]] = {}
    for entry in entries:
        if entry.file == DESCRIPTION:
            campaign.described, campaign.description = entry.sequence, entry.cells[DESCRIPTION]
        else:
            added.setdefault((entry.file, entry.test), []).append(entry)
    for key, new in added.items():
        known = campaign.tests[key].history if key in campaign.tests else []
        campaign.tests[key] = _test(key, sorted([*known, *new], key=lambda entry: entry.uid))
    return campaign


def _test(key: tuple[str, str], history: list[JournalEntry]) -> ReplayedTest:
    test = ReplayedTest(*key, history=history)
    for entry in reversed(history):  # an undoing can be undone
        if entry.action == "undo" and entry.about is not None and entry.sequence not in test.undone:
            test.undone.add(entry.about)
    rows: dict[int, ReplayedRow] = {}
    for entry in history:
        if entry.sequence not in test.undone:
            _take(test, rows, entry)
    test.rows.sort(key=_order)
    return test


def _order(row: ReplayedRow) -> tuple[bool, float, int, int]:
    """Readings that were entered rise with their loads, then fall with those of the unloading; rows of a file stay."""
    position, load = row.entered.position, row.cells.get("load_N")
    if not load or position is None:
        return False, 0.0, position or 0, row.entered.sequence
    taken_off = is_unloading_cell(row.cells.get(BRANCH, ""))
    return taken_off, -float(load) if taken_off else float(load), position, row.entered.sequence


def _take(test: ReplayedTest, rows: dict[int, ReplayedRow], entry: JournalEntry) -> None:
    if entry.action == "add":
        rows[entry.sequence] = ReplayedRow(entry)
        test.rows.append(rows[entry.sequence])
    elif entry.action == "correct" and entry.about in rows:
        rows[entry.about].corrections.append(entry)
    elif entry.action == "cancel":
        test.cancelling = entry
