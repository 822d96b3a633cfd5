"""The replay in the lab: its addresses, and the measured tracks beside a run. The replay itself is `skisnow.replay`."""

from __future__ import annotations

from typing import Any

from ... import replay
from ...former_names import warn_of_former_name


def __getattr__(name: str) -> Any:
    """What moved to `skisnow.replay` stays here for one release."""
    if name not in replay.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn_of_former_name(f"{__name__}.{name}", f"skisnow.replay.{name}")
    return getattr(replay, name)
