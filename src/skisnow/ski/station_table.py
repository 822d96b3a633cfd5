"""Values given at some stations of a ski, for all stations between and beyond."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..errors import ParameterError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class StationTable:
    """Values at stations (m), listed from tip to tail.

    Between the stations a shape-preserving cubic interpolates (Fritsch and Carlson 1980; SciPy's PCHIP): it never
    leaves the range of its neighbours, so a positive table stays positive. Beyond the first and the last station their
    values are held. One value alone holds everywhere.

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
        from scipy.interpolate import PchipInterpolator  # slow to load, and asked for with a ski at hand only

        within = np.clip(station, self.station[-1], self.station[0])
        return np.asarray(PchipInterpolator(self.station[::-1], self.value[::-1])(within))


def evenly_spread(values: npt.ArrayLike, front: float, rear: float) -> StationTable:
    """Table of values at even spacing from a front to a rear station (m)."""
    listed = np.atleast_1d(np.asarray(values, dtype=float))
    return StationTable(np.linspace(front, rear, listed.size), listed)
