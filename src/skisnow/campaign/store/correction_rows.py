"""Rows of corrections.csv from entries of a journal, and the text of a table."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Final

from ..._support.spreadsheet_text import guarded

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .journal_entry import JournalEntry

COLUMNS: Final = ("file", "experiment", "row", "column", "old", "new", "who", "when", "why")


def correction_row(entry: JournalEntry, line: int, column: str, old: str, new: str) -> tuple[str, ...]:
    """What an entry says of a cell in a line of its file, by `COLUMNS`."""
    return (entry.file, entry.test, str(line), column, old, new, entry.who, entry.at, entry.why)


def csv_text(rows: Iterable[Sequence[str]]) -> str:
    r"""A table with commas and plain line ends; no cell is taken for a formula.

    >>> csv_text([("old", "new"), ("1,5", "1.5")])
    'old,new\n"1,5",1.5\n'
    """
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(map(guarded, row) for row in rows)
    return stream.getvalue()
