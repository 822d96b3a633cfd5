"""Search for damage in the store."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sqlalchemy import Connection, select
from sqlalchemy.exc import DatabaseError

from ..._support.errors import StoreError
from .engine import apart, is_file
from .entry_findings import findings_of_entries
from .finding import Finding
from .folder import Progress, manifest_sha256, unsafe_because
from .rows import StoredCampaign, is_sound, stored_campaign
from .schema import campaign, campaign_file, content
from .server import broken_references

if TYPE_CHECKING:
    from collections.abc import Iterator


def findings(connection: Connection, progress: Progress) -> tuple[Finding, ...]:
    """Check database, contents, campaigns and entries, each whatever the others hold; an empty answer: all is sound."""
    found: list[Finding] = []
    for of_part in (_of_database, lambda each: _of_contents(each, progress), _of_campaigns, findings_of_entries):
        try:
            with apart(connection):
                for finding in of_part(connection):
                    found.append(finding)
        except (DatabaseError, UnicodeDecodeError) as error:
            why = getattr(error, "orig", error)
            stopped = Finding(None, None, f"cannot be read further: {why}; put a backup in its place")
            found.extend(() if stopped in found else (stopped,))
    return tuple(found)


def _of_database(connection: Connection) -> Iterator[Finding]:
    if not is_file(connection):
        for table, parent, number in broken_references(connection):
            rows = f"{number} row{'' if number == 1 else 's'} of table {table}"
            yield Finding(None, None, f"{rows} pointing at what table {parent} does not hold")
        return
    for message in connection.exec_driver_sql("PRAGMA integrity_check").scalars():
        if message != "ok":
            yield Finding(None, None, f"SQLite's integrity check: {message}")
    for table, row, parent, _ in connection.exec_driver_sql("PRAGMA foreign_key_check"):
        yield Finding(None, None, f"row {row} of table {table} points at what table {parent} does not hold")


def _of_contents(connection: Connection, progress: Progress) -> Iterator[Finding]:
    rows = connection.execute(select(content.c.sha256, content.c.size)).all()
    done, total = 0, sum(size for _, size in rows if isinstance(size, int))
    for sha256, size in rows:
        if not isinstance(size, int) or not _is_sound(connection, sha256, size):
            users = select(campaign_file.c.campaign_id, campaign_file.c.path).where(campaign_file.c.sha256 == sha256)
            message = f"the bytes no longer have the SHA-256 {sha256}; add the original folder again to repair it"
            named = connection.execute(users).all() if isinstance(sha256, str) else []
            places = [(_words(campaign_id), _words(path)) for campaign_id, path in named]
            yield from (Finding(*place, message) for place in places or [(None, None)])
        done += size if isinstance(size, int) else 0
        progress(done, total)


def _is_sound(connection: Connection, sha256: object, size: int) -> bool:
    try:
        with apart(connection):
            return isinstance(sha256, str) and is_sound(connection, sha256, size)
    except (DatabaseError, UnicodeDecodeError):  # the pages that hold it are broken; other files may be whole
        return False


def _words(value: object) -> str | None:
    return value if value is None or isinstance(value, str) else repr(value)


def _of_campaigns(connection: Connection) -> Iterator[Finding]:
    for row in connection.execute(select(campaign)).all():
        try:
            yield from _of_campaign(stored_campaign(connection, row))
        except StoreError as error:
            yield Finding(_words(row.id), None, str(error))


def _of_campaign(stored: StoredCampaign) -> Iterator[Finding]:
    if manifest_sha256(stored.files) != stored.sha256:
        yield Finding(stored.id, None, "its files are not those it was added with")
    for file in stored.files:
        if (why := unsafe_because(file.path, for_windows=False)) is not None:
            yield Finding(stored.id, file.path, f"the path is not safe to export: {why}")
