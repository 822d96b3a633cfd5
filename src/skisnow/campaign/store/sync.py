"""Synchronisation of two stores in both directions: campaigns with their files, and journals entry by entry.

A run has no memory of earlier ones: it compares both stores by hashes and uids. Each campaign and each journal is
transferred in one transaction, so that an interrupted run can be repeated.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import count
from typing import Final

from sqlalchemy import Connection, insert, select

from ..._support.errors import StoreError
from ..._support.messages import Message
from . import rows
from .conflict import Conflict, Side, entries_by_uid, entry_index, open_conflicts, shared_journals
from .engine import database_errors, reading, writing
from .folder import Progress, no_progress
from .journal import DESCRIPTION, NewEntry, entered_name, insert_entries, next_sequence, number_of_uid, write_entry
from .schema import campaign, journal, journal_entry
from .store import Store
from .stored_tables import FORMS

ALL: Final = "all"
"""Instead of a conflict's id: all open conflicts."""


@dataclass(frozen=True, slots=True)
class SyncResult:
    """Result of a synchronisation.

    n_campaigns_given, n_campaigns_taken: number of stored campaigns that were sent, and received.
    n_entries_given, n_entries_taken: number of journal entries that were sent, and received.
    n_settled: number of conflicts that were settled by choices.
    conflicts: open conflicts.
    problems: sentences on damaged campaigns and journals, which were not transferred.
    """

    n_campaigns_given: int
    n_campaigns_taken: int
    n_entries_given: int
    n_entries_taken: int
    n_settled: int
    conflicts: tuple[Conflict, ...]
    problems: tuple[str, ...]


def sync(
    here: Store,
    there: Store,
    *,
    keep: Mapping[str, Side] | None = None,
    who: str = "",
    progress: Progress = no_progress,
) -> SyncResult:
    """Transfer missing campaigns and entries between two stores, except contradicting entries about a test.

    here, there: the user's store, where choices are written first; the group's store, on a server or in a file.
    keep: sides to keep by id of the conflict or ``"all"``: here, there, or both if possible.
    who: author of the choices.
    progress: called with the number of compared campaigns and their total.
    Raises StoreError: a store cannot be reached, read or written, both are the same, or a choice names no open
        conflict. Completed transfers stay; another run continues.
    """
    if here.path == there.path:
        raise StoreError("{path} cannot be synchronised with itself; name the group's store.").tag(
            "same_store", path=here.path
        )
    return _Sync(here, there).run(keep or {}, who, progress)


class _Sync:
    """Steps of one synchronisation between two stores."""

    def __init__(self, here: Store, there: Store) -> None:
        self._here, self._there = here, there
        self._problems: list[str] = []

    def run(self, chosen: Mapping[str, Side], who: str, progress: Progress) -> SyncResult:
        """Settle the chosen conflicts, copy what each store lacks, and return counts and open conflicts."""
        with database_errors(self._there.path, "not_synchronised"):
            n_settled = self._settle_conflicts(chosen, who)
            to_there, to_here = (self._here, self._there), (self._there, self._here)
            return SyncResult(
                n_campaigns_given=self._copy_campaigns(*to_there),
                n_campaigns_taken=self._copy_campaigns(*to_here),
                n_entries_given=self._copy_journals(*to_there, lambda done, n: progress(done, 2 * n)),
                n_entries_taken=self._copy_journals(*to_here, lambda done, n: progress(n + done, 2 * n)),
                n_settled=n_settled,
                conflicts=self._find_conflicts(),
                problems=tuple(self._problems),
            )

    def _copy_campaigns(self, source: Store, to: Store) -> int:
        """Copy missing campaigns with their files; returns their number and records damaged ones as problems."""
        with reading(to.engine) as connection:
            held = rows.campaign_rows(connection)
        n_taken = 0
        with reading(source.engine) as from_:
            missing = {sha256: row for sha256, row in rows.campaign_rows(from_).items() if sha256 not in held}
            for _, row in sorted(missing.items()):
                try:
                    stored = rows.stored_campaign(from_, row)
                    rows.require_whole(stored)
                    with writing(to.engine) as connection:
                        for file in stored.files:
                            if not rows.copy_content(connection, file, rows.stored_chunks(from_, file.sha256)):
                                names = {"path": file.path, "id": stored.sha256[: rows.ID_DIGITS]}
                                raise rows.damage_error(Message("{path} of the campaign {id}", **names))
                        rows.store_campaign(connection, stored)
                    n_taken += 1
                except StoreError as error:
                    self._problems.append(f"{source.path}: {error}")
        return n_taken

    def _copy_journals(self, source: Store, to: Store, progress: Progress) -> int:
        """Copy the missing entries of all shared journals, without those of conflicts; return their number."""
        n_taken = 0
        with reading(source.engine) as from_:
            with reading(to.engine) as connection:
                ids = list(shared_journals(from_, connection))
            for number, id_ in enumerate(ids):
                with self._collect_damage(id_):
                    of_source = entry_index(from_, id_)
                    with reading(to.engine) as connection:  # no write lock if nothing is missing
                        is_complete = not of_source.missing_in(entry_index(connection, id_))
                    if not is_complete:
                        with writing(to.engine) as connection:
                            missing = of_source.missing_in(entry_index(connection, id_))
                            open_ = {
                                (conflict.file, conflict.test) for conflict in open_conflicts(from_, connection, id_)
                            }
                            wanted = [uid for uid in missing if of_source.subject[uid] not in open_]
                            n_taken += len(take_entries(from_, connection, id_, wanted))
                progress(number + 1, len(ids))
        return n_taken

    def _settle_conflicts(self, chosen: Mapping[str, Side], who: str) -> int:
        """Write all choices in one transaction; return their number."""
        if not chosen:
            return 0
        with reading(self._there.engine) as there, writing(self._here.engine) as here:
            open_ = {conflict.id: conflict for conflict in self._open_conflicts(here, there)}
            if unknown := sorted(chosen.keys() - open_.keys() - {ALL}):
                raise StoreError(
                    "There is no open conflict {names}: one of its sides may have changed. Nothing was settled; "
                    "synchronise without a choice to list the open conflicts."
                ).tag("unknown_conflict", names=list(unknown))
            sides = {id_: chosen.get(id_, chosen.get(ALL)) for id_ in open_}
            choices = [(open_[id_], side) for id_, side in sides.items() if side is not None]
            for conflict, side in choices:
                settle(here, there, conflict, side, who)
        return len(choices)

    def _find_conflicts(self) -> tuple[Conflict, ...]:
        """Conflicts that are still open, with the names of their campaigns."""
        with reading(self._here.engine) as here, reading(self._there.engine) as there:
            open_ = list(self._open_conflicts(here, there))
            return tuple(replace(conflict, name=_name(here, conflict.campaign)) for conflict in open_)

    def _open_conflicts(self, here: Connection, there: Connection) -> Iterator[Conflict]:
        """Open conflicts of all campaigns in entry that both stores have; damaged ones become problems."""
        for id_ in shared_journals(here, there):
            with self._collect_damage(id_):
                yield from list(open_conflicts(here, there, id_))

    @contextmanager
    def _collect_damage(self, journal_id: str) -> Iterator[None]:
        """Add the damage of a journal, with its store, to the problems instead of raising it."""
        try:
            yield
        except StoreError as error:
            damage = [
                f"{store.path}: {why}" for store in (self._here, self._there) if (why := _damage(store, journal_id))
            ]
            self._problems += [message for message in damage or [str(error)] if message not in self._problems]


def _damage(store: Store, journal_id: str) -> str:
    """Error text if a campaign in entry cannot be read whole from a store; "" if it can."""
    try:
        with reading(store.engine) as connection:
            entries_by_uid(connection, journal_id, entry_index(connection, journal_id).subject)
    except StoreError as error:
        return str(error)
    return ""


def _name(connection: Connection, id_: str) -> str:
    """Name of a campaign that is stored or in entry; "" without one."""
    name = connection.execute(select(campaign.c.name).where(campaign.c.id == id_)).scalar()
    return name if isinstance(name, str) else entered_name(connection, id_)


def take_entries(source: Connection, to: Connection, journal_id: str, uids: Iterable[str]) -> dict[str, int]:
    """Copy entries, and a missing journal; return sequences by uid. StoreError: one is damaged or lacks its subject."""
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
            raise rows.damage_error(
                Message("The subject of entry {number} of the campaign {id}", number=entry.sequence, id=journal_id)
            )
        once = None if entry.once in sent else entry.once
        taken.append(replace(entry, sequence=number, about=about, once=once))
        numbers[entry.uid], next_ = number, number + 1
    insert_entries(to, journal_id, taken)
    return {entry.uid: entry.sequence for entry in taken}


def settle(here: Connection, there: Connection, conflict: Conflict, side: Side, who: str) -> None:
    """Copy the other store's entries of a conflict to `here` and apply the choice; StoreError if that is impossible."""
    if side not in conflict.choices:
        raise StoreError("The conflict {id} cannot be settled by keeping {side}: {choices}.").tag(
            "unknown_side", id=conflict.id, side=side, choices=list(conflict.choices)
        )
    numbers = take_entries(there, here, conflict.campaign, [entry.uid for entry in conflict.entries_there])
    if conflict.file == DESCRIPTION:
        cells = (conflict.entries_here if side == "here" else conflict.entries_there)[-1].cells
        entry = NewEntry(action="describe", file=DESCRIPTION, cells=cells, who=who, why="stores synchronised")
        write_entry(here, conflict.campaign, entry)
    elif side != "both":
        others = conflict.entries_there if side == "here" else conflict.entries_here
        names = ", ".join(dict.fromkeys(entry.who for entry in others if entry.who))
        why = f"stores synchronised, the other side kept{f'; written by {names}' if names else ''}"
        _undo_entries(here, conflict, [numbers.get(entry.uid, entry.sequence) for entry in others], why, who)
    elif conflict.kind == "begun twice":
        _rename(here, there, conflict, who)


def _undo_entries(here: Connection, conflict: Conflict, numbers: Iterable[int], why: str, who: str) -> None:
    """Undo a test's entries with these sequence numbers, last one first, with a reason."""
    file, test = conflict.file, conflict.test
    for number in sorted(numbers, reverse=True):
        entry = NewEntry(action="undo", file=file, test=test, about=number, who=who, why=why)
        write_entry(here, conflict.campaign, entry)


def _rename(here: Connection, there: Connection, conflict: Conflict, who: str) -> None:
    """Rename the test of this store (`here`): its entries are undone and written again with a new name."""
    file, test = conflict.file, conflict.test
    key = FORMS[file].key if file in FORMS else ""
    subjects = {
        subject for store in (here, there) for subject in entry_index(store, conflict.campaign).subject.values()
    }
    name = next(free for number in count(2) if (file, free := f"{test} ({number})") not in subjects)
    why = f"stores synchronised; goes on as {name}"
    _undo_entries(here, conflict, [entry.sequence for entry in conflict.entries_here], why, who)
    numbers: dict[int, int] = {}
    for entry in conflict.entries_here:
        about = None if entry.about is None else numbers[entry.about]
        plain = {field: getattr(entry, field) for field in ("action", "file", "position", "who", "why")}
        cells = {column: name if column == key and text == test else text for column, text in entry.cells.items()}
        new = NewEntry(**plain, test=name, cells=cells, about=about)
        written = write_entry(here, conflict.campaign, new, at=entry.at)
        numbers[entry.sequence] = written.sequence
