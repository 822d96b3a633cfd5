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
Told: TypeAlias = Callable[[str], None]

_SMALLEST_DAMPING, _LARGEST_DAMPING = 1e-9, 1e9
_FIRST_DAMPING: Final = 1e-3
_AT_BOUND: Final = 1e-9
"""Distance (sizes) from a bound that counts as on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Manner:
    """How the search goes.

    Attributes
    ----------
    smallest_step, largest_step
        Of the differences, in parameters' sizes; between them the parameter's standard error so far.
    tolerance
        A full step that moves the residuals by less than this many standard deviations of one is the end.
    rough
        Residuals move by so many standard deviations for no reason: where no step improves and what is left to gain
        is smaller than this, the search is at its end too.
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
    tolerance: float = 0.05
    rough: float = 0.5
    smallest_move: float = 1e-5
    most_rounds: int = 30
    candidates: int = 2
    accuracy_is_stated: bool = False


FINE: Final = Manner(smallest_step=1e-3, largest_step=1e-3, tolerance=1e-5, rough=1e-2, smallest_move=1e-9)
"""For residuals in closed form or nearly so."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
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
        Jacobians so far.
    """

    place: FloatArray
    residuals: FloatArray
    jacobian: FloatArray | None = None
    second: FloatArray | None = None
    state: State = "interrupted"
    rounds: int = 0

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
    manner
        How.
    told
        Is told where the search is.
    """

    residuals: Residuals
    lower: FloatArray
    upper: FloatArray
    manner: Manner
    told: Told = field(default=lambda _: None)
    best: Found | None = None

    def run(self, start: FloatArray) -> Found | None:
        """Search from a place; None where there are no residuals at the start.

        Ctrl-C ends it with what is best so far in the state "interrupted"; before the first residuals it passes on.
        """
        try:
            begun = self.residuals([start])[0]
            if begun is None:
                return None
            self.best = Found(start, begun)
            return self._searched()
        except KeyboardInterrupt:
            if self.best is None:
                raise
            return replace(self.best, state="interrupted")

    def _searched(self) -> Found:
        assert self.best is not None
        damping = _FIRST_DAMPING
        for number in range(1, self.manner.most_rounds + 1):
            jacobian, second = self._differences(self.best)
            self.best = replace(self.best, jacobian=jacobian, second=second, rounds=number)
            self.told(f"round {number}: rms residual {np.sqrt(self.best.cost / len(self.best.residuals)):.4g}")
            left = self._left_to_gain(self.best)
            if left <= self.manner.tolerance or self._settled(self.best):
                return replace(self.best, state="converged")
            better, damping = self._stepped(self.best, damping)
            if better is None:
                return replace(self.best, state="converged" if left <= self.manner.rough else "not_converged")
            self.best = replace(better, rounds=number)
        jacobian, second = self._differences(self.best)
        return replace(self.best, jacobian=jacobian, second=second, state="not_converged")

    def polished(self, found: Found, residuals: Residuals, *, most: int = 3) -> Found:
        """Go on with other, dearer residuals and the Jacobian that is known; the best place seen with those."""
        assert found.jacobian is not None
        first = residuals([found.place])[0]
        if first is None:
            return found
        best = here = replace(found, residuals=first)
        self.best = best
        for _ in range(most):
            step = self._full_step(here)
            if self._in_noise(here, step) <= self.manner.tolerance:
                break
            dearer = residuals([here.place + step])[0]
            if dearer is None:
                break
            here = replace(here, place=here.place + step, residuals=dearer)
            if here.cost >= best.cost:
                break
            self.best = best = here
        return best

    def noise(self, found: Found) -> float:
        """Standard deviation of a residual: one where it is stated, else estimated."""
        if self.manner.accuracy_is_stated:
            return 1.0
        return float(np.sqrt(found.cost / max(len(found.residuals) - len(found.place), 1)))

    def _left_to_gain(self, found: Found) -> float:
        return self._in_noise(found, self._full_step(found))

    def _in_noise(self, found: Found, step: FloatArray) -> float:
        assert found.jacobian is not None
        noise = self.noise(found)
        return float(np.linalg.norm(found.jacobian @ step)) / noise if noise > 0.0 else 0.0

    def _settled(self, found: Found) -> bool:
        return float(np.max(np.abs(self._full_step(found)), initial=0.0)) <= self.manner.smallest_move

    def _full_step(self, found: Found) -> FloatArray:
        return self._step(found, _SMALLEST_DAMPING)

    def _step(self, found: Found, damping: float) -> FloatArray:
        """The damped step inside the bounds: min ‖J d + r‖² + damping ‖D d‖²."""
        assert found.jacobian is not None
        scale = np.linalg.norm(found.jacobian, axis=0)
        scale = np.where(scale > 0.0, scale, 1.0)
        system = np.vstack([found.jacobian, np.sqrt(damping) * np.diag(scale)])
        wanted = np.concatenate([-found.residuals, np.zeros(len(scale))])
        low, high = self.lower - found.place, self.upper - found.place
        room = np.maximum(high - low, _AT_BOUND)
        solved = lsq_linear(system / scale, wanted, bounds=(low * scale, (low + room) * scale), method="bvls")
        return np.clip(solved.x / scale, low, high)

    def _stepped(self, found: Found, damping: float) -> tuple[Found | None, float]:
        """The best of some trial steps; None where none of ever shorter ones improves."""
        for _ in range(4):
            dampings = [damping * 10.0 ** (2 * i - 1) for i in range(self.manner.candidates)]
            places = [np.clip(found.place + self._step(found, each), self.lower, self.upper) for each in dampings]
            tried = self.residuals(places)
            costs = [np.inf if each is None else float(each @ each) for each in tried]
            number = int(np.argmin(costs))
            best = tried[number]
            if best is not None and costs[number] < found.cost:
                return Found(places[number], best, found.jacobian, found.second), max(
                    dampings[number] / 3.0, _SMALLEST_DAMPING
                )
            damping = min(dampings[-1] * 10.0, _LARGEST_DAMPING)
        return None, damping

    def _differences(self, found: Found) -> tuple[FloatArray, FloatArray]:
        """Central differences, one-sided where a bound is near or there are no residuals."""
        steps = self._difference_steps(found)
        places = []
        for j, step in enumerate(steps):
            for sign in (1.0, -1.0):
                place = found.place.copy()
                place[j] = np.clip(place[j] + sign * step, self.lower[j], self.upper[j])
                places.append(place)
        asked = self.residuals(places)
        jacobian = np.zeros((len(found.residuals), len(steps)))
        second = np.zeros_like(jacobian)
        for j in range(len(steps)):
            ends = [(places[i][j] - found.place[j], asked[i]) for i in (2 * j, 2 * j + 1)]
            jacobian[:, j], second[:, j] = _slope_and_bend(ends, found.residuals)
        return jacobian, second

    def _difference_steps(self, found: Found) -> FloatArray:
        low, high = self.manner.smallest_step, self.manner.largest_step
        if found.jacobian is None or low == high:
            return np.full(len(found.place), np.sqrt(low * high))
        length = np.linalg.norm(found.jacobian, axis=0)
        with np.errstate(divide="ignore"):
            return np.clip(self.noise(found) / length, low, high)


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
