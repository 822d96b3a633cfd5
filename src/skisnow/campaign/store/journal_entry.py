"""One entry of a journal: what is to be written down, what was, and how it is read from its row."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal, TypeAlias

from sqlalchemy import RowMapping

from ..._support.errors import StoreError
from ..._support.user_files import json_value
from .entry_sums import entry_sha256
from .rows import damaged, number_of, text_of

Action: TypeAlias = Literal["describe", "add", "correct", "cancel", "undo"]

DESCRIPTION: Final = "campaign.toml"
"""The file, and the only cell, of an entry that describes the campaign."""

PLAIN: Final = ("action", "file", "test", "position", "about", "who", "why", "once")
"""What an entry and its row have alike."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NewEntry:
    """What is to be written down.

    Attributes
    ----------
    action
        describe (the whole of campaign.toml), add (a row), correct (one cell of a row), cancel (a test), undo.
    file, test
        The table's file and the test's name; ``""`` for a description.
    cells
        Texts by column.
    position
        Place of an added row within its test; rows are given back in this order, however late one was filled in.
    about
        The sequence of the entry that is corrected or undone.
    who, why
        As corrections.csv has them; why a test was cancelled.
    once
        Any text that the writer gives to this entry alone: sent again, it is not written down a second time.
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
    """What was written down.

    Attributes
    ----------
    sequence
        Its number in this store, which rises.
    at
        When, in UTC (ISO 8601).
    uid
        What it is called in every store that has it; entries sorted by it are in the same order everywhere, and none
        stands before one that its writer knew.
    """

    sequence: int
    at: str
    uid: str = ""

    @property
    def is_from_file(self) -> bool:
        """Whether it says what a stored file says, and nobody entered it."""
        return self.action == "add" and self.position is None


def entry_of(row: RowMapping) -> JournalEntry:
    """An entry from its row.

    Raises
    ------
    StoreError
        It holds what was never written there.
    """
    entry = readable_entry(row)
    if row["sha256"] != entry_sha256({str(name): value for name, value in row.items()}):
        raise _damaged(row)
    return entry


def readable_entry(row: RowMapping) -> JournalEntry:
    """An entry from its row, whether or not that is what was written down; errors as in `entry_of`."""
    values: dict[str, Any] = {name: row[name] for name in (*PLAIN, "sequence", "at", "uid")}
    try:
        for name in ("action", "file", "test", "at", "who", "why", "uid"):
            text_of(values[name])
        for name in ("sequence", "position", "about"):
            if values[name] is not None or name == "sequence":
                number_of(values[name])
        cells = {text_of(column): text_of(cell) for column, cell in json_value(text_of(row["cells"])).items()}
    except (TypeError, ValueError, AttributeError) as error:
        raise _damaged(row) from error
    return JournalEntry(**values, cells=cells)


def _damaged(row: RowMapping) -> StoreError:
    return damaged(f"The entry {row['sequence']} of the campaign in entry {row['journal_id']}")
