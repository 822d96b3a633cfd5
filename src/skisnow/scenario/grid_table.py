"""Values over evenly spaced places from a table with one row for each place."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.csv_rows import CsvRow, csv_rows
from .._support.errors import ParameterError
from .raster import FloatArray, PlacedValues, number_within, require_places

ROUNDED: Final = 0.01
"""Share of the spacing by which a place may lie off its even place: it was written rounded (modelling assumption)."""

SPARSE: Final = 10
"""Places for each row beyond which rows lie on no grid at all."""


def read_grid_table(path: str | Path, columns: Sequence[str], *, action: str) -> PlacedValues:
    """Read columns over ``x_m, y_m``: rows in any order, one for each place of a grid.

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing, a cell holds no finite number or one outside `LIMITS`, a
        place is listed twice or not at all, places are not evenly spaced, or x and y look like degrees; file, row,
        column and value are named.
    """
    names, rows, cells = ("x_m", "y_m", *columns), [], []
    for row in csv_rows(path, names, action=action):
        rows.append(row)
        cells.append([number_within(row, name) for name in names])
    numbers = dict(zip(names, np.array(cells, dtype=float).reshape(-1, len(names)).T, strict=True))
    x, i = _even(path, numbers["x_m"], rows, "x_m")
    y, j = _even(path, numbers["y_m"], rows, "y_m")
    _require_each_once(path, rows, (x, i), (y, j), action)
    steps = float(x[1] - x[0]), float(y[1] - y[0])
    require_places(path, (float(x[0]), float(y[0])), steps, (len(x), len(y)))
    filled = {}
    for name in columns:
        values = np.empty((len(x), len(y)))
        values[i, j] = numbers[name]
        filled[name] = values
    return PlacedValues(x, y, filled)


def _even(
    path: str | Path, places: FloatArray, rows: Sequence[CsvRow], column: str
) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Even places and the number of each row's place among them."""
    different = np.unique(places)
    if len(different) < 2:
        raise ParameterError(f"{path}, column {column}: there is only {_listed(different)}; a grid needs two or more")
    step = float(np.min(np.diff(different)))
    close = np.diff(different) > ROUNDED * (different[-1] - different[0]) / len(different)
    kept = different[np.append(True, close)]  # places that differ by rounding are one
    step = float(kept[-1] - kept[0]) / (len(kept) - 1)
    number = np.rint((places - kept[0]) / step).astype(np.intp)
    off = np.abs(places - kept[0] - number * step)
    worst = int(np.argmax(off))
    if off[worst] > ROUNDED * step:
        raise rows[worst].refused(
            column,
            f"is off the even places from {kept[0]:g} to {kept[-1]:g} m, which are {step:.6g} m apart on average",
            action="interpolate onto evenly spaced places, or add what is missing",
        )
    return kept[0] + step * np.arange(len(kept)), number


def _listed(values: FloatArray) -> str:
    return ", ".join(f"{value:g} m" for value in values) or "nothing"


def _require_each_once(
    path: str | Path,
    rows: Sequence[CsvRow],
    of_x: tuple[FloatArray, npt.NDArray[np.intp]],
    of_y: tuple[FloatArray, npt.NDArray[np.intp]],
    action: str,
) -> None:
    (x, i), (y, j) = of_x, of_y
    if len(x) * len(y) > SPARSE * len(rows):
        raise ParameterError(
            f"{path}: {len(rows)} rows have {len(x)} different x_m and {len(y)} different y_m, so that they lie on no "
            f"grid; interpolate onto one. {action[0].upper()}{action[1:]}"
        )
    place = i * len(y) + j
    count = np.bincount(place, minlength=len(x) * len(y))
    if np.any(count > 1):
        twice = np.flatnonzero(place == int(np.argmax(count > 1)))[:2]
        first, again = (rows[int(each)] for each in twice)
        raise ParameterError(
            f"{path}, row {again.row}: x_m = {again.cells['x_m']}, y_m = {again.cells['y_m']} stand in row "
            f"{first.row}, too; keep one of them"
        )
    if np.any(count == 0):
        gap = int(np.argmin(count))
        raise ParameterError(
            f"{path}: no row has x_m = {x[gap // len(y)]:g} and y_m = {y[gap % len(y)]:g}, of {len(x)} places in x and "
            f"{len(y)} in y; {action}"
        )
