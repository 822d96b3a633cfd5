"""A number of a ski file or its table, in few words."""

from __future__ import annotations

from ..parameters import Quantity


def ski_quantity(
    name: str, meaning: str, allowed: tuple[float, float], usual: tuple[float, float], left_out: str
) -> Quantity:
    """A quantity with its allowed and its usual range, and the value without it."""
    return Quantity(name, meaning, lowest=allowed[0], highest=allowed[1], usual=usual, origin=left_out)
