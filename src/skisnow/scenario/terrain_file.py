"""Measured terrain from its file: CSV, ESRI ASCII grid or GeoTIFF."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from .._support.errors import ParameterError
from .esri_ascii import read_esri_ascii
from .geotiff import read_geotiff
from .grid_table import read_grid_table
from .raster import PlacedValues
from .terrain import Terrain

HEIGHT: Final = "z_m"
_ACTION: Final = (
    "write one row for each place of an even grid, with a decimal point, in m, under a first line x_m,y_m,z_m"
)


def read_terrain(path: str | Path, *, smoothing: float = 0.0, origin_x: float = 0.0, origin_y: float = 0.0) -> Terrain:
    """Read measured terrain.

    Parameters
    ----------
    path
        ``.asc`` or ``.agr``: ESRI ASCII grid. ``.tif`` or ``.tiff``: GeoTIFF, whose first band are the heights. Any
        other: CSV with the columns ``x_m``, ``y_m``, ``z_m``, rows in any order.
    smoothing, origin_x, origin_y
        As of `Terrain` (m).

    Raises
    ------
    ParameterError
        The file cannot be read or is no grid; file, row, column and value are named.
    """
    found = _placed(Path(path))
    try:
        return Terrain(
            found.x, found.y, found.columns[HEIGHT],
            source=str(path), smoothing=smoothing, origin_x=origin_x, origin_y=origin_y,
        )  # fmt: skip
    except ParameterError as error:
        raise ParameterError(f"{path}: {error}") from error


def _placed(path: Path) -> PlacedValues:
    kind = path.suffix.lower()
    if kind in (".asc", ".agr"):
        return read_esri_ascii(path, column=HEIGHT)
    if kind in (".tif", ".tiff"):
        return read_geotiff(path, column=HEIGHT)
    return read_grid_table(path, (HEIGHT,), action=_ACTION)
