"""Export of stored campaigns and of campaigns in entry, with later corrections; photos and positions of tests."""

from __future__ import annotations

import base64
import binascii
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Final, TypeAlias
from uuid import uuid4

from ..._support.csv_text import UnreadableTextError, inspect_csv
from ..._support.errors import ParameterError, StoreError
from ..._support.staging import write_file
from ..problems import AppliedCorrection
from ..reading.campaign import ATTACHMENTS
from ..reading.corrections import STATUS
from ..reading.table_forms import CORRECTIONS
from . import replayed
from .engine import database_errors, file_errors, reading
from .folder import Progress, StoredFile, new_folder, no_progress
from .journal import JournalEntry, JournalHead, Journals, NewEntry
from .replayed import ReplayedCampaign, ReplayedTest, replay_journal
from .rows import StoredCampaign, campaign_rows, pick_id
from .store import Store
from .stored_tables import cell_of

_ATTACHMENT_COLUMNS: Final = ("table", "test", "time", "who", "latitude_deg", "longitude_deg", "accuracy_m", "photo")
"""Columns of attachments.csv; `photo`: path of the file in the exported campaign."""
MOST_PHOTO_BYTES: Final = 700_000
"""A photo of 1600 px has 300 to 600 kB; the journal contains it as text."""
_JPEG: Final = b"\xff\xd8\xff"
_PIECE: Final = 90_000
"""Characters in a cell of an entry: the journal accepts no longer text."""


@dataclass(frozen=True, slots=True)
class Position:
    """Latitude and longitude in degrees (WGS 84), and the radius in m that the receiver states."""

    latitude_deg: float
    longitude_deg: float
    accuracy_m: float

    def __post_init__(self) -> None:
        numbers = (self.latitude_deg, self.longitude_deg, self.accuracy_m)
        is_place = all(map(math.isfinite, numbers)) and abs(self.latitude_deg) <= 90.0 >= abs(self.longitude_deg) / 2.0
        if not is_place or self.accuracy_m < 0.0:
            raise ParameterError(
                "{position} is not a position. Allowed: latitude up to ±90°, longitude up to ±180°, accuracy of 0 m or "
                "more."
            ).tag("no_position", position=list(numbers))


def photo_entry(file: str, test: str, photo: str, *, who: str = "") -> NewEntry:
    """Entry that attaches a photo to a test; `photo` is a JPEG file in base64.

    Raises ParameterError: it is not a JPEG file, or larger than `MOST_PHOTO_BYTES`.
    """
    try:
        data = base64.b64decode(photo, validate=True)
    except (binascii.Error, ValueError):
        data = b""
    if not data.startswith(_JPEG) or len(data) > MOST_PHOTO_BYTES:
        raise ParameterError(
            "The photo is not stored: {size} bytes. Allowed: a JPEG file of at most {most} bytes."
        ).tag("no_photo", size=len(data), most=MOST_PHOTO_BYTES)
    pieces = (photo[at : at + _PIECE] for at in range(0, len(photo), _PIECE))
    return _attachment_entry(file, test, {f"photo_{number:02d}": piece for number, piece in enumerate(pieces)}, who)


def photo_of(attachment: ReplayedTest) -> bytes:
    """Bytes of the JPEG file of an attachment; empty for a position."""
    cells = attachment.rows[0].cells
    return base64.b64decode("".join(cells[name] for name in sorted(cells) if name.startswith("photo_")))


def position_entry(file: str, test: str, position: Position, *, who: str = "") -> NewEntry:
    """New entry with latitude and longitude (°) and accuracy (m) of a test; ``who``: its writer."""
    cells = {name: f"{getattr(position, name):.10g}" for name in ("latitude_deg", "longitude_deg", "accuracy_m")}
    return _attachment_entry(file, test, cells, who)


def _attachment_entry(table: str, test: str, cells: dict[str, str], who: str) -> NewEntry:
    """Journal entry that attaches cells, a photo or a position, to a test of a table."""
    name = f"{table.removesuffix('.csv')} {test} {uuid4().hex[:8]}"  # unique: two laptops never write the same one
    return NewEntry(
        action="add", file=ATTACHMENTS, test=name, cells={"table": table, "test": test, **cells}, position=0, who=who
    )


def attachments_of(campaign: ReplayedCampaign, file: str, test: str) -> list[ReplayedTest]:
    """Attachments (photos and positions) of a test that are not cancelled, in the order of entry."""
    return [
        entry
        for entry in campaign.of_file(ATTACHMENTS)
        if not entry.cancelled and (entry.rows[0].cells["table"], entry.rows[0].cells["test"]) == (file, test)
    ]


def attachment_files(campaign: ReplayedCampaign, before: bytes = b"") -> Iterator[tuple[str, bytes]]:
    """Files of all photos, and attachments.csv: rows of the file `before`, then one for each photo and position."""
    rows: list[dict[str, str]] = []
    for number, attachment in enumerate(campaign.of_file(ATTACHMENTS), start=1):
        entered, cells = attachment.rows[0].entered, dict(attachment.rows[0].cells)
        if attachment.cancelled:
            continue
        if photo := photo_of(attachment):
            path = f"photos/{number:04d}-{attachment.name.rpartition(' ')[2]}.jpg"
            yield path, photo
            cells["photo"] = path
        cells |= {"time": entered.at, "who": entered.who}
        rows.append(cells)
    if rows:
        yield ATTACHMENTS, with_rows(before, ATTACHMENTS, _ATTACHMENT_COLUMNS, rows).encode("utf-8")


def rows_of_file(data: bytes, file: str, test: str) -> list[dict[str, str]]:
    """Rows of an attachments.csv about a test; [] if the file cannot be read."""
    try:
        header, *rows = _parse_records(data, ATTACHMENTS)
    except (StoreError, ValueError):
        return []
    cells = [dict(zip(map(str.strip, header), row, strict=False)) for row in rows]
    return [row for row in cells if (row.get("table"), row.get("test")) == (file, test)]


def with_rows(before: bytes, file: str, columns: Sequence[str], rows: Iterable[Mapping[str, str]]) -> str:
    """Text of a CSV file: the rows of the file `before` with all their columns, then `rows` with `columns`.

    Raises StoreError: the file cannot be read.
    """
    records = _parse_records(before, file) if before.strip() else []
    header = [cell.strip() for cell in records.pop(0)] if records else []
    header += [column for column in columns if column not in header]
    came = ([*cells, *[""] * (len(header) - len(cells))] for cells in records)
    return replayed.guarded_csv([header, *came, *([cells.get(column, "") for column in header] for cells in rows)])


def _parse_records(data: bytes, file: str) -> list[list[str]]:
    """Rows of cells of a CSV file; a StoreError if it cannot be read."""
    try:
        return [cells for _, some in inspect_csv(data).records() for cells in some]
    except UnreadableTextError as error:
        raise StoreError(
            "The file {file} of the campaign cannot be read, so that no rows can be appended: {allowed} is required. "
            "`skisnow store export --as-added` exports the files without later corrections."
        ).tag("unreadable_corrections", file=file, allowed=error.allowed) from error


def exported_files(campaign: ReplayedCampaign) -> dict[str, bytes]:
    """Bytes of all files of a campaign in entry by path: description, tables, corrections, photos and positions."""
    files = {name: text.encode("utf-8") for name, text in replayed.campaign_files(campaign).items()}
    return files | dict(attachment_files(campaign))


def write_campaign(campaign: ReplayedCampaign, folder: Path) -> None:
    """Write all files of a campaign to an existing folder, without flushing: they can be written again at any time."""
    for name, data in exported_files(campaign).items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)


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
    cells = [dict(zip(replayed.COLUMNS, replayed.correction_cells(row), strict=True)) for row in _corrections(entries)]
    if not cells:
        return dict(files)
    text = with_rows(files.get(CORRECTIONS.file, b""), CORRECTIONS.file, replayed.COLUMNS, cells)
    return {**files, CORRECTIONS.file: text.encode("utf-8")}


def _corrections(entries: Iterable[JournalEntry]) -> Iterator[AppliedCorrection]:
    """Corrected cells of entries about a stored campaign, test by test, in the order of their first corrections."""
    tests = [test for test in replay_journal(entries).tests.values() if test.rows and test.file != ATTACHMENTS]
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
                yield replayed.correction_of_cell(entry, line, column, cells_now.get(key, ""), new)
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
