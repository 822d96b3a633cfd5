"""Bounded least squares for simulated residuals: the Levenberg-Marquardt method with few simulations.

All runs of a Jacobian are simulated in one batch. Finite differences take large steps, 1 to 5 % of a parameter's size:
smaller ones show switching contacts instead of the trend. Between Jacobians steps are predicted by Broyden's update
(1965, doi:10.1090/S0025-5718-1965-0198670-6). SciPy's `least_squares` has none: it differentiates at every step.
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
_FIRST_DAMPING: Final = 1e-4
_TRIES, _TRIES_BEFORE_DIFFERENCES = 5, 2
"""Trial steps with rising damping: with a new Jacobian, and with an earlier one before it is computed again."""
_SLIGHT: Final = 6.0
"""Change of the residuals (in standard deviations of one) up to which a Jacobian stays valid after a long move."""
_PREDICTED_FALL: Final = 0.25
"""The Jacobian is computed again if the sum of squares fell by less than this share of the predicted fall."""
_WEAK: Final = 0.02
"""Singular value of a scaled Jacobian below which differences are also taken along its direction."""
_AT_BOUND: Final = 1e-9
"""Distance (sizes) from a bound that counts as on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchOptions:
    """Step sizes and stopping rules of a search; lengths are in parameters' sizes.

    smallest_step, largest_step: limits of the finite-difference step; between them it is the parameter's current
        standard error.
    central: True for central differences; False for one-sided ones towards the predicted minimum, where these suffice.
    tolerance: the search converged if a full step moves the residuals by fewer standard deviations of one residual.
    worth: smallest fall of the sum of squares, in squared standard deviations, for which the search continues.
    rough: numerical roughness of the residuals in standard deviations: the search also converged if no step improves
        and the remaining gain is smaller.
    renews: True to compute the Jacobian next to the minimum, too; False if another search continues there.
    keeps_jacobian: distance from its place up to which a Jacobian is used again; 0: it is always computed again.
    longest_move: longest step of a parameter.
    damping: smallest damping of a step, the square of a singular value of the scaled Jacobian that differences hide.
    smallest_move: the search converged if a full step is shorter (for data without noise).
    most_rounds: maximum number of Jacobians.
    accuracy_is_stated: True if residuals have a standard deviation of 1; otherwise it is estimated from them.
    """

    smallest_step: float = 0.02
    largest_step: float = 0.05
    central: bool = False
    tolerance: float = 5.0
    worth: float = 0.3
    rough: float = 1.0
    renews: bool = True
    keeps_jacobian: float = 0.1
    longest_move: float = 0.25
    damping: float = 1e-5
    smallest_move: float = 1e-5
    most_rounds: int = 30
    accuracy_is_stated: bool = False


CLOSED_FORM_SEARCH: Final = SearchOptions(
    smallest_step=1e-3,
    largest_step=1e-3,
    central=True,
    tolerance=1e-5,
    worth=1e-10,
    rough=1e-2,
    keeps_jacobian=0.0,
    longest_move=5.0,
    damping=_SMALLEST_DAMPING,
    smallest_move=1e-9,
    most_rounds=100,
)
"""For residuals in closed form or nearly so."""


@dataclass(frozen=True, slots=True, eq=False)
class SearchState:
    """Current or final place of a search.

    place: (p,) in sizes from the start.
    residuals, jacobian, second: residuals (n,), their derivatives (n, p), and second differences along each parameter
        (n, p), 0 for one-sided differences; None if not computed yet.
    state: outcome of the search.
    rounds: number of Jacobians computed by differences.
    differentiated_at, is_trusted: place of these; True if the derivatives predicted the last step well.
    """

    place: FloatArray
    residuals: FloatArray
    jacobian: FloatArray | None = None
    second: FloatArray | None = None
    state: State = "interrupted"
    rounds: int = 0
    differentiated_at: FloatArray | None = None
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
    differences: cheaper residuals for derivatives (default: `residuals`).
    middle: state of a search of these, the middle of differences next to it.
    """

    residuals: Residuals
    lower: FloatArray
    upper: FloatArray
    options: SearchOptions
    progress: Progress = field(default=lambda _: None)
    best: SearchState | None = None
    differences: Residuals | None = None
    middle: SearchState | None = None

    def run(self, start: FloatArray) -> SearchState | None:
        """Search from a place; return None if the residuals cannot be computed there.

        Ctrl-C ends the search: it returns the best place so far with the state "interrupted". Before the first
        residuals KeyboardInterrupt is raised.
        """
        try:
            self.best = self._differentiate(start)
            return None if self.best is None else self._iterate_to_end(self.best)
        except KeyboardInterrupt:
            if self.best is None:
                raise
            return replace(self.best, state="interrupted")

    def _iterate_to_end(self, here: SearchState) -> SearchState:
        """Take steps until they converge, gain nothing or are `most_rounds`; the final state."""
        damping = _FIRST_DAMPING
        while here.rounds <= self.options.most_rounds:
            step = self._step(here)
            left = self._in_noise(here, step)
            ends = left <= self.options.tolerance or np.max(np.abs(step), initial=0.0) <= self.options.smallest_move
            near_minimum = self.options.renews and (
                ends or not self.options.keeps_jacobian or not self._is_far(here, step)
            )
            if not self._is_valid(here) and (near_minimum or not here.is_trusted):
                renewed = self._differentiate(here.place, here)
                if renewed is None:
                    break
                here = self.best = self._sharpened(renewed) if near_minimum else renewed
                self.progress(f"round {here.rounds}: rms residual {np.sqrt(here.cost / len(here.residuals)):.4g}")
                continue
            if ends:
                return replace(here, state="converged")
            is_new = here.differentiated_at is here.place
            better, damping = self._step_on(here, damping, _TRIES if is_new else _TRIES_BEFORE_DIFFERENCES)
            gain = 0.0 if better is None else here.cost - better.cost
            is_worth_it = gain >= self.options.worth * self.noise(here) ** 2
            here = self.best = here if better is None else better
            is_settled = left <= self.options.rough if better is None else self._is_valid(here)
            if not is_worth_it and (is_new or is_settled):
                return replace(here, state="converged" if left <= self.options.rough else "not_converged")
            if not is_worth_it:
                here, damping = replace(here, is_trusted=False), _FIRST_DAMPING
        return replace(here, state="not_converged")

    def _is_valid(self, state: SearchState) -> bool:
        """True if the Jacobian is of this place or near it, and predicted the last step well."""
        assert state.differentiated_at is not None
        return state.is_trusted and not self._is_far(state, state.place - state.differentiated_at)

    def _is_far(self, state: SearchState, away: FloatArray) -> bool:
        """True if a move invalidates a Jacobian: it is long and changes the residuals."""
        keeps = self.options.keeps_jacobian
        return bool(np.max(np.abs(away)) > keeps and self._in_noise(state, away) > min(_SLIGHT, 1e3 * keeps))

    def _differentiate(self, place: FloatArray, before: SearchState | None = None) -> SearchState | None:
        """State with derivatives by differences; `before` is the state at a place after the start."""
        middle = self.middle if before and self.differences else before
        if middle and np.max(np.abs(place - middle.place), initial=0.0) > self.options.keeps_jacobian:
            middle = None
        at = middle.place if middle else place
        steps, is_pair = self._difference_steps(at, before), self.options.central
        sides = (1.0, -1.0) if is_pair else (1.0,)
        ends = [self._beside(at, j, side * step, is_pair=is_pair) for j, step in enumerate(steps) for side in sides]
        simulate = self.differences or self.residuals
        batch: list[FloatArray | None] = [middle.residuals] if middle else []
        batch += simulate([at, *ends][len(batch) :])
        first, others = batch[0], batch[1:]
        if first is None:
            return None
        for j, value in enumerate(others):
            if value is None and not is_pair:  # the other side of a place without residuals
                ends[j] = self._beside(at, j, -steps[j], is_pair=True)
                others[j] = simulate([ends[j]])[0]
        jacobian, second = np.zeros((2, len(first), len(steps)))
        for j in range(len(steps)):
            of_j = slice(j * len(sides), (j + 1) * len(sides))
            moved = [(end[j] - at[j], value) for end, value in zip(ends[of_j], others[of_j], strict=True)]
            jacobian[:, j], second[:, j] = _slope_and_bend(moved, first)
        rounds, residuals = (before.rounds + 1, before.residuals) if before else (1, first)
        return SearchState(place, residuals, jacobian, second, rounds=rounds, differentiated_at=place)

    def _sharpened(self, state: SearchState) -> SearchState:
        """State with central differences along the directions in which errors of one-sided ones hide the derivative."""
        jacobian = state.jacobian
        assert jacobian is not None
        length = _lengths(jacobian)
        _, singular, directions = np.linalg.svd(jacobian / length, full_matrices=False)
        if self.options.central or singular[-1] >= _WEAK:
            return state
        weak, keeps = directions[singular < _WEAK] / length, self.options.keeps_jacobian
        most = np.maximum(singular[singular < _WEAK], np.max(np.abs(weak), axis=1) / keeps)
        moves = weak / most[:, None]  # over a standard error, or as far as a Jacobian is used
        ends = [np.clip(state.place + move, self.lower, self.upper) for each in moves for move in (each, -each)]
        values = (self.differences or self.residuals)(ends)
        for one, other, first, second in zip(ends[::2], ends[1::2], values[::2], values[1::2], strict=True):
            if first is not None and second is not None:
                jacobian = _with_secant(jacobian / length, (one - other) * length, first - second) * length
        return replace(state, jacobian=jacobian)

    def _beside(self, place: FloatArray, j: int, step: float, *, is_pair: bool) -> FloatArray:
        """Place with parameter j moved by a step, clipped to the bounds; a single step across one is reversed first."""
        end = place.copy()
        if not is_pair and not self.lower[j] <= place[j] + step <= self.upper[j]:
            step = -step
        end[j] = np.clip(place[j] + step, self.lower[j], self.upper[j])
        return end

    def resume(self, state: SearchState) -> tuple[SearchState, float]:
        """Continue a search with other residuals; returns the state and the rms difference of old and new residuals."""
        assert state.jacobian is not None
        step = self._step(state, _FIRST_DAMPING)
        first = self.residuals([state.place + step])[0]
        if first is None:
            return state, 0.0
        self.middle = state
        apart = float(np.sqrt(np.mean((first - state.residuals - state.jacobian @ step) ** 2)))
        self.best = replace(state, place=state.place + step, residuals=first)
        return self._iterate_to_end(self.best), apart

    def noise(self, state: SearchState) -> float:
        """Standard deviation of a residual: one where it is stated, else estimated."""
        if self.options.accuracy_is_stated:
            return 1.0
        return float(np.sqrt(state.cost / max(len(state.residuals) - len(state.place), 1)))

    def _in_noise(self, state: SearchState, step: FloatArray) -> float:
        """Change of the residuals by a step, in standard deviations of one residual."""
        assert state.jacobian is not None
        noise = self.noise(state)
        return float(np.linalg.norm(state.jacobian @ step)) / noise if noise > 0.0 else 0.0

    def _step(self, state: SearchState, damping: float | None = None) -> FloatArray:
        """Step inside the bounds and no longer than `longest_move` (default: with the smallest damping)."""
        assert state.jacobian is not None
        damping = self.options.damping if damping is None else damping
        low = np.maximum(self.lower - state.place, -self.options.longest_move)
        high = np.minimum(self.upper - state.place, self.options.longest_move)
        return step_inside(state.jacobian, state.residuals, low, high, damping=damping)

    def _step_on(self, state: SearchState, damping: float, tries: int) -> tuple[SearchState | None, float]:
        """First of some ever shorter steps that improves, and the next damping; None if none improves."""
        for number in range(tries):
            place = np.clip(state.place + self._step(state, damping), self.lower, self.upper)
            residuals = self.residuals([place])[0]
            if residuals is not None and float(residuals @ residuals) < state.cost:
                next_damping = damping if number else max(damping / 10.0, self.options.damping)
                return self._moved(state, place, residuals), next_damping
            damping = min(damping * 100.0, _LARGEST_DAMPING)
        return None, damping

    def _moved(self, state: SearchState, place: FloatArray, residuals: FloatArray) -> SearchState:
        """State at a better place, with the derivatives of the old one; Broyden's update after a long move.

        Short moves would fit the roughness of the simulation, and their direction would look well determined.
        """
        jacobian = state.jacobian
        assert jacobian is not None
        step = place - state.place
        predicted = state.residuals + jacobian @ step
        predicted_fall = state.cost - float(predicted @ predicted)
        actual_fall = state.cost - float(residuals @ residuals)
        if self._is_far(state, step):
            jacobian = _with_secant(jacobian, step, residuals - state.residuals)
        is_trusted = actual_fall >= _PREDICTED_FALL * predicted_fall
        return replace(state, place=place, residuals=residuals, jacobian=jacobian, is_trusted=is_trusted)

    def _difference_steps(self, place: FloatArray, before: SearchState | None) -> FloatArray:
        """Signed steps of the differences, towards the predicted minimum."""
        low, high = self.options.smallest_step, self.options.largest_step
        sizes = np.full(len(place), np.sqrt(low * high))
        if before is None or before.jacobian is None:
            return sizes
        if low < high:
            sizes = np.clip(self.noise(before) / _lengths(before.jacobian), low, high)
        return np.copysign(sizes, self._step(before))


def _with_secant(jacobian: FloatArray, step: FloatArray, change: FloatArray) -> FloatArray:
    """Broyden's update: the nearest Jacobian that gives the change of the residuals over a step."""
    return jacobian + np.outer(change - jacobian @ step, step) / max(float(step @ step), 1e-300)


def _lengths(jacobian: FloatArray) -> FloatArray:
    """Lengths (p,) of the columns; 1 for a column of zeros."""
    length = np.linalg.norm(jacobian, axis=0)
    return np.where(length > 0.0, length, 1.0)


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
    scale = _lengths(jacobian)
    system = np.vstack([jacobian / scale, np.sqrt(damping) * np.eye(len(scale))])
    wanted = np.concatenate([-residuals, np.zeros(len(scale))])
    room = np.maximum(high - low, _AT_BOUND)
    solution = lsq_linear(system, wanted, bounds=(low * scale, (low + room) * scale), method="bvls")
    return np.asarray(np.clip(solution.x / scale, low, high))


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
