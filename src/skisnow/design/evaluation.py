"""Outputs of a design at its conditions, its objective and constraints, with exact derivatives by the variables."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain, repeat
from typing import Any, Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import ParameterError, SolverError
from ..carving.answer import asked_snow
from ..carving.equilibrium import differentiable_carve
from ..carving.question import CarveQuestion
from ..carving.sensitivity import CarveDerivatives, ski_derivatives
from ..carving.solve import Solution
from ..ski import Ski
from ..ski.ski_file import ski_of_keys
from ..snow import SnowProperties
from .task import COMBINED, DesignTask, Goal, combined_names, designed_keys, start_value


@dataclass(slots=True, eq=False)
class Evaluator:
    """Equilibria of a task's ski at its conditions, each computed once; variables count from 0 to 1 of their bounds."""

    task: DesignTask
    equilibria: int = 0
    snows: tuple[SnowProperties, ...] = ()
    names: tuple[str, ...] = ()
    _points: dict[bytes, tuple[CarveDerivatives, ...]] = field(default_factory=dict)
    _growths: dict[bytes, dict[tuple[int, str], FloatArray]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        combined = (combined_names(variable.name) for variable in self.task.variables)
        self.names = tuple(dict.fromkeys(chain.from_iterable(combined)))
        self.snows = tuple(asked_snow(condition, self.task.sources) for condition in self.task.conditions)

    @property
    def start(self) -> FloatArray:
        """Variables of the initial ski, from 0 to 1 of their bounds; values beyond a bound are clipped."""
        keys = self.task.ski.keys or {}
        values = [
            (start_value(keys, variable.name) - variable.lowest) / variable.width for variable in self.task.variables
        ]
        return np.clip(values, 0.0, 1.0)

    def values(self, z: FloatArray) -> FloatArray:
        """Values of the variables, in the units of the ski file."""
        return np.array(
            [variable.lowest + variable.width * share for variable, share in zip(self.task.variables, z, strict=True)]
        )

    def named_values(self, z: FloatArray) -> dict[str, float]:
        """Values of the variables by name, in the units of the ski file."""
        return {
            variable.name: value for variable, value in zip(self.task.variables, self.values(z).tolist(), strict=True)
        }

    def keys(self, z: FloatArray) -> dict[str, Any]:
        """Keys of the ski file with these variables."""
        return designed_keys(self.task.ski.keys or {}, self.task.variables, self.values(z).tolist())

    def points(self, z: FloatArray) -> tuple[CarveDerivatives, ...]:
        """Refined equilibria at all conditions. Raises SolverError: the ski is impossible, or has no equilibrium."""
        place = z.tobytes()
        if place not in self._points:
            if len(self._points) > 15:
                self._points.pop(next(iter(self._points)))
            try:
                ski = ski_of_keys(self.keys(z))
            except ParameterError as error:
                raise SolverError("this ski is impossible: {reason}").tag("no_ski", reason=error) from error
            begins: list[Solution | None] = [None] * len(self.snows)
            if self._points:
                near = min(self._points, key=lambda known: float(np.linalg.norm(np.frombuffer(known) - z)))
                begins = [each.at.solution for each in self._points[near]]
            self._points[place] = tuple(map(self._point, range(len(self.snows)), repeat(ski), begins))
        return self._points[place]

    def _point(self, number: int, ski: Ski, near: Solution | None) -> CarveDerivatives:
        """Refined equilibrium of a ski at the condition with this number, from 0."""
        self.equilibria += 1
        derivatives = carve_at(ski, self.task.conditions[number], self.snows[number], near=near)
        if derivatives is None:
            raise SolverError("there is no equilibrium at condition {number}.").tag("no_equilibrium", number=number + 1)
        return derivatives

    def goal_values(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Values (n,) of the goal's output at its conditions and places, or the ratio of two conditions."""
        chosen = self._chosen(goal, z)
        if goal.places_m is not None:
            return np.concatenate([point.force_at(np.array(goal.places_m)) for point in chosen])
        values = np.array([_output(point, goal.output) for point in chosen])
        return values[:1] / values[1:] if goal.ratio else values

    def goal_growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Derivatives of `goal_values` with respect to the variables, shape (values, variables)."""
        if goal.places_m is not None:
            place, by_variables = np.array(goal.places_m), self._by_variables(z)
            growths = [[point.force_growth_at(name, place) for name in self.names] for point in self._chosen(goal, z)]
            return np.concatenate([(by_variables @ np.array(growth)).T for growth in growths])
        rows = self.output_growths([(number, goal.output) for number in self._numbers(goal)], z)
        if goal.ratio:
            values = self.goal_values(goal, z)
            return np.asarray((rows[:1] - values[0] * rows[1:]) / _output(self._chosen(goal, z)[1], goal.output))
        return rows

    def output_growths(self, asked: Sequence[tuple[int, str]], z: FloatArray) -> FloatArray:
        """Derivatives with respect to the variables of outputs, each with the number of its condition, from 0.

        Shape (outputs, variables). Those of all goals are computed together.
        """
        place = z.tobytes()
        if place not in self._growths:
            goals = (goal for goal in self.task.goals if goal.places_m is None)
            of_goals = [(number, goal.output) for goal in goals for number in self._numbers(goal)]
            self._growths = {place: self._computed_growths(dict.fromkeys([*of_goals, *asked]), z)}
        known = self._growths[place]
        if missing := [each for each in asked if each not in known]:
            known |= self._computed_growths(missing, z)
        return np.array([known[each] for each in asked])

    def _computed_growths(self, asked: Collection[tuple[int, str]], z: FloatArray) -> dict[tuple[int, str], FloatArray]:
        """Derivatives (variables,) of outputs by number of condition and name, computed mesh by mesh."""
        points, by_variables = self.points(z), self._by_variables(z)
        out: dict[tuple[int, str], FloatArray] = {}
        meshes = dict.fromkeys(points[number].request.model for number, _ in asked)
        for mesh in meshes:
            same = [each for each in asked if points[each[0]].request.model is mesh]
            growths = ski_derivatives([(points[number], output) for number, output in same], self.names)
            out |= dict(zip(same, growths @ by_variables.T, strict=True))
        return out

    def _by_variables(self, z: FloatArray) -> FloatArray:
        """Derivatives of the ski's parameters with respect to the variables, shape (variables, parameters)."""
        # factors of a list of stiffness multiply its rows
        values = zip(self.task.variables, self.values(z).tolist(), strict=True)
        factors = {COMBINED[variable.name][0]: value for variable, value in values if variable.name in COMBINED}
        out = np.zeros((len(self.task.variables), len(self.names)))
        for row, variable in enumerate(self.task.variables):
            key, _, number = variable.name.partition("[")
            growth = variable.width * factors.get(key, 1.0) if number else variable.width
            if variable.name in COMBINED and variable.name != "sidecut_mm":
                growth /= factors[COMBINED[variable.name][0]]
            for name in combined_names(variable.name):
                out[row, self.names.index(name)] = growth
        return out

    def value_count(self, goal: Goal) -> int:
        """Number of a goal's values."""
        conditions = 1 if goal.ratio else len(goal.conditions or self.task.conditions)
        return conditions * len(goal.factors)

    def _numbers(self, goal: Goal) -> list[int]:
        """Numbers, from 0, of the conditions of a goal (default: all)."""
        return [int(number) - 1 for number in goal.conditions or range(1, len(self.snows) + 1)]

    def _chosen(self, goal: Goal, z: FloatArray) -> list[CarveDerivatives]:
        """Equilibria at the conditions of a goal."""
        points = self.points(z)
        return [points[number] for number in self._numbers(goal)]


def _output(point: CarveDerivatives, name: str) -> float:
    """Value of an output of a carve; SolverError if it does not exist or is not finite."""
    value = point.output(name)
    if value is None or not math.isfinite(value):
        raise SolverError("the carve has no {output}.").tag("no_value", output=name)
    return value


def carve_at(
    ski: Ski, question: CarveQuestion, snow: SnowProperties, *, near: Solution | None = None
) -> CarveDerivatives | None:
    """Refined equilibrium of a question for this ski on this snow; None: not converged."""
    arguments = question.arguments
    del arguments["groove"], arguments["footprint_stiffness"]  # a task has none
    return differentiable_carve(ski, snow, **arguments, near=near)


REACHED: Final = 1e-6
"""Relative deviation at which a target counts as reached, and breach at which a limit counts as kept."""
_NO_SKI: Final = 1e3  # objective without a ski or an equilibrium
PERCENT: Final = 1e4  # squares of deviations count in %
_BROKEN: Final = 1e9  # value of a design that breaks a limit: above that of each that keeps them


class Search:
    """Objective and constraints of a task as functions of the variables, scaled to 0 to 1 of their bounds."""

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

    def values(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Relative deviations from a target, times the root of its weight; distances to a limit, below 0: violated."""
        return np.asarray(goal.merit_factor * goal.deviations(self.evaluator.goal_values(goal, z)))

    def growth(self, goal: Goal, z: FloatArray) -> FloatArray:
        """Derivatives of `values` with respect to the variables, shape (values, variables)."""
        return np.asarray(goal.merit_factor * self.evaluator.goal_growth(goal, z) / goal.scale)

    def objective(self, z: FloatArray) -> float:
        """Sum over the targets of the mean square of their deviations, or of the square of the worst one, in %²."""
        squares = [self.values(goal, z) ** 2 for goal in self.targets]
        over = zip(self.targets, squares, strict=True)
        return PERCENT * sum(float(np.max(each) if goal.over == "worst" else np.mean(each)) for goal, each in over)

    def worst_deviation(self, z: FloatArray) -> float:
        """Largest relative deviation from a target; 0 without targets."""
        try:
            return max((float(np.max(np.abs(self.values(goal, z)))) for goal in self.targets), default=0.0)
        except SolverError:
            return _NO_SKI

    def broken(self, z: FloatArray) -> float:
        """Largest relative violation of a limit or a linear constraint; 0 if all hold."""
        matrix, lowest = self.linear
        try:
            rooms = [float(np.min(self.values(goal, z))) for goal in self.limits]
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
    """Linear constraints a·z ≥ b of the scaled variables z: rows a and limits b, divided by the largest |a|."""
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
        for sign, limit in ((1.0, constraint.at_least), (-1.0, constraint.at_most)):
            if np.isfinite(limit):
                rows.append(sign * row / size)
                limits.append(sign * (limit - base) / size)
    return np.array(rows).reshape(-1, len(zero)), np.array(limits)
