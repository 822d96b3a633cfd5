"""Photos and positions of tests in entry: entries of the journal, and files of the exported campaign."""

from __future__ import annotations

import base64
import binascii
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from uuid import uuid4

from ..._support.csv_text import UnreadableTextError, inspect_csv
from ..._support.errors import ParameterError, StoreError
from ..reading.campaign import ATTACHMENTS
from .journal_entry import NewEntry
from .replayed import ReplayedCampaign, ReplayedTest, campaign_files, guarded_csv

COLUMNS: Final = ("table", "test", "time", "who", "latitude_deg", "longitude_deg", "accuracy_m", "photo")
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
    """Entry of a photo of a test; `photo` is a JPEG file in base64.

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
    """JPEG file of an attachment; empty for a position."""
    cells = attachment.rows[0].cells
    return base64.b64decode("".join(cells[name] for name in sorted(cells) if name.startswith("photo_")))


def position_entry(file: str, test: str, position: Position, *, who: str = "") -> NewEntry:
    """Entry of the position of a test."""
    cells = {name: f"{getattr(position, name):.10g}" for name in ("latitude_deg", "longitude_deg", "accuracy_m")}
    return _attachment_entry(file, test, cells, who)


def _attachment_entry(file: str, test: str, cells: dict[str, str], who: str) -> NewEntry:
    name = f"{file.removesuffix('.csv')} {test} {uuid4().hex[:8]}"  # unique: two laptops never write the same one
    return NewEntry(
        action="add", file=ATTACHMENTS, test=name, cells={"table": file, "test": test, **cells}, position=0, who=who
    )


def attachments_of(campaign: ReplayedCampaign, file: str, test: str) -> list[ReplayedTest]:
    """Photos and positions of a test that are not cancelled, in the order of entry."""
    return [
        entry
        for entry in campaign.of_file(ATTACHMENTS)
        if not entry.cancelled and (entry.rows[0].cells["table"], entry.rows[0].cells["test"]) == (file, test)
    ]


def attachment_files(campaign: ReplayedCampaign, before: bytes = b"") -> Iterator[tuple[str, bytes]]:
    """Photos, and attachments.csv with their rows and those of positions after the rows of `before`."""
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
        yield ATTACHMENTS, with_rows(before, ATTACHMENTS, COLUMNS, rows).encode("utf-8")


def rows_of_file(data: bytes, file: str, test: str) -> list[dict[str, str]]:
    """Rows of an attachments.csv about a test; [] if the file cannot be read."""
    try:
        header, *rows = _parse_records(data, ATTACHMENTS)
    except (StoreError, ValueError):
        return []
    cells = [dict(zip(map(str.strip, header), row, strict=False)) for row in rows]
    return [row for row in cells if (row.get("table"), row.get("test")) == (file, test)]


def with_rows(before: bytes, file: str, columns: Sequence[str], rows: Iterable[Mapping[str, str]]) -> str:
    """Text of a table: the rows of a file as they are with all their columns, then further ones.

    Raises StoreError: the file cannot be read.
    """
    records = _parse_records(before, file) if before.strip() else []
    header = [cell.strip() for cell in records.pop(0)] if records else []
    header += [column for column in columns if column not in header]
    came = ([*cells, *[""] * (len(header) - len(cells))] for cells in records)
    return guarded_csv([header, *came, *([cells.get(column, "") for column in header] for cells in rows)])


def _parse_records(data: bytes, file: str) -> list[list[str]]:
    try:
        return [cells for _, some in inspect_csv(data).records() for cells in some]
    except UnreadableTextError as error:
        raise StoreError(
            "The file {file} of the campaign cannot be read, so that no rows can be appended: {allowed} is required. "
            "`skisnow store export --as-added` exports the files without later corrections."
        ).tag("unreadable_corrections", file=file, allowed=error.allowed) from error


def exported_files(campaign: ReplayedCampaign) -> dict[str, bytes]:
    """All files of a campaign in entry by path: tables, corrections, photos and positions."""
    return {name: text.encode("utf-8") for name, text in campaign_files(campaign).items()} | dict(
        attachment_files(campaign)
    )


def write_campaign(campaign: ReplayedCampaign, folder: Path) -> None:
    """Write all files of a campaign to an existing folder, without flushing: they can be written again at any time."""
    for name, data in exported_files(campaign).items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
