"""Which moments of two tracks are the same moment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from .polyline import Polyline
from .track import Track

TimeFrom: TypeAlias = Literal["first_point", "clock"]
FIRST_POINTS: Final = "let time be counted from each track's first point, or fit the time"


@dataclass(frozen=True, slots=True)
class Clock:
    """A clock for two tracks.

    Attributes
    ----------
    ahead
        The simulated track's time less the measured one's at one moment (s).
    origin
        In words: what time counts from.
    reason
        Why there is no such clock.
    """

    ahead: float
    origin: str
    reason: str | None = None


def common_clock(simulated: Track, measured: Track, time_from: TimeFrom | None) -> Clock:
    """The clock for both tracks; None: the files' own, but first points where only one has a date."""
    starts = (simulated.start, measured.start)
    first = float(simulated.time[0] - measured.time[0]) if len(simulated) and len(measured) else 0.0
    if time_from == "first_point" or (time_from is None and starts.count(None) == 1):
        return Clock(first, "each track's first point")
    if starts[0] is None and starts[1] is None:
        return Clock(measured.first_time - simulated.first_time, "zero of the seconds in both files")
    if starts[0] is None or starts[1] is None:
        return Clock(0.0, "one clock", f"only one of them has a date; {FIRST_POINTS}")
    if simulated.time_scale != measured.time_scale or (starts[0].tzinfo is None) != (starts[1].tzinfo is None):
        scales = f"{simulated.time_scale} and {measured.time_scale}"
        return Clock(0.0, "one clock", f"their clocks are not of one kind ({scales}); {FIRST_POINTS}")
    return Clock(first + (starts[1] - starts[0]).total_seconds(), "one clock, by the dates in both files")


def lacking_time(line: Polyline, name: str) -> str | None:
    """Why there is no place for each time, or None where there is."""
    if not np.isfinite(line.time).all():
        return f"not every point of the {name} track has a time"
    return f"the {name} track's time runs backwards" if (np.diff(line.time) < 0.0).any() else None
