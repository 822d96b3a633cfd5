"""Export of campaigns: stored files with later corrections in corrections.csv, and campaigns from lab entries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TypeAlias

from ..._support.staging import write_file
from ..problems import AppliedCorrection
from ..reading.campaign import ATTACHMENTS
from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS
from .attachments import attachment_files, exported_files, with_rows, write_campaign
from .engine import database_errors, file_errors, reading
from .folder import Progress, StoredFile, new_folder, no_progress
from .journal import JournalHead, Journals
from .journal_entry import JournalEntry
from .replayed import (
    COLUMNS,
    ReplayedTest,
    correction_cells,
    correction_of_cell,
    replay_journal,
)
from .rows import StoredCampaign, campaign_rows, pick_id
from .store import Store
from .stored_tables import cell_of


@dataclass(frozen=True, slots=True)
class ExportedCampaign:
    """An exported campaign, and the number of cells that were corrected since it was stored."""

    stored: StoredCampaign
    n_corrections: int


def export_corrected(store: Store, id_: str, folder: Path, *, progress: Progress = no_progress) -> ExportedCampaign:
    """Export a stored campaign to a new folder: its files byte for byte, and later corrections.

    Corrections are appended to corrections.csv; without corrections all files are unchanged.

    Raises StoreError: as `Store.export`; or the corrections.csv of the campaign cannot be read.
    """
    entries = Journals(store).corrections(store.show(id_).id)
    stored = store.export(id_, folder, progress=progress, complete=lambda filled: _add_later_files(filled, entries))
    return ExportedCampaign(stored, len(list(_corrections(entries))))


def _add_later_files(folder: Path, entries: Sequence[JournalEntry]) -> None:
    """Add corrections, photos and positions to the files of an exported campaign."""
    places = {name: folder / name for name in (CORRECTIONS.file, ATTACHMENTS)}
    before = {name: place.read_bytes() for name, place in places.items() if place.is_file()}
    after = corrected_files(before, entries)
    after |= attachment_files(replay_journal(entries), before.get(ATTACHMENTS, b""))
    for name, data in after.items():
        if data != before.get(name):
            (folder / name).parent.mkdir(exist_ok=True)
            write_file(folder / name, data)


def corrected_files(files: Mapping[str, bytes], entries: Iterable[JournalEntry]) -> dict[str, bytes]:
    """Files of a campaign, with the later corrections appended to corrections.csv.

    Raises StoreError: the corrections.csv of the campaign cannot be read.
    """
    cells = [dict(zip(COLUMNS, correction_cells(row), strict=True)) for row in _corrections(entries)]
    if not cells:
        return dict(files)
    text = with_rows(files.get(CORRECTIONS.file, b""), CORRECTIONS.file, COLUMNS, cells)
    return {**files, CORRECTIONS.file: text.encode("utf-8")}


def _corrections(entries: Iterable[JournalEntry]) -> Iterator[AppliedCorrection]:
    """Corrections, test by test, in the order of the first correction of each test."""
    for test in sorted(replay_journal(entries).tests.values(), key=_uid_of_first_manual_entry):
        if test.rows and test.file != ATTACHMENTS:
            yield from _corrections_of_test(test)


def _uid_of_first_manual_entry(test: ReplayedTest) -> str:
    return min((entry.uid for entry in test.history if not entry.is_from_file), default="")


def _corrections_of_test(test: ReplayedTest) -> Iterator[AppliedCorrection]:
    """Corrections of one test, in the order of the entries."""
    cells_now = dict(test.rows[0].entered.cells)
    first = min(cell_of(key)[0] for key in cells_now)
    for entry in test.history:
        if entry.sequence in test.undone or entry.action not in ("correct", "cancel"):
            continue
        cells = entry.cells if entry.action == "correct" else {f"{first}/{STATUS}": entry.why}
        for key, new in cells.items():
            line, column = cell_of(key)
            yield correction_of_cell(entry, line, column, cells_now.get(key, ""), new)
            cells_now[key] = new


FoundCampaign: TypeAlias = StoredCampaign | JournalHead


def find_campaign(store: Store, id: str) -> FoundCampaign:
    """Find a campaign by the beginning of its id, among stored campaigns and lab entries.

    Raises StoreError: no campaign or several have this beginning; the message lists candidates.
    """
    heads = {head.id: head for head in Journals(store).list()}
    with database_errors(store.path, "not_read"), reading(store.engine) as connection:
        stored = {sha256: row.name for sha256, row in campaign_rows(connection).items()}
    chosen = pick_id(id, {head.id: head.name for head in heads.values()} | stored)
    return heads[chosen] if chosen in heads else store.show(chosen)


def entered_files(store: Store, id: str) -> tuple[StoredFile, ...]:
    """Files that `export_entered` writes, sorted by path; errors as there."""
    contents = exported_files(replay_journal(Journals(store).entries(id)))
    return tuple(StoredFile(path, len(data), sha256(data).hexdigest()) for path, data in sorted(contents.items()))


def export_entered(store: Store, id: str, folder: Path) -> None:
    """Export a campaign from lab entries to a new folder, which `read_campaign` reads.

    Raises StoreError: the campaign is unknown, an entry is damaged, or the folder exists and is not empty.
    """
    campaign = replay_journal(Journals(store).entries(id))
    with file_errors(folder, "not_written"), new_folder(folder) as filling:
        write_campaign(campaign, filling)
