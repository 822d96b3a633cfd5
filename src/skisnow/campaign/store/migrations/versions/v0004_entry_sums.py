"""Checksums of entries: a bit that flips in a cell is noticed, and its place told."""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping
from hashlib import sha256

import sqlalchemy as sa
from alembic import op

from skisnow._support.user_files import json_value

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None

PARTICULARS = ("sequence", "journal_id", "at", "who", "action", "file", "test", "position", "about", "why", "once")


def upgrade() -> None:
    op.add_column("journal_entry", sa.Column("sha256", sa.String(64)))
    op.add_column("journal_entry", sa.Column("sums", sa.Text))
    if op.get_bind().dialect.name != "sqlite":
        return  # no server held an entry without them
    # as bytes: what is damaged already does not keep the store from being opened
    columns = ", ".join(f"CAST({name} AS BLOB) AS {name}" for name in (*PARTICULARS, "cells"))
    connection = op.get_bind()
    for row in connection.exec_driver_sql(f"SELECT {columns} FROM journal_entry").mappings().all():
        said = {str(name): data for name, data in row.items()}
        connection.exec_driver_sql(
            "UPDATE journal_entry SET sha256 = ?, sums = ? WHERE sequence = ?",
            (_sha256(said), _sums(said), int(row["sequence"])),
        )


def downgrade() -> None:
    op.drop_column("journal_entry", "sums")
    op.drop_column("journal_entry", "sha256")


def _sha256(row: Mapping[str, bytes | None]) -> str:
    found = sha256()
    for name in (*PARTICULARS, "cells"):
        data = row[name]
        found.update(b"-;" if data is None else b"%d;%b" % (len(data), data))
    return found.hexdigest()


def _sums(row: Mapping[str, bytes | None]) -> str:
    particulars = {name: _crc32(row[name]) for name in PARTICULARS}
    try:
        said = json_value((row["cells"] or b"").decode(errors="replace"))
        cells = {column: _crc32(cell.encode()) for column, cell in said.items()}
    except (ValueError, AttributeError):
        cells = {}  # damaged before: it is told as before
    return json.dumps({"entry": particulars, "cells": cells}, ensure_ascii=False)


def _crc32(data: bytes | None) -> str:
    return "none" if data is None else f"{zlib.crc32(data):08x}"
