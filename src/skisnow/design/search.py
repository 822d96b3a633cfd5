"""Search of a design from several starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import SolverError
from .descent import Descent
from .evaluation import Evaluator
from .problem import REACHED, Search
from .result import Design, Start, design_of
from .task import DesignTask, design_task, read_design

Progress: TypeAlias = Callable[[int, int], None]


def design_ski(task: str | Path | Mapping[str, Any] | DesignTask, *, progress: Progress | None = None) -> Design:
    """Find the ski that comes nearest to the goals.

    Parameters
    ----------
    task
        A DESIGN.toml, its contents, or a task that was read.
    progress
        Called with the share of finished starts.

    Returns
    -------
    Design
        The ski before and after, the outputs at each condition, the local optima, and the goals that were not reached.

    Raises
    ------
    ParameterError
        The task is not sound.
    SolverError
        No start led to a ski with an equilibrium.

    See Also
    --------
    skisnow.carve : the equilibrium at each condition.

    References
    ----------
    * The page docs/files/ski.md.
    * The page docs/methods/carved-turn.md.

    Examples
    --------
    >>> turn = {"published": "race-piste", "unloading_ratio": 10, "edge_angle_deg": 45, "load_N": 800}
    >>> goal = {"output": "turn_radius_boot_m", "target": 11.0}
    >>> task = {"ski": "slalom", "variables": {"sidecut_mm": [-10, 10]}, "conditions": [turn], "goals": [goal]}
    >>> design_ski({**task, "starts": 1}).reached
    True
    """
    task = task_of(task)
    evaluator = Evaluator(task)
    search = Search(evaluator)
    starts = searched_starts(search, begins_of(evaluator), progress)
    best = starts[0]
    if best.end is None:
        raise SolverError(
            "none of the {count} starts led to a ski with an equilibrium at all conditions. Narrow the bounds."
        ).tag("no_equilibrium", count=task.starts)
    return design_of(search, best.end, starts)


def searched_starts(
    search: Search, begins: Sequence[FloatArray], progress: Progress | None = None
) -> tuple[Start, ...]:
    """Ends of a search from several starts, the best first; that one is searched on to a smaller tolerance."""
    starts = []
    for number, begin in enumerate(begins):
        starts.append(_search_from(search, begin, begin, polish=False))
        if progress is not None:
            progress(number + 1, len(begins))
    first, *others = sorted(starts, key=lambda start: start.result)
    if first.end is not None and search.worst_deviation(first.end) > REACHED:
        polished = _search_from(search, first.begin, first.end, polish=True)
        better = polished if polished.result < first.result else first
        first = replace(better, equilibria=first.equilibria + polished.equilibria)
    return first, *others


def _search_from(search: Search, begin: FloatArray, z: FloatArray, *, polish: bool) -> Start:
    before = search.evaluator.equilibria
    try:
        end = Descent(search).run(z, polish=polish)
        return Start(begin, end, search.result(end), search.evaluator.equilibria - before)
    except SolverError:  # no ski or no equilibrium there: the start is lost
        return Start(begin, None, float("inf"), search.evaluator.equilibria - before)


def task_of(task: str | Path | Mapping[str, Any] | DesignTask) -> DesignTask:
    """The checked task of a file, its contents, or a task."""
    if isinstance(task, DesignTask):
        return task
    return design_task(task) if isinstance(task, Mapping) else read_design(task)


def begins_of(evaluator: Evaluator) -> list[FloatArray]:
    """Starts of a search: the ski itself, and random ones."""
    task = evaluator.task
    random = np.random.default_rng(task.seed)
    return [evaluator.start, *random.uniform(0.0, 1.0, (task.starts - 1, len(task.variables)))]
