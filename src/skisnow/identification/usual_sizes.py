"""For each key that may be looked for: its usual size, and the bounds where a user gives none."""

from __future__ import annotations

from typing import Final

from ..parameters import Search
from ..scenario.keys import SCENARIO_KEYS

_TIMES_START: Final = 5.0


def usual(key: str, start: float) -> Search:
    """Size and bounds of a key for a search that begins at `start`; bounds hold the start and the key's own range."""
    own = SCENARIO_KEYS[key.partition("@")[0]]
    found = own.search
    if found is None:
        size = abs(start) or 1.0
        found = Search(size, -_TIMES_START * size, _TIMES_START * size, about=True)
    low, high = (found.lower + start, found.upper + start) if found.about else (found.lower, found.upper)
    least = own.lowest + (1e-6 * found.size if own.above else 0.0)
    return Search(
        found.size,
        min(max(low, least), start),
        max(min(high, own.highest), start),
        found.about,
        found.logarithmic,
    )
