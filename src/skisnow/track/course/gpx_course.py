"""Waypoints of a GPX file, in their order."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, cast
from xml.parsers import expat

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.user_files import plain_text
from .course import Side

MOST_BYTES: Final = 1 << 24
DEEPEST: Final = 100
_POINT: Final = ("gpx", "wpt")
_SAYS: Final = ("type", "sym", "cmt", "desc", "name")
_SIDE: Final = re.compile(r"\b(left|right)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Waypoint:
    """A waypoint: number in the file, name, latitude and longitude (°, WGS84), height (m; NaN), passed side."""

    row: int
    name: str
    latitude_deg: float
    longitude_deg: float
    height: float
    side: Side | None


@dataclass(slots=True)
class _WaypointTexts:
    latitude: str | None
    longitude: str | None
    texts: dict[str, str] = field(default_factory=dict)


class _RefusedError(Exception):
    """The file has something that no course has."""


class _Reader:
    """Handler of the elements from expat that collects the waypoints."""

    def __init__(self) -> None:
        self.points: list[_WaypointTexts] = []
        self._path: list[str] = []
        self._text: list[str] = []

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        self._path.append(name.rsplit("}", 1)[-1])
        self._text = []
        if len(self._path) > DEEPEST:
            raise _RefusedError(
                Message("more than {deepest} elements within each other", deepest=DEEPEST),
            )
        if tuple(self._path) == _POINT:
            self.points.append(_WaypointTexts(attributes.get("lat"), attributes.get("lon")))

    def text(self, text: str) -> None:
        self._text.append(text)

    def end(self, _name: str) -> None:
        if tuple(self._path[:2]) == _POINT and len(self._path) == 3:
            self.points[-1].texts.setdefault(self._path[2], "".join(self._text).strip())
        self._text = []
        self._path.pop()

    def entity(self, name: str, *_rest: object) -> None:
        raise _RefusedError(Message("the declaration of an entity, {name}", name=name))


def read_waypoints(path: str | Path) -> list[Waypoint]:
    """Read the waypoints of a GPX file.

    Raises
    ------
    ParameterError
        The file cannot be read, is not GPX, or a waypoint has no place on the earth.
    """
    reader, parser = _Reader(), expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = reader.start, reader.end
    parser.CharacterDataHandler, parser.EntityDeclHandler = reader.text, reader.entity
    try:
        parser.Parse(plain_text(path, most_bytes=MOST_BYTES).lstrip(), True)
    except (_RefusedError, expat.ExpatError) as error:
        raise ParameterError(
            Message("{path} is not a readable GPX file ({error}); export it again", path=path, error=error),
            code="not_gpx",
        ) from error
    return [_waypoint(path, row, point) for row, point in enumerate(reader.points, start=1)]


def _waypoint(path: str | Path, row: int, point: _WaypointTexts) -> Waypoint:
    name = point.texts.get("name") or str(row)
    words = (_SIDE.search(point.texts.get(key, "")) for key in _SAYS)
    side = next((word[1].lower() for word in words if word), None)
    latitude = _number(path, row, "lat", point.latitude, 90.0)
    longitude = _number(path, row, "lon", point.longitude, 180.0)
    height = _number(path, row, "ele", point.texts.get("ele") or "nan", 1e5)
    return Waypoint(row, name, latitude, longitude, height, cast("Side | None", side))


def _number(path: str | Path, row: int, what: str, text: str | None, limit: float) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = math.inf
    if (math.isnan(value) and what == "ele") or abs(value) <= limit:
        return value
    raise ParameterError(
        Message(
            "{path}, waypoint {row}, {what}: {text!r} is not a number from {lowest:g} to {limit:g}; correct it",
            path=path,
            row=row,
            what=what,
            text=text,
            lowest=-limit,
            limit=limit,
        ),
        code="not_a_number",
    )
