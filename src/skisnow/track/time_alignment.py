"""Offset in time between two tracks, fitted by least squares at equal time."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
from scipy.optimize import minimize_scalar

from .._support.errors import FitError
from .alignment import LEAST_SHARE, PLACES
from .polyline import Polyline

_TIMES: Final = 401


def fitted_time(simulated: Polyline, measured: Polyline) -> float:
    """By how much the simulated track's time is ahead of the measured one's (s): least squares at equal time.

    The mean square distance over the measured track's length is looked at over all times at which at least half of the
    shorter track has a moment in common with the other, then minimised from the best of them.

    Raises
    ------
    FitError
        One of the tracks has no duration.
    """
    shorter = min(simulated.time[-1] - simulated.time[0], measured.time[-1] - measured.time[0])
    if not shorter > 0.0:
        raise FitError("the start time cannot be fitted: one of the tracks has no duration")
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
    found = minimize_scalar(mean_square, bounds=bounds, method="bounded", options={"xatol": 1e-9 * max(1.0, shorter)})
    return float(found.x)
