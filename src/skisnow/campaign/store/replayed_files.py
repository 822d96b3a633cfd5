"""A campaign that is being entered as the files of a campaign's folder.

The tables hold what was entered first; corrections and cancellings stand in corrections.csv, as they do for every
campaign, so that the history travels with the numbers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS, TABLES
from .correction_rows import COLUMNS, correction_row, csv_text
from .journal_entry import DESCRIPTION

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from pathlib import Path

    from ..reading.table_forms import TableForm
    from .replayed import ReplayedCampaign, ReplayedRow, ReplayedTest

_TIME = "time"


def campaign_files(campaign: ReplayedCampaign, *, of: Iterable[ReplayedTest] | None = None) -> dict[str, str]:
    """The text of each file of the campaign's folder, by name.

    Parameters
    ----------
    campaign
        As it is now.
    of
        The tests to write; all where it is left out.
    """
    chosen = list(campaign.tests.values() if of is None else of)
    files = {DESCRIPTION: campaign.description}
    corrections: list[tuple[str, ...]] = []
    for form in TABLES:
        tests = [test for test in chosen if test.file == form.file and test.rows]
        if tests:
            files[form.file] = _table(form, tests)
            corrections.extend(_corrections(tests))
    if corrections:
        files[CORRECTIONS.file] = csv_text([COLUMNS, *corrections])
    return files


def write_campaign(campaign: ReplayedCampaign, folder: Path, *, of: Iterable[ReplayedTest] | None = None) -> None:
    """Write these files into a folder that exists, without waiting for the disk: they can be made again at any time."""
    for name, text in campaign_files(campaign, of=of).items():
        (folder / name).write_text(text, encoding="utf-8", newline="")


def _table(form: TableForm, tests: Sequence[ReplayedTest]) -> str:
    rows = [row for test in tests for row in test.rows]
    present = {column for row in rows for column in row.entered.cells} | {_TIME}
    present |= {column for row in rows for correction in row.corrections for column in correction.cells}
    columns = [column for column in form.known if column in present or column in form.required]
    return csv_text([columns, *(_cells(row, columns) for row in rows)])


def _cells(row: ReplayedRow, columns: Sequence[str]) -> list[str]:
    entered = {_TIME: row.entered.at, **row.entered.cells}
    return [entered.get(column, "") for column in columns]


def _corrections(tests: Sequence[ReplayedTest]) -> Iterator[tuple[str, ...]]:
    line = 1  # of the header
    for test in tests:
        if test.cancelling is not None:
            yield correction_row(test.cancelling, line + 1, STATUS, "", test.cancelled)
        for row in test.rows:
            line += 1
            now = dict(row.entered.cells)
            for entry in row.corrections:
                for column, new in entry.cells.items():
                    yield correction_row(entry, line, column, now.get(column, ""), new)
                    now[column] = new
