"""A course: gates in the order in which they are passed."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Final, Literal, NamedTuple, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from ..._support.display import Facts, Shown, ShownFields, amount
from ..._support.errors import ParameterError
from ..._support.nearest import require_choice
from ...parameters import Quantity, Word, require_declared

FloatArray: TypeAlias = npt.NDArray[np.float64]
Discipline: TypeAlias = Literal["slalom", "giant-slalom"]
CourseAxes: TypeAlias = Literal["metres", "east_north_up"]

FEWEST_GATES: Final = 2
FARTHEST: Final = 1e8
"""Coordinate (m) beyond which no gate stands, in any map system."""
"""The direction of a course comes from its gates."""
AGAINST: Final = -0.5
"""Cosine of the angle between a gate's own direction and the course's, below which its side is the wrong one."""


class GateLine(NamedTuple):
    """Of a gate: its turning pole (m), unit vectors down the course and to the side that is passed, its width (m)."""

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
        Two or more.
    source
        Where they come from, in words.
    discipline
        Whose rules are looked at; None: no rules.
    latitude_deg, longitude_deg, fall_line_azimuth_deg
        Where a scenario's x = y = 0 lies and where its x points, for gates in degrees.
    axes
        "metres": the file's own, or a scenario's; "east_north_up": from `latitude_deg` and `longitude_deg`.
    warnings
        What the reader had to assume, in words.

    Raises
    ------
    ParameterError
        There are fewer than two gates, two neighbours stand at one place, two have one name, or a gate's outer pole
        stands on the other side than the one that is passed.

    See Also
    --------
    skisnow.read_course
    skisnow.time_gates
    """

    gates: tuple[Gate, ...]
    source: Annotated[
        str,
        Word("course.name", "a course of the catalogue", word_of=name_in_catalogue),
        Word(
            "course.file",
            "gates: CSV with gate, x_m, y_m, side and, where it is known, outer_x_m, outer_y_m; or GPX with a waypoint "
            "for each",
            word_of=file_of_course,
            names_file=True,
        ),
    ] = "given as numbers"
    discipline: Annotated[
        Discipline | None,
        Quantity(
            "course.discipline", "whose rules the course is checked against; left out: no rules", label="discipline"
        ),
    ] = None
    latitude_deg: Annotated[
        float | None,
        Quantity(
            "course.latitude_deg",
            "latitude (WGS84) of x = y = 0, for a course in degrees; left out: the first gate",
            label="latitude of the origin",
            lowest=-90.0,
            highest=90.0,
        ),
    ] = None
    longitude_deg: Annotated[
        float | None,
        Quantity(
            "course.longitude_deg",
            "longitude (WGS84) of x = y = 0, for a course in degrees",
            label="longitude of the origin",
            lowest=-180.0,
            highest=180.0,
        ),
    ] = None
    fall_line_azimuth_deg: Annotated[
        float | None,
        Quantity(
            "course.fall_line_azimuth_deg",
            "compass direction of x, for a course in degrees; such a course needs it in a scenario",
            label="direction of the fall line",
            lowest=-360.0,
            highest=360.0,
        ),
    ] = None
    axes: CourseAxes = "metres"
    warnings: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        require_declared(self)
        require_choice("axes", self.axes, get_args(CourseAxes))
        if len(self.gates) < FEWEST_GATES:
            raise ParameterError(
                f"a course needs {FEWEST_GATES} gates or more, it has {len(self.gates)}: its direction comes from them"
            )
        for before, gate in zip(self.gates, self.gates[1:], strict=False):
            if before.turning == gate.turning:
                raise ParameterError(
                    f"the gates {before.name} and {gate.name} stand at one place; move one, or drop it"
                )
        name, count = Counter(gate.name for gate in self.gates).most_common(1)[0]
        if count > 1:
            raise ParameterError(f"two gates are called {name!r}; give each a name or number of its own")
        for gate in self.gates:
            if not max(map(abs, (*gate.turning, *(gate.outer or ())))) <= FARTHEST:
                raise ParameterError(
                    f"gate {gate.name} stands at {gate.turning}. Allowed: coordinates of finite numbers, at most "
                    f"{FARTHEST:g} m. Correct them, or their unit"
                )
        for gate, line, along in zip(self.gates, self.lines, self._chords(), strict=True):
            if float(line.along @ along) < AGAINST:
                other = "right" if gate.side == "left" else "left"
                raise ParameterError(
                    f"gate {gate.name}: seen down the course the outer pole stands to the {other} of the turning pole, "
                    f'and side is "{gate.side}". Change the side, or exchange the poles'
                )

    @property
    def lines(self) -> tuple[GateLine, ...]:
        """The line of each gate: from the turning pole to the outer one, else square to the course at the pole."""
        return tuple(_line(gate, along) for gate, along in zip(self.gates, self._chords(), strict=True))

    def _chords(self) -> FloatArray:
        """Direction of the course at each gate (n, 2): from the pole before to the pole behind it."""
        place = np.array([gate.turning for gate in self.gates], dtype=float)
        chord = np.concatenate([place[1:2] - place[:1], place[2:] - place[:-2], place[-1:] - place[-2:-1]])
        size = np.linalg.norm(chord, axis=1)
        if not size.min() > 0.0:
            at = int(np.argmin(size))
            raise ParameterError(f"the gates before and behind {self.gates[at].name} stand at one place; move one")
        return np.asarray(chord / size[:, None])

    @property
    def length(self) -> float:
        """From pole to pole (m)."""
        return float(np.linalg.norm(np.diff([gate.turning for gate in self.gates], axis=0), axis=1).sum())

    def _facts(self) -> Facts:
        kind = f"{self.discipline}, " if self.discipline else ""
        return Facts(f"{kind}{len(self.gates)} gates, {amount(self.length, 'm')} from pole to pole: {self.source}")


def _line(gate: Gate, along: FloatArray) -> GateLine:
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
        What `skisnow.read_course` takes beside a path.

    See Also
    --------
    skisnow.read_course

    References
    ----------
    The page docs/files/course.md.

    Examples
    --------
    >>> course_names()
    ('giant-slalom-20-gates', 'slalom-20-gates')
    """
    return tuple(sorted(entry.name.removesuffix(".csv") for entry in _FOLDER.iterdir() if entry.name.endswith(".csv")))


def course_place(name: str) -> Path:
    """Where such a course lies."""
    return Path(str(_FOLDER / f"{name}.csv"))


def name_in_catalogue(source: str) -> str | None:
    """The source of a course, if it is one of these."""
    return source if source in course_names() else None


def file_of_course(source: str) -> str | None:
    """The source of a course, if it is none of these."""
    return None if source in course_names() else source


Side: TypeAlias = Literal["left", "right"]
Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Gate(ShownFields):
    """One gate of a course, seen from above.

    Attributes
    ----------
    name
        As the file has it, such as its number.
    turning
        Place x, y (m) of the turning pole: of a panel the pole beside which the racer goes by.
    side
        On which side of the turning pole it is passed, seen down the course.
    outer
        Place (m) of the outer pole; None: there is none, and the gate is as wide as the slope.

    Raises
    ------
    ParameterError
        A place is not finite, both poles stand at one place, or the side is no side.

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
        for pole, place in (("turning", self.turning), ("outer", self.outer)):
            if place is not None and not all(math.isfinite(coordinate) for coordinate in place):
                raise ParameterError(f"gate {self.name}: the {pole} pole stands at {place}; both must be finite, in m")
        if self.outer is not None and not self.width > 0.0:
            raise ParameterError(
                f"gate {self.name}: both poles stand at {self.turning}; move one, or leave the outer out"
            )

    @property
    def width(self) -> float:
        """Between the poles (m); infinite without an outer pole."""
        return math.inf if self.outer is None else math.dist(self.turning, self.outer)
