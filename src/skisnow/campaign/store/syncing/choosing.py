"""What a user chose where two stores contradict each other: written down here as entries, so that nothing is lost.

What is not kept comes over as well and is taken back by entries of its own; it stays in the history of both stores.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...._support.errors import StoreError
from ..cells import FORMS
from ..entry_rows import write_entry
from ..journal_entry import DESCRIPTION, NewEntry
from .heads import heads
from .taking import take_entries

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from sqlalchemy import Connection

    from ..journal_entry import JournalEntry
    from .conflict import Divergence, Side


def settle(here: Connection, there: Connection, divergence: Divergence, side: Side, who: str) -> None:
    """Make this store the one that holds both sides' entries and the choice between them.

    Raises
    ------
    StoreError
        Both cannot be kept.
    """
    if side not in divergence.choices:
        raise StoreError(
            f"The conflict {divergence.id} cannot be settled by keeping {side}: {' or '.join(divergence.choices)}."
        )
    numbers = take_entries(there, here, divergence.journal_id, [entry.uid for entry in divergence.there])
    if divergence.subject[0] == DESCRIPTION:
        _describe_again(here, divergence, side, who)
    elif side == "here":
        taken = [numbers[entry.uid] for entry in divergence.there]
        _take_back(here, divergence, taken, _why(divergence.there), who)
    elif side == "there":
        own = [entry.sequence for entry in divergence.here]
        _take_back(here, divergence, own, _why(divergence.here), who)
    elif divergence.kind == "begun twice":
        _rename(here, there, divergence, who)


def _why(others: Iterable[JournalEntry]) -> str:
    names = ", ".join(dict.fromkeys(entry.who for entry in others if entry.who))
    return f"stores synchronised, the other side kept{f'; written by {names}' if names else ''}"


def _describe_again(here: Connection, divergence: Divergence, side: Side, who: str) -> None:
    chosen = (divergence.here if side == "here" else divergence.there)[-1]
    entry = NewEntry(action="describe", file=DESCRIPTION, cells=chosen.cells, who=who, why="stores synchronised")
    write_entry(here, divergence.journal_id, entry)


def _take_back(here: Connection, divergence: Divergence, numbers: Iterable[int], why: str, who: str) -> None:
    file, test = divergence.subject
    for number in sorted(numbers, reverse=True):
        entry = NewEntry(action="undo", file=file, test=test, about=number, who=who, why=why)
        write_entry(here, divergence.journal_id, entry)


def _rename(here: Connection, there: Connection, divergence: Divergence, who: str) -> None:
    """Give this store's test another name: it is taken back under the old one and written again as it was entered."""
    file, test = divergence.subject
    name = _free_name(here, there, divergence)
    why = f"stores synchronised; goes on as {name}"
    _take_back(here, divergence, [entry.sequence for entry in divergence.here], why, who)
    numbers: dict[int, int] = {}
    for entry in divergence.here:
        about = None if entry.about is None else numbers[entry.about]
        plain = {field: getattr(entry, field) for field in ("action", "file", "position", "who", "why")}
        cells = _renamed_cells(entry.cells, FORMS[file].key, test, name)
        written = write_entry(
            here, divergence.journal_id, NewEntry(**plain, test=name, cells=cells, about=about), at=entry.at
        )
        numbers[entry.sequence] = written.sequence


def _renamed_cells(cells: Mapping[str, str], key: str, test: str, name: str) -> dict[str, str]:
    return {column: name if column == key and text == test else text for column, text in cells.items()}


def _free_name(here: Connection, there: Connection, divergence: Divergence) -> str:
    file, test = divergence.subject
    subjects = {*heads(here, divergence.journal_id).subject.values()}
    subjects |= {*heads(there, divergence.journal_id).subject.values()}
    number = 2
    while (file, f"{test} ({number})") in subjects:
        number += 1
    return f"{test} ({number})"
