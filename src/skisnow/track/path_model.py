"""The motion of a skier as a stochastic model: a point that runs along its heading.

State at each node of time: place x, y (m), heading θ (rad), turn rate ω (rad/s) and its rate η (rad/s²), speed v (m/s),
acceleration a (m/s²).

    ẋ = v cos θ + drift,  ẏ = v sin θ + drift,  θ̇ = ω,  ω̇ = η,  η̇ = -2 ζ Ω η - Ω² ω + noise,
    v̇ = a,  ȧ = -a / T + noise

The turn rate is a damped oscillation: linked turns to the left and right. The acceleration is an Ornstein-Uhlenbeck
process.

Speed and heading vary separately, so that a turn between two points bends the path and leaves the speed: a model in x
and y would slow down and speed up instead. The drift is that of the receiver, a random walk of the places.

`PathModel.fit` finds the most probable path by Gauss-Newton steps with a banded Cholesky factor, and the evidence of
the parameters by Laplace's approximation: Bell (1994), "The iterated Kalman smoother as a Gauss-Newton method", SIAM J.
Optim. 4, 626-636, doi 10.1137/0804035; Rue, Martino and Chopin (2009), J. R. Stat. Soc. B 71, 319-392.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.interpolate import make_interp_spline, make_smoothing_spline
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded, expm

from .._support.arrays import FloatArray, IntArray

DAMPING: Final = 0.07
"""Damping ratio ζ of the turn rate (modelling assumption: four or five linked turns resemble each other)."""
USUAL_SPEED: Final = (10.0, 30.0)
"""Mean and standard deviation (m/s) of the first speed (modelling assumption: hardly any information)."""
HEADING_PRECISION: Final = 1e-2
"""Precision of the first heading (1/rad²): hardly any information."""
STATES: Final = 7
_X, _TURN, _SPEED = slice(0, 2), slice(2, 5), slice(5, 7)
_THETA, _OMEGA, _V = 2, 3, 5
_MOST_STEPS: Final = 30
_SETTLED: Final = 1e-6
"""Relative decrease of the misfit at which a fit ends."""
_INITIAL_ACCELERATION: Final = 50.0
"""Spectral density (m²/s³) of the acceleration for the initial path (modelling assumption)."""
_ACCELERATION_AT_REST: Final = 0.05
"""The same for a point that does not move: otherwise the path would follow the noise."""
_RATE_AT_REST: Final = 0.7
"""Speed over noise (1/s) below which a point does not move (modelling assumption)."""


class TimeScales(NamedTuple):
    """Longest step between nodes, and correlation time T of the acceleration along the path (s)."""

    longest_step: float
    correlation_time: float


class MotionParameters(NamedTuple):
    """Parameters of the model.

    place_noise: standard deviation (m) of a coordinate, from point to point.
    turn_rate: standard deviation (rad/s) of the turn rate.
    period: 2π/Ω (s): of a turn to the left and one to the right.
    acceleration: standard deviation (m/s²) of the acceleration along the path.
    drift: random walk of the places (m/√s).
    """

    place_noise: float
    turn_rate: float
    period: float
    acceleration: float
    drift: float


@dataclass(frozen=True, slots=True)
class PathFit:
    """The most probable path of one set of parameters.

    state: (n, 7), at each node.
    factor: (14, 7 n), lower banded Cholesky factor of the precision of the state.
    log_evidence: logarithm of the evidence of the parameters, up to a constant of the nodes.
    """

    state: FloatArray
    factor: FloatArray
    log_evidence: float


class _Weights(NamedTuple):
    """Precisions of the transitions, and the part of the normal equations that does not depend on the state."""

    place: FloatArray
    turn: FloatArray
    speed: FloatArray
    band: FloatArray


class _Residuals(NamedTuple):
    """Residuals of places, points and both chains, values for their derivatives, and half their weighted squares."""

    place: FloatArray
    turn_pull: FloatArray
    speed_pull: FloatArray
    point: FloatArray
    turn: FloatArray
    mean_speed: FloatArray
    shortening: FloatArray
    direction: FloatArray
    misfit: float


class Chain:
    """Linear chain of states driven by white noise, as a prior, over steps of any length.

    dynamics: (k, k), of ẋ = dynamics x + (0, …, 0, 1) noise.
    density: Spectral density of the noise.
    step: (n,) s,
    """

    def __init__(self, dynamics: FloatArray, density: float, step: FloatArray) -> None:
        size = len(dynamics)
        lengths, which = np.unique(np.round(step, 6), return_inverse=True)
        noise = np.zeros((size, size))
        noise[-1, -1] = density
        loan = np.block([[-dynamics, noise], [np.zeros((size, size)), dynamics.T]])
        powers = expm(loan * lengths[:, None, None])  # Van Loan (1978), doi 10.1109/TAC.1978.1101743
        transition = powers[:, size:, size:].transpose(0, 2, 1)
        covariance = transition @ powers[:, :size, size:]
        scale = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
        correlation = covariance / (scale[:, :, None] * scale[:, None, :])
        precision = np.linalg.inv(correlation) / (scale[:, :, None] * scale[:, None, :])
        counts = np.bincount(which, minlength=len(lengths))
        log_determinant = np.linalg.slogdet(correlation)[1] + 2.0 * np.sum(np.log(scale), axis=1)
        self.transition: FloatArray = transition[which]
        self.precision: FloatArray = precision[which]
        self.log_scale = -0.5 * float(counts @ log_determinant)


class PathModel:
    """Model of the path through the points of one stretch without a gap; its nodes are at and between the points.

    time: Rising times of the points (s), (m,).
    place: Measured x and y of the points (m), (m, 2).
    scales: Times that depend on the interval between points.
    """

    def __init__(self, time: FloatArray, place: FloatArray, scales: TimeScales) -> None:
        counts = np.maximum(1, np.ceil(np.diff(time) / scales.longest_step - 1e-9)).astype(np.int64)
        self.points: IntArray = np.concatenate([[0], np.cumsum(counts)])
        self.count = int(self.points[-1]) + 1
        self.step: FloatArray = np.repeat(np.diff(time) / counts, counts)
        self.time: FloatArray = np.interp(np.arange(self.count), self.points, time)
        self.place = place
        dynamics = np.array([[0.0, 1.0], [0.0, -1.0 / scales.correlation_time]])
        self._speed = Chain(dynamics, 2.0 / scales.correlation_time, self.step)  # acceleration of unit variance
        self._turns: dict[float, Chain] = {}

    def initial_state(self, place_noise: float) -> FloatArray:
        """A path (n, 7) through places of this noise (m), from splines of x and y."""
        time = self.time[self.points]
        state = np.zeros((self.count, STATES))
        velocity, slow_velocity = np.zeros((self.count, 2)), np.zeros((self.count, 2))
        for axis in range(2):
            values = self.place[:, axis]
            if len(time) < 5:
                spline = slow = make_interp_spline(time, values, k=1)
            else:
                spline, slow = (
                    make_smoothing_spline(time, values, lam=max(place_noise**2 / density, 1e-8))
                    for density in (_INITIAL_ACCELERATION, _ACCELERATION_AT_REST)
                )
            state[:, axis], velocity[:, axis] = spline(self.time), spline.derivative()(self.time)
            slow_velocity[:, axis] = slow.derivative()(self.time)
        at_rest = np.hypot(*slow_velocity.T) < place_noise * _RATE_AT_REST
        velocity[at_rest] = slow_velocity[at_rest]
        state[:, _THETA] = np.unwrap(np.arctan2(velocity[:, 1], velocity[:, 0]))
        state[:, _OMEGA] = np.gradient(state[:, _THETA], self.time)
        state[:, _V] = np.hypot(*velocity.T)
        return state

    def fit(self, parameters: MotionParameters, state: FloatArray) -> PathFit | None:
        """The most probable path, from an initial one; None if the steps fail."""
        weights = self._weights(parameters)
        residuals = self._residuals(state, parameters, weights)
        damping = 0.0
        factor = None
        for _ in range(_MOST_STEPS):
            band, gradient = self._normal_equations(state, residuals, parameters, weights)
            while True:
                damped = band.copy()
                damped[0] *= 1.0 + damping
                try:
                    factor = cholesky_banded(damped, overwrite_ab=True, lower=True, check_finite=False)
                except LinAlgError:
                    return None
                change = cho_solve_banded((factor, True), gradient.ravel(), check_finite=False)
                moved = state - change.reshape(-1, STATES)
                moved_residuals = self._residuals(moved, parameters, weights)
                if moved_residuals.misfit <= residuals.misfit * (1.0 + 1e-9) + 1e-9:
                    break
                damping = max(5.0 * damping, 1e-4)
                if not damping < 1e6:
                    return None
            decrease = residuals.misfit - moved_residuals.misfit
            state, residuals = moved, moved_residuals
            if damping == 0.0 and decrease < _SETTLED * max(1.0, residuals.misfit) and decrease < 1e-2:
                break
            damping = damping / 10.0 if damping > 1e-4 else 0.0
        assert factor is not None
        evidence = self._log_prior_scale(parameters) - residuals.misfit - float(np.sum(np.log(factor[0])))
        return PathFit(state, factor, evidence) if np.isfinite(evidence) else None

    def _weights(self, parameters: MotionParameters) -> _Weights:
        """Precisions, and the part of the normal equations that they determine."""
        place = 1.0 / (parameters.drift**2 * self.step)
        turn = self._turn_chain(parameters).precision / parameters.turn_rate**2
        speed = self._speed.precision / parameters.acceleration**2
        band = np.zeros((2 * STATES, self.count, STATES))
        band[STATES, :-1, _X] = -place[:, None]
        band[0, :-1, _X] += place[:, None]
        band[0, 1:, _X] += place[:, None]
        band[0, self.points, _X] += 1.0 / parameters.place_noise**2
        band[0, 0] += _first_precision(parameters)
        for precision, chain, first in ((turn, self._turn_chain(parameters), _THETA), (speed, self._speed, _V)):
            below = -precision @ chain.transition
            before = -chain.transition.transpose(0, 2, 1) @ below
            for row, column in itertools.product(range(precision.shape[1]), repeat=2):
                band[STATES + row - column, :-1, first + column] += below[:, row, column]
                if row >= column:
                    band[row - column, :-1, first + column] += before[:, row, column]
                    band[row - column, 1:, first + column] += precision[:, row, column]
        return _Weights(place, turn, speed, band)

    def _turn_chain(self, parameters: MotionParameters) -> Chain:
        """Chain of the heading, the turn rate of unit variance, and its rate."""
        if parameters.period not in self._turns:
            angular = 2.0 * np.pi / parameters.period
            dynamics = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, -(angular**2), -2.0 * DAMPING * angular]])
            self._turns[parameters.period] = Chain(dynamics, 4.0 * DAMPING * angular**3, self.step)
        return self._turns[parameters.period]

    def _log_prior_scale(self, parameters: MotionParameters) -> float:
        """Logarithm of the normalising factors of all Gaussian densities of the model, up to a constant."""
        steps, points = len(self.step), len(self.points)
        turn, speed = np.log(parameters.turn_rate), np.log(parameters.acceleration)
        scale = -(3 * steps + 2) * turn - (2 * steps + 1) * speed - 2 * steps * np.log(parameters.drift)
        scale += self._turn_chain(parameters).log_scale + self._speed.log_scale + np.log(parameters.period)
        return float(scale - 2 * points * np.log(parameters.place_noise))

    def _residuals(self, state: FloatArray, parameters: MotionParameters, weights: _Weights) -> _Residuals:
        """Residuals; over a step with the turn Δθ the chord is shorter than the arc by 1 - Δθ²/24."""
        heading, speed = state[:, _THETA], state[:, _V]
        turn = np.diff(heading)
        middle = (heading[1:] + heading[:-1]) / 2.0
        mean_speed = (speed[1:] + speed[:-1]) / 2.0
        shortening = 1.0 - turn**2 / 24.0
        direction = np.stack([np.cos(middle), np.sin(middle)], axis=1)
        place = np.diff(state[:, _X], axis=0) - (self.step * mean_speed * shortening)[:, None] * direction
        turns = state[1:, _TURN] - _times(self._turn_chain(parameters).transition, state[:-1, _TURN])
        speeds = state[1:, _SPEED] - _times(self._speed.transition, state[:-1, _SPEED])
        pulls = _times(weights.turn, turns), _times(weights.speed, speeds)
        point = state[self.points, _X] - self.place
        misfit = weights.place @ np.sum(place**2, axis=1) + np.sum(turns * pulls[0]) + np.sum(speeds * pulls[1])
        misfit += np.sum(point**2) / parameters.place_noise**2
        misfit += np.sum(_first_precision(parameters) * (state[0] - _FIRST) ** 2)
        return _Residuals(place, *pulls, point, turn, mean_speed, shortening, direction, 0.5 * float(misfit))

    def _normal_equations(
        self, state: FloatArray, residuals: _Residuals, parameters: MotionParameters, weights: _Weights
    ) -> tuple[FloatArray, FloatArray]:
        """Lower banded matrix (14, 7 n) and gradient (n, 7) of the misfit."""
        band, gradient = weights.band.copy(), np.zeros((self.count, STATES))
        gradient[self.points, _X] = residuals.point / parameters.place_noise**2
        gradient[0] += _first_precision(parameters) * (state[0] - _FIRST)
        for part, chain, pull in (
            (_TURN, self._turn_chain(parameters), residuals.turn_pull),
            (_SPEED, self._speed, residuals.speed_pull),
        ):
            gradient[1:, part] += pull
            gradient[:-1, part] -= _times(chain.transition.transpose(0, 2, 1), pull)
        by_turn = self.step * residuals.mean_speed * residuals.turn / 12.0
        half_chord = 0.5 * self.step * residuals.mean_speed * residuals.shortening
        one = np.ones(len(self.step))
        for axis in range(2):
            along, across = residuals.direction[:, axis], (2 * axis - 1) * residuals.direction[:, 1 - axis]
            by_speed = -0.5 * self.step * residuals.shortening * along
            before = -one, -by_turn * along - half_chord * across, by_speed
            after = one, by_turn * along - half_chord * across, by_speed
            columns = axis, _THETA, _V
            pull = weights.place * residuals.place[:, axis]
            for column, earlier, later in zip(columns, before, after, strict=True):
                gradient[:-1, column] += pull * earlier
                gradient[1:, column] += pull * later
            for row, column in itertools.product(range(3), repeat=2):
                offset, left = columns[row] - columns[column], columns[column]
                if row == column == 0:  # in the constant part
                    continue
                band[STATES + offset, :-1, left] += weights.place * after[row] * before[column]
                if row >= column:
                    band[offset, :-1, left] += weights.place * before[row] * before[column]
                    band[offset, 1:, left] += weights.place * after[row] * after[column]
        return band.reshape(2 * STATES, -1), gradient


def _times(matrices: FloatArray, vectors: FloatArray) -> FloatArray:
    """Products (n, k) of matrices (n, k, k) and vectors (n, k)."""
    return np.einsum("nij,nj->ni", matrices, vectors)


_FIRST: Final = np.array([0.0, 0.0, 0.0, 0.0, 0.0, USUAL_SPEED[0], 0.0])
"""Mean of the first state."""


def _first_precision(parameters: MotionParameters) -> FloatArray:
    """Precision (7,) of the first state; the place is free, the heading nearly so."""
    turn = parameters.turn_rate**-2
    rate = turn * (parameters.period / (2.0 * np.pi)) ** 2
    return np.array([0.0, 0.0, HEADING_PRECISION, turn, rate, USUAL_SPEED[1] ** -2, parameters.acceleration**-2])
