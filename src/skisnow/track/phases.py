"""Ups and downs of a height: turning points that differ by a least height, whatever lies between."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def turning_points(values: FloatArray, least: float) -> list[int]:
    """Numbers of the first value, of the highest and lowest in turn, and of the last.

    Parameters
    ----------
    values : (n,)
        Finite.
    least
        Two neighbouring turning points but the first and the last differ at least by this.

    >>> turning_points(np.array([0.0, 5.0, 4.5, 9.0, 1.0, 1.5, 0.0, 6.0]), 2.0)
    [0, 3, 6, 7]
    """
    found = [0]
    direction = high = low = 0
    for here in _local_extremes(values):
        if direction >= 0 and values[here] > values[high]:
            high = here
        if direction <= 0 and values[here] < values[low]:
            low = here
        if direction >= 0 and values[high] - values[here] >= least:
            found.append(high)
            direction, low = -1, here
        elif direction <= 0 and values[here] - values[low] >= least:
            found.append(low)
            direction, high = 1, here
    if direction:
        found.append(high if direction > 0 else low)
    return sorted({*found, len(values) - 1})


def _local_extremes(values: FloatArray) -> list[int]:
    """Numbers at which the direction changes, with the last: only these can be turning points."""
    signs = np.sign(np.diff(values))
    moving = np.flatnonzero(signs)
    changes = np.flatnonzero(np.diff(signs[moving])) + 1
    return [*moving[changes].tolist(), len(values) - 1] if len(values) else []
