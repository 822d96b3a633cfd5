"""How the loops are compiled."""

from __future__ import annotations

from typing import Any, Final

PLAIN: Final[dict[str, Any]] = {"error_model": "numpy", "_nrt": False}
"""Options of functions that only read and write arrays they are given: without counting references to them, which
took a seventh of the time of a run. They cannot make arrays."""
MAKING: Final[dict[str, Any]] = {**PLAIN, "_nrt": True}
"""Options of the few that make arrays; said outright, or a function would take them from the one that calls it."""
SUMS: Final = {"contract", "reassoc", "nsz"}
"""Freedom to add in any order: several cells in one instruction. The order is the same in every run."""
