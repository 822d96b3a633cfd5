"""Tracks in GPX 1.0 and 1.1 and in TCX, with speeds of GPX 1.0 or of an extension named ``speed``.

The file is read in one pass with expat, without a tree. Nesting and number of elements are limited, and a file that
declares entities is rejected. Heights of GPX are above mean sea level. Routes and waypoints are not read.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC
from typing import Final, NoReturn
from xml.parsers import expat

import numpy as np

from ..._support.messages import Message
from ..._support.spreadsheet_text import number
from .recording import Recording, is_not_finite, track_error
from .text import moment

DEEPEST: Final = 100
"""Elements within each other; a point with extensions has about seven."""
MOST_ELEMENTS: Final = 20_000_000
"""A week of points ten times a second, three elements each."""
_POINT: Final[tuple[str, ...]] = ("gpx", "trk", "trkseg", "trkpt")
_TCX_POINT: Final[tuple[str, ...]] = ("TrainingCenterDatabase", "Activities", "Activity", "Lap", "Track", "Trackpoint")
_NUMBERS: Final = ("lat", "lon", "ele", "distance", "speed", "extended speed")
_OTHERS: Final = ("wpt", "rtept", "trkpt", "Trackpoint")
"""Points of a file; only those of recorded tracks are read."""
_TEXTS: Final = {key: key for key in ("ele", "time", "speed", "fix")}
_TCX_TEXTS: Final = {
    "AltitudeMeters": "ele",
    "DistanceMeters": "distance",
    "Time": "time",
    "Position/LatitudeDegrees": "lat",
    "Position/LongitudeDegrees": "lon",
}


@dataclass(slots=True)
class _Point:
    """Texts of a point as written, and the number of its segment."""

    segment: int
    texts: dict[str, str] = field(default_factory=dict)
    needs_place: bool = True


class _Reader:
    """Handler that collects the points of a GPX or TCX file from the events of the XML parser expat."""

    def __init__(self, name: str) -> None:
        self._name = name
        self.points: list[_Point] = []
        self._segment = 0
        self._path: list[str] = []
        self.root = ""
        self.others: dict[str, int] = {}
        self._point, self._texts = _POINT, _TEXTS
        self._count = 0
        self._text: list[str] | None = None

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Handle an opening tag: begin a segment, a point or a text, or count an element of another kind."""
        self._text = None
        self._path.append(name.rsplit("}", 1)[-1])
        self._count += 1
        self.root = self._path[0]
        if self._path == [_TCX_POINT[0]]:
            self._point, self._texts = _TCX_POINT, _TCX_TEXTS
        if len(self._path) > DEEPEST:
            allowed = Message("at most {most}", most=DEEPEST)
            self._refuse(Message("{count} elements within each other", count=len(self._path)), allowed)
        if self._count > MOST_ELEMENTS:
            allowed = Message("at most {most}", most=MOST_ELEMENTS)
            self._refuse(Message("more than {most} elements", most=MOST_ELEMENTS), allowed)
        if tuple(self._path) == self._point[:-1]:
            self._segment += 1
        elif tuple(self._path) == self._point:
            place = {key: attributes[key] for key in ("lat", "lon") if key in attributes}
            self.points.append(_Point(self._segment, place, needs_place=self._point == _POINT))
        elif self._path[-1] in _OTHERS:
            self.others[self._path[-1]] = self.others.get(self._path[-1], 0) + 1
        elif self._key() is not None:
            self._text = []

    def text(self, text: str) -> None:
        """Collect characters if the open element is one of a point's texts."""
        if self._text is not None:
            self._text.append(text)

    def end(self, _name: str) -> None:
        """Handle a closing tag: store the collected text in the last point, unless it has one already."""
        key = self._key()
        if key is not None and self._text is not None:
            self.points[-1].texts.setdefault(key, "".join(self._text).strip())
        self._text = None
        self._path.pop()

    def entity(self, name: str, *_rest: object) -> None:
        """Reject the file: it declares an entity, which could expand without limit."""
        self._refuse(Message("the declaration of an entity, {name}", name=name), Message("a file without them"))

    def _refuse(self, value: str, allowed: Message) -> NoReturn:
        """Raise an error for a file that cannot be read."""
        raise track_error("unreadable_file", self._name, allowed, value=value)

    def _key(self) -> str | None:
        """Key of the open element's text, if it is one of a point's texts or a speed in its extensions; else None."""
        size = len(self._point)
        path = self._path[size:]
        if not path or tuple(self._path[:size]) != self._point:
            return None
        if path[0].lower() == "extensions":
            is_speed = len(path) > 1 and path[-1].rsplit(":", 1)[-1].lower() == "speed"
            return "extended speed" if is_speed else None
        return self._texts.get("/".join(path))


def read_gpx(text: str, name: str) -> Recording:
    """The recording in a GPX or TCX file: all points of all tracks and segments, in the order of the file.

    Raises FieldDataError: the file is neither GPX nor TCX, or has no recorded track; a point has no time; or a place,
        height, speed or distance is not a number.
    """
    points = _read_points(text, name)
    moments, numbers = [], []
    for place, point in enumerate(points, start=1):
        absent, texts = None if point.needs_place else "nan", point.texts
        time = moment(texts.get("time", "").upper())
        if time is None:
            allowed = Message("a time such as 2022-12-27T15:51:14Z in every point, unlike in a drawn route")
            value = texts.get("time") or None
            raise track_error("not_a_time", name, allowed, place=f"point {place}", column="time", value=value)
        moments.append(time.replace(tzinfo=UTC))  # a time without a zone is in UTC, as the format defines
        # speed of GPX 1.0, or of the first element called speed in the point's extensions
        cells = {
            ("lat", "degrees"): texts.get("lat", absent),
            ("lon", "degrees"): texts.get("lon", absent),
            ("ele", "m"): texts.get("ele") or "nan",
            ("speed", "m/s"): texts.get("speed") or texts.get("extended speed") or "nan",
            ("distance", "m"): texts.get("distance") or "nan",
        }
        numbers.append([_number(cell, name, place, *column) for column, cell in cells.items()])
    table = np.array(numbers, dtype=float).reshape(-1, 5)
    return Recording(
        name=name,
        places_in_file=[f"point {place + 1}" for place in range(len(points))],
        time=np.array([(time - moments[0]).total_seconds() for time in moments]),
        place=table[:, :3],
        start=moments[0] if moments else None,
        speed=table[:, 3],
        speed_kind="as the device gives it",
        odometer=None if np.isnan(table[:, 4]).all() else table[:, 4],
        fix=np.array([point.texts.get("fix") != "none" for point in points], dtype=bool),
        heights="above mean sea level, as recorded",
        segment=np.array([point.segment for point in points], dtype=np.int64),
        not_finite=np.array([any(is_not_finite(point.texts.get(key, "")) for key in _NUMBERS) for point in points]),
    )


def _read_points(text: str, name: str) -> list[_Point]:
    """Points of a GPX or TCX file; rejects damaged XML, and files with only waypoints, routes or courses."""
    reader, parser = _Reader(name), expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = reader.start, reader.end
    parser.CharacterDataHandler, parser.EntityDeclHandler = reader.text, reader.entity
    try:
        parser.Parse(text.lstrip(), True)
    except expat.ExpatError as error:
        raise track_error("unreadable_file", name, Message("GPX 1.0, GPX 1.1 or TCX"), value=str(error)) from error
    if not reader.points and (reader.others or reader.root not in (_POINT[0], _TCX_POINT[0])):
        counted = ", ".join(f"{count} {element}" for element, count in reader.others.items())
        path = " > ".join(_TCX_POINT if reader.root == _TCX_POINT[0] else _POINT)
        allowed = Message("{path}", path=path)
        action = Message("The file has no recorded track. Waypoints, routes and courses are not read.")
        raise track_error("unreadable_file", name, allowed, action, value=counted or f"<{reader.root}>")
    return reader.points


def _number(text: str | None, name: str, place: int, column: str, unit: str) -> float:
    """Number in a text; NaN for `nan` and `inf`, which are flagged; FieldDataError if it is not a number."""
    value = math.nan if text is None else number(text)
    if math.isnan(value) and (text is None or not is_not_finite(text)):
        allowed = Message("a finite number in {unit}", unit=unit)
        raise track_error("not_a_number", name, allowed, place=f"point {place}", column=column, value=text)
    return value
