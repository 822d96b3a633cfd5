"""What was corrected in a campaign that is kept byte for byte, as rows of its corrections.csv."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Final

from ...files import write_file
from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS
from ..reading.text import look_at_csv
from .grown import grown
from .journal import Journals
from .kept_tables import cell_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from .grown import GrownTest
    from .journal import JournalEntry
    from .store import Store, StoredCampaign

COLUMNS: Final = ("file", "experiment", "row", "column", "old", "new", "who", "when", "why")


def export_corrected(store: Store, id_: str, folder: Path) -> StoredCampaign:
    """Give a kept campaign back in a new folder: its files byte for byte, and what was corrected since.

    Corrections stand in corrections.csv behind those that came with the campaign; where there are none, every file is
    as it came in.

    Raises
    ------
    StoreError
        As `Store.export`.
    """
    stored = store.export(id_, folder)
    add_corrections(folder, Journals(store).corrections(stored.id))
    return stored


def add_corrections(folder: Path, entries: Iterable[JournalEntry], *, before: bytes | None = None) -> None:
    """Write corrections.csv into a campaign's folder, where there is something to correct.

    Parameters
    ----------
    folder
        The campaign's files.
    entries
        Those about the campaign, oldest first.
    before
        corrections.csv as it came with the campaign; None: as it stands in the folder.
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


def _together(before: bytes, rows: list[dict[str, str]]) -> str:
    """One file: the rows that came with the campaign with all their columns, then ours."""
    records = [cells for _, some in look_at_csv(before).records() for cells in some] if before.strip() else []
    header = [cell.strip() for cell in records.pop(0)] if records else []
    header += [column for column in COLUMNS if column not in header]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([*cells, *[""] * (len(header) - len(cells))] for cells in records)
    writer.writerows([row.get(column, "") for column in header] for row in rows)
    return stream.getvalue()


def _rows(entries: Iterable[JournalEntry]) -> Iterator[dict[str, str]]:
    for test in grown(entries).tests.values():
        if test.rows:
            yield from _rows_of(test)


def _rows_of(test: GrownTest) -> Iterator[dict[str, str]]:
    """The rows about one test, in the order of the entries."""
    now = dict(test.rows[0].entered.cells)
    first = min(cell_of(key)[0] for key in now)
    for entry in test.history:
        if entry.sequence in test.undone or entry.action not in ("correct", "cancel"):
            continue
        cells = entry.cells if entry.action == "correct" else {f"{first}/{STATUS}": entry.why}
        for key, new in cells.items():
            line, column = cell_of(key)
            said = (entry.file, entry.test, str(line), column, now.get(key, ""), new, entry.who, entry.at, entry.why)
            yield dict(zip(COLUMNS, said, strict=True))
            now[key] = new
