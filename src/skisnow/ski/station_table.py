"""Values given at some stations of a ski, for all stations between and beyond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.errors import ParameterError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class StationTable:
    """Values at stations (m), listed from tip to tail.

    Between the stations a shape-preserving cubic interpolates (Fritsch and Butland 1984, as SciPy's PCHIP does): it
    never leaves the range of its neighbours, so a positive table stays positive. Beyond the first and the last
    station their values are held. One value alone holds everywhere.

    Examples
    --------
    >>> table = StationTable(np.array([0.7, 0.0, -0.7]), np.array([100.0, 440.0, 100.0]))
    >>> [round(float(value), 6) for value in table.at(np.array([0.9, 0.7, 0.0, -0.8]))]
    [100.0, 100.0, 440.0, 100.0]
    """

    station: FloatArray
    value: FloatArray

    def __post_init__(self) -> None:
        if self.station.shape != self.value.shape or self.station.ndim != 1 or not self.station.size:
            raise ParameterError(
                f"{self.value.size} values stand at {self.station.size} stations. Give as many values as stations."
            )
        if np.any(np.diff(self.station) >= 0):
            raise ParameterError("the stations do not fall. List them from tip to tail, positive in front of the boot.")

    def at(self, station: FloatArray) -> FloatArray:
        """Values at stations (m). Shape of ``station``."""
        if self.station.size == 1:
            return np.full(np.shape(station), self.value[0])
        x, y = self.station[::-1], self.value[::-1]
        within = np.clip(station, x[0], x[-1])
        at = np.clip(np.searchsorted(x, within, side="right") - 1, 0, x.size - 2)
        width, slope = np.diff(x)[at], _slopes(x, y)
        t, rise, first, last = (within - x[at]) / width, np.diff(y)[at], width * slope[at], width * slope[at + 1]
        return np.asarray(y[at] + t * (first + t * (3.0 * rise - 2.0 * first - last + t * (first + last - 2.0 * rise))))


def _slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Slopes at the points: weighted harmonic means of those beside them, 0 at a peak; parabolas at both ends.

    Not SciPy's PCHIP, which makes the same: it takes 0.2 s to load, a fifth of the start of a run.
    """
    width = np.diff(x)
    rise = np.diff(y) / width
    if rise.size == 1:
        return np.repeat(rise, 2)
    same = rise[1:] * rise[:-1] > 0.0
    near, far = 2.0 * width[1:] + width[:-1], width[1:] + 2.0 * width[:-1]
    means = (near + far) / (near / np.where(same, rise[:-1], 1.0) + far / np.where(same, rise[1:], 1.0))
    first = _end_slope(width[0], width[1], rise[0], rise[1])
    last = _end_slope(width[-1], width[-2], rise[-1], rise[-2])
    return np.concatenate([[first], np.where(same, means, 0.0), [last]])


def _end_slope(width: float, next_width: float, rise: float, next_rise: float) -> float:
    """That of the parabola through the outer three points, unless it would overshoot."""
    slope = ((2.0 * width + next_width) * rise - width * next_rise) / (width + next_width)
    if slope * rise <= 0.0:
        return 0.0
    return 3.0 * rise if rise * next_rise <= 0.0 and abs(slope) > 3.0 * abs(rise) else slope


def evenly_spread(values: npt.ArrayLike, front: float, rear: float) -> StationTable:
    """Table of values at even spacing from a front to a rear station (m)."""
    listed = np.atleast_1d(np.asarray(values, dtype=float))
    return StationTable(np.linspace(front, rear, listed.size), listed)
