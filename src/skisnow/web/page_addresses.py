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
    """Address of the entry of a campaign, or of a table and test in it; ``head``: cells of a test without rows."""
    return f"/enter/{id_}" + _query(table, test, **(head or {}))


def correcting(id_: str, *, table: str = "", test: str = "") -> str:
    """Address of the correction of an imported campaign, or of a table and test in it."""
    return f"/correct/{id_}" + _query(table, test)


def _query(table: str, test: str, **further: str) -> str:
    parameters = {"table": table, "test": test, **further}
    words = [f"{key}={quote(value, safe='')}" for key, value in parameters.items() if value]
    return "?" + "&".join(words) if words else ""


def carving(ski: str, other: str = "") -> str:
    """Address of the page Carve with a ski, and another one for comparison."""
    return f"/carve?ski={quote(ski, safe='')}" + (f"&other={quote(other, safe='')}" if other else "")


def analysis(kind: str, id_: str) -> str:
    """Address of the analysis of a campaign; kind: entry or kept."""
    return f"/analysis/{kind}/{id_}"


def export(kind: str, id_: str) -> str:
    """Address of a campaign's zip file."""
    return f"/export/{kind}/{id_}.zip"


def plain_stem(called: str, otherwise: str) -> str:
    """Name of a file without folder and suffix, in characters that are valid in names of folders on every system.

    >>> plain_stem("Hang 3/Übungs lauf.gpx", "track"), plain_stem("雪.csv", "course")
    ('bungs-lauf', 'course')
    """
    stem = PurePosixPath(called.replace("\\", "/")).name.rsplit(".", 1)[0]
    return re.sub(r"[^A-Za-z0-9]+", "-", stem).strip("-")[:40] or otherwise


def required_id(text: str) -> str:
    """Id of a campaign from an address.

    Raises
    ------
    StoreError
        The text is not an id.
    """
    if not _ID.fullmatch(text):
        raise StoreError("This address names no campaign; the list of campaigns names all.", code="no_campaign")
    return text
