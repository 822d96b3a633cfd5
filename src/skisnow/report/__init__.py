"""Tables, figures and the self-contained report of an analysed campaign.

What draws is fetched on first use: the terminal's summary must not wait for the drawing library.
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
