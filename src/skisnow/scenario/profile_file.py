"""A measured profile of a slope from its CSV file."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from .._support.csv_rows import csv_rows
from .._support.errors import ParameterError
from .raster import number_within, profile_limits
from .slope import Gap, Profile

COLUMNS: Final = ("x", "y")
_ACTION: Final = "write horizontal distance and height in m, with a decimal point, under a first line x,y"


def read_profile(path: str | Path, *, gap: Gap = "error") -> Profile:
    """Read a profile.

    Parameters
    ----------
    path
        A CSV file with a first line ``x,y``: horizontal distance, rising, and height, both in m. Commas, semicolons or
        tabs between cells; decimal points, or commas where cells are parted otherwise. Other columns are not read.
    gap
        What to do where neighbouring points are more than 5 m apart: "error", or "interpolate" over it.

    Raises
    ------
    ParameterError
        The file cannot be read, a column is missing, a cell holds no finite number or an impossible one (file, row,
        column and value are named), or it is no profile: too few points, x that does not rise, a gap, a cliff.
    """
    limits = profile_limits(COLUMNS)
    rows = csv_rows(path, COLUMNS, action=_ACTION)
    numbers = [[number_within(row, name, limits[name]) for name in COLUMNS] for row in rows]
    table = np.array(numbers, dtype=float).reshape(-1, 2)
    try:
        return Profile(table[:, 0], table[:, 1], gap=gap, source=str(path))
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error
