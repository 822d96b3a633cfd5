"""Synthetic tracks: a day with lifts and a run through gates, as GPX."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING, Final

import numpy as np

from .._support.units import DEGREE
from ..track.projection import GeodeticPoint, earth_centred, geodetic
from ..track.slope_frame import slope_axes

if TYPE_CHECKING:
    import numpy.typing as npt

    FloatArray = npt.NDArray[np.float64]

ORIGIN: Final = GeodeticPoint(47.1234, 11.4321, 1900.0)
AZIMUTH_DEG: Final = 140.0
"""Compass direction in which the sample slope falls."""
START: Final = datetime(2026, 2, 3, 9, 10, tzinfo=UTC)
RECEIVER_NOISE_M: Final = 0.3
"""Standard deviation of each coordinate; the noise of neighbouring points does not correlate."""
_GATES: Final = np.array([[12.0 + 12.0 * number, 2.0 * (-1.0) ** number] for number in range(8)])
_SLOPE_DEG: Final = 12.0


def touring_day(random: np.random.Generator) -> str:
    """GPX of three runs of linked turns at 10 m/s and two lifts, 1 Hz, on a slope of 12°."""
    length, turn, swing = 600.0, 60.0, 40.0 * DEGREE
    way = np.arange(0.0, length, 0.1)
    heading = swing * np.sin(2.0 * np.pi * way / turn)
    down = np.cumsum(np.column_stack([np.cos(heading), np.sin(heading)]) * 0.1, axis=0)[::100]
    up = np.linspace(down[-1], down[0], 200)
    place = np.concatenate([down, up, down, up, down])
    return gpx_track(_noisy(place, random), np.arange(len(place), dtype=float), slope_angle=_SLOPE_DEG * DEGREE)


def gates_track(random: np.random.Generator) -> str:
    """GPX of a run at 8 m/s and 10 Hz that passes the gates of `course_waypoints`, 0.6 m from each pole."""
    x = np.arange(0.0, _GATES[-1, 0] + 12.0, 0.01)
    y = 2.6 * np.cos(np.pi * (x - _GATES[0, 0]) / 12.0) * np.clip(x / _GATES[0, 0], 0.0, 1.0)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    even = np.arange(0.0, way[-1], 0.8)
    place = np.column_stack([np.interp(even, way, x), np.interp(even, way, y)])
    noise = 0.03 * random.standard_normal(place.shape)
    return gpx_track(place + noise, 0.1 * np.arange(float(len(place))), slope_angle=_SLOPE_DEG * DEGREE)


def course_waypoints() -> str:
    """GPX of eight gates: one waypoint for each turning pole, with the side on which it is passed."""
    points = on_earth(_GATES, slope_angle=_SLOPE_DEG * DEGREE)
    sides = ["left" if y > 0.0 else "right" for _, y in _GATES]
    rows = [
        f'<wpt lat="{point[0]:.9f}" lon="{point[1]:.9f}"><ele>{point[2]:.2f}</ele>'
        f"<name>{number}</name><type>{side}</type></wpt>"
        for number, (point, side) in enumerate(zip(points, sides, strict=True), 1)
    ]
    return _document(rows)


def on_earth(place: FloatArray, *, slope_angle: float) -> FloatArray:
    """Latitude (°), longitude (°), height (m) of points x down the slope, y to the left, shape (n, 2) or (n, 3)."""
    inside = np.zeros((len(place), 3))
    inside[:, : place.shape[1]] = place
    enu = inside @ slope_axes(AZIMUTH_DEG * DEGREE, slope_angle)
    latitude, longitude = ORIGIN.latitude_deg * DEGREE, ORIGIN.longitude_deg * DEGREE
    east = np.array([-np.sin(longitude), np.cos(longitude), 0.0])
    up = np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])
    origin = earth_centred(np.array(ORIGIN.latitude_deg), np.array(ORIGIN.longitude_deg), np.array(ORIGIN.height))
    return geodetic(origin + enu @ np.stack([east, np.cross(up, east), up]))


def gpx_track(place: FloatArray, time: FloatArray, *, slope_angle: float) -> str:
    """GPX 1.1 of points on the slope (m) at times (s) after `START`."""
    rows = ["<trk><name>synthetic</name><trkseg>"]
    for (latitude, longitude, height), second in zip(on_earth(place, slope_angle=slope_angle), time, strict=True):
        stamp = (START + timedelta(seconds=float(second))).isoformat(timespec="milliseconds").replace("+00:00", "Z")
        rows.append(
            f'<trkpt lat="{latitude:.9f}" lon="{longitude:.9f}"><ele>{height:.3f}</ele><time>{stamp}</time></trkpt>'
        )
    return _document([*rows, "</trkseg></trk>"])


def _noisy(place: FloatArray, random: np.random.Generator) -> FloatArray:
    return place + RECEIVER_NOISE_M * random.standard_normal(place.shape)


def _document(rows: list[str]) -> str:
    head = '<gpx version="1.1" creator="skisnow, synthetic" xmlns="http://www.topografix.com/GPX/1/1">'
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, *rows, "</gpx>", ""])
