"""Gaussian process through the evaluated lines of a race, and the search that chooses the next lines by it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr
from scipy.stats import qmc

from .._support.arrays import BoolArray, FloatArray
from .score import NOT_PASSED
from .search import Batches, Evaluated, optimiser_within

LENGTHS: Final = (0.05, 5.0)
"""Bounds of the process's correlation lengths, in shares of each range."""
NOISE: Final = (1e-3, 0.5)
"""Bounds of the standard deviation of one evaluation, over that of all values."""
SMALLEST: Final = 1e-9
"""Added to the kernel's diagonal, for rounding."""
MOST_TIME: Final = 3.0
"""Largest counted time, in quarter widths above the median; also that of a race that did not reach the last gate."""
MOST_MARGIN: Final = 0.5
"""Distance (m) from a pole that counts at most, to either side; a gate that was not reached counts as missed by it."""
_UNIT: Final = 0.5 * math.log(2.0 * math.pi)


@dataclass(frozen=True, slots=True)
class Surrogate:
    """Gaussian process with Matérn's kernel 5/2 that predicts values, such as times, at places in the unit cube.

    places: places of the evaluations, shape (n, d).
    lengths: correlation lengths of the kernel, shape (d,).
    level, scale: mean and standard deviation of the values: a number, or (q,) for q values with shared lengths.
    noise: standard deviation of one value, divided by `scale`.

    * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
      Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
    """

    places: FloatArray
    lengths: FloatArray
    level: FloatArray
    scale: FloatArray
    noise: float
    _factor: tuple[FloatArray, bool]
    _weights: FloatArray

    @classmethod
    def of(cls, places: FloatArray, values: FloatArray, kinds: int) -> Surrogate:
        """Fit a process by maximum likelihood; each `kinds`-th number of a place has the same correlation length.

        places: places of the evaluations, shape (n, d), n 2 or more.
        values: finite values, shape (n,) or (n, q).
        kinds: how many numbers each turn has; d is a multiple of it.
        """
        level, scale = values.mean(axis=0), np.asarray(values.std(axis=0))
        scale = np.where(scale > 0.0, scale, 1.0)
        standard = (values - level) / scale
        columns = 1 if values.ndim == 1 else values.shape[1]

        def misfit(logs: FloatArray) -> float:
            lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
            factor = _factorise_kernel(places, lengths, math.exp(logs[kinds]))
            likelihood = 0.5 * np.sum(standard * cho_solve(factor, standard))
            likelihood += columns * np.sum(np.log(np.diag(factor[0])))
            return float(likelihood + 0.1 * np.sum((logs[:kinds] - math.log(0.7)) ** 2))

        bounds = [(math.log(low), math.log(high)) for low, high in (*(LENGTHS,) * kinds, NOISE)]
        begin = np.array([math.log(0.7)] * kinds + [math.log(0.05)])
        logs = minimize(misfit, begin, method="L-BFGS-B", bounds=bounds, options={"maxiter": 40}).x
        lengths = np.tile(np.exp(logs[:kinds]), places.shape[1] // kinds)
        return cls._fitted_to(places, standard, lengths, level, scale, math.exp(logs[kinds]))

    @classmethod
    def _fitted_to(
        cls,
        places: FloatArray,
        standard: FloatArray,
        lengths: FloatArray,
        level: FloatArray,
        scale: FloatArray,
        noise: float,
    ) -> Surrogate:
        """Surrogate with these lengths and noise of the kernel, fitted to standardised values at places."""
        factor = _factorise_kernel(places, lengths, noise)
        return cls(places, lengths, level, scale, noise, factor, cho_solve(factor, standard))

    def at(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Predicted mean and standard deviation of the values, (m,) or (m, q), at places (m, d)."""
        kernel = _kernel(places, self.places, self.lengths)
        mean = self.level + self.scale * (kernel @ self._weights)
        left = 1.0 - np.sum(kernel * cho_solve(self._factor, kernel.T).T, axis=1)
        return mean, np.multiply.outer(np.sqrt(np.maximum(left, 1e-12)), self.scale)

    def with_mean_at(self, place: FloatArray) -> Surrogate:
        """Surrogate with one more evaluation whose value is the mean predicted there (Kriging believer)."""
        expected = (self.at(place[None, :])[0] - self.level) / self.scale
        variance = (
            _kernel(self.places, self.places, self.lengths) @ self._weights + (self.noise**2 + SMALLEST) * self._weights
        )
        return self._fitted_to(
            np.vstack([self.places, place]), np.concatenate([variance, expected]), self.lengths, self.level, self.scale,
            self.noise,
        )  # fmt: skip


def _factorise_kernel(places: FloatArray, lengths: FloatArray, noise: float) -> tuple[FloatArray, bool]:
    """Cholesky factor (n, n) of the kernel matrix with noise, and True: a lower triangle, as SciPy's `cho_factor`."""
    kernel = _kernel(places, places, lengths)
    kernel[np.diag_indices(len(places))] += noise**2 + SMALLEST
    factor, low = cho_factor(kernel, lower=True)
    return factor, bool(low)


def _kernel(first: FloatArray, second: FloatArray, lengths: FloatArray) -> FloatArray:
    """Matérn kernel 5/2 between two sets of places, (n, m)."""
    a, b = first / lengths, second / lengths
    square = np.sum(a * a, axis=1)[:, None] + np.sum(b * b, axis=1)[None, :] - 2.0 * a @ b.T
    apart = np.sqrt(5.0 * np.maximum(square, 0.0))
    return (1.0 + apart + apart**2 / 3.0) * np.exp(-apart)


@dataclass(frozen=True, slots=True)
class Prospects:
    """Predictions for lines that are not evaluated yet, by two Gaussian processes.

    time: process of the time at the last gate (s), also of failed races.
    margins: process of the margins (m), which must all be above 0; None if no margin is 0 or below.
    least: smallest predicted time (s) of the evaluated lines that pass all gates.

    * Gardner and others (2014), "Bayesian optimization with inequality constraints", Proceedings of Machine Learning
      Research 32(2), 937-945.
    * Eriksson and Poloczek (2021), "Scalable constrained Bayesian optimization", Proceedings of Machine Learning
      Research 130, 730-738, doi 10.48550/arXiv.2002.08526.
    """

    time: Surrogate
    margins: Surrogate | None
    least: float

    @classmethod
    def of(cls, evaluations: Sequence[Evaluated], kinds: int) -> Prospects:
        """Fit the processes to two or more evaluations, whose places have `kinds` numbers for each turn."""
        places = np.array([evaluation.place for evaluation in evaluations])
        times, margins = times_of(evaluations), margins_of(evaluations)
        time = Surrogate.of(places, times, kinds)
        passed = passed_of(evaluations)
        expected = time.at(places)[0]
        least = float(expected[passed].min() if passed.any() else times.max())
        varied = bool(np.any(margins <= 0.0))
        return cls(time, Surrogate.of(places, margins, kinds) if varied else None, least)

    def through(self, places: FloatArray) -> FloatArray:
        """Logarithm of the probability (m,) of passing all gates at places (m, d)."""
        if self.margins is None:
            return np.zeros(len(places))
        mean, deviation = self.margins.at(places)
        scatter = np.hypot(deviation, self.margins.noise * self.margins.scale)
        return np.asarray(np.sum(log_ndtr(mean / scatter), axis=1))

    def worth(self, places: FloatArray, curiosity: float = 1.0, caution: float = 1.0) -> FloatArray:
        """Logarithm of the expected improvement (s) on `least` at places (m, d), weighted with the chance to pass.

        `curiosity` multiplies the standard deviation of the time: near 0 only the mean counts; `caution` is the
        exponent of the probability of passing all gates.
        """
        mean, deviation = self.time.at(places)
        deviation = deviation * curiosity
        gain = _log_improvement((self.least - mean) / deviation) + np.log(deviation)
        return np.asarray(gain + caution * self.through(places))

    def with_mean_at(self, place: FloatArray) -> Prospects:
        """Prospects with one more evaluation whose values are the means predicted there."""
        margins, least = None if self.margins is None else self.margins.with_mean_at(place), self.least
        if self.through(place[None, :])[0] > math.log(0.5):
            least = min(least, float(self.time.at(place[None, :])[0][0]))
        return Prospects(self.time.with_mean_at(place), margins, least)


def passed_of(evaluations: Sequence[Evaluated]) -> BoolArray:
    """True for evaluations that pass all gates (n,)."""
    return np.array([evaluation.value < NOT_PASSED for evaluation in evaluations])


def times_of(evaluations: Sequence[Evaluated]) -> FloatArray:
    """Times (n,) (s) at the last gate, limited to an upper value, which races that do not reach it also get."""
    times = np.full(len(evaluations), math.inf)
    for number, evaluation in enumerate(evaluations):
        gates = evaluation.row.get("gates")
        if evaluation.value < NOT_PASSED:
            times[number] = evaluation.value
        elif gates and gates[-1][1] is not None:  # it reached the last gate, but not by an allowed line
            times[number] = gates[-1][1]
    finite = np.isfinite(times)
    if not finite.any():
        return np.array([math.log(min(evaluation.value, 1e6)) for evaluation in evaluations])
    low, middle, high = np.quantile(times[finite], [0.25, 0.5, 0.75])
    return np.minimum(np.where(finite, times, np.inf), middle + MOST_TIME * max(high - low, 1e-6))


def margins_of(evaluations: Sequence[Evaluated]) -> FloatArray:
    """Margins (n, q) (m) of evaluations whose rows contain them; without margins 1 for a pass and -1 for a failure."""
    if not evaluations[0].row.get("margins"):
        return np.where(passed_of(evaluations), 1.0, -1.0)[:, None]
    count = max(len(evaluation.row["margins"]) for evaluation in evaluations)
    out = np.full((len(evaluations), count), -MOST_MARGIN)
    for i, evaluation in enumerate(evaluations):
        for j, margin in enumerate(evaluation.row["margins"]):
            if margin is not None:
                out[i, j] = min(max(margin, -MOST_MARGIN), MOST_MARGIN)
    return out


def _log_improvement(hope: FloatArray) -> FloatArray:
    """Logarithm of φ(z) + z Φ(z), the expected improvement in standard deviations, also for z far below 0."""
    above, near = np.maximum(hope, 0.0), np.clip(hope, -10.0, 0.0)
    density = -0.5 * near**2 - _UNIT
    below = density + np.log1p(near * np.exp(log_ndtr(near) - density))
    low = np.maximum(-hope, 10.0)
    far = -0.5 * low**2 - _UNIT - 2.0 * np.log(low) + np.log1p(-3.0 / low**2 + 15.0 / low**4)
    over = np.log(above * ndtr(above) + np.exp(-0.5 * above**2 - _UNIT))
    return np.asarray(np.where(hope > 0.0, over, np.where(hope > -10.0, below, far)))


PATIENCE: Final = 3
"""Batches without a better value that end a search with `settled`."""
BOX: Final = (0.02, 0.5)
"""Minimum and maximum half width of the search box about the best point, in shares of each range; below the minimum
the search ends."""
BOX_CHANGES: Final = (0.8, 1.3)
"""Factors of that half width after a batch without a better value, and with one."""
ASKED: Final = 50
"""Generations of the search for the minimum of the process."""
ALIKE: Final = 0.25
"""Share of all evaluations with the same numbers for all turns."""


@dataclass(frozen=True, slots=True)
class PointChoice:
    """Settings for the choice of one point of a batch.

    curiosity: factor of the standard deviation of the predicted time.
    caution: exponent of the probability of passing all gates; with 1 most races fail by millimetres in the end.
    held: share of the directions, drawn at random, that stay at the centre; without it the points of a batch would be
        close together.
    """

    curiosity: float
    caution: float
    held: float


BATCH: Final = (
    PointChoice(0.1, 4.0, 0.0),
    PointChoice(1.0, 1.0, 0.5),
    PointChoice(0.3, 4.0, 0.5),
    PointChoice(1.0, 2.0, 0.0),
)
"""The places of a batch: the first is where the least is expected."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SurrogateSearch:
    """Search by a surrogate model: its settings and evaluations.

    count: number of evaluations after which no new batch begins.
    kinds: how many numbers each turn has.
    spread: half width of the first box in shares of each range, at most 0.25; twice as much for equal turns.
    settled: above 0: the search ends when three batches in a row have not lowered the minimum by this much.
    """

    batches: Batches
    count: int
    kinds: int
    spread: float
    seed: Sequence[int]
    settled: float = 0.0

    def least(self, start: FloatArray, *, alike: bool = True) -> Evaluated:
        """Best evaluation; if `alike` and all turns of `start` are equal, equal turns are searched first, then each.

        * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
          Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
        * Eriksson and others (2019), "Scalable global optimization via local Bayesian optimization", Advances in Neural
          Information Processing Systems 32, doi 10.48550/arXiv.1910.01739.
        """
        if alike and self.starts_with_equal_turns(start):
            self.minimise_equal_turns(start, math.ceil(ALIKE * self.count))
        else:
            self.batches.evaluate([np.asarray(start, float)])
        self._search_along(np.eye(len(start)), len(start) // 2, self.count, 1)
        return self.batches.least

    def minimise_equal_turns(self, start: FloatArray, count: int) -> Evaluated:
        """Best of about `count` evaluations of lines whose turns all have the same numbers, as those of the start."""
        directions = np.tile(np.eye(self.kinds), (len(start) // self.kinds, 1))
        self.batches.evaluate([np.asarray(start, float)])
        self._search_along(directions, self.first_of(self.kinds), count, 0)
        return self.batches.least

    def starts_with_equal_turns(self, start: FloatArray) -> bool:
        """True if there are several turns, which all have the same numbers."""
        turns = len(start) // self.kinds
        return turns > 1 and np.array_equal(np.tile(start[: self.kinds], turns), start)

    @staticmethod
    def first_of(numbers: int) -> int:
        """Number of evaluations before the surrogate is used, in a search over so many numbers."""
        return 2 * numbers + 2

    def _search_along(self, directions: FloatArray, drawn: int, count: int, phase: int) -> None:
        """Evaluate `drawn` random places, then batches, along the columns of `directions` (n, m), until `count`."""
        box, size = min(2.0 * self.spread, BOX[1]) / (1 + phase), directions.shape[1]
        shares = qmc.LatinHypercube(size, rng=np.random.default_rng([*self.seed, phase])).random(drawn)
        begin = self._steps_along(directions, np.array(self.batches.least.place))
        if len(self.batches.found) < count:
            self.batches.evaluate(
                [directions @ np.clip(begin + box * (2.0 * share - 1.0), 0.0, 1.0) for share in shares]
            )
        waited = 0
        while len(self.batches.found) < count and box > BOX[0]:
            before = self.batches.least.value
            self.batches.evaluate(self._choose_batch(directions, box, phase))
            better = self.batches.least.value < before - self.settled
            box = min(BOX[1], box * BOX_CHANGES[better])
            waited = 0 if better else waited + 1
            if self.settled > 0.0 and waited == PATIENCE:
                return

    def _choose_batch(self, directions: FloatArray, box: float, phase: int) -> list[FloatArray]:
        """Places of the next batch; each is chosen as if the earlier ones had been evaluated as predicted."""
        evaluations = self.batches.found
        prospects = Prospects.of(evaluations, self.kinds)
        best, passed = self.batches.least, passed_of(evaluations)
        if passed.any():  # the smallest predicted time of the lines that pass all gates
            expected = prospects.time.at(np.array([evaluation.place for evaluation in evaluations]))[0]
            best = evaluations[int(np.argmin(np.where(passed, expected, np.inf)))]
        centre = self._steps_along(directions, np.array(best.place))
        chosen: list[FloatArray] = []
        for daring in BATCH:
            seed = (*self.seed, phase, len(evaluations), len(chosen))
            free = np.random.default_rng(seed).random(len(centre)) >= daring.held
            if free.sum() < 2:  # CMA-ES needs two numbers
                free[:] = True
            moved = directions[:, free]
            rest = directions @ np.where(free, 0.0, centre)
            place = rest + moved @ _best_within(prospects, moved, rest, centre[free], box, daring, seed)
            chosen.append(place)
            prospects = prospects.with_mean_at(place)
        return chosen

    @staticmethod
    def _steps_along(directions: FloatArray, place: FloatArray) -> FloatArray:
        """Coordinates (m,) along the directions (n, m) of a place (n,), or of the nearest one (least squares)."""
        return np.asarray(np.linalg.lstsq(directions, place)[0], np.float64)


def _best_within(
    prospects: Prospects, directions: FloatArray, rest: FloatArray, centre: FloatArray, box: float, daring: PointChoice,
    seed: Sequence[int],
) -> FloatArray:  # fmt: skip
    """Coordinates (m,) along the directions with the largest `Prospects.worth`, within a box about the centre."""
    limits = np.stack([np.maximum(centre - box, 0.0), np.minimum(centre + box, 1.0)], axis=1)
    optimiser = optimiser_within(limits, np.clip(centre, *limits.T), 0.4 * box, seed)
    best, most = centre, -math.inf
    for _ in range(ASKED):
        candidates = np.array([optimiser.ask() for _ in range(optimiser.population_size)])
        values = prospects.worth(rest + candidates @ directions.T, daring.curiosity, daring.caution)
        optimiser.tell(list(zip(candidates, (-values).tolist(), strict=True)))
        if values.max() > most:
            best, most = candidates[int(np.argmax(values))], float(values.max())
        if optimiser.should_stop():
            break
    return best
