"""Bounded least squares for simulated residuals: the Levenberg-Marquardt method in batches.

All runs of a Jacobian are simulated in one batch, and so are trial steps of several lengths. Finite differences take
large steps, 1 to 5 % of a parameter's size: smaller ones show switching contacts instead of the trend.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np
from scipy.optimize import lsq_linear

from .._support.arrays import FloatArray

Residuals: TypeAlias = Callable[[Sequence[FloatArray]], list[FloatArray | None]]
"""Function from places of the search to their residuals, all in one batch; None for a place without residuals."""
State: TypeAlias = Literal["converged", "not_converged", "interrupted"]
Progress: TypeAlias = Callable[[str], None]

_SMALLEST_DAMPING, _LARGEST_DAMPING = 1e-9, 1e9
_FIRST_DAMPING: Final = 1e-3
_SLIGHT: Final = 3.0
"""Change of the residuals (in standard deviations of one) up to which a Jacobian stays valid after a long move."""
_PREDICTED_FALL: Final = 0.5
"""The Jacobian is computed again if the sum of squares fell by less than this share of the predicted fall."""
_AT_BOUND: Final = 1e-9
"""Distance (sizes) from a bound that counts as on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchOptions:
    """Step sizes and stopping rules of a search; lengths are in parameters' sizes.

    smallest_step, largest_step: limits of the finite-difference step; between them it is the parameter's current
        standard error.
    tolerance: the search converged if a full step moves the residuals by fewer standard deviations of one residual.
    worth: smallest fall of the sum of squares, in squared standard deviations, for which the search continues.
    rough: numerical roughness of the residuals in standard deviations: the search also converged if no step improves
        and the remaining gain is smaller.
    keeps_jacobian: distance from its place up to which a Jacobian is used again; 0: it is always computed again.
    longest_move: longest step of a parameter.
    smallest_move: the search converged if a full step is shorter (for data without noise).
    most_rounds: maximum number of Jacobians.
    candidates: number of trial steps in one batch.
    accuracy_is_stated: True if residuals have a standard deviation of 1; otherwise it is estimated from them.
    """

    smallest_step: float = 0.01
    largest_step: float = 0.05
    tolerance: float = 0.2
    worth: float = 0.3
    rough: float = 1.0
    keeps_jacobian: float = 0.1
    longest_move: float = 0.25
    smallest_move: float = 1e-5
    most_rounds: int = 30
    candidates: int = 2
    accuracy_is_stated: bool = False


CLOSED_FORM_SEARCH: Final = SearchOptions(
    smallest_step=1e-3,
    largest_step=1e-3,
    tolerance=1e-5,
    worth=1e-10,
    rough=1e-2,
    keeps_jacobian=0.0,
    longest_move=5.0,
    smallest_move=1e-9,
    most_rounds=100,
)
"""For residuals in closed form or nearly so."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchState:
    """Current or final place of a search.

    place: (p,) in sizes from the start.
    residuals, jacobian, second: residuals (n,), their derivatives (n, p), and second differences along each parameter
        (n, p); None if not computed yet.
    state: outcome of the search.
    rounds: number of Jacobians computed by central differences.
    differentiated_at, is_central, is_trusted: place of the derivatives; True if they are central differences; True if
        they predicted the last step well.
    """

    place: FloatArray
    residuals: FloatArray
    jacobian: FloatArray | None = None
    second: FloatArray | None = None
    state: State = "interrupted"
    rounds: int = 0
    differentiated_at: FloatArray | None = None
    is_central: bool = False
    is_trusted: bool = True

    @property
    def cost(self) -> float:
        """Sum of squares."""
        return float(self.residuals @ self.residuals)


@dataclass(slots=True)
class Search:
    """Search for the minimum of a sum of squares.

    lower, upper: bounds (p,), in sizes from the start.
    progress: called with a line of text after each round.
    best: best place so far.
    """

    residuals: Residuals
    lower: FloatArray
    upper: FloatArray
    options: SearchOptions
    progress: Progress = field(default=lambda _: None)
    best: SearchState | None = None

    def run(self, start: FloatArray) -> SearchState | None:
        """Search from a place; return None if the residuals cannot be computed there.

        Ctrl-C ends the search: it returns the best place so far with the state "interrupted". Before the first
        residuals KeyboardInterrupt is raised.
        """
        try:
            self.best = self._begin(start)
            return None if self.best is None else self._iterate()
        except KeyboardInterrupt:
            if self.best is None:
                raise
            return replace(self.best, state="interrupted")

    def _iterate(self) -> SearchState:
        damping = _FIRST_DAMPING
        for _ in range(self.options.most_rounds):
            here = self._with_jacobian(self._require_best())
            left = self._in_noise(here, self._full_step(here))
            ends = left <= self.options.tolerance or self._settled(here)
            if ends and here.is_central:
                return replace(here, state="converged")
            if ends:
                self._differentiate(here)
                continue
            better, damping = self._step_on(here, damping)
            if better is not None:
                self.best = better
            if better is None or here.cost - better.cost < self.options.worth * self.noise(here) ** 2:
                if here.is_central and here.differentiated_at is here.place:
                    return replace(
                        self._require_best(), state="converged" if left <= self.options.rough else "not_converged"
                    )
                self._differentiate(self._require_best())
                damping = _FIRST_DAMPING
        return replace(self._differentiate(self._require_best()), state="not_converged")

    def _require_best(self) -> SearchState:
        assert self.best is not None
        return self.best

    def _with_jacobian(self, state: SearchState) -> SearchState:
        """Return the state with a valid Jacobian; it is computed again if one-sided, too far away, or inaccurate."""
        if state.jacobian is None or state.differentiated_at is None:
            return self._differentiate(state)
        away = state.place - state.differentiated_at
        if not np.any(away):
            return state
        far = np.max(np.abs(away)) > self.options.keeps_jacobian and self._in_noise(state, away) > min(
            _SLIGHT, 1e3 * self.options.keeps_jacobian
        )
        if far or not state.is_central or not state.is_trusted:
            return self._differentiate(state)
        return state

    def _differentiate(self, state: SearchState) -> SearchState:
        jacobian, second = self._differences(state)
        renewed = replace(
            state,
            jacobian=jacobian,
            second=second,
            differentiated_at=state.place,
            is_central=True,
            is_trusted=True,
            rounds=state.rounds + 1,
        )
        self.best = renewed
        self.progress(f"round {renewed.rounds}: rms residual {np.sqrt(renewed.cost / len(renewed.residuals)):.4g}")
        return renewed

    def _begin(self, start: FloatArray) -> SearchState | None:
        """Residuals and one-sided derivatives at the start, computed in one batch."""
        places = [start]
        steps = np.full(len(start), np.sqrt(self.options.smallest_step * self.options.largest_step))
        for j, step in enumerate(steps):
            place = start.copy()
            place[j] += step if start[j] + step <= self.upper[j] else -step
            places.append(np.clip(place, self.lower, self.upper))
        batch = self.residuals(places)
        first = batch[0]
        if first is None:
            return None
        ends = [(places[j + 1][j] - start[j], batch[j + 1]) for j in range(len(start))]
        jacobian = np.column_stack([_slope_and_bend([end], first)[0] for end in ends])
        return SearchState(start, first, jacobian, np.zeros_like(jacobian), differentiated_at=start)

    def polish(self, state: SearchState, residuals: Residuals, *, most: int = 2) -> SearchState:
        """Take at most `most` steps with other, more expensive residuals and the current Jacobian; return the best."""
        assert state.jacobian is not None
        first = residuals([state.place])[0]
        if first is None:
            return state
        best = here = replace(state, residuals=first)
        self.best = best
        for _ in range(most):
            step = self._full_step(here)
            if self._in_noise(here, step) <= self.options.tolerance:
                break
            dearer = residuals([here.place + step])[0]
            if dearer is None:
                break
            here = replace(here, place=here.place + step, residuals=dearer)
            if here.cost >= best.cost:
                break
            self.best = best = here
        return best

    def noise(self, state: SearchState) -> float:
        """Standard deviation of a residual: one where it is stated, else estimated."""
        if self.options.accuracy_is_stated:
            return 1.0
        return float(np.sqrt(state.cost / max(len(state.residuals) - len(state.place), 1)))

    def _in_noise(self, state: SearchState, step: FloatArray) -> float:
        assert state.jacobian is not None
        noise = self.noise(state)
        return float(np.linalg.norm(state.jacobian @ step)) / noise if noise > 0.0 else 0.0

    def _settled(self, state: SearchState) -> bool:
        return float(np.max(np.abs(self._full_step(state)), initial=0.0)) <= self.options.smallest_move

    def _full_step(self, state: SearchState) -> FloatArray:
        return self._step(state, _SMALLEST_DAMPING)

    def _step(self, state: SearchState, damping: float) -> FloatArray:
        """Damped step inside the bounds and no longer than `longest_move`."""
        assert state.jacobian is not None
        low = np.maximum(self.lower - state.place, -self.options.longest_move)
        high = np.minimum(self.upper - state.place, self.options.longest_move)
        return step_inside(state.jacobian, state.residuals, low, high, damping=damping)

    def _step_on(self, state: SearchState, damping: float) -> tuple[SearchState | None, float]:
        """Best of several trial steps and the next damping; None if even the shortest step does not improve."""
        for _ in range(4):
            dampings = [damping * 10.0 ** (2 * i - 1) for i in range(self.options.candidates)]
            steps = [self._step(state, trial_damping) for trial_damping in dampings]
            places = [np.clip(state.place + step, self.lower, self.upper) for step in steps]
            tried = self.residuals(places)
            costs = [np.inf if residuals is None else float(residuals @ residuals) for residuals in tried]
            number = int(np.argmin(costs))
            best = tried[number]
            if best is not None and costs[number] < state.cost:
                return _moved(state, places[number], best), max(dampings[number] / 3.0, _SMALLEST_DAMPING)
            damping = min(dampings[-1] * 10.0, _LARGEST_DAMPING)
        return None, damping

    def _differences(self, state: SearchState) -> tuple[FloatArray, FloatArray]:
        """Central differences; one-sided next to a bound or next to a place without residuals."""
        steps = self._difference_steps(state)
        places = []
        for j, step in enumerate(steps):
            for sign in (1.0, -1.0):
                place = state.place.copy()
                place[j] = np.clip(place[j] + sign * step, self.lower[j], self.upper[j])
                places.append(place)
        batch = self.residuals(places)
        jacobian = np.zeros((len(state.residuals), len(steps)))
        second = np.zeros_like(jacobian)
        for j in range(len(steps)):
            ends = [(places[i][j] - state.place[j], batch[i]) for i in (2 * j, 2 * j + 1)]
            jacobian[:, j], second[:, j] = _slope_and_bend(ends, state.residuals)
        return jacobian, second

    def _difference_steps(self, state: SearchState) -> FloatArray:
        low, high = self.options.smallest_step, self.options.largest_step
        if state.jacobian is None or low == high:
            return np.full(len(state.place), np.sqrt(low * high))
        length = np.linalg.norm(state.jacobian, axis=0)
        with np.errstate(divide="ignore"):
            return np.clip(self.noise(state) / length, low, high)


def step_inside(
    jacobian: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    *,
    damping: float = _SMALLEST_DAMPING,
) -> FloatArray:
    """The step d, low ≤ d ≤ high, of least ‖J d + r‖² + damping ‖D d‖², D the lengths of J's columns.

    >>> step_inside(np.eye(2), np.array([-3.0, -1.0]), np.full(2, -2.0), np.full(2, 2.0)).round(6).tolist()
    [2.0, 1.0]
    """
    scale = np.linalg.norm(jacobian, axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    system = np.vstack([jacobian / scale, np.sqrt(damping) * np.eye(len(scale))])
    wanted = np.concatenate([-residuals, np.zeros(len(scale))])
    room = np.maximum(high - low, _AT_BOUND)
    solution = lsq_linear(system, wanted, bounds=(low * scale, (low + room) * scale), method="bvls")
    return np.asarray(np.clip(solution.x / scale, low, high))


def _moved(state: SearchState, place: FloatArray, residuals: FloatArray) -> SearchState:
    """State at a better place, with the derivatives of the old one.

    Broyden's update is not used: along a direction that hardly affects the data it would fit the roughness of the
    simulation, and the direction would look well determined.
    """
    assert state.jacobian is not None
    predicted = state.residuals + state.jacobian @ (place - state.place)
    predicted_fall = state.cost - float(predicted @ predicted)
    actual_fall = state.cost - float(residuals @ residuals)
    return replace(state, place=place, residuals=residuals, is_trusted=actual_fall >= _PREDICTED_FALL * predicted_fall)


def _slope_and_bend(
    ends: Sequence[tuple[float, FloatArray | None]], middle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """First and second derivative of the residuals from the points next to `middle`; 0 if both are missing."""
    sides = [(away, value) for away, value in ends if value is not None and abs(away) > 1e-12]
    slopes = [(value - middle) / away for away, value in sides]
    if not slopes:
        return np.zeros_like(middle), np.zeros_like(middle)
    if len(slopes) == 1:
        return slopes[0], np.zeros_like(middle)
    (one, _), (other, _) = sides
    bend = 2.0 * (slopes[0] - slopes[1]) / (one - other)
    return slopes[0] - 0.5 * bend * one, bend
