"""Settings of the lab: store, folders, limits of uploads, times."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from pathlib import Path

    from ..campaign.store import Store

MEGABYTE: Final = 1_000_000
STALL_S: Final = 60.0
"""Longest time without an answer from browser or server that keeps the connection, in s."""
PING_EVERY_S: Final = 10.0
PING_WAIT_S: Final = STALL_S + 15.0
RECONNECT_S: Final = 120.0
"""Time that a page is kept after its connection was lost, in s: a walk out of reach of the network."""
BUILD_S: Final = 2.0 * STALL_S
"""Longest time to build a page, in s; the framework then gives up."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What an upload may hold (the largest campaign foreseen, a million readings, is 60 MB).

    Attributes
    ----------
    upload_bytes
        Of one request's body.
    unpacked_bytes
        Of all files of a zip together, unpacked.
    files
        Number of files of one upload, packed or not.
    """

    upload_bytes: int = 100 * MEGABYTE
    unpacked_bytes: int = 400 * MEGABYTE
    files: int = 200


@dataclass(frozen=True, slots=True)
class Lab:
    """What is handed to each page's ``add_page``.

    Attributes
    ----------
    store
        Open.
    runs
        The folder that runs are kept in.
    limits
        Of uploads.
    scheduler
        Who computes studies, as ``skisnow study --scheduler`` takes it; None: this machine.
    """

    store: Store
    runs: Path
    limits: Limits = field(default_factory=Limits)
    scheduler: str | None = None
