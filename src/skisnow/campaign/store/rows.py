"""Rows of stored campaigns and contents: reading and writing inside a transaction of the caller."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Final, TypeVar

from sqlalchemy import Connection, Row, delete, insert, select, update

from ..._support.errors import StoreError
from ..._support.messages import Message
from .folder import StoredFile, manifest_sha256, read_chunks
from .schema import CHUNK_BYTES, campaign, campaign_file, chunk, content, journal_entry

T = TypeVar("T")
ID_DIGITS: Final = 12
_SHORTEST_PREFIX: Final = 4
_SHOWN_CANDIDATES: Final = 10
TIME: Final = "%Y-%m-%dT%H:%M:%SZ"


@dataclass(frozen=True, slots=True)
class StoredCampaign:
    """A campaign in the store.

    id, sha256: SHA-256 of the manifest and its first 12 hexadecimal digits.
    name: name from campaign.toml or of the folder when it was first added.
    added_at: time in UTC.
    n_errors, n_warnings: numbers of problems of the campaign; None if the check failed.
    files: files sorted by path.
    """

    id: str
    name: str
    added_at: datetime
    sha256: str
    n_errors: int | None
    n_warnings: int | None
    files: tuple[StoredFile, ...]

    @property
    def n_files(self) -> int:
        """Number of files of the campaign."""
        return len(self.files)

    @property
    def n_bytes(self) -> int:
        """Total size of the campaign's files in bytes."""
        return sum(file.size for file in self.files)


def campaign_rows(connection: Connection) -> dict[str, Row[tuple[object, ...]]]:
    """Rows of all campaigns by their SHA-256, oldest first."""
    rows = connection.execute(select(campaign).order_by(campaign.c.added_at, campaign.c.id)).all()
    return {str(row.sha256): row for row in rows}


def one_campaign(connection: Connection, beginning: str) -> StoredCampaign:
    """Campaign whose SHA-256 has this beginning; StoreError if none or several have it, or it is damaged."""
    rows = campaign_rows(connection)
    sha256 = pick_id(beginning, {sha256: row.name for sha256, row in rows.items()})
    return stored_campaign(connection, rows[sha256])


def pick_id(beginning: str, names: Mapping[str, object]) -> str:
    """The only id or SHA-256 with this beginning; `names`: names of all campaigns by id or SHA-256, oldest first.

    Raises StoreError: not hexadecimal, fewer than 4 digits, unknown, or ambiguous; the message lists candidates.
    """
    digits = beginning.strip().lower()
    if not re.fullmatch(rf"[0-9a-f]{{{_SHORTEST_PREFIX},64}}", digits):
        raise StoreError(
            "{digits!r} is not the id of a campaign: give its {most} hexadecimal digits or the first "
            "{fewest} or more of them."
        ).tag("not_an_id", digits=digits, most=ID_DIGITS, fewest=_SHORTEST_PREFIX)
    matching = [id_ for id_ in names if id_.startswith(digits)]
    if len(matching) == 1:
        return matching[0]
    listed = sorted(matching) or list(names)[::-1]  # the newest first
    named = [f"{id_[:ID_DIGITS]} ({names[id_]})" for id_ in listed]
    candidates = Message("{names}", names=named[:_SHOWN_CANDIDATES]) if named else Message("none")
    if len(named) > _SHOWN_CANDIDATES:
        further = len(named) - _SHOWN_CANDIDATES
        candidates = Message("{names} and {count} more", names=candidates, count=further)
    if matching:
        raise StoreError("Several campaigns begin with {beginning}: {candidates}; give more digits.").tag(
            "ambiguous_id", beginning=digits, candidates=candidates
        )
    raise StoreError("No campaign begins with {beginning}; the store contains {candidates}.").tag(
        "unknown_id", beginning=digits, candidates=candidates
    )


def damage_error(what: str) -> StoreError:
    """StoreError that `what` is damaged in the store, with the advice to restore a backup."""
    return StoreError("{what} is damaged in the store; `skisnow store verify` lists all damage. Restore a backup.").tag(
        "damaged", what=what
    )


def entry_damage_error(number: object, journal_id: object) -> StoreError:
    """Error that the entry `number` of a campaign in entry is damaged."""
    words = Message("The entry {number} of the campaign in entry {id}", number=str(number), id=str(journal_id))
    return damage_error(words)


def require_whole(stored: StoredCampaign) -> None:
    """Raise a StoreError if a campaign's list of files changed since it was added; the stored bytes are not read."""
    if manifest_sha256(stored.files) != stored.sha256:
        raise damage_error(Message("The list of files of the campaign {id}", id=stored.id))


def stored_campaign(connection: Connection, row: Row[tuple[object, ...]]) -> StoredCampaign:
    """Convert a row to a campaign, with the list of its files; StoreError if the row or that list is damaged."""
    try:
        rows = connection.execute(
            select(campaign_file.c.path, content.c.size, content.c.sha256)
            .join_from(campaign_file, content)
            .where(campaign_file.c.campaign_id == row.id)
        )
        files = [
            StoredFile(require_type(file.path, str), require_type(file.size, int), require_type(file.sha256, str))
            for file in rows
        ]
        return StoredCampaign(
            id=require_type(row.id, str),
            name=require_type(row.name, str),
            added_at=datetime.strptime(require_type(row.added_at, str), TIME).replace(tzinfo=UTC),
            sha256=require_type(row.sha256, str),
            n_errors=None if row.n_errors is None else require_type(row.n_errors, int),
            n_warnings=None if row.n_warnings is None else require_type(row.n_warnings, int),
            files=tuple(sorted(files, key=lambda file: file.path)),
        )
    except (TypeError, ValueError) as error:
        raise damage_error(Message("The campaign {id}", id=row.id)) from error


def require_type(value: object, kind: type[T]) -> T:
    """The value, which must have the type; SQLite can return bytes or a number for a text of a damaged row."""
    if not isinstance(value, kind):
        raise TypeError(f"{value!r} is not of the type {kind.__name__}")
    return value


def stored_chunks(connection: Connection, sha256: str) -> Iterator[bytes]:
    """Read the stored bytes of a file by their SHA-256, in pieces. Raises StoreError: a piece is damaged."""
    pieces = select(chunk.c.data).where(chunk.c.sha256 == sha256).order_by(chunk.c.position)
    try:
        for piece in connection.execute(pieces, execution_options={"yield_per": 1}).scalars():
            yield require_type(piece, bytes)
    except TypeError as error:
        raise damage_error(Message("The content {sha256}", sha256=sha256)) from error


def is_sound(connection: Connection, sha256: str, size: int) -> bool:
    """True if the bytes that are stored under a SHA-256 have it, and the size (bytes)."""
    digest, n_bytes = hashlib.sha256(), 0
    try:
        for piece in stored_chunks(connection, sha256):
            digest.update(piece)
            n_bytes += len(piece)
    except StoreError:
        return False
    return digest.hexdigest() == sha256 and n_bytes == size


def store_content(connection: Connection, folder: Path, file: StoredFile) -> bool:
    """Store the bytes of a file unless stored; True if damaged bytes were replaced; StoreError if the file changed."""
    stored_size = connection.execute(select(content.c.size).where(content.c.sha256 == file.sha256)).scalar_one_or_none()
    if stored_size is None:
        connection.execute(insert(content).values(sha256=file.sha256, size=file.size))
    elif is_sound(connection, file.sha256, file.size) and stored_size == file.size:
        return False
    else:
        connection.execute(update(content).where(content.c.sha256 == file.sha256).values(size=file.size))
        connection.execute(delete(chunk).where(chunk.c.sha256 == file.sha256))
    if not _store_chunks(connection, file.sha256, read_chunks(folder / file.path, CHUNK_BYTES)):
        refuse_changed([file.path])
    return stored_size is not None


def copy_content(connection: Connection, file: StoredFile, pieces: Iterable[bytes]) -> bool:
    """Store the bytes of a file from another store unless they are stored; False if they lack the file's SHA-256."""
    held = connection.execute(select(content.c.size).where(content.c.sha256 == file.sha256)).first()
    if held is not None:
        return True
    connection.execute(insert(content).values(sha256=file.sha256, size=file.size))
    return _store_chunks(connection, file.sha256, pieces)


def remove_campaign(connection: Connection, stored: StoredCampaign) -> None:
    """Remove a campaign, and the bytes that only its files have; StoreError if the campaign has corrections."""
    if connection.execute(select(journal_entry.c.sequence).where(journal_entry.c.journal_id == stored.id)).first():
        raise StoreError("The campaign {id} has corrections and was not removed. Export it instead.").tag(
            "has_corrections", id=stored.id
        )
    connection.execute(delete(campaign_file).where(campaign_file.c.campaign_id == stored.id))
    connection.execute(delete(campaign).where(campaign.c.id == stored.id))
    own = {file.sha256 for file in stored.files}
    used = set(connection.execute(select(campaign_file.c.sha256).where(campaign_file.c.sha256.in_(own))).scalars())
    for sha256 in own - used:
        connection.execute(delete(chunk).where(chunk.c.sha256 == sha256))
        connection.execute(delete(content).where(content.c.sha256 == sha256))


def _store_chunks(connection: Connection, sha256: str, pieces: Iterable[bytes]) -> bool:
    """Store bytes in pieces under a SHA-256; True if they have it."""
    digest = hashlib.sha256()
    for position, piece in enumerate(pieces):
        digest.update(piece)
        connection.execute(insert(chunk).values(sha256=sha256, position=position, data=piece))
    return digest.hexdigest() == sha256


def refuse_changed(paths: Sequence[str]) -> None:
    """Raise a StoreError that lists the files that changed while they were read, if any."""
    if paths:
        raise StoreError(
            "Changed while being read: {paths}; nothing was stored. Close the program that writes "
            "there and add the folder again."
        ).tag("changed_meanwhile", paths=list(paths))


def store_campaign(connection: Connection, stored: StoredCampaign) -> bool:
    """Write the row of a campaign whose files' bytes are stored; False if the campaign exists already."""
    present = connection.execute(select(campaign.c.sha256).where(campaign.c.id == stored.id)).scalar_one_or_none()
    if present == stored.sha256:
        return False
    if present is not None:
        raise StoreError(
            "Another campaign in the store has the id {id} by chance; keep this one in another store."
        ).tag("same_id", id=stored.id)
    columns = {name: getattr(stored, name) for name in ("id", "sha256", "name", "n_errors", "n_warnings")}
    connection.execute(insert(campaign).values(**columns, added_at=stored.added_at.strftime(TIME)))
    connection.execute(
        insert(campaign_file),
        [{"campaign_id": stored.id, "path": file.path, "sha256": file.sha256} for file in stored.files],
    )
    return True
