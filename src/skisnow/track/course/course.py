"""A course: gates in the order in which they are passed."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Final, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError, require_choice
from ..._support.messages import Message
from ..._support.units import Facts, Shown, ShownFields, amount
from ...parameters import Allowed, Label, Quantity, Word, require_declared

CourseAxes: TypeAlias = Literal["metres", "east_north_up"]

FEWEST_GATES: Final = 2
FARTHEST: Final = 1e8
"""Largest coordinate (m) of a gate in any map system."""
AGAINST: Final = -0.5
"""Cosine of the angle between the directions of a gate and of the course below which its side is wrong."""


class GateLine(NamedTuple):
    """Line of a gate: turning pole (m), unit vectors down the course and towards the passed side, width (m)."""

    pole: FloatArray
    along: FloatArray
    across: FloatArray
    width: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Course(Shown):
    """Gates in their order.

    Attributes
    ----------
    gates
        At least two gates.
    source
        Name of the course or of its file.
    latitude_deg, longitude_deg, fall_line_azimuth_deg
        Place of the scenario's x = y = 0 and direction of its x, for gates in degrees.
    axes
        "metres": those of the file or a scenario; "east_north_up": from `latitude_deg` and `longitude_deg`.

    Raises
    ------
    ParameterError
        There are fewer than two gates, two neighbours have the same place, two have the same name, or a gate's outer
        pole is on the wrong side.

    See Also
    --------
    skisnow.read_course
    skisnow.time_gates
    """

    gates: tuple[Gate, ...]
    source: Annotated[
        str,
        Word(
            "course.name",
            "a course of the catalogue",
            word_of=lambda source: source if source in course_names() else None,
        ),
        Word(
            "course.file",
            "gates: CSV with gate, x_m, y_m, side and, where it is known, outer_x_m, outer_y_m; or GPX with a waypoint "
            "for each",
            word_of=lambda source: None if source in course_names() else source,
            names_file=True,
        ),
    ] = Message("given as numbers")
    latitude_deg: Annotated[
        float | None,
        Quantity(
            "course.latitude_deg", "latitude (WGS84) of x = y = 0, for a course in degrees; default: the first gate"
        ),
        Label(Message("latitude of the origin")),
        Allowed(-90.0, 90.0),
    ] = None
    longitude_deg: Annotated[
        float | None,
        Quantity("course.longitude_deg", "longitude (WGS84) of x = y = 0, for a course in degrees"),
        Label(Message("longitude of the origin")),
        Allowed(-180.0, 180.0),
    ] = None
    fall_line_azimuth_deg: Annotated[
        float | None,
        Quantity(
            "course.fall_line_azimuth_deg",
            "compass direction of x, for a course in degrees; such a course needs it in a scenario",
        ),
        Label(Message("direction of the fall line")),
        Allowed(-360.0, 360.0),
    ] = None
    axes: CourseAxes = "metres"

    def __post_init__(self) -> None:
        require_declared(self)
        require_choice("axes", self.axes, get_args(CourseAxes))
        if len(self.gates) < FEWEST_GATES:
            raise ParameterError(
                "a course needs {fewest} gates or more, it has {count}: its direction comes from them"
            ).tag("too_few_gates", fewest=FEWEST_GATES, count=len(self.gates))
        for before, gate in zip(self.gates, self.gates[1:], strict=False):
            if before.turning == gate.turning:
                raise ParameterError("the gates {first} and {second} are at one place; move one, or drop it").tag(
                    "same_place", first=before.name, second=gate.name
                )
        name, count = Counter(gate.name for gate in self.gates).most_common(1)[0]
        if count > 1:
            raise ParameterError("two gates are called {name!r}; give each a different name or number").tag(
                "repeated_name", name=name
            )
        for gate, line, along in zip(self.gates, self.lines, self._chords(), strict=True):
            if float(line.along @ along) < AGAINST:
                raise ParameterError(
                    "gate {name}: seen down the course the outer pole is not on the side of the turning pole that is "
                    'passed, "{side}". Change the side, or exchange the poles'
                ).tag("wrong_side", name=gate.name, side=gate.side)

    @property
    def lines(self) -> tuple[GateLine, ...]:
        """Line of each gate: from the turning pole to the outer one, else perpendicular to the course at the pole."""
        return tuple(_gate_line(gate, along) for gate, along in zip(self.gates, self._chords(), strict=True))

    def _chords(self) -> FloatArray:
        """Direction of the course at each gate (n, 2): from the pole before to the pole behind it."""
        place = np.array([gate.turning for gate in self.gates], dtype=float)
        chord = np.concatenate([place[1:2] - place[:1], place[2:] - place[:-2], place[-1:] - place[-2:-1]])
        size = np.linalg.norm(chord, axis=1)
        if not size.min() > 0.0:
            at = int(np.argmin(size))
            raise ParameterError("the gates before and behind {name} are at one place; move one").tag(
                "same_place", name=self.gates[at].name
            )
        return np.asarray(chord / size[:, None])

    @property
    def length(self) -> float:
        """Length from pole to pole (m)."""
        return float(np.linalg.norm(np.diff([gate.turning for gate in self.gates], axis=0), axis=1).sum())

    def _repr_facts(self) -> Facts:
        """Title with the number of gates, the length from pole to pole (m), and the source."""
        return Facts(f"{len(self.gates)} gates, {amount(self.length, 'm')} from pole to pole: {self.source}")


def _gate_line(gate: Gate, along: FloatArray) -> GateLine:
    """Line of a gate from its turning pole: to the outer pole, or without one perpendicular to `along`."""
    turn = 1.0 if gate.side == "left" else -1.0
    pole = np.array(gate.turning)
    if gate.outer is None:
        return GateLine(pole, along, turn * np.array([-along[1], along[0]]), gate.width)
    across = (np.array(gate.outer) - pole) / gate.width
    return GateLine(pole, turn * np.array([across[1], -across[0]]), across, gate.width)


_FOLDER: Final = files(__package__) / "catalogue"


def course_names() -> tuple[str, ...]:
    """Names of the courses that come with skisnow.

    Returns
    -------
    tuple of str
        Names that `skisnow.read_course` accepts instead of a path.

    See Also
    --------
    skisnow.read_course

    References
    ----------
    The page docs/files/scenario.md.

    Examples
    --------
    >>> course_names()
    ('giant-slalom-20-gates', 'slalom-20-gates', 'wide-slalom-20-gates')
    """
    return tuple(sorted(entry.name.removesuffix(".csv") for entry in _FOLDER.iterdir() if entry.name.endswith(".csv")))


def course_place(name: str) -> Path:
    """Path of the CSV file of a built-in course; it need not exist."""
    return Path(str(_FOLDER / f"{name}.csv"))


Side: TypeAlias = Literal["left", "right"]
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Gate(ShownFields):
    """One gate of a course, seen from above.

    Attributes
    ----------
    name
        Name in the file, such as its number.
    turning
        Place x, y (m) of the turning pole; for a panel, its pole on the racer's side.
    side
        Side of the turning pole on which it is passed, seen down the course.
    outer
        Place (m) of the outer pole; None for a single pole: the gate is as wide as the slope.

    Raises
    ------
    ParameterError
        A place is not finite, both poles have the same place, or the side is unknown.

    See Also
    --------
    skisnow.Course
    skisnow.read_course
    """

    name: str
    turning: Point
    side: Side
    outer: Point | None = None

    def __post_init__(self) -> None:
        require_choice(f"gate {self.name}: side", self.side, get_args(Side))
        for place in (self.turning, self.outer):
            if place is not None and not all(abs(coordinate) <= FARTHEST for coordinate in place):
                raise ParameterError(
                    "gate {name} is at {place}. Allowed: coordinates of finite numbers, at most {farthest:g} m. "
                    "Correct them, or their unit"
                ).tag("not_a_number", name=self.name, place=place, farthest=FARTHEST)
        if self.outer is not None and not self.width > 0.0:
            raise ParameterError("gate {name}: both poles are at {turning}; move one, or remove the outer pole").tag(
                "same_place", name=self.name, turning=self.turning
            )

    @property
    def width(self) -> float:
        """Distance between the poles (m); infinite without an outer pole."""
        return math.inf if self.outer is None else math.dist(self.turning, self.outer)
