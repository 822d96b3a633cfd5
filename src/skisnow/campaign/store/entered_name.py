"""Name of a campaign that consists of lab entries."""

from __future__ import annotations

from sqlalchemy import Connection, select
from sqlalchemy.exc import DatabaseError

from ..._support.errors import ParameterError, StoreError
from ..._support.user_files import toml_values
from .engine import apart
from .journal_entry import DESCRIPTION, entry_of
from .schema import journal_entry


def entered_name(connection: Connection, journal_id: str) -> str:
    """Name in the campaign's last description; "" if it has none or is damaged."""
    columns = journal_entry.c
    descriptions = select(journal_entry).where(columns.journal_id == journal_id, columns.file == DESCRIPTION)
    try:
        with apart(connection):
            entries = [entry_of(row) for row in connection.execute(descriptions).mappings()]
        last = max(entries, key=lambda entry: entry.uid, default=None)
        name = toml_values(last.cells[DESCRIPTION]).get("name") if last is not None else ""
    except (StoreError, ParameterError, KeyError, DatabaseError, UnicodeDecodeError):
        return ""
    return " ".join(name.split()) if isinstance(name, str) else ""
