"""Export of stored campaigns and of campaigns in entry, with later corrections."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import TypeAlias

from ..._support.csv_text import UnreadableTextError, inspect_csv
from ..._support.errors import StoreError
from ..._support.staging import write_file
from ..problems import AppliedCorrection
from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS
from .engine import database_errors, file_errors, reading
from .folder import Progress, StoredFile, new_folder, no_progress
from .journal import JournalHead, Journals
from .journal_entry import JournalEntry
from .replayed import (
    COLUMNS,
    ReplayedCampaign,
    campaign_files,
    correction_cells,
    correction_of_cell,
    guarded_csv,
    replay_journal,
)
from .rows import StoredCampaign, campaign_rows, pick_id
from .store import Store
from .stored_tables import cell_of


def write_campaign(campaign: ReplayedCampaign, folder: Path) -> None:
    """Write all files of a campaign to an existing folder, without flushing: they can be written again at any time."""
    for name, text in campaign_files(campaign).items():
        (folder / name).write_bytes(text.encode("utf-8"))


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

    def add_corrections(filled: Path) -> None:
        place = filled / CORRECTIONS.file
        before = {place.name: place.read_bytes()} if place.is_file() else {}
        after = corrected_files(before, entries)
        if after != before:
            write_file(place, after[place.name])

    stored = store.export(id_, folder, progress=progress, complete=add_corrections)
    return ExportedCampaign(stored, len(list(_corrections(entries))))


def corrected_files(files: Mapping[str, bytes], entries: Iterable[JournalEntry]) -> dict[str, bytes]:
    """Files of a campaign, with the later corrections appended to corrections.csv.

    Raises StoreError: the corrections.csv of the campaign cannot be read.
    """
    cells = [dict(zip(COLUMNS, correction_cells(row), strict=True)) for row in _corrections(entries)]
    if not cells:
        return dict(files)
    try:
        before = [row for _, rows in inspect_csv(files.get(CORRECTIONS.file, b"")).records() for row in rows]
    except UnreadableTextError as error:
        raise StoreError(
            "The file {file} of the campaign cannot be read, so that no rows can be appended: {allowed} is required. "
            "`skisnow store export --as-added` exports the files without later corrections."
        ).tag("unreadable_corrections", file=CORRECTIONS.file, allowed=error.allowed) from error
    header = [cell.strip() for cell in before.pop(0)] if before else []
    header += [column for column in COLUMNS if column not in header]
    came = ([*row, *[""] * (len(header) - len(row))] for row in before)
    text = guarded_csv([header, *came, *([row.get(column, "") for column in header] for row in cells)])
    return {**files, CORRECTIONS.file: text.encode("utf-8")}


def _corrections(entries: Iterable[JournalEntry]) -> Iterator[AppliedCorrection]:
    """Corrected cells of entries about a stored campaign, test by test, in the order of their first corrections."""
    tests = [test for test in replay_journal(entries).tests.values() if test.rows]
    tests.sort(key=lambda test: min((entry.uid for entry in test.history if not entry.is_from_file), default=""))
    for test in tests:
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
    texts = campaign_files(replay_journal(Journals(store).entries(id)))
    contents = ((path, text.encode("utf-8")) for path, text in sorted(texts.items()))
    return tuple(StoredFile(path, len(data), sha256(data).hexdigest()) for path, data in contents)


def export_entered(store: Store, id: str, folder: Path) -> None:
    """Export a campaign from lab entries to a new folder, which `read_campaign` reads.

    Raises StoreError: the campaign is unknown, an entry is damaged, or the folder exists and is not empty.
    """
    campaign = replay_journal(Journals(store).entries(id))
    with file_errors(folder, "not_written"), new_folder(folder) as filling:
        write_campaign(campaign, filling)
