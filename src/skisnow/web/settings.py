"""Settings of the lab: store, folders, limits of uploads, times."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from ..campaign.store import Store

MEGABYTE: Final = 1_000_000
STALL_S: Final = 60.0  # maximum time without an answer of browser or server before the connection is closed (s)
PING_EVERY_S: Final = 10.0
PING_WAIT_S: Final = STALL_S + 15.0
RECONNECT_S: Final = 120.0  # time that a page is kept after its connection was lost (s)
BUILD_S: Final = 2.0 * STALL_S  # maximum time to build a page (s)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of an upload: bytes of a request, bytes of all unpacked files of a zip, number of files, packed or not."""

    upload_bytes: int = 100 * MEGABYTE
    unpacked_bytes: int = 400 * MEGABYTE
    files: int = 200


@dataclass(frozen=True, slots=True)
class Lab:
    """Store, folder of runs, studies, skis, tracks and courses, and limits of uploads of a lab."""

    store: Store
    runs: Path
    limits: Limits = field(default_factory=Limits)
