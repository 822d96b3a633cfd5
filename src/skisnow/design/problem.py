"""Objective and constraints of a design, with exact derivatives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import SolverError
from .evaluation import Evaluator
from .task import Goal, designed_keys, start_value

REACHED: Final = 1e-6
"""Relative deviation at which a target counts as reached, and breach at which a limit counts as kept."""
_NO_SKI: Final = 1e3  # objective where there is no ski or no equilibrium
PERCENT: Final = 1e4  # squares of deviations count in %
_BROKEN: Final = 1e9  # value of a design that breaks a limit: above that of each that keeps them


class Search:
    """Objective and constraints of a task, in the variables from 0 to 1."""

    def __init__(self, evaluator: Evaluator, goals: Sequence[Goal] | None = None) -> None:
        self.evaluator = evaluator
        goals = evaluator.task.goals if goals is None else goals
        self.targets = [goal for goal in goals if goal.target is not None]
        self.limits = [goal for goal in goals if goal.target is None]
        self.linear = linear_constraints(evaluator)

    @property
    def count(self) -> int:
        """Number of variables."""
        return len(self.evaluator.task.variables)

    def deviations(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Relative deviations from a target, times the root of the goal's weight."""
        return np.asarray(np.sqrt(goal.weight) * goal.deviations(self.evaluator.goal_values(goal, z)))

    def deviation_growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Growth of these, shape (values, variables)."""
        return np.asarray(np.sqrt(goal.weight) * self.evaluator.goal_growth(goal, z) / goal.scale)

    def room(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Relative distance to a limit; negative where it is violated."""
        side = -1.0 if goal.at_most is not None else 1.0
        return np.asarray(side * goal.deviations(self.evaluator.goal_values(goal, z)))

    def room_growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Growth of that, shape (values, variables)."""
        side = -1.0 if goal.at_most is not None else 1.0
        return np.asarray(side * self.evaluator.goal_growth(goal, z) / goal.scale)

    def objective(self, z: FloatArray) -> float:
        """Sum over the targets of the mean square of their deviations, or of the square of the worst one, in %²."""
        squares = [self.deviations(goal, z) ** 2 for goal in self.targets]
        over = zip(self.targets, squares, strict=True)
        return PERCENT * sum(float(np.max(each) if goal.over == "worst" else np.mean(each)) for goal, each in over)

    def worst_deviation(self, z: FloatArray) -> float:
        """Largest relative deviation from a target; 0 without targets."""
        try:
            return max((float(np.max(np.abs(self.deviations(goal, z)))) for goal in self.targets), default=0.0)
        except SolverError:
            return _NO_SKI

    def broken(self, z: FloatArray) -> float:
        """Largest breach of limits and linear constraints, relative."""
        matrix, lowest = self.linear
        try:
            rooms = [float(np.min(self.room(goal, z))) for goal in self.limits]
        except SolverError:
            return _NO_SKI
        return max([0.0, *(-room for room in rooms), *(lowest - matrix @ z).tolist()])

    def result(self, z: FloatArray) -> float:
        """Value of a design, in %²: mean squares and squares of worst deviations; huge where a limit is broken."""
        if self.broken(z) > REACHED:
            return _BROKEN * (1.0 + self.broken(z))
        home = self.evaluator.start
        nearest = 1e-9 * float((z - home) @ (z - home))  # among designs that reach all targets
        return self.objective(z) + nearest


def linear_constraints(evaluator: Evaluator) -> tuple[FloatArray, FloatArray]:
    """Rows a and limits b of a·z ≥ b, each over the size of its limit in the units of the ski file."""
    task = evaluator.task
    keys = task.ski.keys or {}

    def total(terms: Mapping[str, float], z: FloatArray) -> float:
        current = designed_keys(keys, task.variables, evaluator.values(z).tolist())
        return sum(factor * start_value(current, name) for name, factor in terms.items())

    rows, limits = [], []
    zero = np.zeros(len(task.variables))
    for constraint in task.constraints:
        base = total(constraint.terms, zero)
        row = np.array([total(constraint.terms, zero + one) - base for one in np.eye(len(zero))])
        size = float(np.max(np.abs(row), initial=0.0)) or 1.0
        if np.isfinite(constraint.at_least):
            rows.append(row / size)
            limits.append((constraint.at_least - base) / size)
        if np.isfinite(constraint.at_most):
            rows.append(-row / size)
            limits.append((base - constraint.at_most) / size)
    return np.array(rows).reshape(-1, len(zero)), np.array(limits)
