"""What an entry is called in every store that has it, so that two stores can be synchronised."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from hashlib import sha256
from typing import Any

import sqlalchemy as sa
from alembic import op

from skisnow._support.user_files import json_value

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None

PARTICULARS = ("sequence", "journal_id", "at", "who", "action", "file", "test", "position", "about", "why", "once")


def upgrade() -> None:
    op.add_column("journal_entry", sa.Column("uid", sa.String(31)))
    connection = op.get_bind()
    if connection.dialect.name == "sqlite":  # no server held an entry without one
        stored = set(connection.exec_driver_sql("SELECT CAST(id AS BLOB) FROM campaign").scalars())
        taken: set[str] = set()
        for row in _rows(connection, PARTICULARS):
            uid = _uid(row, stored, taken)
            taken.add(uid)
            _rewrite(connection, row, {"uid": uid.encode()}, PARTICULARS, (*PARTICULARS, "uid"))
    op.create_index(op.f("ix_journal_entry_uid"), "journal_entry", ["uid"], unique=True)


def downgrade() -> None:
    op.drop_index(op.f("ix_journal_entry_uid"), "journal_entry")
    connection = op.get_bind()
    if connection.dialect.name == "sqlite":
        for row in _rows(connection, (*PARTICULARS, "uid")):
            _rewrite(connection, row, {"uid": None}, (*PARTICULARS, "uid"), PARTICULARS)
    op.drop_column("journal_entry", "uid")


def _rows(connection: sa.Connection, names: Sequence[str]) -> list[dict[str, bytes | None]]:
    """As bytes: what is damaged already does not keep the store from being opened."""
    columns = ", ".join(f"CAST({name} AS BLOB) AS {name}" for name in (*names, "cells", "sha256", "sums"))
    found = connection.exec_driver_sql(f"SELECT {columns} FROM journal_entry ORDER BY sequence").mappings().all()
    return [{str(name): data for name, data in row.items()} for row in found]


def _uid(row: Mapping[str, bytes | None], stored: set[bytes], taken: set[str]) -> str:
    if row["action"] == b"add" and row["position"] is None and row["journal_id"] in stored:
        # what a file says: the same in every store that keeps the campaign
        said = b"\0".join(row[name] or b"" for name in ("journal_id", "file", "test"))
        uid = f"{0:010d}-{_beginning(said)}"
        if uid not in taken:
            return uid
    return f"{int(row['sequence'] or 0):010d}-{_beginning(row['sha256'] or b'')}"


def _beginning(data: bytes) -> str:
    return sha256(data).hexdigest()[:20]


def _rewrite(
    connection: sa.Connection,
    row: Mapping[str, bytes | None],
    change: Mapping[str, bytes | None],
    before: Sequence[str],
    after: Sequence[str],
) -> None:
    """Sum an entry anew; where a sum was wrong it stays wrong, so that damage is told as before."""
    changed = {**row, **change}
    is_whole = row["sha256"] is not None and row["sha256"].decode(errors="replace") == _sha256(row, before)
    sums = _sums(row["sums"], changed, after)
    connection.exec_driver_sql(
        "UPDATE journal_entry SET uid = ?, sha256 = CASE WHEN ? THEN ? ELSE sha256 END, sums = COALESCE(?, sums) "
        "WHERE sequence = ?",
        (_text(changed["uid"]), is_whole, _sha256(changed, after), sums, int(row["sequence"] or 0)),
    )


def _sums(known: bytes | None, row: Mapping[str, bytes | None], names: Sequence[str]) -> str | None:
    """The sums with that of the uid, or without; None where they cannot be read."""
    try:
        sums: Any = json_value((known or b"").decode())
        entry = {name: crc for name, crc in sums["entry"].items() if name != "uid"}
    except (ValueError, TypeError, KeyError, AttributeError):
        return None
    if "uid" in names:
        entry["uid"] = f"{zlib.crc32(row['uid'] or b''):08x}"
    return json.dumps({**sums, "entry": entry}, ensure_ascii=False)


def _sha256(row: Mapping[str, bytes | None], names: Sequence[str]) -> str:
    found = sha256()
    for name in (*names, "cells"):
        data = row[name]
        found.update(b"-;" if data is None else b"%d;%b" % (len(data), data))
    return found.hexdigest()


def _text(data: bytes | None) -> str | None:
    return None if data is None else data.decode()
