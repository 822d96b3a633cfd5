"""Tracks in GPX 1.0 and 1.1, read with gpxpy; speed as GPX 1.0 has it, or in an extension named ``speed``.

Heights of GPX are above mean sea level. Routes and waypoints are not read.
"""

from __future__ import annotations

import math
import re
from datetime import UTC
from typing import TYPE_CHECKING, Any

import numpy as np

from ..spreadsheet_text import number
from .recording import Recording
from .trouble import refusal

if TYPE_CHECKING:
    from collections.abc import Iterator


def read_gpx(text: str, name: str) -> Recording:
    """The recording in a GPX file: all points of all tracks, in the order of the file.

    Raises
    ------
    FieldDataError
        The file is no GPX, or a point has no time, or a speed that is no number.
    """
    points = list(_points(_parsed(text, name)))
    for place, point in enumerate(points):
        if point.time is None:
            raise refusal(
                "not_a_time",
                name,
                place=f"point {place + 1}",
                column="time",
                allowed="a time such as 2022-12-27T15:51:14Z in every point",
                action="The point has no time, or one that cannot be read. A drawn route is no recorded track.",
            )
    moments = [_in_utc(point.time) for point in points]
    return Recording(
        name=name,
        places_in_file=[f"point {place + 1}" for place in range(len(points))],
        time=np.array([(moment - moments[0]).total_seconds() for moment in moments]),
        place=np.array(
            [[_or_nan(p.latitude), _or_nan(p.longitude), _or_nan(p.elevation)] for p in points], dtype=float
        ).reshape(-1, 3),
        is_geodetic=True,
        time_scale="UTC",
        start=moments[0] if moments else None,
        speed=np.array([_speed(point, name, place) for place, point in enumerate(points)], dtype=float),
        speed_kind="as the device gives it",
        fix=np.array([point.type_of_gpx_fix != "none" for point in points], dtype=bool),
        heights="above mean sea level, as recorded",
    )


def _parsed(text: str, name: str) -> Any:
    import gpxpy

    try:
        return gpxpy.parse(re.sub(r"^\s*<\?xml.*?\?>", "", text, count=1, flags=re.DOTALL))
    except Exception as error:  # gpxpy lets many kinds through, and says which in words
        raise refusal(
            "unreadable_file",
            name,
            value=str(error),
            allowed="GPX 1.0 or 1.1",
            action="The file is damaged or ends too early; export it again.",
        ) from error


def _points(gpx: Any) -> Iterator[Any]:
    for track in gpx.tracks:
        for segment in track.segments:
            yield from segment.points


def _in_utc(time: Any) -> Any:
    """GPX says UTC; a time without zone is taken at its word."""
    return time.replace(tzinfo=UTC) if time.tzinfo is None else time.astimezone(UTC)


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _speed(point: Any, name: str, place: int) -> float:
    """Speed in m/s: of GPX 1.0, or of the first element called speed in the point's extensions."""
    if point.speed is not None:
        return float(point.speed)
    for extension in point.extensions:
        for element in extension.iter():
            if str(element.tag).rsplit("}", 1)[-1].rsplit(":", 1)[-1].lower() == "speed" and element.text:
                return _number(element.text.strip(), name, place)
    return math.nan


def _number(text: str, name: str, place: int) -> float:
    value = number(text)
    if math.isnan(value):
        raise refusal(
            "not_a_number",
            name,
            place=f"point {place + 1}",
            column="speed",
            value=text,
            allowed="a finite number in m/s",
            action="Correct the point.",
        )
    return value
