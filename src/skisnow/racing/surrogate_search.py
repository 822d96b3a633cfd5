"""Search that chooses the next lines by a Gaussian process, for evaluations that take seconds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.stats import qmc

from .._support.arrays import FloatArray
from .search import Batches, Evaluated, optimiser_within
from .surrogate import Prospects, passed_of

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
class Daring:
    """Choice of a point of a batch.

    curiosity: times the deviation of a time, by which it may come out other than expected.
    caution: power of the probability of coming through: with 1 most races fail by millimetres in the end.
    held: share of the directions that stay at the centre, at random: without it the points of a batch would be close
        together.
    """

    curiosity: float
    caution: float
    held: float


BATCH: Final = (Daring(0.1, 4.0, 0.0), Daring(1.0, 1.0, 0.5), Daring(0.3, 4.0, 0.5), Daring(1.0, 2.0, 0.0))
"""The places of a batch: the first is where the least is expected."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SurrogateSearch:
    """Settings of the search.

    count: evaluations after which no new batch begins.
    kinds: numbers of a turn.
    spread: size of the first evaluations: half of the box about the start is twice as much.
    settled: above 0: the search ends when three batches in a row have not lowered the minimum by this much.
    """

    batches: Batches
    count: int
    kinds: int
    spread: float
    seed: Sequence[int]
    settled: float = 0.0

    def least(self, start: FloatArray, *, alike: bool = True) -> Evaluated:
        """Minimum; if all turns begin `alike`, first with equal turns, then for each turn separately.

        * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
          Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
        * Eriksson and others (2019), "Scalable global optimization via local Bayesian optimization", Advances in Neural
          Information Processing Systems 32, doi 10.48550/arXiv.1910.01739.
        """
        if alike and self.begins_alike(start):
            self.least_alike(start, math.ceil(ALIKE * self.count))
        else:
            self.batches.evaluate([np.asarray(start, float)])
        self._narrow(np.eye(len(start)), len(start) // 2, self.count, 1)
        return self.batches.least

    def least_alike(self, start: FloatArray, count: int) -> Evaluated:
        """Minimum of about `count` evaluations with the same numbers for all turns, as in the start."""
        directions = np.tile(np.eye(self.kinds), (len(start) // self.kinds, 1))
        self.batches.evaluate([np.asarray(start, float)])
        self._narrow(directions, self.first_of(self.kinds), count, 0)
        return self.batches.least

    def begins_alike(self, start: FloatArray) -> bool:
        """True if several turns have the same numbers."""
        turns = len(start) // self.kinds
        return turns > 1 and np.array_equal(np.tile(start[: self.kinds], turns), start)

    @staticmethod
    def first_of(numbers: int) -> int:
        """Evaluations before the surrogate is used."""
        return 2 * numbers + 2

    def _narrow(self, directions: FloatArray, drawn: int, count: int, phase: int) -> None:
        """Go on until `count`, moving by directions (n, m) from the best."""
        box, size = min(2.0 * self.spread, BOX[1]) / (1 + phase), directions.shape[1]
        shares = qmc.LatinHypercube(size, rng=np.random.default_rng([*self.seed, phase])).random(drawn)
        begin = self._numbers(directions, np.array(self.batches.least.place))
        if len(self.batches.found) < count:
            self.batches.evaluate(
                [directions @ np.clip(begin + box * (2.0 * share - 1.0), 0.0, 1.0) for share in shares]
            )
        waited = 0
        while len(self.batches.found) < count and box > BOX[0]:
            before = self.batches.least.value
            self.batches.evaluate(self._chosen(directions, box, phase))
            better = self.batches.least.value < before - self.settled
            box = min(BOX[1], box * BOX_CHANGES[better])
            waited = 0 if better else waited + 1
            if self.settled > 0.0 and waited == PATIENCE:
                return

    def _chosen(self, directions: FloatArray, box: float, phase: int) -> list[FloatArray]:
        """A batch; for each point the earlier points of the batch count with their predicted values."""
        evaluations = self.batches.found
        prospects = Prospects.of(evaluations, self.kinds)
        centre = self._numbers(directions, np.array(self._centre(prospects).place))
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

    def _centre(self, prospects: Prospects) -> Evaluated:
        """The line that passes all gates and is expected to be the fastest, else the one with the smallest failure."""
        evaluations = self.batches.found
        passed = passed_of(evaluations)
        if not passed.any():
            return self.batches.least
        expected = prospects.time.at(np.array([evaluation.place for evaluation in evaluations]))[0]
        return evaluations[int(np.argmin(np.where(passed, expected, np.inf)))]

    @staticmethod
    def _numbers(directions: FloatArray, place: FloatArray) -> FloatArray:
        """By how much of each direction a place is reached, or the nearest to it."""
        return np.asarray(np.linalg.lstsq(directions, place)[0], np.float64)


def _best_within(
    prospects: Prospects, directions: FloatArray, rest: FloatArray, centre: FloatArray, box: float, daring: Daring,
    seed: Sequence[int],
) -> FloatArray:  # fmt: skip
    """Point of the largest prospect within a box about the centre and the unit cube (m,)."""
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
