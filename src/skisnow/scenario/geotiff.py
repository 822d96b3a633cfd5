"""Heights from a GeoTIFF; needs rasterio (``skisnow[geotiff]``)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..given import is_file
from ..optional_packages import needed
from .grid_table import PlacedValues


def read_geotiff(path: str | Path, *, column: str) -> PlacedValues:
    """Read the first band: x is east, y is north, in the file's coordinates (m); places are the middles of the cells.

    Raises
    ------
    ParameterError
        rasterio is not installed, the file cannot be read, its coordinates are degrees or not in metres, it is turned
        against them, or a cell has no height.
    """
    if not is_file(path):
        raise ParameterError(f"{path} cannot be read: there is no such file. Check the path.")
    rasterio = _rasterio(path)
    try:
        with rasterio.open(path) as source:
            band = source.read(1, masked=True)
            transform, system = source.transform, source.crs
    except rasterio.errors.RasterioError as error:
        raise ParameterError(f"{path} is no GeoTIFF that can be read: {error}. Export it again.") from error
    _require_metres(path, system)
    if transform.b != 0.0 or transform.d != 0.0:
        raise ParameterError(
            f"{path}: its rows do not run east; warp it, such as by gdalwarp, to a grid that is not turned"
        )
    heights = np.ma.filled(band.astype(float), np.nan)
    bad = np.argwhere(~np.isfinite(heights))
    if len(bad):
        row, at = (int(each) + 1 for each in bad[0])
        raise ParameterError(
            f"{path}, row {row}, column {at}: no height, and {len(bad)} cells like it. Cut out a rectangle that is "
            "measured everywhere, or fill the gaps"
        )
    n_rows, n_columns = heights.shape
    x = transform.c + transform.a * (np.arange(n_columns) + 0.5)
    y = transform.f + transform.e * (np.arange(n_rows) + 0.5)
    values = heights.T
    if transform.a < 0.0:
        x, values = x[::-1], values[::-1]
    if transform.e < 0.0:
        y, values = y[::-1], values[:, ::-1]
    return PlacedValues(x, y, {column: np.ascontiguousarray(values)})


def _rasterio(path: str | Path) -> Any:
    grid = ", or write the heights as an ESRI ASCII grid, such as by gdal_translate -of AAIGrid"
    return needed("rasterio", extra="geotiff", what=f"{path}: a GeoTIFF", instead=grid)


def _require_metres(path: str | Path, system: Any) -> None:
    if system is None:
        return  # the file says nothing: metres, as of an ESRI ASCII grid
    if system.is_geographic:
        raise ParameterError(
            f"{path}: its coordinates are degrees ({system}); warp it to metres, such as by gdalwarp -t_srs EPSG:32632"
        )
    if abs(system.linear_units_factor[1] - 1.0) > 1e-9:
        raise ParameterError(f"{path}: its coordinates are in {system.linear_units}; warp it to a system in metres")
