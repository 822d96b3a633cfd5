"""Transfer of campaigns and journals between stores, each in one transaction of the caller; settlement of conflicts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from sqlalchemy import Connection, insert, select

from ..._support.errors import StoreError
from ..._support.messages import Message
from .conflict import entries_by_uid, entry_index, find_divergences
from .journal_entry import DESCRIPTION, NewEntry, insert_entries, next_sequence, number_of_uid, write_entry
from .rows import ID_DIGITS, copy_content, damage_error, require_whole, store_campaign, stored_chunks
from .schema import journal, journal_entry
from .stored_tables import FORMS

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from sqlalchemy import Connection

    from .conflict import Divergence, Side
    from .journal_entry import JournalEntry
    from .rows import StoredCampaign


def take_campaign(source: Connection, to: Connection, stored: StoredCampaign) -> None:
    """Copy a campaign with the bytes of its files.

    Raises
    ------
    StoreError
        It is damaged in the source.
    """
    require_whole(stored)
    for file in stored.files:
        if not copy_content(to, file, stored_chunks(source, file.sha256)):
            raise damage_error(Message("{path} of the campaign {id}", path=file.path, id=stored.sha256[:ID_DIGITS]))
    counts = (stored.n_errors, stored.n_warnings)
    store_campaign(to, stored.files, stored.sha256, stored.name, counts, added_at=stored.added_at)


def take_journal(source: Connection, to: Connection, journal_id: str) -> int:
    """Copy the missing entries of a journal, without those of conflicts; return their number.

    Raises
    ------
    StoreError
        An entry is damaged.
    """
    of_source, held = entry_index(source, journal_id), entry_index(to, journal_id)
    open_ = {
        divergence.subject
        for divergence in find_divergences(source, to, journal_id, of_source, held)
        if not divergence.is_agreed
    }
    wanted = [uid for uid in of_source.missing_in(held) if of_source.subject[uid] not in open_]
    return len(take_entries(source, to, journal_id, wanted))


def take_entries(source: Connection, to: Connection, journal_id: str, uids: Iterable[str]) -> dict[str, int]:
    """Copy entries of a journal, and the journal if it is missing; return their sequences by uid.

    Raises
    ------
    StoreError
        An entry is damaged, or refers to a missing one.
    """
    entries = entries_by_uid(source, journal_id, uids)
    if to.execute(select(journal.c.id).where(journal.c.id == journal_id)).first() is None:
        begun_at = source.execute(select(journal.c.begun_at).where(journal.c.id == journal_id)).scalar_one()
        to.execute(insert(journal).values(id=journal_id, begun_at=begun_at))
    of_source, numbers = entry_index(source, journal_id).uid, dict(entry_index(to, journal_id).sequence)
    once_there = select(journal_entry.c.once).where(journal_entry.c.journal_id == journal_id)
    sent = set(to.execute(once_there).scalars())
    next_, taken = next_sequence(to), []
    for entry in entries:
        number = max(next_, number_of_uid(entry.uid))
        about = None if entry.about is None else numbers.get(of_source.get(entry.about, ""))
        if entry.about is not None and about is None:
            raise damage_error(
                Message("The subject of entry {number} of the campaign {id}", number=entry.sequence, id=journal_id)
            )
        once = None if entry.once in sent else entry.once
        taken.append(replace(entry, sequence=number, about=about, once=once))
        numbers[entry.uid], next_ = number, number + 1
    insert_entries(to, journal_id, taken)
    return {entry.uid: entry.sequence for entry in taken}


def settle(here: Connection, there: Connection, divergence: Divergence, side: Side, who: str) -> None:
    """Write the entries of both sides and the choice between them to this store.

    Raises
    ------
    StoreError
        Both cannot be kept.
    """
    if side not in divergence.choices:
        raise StoreError(
            "The conflict {id} cannot be settled by keeping {side}: {choices}.",
            code="unknown_side",
            id=divergence.id,
            side=side,
            choices=list(divergence.choices),
        )
    numbers = take_entries(there, here, divergence.journal_id, [entry.uid for entry in divergence.there])
    if divergence.subject[0] == DESCRIPTION:
        _write_chosen_description(here, divergence, side, who)
    elif side == "here":
        taken = [numbers[entry.uid] for entry in divergence.there]
        _undo_entries(here, divergence, taken, _why(divergence.there), who)
    elif side == "there":
        own = [entry.sequence for entry in divergence.here]
        _undo_entries(here, divergence, own, _why(divergence.here), who)
    elif divergence.kind == "begun twice":
        _rename(here, there, divergence, who)


def _why(others: Iterable[JournalEntry]) -> str:
    names = ", ".join(dict.fromkeys(entry.who for entry in others if entry.who))
    return f"stores synchronised, the other side kept{f'; written by {names}' if names else ''}"


def _write_chosen_description(here: Connection, divergence: Divergence, side: Side, who: str) -> None:
    chosen = (divergence.here if side == "here" else divergence.there)[-1]
    entry = NewEntry(action="describe", file=DESCRIPTION, cells=chosen.cells, who=who, why="stores synchronised")
    write_entry(here, divergence.journal_id, entry)


def _undo_entries(here: Connection, divergence: Divergence, numbers: Iterable[int], why: str, who: str) -> None:
    file, test = divergence.subject
    for number in sorted(numbers, reverse=True):
        entry = NewEntry(action="undo", file=file, test=test, about=number, who=who, why=why)
        write_entry(here, divergence.journal_id, entry)


def _rename(here: Connection, there: Connection, divergence: Divergence, who: str) -> None:
    """Rename this store's test: its entries are undone and written again with the new name."""
    file, test = divergence.subject
    name = _free_name(here, there, divergence)
    why = f"stores synchronised; goes on as {name}"
    _undo_entries(here, divergence, [entry.sequence for entry in divergence.here], why, who)
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
    subjects = {*entry_index(here, divergence.journal_id).subject.values()}
    subjects |= {*entry_index(there, divergence.journal_id).subject.values()}
    number = 2
    while (file, f"{test} ({number})") in subjects:
        number += 1
    return f"{test} ({number})"
