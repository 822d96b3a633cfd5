"""Map systems of rasters: units of places and heights, degrees, and the length of a metre on the map.

The description is well-known text (WKT 1 or 2), as in a GeoTIFF and in the ``.prj`` file of an ESRI ASCII grid.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from .._support.errors import ParameterError
from ..track.projection import earth_centred

TRUE_LENGTHS: Final = 0.005
"""Share by which a length on the map may differ from the ground; UTM differs by up to 0.001 (modelling assumption)."""
_US_FOOT: Final = 1200.0 / 3937.0
LENGTHS: Final = {
    **dict.fromkeys(("m", "metre", "meter"), 1.0),
    **dict.fromkeys(("dm", "decimetre", "decimeter"), 0.1),
    **dict.fromkeys(("cm", "centimetre", "centimeter"), 0.01),
    **dict.fromkeys(("mm", "millimetre", "millimeter"), 0.001),
    **dict.fromkeys(("km", "kilometre", "kilometer"), 1000.0),
    **dict.fromkeys(("ft", "foot", "feet", "international foot"), 0.3048),
    **dict.fromkeys(("us survey foot", "us survey feet", "us foot", "foot us", "us ft", "ftus"), _US_FOOT),
    **dict.fromkeys(("yd", "yard"), 0.9144),
}
"""Metres in a unit of length, by its name in lower case with single blanks."""
_UNIT: Final = re.compile(r'UNIT\s*\[\s*"([^"]*)"\s*,\s*([0-9.eE+-]+)', re.IGNORECASE)
_VERTICAL: Final = re.compile(r"VERT_?C(?:S|RS)\s*\[|VERTICALCRS\s*\[", re.IGNORECASE)
_PROJECTED: Final = re.compile(r"(?:PROJCS|PROJCRS|PROJECTEDCRS)\s*\[", re.IGNORECASE)
_DEGREES: Final = re.compile(
    r"(?:GEOGCS|GEOGCRS|GEODCRS|GEOGRAPHICCRS)\s*\[|^\s*projection\s+geographic\b|^\s*units\s+d[ds]\b",
    re.IGNORECASE | re.MULTILINE,
)
_OLD_UNIT: Final = re.compile(r"^\s*units\s+(\w+)", re.IGNORECASE | re.MULTILINE)
_OLD_HEIGHT_UNIT: Final = re.compile(r"^\s*zunits\s+(\w+)", re.IGNORECASE | re.MULTILINE)
_MERCATOR: Final = re.compile(r'PROJECTION\s*\[\s*"(?:popular[_ ]visualisation[_ ]pseudo[_ ])?mercator', re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class MapSystem:
    """Units of a map's coordinate system.

    text: its description as WKT.
    in_degrees: True for longitude and latitude.
    unit: m, length of one unit of x and y.
    height_unit: m or None, length of one unit of the heights; None if the system has no heights.
    downwards: True if its heights count downwards, as depths do.
    """

    text: str
    in_degrees: bool
    unit: float
    height_unit: float | None
    downwards: bool

    @property
    def name(self) -> str:
        """The first quoted name of the description."""
        match = re.search(r'"([^"]*)"', self.text)
        return match[1] if match else " ".join(self.text.split()[:2])


def length_unit(name: str) -> float | None:
    """Metres in a unit of length; None for an unknown unit.

    >>> length_unit("US_survey-foot") == 1200 / 3937, length_unit("Meters"), length_unit("fathom")
    (True, 1.0, None)
    """
    words = " ".join(re.sub(r"[_\-.]", " ", name.lower()).split())
    return LENGTHS.get(words, LENGTHS.get(words.removesuffix("s")))


def _factor(text: str) -> float:
    """Length (m) of a unit from the number in its description; ParameterError unless above 0."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise ParameterError("the description of the map system states a unit of {text!r}. Allowed: above 0, in m").tag(
            "out_of_range", text=text[:40]
        )
    return value


def map_system(text: str) -> MapSystem:
    """Parse a description: WKT, or the older lines ``Projection …``, ``Units …``, ``Zunits …``."""
    vertical = _VERTICAL.search(text)
    places, heights = (text[: vertical.start()], text[vertical.start() :]) if vertical else (text, "")
    projected = _PROJECTED.search(places) is not None
    units = _UNIT.findall(places)
    old = _OLD_UNIT.search(places)
    unit = _factor(units[-1][1]) if units else length_unit(old[1]) if old else None
    in_degrees = not projected and _DEGREES.search(places) is not None
    height_units, old_height = _UNIT.findall(heights), _OLD_HEIGHT_UNIT.search(text)
    height_unit = length_unit(old_height[1]) if old_height and "[" not in text else None
    return MapSystem(
        text=text,
        in_degrees=in_degrees,
        unit=1.0 if in_degrees or unit is None else unit,
        height_unit=_factor(height_units[-1][1]) if height_units else height_unit,
        downwards=re.search(r'AXIS\s*\[\s*"[^"]*"\s*,\s*DOWN\b', heights, re.IGNORECASE) is not None,
    )


def require_true_lengths(path: object, system: MapSystem, x: float, y: float) -> None:
    """Reject a map on which lengths differ from the ground, such as one in the Mercator projection.

    x, y: middle of the grid, in the system's units.
    """
    true_scale, limit = _scale(system, x, y), 100 * TRUE_LENGTHS
    if true_scale is None:
        if _MERCATOR.search(system.text):
            raise ParameterError(
                "{path}: The map system {system} stretches lengths by 1/cos of the latitude at the grid. Allowed: at "
                "most {limit:g} %. Fix: warp the grid to a system with true lengths, such as gdalwarp -t_srs the UTM "
                "zone of the place -r cubic."
            ).tag("stretched", path=path, system=system.name, limit=limit)
        return
    scales, target = true_scale
    worst = max(scales, key=lambda scale: abs(scale - 1.0))
    if not abs(worst - 1.0) <= TRUE_LENGTHS:
        raise ParameterError(
            "{path}: The map system {system} stretches lengths by a factor of {factor:.4g} at the grid. Allowed: at "
            "most {limit:g} %. Fix: warp the grid to a system with true lengths, such as gdalwarp -t_srs {target} -r "
            "cubic."
        ).tag("stretched", path=path, system=system.name, factor=worst, limit=limit, target=target)


def utm_zone(longitude_deg: float, latitude_deg: float) -> str:
    """EPSG code of the UTM zone on WGS84.

    >>> utm_zone(11.0, 47.0), utm_zone(-70.0, -33.0)
    ('EPSG:32632', 'EPSG:32719')
    """
    zone = min(max(math.floor((longitude_deg + 180.0) / 6.0) + 1, 1), 60)
    return f"EPSG:{(32600 if latitude_deg >= 0.0 else 32700) + zone}"


def raster_errors() -> tuple[type[Exception], ...]:
    """Errors of rasterio for a damaged file or map system, and those of GDAL, whose base class is private."""
    from rasterio._err import CPLE_BaseError
    from rasterio.errors import CRSError, RasterioError

    return RasterioError, CRSError, CPLE_BaseError, UnicodeDecodeError, MemoryError  # the fourth from a damaged text


def _scale(system: MapSystem, x: float, y: float) -> tuple[tuple[float, float], str] | None:
    """Scale of the map along x and y (length on the map over that on the ground), and the UTM zone there.

    None without rasterio, or if the system has no known place on the earth.
    """
    try:
        from rasterio.crs import CRS
        from rasterio.warp import transform
    except ImportError:
        return None
    step = 50.0 / system.unit
    at = np.array([[x, y], [x - step, y], [x + step, y], [x, y - step], [x, y + step]])
    try:
        turned: Any = transform(CRS.from_wkt(system.text), "EPSG:4326", *at.T.tolist())
    except raster_errors():
        return None
    longitude, latitude = np.array(turned[0]), np.array(turned[1])
    if not np.isfinite([longitude, latitude]).all():
        return None
    place = earth_centred(latitude, longitude, np.zeros(5))
    ground = np.linalg.norm(place[[2, 4]] - place[[1, 3]], axis=1)
    if not ground.all():  # so far away that the steps are rounded off
        return None
    along_x, along_y = (100.0 / ground).tolist()
    return (along_x, along_y), utm_zone(float(longitude[0]), float(latitude[0]))
