"""A line through gates, by numbers of each turn: offsets aside and along the course, length, and wanted speed."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from itertools import islice, pairwise
from pathlib import Path
from typing import Final

from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.spreadsheet_text import csv_rows, csv_text
from .._support.staging import write_file
from .._support.units import Facts, Shown, ShownFields, amount
from ..scenario import Scenario, Skier
from ..skier import BalancedSkier
from ..track.course import Course

LEAST_TURNING: Final = 0.2
"""Least share of the way over which a turn may last: below, its curvature grows beyond any ski's."""
COLUMNS: Final = (
    "gate", "aside_m", "along", "turning", "speed", "apex_x_m", "apex_y_m", "edging_from_x_m", "edging_to_x_m",
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class LineTurn(ShownFields):
    """The turn at one gate.

    aside: Distance of the apex from the turning pole, to the side that is passed (m).
    along: Distance of the apex from the pole down the course, divided by that to the nearer neighbouring gate; above 0:
        the apex is below the pole.
    turning: Share of half the way to the apexes before and behind over which the edges turn, 0.2 to 1: edging starts so
        far before the apex and ends so far behind it; the rest is straight. 1: half waves.
    speed: Speed to which a skier in skidded turns brakes before the apex, divided by `brakes_to` of the scenario.
    """

    aside: float
    along: float = 0.0
    turning: float = 1.0
    speed: float = 1.0


NUMBERS: Final = tuple(number.name for number in fields(LineTurn))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RacingLine(Shown):
    """Line of a racer: turns with straights between them, from apex to apex.

    course: Course whose gates follow each other down the slope, x rising.
    start: x, y (m) of the first point; x counts down the slope.
    turns: One turn for each gate.
    Raises ParameterError: the number of turns is not that of gates, a turn is too short, or the apexes do not follow
        each other down the slope.

    Notes
    -----
    Between two apexes the first turn ends at the share τ₁, and the next one begins at 1 - τ₂. The slope of the line
    there is P sin(πu/(2τ₁)), P between, P sin(π(1 - u)/(2τ₂)), where P follows from the apexes. With τ = ½ it is a half
    wave. The largest edge angle follows from the curvature at the apex, π P/(2τ L).

    References
    ----------
    The page docs/how-to/race.md.
    """

    course: Course
    start: tuple[float, float]
    turns: tuple[LineTurn, ...]
    _x: list[float] = field(init=False)
    _y: list[float] = field(init=False)
    _share: list[float] = field(init=False)

    def __post_init__(self) -> None:
        gates = self.course.gates
        if len(self.turns) != len(gates):
            raise ParameterError("the line has {n_turns} turns and the course {n_gates} gates; give one each").tag(
                "wrong_shape", n_turns=len(self.turns), n_gates=len(gates)
            )
        way = turn_lengths(self.course, self.start)
        x, y, share = [self.start[0]], [self.start[1]], [0.5]
        for gate, turn, reach in zip(gates, self.turns, way, strict=True):
            if not LEAST_TURNING <= turn.turning <= 1.0:
                raise ParameterError("gate {name}: turning is {turning:g}; it must be from 0.2 to 1").tag(
                    "out_of_range", name=gate.name, turning=turn.turning
                )
            if not 0.0 < turn.speed < math.inf:
                raise ParameterError("gate {name}: speed is {speed:g}; it must be above 0").tag(
                    "out_of_range", name=gate.name, speed=turn.speed
                )
            x.append(gate.turning[0] + turn.along * reach)
            y.append(gate.turning[1] + (turn.aside if gate.side == "left" else -turn.aside))
            share.append(0.5 * turn.turning)
        for i, gate in enumerate(gates):
            if not x[i + 1] > x[i]:
                raise ParameterError(
                    "gate {name}: its apex at x = {x:g} m does not lie below the one before, {before:g} m; a line "
                    "goes down the slope"
                ).tag("out_of_range", name=gate.name, x=x[i + 1], before=x[i])
        for name, values in (("_x", x), ("_y", y), ("_share", share)):
            object.__setattr__(self, name, values)

    @property
    def apexes(self) -> list[tuple[float, float]]:
        """Start and apexes, x and y (m)."""
        return list(zip(self._x, self._y, strict=True))

    @property
    def breaks(self) -> list[float]:
        """Places down the slope (m), rising, between which the line is smooth."""
        places = []
        for i in range(len(self._x) - 1):
            way = self._x[i + 1] - self._x[i]
            places += [self._x[i], self._x[i] + self._share[i] * way, self._x[i + 1] - self._share[i + 1] * way]
        return [*places, self._x[-1]]

    def at(self, x: float) -> tuple[float, float, float]:
        """Place aside (m), slope and second derivative (1/m) of the line at a place down the slope (m)."""
        i = bisect_right(self._x, x) - 1
        if i < 0 or i >= len(self._x) - 1:
            return self._y[max(i, 0)], 0.0, 0.0
        way, rise = self._x[i + 1] - self._x[i], self._y[i + 1] - self._y[i]
        first, last = self._share[i], self._share[i + 1]
        steepest = rise / way / (1.0 - (1.0 - 2.0 / math.pi) * (first + last))
        u = (x - self._x[i]) / way
        if u < first:
            aside, slope, bend = _turn_shape(u, first, steepest, way)
            return self._y[i] + aside, slope, bend
        if u > 1.0 - last:
            aside, slope, bend = _turn_shape(1.0 - u, last, steepest, way)
            return self._y[i + 1] - aside, slope, -bend
        return self._y[i] + way * steepest * (2.0 * first / math.pi + u - first), steepest, 0.0

    def speed_at(self, x: float) -> float:
        """Speed ratio, `LineTurn.speed`, of the turn whose apex is the next after x (m) down the slope."""
        return self.turns[min(bisect_right(self._x, x, lo=1), len(self.turns)) - 1].speed

    def greatest_curvature(self) -> float:
        """Largest curvature at any apex (1/m)."""
        return max(abs(self.at(x + side * 1e-9)[2]) for x in self._x for side in (-1.0, 1.0))

    def _repr_facts(self) -> Facts:
        """Number of turns as title, and rows with the ranges of aside, along (m) and turning."""
        aside, along, turning = zip(*((turn.aside, turn.along, turn.turning) for turn in self.turns), strict=True)
        rows = (
            ("aside", f"{amount(min(aside), 'm')} to {amount(max(aside), 'm')}"),
            ("along", f"{amount(min(along))} to {amount(max(along))}"),
            ("turning", f"{amount(min(turning))} to {amount(max(turning))}"),
        )
        return Facts(f"{len(self.turns)} turns", rows)


def _turn_shape(u: float, share: float, steepest: float, way: float) -> tuple[float, float, float]:
    """Sideways place (m), slope dy/dx and second derivative (1/m) of half a turn, at the share u of the way (m).

    The turn begins at the apex, u = 0, and ends at u = `share`, with the slope `steepest`.
    """
    rate = math.pi / (2.0 * share)
    sine, cosine = math.sin(rate * u), math.cos(rate * u)
    return way * steepest / rate * (1.0 - cosine), steepest * sine, steepest * rate / way * cosine


def turn_lengths(course: Course, start: tuple[float, float]) -> list[float]:
    """Distance (m) down the slope from each gate to its nearer neighbour; the start counts as a neighbour."""
    x = [start[0], *(gate.turning[0] for gate in course.gates)]
    before = [b - a for a, b in pairwise(x)]
    return [min(pair) for pair in zip(before, [*before[1:], math.inf], strict=True)]


def course_of(scenario: Scenario) -> Course:
    """Course of a scenario; ParameterError without one."""
    if scenario.course is None:
        raise ParameterError("the scenario has no course; a race needs one: [course] name = or file =").tag("no_data")
    return scenario.course


def skier_of(scenario: Scenario) -> Skier:
    """Skier of a scenario; ParameterError without one."""
    if scenario.skier is None:
        raise ParameterError('the scenario has no skier; a race needs one: [skier] steers = "gates"').tag("no_data")
    return scenario.skier


def follower_line(scenario: Scenario) -> RacingLine:
    """Line that a scenario's skier takes without a search: half waves that pass the poles at the skier's clearance."""
    course, start = course_of(scenario), (scenario.start.x, scenario.start.y)
    apexes = BalancedSkier(scenario).apexes(course)[1:]
    asides = [abs(y - gate.turning[1]) for (_, y), gate in zip(apexes, course.gates, strict=True)]
    return RacingLine(course, start, tuple(LineTurn(aside=aside) for aside in asides))


def with_numbers(line: RacingLine, numbers: Sequence[Sequence[float]], first: int) -> RacingLine:
    """Copy of a line with new numbers of the turns from gate `first` (from 0) on: one row per turn, as `LineTurn`."""
    new = [
        replace(turn, **dict(zip(NUMBERS, row, strict=False)))
        for turn, row in zip(line.turns[first:], numbers, strict=False)
    ]
    turns = (*line.turns[:first], *new, *line.turns[first + len(new) :])
    return RacingLine(line.course, line.start, turns)


def first_gates(line: RacingLine, gates: int) -> RacingLine:
    """Line with only the first `gates` gates of its course and their turns."""
    return RacingLine(replace(line.course, gates=line.course.gates[:gates]), line.start, line.turns[:gates])


def write_line(line: RacingLine, path: Path) -> None:
    """Write a line as CSV, one row for each gate.

    Raises OutputError: the place cannot be written.
    """
    rows, breaks = [], line.breaks
    for i, (gate, turn) in enumerate(zip(line.course.gates, line.turns, strict=True)):
        x, y = line.apexes[i + 1]
        begins = breaks[3 * i + 2]
        ends = breaks[3 * i + 4] if 3 * i + 4 < len(breaks) else x
        numbers = [repr(getattr(turn, name)) for name in NUMBERS]
        rows.append([gate.name, *numbers, *(f"{number:.6g}" for number in (x, y, begins, ends))])
    write_file(path, csv_text([COLUMNS, *rows]))


def read_line(path: Path, course: Course, start: tuple[float, float]) -> RacingLine:
    """Read a line that `write_line` wrote, for the first gates of a course.

    path: CSV with gate, aside_m, along, turning, speed; other columns are not read.
    course: Course that begins with these gates, in this order.
    start: x, y (m) of the line's first point.
    Raises ParameterError: it cannot be read, a column is missing, a cell is not a number, or its gates are not the
        course's.
    """
    most = len(course.gates)
    table = csv_rows(path, COLUMNS[: 1 + len(NUMBERS)], action=Message("Write the line with `skisnow race` again."))
    rows = list(islice(table, most + 1))
    if not 0 < len(rows) <= most:
        raise ParameterError("{path}: it has no rows or too many. Allowed: 1 to {n_gates}, a row for each gate").tag(
            "out_of_range", path=path, n_gates=most
        )
    for row, gate in zip(rows, course.gates, strict=False):
        if row.cells["gate"] != gate.name:
            raise row.refused(
                "gate", Message("The course has the gate {gate!r} there.", gate=gate.name), code="another_gate"
            )
    turns = tuple(
        LineTurn(**{name: row.number(column) for name, column in zip(NUMBERS, COLUMNS[1:], strict=False)})
        for row in rows
    )
    return RacingLine(replace(course, gates=course.gates[: len(turns)]), start, turns)
