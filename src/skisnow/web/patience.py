"""How long the lab and the browser wait for each other: a busy laptop or a sleeping phone loses nothing."""

from __future__ import annotations

from typing import Final

from nicegui import core

STALL_S: Final = 60.0
"""Either side may stand still for this long, and the connection stays (modelling assumption)."""
PING_EVERY_S: Final = 10.0
PING_WAIT_S: Final = STALL_S + 15.0
RECONNECT_S: Final = 120.0
"""A page whose connection is gone is kept this long (modelling assumption): a walk out of reach of the network."""
BUILD_S: Final = 2.0 * STALL_S
"""A page may take this long to be put together; the framework then gives it up."""


def use_heartbeat() -> None:
    """Set the heartbeat of the pages' sockets; the framework sets its own when it starts, so this comes after."""
    core.sio.eio.ping_interval = PING_EVERY_S
    core.sio.eio.ping_timeout = PING_WAIT_S
