"""What was corrected in a stored campaign, whose files stay byte for byte, as rows of its corrections.csv."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..._support.errors import StoreError
from ..._support.staging import write_file
from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS
from ..reading.text import UnreadableTextError, inspect_csv
from .folder import no_progress
from .journal import Journals
from .replayed import COLUMNS, correction_row, csv_text, replayed
from .stored_tables import cell_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from pathlib import Path

    from .folder import Progress
    from .journal_entry import JournalEntry
    from .replayed import ReplayedTest
    from .store import Store, StoredCampaign


@dataclass(frozen=True, slots=True)
class ExportedCampaign:
    """A campaign that was given back, and how many cells were corrected since it was stored."""

    stored: StoredCampaign
    n_corrections: int


def export_corrected(store: Store, id_: str, folder: Path, *, progress: Progress = no_progress) -> ExportedCampaign:
    """Give a stored campaign back in a new folder: its files byte for byte, and what was corrected since.

    Corrections stand in corrections.csv behind those that came with the campaign; where there are none, every file is
    as it came in.

    Raises
    ------
    StoreError
        As `Store.export`; and where a corrections.csv that came with the campaign cannot be gone on with.
    """
    entries = Journals(store).corrections(store.show(id_).id)
    written: list[int] = []
    stored = store.export(
        id_, folder, progress=progress, complete=lambda filled: written.append(add_corrections(filled, entries))
    )
    return ExportedCampaign(stored, sum(written))


def add_corrections(folder: Path, entries: Iterable[JournalEntry], *, before: bytes | None = None) -> int:
    """Write corrections.csv into a campaign's folder, where there is something to correct; says how many cells are.

    Parameters
    ----------
    folder
        The campaign's files.
    entries
        Those about the campaign, oldest first.
    before
        corrections.csv as it came with the campaign; None: as it stands in the folder.

    Raises
    ------
    StoreError
        That file cannot be read.
    """
    place = folder / CORRECTIONS.file
    rows = list(_rows(entries))
    if before is None:
        before = place.read_bytes() if place.is_file() else b""
    if rows:
        write_file(place, _together(before, rows))
    elif before:
        write_file(place, before)
    else:
        place.unlink(missing_ok=True)
    return len(rows)


def corrected_files(files: Mapping[str, bytes], entries: Iterable[JournalEntry]) -> dict[str, bytes]:
    """The files of a campaign with the corrections.csv that `add_corrections` would write beside them.

    Raises
    ------
    StoreError
        The corrections.csv that came with the campaign cannot be read.
    """
    rows = list(_rows(entries))
    if not rows:
        return dict(files)
    return {**files, CORRECTIONS.file: _together(files.get(CORRECTIONS.file, b""), rows).encode("utf-8")}


def _together(before: bytes, rows: list[dict[str, str]]) -> str:
    """One file: the rows that came with the campaign with all their columns, then ours."""
    records = _records(before) if before.strip() else []
    header = [cell.strip() for cell in records.pop(0)] if records else []
    header += [column for column in COLUMNS if column not in header]
    came = ([*cells, *[""] * (len(header) - len(cells))] for cells in records)
    ours = ([row.get(column, "") for column in header] for row in rows)
    return csv_text([header, *came, *ours])


def _records(data: bytes) -> list[list[str]]:
    try:
        return [cells for _, some in inspect_csv(data).records() for cells in some]
    except UnreadableTextError as error:
        raise StoreError(
            f"The {CORRECTIONS.file} that came with the campaign cannot be read, so that no rows can follow: "
            f"{error.allowed} is wanted. `skisnow store export --as-added` gives the files without later corrections."
        ) from error


def _rows(entries: Iterable[JournalEntry]) -> Iterator[dict[str, str]]:
    """Test by test, in the order in which they were first corrected."""
    for test in sorted(replayed(entries).tests.values(), key=_first_by_hand):
        if test.rows:
            yield from _rows_of(test)


def _first_by_hand(test: ReplayedTest) -> str:
    return min((entry.uid for entry in test.history if not entry.is_from_file), default="")


def _rows_of(test: ReplayedTest) -> Iterator[dict[str, str]]:
    """The rows about one test, in the order of the entries."""
    now = dict(test.rows[0].entered.cells)
    first = min(cell_of(key)[0] for key in now)
    for entry in test.history:
        if entry.sequence in test.undone or entry.action not in ("correct", "cancel"):
            continue
        cells = entry.cells if entry.action == "correct" else {f"{first}/{STATUS}": entry.why}
        for key, new in cells.items():
            line, column = cell_of(key)
            yield dict(zip(COLUMNS, correction_row(entry, line, column, now.get(key, ""), new), strict=True))
            now[key] = new
