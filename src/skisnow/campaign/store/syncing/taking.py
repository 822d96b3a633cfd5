"""One store takes from another what it lacks, each campaign or journal in one transaction: whole, or not at all."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from sqlalchemy import Connection, insert, select

from ..entry_rows import insert_entries, next_sequence, number_of_uid
from ..rows import ID_DIGITS, copy_content, damaged, require_whole, store_campaign, stored_chunks
from ..schema import journal, journal_entry
from .conflict import divergences
from .heads import entries_by_uid, heads

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..rows import StoredCampaign


def take_campaign(source: Connection, to: Connection, stored: StoredCampaign) -> None:
    """Take a campaign with the bytes of its files.

    Raises
    ------
    StoreError
        It is damaged in the source.
    """
    require_whole(stored)
    for file in stored.files:
        if not copy_content(to, file, stored_chunks(source, file.sha256)):
            raise damaged(f"{file.path} of the campaign {stored.sha256[:ID_DIGITS]}")
    counts = (stored.n_errors, stored.n_warnings)
    store_campaign(to, stored.files, stored.sha256, stored.name, counts, added_at=stored.added_at)


def take_journal(source: Connection, to: Connection, journal_id: str) -> int:
    """Take the entries of a journal that are lacking, but for tests that both wrote about and do not agree on.

    Returns how many were taken.

    Raises
    ------
    StoreError
        An entry is damaged.
    """
    of_source, held = heads(source, journal_id), heads(to, journal_id)
    open_ = {each.subject for each in divergences(source, to, journal_id, of_source, held) if not each.is_agreed}
    wanted = [uid for uid in of_source.missing_in(held) if of_source.subject[uid] not in open_]
    return len(take_entries(source, to, journal_id, wanted))


def take_entries(source: Connection, to: Connection, journal_id: str, uids: Iterable[str]) -> dict[str, int]:
    """Take these entries of a journal, and the journal where it is lacking; their numbers by their uids.

    Raises
    ------
    StoreError
        An entry is damaged, or is about one that is not there.
    """
    entries = entries_by_uid(source, journal_id, uids)
    if to.execute(select(journal.c.id).where(journal.c.id == journal_id)).first() is None:
        begun_at = source.execute(select(journal.c.begun_at).where(journal.c.id == journal_id)).scalar_one()
        to.execute(insert(journal).values(id=journal_id, begun_at=begun_at))
    of_source, numbers = heads(source, journal_id).uid, dict(heads(to, journal_id).sequence)
    once_there = select(journal_entry.c.once).where(journal_entry.c.journal_id == journal_id)
    sent = set(to.execute(once_there).scalars())
    next_, taken = next_sequence(to), []
    for entry in entries:
        number = max(next_, number_of_uid(entry.uid))
        about = None if entry.about is None else numbers.get(of_source.get(entry.about, ""))
        if entry.about is not None and about is None:
            raise damaged(f"What the entry {entry.sequence} of the campaign {journal_id} is about")
        once = None if entry.once in sent else entry.once
        taken.append(replace(entry, sequence=number, about=about, once=once))
        numbers[entry.uid], next_ = number, number + 1
    insert_entries(to, journal_id, taken)
    return {entry.uid: entry.sequence for entry in taken}
