"""Checksums of an entry of a journal: one that shows whether it is what was written down, and one for each part of it.

They are taken from the bytes that the store holds, so that an entry with invalid text can be checked, too.
The format must not change without a migration: stores hold these checksums.
"""

from __future__ import annotations

import json
import zlib
from hashlib import sha256
from typing import TYPE_CHECKING, Final

from ..._support.user_files import json_value

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_PARTICULARS: Final = (
    "sequence",
    "journal_id",
    "at",
    "who",
    "action",
    "file",
    "test",
    "position",
    "about",
    "why",
    "once",
    "uid",
)
"""Columns beside the cells, in the order in which they are summed; only ever added to with a migration."""


def entry_sha256(row: Mapping[str, object]) -> str:
    """The SHA-256 of all that an entry says, by the names of its columns.

    >>> row = {name: None for name in ("at", "who", "about")} | {"sequence": 1, "cells": "{}"}
    >>> entry_sha256(row) == entry_sha256(row | {"who": ""}), len(entry_sha256(row))
    (False, 64)
    """
    found = sha256()
    for name in (*_PARTICULARS, "cells"):
        data = as_bytes(row.get(name))
        found.update(b"-;" if data is None else b"%d;%b" % (len(data), data))
    return found.hexdigest()


def entry_sums(row: Mapping[str, object]) -> str:
    """A CRC-32 of each part, as JSON: they show where an entry is damaged that no longer has its SHA-256."""
    return json.dumps({"entry": _of_particulars(row), "cells": _of_cells(row)}, ensure_ascii=False)


def differing(row: Mapping[str, object], sums: bytes) -> Iterator[tuple[str, str | None]]:
    """The parts that are not what was summed: "entry" or "cells" and the column.

    With None for the column: "cells" that cannot be taken apart, "sums" that cannot be read.
    """
    try:
        known = json_value(sums.decode())
        by_kind = {kind: dict(known[kind]) for kind in ("entry", "cells")}
        if not by_kind["entry"].keys() <= row.keys():
            raise ValueError("a column that no entry has")
    except (AttributeError, ValueError, TypeError, KeyError):
        yield "sums", None
        return
    try:
        found = {"entry": _of_particulars(row), "cells": _of_cells(row)}
    except ValueError:
        found = {"entry": _of_particulars(row), "cells": by_kind["cells"]}
        yield "cells", None
    for kind, sums_of_kind in by_kind.items():
        names = [*sums_of_kind, *(name for name in found[kind] if name not in sums_of_kind)]
        yield from ((kind, name) for name in names if found[kind].get(name) != sums_of_kind.get(name))


def cells_of(row: Mapping[str, object]) -> dict[str, str]:
    """The cells of an entry as their bytes say them, what is no text in them replaced.

    Raises
    ------
    ValueError
        They cannot be taken apart.
    """
    data = as_bytes(row.get("cells")) or b""
    cells = json_value(data.decode(errors="replace"))
    if not isinstance(cells, dict) or not all(isinstance(cell, str) for cell in cells.values()):
        raise ValueError("the cells are not texts by their columns")
    return {str(column): str(cell) for column, cell in cells.items()}


def _of_particulars(row: Mapping[str, object]) -> dict[str, str]:
    return {name: _crc32(as_bytes(row.get(name))) for name in _PARTICULARS}


def _of_cells(row: Mapping[str, object]) -> dict[str, str]:
    return {column: _crc32(cell.encode()) for column, cell in cells_of(row).items()}


def _crc32(data: bytes | None) -> str:
    return "none" if data is None else f"{zlib.crc32(data):08x}"


def as_bytes(value: object) -> bytes | None:
    """A value as SQLite casts it to a BLOB."""
    if value is None or isinstance(value, bytes):
        return value
    return str(value).encode(errors="surrogatepass")
