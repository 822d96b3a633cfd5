"""One simulated run of a search: from values of keys to places and speeds at the times that were measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicHermiteSpline

from .._support.errors import SkisnowError
from .._support.processes.kept_rows import Row
from ..scenario import Scenario, Solver, Stop
from ..scenario.reading import build_input
from ..scenario.resolution import ScenarioInput
from ..simulation.run import Run
from ..ski.sources import Sources

FloatArray = npt.NDArray[np.float64]

SEARCH_STEP: Final = 4e-3
"""Fixed step (s) of the fast mode in a search: 1 to 3 cm off after 46 m, on very hard snow too long (modelling
assumption)."""
OUTPUT_INTERVAL: Final = 0.02
"""Between the outputs (s) that a cubic with their velocities joins: exact to 0.1 mm on R = 5 m at 10 m/s."""
_AFTER_THE_LAST: Final = 1e-9


@dataclass(frozen=True, slots=True)
class RunTask:
    """What one simulated run is asked.

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
        """Lists x_m, y_m, speed_m_per_s at the times, and how many of these the run reached; or why there is none."""
        from ..simulation.simulated_run import simulate

        try:
            scenario = self._scenario(task)
            run = simulate(scenario)
        except SkisnowError as error:
            return {"outcome": "error", "reason": str(error)}
        if run.outcome == "interrupted":  # half a run is none: the search is what was interrupted
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
