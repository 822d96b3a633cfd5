"""A point with mass on a line, with exact solutions, and the racers that worker processes take along."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, astuple, dataclass, fields, replace
from itertools import pairwise
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from ..scenario import Plane, Scenario
from ..simulation.run import Run
from ..simulation.run_summary import run_gates
from ..simulation.simulated_run import Progress, simulate
from ..skier import BalancedSkier
from ..skier.control import SkidControl
from ..skier.plan import Line
from ..skier.seen import Moment
from ..track.course import CourseResult, MovingPoint, passages
from .line import NUMBERS, LineTurn, RacingLine, skier_of
from .score import NOT_PASSED, Score, score_of, with_room

STEP: Final = 0.5
"""Largest step down the slope (m): see the tests of convergence."""
BEHIND: Final = 1.0
"""Way (m) behind the last apex that is computed, so that the last gate is crossed."""
SLOWEST: Final = 1e-3
"""Speed (m/s) below which it has stopped."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PointRacer:
    """Model of a racer: a point with mass that stays exactly on its line.

    slope_angle: Inclination of the plane (rad).
    mass: Mass of the racer with skis (kg).
    friction, friction_by_speed: μ = friction + friction_by_speed · v (s/m), of the load on the base.
    drag: ρ c A/2 (kg/m).
    speed: Speed at the start (m/s).
    least_radius: Smallest radius (m) that can be skied; 0: any.
    half_width: Half of the racer's width (m): both sides have to pass a gate.
    gravity: Acceleration of gravity (m/s²).

    Notes
    -----
    v dv/ds = g sin α cos χ - μ √((g cos α)² + a²) - ρ c A v²/(2 m), where a = κ v² + g sin α sin χ is the side force of
    the snow per mass: the base bears the load of a carve in balance. Fourth-order Runge–Kutta method.
    """

    slope_angle: float
    mass: float
    friction: float
    drag: float
    speed: float
    friction_by_speed: float = 0.0
    least_radius: float = 0.0
    half_width: float = 0.0
    gravity: float = 9.81

    @classmethod
    def of(cls, scenario: Scenario) -> PointRacer:
        """Racer from a scenario; the smallest radius is that of its ski at the skier's largest edge angle.

        Raises ParameterError: the slope is not a plane, or the scenario has no skier.
        """
        if not isinstance(scenario.slope, Plane):
            raise ParameterError("a point races on a plane; the scenario has a profile or a grid. Use the skier").tag(
                "not_supported"
            )
        ski, air, contact = scenario.ski, scenario.air, scenario.contact
        contact.require_linear_friction()
        return cls(
            slope_angle=scenario.slope.angle,
            mass=scenario.sledge.mass + 2.0 * ski.mass,
            friction=contact.friction,
            friction_by_speed=contact.friction_by_speed,
            drag=0.5 * air.density * air.drag_area,
            speed=scenario.start.speed,
            least_radius=ski.sidecut_radius_of_edge_line * math.cos(skier_of(scenario).greatest_edge),
            half_width=0.5 * (scenario.sledge.stance_width + ski.waist_width),
            gravity=scenario.gravity,
        )

    def rates(self, line: Line, x: float, square: float) -> tuple[float, float]:
        """Rates of v² (m/s²) and of the time (s/m) per metre down the slope, at a place x (m) with v² (m²/s²)."""
        _, slope, bend = line.at(x)
        long = math.sqrt(1.0 + slope * slope)
        cosine, sine = 1.0 / long, slope / long
        down = self.gravity * math.sin(self.slope_angle)
        speed = math.sqrt(max(square, SLOWEST**2))
        aside = bend * cosine**3 * square + down * sine
        load = math.hypot(self.gravity * math.cos(self.slope_angle), aside)
        friction = (self.friction + self.friction_by_speed * speed) * load
        return 2.0 * long * (down * cosine - friction - self.drag / self.mass * square), long / speed

    def motion(self, line: Line, breaks: Sequence[float]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Places down the slope (m), v² (m²/s²) and times (s) of a run, in steps between breaks; it ends at a stop."""
        x, square, time = breaks[0], self.speed**2, 0.0
        rows = [(x, square, time)]
        for low, high in pairwise(breaks):
            count = math.ceil((high - low) / STEP - 1e-9)
            for i in range(count):
                x, step = low + i * (high - low) / count, (high - low) / count
                square, time = self._runge_kutta_step(line, x, square, time, step)
                if not square > SLOWEST**2:
                    return _as_columns(rows)
                rows.append((x + step, square, time))
        return _as_columns(rows)

    def _runge_kutta_step(self, line: Line, x: float, square: float, time: float, step: float) -> tuple[float, float]:
        """Squared speed and time after one fourth-order Runge-Kutta step in x from their values before."""
        inside = 1e-9 * step  # a line bends differently before and behind a break
        a, first = self.rates(line, x + inside, square)
        b, second = self.rates(line, x + 0.5 * step, square + 0.5 * step * a)
        c, third = self.rates(line, x + 0.5 * step, square + 0.5 * step * b)
        d, fourth = self.rates(line, x + step - inside, square + step * c)
        return (
            square + step / 6.0 * (a + 2.0 * b + 2.0 * c + d),
            time + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth),
        )

    def race(self, line: RacingLine) -> tuple[CourseResult | None, tuple[float, float]]:
        """Passages of the gates, None if the racer stops at once; and x and y (m) of the end of the run."""
        last = max(line.breaks[-1], line.course.gates[-1].turning[0])
        x, square, time = self.motion(line, [*line.breaks, last + BEHIND])
        if len(x) < 2:
            return None, line.start
        y, slope = np.array([line.at(float(place_x))[:2] for place_x in x]).T
        ahead = np.stack([np.ones_like(slope), slope], axis=1) / np.sqrt(1.0 + slope**2)[:, None]
        place, velocity = np.stack([x, y], axis=1), np.sqrt(square)[:, None] * ahead
        left = self.half_width * np.stack([-ahead[:, 1], ahead[:, 0]], axis=1)
        sides = {name: MovingPoint(time, place + sign * left) for name, sign in (("left", 1.0), ("right", -1.0))}
        return passages(line.course, MovingPoint(time, place, velocity), sides), (float(x[-1]), float(y[-1]))

    def score(self, line: RacingLine) -> Score:
        """Score of a line; a line with a radius below `least_radius` fails."""
        result, end = self.race(line)
        own_score = score_of(result, end, finished=True, words="finished")
        tight = self.least_radius * line.greatest_curvature() - 1.0
        own_score = replace(own_score, margins=(*own_score.margins, -tight))
        if tight > 0.0:
            failed = NOT_PASSED if own_score.time is not None else own_score.value
            return replace(own_score, value=failed + tight, time=None, words="the line is too tight")
        return own_score


def _as_columns(rows: list[tuple[float, float, float]]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, squared speed and time, each of shape (n,), from rows of the three."""
    x, square, time = np.array(rows).T
    return x, square, time


RacerModel: TypeAlias = Literal["skier", "point"]


class LineSkier:
    """Motion of the boots for `simulate`, of a balanced skier that steers along a racing line.

    scenario: scenario with a skier.
    line: line through the scenario's course.
    """

    def __init__(self, scenario: Scenario, line: RacingLine) -> None:
        self.skier, self.line = BalancedSkier(scenario), line
        self.skier.controller = self.skier.follow(line, line.apexes)

    @property
    def period(self) -> float:
        """Time from one call of this object by the simulation to the next (s)."""
        return self.skier.period

    def __call__(self, moment: Moment) -> Any:
        """Target positions of the boots at the end of a time step of the simulation."""
        control, usual = self.skier.controller, self.skier.skier
        if isinstance(control, SkidControl):
            control.skier = replace(usual, brakes_to=usual.brakes_to * self.line.speed_at(float(moment.position[0])))
        return self.skier(moment)


def ski_line(scenario: Scenario, line: RacingLine, *, progress: Progress | None = None) -> Run:
    """Simulate a scenario's skier on a racing line; returns the run, with the line's gates as its course.

    scenario: with a skier; its course is ignored.
    """
    through = replace(scenario, course=line.course)
    return simulate(through, boots=LineSkier(through, line), progress=progress)


def run_score(run: Run) -> Score:
    """Score of a run. Raises KeyboardInterrupt: the run was interrupted."""
    if run.outcome == "interrupted":
        raise KeyboardInterrupt
    end = float(run.place[-1, 0]), float(run.place[-1, 1])
    words = run.outcome.replace("_", " ")
    return score_of(run_gates(run), end, finished=run.outcome in ("finished", "straddled", "missed_gate"), words=words)


@dataclass(frozen=True, slots=True)
class LinePoint:
    """Input of a worker: a line, and the place in the unit cube of the search from which its numbers follow."""

    line: RacingLine
    place: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Racer:
    """Callable for worker processes that races a `LinePoint` and returns the row of its result.

    scenario: scenario with course and skier.
    model: "skier": a whole simulated run; "point": a mass on the line.
    room: distance (m) from each pole, below which a gate counts as not passed.
    """

    scenario: Scenario
    model: RacerModel
    room: float = 0.0

    def score(self, line: RacingLine) -> Score:
        """Score of a race on a line by the chosen model, with the room that each pole must have."""
        if self.model == "point":
            raced = PointRacer.of(self.scenario).score(line)
        else:
            raced = run_score(ski_line(self.scenario, line))
        return with_room(raced, self.room)

    def __call__(self, point: LinePoint) -> dict[str, Any]:
        """Row of a point: the fields of its score, its place, and the numbers of all turns."""
        score = asdict(self.score(point.line))
        return {"place": list(point.place), **score, "turns": [list(astuple(turn)) for turn in point.line.turns]}


def score_in(row: dict[str, Any]) -> Score:
    """Score in a row that a `Racer` returned."""
    values = {field.name: row[field.name] for field in fields(Score)}
    gates = tuple((outcome, time) for outcome, time in row["gates"])
    return Score(**values | {"gates": gates, "margins": tuple(row["margins"])})


def turns_in(row: dict[str, Any]) -> tuple[LineTurn, ...]:
    """Turns of the raced line in a row that a `Racer` returned."""
    return tuple(LineTurn(**dict(zip(NUMBERS, numbers, strict=True))) for numbers in row["turns"])
