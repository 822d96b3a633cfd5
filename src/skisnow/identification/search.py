"""Least squares inside bounds, made for residuals that come from simulations: Levenberg and Marquardt in batches.

Everything that can be asked at once is asked at once: the runs of a Jacobian, and trial steps of several lengths. Steps
of the differences are large, 1 to 5 % of a parameter's size: smaller ones see contact that switches, not the trend.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import lsq_linear

FloatArray = npt.NDArray[np.float64]
Residuals: TypeAlias = Callable[[Sequence[FloatArray]], list[FloatArray | None]]
"""From places of the search to residuals, all at once; None where there are none."""
State: TypeAlias = Literal["converged", "not_converged", "interrupted"]
Progress: TypeAlias = Callable[[str], None]

_SMALLEST_DAMPING, _LARGEST_DAMPING = 1e-9, 1e9
_FIRST_DAMPING: Final = 1e-3
_SLIGHT: Final = 3.0
"""Change of the residuals (standard deviations of one) over which derivatives hold, however far the parameters went."""
_KEPT_PROMISE: Final = 0.5
"""Share of the fall that derivatives foretold, below which they are taken again."""
_AT_BOUND: Final = 1e-9
"""Distance (sizes) from a bound that counts as on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchOptions:
    """How the search goes.

    Attributes
    ----------
    smallest_step, largest_step
        Of the differences, in parameters' sizes; between them the parameter's standard error so far.
    tolerance
        A full step that moves the residuals by less than this many standard deviations of one is the end.
    worth
        Fall of the sum of squares, in squared standard deviations, that is worth another round.
    rough
        Residuals move by so many standard deviations for no reason: where no step improves and what is left to gain
        is smaller than this, the search is at its end too.
    keeps_jacobian
        Derivatives are taken again farther away than this from where they were taken, in sizes; 0: always.
    longest_move
        Of a parameter in one step, in sizes: beyond it nothing is known yet.
    smallest_move
        A full step shorter than this, in sizes, is the end: of data without noise.
    most_rounds
        Jacobians at most.
    candidates
        Trial steps at once.
    accuracy_is_stated
        Whether one is the standard deviation of a residual, or it is estimated from them.
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


FINE: Final = SearchOptions(
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
    """Where a search is, or ended.

    Attributes
    ----------
    place
        (p,) in sizes from the start.
    residuals, jacobian, second
        (n,), (n, p), and (n, p) second differences along each parameter; the last two None before they are known.
    state
        How it ended.
    rounds
        Jacobians by central differences so far.
    differentiated_at, is_central, is_trusted
        Where the derivatives were taken, whether from both sides, and whether the last step did what they foretold.
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
    """One search.

    Attributes
    ----------
    residuals
        What is made small.
    lower, upper
        Bounds, in sizes from the start.
    options
        How.
    progress
        Called with where the search is.
    """

    residuals: Residuals
    lower: FloatArray
    upper: FloatArray
    options: SearchOptions
    progress: Progress = field(default=lambda _: None)
    best: SearchState | None = None

    def run(self, start: FloatArray) -> SearchState | None:
        """Search from a place; None where there are no residuals at the start.

        Ctrl-C ends it with what is best so far in the state "interrupted"; before the first residuals it passes on.
        """
        try:
            self.best = self._begun(start)
            return None if self.best is None else self._searched()
        except KeyboardInterrupt:
            if self.best is None:
                raise
            return replace(self.best, state="interrupted")

    def _searched(self) -> SearchState:
        damping = _FIRST_DAMPING
        for _ in range(self.options.most_rounds):
            here = self._with_jacobian(self._seen())
            left = self._left_to_gain(here)
            ends = left <= self.options.tolerance or self._settled(here)
            if ends and here.is_central:
                return replace(here, state="converged")
            if ends:
                self._differentiated(here)
                continue
            better, damping = self._stepped(here, damping)
            if better is not None:
                self.best = better
            if better is None or here.cost - better.cost < self.options.worth * self.noise(here) ** 2:
                if here.is_central and here.differentiated_at is here.place:
                    return replace(self._seen(), state="converged" if left <= self.options.rough else "not_converged")
                self._differentiated(self._seen())
                damping = _FIRST_DAMPING
        return replace(self._differentiated(self._seen()), state="not_converged")

    def _seen(self) -> SearchState:
        assert self.best is not None
        return self.best

    def _with_jacobian(self, state: SearchState) -> SearchState:
        """With derivatives that hold here: not one-sided ones, nor of a place too far away, nor such as failed."""
        if state.jacobian is None or state.differentiated_at is None:
            return self._differentiated(state)
        away = state.place - state.differentiated_at
        if not np.any(away):
            return state
        far = np.max(np.abs(away)) > self.options.keeps_jacobian and self._in_noise(state, away) > min(
            _SLIGHT, 1e3 * self.options.keeps_jacobian
        )
        if far or not state.is_central or not state.is_trusted:
            return self._differentiated(state)
        return state

    def _differentiated(self, state: SearchState) -> SearchState:
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

    def _begun(self, start: FloatArray) -> SearchState | None:
        """Residuals of the start and one-sided derivatives there, in one batch: enough for a first step."""
        places = [start]
        steps = np.full(len(start), np.sqrt(self.options.smallest_step * self.options.largest_step))
        for j, step in enumerate(steps):
            place = start.copy()
            place[j] += step if start[j] + step <= self.upper[j] else -step
            places.append(np.clip(place, self.lower, self.upper))
        asked = self.residuals(places)
        first = asked[0]
        if first is None:
            return None
        ends = [(places[j + 1][j] - start[j], asked[j + 1]) for j in range(len(start))]
        jacobian = np.column_stack([_slope_and_bend([end], first)[0] for end in ends])
        return SearchState(start, first, jacobian, np.zeros_like(jacobian), differentiated_at=start)

    def polished(self, state: SearchState, residuals: Residuals, *, most: int = 2) -> SearchState:
        """Go on with other, dearer residuals and the Jacobian that is known; the best place seen with those."""
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

    def _left_to_gain(self, state: SearchState) -> float:
        return self._in_noise(state, self._full_step(state))

    def _in_noise(self, state: SearchState, step: FloatArray) -> float:
        assert state.jacobian is not None
        noise = self.noise(state)
        return float(np.linalg.norm(state.jacobian @ step)) / noise if noise > 0.0 else 0.0

    def _settled(self, state: SearchState) -> bool:
        return float(np.max(np.abs(self._full_step(state)), initial=0.0)) <= self.options.smallest_move

    def _full_step(self, state: SearchState) -> FloatArray:
        return self._step(state, _SMALLEST_DAMPING)

    def _step(self, state: SearchState, damping: float) -> FloatArray:
        """The damped step inside the bounds, no longer than is known."""
        assert state.jacobian is not None
        low = np.maximum(self.lower - state.place, -self.options.longest_move)
        high = np.minimum(self.upper - state.place, self.options.longest_move)
        return step_inside(state.jacobian, state.residuals, low, high, damping=damping)

    def _stepped(self, state: SearchState, damping: float) -> tuple[SearchState | None, float]:
        """The best of some trial steps; None where none of ever shorter ones improves."""
        for _ in range(4):
            dampings = [damping * 10.0 ** (2 * i - 1) for i in range(self.options.candidates)]
            places = [np.clip(state.place + self._step(state, each), self.lower, self.upper) for each in dampings]
            tried = self.residuals(places)
            costs = [np.inf if each is None else float(each @ each) for each in tried]
            number = int(np.argmin(costs))
            best = tried[number]
            if best is not None and costs[number] < state.cost:
                return _moved(state, places[number], best), max(dampings[number] / 3.0, _SMALLEST_DAMPING)
            damping = min(dampings[-1] * 10.0, _LARGEST_DAMPING)
        return None, damping

    def _differences(self, state: SearchState) -> tuple[FloatArray, FloatArray]:
        """Central differences, one-sided where a bound is near or there are no residuals."""
        steps = self._difference_steps(state)
        places = []
        for j, step in enumerate(steps):
            for sign in (1.0, -1.0):
                place = state.place.copy()
                place[j] = np.clip(place[j] + sign * step, self.lower[j], self.upper[j])
                places.append(place)
        asked = self.residuals(places)
        jacobian = np.zeros((len(state.residuals), len(steps)))
        second = np.zeros_like(jacobian)
        for j in range(len(steps)):
            ends = [(places[i][j] - state.place[j], asked[i]) for i in (2 * j, 2 * j + 1)]
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
    solved = lsq_linear(system, wanted, bounds=(low * scale, (low + room) * scale), method="bvls")
    return np.asarray(np.clip(solved.x / scale, low, high))


def _moved(state: SearchState, place: FloatArray, residuals: FloatArray) -> SearchState:
    """At a better place, with the derivatives as they were.

    Broyden's update is left away: along a direction that hardly shows in the data it would learn the roughness of the
    simulation, and make the direction look well known.
    """
    assert state.jacobian is not None
    foretold = state.residuals + state.jacobian @ (place - state.place)
    promised = state.cost - float(foretold @ foretold)
    kept = state.cost - float(residuals @ residuals)
    return replace(state, place=place, residuals=residuals, is_trusted=kept >= _KEPT_PROMISE * promised)


def _slope_and_bend(
    ends: Sequence[tuple[float, FloatArray | None]], middle: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """First and second derivative from the residuals at two places beside the middle, as far as there are any."""
    known = [(away, value) for away, value in ends if value is not None and abs(away) > 1e-12]
    slopes = [(value - middle) / away for away, value in known]
    if not slopes:
        return np.zeros_like(middle), np.zeros_like(middle)
    if len(slopes) == 1:
        return slopes[0], np.zeros_like(middle)
    (one, _), (other, _) = known
    bend = 2.0 * (slopes[0] - slopes[1]) / (one - other)
    return slopes[0] - 0.5 * bend * one, bend
