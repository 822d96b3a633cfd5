"""Reports: tables, figures and self-contained pages.

Modules that draw are imported on first use, so that a summary in the terminal does not wait for Matplotlib.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .campaign.page import write_report
    from .turn.chain import TurnChain

__all__ = ["TurnChain", "write_report"]


def __getattr__(name: str) -> Any:
    if name == "write_report":
        from .campaign.page import write_report

        return write_report
    if name == "TurnChain":
        from .turn.chain import TurnChain

        return TurnChain
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
