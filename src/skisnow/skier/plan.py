"""When a skier turns, and to which side."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from ..errors import ParameterError

MOST_TURNS: Final = 1000.0


@dataclass(frozen=True, slots=True, kw_only=True)
class TurnPlan:
    """Turns to the left and to the right by turns, the first half a turn long, then straight on.

    Attributes
    ----------
    first
        When the first one begins (s), ≥ 0.
    turn_time
        Of a whole turn, from edge change to edge change (s), > 0.
    turns
        How many, the first one counted as a half: 4.5 are a half and four whole ones. Infinite: without end.
    to_left
        Whether the first one goes to the left.

    Examples
    --------
    >>> plan = TurnPlan(first=1.0, turn_time=2.0, turns=1.5)
    >>> [plan.sense(time) for time in (0.5, 1.5, 3.0, 4.5)]
    [0.0, 1.0, -1.0, 0.0]
    """

    first: float = 1.0
    turn_time: float = 2.0
    turns: float = 4.5
    to_left: bool = True

    def __post_init__(self) -> None:
        if not (self.first >= 0.0 and 0.0 < self.turn_time < math.inf and self.turns > 0.0):
            raise ParameterError(f"{self!r}: first must be 0 or more, turn_time and turns above 0")

    def sense(self, time: float) -> float:
        """1 for a turn to the left, -1 to the right, 0 for none, at a time (s)."""
        done = (time - self.first) / self.turn_time
        if not 0.0 <= done < self.turns:
            return 0.0
        side = 1.0 if math.floor(done + 0.5) % 2 == 0 else -1.0
        return side if self.to_left else -side
