"""From the WGS84 ellipsoid to metres: earth-centred coordinates, and a plane that touches the ground at an origin.

Earth-centred, earth-fixed (ECEF) coordinates of latitude φ, longitude λ and height h above the ellipsoid, with
N = a/√(1 − e² sin² φ):

    X = (N + h) cos φ cos λ,   Y = (N + h) cos φ sin λ,   Z = (N (1 − e²) + h) sin φ

East, north, up are the components of the difference to the origin along the three unit vectors at the origin. No
distance is distorted: it is a rotation. "Up" is the height above the plane that touches the ellipsoid at the origin's
height; the ellipsoid falls away from it by d²/(2R): 8 cm at 1 km, 8 m at 10 km.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import DEGREE, Facts, Shown

SEMI_MAJOR_AXIS: Final = 6378137.0
"""a in m, WGS84."""
FLATTENING: Final = 1.0 / 298.257223563
"""f, WGS84."""
_ECCENTRICITY2: Final = FLATTENING * (2.0 - FLATTENING)
_ROUNDS: Final = 5  # each gains five digits or more from 6400 km off to 10,000 km above the ellipsoid
HIGHEST: Final = 1e5
"""Largest height (m) of a point, far above all ski slopes."""


@dataclass(frozen=True, slots=True, repr=False)
class GeodeticPoint(Shown):
    """A point on WGS84: latitude and longitude in degrees, height in m.

    Raises
    ------
    ParameterError
        Latitude beyond ±90°, longitude beyond ±180°, height beyond ±100 km, or not a finite number.

    See Also
    --------
    skisnow.in_slope_frame

    Examples
    --------
    >>> str(GeodeticPoint(47.5, -11.25, height=1500.0))
    'latitude 47.5°, longitude -11.25°, height 1500 m'
    """

    latitude_deg: float
    longitude_deg: float
    height: float = 0.0

    def _repr_facts(self) -> Facts:
        return Facts(str(self))

    def __post_init__(self) -> None:
        for name, limit in (("latitude_deg", 90.0), ("longitude_deg", 180.0), ("height", HIGHEST)):
            value = getattr(self, name)
            if not abs(value) <= limit:
                raise ParameterError("{name} of an origin is {value:g}; it must be from {lowest:g} to {limit:g}").tag(
                    "out_of_range", name=name, value=value, lowest=-limit, limit=limit
                )

    @property
    def in_space(self) -> FloatArray:
        """Earth-centred place (3,) in m."""
        return earth_centred(*np.array([self.latitude_deg, self.longitude_deg, self.height]))

    def __str__(self) -> str:
        """Coordinates to 0.1 mm."""
        return f"latitude {self.latitude_deg:.12g}°, longitude {self.longitude_deg:.12g}°, height {self.height:.9g} m"


def earth_centred(latitude_deg: FloatArray, longitude_deg: FloatArray, height: FloatArray) -> FloatArray:
    """X, Y, Z (…, 3) in m of latitude and longitude in degrees and height above the ellipsoid in m.

    >>> earth_centred(np.array(0.0), np.array(90.0), np.array(10.0)).round(6).tolist()
    [0.0, 6378147.0, 0.0]
    """
    latitude, longitude = np.asarray(latitude_deg) * DEGREE, np.asarray(longitude_deg) * DEGREE
    sine, cosine = np.sin(latitude), np.cos(latitude)
    normal = SEMI_MAJOR_AXIS / np.sqrt(1.0 - _ECCENTRICITY2 * sine**2)
    x, y = (normal + height) * cosine * np.cos(longitude), (normal + height) * cosine * np.sin(longitude)
    return np.stack([x, y, (normal * (1.0 - _ECCENTRICITY2) + height) * sine], axis=-1)


def geodetic(place: FloatArray) -> FloatArray:
    """Latitude (°), longitude (°) and height (m) above the ellipsoid (…, 3) of earth-centred places (…, 3) in m.

    Bowring's iteration on the reduced latitude β: tan φ = (Z + e'² b sin³ β)/(p − e² a cos³ β), tan β = (1 − f) tan φ.
    Below 10⁻⁸ m wherever someone skis.
    """
    x, y, z = np.moveaxis(np.asarray(place, float), -1, 0)
    axis_distance = np.hypot(x, y)
    minor = SEMI_MAJOR_AXIS * (1.0 - FLATTENING)
    beyond = _ECCENTRICITY2 / (1.0 - _ECCENTRICITY2) * minor
    reduced = np.arctan2(z, axis_distance * (1.0 - FLATTENING))
    latitude = reduced
    for _ in range(_ROUNDS):
        latitude = np.arctan2(
            z + beyond * np.sin(reduced) ** 3, axis_distance - _ECCENTRICITY2 * SEMI_MAJOR_AXIS * np.cos(reduced) ** 3
        )
        reduced = np.arctan2((1.0 - FLATTENING) * np.sin(latitude), np.cos(latitude))
    sine, cosine = np.sin(latitude), np.cos(latitude)
    root = np.sqrt(1.0 - _ECCENTRICITY2 * sine**2)
    height = axis_distance * cosine + z * sine - SEMI_MAJOR_AXIS * root  # no division: good at poles and equator
    return np.stack([latitude / DEGREE, np.arctan2(y, x) / DEGREE, height], axis=-1)


def east_north_up_axes(latitude_deg: FloatArray | float, longitude_deg: FloatArray | float) -> FloatArray:
    """Unit vectors east, north, up (…, 3, 3), one a row, in earth-centred coordinates.

    >>> east_north_up_axes(0.0, 0.0).round(9).tolist()
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    latitude, longitude = np.asarray(latitude_deg) * DEGREE, np.asarray(longitude_deg) * DEGREE
    sin_lat, cos_lat = np.sin(latitude), np.cos(latitude)
    sin_lon, cos_lon = np.sin(longitude), np.cos(longitude)
    zero = np.zeros_like(sin_lat)
    east = np.stack([-sin_lon, cos_lon, zero], axis=-1)
    north = np.stack([-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat], axis=-1)
    up = np.stack([cos_lat * cos_lon, cos_lat * sin_lon, sin_lat], axis=-1)
    return np.stack([east, north, up], axis=-2) + 0.0  # no negative zeros


def east_north_up(points: FloatArray, *, origin: GeodeticPoint) -> FloatArray:
    """East, north, up (n, 3) in m from the origin.

    points: (n, 3), latitude (°), longitude (°), height (m). Where the height is NaN the point is projected at the
        origin's height, and up is NaN: 100 m of height change east and north by 16 parts in a million.
    origin: point at which the plane touches the ellipsoid.
    """
    points = np.asarray(points, float)
    missing = np.isnan(points[:, 2])
    height = np.where(missing, origin.height, points[:, 2])
    difference = earth_centred(points[:, 0], points[:, 1], height) - origin.in_space
    place = difference @ east_north_up_axes(origin.latitude_deg, origin.longitude_deg).T
    place[missing, 2] = np.nan
    return np.asarray(place)


def place_from_origin(place: FloatArray, before: GeodeticPoint, after: GeodeticPoint) -> FloatArray:
    """Places (n, 3) in east, north, up (m) from one origin, as east, north, up from another one.

    A rotation and a shift: no distance changes. A place without height is taken to be in the first origin's plane, and
    its height stays NaN.
    """
    axes = [east_north_up_axes(point.latitude_deg, point.longitude_deg) for point in (before, after)]
    missing = np.isnan(place[:, 2])
    level = np.column_stack([place[:, :2], np.where(missing, 0.0, place[:, 2])])
    moved = (level @ axes[0] + before.in_space - after.in_space) @ axes[1].T
    moved[missing, 2] = np.nan
    return np.asarray(moved)


def rotate_to_origin(vectors: FloatArray, points: FloatArray, *, origin: GeodeticPoint) -> FloatArray:
    """Rotate vectors (n, 3) from east, north, up at points (n, 3) to east, north, up at the origin.

    A missing vertical component (NaN) counts as 0 and stays NaN. The axes of two points 1 km apart differ by 0.009°, so
    the missing component is negligible.
    """
    own = east_north_up_axes(points[:, 0], points[:, 1])
    here = east_north_up_axes(origin.latitude_deg, origin.longitude_deg)
    missing = np.isnan(vectors[:, 2])
    complete = np.where(missing[:, None] & np.array([False, False, True]), 0.0, vectors)
    turned = np.einsum("ij,nkj,nk->ni", here, own, complete)
    turned[missing, 2] = np.nan
    return np.asarray(turned)
