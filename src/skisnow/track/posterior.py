"""Posterior distribution of the parameters of a track's motion as weighted points.

The evidence of the parameters is maximised for each of several accelerations. Its curvature there gives points that
represent the distribution (Rue, Martino and Chopin 2009, doi 10.1111/j.1467-9868.2008.00700.x). One acceleration is
nearly 0 and has half of the prior probability: noise at constant speed must not increase the maximum speed.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from .._support.arrays import FloatArray
from .path_model import MotionParameters, PathModel

PRIOR_MEAN: Final = np.log(np.array([0.5, 0.8, 0.15]))
PRIOR_SD: Final = np.array([1.5, 0.8, 1.3])
"""Prior of the logarithms of place noise (m), turn rate (rad/s) and drift (m/√s) (modelling assumption)."""
ACCELERATIONS: Final = np.concatenate([[1e-4], np.geomspace(1e-3, 2.7, 7)[1:]])
"""Standard deviations (m/s²) of the acceleration along the path.

The speed wanders by σ √(2 T t): with the first one by 0.002 m/s in a minute. With 0.001 m/s² it would wander by as
much as places within 5 cm resolve, and a highest speed would always exceed a constant one.
"""
LOG_PRIOR: Final = np.log(np.array([6.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]) / 12.0)
"""Logarithms of the prior probabilities of the accelerations (modelling assumption)."""
PERIODS: Final = (3.0, 4.2, 6.0, 8.5, 12.0, 17.0)
"""Periods (s) of the turn rate that are tried."""
_STARTS: Final = ((0.05, 0.3, 1.0), (0.3, 1.0))
"""Place noises (m) and turn rates (rad/s) with which the search begins."""
_SLOW, _FAST = 1, 4
"""Numbers of the accelerations with which the search begins."""
_FARTHEST: Final = 9.0
_DIFFERENCE: Final = 0.25
"""Step of the logarithms for differences."""
_LEAST_CURVATURE: Final = 0.2
_NEGLIGIBLE: Final = 8.0
"""Difference of log evidence beyond which a point has no weight."""


class WeightedParameters(NamedTuple):
    """Parameters and the logarithm of their weight."""

    parameters: MotionParameters
    log_weight: float


@dataclass(slots=True)
class _Optimum:
    """Maximum of the posterior density for one acceleration.

    logs: logarithms of place noise, turn rate and drift.
    value: logarithm of the density.
    state: fitted path.
    root: matrix R with the covariance R Rᵀ of `logs`.
    """

    logs: FloatArray
    value: float
    state: FloatArray
    root: FloatArray


class _Search:
    """Log posterior density of the place noise, turn rate and drift of one stretch, and its maximum."""

    def __init__(self, model: PathModel, period: float) -> None:
        self.model, self.period = model, period

    def parameters(self, logs: FloatArray, acceleration: float) -> MotionParameters:
        """Parameters of the motion from logarithms of place noise, turn rate and drift, and an acceleration (m/s²)."""
        place_noise, turn_rate, drift = np.exp(logs).tolist()
        return MotionParameters(place_noise, turn_rate, self.period, acceleration, drift)

    def value(self, logs: FloatArray, acceleration: float, state: FloatArray) -> tuple[float, FloatArray]:
        """Log density, and the path; minus infinity if no path can be fitted."""
        if np.any(np.abs(logs - PRIOR_MEAN) > _FARTHEST):
            return -np.inf, state
        fit = self.model.fit(self.parameters(logs, acceleration), state)
        if fit is None:
            return -np.inf, state
        return fit.log_evidence - 0.5 * float(np.sum(((logs - PRIOR_MEAN) / PRIOR_SD) ** 2)), fit.state

    def optimum(self, logs: FloatArray, acceleration: float, state: FloatArray) -> _Optimum | None:
        """The maximum of the density for one acceleration, by Newton's steps with differences."""
        value, state = self.value(logs, acceleration, state)
        if not np.isfinite(value):
            return None
        root = np.diag(PRIOR_SD)
        for _ in range(4):
            gradient, root = self._curvature(logs, acceleration, state, value)
            step = root @ (root.T @ gradient)
            step *= min(1.0, 2.0 / max(float(np.linalg.norm(step)), 1e-9))
            for share in (1.0, 0.3, 0.1):
                better, moved = self.value(logs + share * step, acceleration, state)
                if better > value - 1e-3:
                    break
            else:
                break
            gain, logs, value, state = better - value, logs + share * step, better, moved
            if gain < 0.05:
                break
        return _Optimum(logs, value, state, root)

    def _curvature(
        self, logs: FloatArray, acceleration: float, state: FloatArray, value: float
    ) -> tuple[FloatArray, FloatArray]:
        """Gradient (3,), and a root (3, 3) of the inverse of the negative second derivatives."""
        size = len(logs)
        shifts = _DIFFERENCE * np.eye(size)

        def at(shift: FloatArray) -> float:
            return max(self.value(logs + shift, acceleration, state)[0], value - 50.0)

        above, below = [at(shift) for shift in shifts], [at(-shift) for shift in shifts]
        gradient = (np.array(above) - np.array(below)) / (2.0 * _DIFFERENCE)
        second = np.diag((np.array(above) + np.array(below) - 2.0 * value) / _DIFFERENCE**2)
        for one, other in itertools.combinations(range(size), 2):
            mixed = at(shifts[one] + shifts[other]) - above[one] - above[other] + value
            second[one, other] = second[other, one] = mixed / _DIFFERENCE**2
        curvatures, directions = np.linalg.eigh(-second)
        return gradient, directions / np.sqrt(np.maximum(np.abs(curvatures), _LEAST_CURVATURE))


def likely_parameters(model: PathModel) -> list[WeightedParameters]:
    """Weighted points that represent the posterior distribution of the parameters.

    model: a stretch with at most a few hundred points.
    Returns: at least one point, unless no path at all can be fitted.
    """
    search, start = _best_start(model)
    if start is None:
        return []
    optima: list[_Optimum | None] = [None] * len(ACCELERATIONS)
    optima[start[0]] = search.optimum(start[1], float(ACCELERATIONS[start[0]]), start[2])
    for numbers in (range(start[0] - 1, -1, -1), range(start[0] + 1, len(ACCELERATIONS))):
        before = optima[start[0]]
        for number in numbers:
            if before is None:
                break
            before = optima[number] = search.optimum(before.logs, float(ACCELERATIONS[number]), before.state)
            best = max(other.value for other in optima if other is not None)
            if before is not None and before.value < best - 2.0 * _NEGLIGIBLE:
                break
    return _points(search, optima)


def _best_start(model: PathModel) -> tuple[_Search, tuple[int, FloatArray, FloatArray] | None]:
    """A search with the best period, and the best acceleration, logarithms and path among the starts."""
    noises, turn_rates = _STARTS
    initial = {noise: model.initial_state(noise) for noise in noises}
    best, search, start = -np.inf, _Search(model, PERIODS[0]), None
    for number, periods in ((_SLOW, PERIODS), (_FAST, None)):
        for period in (search.period,) if periods is None else periods:
            tried = _Search(model, period)
            for noise, turn_rate in itertools.product(noises, turn_rates):
                logs = np.array([np.log(noise), np.log(turn_rate), PRIOR_MEAN[2]])
                value, state = tried.value(logs, float(ACCELERATIONS[number]), initial[noise])
                if value > best:
                    best, search, start = value, tried, (number, logs, state)
    return search, start


def _points(search: _Search, optima: list[_Optimum | None]) -> list[WeightedParameters]:
    """Cubature points about each optimum that has weight."""
    volumes = [0.0 if optimum is None else float(np.linalg.slogdet(optimum.root)[1]) for optimum in optima]
    masses = [
        -np.inf if optimum is None else optimum.value + volume + prior
        for optimum, volume, prior in zip(optima, volumes, LOG_PRIOR, strict=True)
    ]
    points = []
    for number, optimum in enumerate(optima):
        if optimum is None or masses[number] < max(masses) - _NEGLIGIBLE:
            continue
        acceleration, size = float(ACCELERATIONS[number]), len(optimum.logs)
        for sign, axis in itertools.product((1.0, -1.0), range(size)):
            logs = optimum.logs + sign * np.sqrt(size) * optimum.root[:, axis]
            value, _ = search.value(logs, acceleration, optimum.state)
            weight = value + 0.5 * size + volumes[number] + LOG_PRIOR[number]
            if np.isfinite(weight):
                points.append(WeightedParameters(search.parameters(logs, acceleration), float(weight)))
    return points
