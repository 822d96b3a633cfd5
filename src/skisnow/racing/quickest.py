"""The quickest line through a course."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import get_args

from .._support.arrays import content_hash
from .._support.errors import ParameterError, require_choice, require_range
from .._support.messages import Message
from .._support.processes.batch import ExecutorLike, Pool, require_executor, worker_count
from .._support.processes.kept_rows import KeptRows
from .._support.units import Facts, Shown, amount
from ..scenario import Scenario
from .line import RacingLine, course_of, first_gates, follower_line, skier_of
from .point import Racer, RacerModel, score_in, turns_in
from .score import NOT_PASSED, Score
from .search import Evaluated, Evaluations, require_cmaes
from .windows import RANGES, Progress, Search, Windows


@dataclass(frozen=True, slots=True, kw_only=True, repr=False, eq=False)
class QuickestLine(Shown):
    """Result of a search, next to the line that it started from.

    Attributes
    ----------
    scenario
        Scenario of the race; its course is cut to the gates that were raced through.
    model
        Racer: "skier" or "point".
    line, score
        Quickest line, and its score as the search computed it.
    start, start_score
        Line at the start of the search, and its score; default: `skisnow.racing.follower_line`.
    history
        Every evaluation.
    seed
        Seed of the random numbers of the search.

    See Also
    --------
    skisnow.race
    """

    scenario: Scenario
    model: RacerModel
    line: RacingLine
    score: Score
    start: RacingLine
    start_score: Score
    history: tuple[Evaluated, ...]
    seed: int

    @property
    def gained(self) -> float | None:
        """Time (s) by which the result is quicker than the start of the search; None if one of them fails."""
        if self.score.time is None or self.start_score.time is None:
            return None
        return self.start_score.time - self.score.time

    def _repr_facts(self) -> Facts:
        """Time and gates as title, and rows with the start, the gain (s) and the number of evaluations."""
        rows = (
            ("began from", amount(self.start_score.time, "s") if self.start_score.time else self.start_score.words),
            ("quicker by", amount(self.gained, "s")),
            ("evaluations", str(len(self.history))),
        )
        time = self.score.words if self.score.time is None else amount(self.score.time, "s")
        return Facts(f"{time} through {len(self.line.turns)} gates", rows)


def quickest_line(
    scenario: Scenario,
    *,
    gates: int | None = None,
    model: RacerModel = "skier",
    start: RacingLine | None = None,
    evaluations: int = 300,
    search: Search | None = None,
    population: int | None = None,
    spread: float = 0.15,
    settled: float = 0.0,
    window: int | None = None,
    step: int = 1,
    ahead: int = 2,
    room: float = 0.05,
    seed: int = 0,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    checkpoint: Path | None = None,
    progress: Progress | None = None,
) -> QuickestLine:
    """Search the quickest line through a course: three numbers a turn, in skidded turns also the wanted speed.

    Parameters
    ----------
    scenario
        With a course and a skier. The search computes it as it is: give ``method="fast"`` for half of the work.
    gates
        Number of gates to race through, the first of the course, 2 or more; None: all.
    model
        "skier": each evaluation is a simulated run; "point": a mass on the line, on a plane, 5 ms each.
    start
        Start of the search; None: the skier's own line.
    evaluations
        Number, for each window, after which no new batch begins. 1: only the start line, which needs no cmaes.
    search
        "surrogate": a Gaussian process of the evaluations so far chooses the next four; where all turns begin alike it
        varies them alike at first. "cma": only CMA-ES, for very cheap evaluations. None: "surrogate" for the skier,
        "cma" for the point.
    population
        Evaluations of a batch of CMA-ES; None: 4 + 3 ln n for n numbers.
    spread
        Standard deviation of the first batch over the range of each number, above 0 to 1.
    settled
        Tolerance (s) that ends a search early: with CMA-ES if the values of a batch differ by less, with the surrogate
        if three batches in a row lower the smallest value by less.
    window, step
        Number of gates whose turns are searched at once; the turns before them stay as found, then the window moves by
        `step` gates; None: all at once. The whole course is searched first, with equal turns if they begin equal: turns
        outside all windows keep that result. If no line of a window passes, the window before is searched again.
    ahead
        Number of gates behind a window that its evaluations race through as well, by the turns so far: a line that is
        too fast at the window's last gate fails at them, or is slow.
    room
        Smallest distance (m) of both skis from each pole, 0 to 1; a line that passes nearer fails. A smaller distance
        may become a straddle with another solver.
    seed
        Seed of all random numbers, 0 or more.
    workers
        Number of processes; None: one for each core. The line does not depend on it.
    executor
        Executor used instead of processes of this computer, as of `skisnow.run_batch`.
    checkpoint
        File of finished evaluations, from which the same call resumes; None: no file.
    progress
        Called with a line of text now and then.

    Returns
    -------
    QuickestLine
        The best line of all evaluations, which never is slower than where it began.

    Raises
    ------
    ParameterError
        The scenario has no course or no skier, a number is out of range, cmaes is not installed, or the checkpoint
        belongs to another search.

    See Also
    --------
    skisnow.simulate
    skisnow.time_gates

    Notes
    -----
    A line that misses a gate, or on which the skier falls, counts as slower than any other, by the missing distance.
    The same call gives the same bits on the same machine, interrupted or not, whatever the number of workers.

    References
    ----------
    * Hansen and Ostermeier (2001), "Completely derandomized self-adaptation in evolution strategies", Evolutionary
      Computation 9(2), 159-195, doi 10.1162/106365601750190398.
    * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
      Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
    * The page docs/how-to/race.md.
    """
    require_choice("model", model, get_args(RacerModel))
    begun = _start_line(scenario, gates, start)
    window, step = _window_and_step(len(begun.turns), window, step, ahead)
    _require_settings(evaluations=evaluations, population=population, spread=spread, settled=settled, room=room)
    search = _search_method(search, model)
    if evaluations > 1:
        require_cmaes()
    require_executor(executor)
    scenario = replace(scenario, course=begun.course)
    racer = Racer(scenario, model, room)
    tell = progress or (lambda *_: None)
    settings = (evaluations, search, population, spread, settled, window, step, ahead, seed)
    rows = KeptRows() if checkpoint is None else KeptRows.opened(checkpoint, _fingerprint(racer, begun, settings))
    advice = Message("Finished evaluations are kept. Start again, with fewer workers.")
    try:
        with Pool(racer, worker_count(workers), advice=advice, executor=executor) as pool:
            made = Evaluations(pool, rows, [])
            kinds = len(RANGES) - (model == "point" or not skier_of(scenario).brakes_to)
            searched = Windows(
                made, search, evaluations, population, spread, settled, seed, tell, window, step, ahead, kinds
            ).search_line(begun)
    finally:
        rows.close()
    return QuickestLine(
        scenario=scenario, model=model, line=RacingLine(begun.course, begun.start, turns_in(searched.row)),
        score=score_in(searched.row), start=begun, start_score=score_in(made.done[0].row), history=tuple(made.done),
        seed=seed,
    )  # fmt: skip


def _start_line(scenario: Scenario, gates: int | None, start: RacingLine | None) -> RacingLine:
    """Line at the start of the search, cut to the number of gates; each of its numbers must be in its range."""
    course = course_of(scenario)
    line = follower_line(scenario) if start is None else start
    if start is not None and len(start.turns) != len(course.gates) and gates is None:
        raise ParameterError("the start line has {n_turns} turns and the course {n_gates} gates; state gates=").tag(
            "wrong_shape", n_turns=len(start.turns), n_gates=len(course.gates)
        )
    for gate, turn in zip(course.gates, line.turns, strict=False):
        for name, (low, high) in RANGES.items():
            if not low <= getattr(turn, name) <= high:
                raise ParameterError(
                    "gate {gate}: {name} is {value:g}; a search begins within {low:g} to {high:g}"
                ).tag("out_of_range", gate=gate.name, name=name, value=getattr(turn, name), low=low, high=high)
    count = len(course.gates) if gates is None else gates
    require_range("gates", count, 2, len(line.turns))
    return first_gates(line, count)


def _window_and_step(gates: int, window: int | None, step: int, ahead: int) -> tuple[int, int]:
    """Checked window and step of the search, in gates."""
    window = gates if window is None else window
    require_range("window", window, 2, gates)
    require_range("step", step, 1, window)
    require_range("ahead", ahead, 0)
    return window, step


def _search_method(search: Search | None, model: RacerModel) -> Search:
    """Method of the search; by default "surrogate" for the skier and "cma" for other models."""
    if search is None:
        return "surrogate" if model == "skier" else "cma"
    require_choice("search", search, get_args(Search))
    return search


def _require_settings(*, evaluations: int, population: int | None, spread: float, settled: float, room: float) -> None:
    """Reject settings of the search that are out of their ranges."""
    require_range("evaluations", evaluations, 1)
    require_range("population", 4 if population is None else population, 4)
    require_range("spread", spread, 0.0, 1.0, above=True)
    require_range("room", room, 0.0, 1.0)
    require_range("settled", settled, 0.0, NOT_PASSED, below=True)


def _fingerprint(racer: Racer, begun: RacingLine, settings: Sequence[object]) -> str:
    """Hash of racer, start line, settings and versions, which marks the evaluations of the same search."""
    search = version("cmaes") if settings[0] != 1 else None
    head = f"with gates {version('skisnow')} {search} {tuple(settings)} {begun.apexes}"
    return content_hash(head, racer, begun.turns)
