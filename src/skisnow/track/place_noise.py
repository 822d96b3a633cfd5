"""Noise of measured places from point to point, separated from the path by differences of high order.

A smooth path nearly vanishes in a difference of high order, white noise does not: Tintner (1940), *The Variate
Difference Method*. If the differences of two orders give the same noise, the path has vanished. Otherwise the points
are too far apart for the curvature of the path, and the result is only an upper bound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .smoothing import SHORTEST_WINDOW, SmoothedTrack
from .track import Track

ORDERS: Final = (6, 8)
"""Orders of the differences that are compared; the noise comes from the higher one."""
FEWEST_DIFFERENCES: Final = 30
_EVEN: Final = 0.02
"""Relative deviation of the steps in time from their median up to which they count as even."""
_ERROR, _ERROR_OF_RATIO = 1.15, 0.33
"""Relative standard errors, times √(number of differences), of the noise and of its ratio by two orders: simulated."""
_ALIKE: Final = 0.1
"""Relative difference of the two orders at which the noise is wrong by at most 5 %: a path of four points per
oscillation leaves 0.54 of its amplitude from order 6 to 8."""


@dataclass(frozen=True, slots=True)
class PlaceNoise:
    """Standard deviation (m) of a coordinate from point to point; with ``is_bound`` only its upper 97.5 % bound."""

    value: float
    is_bound: bool


def estimate_place_noise(track: Track, smoothed: SmoothedTrack) -> PlaceNoise | None:
    """Noise of the places of even, usable points; None with too few of them.

    Points that are further apart than half the shortest turn (0.8 s) do not exclude turns between them: with them the
    result is a bound, too.
    """
    steps = np.diff(track.time)
    interval = float(np.median(steps))
    joined = (np.abs(steps - interval) < _EVEN * interval) & (np.diff(smoothed.part) == 0)
    joined &= smoothed.usable[1:] & smoothed.usable[:-1]
    runs = np.split(track.place[:, :2], np.flatnonzero(~joined) + 1)
    lower, higher = (_squares(runs, order) for order in ORDERS)
    if len(higher) < FEWEST_DIFFERENCES:
        return None
    noise, other = (math.sqrt(float(np.median(squares)) / (2.0 * math.log(2.0))) for squares in (higher, lower))
    error = 1.0 / math.sqrt(len(higher))
    alike = abs(noise - other) <= max(_ALIKE, 2.0 * _ERROR_OF_RATIO * error) * noise
    if alike and interval <= SHORTEST_WINDOW / 2.0:
        return PlaceNoise(noise, is_bound=False)
    return PlaceNoise(noise * (1.0 + 2.0 * _ERROR * error), is_bound=True)


def _squares(runs: list[FloatArray], order: int) -> FloatArray:
    """Squared differences of both coordinates over the variance that white noise of 1 m gives each of them."""
    differences = [np.diff(run, order, axis=0) for run in runs if len(run) > order]
    return np.concatenate([np.zeros(0), *(np.sum(each**2, axis=1) for each in differences)]) / math.comb(
        2 * order, order
    )
