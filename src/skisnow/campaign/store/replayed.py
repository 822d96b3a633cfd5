"""Current state of a campaign in entry, computed by replaying its journal (event sourcing); its files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, field, fields, replace
from typing import Final, TypeAlias

from ..._support.errors import FieldDataError
from ..._support.spreadsheet_text import csv_text, protect_from_formulas
from ..._support.user_files.text_files import toml_text
from ..problems import AppliedCorrection, Problem
from ..reading.campaign import campaign_of_cells
from ..reading.campaign_file import read_campaign_file
from ..reading.columns import is_unloading_cell
from ..reading.corrections import STATUS
from ..reading.table_forms import BRANCH, CORRECTIONS, TABLES, TableForm
from ..reading.tables import Cells
from ..records import Campaign
from .journal import DESCRIPTION, JournalEntry


@dataclass(slots=True)
class Reading:
    """A reading of a test, or a sample: its entry and the corrections since then."""

    entered: JournalEntry
    corrections: list[JournalEntry] = field(default_factory=list)

    @property
    def cells(self) -> dict[str, str]:
        """Texts of the entry by column, with all corrections."""
        cells = dict(self.entered.cells)
        for correction in self.corrections:
            cells.update(correction.cells)
        return cells


@dataclass(slots=True)
class ReplayedTest:
    """A test, sample or experiment, rebuilt from its journal entries: rows, cancellation, entries, undone sequences."""

    file: str
    name: str
    rows: list[Reading] = field(default_factory=list)
    cancelling: JournalEntry | None = None
    history: list[JournalEntry] = field(default_factory=list)
    undone: set[int] = field(default_factory=set)

    @property
    def last(self) -> int:
        """Sequence of the last entry about the test, for `seen` of `Journals.append`; 0 without entries."""
        return max((entry.sequence for entry in self.history), default=0)

    @property
    def cancelled(self) -> str:
        """Reason why the test was cancelled, or ``""``."""
        return self.cancelling.why if self.cancelling is not None else ""

    @property
    def undoable(self) -> JournalEntry | None:
        """Last entry that was not undone and can be undone; entries from a file cannot."""
        counting = (entry for entry in reversed(self.history) if entry.action != "undo" and not entry.is_from_file)
        return next((entry for entry in counting if entry.sequence not in self.undone), None)

    def row_under(self, load: str, branch: str = "") -> Reading | None:
        """Reading of a series under a load (N), of the loading or the unloading branch; None without one."""
        under_load = (row for row in self.rows if float(row.cells["load_N"]) == float(load))
        unloading = is_unloading_cell(branch)
        return next((row for row in under_load if is_unloading_cell(row.cells.get(BRANCH, "")) == unloading), None)

    @property
    def next_position(self) -> int:
        """First unused position in the test."""
        return max((entry.position + 1 for entry in self.history if entry.position is not None), default=0)


@dataclass(slots=True)
class ReplayedCampaign:
    """State of a campaign in entry, or of changes to a stored one; ``tests`` by file and name, in order of entry."""

    description: str = ""
    described: int = 0
    tests: dict[tuple[str, str], ReplayedTest] = field(default_factory=dict)

    def of_file(self, file: str) -> list[ReplayedTest]:
        """The tests of one table that have a row."""
        return [test for test in self.tests.values() if test.file == file and test.rows]

    def test(self, file: str, name: str) -> ReplayedTest:
        """A test by its name; a new empty one if it does not exist."""
        return self.tests.get((file, name)) or ReplayedTest(file, name)


def replay_journal(entries: Iterable[JournalEntry], *, before: ReplayedCampaign | None = None) -> ReplayedCampaign:
    """State of a campaign after a journal's entries, oldest first. Undone ones have no effect, but stay in `history`.

    before: state before these entries, which is not changed; only tests with new entries are replayed.
    """
    campaign = replace(before, tests=dict(before.tests)) if before is not None else ReplayedCampaign()
    added: dict[tuple[str, str], list[JournalEntry]] = {}
    for entry in entries:
        if entry.file == DESCRIPTION:
            campaign.described, campaign.description = entry.sequence, entry.cells[DESCRIPTION]
        else:
            added.setdefault((entry.file, entry.test), []).append(entry)
    for key, new in added.items():
        history = campaign.tests[key].history if key in campaign.tests else []
        campaign.tests[key] = _replay_test(key, sorted([*history, *new], key=lambda entry: entry.uid))
    return campaign


def _replay_test(key: tuple[str, str], history: list[JournalEntry]) -> ReplayedTest:
    """State of one test after its entries, oldest first; undone entries have no effect."""
    test = ReplayedTest(*key, history=history)
    for entry in reversed(history):  # an undoing can be undone
        if entry.action == "undo" and entry.about is not None and entry.sequence not in test.undone:
            test.undone.add(entry.about)
    rows: dict[int, Reading] = {}
    for entry in history:
        if entry.sequence not in test.undone:
            if entry.action == "add":
                rows[entry.sequence] = Reading(entry)
                test.rows.append(rows[entry.sequence])
            elif entry.action == "correct" and entry.about in rows:
                rows[entry.about].corrections.append(entry)
            elif entry.action == "cancel":
                test.cancelling = entry
    test.rows.sort(key=_row_order)
    return test


def _row_order(row: Reading) -> tuple[bool, float, int, int]:
    """Sort key: entered readings by rising load, then unloading by falling load; other rows by position."""
    position, load = row.entered.position, row.cells.get("load_N")
    if not load or position is None:
        return False, 0.0, position or 0, row.entered.sequence
    taken_off = is_unloading_cell(row.cells.get(BRANCH, ""))
    return taken_off, -float(load) if taken_off else float(load), position, row.entered.sequence


COLUMNS: Final = tuple(column.name for column in fields(AppliedCorrection))
"""Columns of corrections.csv."""


def correction_of_cell(entry: JournalEntry, line: int, column: str, old: str, new: str) -> AppliedCorrection:
    """Correction of one cell by an entry, in the given line of the exported file."""
    return AppliedCorrection(entry.file, entry.test, line, column, old, new, entry.who, entry.at, entry.why)


def correction_cells(correction: AppliedCorrection) -> tuple[str, ...]:
    """Cells of a row of corrections.csv, in the order of `COLUMNS`."""
    return tuple(map(str, astuple(correction)))


def guarded_csv(rows: Iterable[Sequence[str]]) -> str:
    """CSV text of rows, whose cells are protected from being read as formulas by a spreadsheet."""
    return csv_text(map(protect_from_formulas, row) for row in rows)


_TIME = "time"


def campaign_files(campaign: ReplayedCampaign) -> dict[str, str]:
    """Text of each file of the campaign's folder by name, except photos and positions."""
    files = {DESCRIPTION: campaign.description}
    corrections: list[AppliedCorrection] = []
    for form, tests in _tests_by_table(campaign.tests.values()):
        columns = _table_columns(form, tests)
        rows = [_row_cells(row.entered.at, row.entered.cells, columns) for test in tests for row in test.rows]
        files[form.file] = guarded_csv([columns, *rows])
        corrections.extend(_applied_corrections(tests))
    if corrections:
        files[CORRECTIONS.file] = guarded_csv([COLUMNS, *map(correction_cells, corrections)])
    return files


def campaign_in_memory(campaign: ReplayedCampaign, *, of: Iterable[ReplayedTest] | None = None) -> Campaign:
    """Campaign as `read_campaign` reads it from the exported folder, without the hashes of its files.

    of: tests to include (default: all).
    Raises FieldDataError: as `read_campaign`.
    """
    tables: dict[str, Cells] = {}
    corrections: list[AppliedCorrection] = []
    for form, tests in _tests_by_table(campaign.tests.values() if of is None else of):
        columns = _table_columns(form, tests)
        if STATUS not in columns and any(test.cancelling for test in tests):
            columns.append(STATUS)
        rows = []
        for test in tests:
            reason = {} if test.cancelling is None else {STATUS: test.cancelled}  # in the first row of the test
            for reading in test.rows:
                rows.append(_row_cells(reading.entered.at, reading.cells | reason, columns))
                reason = {}
        tables[form.file] = Cells(tuple(columns), range(2, len(rows) + 2), rows)
        corrections.extend(_applied_corrections(tests))
    return campaign_of_cells(campaign.description, tables, tuple(corrections))


def _tests_by_table(tests: Iterable[ReplayedTest]) -> Iterator[tuple[TableForm, list[ReplayedTest]]]:
    """Each table that has rows, with its tests that have rows."""
    by_file: dict[str, list[ReplayedTest]] = {}
    for test in tests:
        if test.rows:
            by_file.setdefault(test.file, []).append(test)
    yield from ((form, by_file[form.file]) for form in TABLES if form.file in by_file)


def _table_columns(form: TableForm, tests: Sequence[ReplayedTest]) -> list[str]:
    """Columns of a table that the tests use or that are required, in the form's order."""
    rows = [row for test in tests for row in test.rows]
    present = {column for row in rows for column in row.entered.cells} | {_TIME}
    present |= {column for row in rows for correction in row.corrections for column in correction.cells}
    return [column for column in form.known if column in present or column in form.required]


def _row_cells(at: str, cells: Mapping[str, str], columns: Sequence[str]) -> list[str]:
    """Cells of a row in the order of the columns; `at`: time of the entry, for a row without a time."""
    cells = {_TIME: at, **cells}
    return [cells.get(column, "") for column in columns]


def _applied_corrections(tests: Sequence[ReplayedTest]) -> Iterator[AppliedCorrection]:
    """Corrections of cells, and of the status of cancelled tests, in the order of their lines in the exported table."""
    line = 1  # the header
    for test in tests:
        if test.cancelling is not None:
            yield correction_of_cell(test.cancelling, line + 1, STATUS, "", test.cancelled)
        for row in test.rows:
            line += 1
            cells = dict(row.entered.cells)
            for entry in row.corrections:
                for column, new in entry.cells.items():
                    yield correction_of_cell(entry, line, column, cells.get(column, ""), new)
                    cells[column] = new


Value: TypeAlias = "str | float | Sequence[str] | Sequence[float]"


def description_text(
    values: Mapping[str, Value | None],
    tools: Iterable[Mapping[str, Value]] = (),
    plates: Iterable[Mapping[str, Value]] = (),
) -> str:
    """Text of campaign.toml with values by key, tools and plates; values None and "" are omitted.

    Raises FieldDataError: the description is invalid; the exception has the problems of reading the text.
    """
    lines = [f"{key} = {toml_text(value)}" for key, value in values.items() if value not in (None, "")]
    for table, entries in (("tool", tools), ("plate", plates)):
        for entry in entries:
            lines += ["", f"[[{table}]]", *(f"{key} = {toml_text(value)}" for key, value in entry.items())]
    text = "\n".join(lines) + "\n"
    problems: list[Problem] = []
    read_campaign_file(text, problems)
    if any(problem.severity == "error" for problem in problems):
        raise FieldDataError(problems)
    return text
