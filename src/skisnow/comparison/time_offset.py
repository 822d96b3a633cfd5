"""Offset in time between two tracks: from their clocks, or fitted by least squares at equal time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.optimize import minimize_scalar

from .._support.errors import FitError
from .._support.messages import Message
from ..track.track import Track
from .alignment import LEAST_SHARE, PLACES
from .distances import Polyline

TimeFrom: TypeAlias = Literal["first_point", "clock"]
FIRST_POINTS: Final = "let time be counted from each track's first point, or fit the time"


@dataclass(frozen=True, slots=True)
class Clock:
    """A clock for two tracks.

    Attributes
    ----------
    ahead
        Time of the simulated track minus that of the measured one (s).
    origin
        Description of the zero of time.
    reason
        Reason why the tracks have no common clock (default: they have one).
    """

    ahead: float
    origin: str
    reason: str | None = None


def common_clock(simulated: Track, measured: Track, time_from: TimeFrom | None) -> Clock:
    """Clock for both tracks; `time_from` None: that of the files, or first points if only one has a date."""
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


def missing_time_reason(line: Polyline, name: str) -> Message | None:
    """Reason why a track has no place at each time, or None if it has."""
    if not np.isfinite(line.time).all():
        return Message("not every point of the {name} track has a time", name=name)
    backwards = bool((np.diff(line.time) < 0.0).any())
    return Message("the {name} track's time runs backwards", name=name) if backwards else None


_TIMES: Final = 401


def fit_time(simulated: Polyline, measured: Polyline) -> float:
    """Time of the simulated track minus that of the measured one (s), by least squares of distances at equal time.

    The mean square distance over the measured track's length is computed for all offsets at which at least half of the
    shorter track overlaps with the other, and then minimised from the best of them.

    Raises
    ------
    FitError
        One of the tracks has no duration.
    """
    shorter = min(simulated.time[-1] - simulated.time[0], measured.time[-1] - measured.time[0])
    if not shorter > 0.0:
        raise FitError("the start time cannot be fitted: one of the tracks has no duration", code="no_duration")
    least = simulated.time[0] - measured.time[-1] + LEAST_SHARE * shorter
    most = simulated.time[-1] - measured.time[0] - LEAST_SHARE * shorter
    arc_length = np.linspace(0.0, measured.length, PLACES + 1)
    time, places = np.interp(arc_length, measured.arc_length, measured.time), measured.at_arc_length(arc_length)

    def mean_square(later: float) -> float:
        at = time + later
        common = (at >= simulated.time[0]) & (at <= simulated.time[-1])
        apart = simulated.at_time(at[common]) - places[common]
        return float((apart**2).sum(axis=1).mean()) if common.any() else math.inf

    tried = np.linspace(least, most, _TIMES)
    best = float(tried[int(np.argmin([mean_square(float(later)) for later in tried]))])
    step = (most - least) / (_TIMES - 1)
    bounds = (max(least, best - step), min(most, best + step))
    minimum = minimize_scalar(mean_square, bounds=bounds, method="bounded", options={"xatol": 1e-9 * max(1.0, shorter)})
    return float(minimum.x)
