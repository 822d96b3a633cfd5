"""Search of a design from several starts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from .._support.errors import SolverError
from .evaluation import Evaluator
from .problem import Search
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
    if not isinstance(task, DesignTask):
        task = design_task(task) if isinstance(task, dict) else read_design(task)  # type: ignore[arg-type]
    evaluator = Evaluator(task)
    search = Search(evaluator)
    random = np.random.default_rng(task.seed)
    begins = [evaluator.start, *random.uniform(0.0, 1.0, (task.starts - 1, search.count))]
    starts: list[Start] = []
    for number, begin in enumerate(begins):
        before = evaluator.equilibria
        try:
            z = search.run(begin)
            starts.append(Start(begin, z, search.result(z), evaluator.equilibria - before))
        except SolverError:  # no ski or no equilibrium there: the start is lost
            starts.append(Start(begin, None, float("inf"), evaluator.equilibria - before))
        if progress is not None:
            progress(number + 1, task.starts)
    best = min(starts, key=lambda start: start.result)
    if best.end is None:
        raise SolverError(
            "none of the {count} starts led to a ski with an equilibrium at all conditions. Narrow the bounds.",
            code="no_equilibrium",
            count=task.starts,
        )
    return design_of(search, best.end, tuple(starts))
