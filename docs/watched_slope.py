"""A slope as a watch measured it: heights over the way of a day's skiing, as a profile for a scenario."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import numpy.typing as npt

DAY = Path(__file__).resolve().parents[2] / "shared" / "data" / "ski-track" / "morin_heights_2022-12-27.csv"
"""Of a wrist watch, a row a second: columns dist_m and alt_m."""
SMOOTHED = 10.0
"""Standard deviation of the Gaussian by which heights are meant (m)."""
REACH = 4.0
BEFORE, BEHIND = 20.0, 30.0


def write_profile(path: Path, begins: float, length: float, day: Path = DAY) -> npt.NDArray[np.float64]:
    """Write the slope from a place of the day's way on (m), so long (m), as columns x, y; gives its angles (°).

    The way along the tracks counts as distance: turns make it longer than the fall line, and slopes less steep.
    """
    with day.open(encoding="utf-8", newline="") as file:
        rows = [(row["dist_m"], row["alt_m"]) for row in csv.DictReader(file)]
    known = np.array([row for row in rows if all(row)], dtype=float)
    way, first = np.unique(known[:, 0], return_index=True)
    x = np.arange(-BEFORE, length + BEHIND)
    there = np.arange(x[0] - REACH * SMOOTHED, x[-1] + REACH * SMOOTHED + 1.0)
    heights = np.interp(begins + there, way, known[first, 1])
    weights = np.exp(-0.5 * ((there - x[:, None]) / SMOOTHED) ** 2)
    y = weights @ heights / weights.sum(axis=1)
    np.savetxt(path, np.column_stack([x, y - y[0]]), delimiter=",", header="x,y", comments="", fmt="%.4f")
    down = (x >= 0.0) & (x <= length)
    return np.degrees(-np.arctan(np.gradient(y, x)))[down]
