"""Simulated runs of a search, computed by worker processes and stored for a restart."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from typing import Any, Final

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from .._support.arrays import FloatArray
from .._support.errors import SkisnowError
from .._support.messages import Message
from .._support.processes.batch import ExecutorLike, Pool, worker_count
from .._support.processes.kept_rows import KeptRows, Row
from ..scenario import Scenario, Stop
from ..scenario.reading import build_input
from ..scenario.resolution import ScenarioInput
from ..simulation.run import Run
from ..simulation.verification import NUDGE, NUDGED, limit_sentences
from ..ski.ski_file import Sources

SEARCH_STEP: Final = 4e-3
"""Fixed step (s) of the fast mode in a search: error of 1 to 3 cm after 46 m; too long on very hard snow."""
OUTPUT_INTERVAL: Final = 0.02
"""Time (s) between outputs, which are interpolated by cubics with their velocities: error of 0.1 mm on R = 5 m at
10 m/s."""
_AFTER_THE_LAST: Final = 1e-9
_SNOW: Final = ("snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2")
_TOWARDS_LIMIT: Final = {"snow.S_f_N_per_mm2": -1.0}
"""Sign of a change that brings a run nearer to the limit of grip, where it is not 1."""


@dataclass(slots=True)
class Simulations(AbstractContextManager["Simulations"]):
    """Simulates batches of tasks in parallel, each different task once; processes start with the first tasks.

    workers: number of processes (default: the number of cores available to this process); 1: this process itself.
    progress: called with the number of runs computed so far.
    executor: executor of the simulations (default: processes of this computer).
    computed, restored: number of runs computed here, and of runs restored from `stored`.
    """

    simulate: RunSimulation
    stored: KeptRows = field(default_factory=KeptRows)
    workers: int | None = None
    progress: Callable[[int], None] = field(default=lambda _: None)
    executor: ExecutorLike | None = None
    computed: int = 0
    restored: int = 0
    _pool: Pool = field(init=False)
    _before: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        advice = Message("Finished runs are kept. Start again with --resume, with fewer workers.")
        self._pool = Pool(self.simulate, worker_count(self.workers), advice=advice, executor=self.executor)
        self._before = frozenset(self.stored.numbers())

    def __call__(self, tasks: Sequence[RunTask]) -> list[Row]:
        """Rows of all tasks, in their order."""
        numbers = [task_number(task) for task in tasks]
        missing = {number: task for number, task in zip(numbers, tasks, strict=True) if number not in self.stored}
        self.restored += sum(number in self._before for number in dict.fromkeys(numbers))
        for rows in self._pool.rows(list(missing.items())):
            self.computed += self.stored.add(rows)
            self.progress(self.computed)
        return [self.stored.row(number) for number in numbers]

    def __exit__(self, *error: Any) -> None:
        """End the processes."""
        self._pool.__exit__(*error)
        self.stored.close()


def task_number(task: RunTask) -> int:
    """Number that identifies a task, the same in every process.

    >>> task_number(RunTask({"friction.mu_0": 0.05}, 0, False))
    851841852695433548
    """
    text = json.dumps([sorted(task.values.items()), task.run, task.final])
    return int(hashlib.sha256(text.encode()).hexdigest()[:15], 16)


@dataclass(frozen=True, slots=True)
class RunTask:
    """Input of one simulated run.

    values: parameters by key of the scenario.
    run: index of the measured track.
    final: True for the scenario's accurate solver, False for the fast one of the search.
    """

    values: Mapping[str, float]
    run: int
    final: bool


@dataclass(slots=True)
class RunSimulation:
    """Simulates a run that tracks are compared with; instances can be sent to other processes.

    times: output times (s) for each track, rising, from the start.
    """

    scenario_input: ScenarioInput
    times: tuple[FloatArray, ...]
    _sources: Sources = field(init=False, default_factory=Sources)

    def __call__(self, task: RunTask) -> Row:
        """Row with x_m, y_m and speed_m_per_s at the times and the number of times reached, or with an error."""
        from ..simulation.simulated_run import simulate

        try:
            scenario = self._scenario_of_task(task)
            run = simulate(scenario)
        except SkisnowError as error:
            return {"outcome": "error", "reason": str(error)}
        if run.outcome == "interrupted":  # an incomplete run is not stored; the search is interrupted instead
            raise KeyboardInterrupt
        return _row(run, self.times[task.run])

    def _scenario_of_task(self, task: RunTask) -> Scenario:
        """Scenario of a run, as long as its track; with fast fixed steps unless it is the final run."""
        scenario = build_input(self.scenario_input.changed(task.values), sources=self._sources).scenario
        duration = max(float(self.times[task.run][-1]), 1e-3) + _AFTER_THE_LAST
        interval = min(scenario.solver.output_interval, OUTPUT_INTERVAL) if task.final else OUTPUT_INTERVAL
        solver = replace(scenario.solver, output_interval=interval)
        if not task.final:
            solver = replace(solver, method="fast", fixed=True, step=SEARCH_STEP)
        return replace(scenario, stop=Stop(duration=duration), solver=solver)


def _row(run: Run, times: FloatArray) -> Row:
    """Outcome, places (m) and speeds (m/s) of a run at the times (s); after its end extrapolated straight."""
    finite = np.isfinite(run.place).all(axis=1) & np.isfinite(run.velocity).all(axis=1)
    count = len(run.time) if finite.all() else int(np.argmin(finite))
    if count < 2:
        return {"outcome": "error", "reason": run.remedy}
    time, place, velocity = run.time[:count], run.place[:count, :2], run.velocity[:count, :2]
    within = np.minimum(times, time[-1])
    places = CubicHermiteSpline(time, place, velocity)(within) + (times - within)[:, None] * velocity[-1]
    speed = np.interp(within, time, np.linalg.norm(run.velocity[:count], axis=1))
    return {
        "outcome": run.outcome,
        "reached": int(np.sum(times <= time[-1] + 1e-6)),
        "x_m": places[:, 0].tolist(),
        "y_m": places[:, 1].tolist(),
        "speed_m_per_s": speed.tolist(),
    }


def perturbed_tasks(task: RunTask, values: Mapping[str, float], *, together: bool = False) -> dict[str, list[RunTask]]:
    """Tasks of fast runs with each input increased and decreased by 0.1 %, by key.

    task: task of the run with the best values.
    values: values of the scenario for keys that the task does not have. A value of 0 is not changed.
    together: True to change all inputs at once, towards the limit of grip and away from it.
    """
    base = {**{key: values[key] for key in _SNOW}, **task.values}  # numbers replace a published snow
    groups = {"all": NUDGED} if together else {key: (key,) for key in NUDGED}
    tasks: dict[str, list[RunTask]] = {}
    for name, keys in groups.items():
        for change in (NUDGE, -NUDGE):
            moved = {key: base.get(key, values[key]) * (1.0 + change * _TOWARDS_LIMIT.get(key, 1.0)) for key in keys}
            if any(moved.values()):
                tasks.setdefault(name, []).append(RunTask(base | moved, task.run, final=False))
    return tasks


def grip_limit_sentences(
    task: RunTask, values: Mapping[str, float], simulate: Callable[[Sequence[RunTask]], list[Row]]
) -> tuple[Message, ...]:
    """Warning as of `simulate --verify` if small changes of the inputs move the end of the run too far.

    Each input is changed separately only if the ends of two runs with all inputs changed are apart by half as much.
    """
    first, other = simulate(perturbed_tasks(task, values, together=True)["all"])
    if "x_m" not in first or not limit_sentences({NUDGED[0]: 2.0 * _end_distance(first, other)}, _path_length(first)):
        return ()
    (own,) = simulate([task])
    if "x_m" not in own:
        return ()
    perturbed = perturbed_tasks(task, values)
    rows = iter(simulate([each for pair in perturbed.values() for each in pair]))
    moves = {key: max(_end_distance(own, next(rows)) for _ in pair) for key, pair in perturbed.items()}
    return limit_sentences(moves, _path_length(own))


def _path_length(row: Row) -> float:
    """Length (m) of a simulated path in the plane."""
    return float(np.sum(np.hypot(np.diff(row["x_m"]), np.diff(row["y_m"]))))


def _end_distance(own: Row, other: Row) -> float:
    """Distance (m) between the ends of two runs; 0 if the other run does not exist."""
    if "x_m" not in other:
        return 0.0
    return float(np.hypot(other["x_m"][-1] - own["x_m"][-1], other["y_m"][-1] - own["y_m"][-1]))
