"""Reader of courses (CSV in metres, GPX in degrees), and courses in the axes of a slope."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final, cast

import numpy as np

from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.spreadsheet_text import CsvRow, csv_rows
from ..._support.units import DEGREE
from ..._support.user_files.text_files import ContentError, plain_bytes
from ..._support.user_files.xml_elements import Element, xml_tree
from ..projection import GeodeticPoint, east_north_up
from ..slope_frame import slope_axes
from .course import Course, Gate, Side, course_names, course_place

_COLUMNS: Final = ("gate", "x_m", "y_m", "side")
_OUTER: Final = ("outer_x_m", "outer_y_m")
_ACTION: Final = Message(
    "Write one row for each gate, in their order, with its name, its turning pole in m and left or right, the side on "
    "which it is passed, under a first line gate,x_m,y_m,side."
)


def read_course(
    path: str | Path,
    *,
    latitude_deg: float | None = None,
    longitude_deg: float | None = None,
    fall_line_azimuth_deg: float | None = None,
) -> Course:
    """Read a course.

    Parameters
    ----------
    path
        A name of `course_names`, or the path of a file: CSV with the columns ``gate``, ``x_m``, ``y_m``, ``side``, and,
        if the outer poles are known, ``outer_x_m``, ``outer_y_m``; or GPX with one waypoint for each gate, in their
        order, whose type, symbol, comment, description or name contains left or right.
    latitude_deg, longitude_deg
        Origin of x and y for gates of a GPX file (default: its first waypoint).
    fall_line_azimuth_deg
        Compass direction in which the slope falls, for `on_slope`.

    Returns
    -------
    Course
        Course in the file's metres, or in metres east and north of the origin.

    Raises
    ------
    ParameterError
        The file cannot be read, or is not a course; file, row, column and value are named.

    See Also
    --------
    skisnow.time_gates : times at the gates.

    References
    ----------
    The page docs/files/scenario.md.
    """
    name = str(path)
    path = course_place(name) if name in course_names() else Path(path)
    options: dict[str, Any] = {"source": name, "fall_line_azimuth_deg": fall_line_azimuth_deg}
    if (latitude_deg is None) != (longitude_deg is None):
        raise ParameterError("{path}: latitude and longitude of the origin go together; give both, or neither").tag(
            "half_place", path=path
        )
    try:
        if path.suffix.lower() != ".gpx":
            rows = csv_rows(path, _COLUMNS, further=_OUTER, action=_ACTION)
            return Course(gates=tuple(map(_gate_of_row, rows)), **options)
        return _geodetic_course(read_waypoints(path), latitude_deg, longitude_deg, options)
    except ParameterError as error:
        raise error if str(error).startswith(str(path)) else error.at(path) from error


def _gate_of_row(row: CsvRow) -> Gate:
    """Gate of a table's row; rejects an unknown side, a missing name, and half an outer pole."""
    side = row.cells["side"].lower()
    if side not in ("left", "right"):
        problem = Message("Must be left or right, the side on which the turning pole is passed.")
        raise row.refused("side", problem, code="unknown_choice")
    if not row.cells["gate"]:
        problem, action = Message("This is not a name."), Message("Give each gate a number or a name.")
        raise row.refused("gate", problem, code="missing_name", action=action)
    outer_cells = [name for name in _OUTER if row.cells.get(name)]
    if len(outer_cells) == 1:
        problem = Message("The other coordinate of the outer pole is missing.")
        action = Message("Give both columns ({columns}), or neither.", columns=_OUTER)
        raise row.refused(outer_cells[0], problem, code="missing_column", action=action)
    outer = (row.number("outer_x_m"), row.number("outer_y_m")) if outer_cells else None
    place = (row.number("x_m"), row.number("y_m"))
    return Gate(name=row.cells["gate"], turning=place, side=cast("Side", side), outer=outer)


def _geodetic_course(
    waypoints: list[Waypoint], latitude_deg: float | None, longitude_deg: float | None, options: dict[str, Any]
) -> Course:
    """Course in metres east and north of an origin (default: the first waypoint); each waypoint must have a side."""
    if not waypoints:
        raise ParameterError("there is no waypoint; write one for each gate, in order").tag("no_waypoint")
    first = waypoints[0]
    latitude = first.latitude_deg if latitude_deg is None else latitude_deg
    longitude = first.longitude_deg if longitude_deg is None else longitude_deg
    height = 0.0 if np.isnan(first.height) else first.height
    points = np.array([(waypoint.latitude_deg, waypoint.longitude_deg, height) for waypoint in waypoints])
    place = east_north_up(points, origin=GeodeticPoint(latitude, longitude, height))[:, :2]
    gates = []
    for waypoint, (x, y) in zip(waypoints, place, strict=True):
        if waypoint.side is None:
            raise ParameterError("waypoint {row}, {name!r}, states no side. Write left or right into its type").tag(
                "no_side", row=waypoint.row, name=waypoint.name
            )
        gates.append(Gate(name=waypoint.name, turning=(float(x), float(y)), side=waypoint.side))
    return Course(
        gates=tuple(gates), axes="east_north_up", latitude_deg=latitude, longitude_deg=longitude, **options,
    )  # fmt: skip


def on_slope(course: Course, *, slope_angle: float | None) -> Course:
    """Convert a course to a scenario's x and y.

    course: A course in metres stays; one in east and north is rotated by its `fall_line_azimuth_deg`.
    slope_angle: Inclination of a plane slope (rad), whose x goes down the incline; None: x is horizontal.
    Raises ParameterError: the course is in degrees, and the direction of x is unknown.
    """
    if course.axes == "metres":
        return course
    if course.fall_line_azimuth_deg is None:
        raise ParameterError(
            "{source}: its gates are in degrees; give course.fall_line_azimuth_deg, the compass direction in which x "
            "points, and course.latitude_deg and course.longitude_deg of x = y = 0"
        ).tag("no_azimuth", source=course.source)
    angle = slope_angle or 0.0
    axes = slope_axes(course.fall_line_azimuth_deg * DEGREE, angle)

    def turned(point: tuple[float, float]) -> tuple[float, float]:
        up = -float(np.dot(axes[2, :2], point)) / float(axes[2, 2]) if angle else 0.0
        x, y, _ = axes @ np.array([*point, up])
        return float(x), float(y)

    gates = tuple(
        replace(gate, turning=turned(gate.turning), outer=None if gate.outer is None else turned(gate.outer))
        for gate in course.gates
    )
    return replace(course, gates=gates, axes="metres")


MOST_BYTES: Final = 1 << 24
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


def read_waypoints(path: str | Path) -> list[Waypoint]:
    """Read the waypoints of a GPX file.

    Raises ParameterError: the file cannot be read, is not GPX, or a waypoint has no place on the earth.
    """
    data = plain_bytes(path, most_bytes=MOST_BYTES)
    try:
        root = xml_tree(data.lstrip())
    except ContentError as error:
        raise ParameterError("{path} is not a readable GPX file ({error}); export it again").tag(
            "not_gpx", path=path, error=error
        ) from error
    points = root.named("wpt") if root.name == "gpx" else ()
    return [_read_waypoint(path, row, point) for row, point in enumerate(points, start=1)]


def _read_waypoint(path: str | Path, row: int, point: Element) -> Waypoint:
    """Waypoint from a GPX element; its side is the first "left" or "right" in its texts, None without one."""
    name = point.text_of("name") or str(row)
    words = (_SIDE.search(point.text_of(key)) for key in _SAYS)
    side = next((word[1].lower() for word in words if word), None)
    latitude = _waypoint_number(path, row, "lat", point.attributes.get("lat"), 90.0)
    longitude = _waypoint_number(path, row, "lon", point.attributes.get("lon"), 180.0)
    height = _waypoint_number(path, row, "ele", point.text_of("ele") or "nan", 1e5)
    return Waypoint(row, name, latitude, longitude, height, cast("Side | None", side))


def _waypoint_number(path: str | Path, row: int, what: str, text: str | None, limit: float) -> float:
    """Number in the value `what` of a waypoint; an error outside ±`limit`; only "ele" may be NaN."""
    try:
        value = float(text or "")
    except ValueError:
        value = math.inf
    if (math.isnan(value) and what == "ele") or abs(value) <= limit:
        return value
    raise ParameterError(
        "{path}, waypoint {row}, {what}: {text!r} is not a number from {lowest:g} to {limit:g}; correct it"
    ).tag("not_a_number", path=path, row=row, what=what, text=text, lowest=-limit, limit=limit)
