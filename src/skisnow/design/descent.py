"""Smallest deviations within limits from one start: least squares of lines in a trust region.

At a kink the lines of one side mislead: the step also keeps to those of the last rejected design.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np

from .._support.arrays import FloatArray
from .._support.errors import SolverError
from .evaluation import PERCENT, REACHED, Search

_TOLERANCE: Final = 5e-6  # gain of the objective
_POLISHED_TOLERANCE: Final = 1e-7  # the same for the best start
_FIRST_REACH: Final = 0.3  # of a step, in each variable
_MOST_TRIALS: Final = 60
_MOST_STEPS: Final = 20  # to the nearest design
_CLOSE: Final = 1e-5  # last step to it
_POOR: Final = 0.25  # share of the expected gain below which the reach is halved
_GOOD: Final = 0.75  # and above which it is twice the step
_NEAR: Final = 0.02  # distance of a design whose lines are still trusted at the end
_FLAT: Final = 1e-3  # weight of the variables: of two steps with the same deviations the shorter
_BREACH: Final = 1e3  # weight of a limit that the step breaks
_LARGEST_WEIGHT: Final = 100.0  # largest weight of a broken limit against the squares
_ROUNDING: Final = 1e-13


@dataclass(frozen=True, slots=True, eq=False)
class _LinearModel:
    """Linear model at a design z: deviations from targets, distances to limits; `growth`: their derivatives by z."""

    z: FloatArray
    values: FloatArray
    growth: FloatArray


class Descent:
    """Trust-region search that minimises the squared deviations from the targets and the violations of the limits."""

    def __init__(self, search: Search) -> None:
        self.search = search
        ends = np.cumsum([0, *(search.evaluator.value_count(goal) for goal in search.targets)]).tolist()
        parts = [slice(begin, end) for begin, end in itertools.pairwise(ends)]
        over_mean = [goal.over == "mean" for goal in search.targets]
        self.means = [part for part, mean in zip(parts, over_mean, strict=True) if mean]
        self.worst = [part for part, mean in zip(parts, over_mean, strict=True) if not mean]
        self.rooms = slice(ends[-1], None)
        self.weight, self.reach, self.best = 1.0, _FIRST_REACH, (np.inf, np.zeros(0))

    def run(self, z: FloatArray, *, polish: bool = False) -> FloatArray:
        """Design variables (n,) with the smallest deviations from the targets, searched from z.

        If all targets are reached, those with the least change of the ski.
        polish: True from the best end of several starts, to a smaller tolerance.
        """
        search = self.search
        if search.targets:
            z = self._smallest(z, (_POLISHED_TOLERANCE if polish else _TOLERANCE) / PERCENT)
            if search.worst_deviation(z) > 1e-3 or self.rooms.start > search.count:
                return z
        try:
            near = self._nearest(z, search.evaluator.start)
        except SolverError:
            return z
        return near if search.broken(near) <= REACHED and search.worst_deviation(near) <= REACHED else z

    def _smallest(self, z: FloatArray, tolerance: float) -> FloatArray:
        """Best design found from z; the search ends if the predicted gain is below the tolerance."""
        self.best = self.search.result(z), z
        here, beside = self._linearise(z), None
        for _ in range(_MOST_TRIALS):
            lines = [here] if beside is None else [here, self._cut(here, beside)]
            step = self._step(lines)
            value = self._merit(here.values)
            gain = value - self._merit(*(each.values + each.growth @ step for each in lines))
            if gain >= tolerance:
                share = self._share_of_gain(here.z + step, value, gain, float(np.max(np.abs(step))))
                if share > 0.0:
                    here = self._linearise(here.z + step)
                elif np.isfinite(share):
                    beside = self._linearise(here.z + step)
            elif beside is not None and np.max(np.abs(beside.z - here.z)) > _NEAR:
                beside = None
            elif self.weight < _LARGEST_WEIGHT and self.search.broken(here.z) > REACHED:
                self.weight *= 10.0
            else:
                break
        return self.best[1]

    def _share_of_gain(self, trial: FloatArray, value: float, gain: float, size: float) -> float:
        """Actual over predicted gain of a trial, which sets the trust region; -∞ without ski or equilibrium."""
        try:
            share = (value - self._merit(self._deviations_and_distances(trial))) / gain
        except SolverError:
            self.reach = size / 4.0
            return -np.inf
        self.best = min(self.best, (self.search.result(trial), trial), key=lambda each: each[0])
        self.reach = size / 2.0 if share < _POOR else max(self.reach, 2.0 * size) if share > _GOOD else self.reach
        return share

    def _nearest(self, z: FloatArray, home: FloatArray) -> FloatArray:
        """Design nearest to `home` that reaches all targets and keeps all limits, from z, which nearly does."""
        one, end, moved, full = np.eye(len(z)), self.rooms.start, np.zeros(len(z)), np.zeros(len(z))
        for _ in range(_MOST_STEPS):
            here, (low, high) = self._linearise(z), _ends(z, _FIRST_REACH)
            rows = np.vstack([here.growth, -here.growth[:end], one, -one])
            least = np.concatenate([-here.values, here.values[:end], low, -high])
            step = np.clip(_least_squares(one, home - z, rows, least), low, high)
            # where the targets' lines turn, full steps swing about the end: a secant shortens them
            falls = float(moved @ (full - step))
            moved, full = (min(1.0, float(moved @ moved) / falls) if falls > 0.0 else 1.0) * step, step
            if np.max(np.abs(step)) < _CLOSE:
                return z + step
            z = z + moved
        return z

    def _deviations_and_distances(self, z: FloatArray) -> FloatArray:
        """Deviations from targets and limits at a design z, then distances to the linear constraints."""
        search, (matrix, lowest) = self.search, self.search.linear
        values = [search.values(goal, z) for goal in (*search.targets, *search.limits)]
        return np.concatenate([*values, matrix @ z - lowest])

    def _linearise(self, z: FloatArray) -> _LinearModel:
        """Linear model at a design z: deviations and their derivatives."""
        search = self.search
        growths = [search.growth(goal, z) for goal in (*search.targets, *search.limits)]
        return _LinearModel(z, self._deviations_and_distances(z), np.concatenate([*growths, search.linear[0]]))

    def _merit(self, *values: FloatArray) -> float:
        """Value to minimise: squared deviations plus weighted violation, the worst of several linear predictions."""
        squares = [float(np.mean(values[0][part] ** 2)) for part in self.means]
        squares += [max(float(np.max(each[part] ** 2)) for each in values) for part in self.worst]
        rooms = np.min(values, axis=0)[self.rooms]
        return sum(squares) - self.weight * min(0.0, float(np.min(rooms, initial=0.0)))

    def _cut(self, here: _LinearModel, beside: _LinearModel) -> _LinearModel:
        """Linear model of design `beside`, shifted so that it predicts nothing worse than the values of `here`."""
        values = beside.values + beside.growth @ (here.z - beside.z)
        for part in self.worst:
            largest = np.max(np.abs(here.values[part]))
            values[part] = np.clip(values[part], -largest, largest)
        values[self.rooms] = np.maximum(values[self.rooms], here.values[self.rooms])
        return _LinearModel(here.z, values, beside.growth)

    def _step(self, lines: list[_LinearModel]) -> FloatArray:
        """Step (n,) that minimises the squares of the linear models, inside trust region and bounds.

        Unknowns: the step, a bound of each worst deviation, and the largest breach of a limit.
        """
        z, (low, high) = lines[0].z, _ends(lines[0].z, self.reach)
        count, one = len(z), np.eye(len(z) + len(self.worst) + 1)
        means = [(part, np.sqrt(part.stop - part.start)) for part in self.means]
        squares = [lines[0].growth[part] @ one[:count] / size for part, size in means]
        weights = np.diag([*[_FLAT] * count, *[1.0] * len(self.worst), _BREACH])
        wanted = [*(-lines[0].values[part] / size for part, size in means), np.zeros(len(one))]
        rows, least = [one[:count], -one[:count], one[-1:]], [low, -high, np.zeros(1)]
        for line in lines:
            growth = line.growth @ one[:count]
            for bound, part in zip(one[count:-1], self.worst, strict=True):
                rows += [bound + growth[part], bound - growth[part]]
                least += [-line.values[part], line.values[part]]
            rows.append(growth[self.rooms] + one[-1])
            least.append(-line.values[self.rooms])
        found = _least_squares(
            np.vstack([*squares, weights]), np.concatenate(wanted), np.vstack(rows), np.concatenate(least)
        )
        return np.clip(found[:count], low, high)


def _ends(z: FloatArray, reach: float) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest steps (n,) from z, inside the trust region and the bounds."""
    return np.maximum(-z, -reach), np.minimum(1.0 - z, reach)


def _least_squares(matrix: FloatArray, wanted: FloatArray, rows: FloatArray, least: FloatArray) -> FloatArray:
    """Least-squares solution x of matrix x = wanted with rows x ≥ least; zeros where rounding errors hide it.

    By the least distance and its dual. Source: C. L. Lawson and R. J. Hanson (1974), Solving least squares problems,
    chapter 23.
    """
    from scipy.optimize import nnls

    orthogonal, upper = np.linalg.qr(matrix)
    nearest = orthogonal.T @ wanted
    by_distance = np.linalg.solve(upper.T, rows.T)
    dual = np.vstack([by_distance, least - nearest @ by_distance])
    end = np.eye(1, len(dual), len(dual) - 1)[0]
    try:
        residual = dual @ nnls(dual, end)[0] - end
    except RuntimeError:
        residual = 0.0 * end
    if not residual[-1] < -_ROUNDING:
        return np.zeros(len(upper))
    return np.asarray(np.linalg.solve(upper, nearest - residual[:-1] / residual[-1]))
