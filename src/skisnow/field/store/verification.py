"""Search for damage in the store."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from sqlalchemy import Connection, func, select
from sqlalchemy.exc import DatabaseError

from .folder import Progress, manifest_sha256, unsafe_because
from .rows import StoredCampaign, all_campaigns, is_sound
from .schema import campaign_file, content

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True, slots=True)
class Finding:
    """Damage found in the store: in which campaign and file (None: in the database as a whole), and what it is."""

    campaign: str | None
    path: str | None
    message: str

    def __str__(self) -> str:
        """Say it in one line."""
        place = ", ".join(part for part in (self.campaign, self.path) if part is not None)
        return f"{place or 'database'}: {self.message}"


def findings(connection: Connection, progress: Progress) -> tuple[Finding, ...]:
    """Check database, contents and campaigns; an empty answer means that all is sound."""
    found: list[Finding] = []
    try:
        found.extend(_of_database(connection))
        found.extend(_of_contents(connection, progress))
        for stored in all_campaigns(connection):
            found.extend(_of_campaign(stored))
    except DatabaseError as error:
        found.append(Finding(None, None, f"cannot be read further: {error.orig}; put a backup in its place"))
    return tuple(found)


def _of_database(connection: Connection) -> Iterator[Finding]:
    for message in connection.exec_driver_sql("PRAGMA integrity_check").scalars().all():
        if message != "ok":
            yield Finding(None, None, f"SQLite's integrity check: {message}")
    for table, row, parent, _ in connection.exec_driver_sql("PRAGMA foreign_key_check").all():
        yield Finding(None, None, f"row {row} of table {table} points at what table {parent} does not hold")


def _of_contents(connection: Connection, progress: Progress) -> Iterator[Finding]:
    done, total = 0, connection.execute(select(func.coalesce(func.sum(content.c.size), 0))).scalar_one()
    for sha256, size in connection.execute(select(content.c.sha256, content.c.size)).all():
        try:
            sound = is_sound(connection, sha256, size)
        except DatabaseError:  # the pages that hold it are broken; other files may be whole
            sound = False
        if not sound:
            users = select(campaign_file.c.campaign_id, campaign_file.c.path).where(campaign_file.c.sha256 == sha256)
            message = f"the bytes no longer have the SHA-256 {sha256}; add the original folder again to repair it"
            for campaign_id, path in connection.execute(users).all():
                yield Finding(campaign_id, path, message)
        done += size
        progress(done, total)


def _of_campaign(stored: StoredCampaign) -> Iterator[Finding]:
    if manifest_sha256(stored.files) != stored.sha256:
        yield Finding(stored.id, None, "its files are not those it was added with")
    for file in stored.files:
        if (why := unsafe_because(file.path, for_windows=False)) is not None:
            yield Finding(stored.id, file.path, f"the path is not safe to export: {why}")
