"""Search of a design from several starts, and the Pareto front of two goals."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, SolverError
from .descent import Descent
from .evaluation import REACHED, Evaluator, Search
from .result import Design, Start, design_of, write_files
from .task import DesignTask, Goal, design_task, read_design

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
    """Searches from all starts, the best first, which is continued to a smaller tolerance."""
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
    """Search from a start z; if no ski or equilibrium exists on the way, its end is None and its result infinite."""
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
    """Variables of each start of a search: those of the ski itself, then random ones."""
    task = evaluator.task
    random = np.random.default_rng(task.seed)
    return [evaluator.start, *random.uniform(0.0, 1.0, (task.starts - 1, len(task.variables)))]


@dataclass(frozen=True, slots=True)
class FrontPoint:
    """A design of the front: its largest relative deviations from both targets (%), and its variables."""

    first_percent: float
    second_percent: float
    values: dict[str, float]


def design_front(task: str | Path | Mapping[str, Any] | DesignTask, *, points: int = 9) -> tuple[FrontPoint, ...]:
    """Pareto front of the two targets of a task; limits and constraints hold everywhere.

    The second target may deviate by even steps, from the design for it alone to the design for the first alone; at
    each step the design nearest to the first target is searched from the task's starts and from the design before.

    Parameters
    ----------
    task
        As of `skisnow.design_ski`, with exactly two goals that have a target.
    points
        Number of designs, 2 or more; fewer where both targets can be reached together.

    Raises
    ------
    ParameterError
        The task has another number of targets, or the number of points is below 2.
    SolverError
        No start led to a ski with an equilibrium.
    """
    task = task_of(task)
    targets = [goal for goal in task.goals if goal.target is not None]
    if len(targets) != 2 or points < 2:
        raise ParameterError(
            "a front needs two goals with a target and two points or more; there are {targets} and {points}."
        ).tag("out_of_range", targets=len(targets), points=points)
    first, second = targets
    limits = [goal for goal in task.goals if goal.target is None]
    evaluator = Evaluator(task)
    begins = begins_of(evaluator)
    ends = [_best_design(evaluator, [goal, *limits], begins) for goal in (first, second)]
    low, high = (_deviation(evaluator, second, end) for end in reversed(ends))
    found = [ends[1]]
    for allowed in np.linspace(low, high, points)[1:-1]:
        bounds = [_limit(second, allowed, 1.0), _limit(second, allowed, -1.0)]
        found.append(_best_design(evaluator, [first, *limits, *bounds], [*begins, found[-1]]))
    return _front(evaluator, first, second, [*found, ends[0]])


def write_front(front: Sequence[FrontPoint], folder: Path) -> tuple[Path, ...]:
    """Write ``front.csv`` and ``front.json``; returns their paths.

    Raises OutputError: a file cannot be written, or a ``front.csv`` is not from an earlier front.
    """
    rows = [["first_percent", "second_percent", *front[0].values]]
    rows += [
        [f"{n:.9g}" for n in (point.first_percent, point.second_percent, *point.values.values())] for point in front
    ]
    table = "".join(f"{','.join(row)}\n" for row in rows)
    values = json.dumps([asdict(point) for point in front], indent=1) + "\n"
    return write_files(folder, {"front.csv": table, "front.json": values})


def _limit(goal: Goal, allowed: float, side: float) -> Goal:
    """The goal's target as a limit: upper (side 1) or lower (side -1), `allowed` times its scale away."""
    curve = goal.factors + side * allowed * np.max(goal.factors)
    most, least = (goal.target, None) if side > 0.0 else (None, goal.target)
    return replace(goal, target=None, at_most=most, at_least=least, curve=tuple(curve.tolist()))


def _deviation(evaluator: Evaluator, goal: Goal, z: FloatArray) -> float:
    """Largest relative deviation of a design from a goal."""
    return float(np.max(np.abs(goal.deviations(evaluator.goal_values(goal, z)))))


def _best_design(evaluator: Evaluator, goals: Sequence[Goal], begins: Sequence[FloatArray]) -> FloatArray:
    """Variables (n,) of the best design for these goals together, of searches from all starts."""
    best = searched_starts(Search(evaluator, goals), begins)[0]
    if best.end is None:
        raise SolverError("no start led to a ski with an equilibrium. Narrow the bounds.").tag("no_equilibrium")
    return best.end


def _front(evaluator: Evaluator, first: Goal, second: Goal, designs: Sequence[FloatArray]) -> tuple[FrontPoint, ...]:
    """The designs in the order of the second deviation, without those that another one beats in both."""
    made = []
    for z in designs:
        off = [100.0 * _deviation(evaluator, goal, z) for goal in (first, second)]
        made.append(FrontPoint(off[0], off[1], evaluator.named_values(z)))
    front: list[FrontPoint] = []
    for point in sorted(made, key=lambda each: (each.second_percent, each.first_percent)):
        if not front or point.first_percent < front[-1].first_percent - 1e-4:
            front.append(point)
    return tuple(front)
