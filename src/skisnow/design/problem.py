"""Objective and constraints of a design, and a search from one start: SciPy's SLSQP with exact derivatives."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import SolverError
from .evaluation import Evaluator
from .variables import designed_keys, start_value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from .task import Goal


REACHED: Final = 1e-6
"""Relative deviation at which a target counts as reached."""
_NO_SKI: Final = 1e3  # objective where there is no ski or no equilibrium
_FTOL: Final = 5e-6  # of the objective: at a kink it does not fall smoothly
_POLISHED_FTOL: Final = 1e-7  # the same for the best start
_LEAST_GAIN: Final = 1e-4  # relative, of the result, for another run
_MOST_TRIALS: Final = 4  # trials of a line search: further ones would only creep up to a kink
_MOST_RUNS: Final = 4  # of SLSQP, each from the end of the one before
_NEAREST_FTOL: Final = 1e-8  # of changes, and of relative deviations where all targets are reached
PERCENT: Final = 1e4  # squares of deviations count in %
_BROKEN: Final = 1e9  # value of a design that breaks a limit: above that of each that keeps them
_MOST_ITERATIONS: Final = 60


class _StoppedError(Exception):
    """A search that gains nothing any more, or a line search that creeps up to a kink."""


class Search:
    """Objective and constraints of a task, in the variables from 0 to 1, and for worst-case goals one slack each."""

    def __init__(self, evaluator: Evaluator, goals: Sequence[Goal] | None = None) -> None:
        self.evaluator = evaluator
        goals = evaluator.task.goals if goals is None else goals
        self.targets = [goal for goal in goals if goal.target is not None]
        self.limits = [goal for goal in goals if goal.target is None]
        self.worst = [goal for goal in self.targets if goal.over == "worst"]
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

    def objective(self, x: FloatArray) -> float:
        """Sum over the targets of the mean square of their deviations, or of the square of their slack, in %²."""
        z, slack = x[: self.count], x[self.count :]
        try:
            squares = [float(np.mean(self.deviations(goal, z) ** 2)) for goal in self.targets if goal.over == "mean"]
        except SolverError:
            return _NO_SKI
        return PERCENT * (sum(squares) + float(slack @ slack))

    def gradient(self, x: FloatArray) -> FloatArray:
        """Gradient of the objective."""
        z, out = x[: self.count], 2.0 * np.concatenate([np.zeros(self.count), x[self.count :]])
        for goal in self.targets:
            if goal.over == "mean":
                deviations = self.deviations(goal, z)
                out[: self.count] += 2.0 * deviations @ self.deviation_growth(goal, z) / len(deviations)
        return PERCENT * out

    def constraints(self, *, exact: bool = False) -> list[dict[str, Any]]:
        """Limits, linear constraints, slacks; `exact`: all targets as equalities."""
        constraints = [_constraint(self, self.room, self.room_growth, goal) for goal in self.limits]
        if exact:
            constraints += [
                _constraint(self, self.deviations, self.deviation_growth, goal, kind="eq") for goal in self.targets
            ]
        else:
            for number, goal in enumerate(self.worst):
                constraints.append(_slack(self, goal, number))
        matrix, lowest = self.linear
        if len(lowest):
            constraints.append(
                {"type": "ineq", "fun": lambda x: matrix @ x[: self.count] - lowest, "jac": partial(_padded, matrix)}
            )
        return constraints

    def run(self, z: FloatArray, *, polish: bool = False) -> FloatArray:
        """Design variables (n,) with the smallest deviations from the targets, searched from z.

        If all targets are reached, those with the least change of the ski.
        polish: True from the best end of several starts, to a smaller tolerance.
        """
        if not self.targets:
            return self._nearest(z)
        z = self._smallest_deviations(z, polish)
        # SLSQP must not be given more equations than variables: it writes beyond its memory (SciPy 1.16)
        equations = sum(self.evaluator.value_count(goal) for goal in self.targets)
        return z if self.worst_deviation(z) > 1e-3 or equations > self.count else self._nearest(z)

    def _smallest_deviations(self, z: FloatArray, polish: bool) -> FloatArray:
        """SLSQP, and where it stops at a kink again from there: its quadratic model of one side misleads it."""
        best: list[Any] = [self.result(z), z]
        for _ in range(_MOST_RUNS):
            before = best[0]
            if not self._descend(best, polish) or best[0] > (1.0 - _LEAST_GAIN) * before:
                break
        return np.asarray(best[1])

    def _descend(self, best: list[Any], polish: bool) -> bool:
        """One run of SLSQP from the best design, which it replaces by better ones; whether it stopped at a kink."""
        trials = iterations = 0

        def objective(x: FloatArray) -> float:
            nonlocal trials
            trials += 1
            if iterations > 1 and trials > _MOST_TRIALS:
                raise _StoppedError
            return self.objective(x)

        def keep(x: FloatArray) -> None:
            z = np.clip(x[: self.count], 0.0, 1.0)
            result = self.result(z)
            if result < best[0]:
                best[:] = result, z

        def gradient(x: FloatArray) -> FloatArray:  # where SLSQP accepts a design; its callback sees trials
            nonlocal trials, iterations
            trials, iterations = 0, iterations + 1
            keep(x)
            return self.gradient(x)

        slack = [float(np.max(np.abs(self.deviations(goal, best[1])))) for goal in self.worst]
        try:
            solution = _minimize(
                objective, np.concatenate([best[1], slack]), jac=gradient,
                bounds=[(0.0, 1.0)] * self.count + [(0.0, None)] * len(slack), constraints=self.constraints(),
                ftol=_POLISHED_FTOL if polish else _FTOL,
            )  # fmt: skip
        except _StoppedError:
            return True
        keep(solution.x)
        return False

    def _nearest(self, z: FloatArray) -> FloatArray:
        """The design with the least change that reaches all targets; the given one where none was found."""
        home = self.evaluator.start
        nearest = _minimize(
            lambda x: float((x - home) @ (x - home)), z, jac=lambda x: 2.0 * (x - home),
            bounds=[(0.0, 1.0)] * self.count, constraints=self.constraints(exact=True), ftol=_NEAREST_FTOL,
        )  # fmt: skip
        near = np.clip(nearest.x, 0.0, 1.0)
        return near if self.broken(near) <= REACHED and self.worst_deviation(near) <= REACHED else z

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
        slack = [float(np.max(np.abs(self.deviations(goal, z)))) for goal in self.worst]
        home = self.evaluator.start
        nearest = 1e-9 * float((z - home) @ (z - home))  # among designs that reach all targets
        return self.objective(np.concatenate([z, slack])) + nearest


def _minimize(objective: Any, x: FloatArray, *, ftol: float, **arguments: Any) -> Any:
    from scipy import optimize

    minimize: Any = optimize.minimize  # its overloads know no vectors of constraints
    return minimize(objective, x, method="SLSQP", options={"ftol": ftol, "maxiter": _MOST_ITERATIONS}, **arguments)


def _constraint(search: Search, value: Any, growth: Any, goal: Goal, *, kind: str = "ineq") -> dict[str, Any]:
    def fun(x: FloatArray) -> FloatArray:
        try:
            return np.asarray(value(goal, x[: search.count]))
        except SolverError:
            return np.full(search.evaluator.value_count(goal), -_NO_SKI)

    return {"type": kind, "fun": fun, "jac": lambda x: _padded(growth(goal, x[: search.count]), x)}


def _padded(matrix: FloatArray, x: FloatArray) -> FloatArray:
    """With columns for the slacks."""
    return np.hstack([matrix, np.zeros((len(matrix), len(x) - matrix.shape[1]))])


def _slack(search: Search, goal: Goal, number: int) -> dict[str, Any]:
    """Constraint of SLSQP that bounds a goal's deviations by a slack: slack ± deviation ≥ 0."""

    def fun(x: FloatArray) -> FloatArray:
        try:
            deviations = search.deviations(goal, x[: search.count])
        except SolverError:
            return np.full(2 * search.evaluator.value_count(goal), -_NO_SKI)
        return np.asarray(x[search.count + number] + np.concatenate([deviations, -deviations]))

    def jac(x: FloatArray) -> FloatArray:
        growth = search.deviation_growth(goal, x[: search.count])
        out = _padded(np.concatenate([growth, -growth]), x)
        out[:, search.count + number] = 1.0
        return out

    return {"type": "ineq", "fun": fun, "jac": jac}


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
