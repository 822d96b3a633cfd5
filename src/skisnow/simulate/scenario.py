"""The former place of `skisnow.scenario`; it goes with the next release."""

from __future__ import annotations

from typing import Any

from .. import scenario as package
from ..former_names import warn_of_former_name
from ..scenario import __all__ as moved


def __getattr__(name: str) -> Any:
    if name not in moved:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn_of_former_name(f"{__name__}.{name}", f"skisnow.scenario.{name}")
    return getattr(package, name)
