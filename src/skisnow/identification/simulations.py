"""Simulated runs of a search, computed by worker processes and stored for a restart."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import TracebackType
from typing import Final, Self

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from .._support.errors import SkisnowError
from .._support.processes.executors import ExecutorLike
from .._support.processes.kept_rows import KeptRows, Row
from .._support.processes.pool import Pool, workers_in_force
from ..scenario import Scenario, Solver, Stop
from ..scenario.reading import build_input
from ..scenario.resolution import ScenarioInput
from ..simulation.run import Run
from ..simulation.verification import NUDGE, NUDGED, limit_sentences
from ..ski.sources import Sources

FloatArray = npt.NDArray[np.float64]
SEARCH_STEP: Final = 4e-3
"""Fixed step (s) of the fast mode in a search: 1 to 3 cm off after 46 m, on very hard snow too long (modelling
assumption)."""
OUTPUT_INTERVAL: Final = 0.02
"""Between the outputs (s) that a cubic with their velocities joins: exact to 0.1 mm on R = 5 m at 10 m/s."""
_AFTER_THE_LAST: Final = 1e-9
_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")


@dataclass(slots=True)
class Simulations:
    """Runs tasks, all at once, each only once.

    Attributes
    ----------
    simulate
        What does one.
    kept
        Rows that are finished, and where new ones are kept.
    workers
        Number of processes; None: as many as this process has cores; 1: this process itself.
    progress
        Called with the number of runs computed so far.
    executor
        Executor of the simulations (default: processes of this computer).
    computed, found
        How many were computed here, and how many were finished before.
    """

    simulate: RunSimulation
    kept: KeptRows = field(default_factory=KeptRows)
    workers: int | None = None
    progress: Callable[[int], None] = field(default=lambda _: None)
    executor: ExecutorLike | None = None
    computed: int = 0
    found: int = 0
    _pool: Pool = field(init=False)
    _before: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        advice = "finished runs are kept. Start again with --resume, with fewer workers"
        self._pool = Pool(self.simulate, workers_in_force(self.workers), advice=advice, executor=self.executor)
        self._before = frozenset(self.kept.numbers())

    def __call__(self, tasks: Sequence[RunTask]) -> list[Row]:
        """Rows of all tasks, in their order.

        Raises
        ------
        SkisnowError
            A process ended unexpectedly; what was finished is kept.
        """
        numbers = [task_number(task) for task in tasks]
        missing = {number: task for number, task in zip(numbers, tasks, strict=True) if number not in self.kept}
        self.found += sum(number in self._before for number in dict.fromkeys(numbers))
        for rows in self._pool.rows(list(missing.items())):
            self.computed += self.kept.add(rows)
            self.progress(self.computed)
        return [self.kept.row(number) for number in numbers]

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the processes."""
        self._pool.__exit__(kind, error, trace)
        self.kept.close()


def task_number(task: RunTask) -> int:
    """The same number for the same task, at every start.

    >>> task_number(RunTask({"friction.mu_0": 0.05}, 0, False))
    851841852695433548
    """
    text = json.dumps([sorted(task.values.items()), task.run, task.final])
    return int(hashlib.sha256(text.encode()).hexdigest()[:15], 16)


@dataclass(frozen=True, slots=True)
class RunTask:
    """Input of one simulated run.

    Attributes
    ----------
    values
        By the scenario's keys.
    run
        Number of the track.
    final
        Whether with the accuracy of the answer: the scenario's own solver.
    """

    values: Mapping[str, float]
    run: int
    final: bool


@dataclass(slots=True)
class RunSimulation:
    """Simulates what tracks are compared with. An instance can be handed to another process.

    Attributes
    ----------
    given
        The scenario.
    times
        For each track the times (s) that are wanted, rising, from the start.
    """

    given: ScenarioInput
    times: tuple[FloatArray, ...]
    _sources: Sources = field(init=False, default_factory=Sources)

    def __call__(self, task: RunTask) -> Row:
        """Lists x_m, y_m, speed_m_per_s at the times, and how many times the run reached; or why no run exists."""
        from ..simulation.simulated_run import simulate

        try:
            scenario = self._scenario(task)
            run = simulate(scenario)
        except SkisnowError as error:
            return {"outcome": "error", "reason": str(error)}
        if run.outcome == "interrupted":  # half a run does not count: the search is what was interrupted
            raise KeyboardInterrupt
        return _row(run, self.times[task.run])

    def _scenario(self, task: RunTask) -> Scenario:
        asked = build_input(self.given.changed(task.values), sources=self._sources).scenario
        duration = max(float(self.times[task.run][-1]), 1e-3) + _AFTER_THE_LAST
        interval = min(asked.solver.output_interval, OUTPUT_INTERVAL) if task.final else OUTPUT_INTERVAL
        solver = replace(asked.solver, output_interval=interval)
        if not task.final:
            solver = _search_solver(solver)
        return replace(asked, stop=Stop(duration=duration), solver=solver)


def _search_solver(solver: Solver) -> Solver:
    return replace(solver, method="fast", fixed=True, step=SEARCH_STEP)


def _row(run: Run, times: FloatArray) -> Row:
    """Where the run ended before a time it is taken to go on straight, as fast as it was."""
    known = np.isfinite(run.place).all(axis=1) & np.isfinite(run.velocity).all(axis=1)
    count = len(run.time) if known.all() else int(np.argmin(known))
    if count < 2:
        return {"outcome": "error", "reason": run.remedy}
    time, place, velocity = run.time[:count], run.place[:count, :2], run.velocity[:count, :2]
    within = np.minimum(times, time[-1])
    found = CubicHermiteSpline(time, place, velocity)(within) + (times - within)[:, None] * velocity[-1]
    speed = np.interp(within, time, np.linalg.norm(run.velocity[:count], axis=1))
    return {
        "outcome": run.outcome,
        "reached": int(np.sum(times <= time[-1] + 1e-6)),
        "x_m": found[:, 0].tolist(),
        "y_m": found[:, 1].tolist(),
        "speed_m_per_s": speed.tolist(),
    }


def nudged_tasks(task: RunTask, values: Mapping[str, float]) -> dict[str, tuple[RunTask, ...]]:
    """A quick run with a thousandth more and one with a thousandth less of each input, by key.

    Parameters
    ----------
    task
        Of the run that was found.
    values
        The scenario's, where the task has none. One that is 0 is not nudged.
    """
    base = {**{key: values[key] for key in _SNOW}, **task.values}  # numbers replace a published snow
    found: dict[str, tuple[RunTask, ...]] = {}
    for key in NUDGED:
        own = base.get(key, values[key])
        if own:
            each = ({**base, key: own * (1.0 + sign * NUDGE)} for sign in (1.0, -1.0))
            found[key] = tuple(RunTask(nudged, task.run, final=False) for nudged in each)
    return found


def limit_of(own: Row, nudged: Mapping[str, Sequence[Row]]) -> tuple[str, ...]:
    """The sentence of `simulate --verify`, from the ends of the run that was found and of the nudged ones."""
    if "x_m" not in own or len(own["x_m"]) < 2:
        return ()
    length = float(np.sum(np.hypot(np.diff(own["x_m"]), np.diff(own["y_m"]))))
    moves = {key: max((_apart(own, row) for row in rows), default=0.0) for key, rows in nudged.items()}
    return limit_sentences(moves, length)


def _apart(own: Row, other: Row) -> float:
    """Distance (m) of the ends; 0 if the other run does not exist."""
    if "x_m" not in other:
        return 0.0
    return float(np.hypot(other["x_m"][-1] - own["x_m"][-1], other["y_m"][-1] - own["y_m"][-1]))
