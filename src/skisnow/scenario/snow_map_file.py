"""A snow map from its CSV file."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from .._support.csv_rows import CsvRow, csv_rows
from .._support.errors import ParameterError
from .._support.units import N_PER_MM2, N_PER_MM3
from ..geometry.surfaces import Grid
from .grid_table import read_grid_table
from .raster import number_within
from .snow_map import SnowMap

SIZES: Final = {"H_V_N_per_mm3": N_PER_MM3, "S_f_N_per_mm2": N_PER_MM2}
FINER: Final = 16
"""Places of an uneven row's even table for each of its shortest distances."""
MOST_PLACES: Final = 20_000
CLOSEST: Final = 1e-6
"""Rows nearer to each other (m) are at the same place (modelling assumption)."""
_ACTION: Final = (
    "write x_m and H_V_N_per_mm3, S_f_N_per_mm2 or both, one row for each place along the slope; with y_m one row for "
    "each place of an even grid"
)


def read_snow_map(path: str | Path) -> SnowMap:
    """Read H_V and S_f over the place.

    Parameters
    ----------
    path
        CSV with ``x_m``, one or both of ``H_V_N_per_mm3`` and ``S_f_N_per_mm2``, and where the snow varies across the
        slope ``y_m``. With ``y_m`` places are those of an even grid, in any order; without it x rises, evenly or not,
        and values between are those of monotone cubics (PCHIP).

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing, a cell holds no number above 0, or places are no grid; file, row,
        column and value are named.
    """
    rows = [_positive(row) for row in csv_rows(path, ("x_m",), further=("y_m", *SIZES), action=_ACTION)]
    names = [name for name in SIZES if rows and name in rows[0].cells]
    if not names:
        raise ParameterError(f"{path}: there is no column {' and none '.join(SIZES)}, or no row; {_ACTION}")
    grids = _grids(path, names) if "y_m" in rows[0].cells else _along(path, rows, names)
    try:
        return SnowMap(
            hardness=grids.get("H_V_N_per_mm3"), failure_shear_stress=grids.get("S_f_N_per_mm2"), source=str(path)
        )
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def _positive(row: CsvRow) -> CsvRow:
    """The row, if what it says of the snow is above 0."""
    for name in SIZES:
        if name in row.cells and not number_within(row, name) > 0.0:
            raise row.refused(name, "is not above 0")
    return row


def _grids(path: str | Path, names: Sequence[str]) -> dict[str, Grid]:
    found = read_grid_table(path, names, action=_ACTION)
    return {name: Grid(found.x, found.y, SIZES[name] * values) for name, values in found.columns.items()}


def _along(path: str | Path, rows: Sequence[CsvRow], names: Sequence[str]) -> dict[str, Grid]:
    """Uneven places are brought to even ones by cubics that do not overshoot."""
    x = np.array([number_within(row, "x_m") for row in rows])
    if len(x) < 2:
        raise ParameterError(f"{path}: there are {len(x)} rows; snow that varies needs two or more")
    for row, step in zip(rows[1:], np.diff(x), strict=True):
        if not step > CLOSEST:
            raise row.refused("x_m", "does not rise", action="sort the rows, and keep one of those at the same place")
    from scipy.interpolate import PchipInterpolator  # slow to load

    count = min(MOST_PLACES, FINER * math.ceil((x[-1] - x[0]) / np.diff(x).min()) + 1)
    even = np.linspace(x[0], x[-1], count)
    columns = {name: SIZES[name] * np.array([row.number(name) for row in rows]) for name in names}
    return {name: Grid.along(even, PchipInterpolator(x, values)(even)) for name, values in columns.items()}
