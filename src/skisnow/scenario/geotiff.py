"""Heights from a GeoTIFF; needs rasterio (``skisnow[geotiff]``)."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from .._support.errors import ParameterError
from .._support.optional_packages import needed
from .._support.user_files import is_file
from .map_system import LENGTHS, MapSystem, length_unit, map_system
from .raster import FloatArray, PlacedValues, Raster, placed_heights, require_size


def read_geotiff(path: str | Path, *, column: str) -> PlacedValues:
    """Read the first band: x is east, y is north, in the map's coordinates (m); places are the middles of the cells.

    Heights are the band's numbers times its scale, plus its offset, in the band's unit, else in the unit of the
    vertical system, else in m.

    Raises
    ------
    ParameterError
        rasterio is not installed, the file cannot be read, it does not say where it lies, its rows do not run east, or
        the grid breaks a rule of `raster`.
    """
    if not is_file(path):
        raise ParameterError(f"{path} cannot be read: there is no such file. Check the path.")
    rasterio = _rasterio(path)
    try:
        with warnings.catch_warnings(action="ignore"), rasterio.open(path) as source:  # without a place: rejected below
            require_size(path, source.width, source.height)
            heights = _heights(path, source)
            transform, system = source.transform, _system(source)
            unit = _height_unit(path, source.units[0], system)
    except (rasterio.errors.RasterioError, UnicodeDecodeError, MemoryError) as error:  # the second from a damaged text
        raise ParameterError(f"{path} cannot be read as a GeoTIFF: {error}. Export it again.") from error
    _require_north_up(path, transform, system)
    raster = Raster(
        path=path,
        values=heights,
        first=(transform.c + transform.a / 2.0, transform.f + transform.e / 2.0),
        step=(transform.a, transform.e),
        height_unit=unit,
        system=system,
        where=lambda row, at: f"row {row + 1}, column {at + 1}",
    )
    return placed_heights(raster, column=column)


def _rasterio(path: str | Path) -> Any:
    grid = ", or write the heights as an ESRI ASCII grid, such as by gdal_translate -of AAIGrid"
    return needed("rasterio", extra="geotiff", what=f"{path}: a GeoTIFF", instead=grid)


def _heights(path: str | Path, source: Any) -> FloatArray:
    """The first band in its unit, NaN where it is masked."""
    band = source.read(1, masked=True)
    if np.iscomplexobj(band):
        raise ParameterError(f"{path}: The first band has complex numbers. Allowed: heights. Export them again.")
    scale, offset = float(source.scales[0]), float(source.offsets[0])
    if not (np.isfinite([scale, offset]).all() and scale != 0.0):
        raise ParameterError(
            f"{path}: The first band has scale {scale:g} and offset {offset:g}. Allowed: finite numbers."
        )
    with np.errstate(over="ignore", invalid="ignore"):  # huge values are rejected as heights
        return np.asarray(np.ma.filled(band.astype(float), np.nan) * scale + offset)


def _system(source: Any) -> MapSystem | None:
    return None if source.crs is None else map_system(source.crs.to_wkt())


def _height_unit(path: str | Path, name: str | None, system: MapSystem | None) -> float:
    """Length (m) of one unit of the heights."""
    vertical = None if system is None else system.height_unit
    if not (name or "").strip():
        return 1.0 if vertical is None else vertical
    unit = length_unit(str(name))
    if unit is None:
        raise ParameterError(
            f"{path}: The unit of the first band is {name!r}. Allowed: {', '.join(LENGTHS)}. Fix: gdal_edit -units m."
        )
    if vertical is not None and abs(unit - vertical) > 1e-4 * vertical:
        raise ParameterError(
            f"{path}: The first band is in {name}, but one unit of its vertical system is {vertical:g} m. Fix: state "
            "one unit, such as by gdal_edit -units or -a_srs."
        )
    return unit


def _require_north_up(path: str | Path, transform: Any, system: MapSystem | None) -> None:
    if transform.b != 0.0 or transform.d != 0.0:
        raise ParameterError(
            f"{path}: its rows do not run east; warp it, such as by gdalwarp, to a grid that is not turned"
        )
    if system is None and (transform.a, transform.c, transform.e, transform.f) == (1.0, 0.0, 1.0, 0.0):
        raise ParameterError(
            f"{path}: The file does not say where it lies and how large its cells are. Export it again."
        )
