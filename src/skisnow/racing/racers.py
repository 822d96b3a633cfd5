"""Who races: a function from the numbers of a line to its score, which worker processes take along."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias

from ..scenario import Scenario
from ..simulation.run import Run
from ..simulation.run_gates import run_gates
from ..simulation.simulated_run import Progress, simulate
from ..skier import BalancedSkier
from ..skier.seen import Moment
from .line import LineTurn, RacingLine
from .point import PointRacer
from .score import Score, score_of, with_room

RacerModel: TypeAlias = Literal["skier", "point"]


class LineSkier:
    """Moves the boots of a run as a balanced skier that steers by a line.

    Parameters
    ----------
    scenario
        With a skier.
    line
        Through its course.
    """

    def __init__(self, scenario: Scenario, line: RacingLine) -> None:
        self.skier = BalancedSkier(scenario)
        self.skier.controller = self.skier.follow(line, line.apexes)

    @property
    def period(self) -> float:
        """Time from call to call (s)."""
        return self.skier.period

    def __call__(self, moment: Moment) -> Any:
        """Where the boots shall be at the moment's end."""
        return self.skier(moment)


def ski_line(scenario: Scenario, line: RacingLine, *, progress: Progress | None = None) -> Run:
    """The run of a scenario's skier on a line, through the line's gates.

    Parameters
    ----------
    scenario
        With a skier; its course is not asked.
    line
        Steered by.
    progress
        As of `skisnow.simulate`.
    """
    through = replace(scenario, course=line.course)
    return simulate(through, boots=LineSkier(through, line), progress=progress)


def run_score(run: Run) -> Score:
    """How good a run is; an interrupted one has no score.

    Raises
    ------
    KeyboardInterrupt
        The run was interrupted: it says nothing of its line.
    """
    if run.outcome == "interrupted":
        raise KeyboardInterrupt
    end = float(run.place[-1, 0]), float(run.place[-1, 1])
    words = run.outcome.replace("_", " ")
    return score_of(run_gates(run), end, finished=run.outcome in ("finished", "straddled", "missed_gate"), words=words)


@dataclass(frozen=True, slots=True)
class Racer:
    """Gives the score of a line's numbers, as a row.

    Attributes
    ----------
    scenario
        With course and skier.
    model
        "skier": a whole simulated run; "point": a mass on the line.
    room
        Distance (m) from each pole, below which a gate counts as not passed.
    """

    scenario: Scenario
    model: RacerModel
    room: float = 0.0

    def score(self, line: RacingLine) -> Score:
        """How good a line is."""
        if self.model == "point":
            raced = PointRacer.of(self.scenario).score(line)
        else:
            raced = run_score(ski_line(self.scenario, line))
        return with_room(raced, self.room)


@dataclass(frozen=True, slots=True)
class LinePoint:
    """Input of a worker: the line, and the position in the unit cube that it came from."""

    line: RacingLine
    place: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ScoredLine:
    """From a point to its row; for worker processes."""

    racer: Racer

    def __call__(self, point: LinePoint) -> dict[str, Any]:
        """The score with the place and the numbers of all turns."""
        result = self.racer.score(point.line)
        return {
            "place": list(point.place),
            "value": result.value,
            "time": result.time,
            "passed": result.passed,
            "words": result.words,
            "gates": [list(gate) for gate in result.gates],
            "margins": list(result.margins),
            "turns": [[turn.aside, turn.along, turn.turning] for turn in point.line.turns],
        }


def score_in(row: dict[str, Any]) -> Score:
    """The score of a row."""
    gates = tuple((outcome, time) for outcome, time in row["gates"])
    margins = tuple(row["margins"])
    return Score(
        value=row["value"], time=row["time"], passed=row["passed"], words=row["words"], gates=gates, margins=margins
    )


def turns_in(row: dict[str, Any]) -> tuple[LineTurn, ...]:
    """The turns of a row."""
    return tuple(LineTurn(aside=a, along=b, turning=c) for a, b, c in row["turns"])
