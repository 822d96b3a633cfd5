"""Addresses of the pages of one campaign. An id consists of letters and digits."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Final
from urllib.parse import quote

from .._support.errors import StoreError

if TYPE_CHECKING:
    from collections.abc import Mapping

_ID: Final = re.compile(r"[0-9a-f]{4,64}")


def entering(id_: str, *, table: str = "", test: str = "", head: Mapping[str, str] | None = None) -> str:
    """Where a campaign is entered; with a table and a test: where that test is; head: what one without rows has."""
    return f"/enter/{id_}" + _asking(table, test, **(head or {}))


def correcting(id_: str, *, table: str = "", test: str = "") -> str:
    """Where a kept campaign is corrected; with a table and a test: where that test is."""
    return f"/correct/{id_}" + _asking(table, test)


def _asking(table: str, test: str, **further: str) -> str:
    asked = {"table": table, "test": test, **further}
    words = [f"{key}={quote(value, safe='')}" for key, value in asked.items() if value]
    return "?" + "&".join(words) if words else ""


def carving(ski: str, other: str = "") -> str:
    """Where a ski is carved, with another one beside it."""
    return f"/carve?ski={quote(ski, safe='')}" + (f"&other={quote(other, safe='')}" if other else "")


def analysis(kind: str, id_: str) -> str:
    """Where a campaign is analysed; kind: entry or kept."""
    return f"/analysis/{kind}/{id_}"


def export(kind: str, id_: str) -> str:
    """Where a campaign's zip comes from."""
    return f"/export/{kind}/{id_}.zip"


def plain_stem(called: str, otherwise: str) -> str:
    """A file's name without folder and ending, in letters that a folder has on every system.

    >>> plain_stem("Hang 3/Übungs lauf.gpx", "track"), plain_stem("雪.csv", "course")
    ('bungs-lauf', 'course')
    """
    stem = PurePosixPath(called.replace("\\", "/")).name.rsplit(".", 1)[0]
    return re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-")[:40] or otherwise


def required_id(said: str) -> str:
    """An id as it stands in an address.

    Raises
    ------
    StoreError
        It is none.
    """
    if not _ID.fullmatch(said):
        raise StoreError("This address names no campaign; the list of campaigns names all.")
    return said
