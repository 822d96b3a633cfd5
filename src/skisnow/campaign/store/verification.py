"""Search for damage in the store: database, contents, campaigns, entries with their rows and columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from sqlalchemy import Connection, LargeBinary, cast, select
from sqlalchemy.exc import DatabaseError, NoResultFound

from ..._support.errors import StoreError
from ..._support.user_files.text_files import natural_number
from .engine import is_file, savepoint
from .folder import Progress, manifest_sha256, unsafe_because
from .journal import as_bytes, entry_sha256, readable_entry
from .rows import is_sound, stored_campaign
from .schema import campaign, campaign_file, content, journal_entry
from .server import broken_references

_Row: TypeAlias = Mapping[str, bytes | None]


def findings(connection: Connection, progress: Progress) -> tuple[Finding, ...]:
    """Search for damage of the database, the files' bytes, campaigns and entries, independently; () without damage."""
    damage: list[Finding] = []
    for of_part in (
        _database_damage,
        lambda part_connection: _content_damage(part_connection, progress),
        _find_damaged_campaigns,
        find_entry_damage,
    ):
        try:
            with savepoint(connection):
                for finding in of_part(connection):
                    damage.append(finding)
        except (DatabaseError, UnicodeDecodeError) as error:
            why = getattr(error, "orig", error)
            stopped = Finding(None, None, f"cannot be read further: {why}; put a backup in its place")
            damage.extend(() if stopped in damage else (stopped,))
    return tuple(damage)


def _database_damage(connection: Connection) -> Iterator[Finding]:
    """Findings of SQLite's own integrity and foreign-key checks; on a server, of a search for broken references."""
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


def _content_damage(connection: Connection, progress: Progress) -> Iterator[Finding]:
    """Findings for files whose bytes no longer have their SHA-256, for each campaign that uses them."""
    rows = connection.execute(select(content.c.sha256, content.c.size)).all()
    done, total = 0, sum(size for _, size in rows if isinstance(size, int))
    for sha256, size in rows:
        try:
            with savepoint(connection):
                sound = isinstance(sha256, str) and isinstance(size, int) and is_sound(connection, sha256, size)
        except (DatabaseError, UnicodeDecodeError):  # the pages with these bytes are broken; other files may be whole
            sound = False
        if not sound:
            users = select(campaign_file.c.campaign_id, campaign_file.c.path).where(campaign_file.c.sha256 == sha256)
            message = f"the bytes no longer have the SHA-256 {sha256}; add the original folder again to repair it"
            named = connection.execute(users).all() if isinstance(sha256, str) else []
            places = [(_text_or_repr(campaign_id), _text_or_repr(path)) for campaign_id, path in named]
            yield from (Finding(*place, message) for place in places or [(None, None)])
        done += size if isinstance(size, int) else 0
        progress(done, total)


def _text_or_repr(value: object) -> str | None:
    """A text or None unchanged, any other value by its repr."""
    return value if value is None or isinstance(value, str) else repr(value)


def _find_damaged_campaigns(connection: Connection) -> Iterator[Finding]:
    """Findings for unreadable campaigns, changed lists of files and unsafe paths."""
    for row in connection.execute(select(campaign)).all():
        try:
            stored = stored_campaign(connection, row)
        except StoreError as error:
            yield Finding(_text_or_repr(row.id), None, str(error))
            continue
        if manifest_sha256(stored.files) != stored.sha256:
            yield Finding(stored.id, None, "its files are not those it was added with")
        for file in stored.files:
            if (why := unsafe_because(file.path, for_windows=False)) is not None:
                yield Finding(stored.id, file.path, f"the path is not safe to export: {why}")


@dataclass(frozen=True, slots=True)
class Finding:
    """Damage in the store: campaign and file (None: the whole database), and a message."""

    campaign: str | None
    path: str | None
    message: str

    def __str__(self) -> str:
        """Line of text with the place and the message."""
        place = ", ".join(part for part in (self.campaign, self.path) if part is not None)
        return f"{place or 'database'}: {self.message}"


def find_entry_damage(connection: Connection) -> Iterator[Finding]:
    """Search for damaged journal entries; they are read as bytes, so that invalid text is found, too."""
    columns = journal_entry.c
    if is_file(connection):
        query = select(*(cast(column, LargeBinary).label(column.name) for column in columns))
    else:
        query = select(*columns)  # a server has only valid text
    found = connection.execute(query.order_by(columns.sequence)).mappings().all()
    rows: list[_Row] = [{str(name): as_bytes(value) for name, value in row.items()} for row in found]
    places = {row["sequence"]: row["position"] for row in rows}
    for row in rows:
        position = _utf8(row["position"] if row["about"] is None else places.get(row["about"]))
        line = natural_number(position)
        place = f"test {_utf8(row['test'])}, " if row["test"] else ""
        place += "" if line is None else f"row {line + 1}, "
        what = _entry_damage(connection, row)
        if what:
            message = f"{place}entry {_utf8(row['sequence'])}: {what}; put a backup in its place"
            yield Finding(_utf8(row["journal_id"]), _utf8(row["file"]) or None, message)


def _entry_damage(connection: Connection, row: _Row) -> str:
    """Reason why an entry is damaged: changed, unreadable or without checksum; "" if it is sound."""
    if row["sha256"] is not None and _utf8(row["sha256"]) != entry_sha256(row):
        return "it is not as it was written down"
    query = select(journal_entry).where(journal_entry.c.sequence == int(_utf8(row["sequence"])))
    try:
        readable_entry(connection.execute(query).mappings().one())
    except StoreError as error:
        return str(error)
    except (DatabaseError, NoResultFound, UnicodeDecodeError):
        return "it cannot be read"
    return "" if row["sha256"] is not None else "it has no checksum"


def _utf8(data: bytes | None) -> str:
    """Text of UTF-8 bytes, with invalid ones replaced; "" for None."""
    return "" if data is None else data.decode(errors="replace")
