"""What a point of a recording may say: numbers beyond are in no unit a ski run's, or would overflow on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

from ..parameters import Quantity, own_quantities
from .projection import HIGHEST

FARTHEST: Final = 1e8
"""Places, times and distances (m, s) beyond this are not those of a ski run."""
FASTEST_NUMBER: Final = 1e4
"""Speeds (m/s) beyond this are no speeds of anything that touches snow."""


def _place(name: str) -> Quantity:
    return Quantity(name, "in the frame of the file", lowest=-FARTHEST, highest=FARTHEST)


def _velocity(name: str, meaning: str) -> Quantity:
    return Quantity(name, meaning, lowest=-FASTEST_NUMBER, highest=FASTEST_NUMBER)


@dataclass(frozen=True, slots=True)
class LocalPlace:
    """Where a point is, in metres of the file."""

    x: Annotated[float, _place("x_m")]
    y: Annotated[float, _place("y_m")]
    z: Annotated[float, _place("z_m")]


@dataclass(frozen=True, slots=True)
class GeodeticPlace:
    """Where on earth a point is."""

    latitude: Annotated[float, Quantity("latitude_deg", "latitude", lowest=-90.0, highest=90.0)]
    longitude: Annotated[float, Quantity("longitude_deg", "longitude", lowest=-180.0, highest=180.0)]
    height: Annotated[float, Quantity("height_m", "height", lowest=-HIGHEST, highest=HIGHEST)]


@dataclass(frozen=True, slots=True)
class Motion:
    """What else a device may say of a point."""

    speed: Annotated[float, _velocity("speed_m_per_s", "speed")]
    velocity: Annotated[float, _velocity("velocity_m_per_s", "part of the velocity")]
    odometer: Annotated[float, Quantity("odometer_m", "distance so far", lowest=-FARTHEST, highest=FARTHEST)]
    place_sd: Annotated[float, Quantity("place_sd_m", "standard deviation of a place", lowest=0.0, highest=FARTHEST)]
    speed_sd: Annotated[
        float, Quantity("speed_sd_m_per_s", "standard deviation of the speed", lowest=0.0, highest=FASTEST_NUMBER)
    ]


LOCAL: Final = own_quantities(LocalPlace)
GEODETIC: Final = own_quantities(GeodeticPlace)
MOTION: Final = {each.field: each for each in own_quantities(Motion)}
