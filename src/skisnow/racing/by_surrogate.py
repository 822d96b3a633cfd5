"""A search that asks a Gaussian process where to evaluate next: for evaluations that take seconds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.stats import qmc

from .score import NOT_PASSED
from .search import Batches, Evaluated, optimiser_within
from .surrogate import Surrogate, learnable

FloatArray: TypeAlias = npt.NDArray[np.float64]

HOPES: Final = (0.0, 1.0, 0.5, 2.0)
"""By how many deviations below its mean the process is asked, one place of a batch after the other: the first where
it expects the least, the last where it knows little (modelling assumption)."""
BOX: Final = (0.02, 0.5)
"""Half of the box about the best in which it is asked: the least, below which the search is over, and the greatest, in
shares of each range (modelling assumption)."""
BOX_CHANGES: Final = (0.8, 1.3)
"""Of that box after a batch without a better value, and with one (modelling assumption)."""
ASKED: Final = 50
"""Generations in which the least of the process is sought (modelling assumption)."""
ALIKE: Final = 0.5
"""Share of all evaluations with the same numbers for all turns (modelling assumption)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SurrogateSearch:
    """How to search.

    Attributes
    ----------
    batches
        Where they are made.
    count
        Evaluations after which no new batch begins.
    kinds
        Numbers of a turn.
    spread
        Of the first evaluations: half of the box about the start is twice as much.
    seed
        Numbers from 0 on.
    settled
        Ends the search before, where all values of two batches lie within so much.
    """

    batches: Batches
    count: int
    kinds: int
    spread: float
    seed: Sequence[int]
    settled: float = 0.0

    def least(self, start: FloatArray) -> Evaluated:
        """The least; where all turns begin alike they are searched alike at first, then each for itself.

        References
        ----------
        * Jones, Schonlau and Welch (1998), "Efficient global optimization of expensive black-box functions", Journal of
          Global Optimization 13, 455-492, doi 10.1023/A:1008306431147.
        * Eriksson and others (2019), "Scalable global optimization via local Bayesian optimization", Advances in Neural
          Information Processing Systems 32, doi 10.48550/arXiv.1910.01739.
        """
        self.batches.evaluate([np.asarray(start, float)])
        turns = len(start) // self.kinds
        each_alike = np.tile(np.eye(self.kinds), (turns, 1))
        if turns > 1 and np.array_equal(np.tile(start[: self.kinds], turns), start):
            self._narrow(each_alike, self.first_of(self.kinds), math.ceil(ALIKE * self.count), 0)
        self._narrow(np.eye(len(start)), len(start) // 2, self.count, 1)
        return self.batches.least

    @staticmethod
    def first_of(numbers: int) -> int:
        """Evaluations before the process is asked."""
        return 2 * numbers + 2

    def _narrow(self, directions: FloatArray, drawn: int, count: int, phase: int) -> None:
        """Go on until `count`, moving by directions (n, m) from the best."""
        box, size = min(2.0 * self.spread, BOX[1]) / (1 + phase), directions.shape[1]
        shares = qmc.LatinHypercube(size, rng=np.random.default_rng([*self.seed, phase])).random(drawn)
        begin = self._numbers(directions, np.array(self.batches.least.place))
        if len(self.batches.found) < count:
            self.batches.evaluate([directions @ np.clip(begin + box * (2.0 * each - 1.0), 0.0, 1.0) for each in shares])
        while len(self.batches.found) < count and box > BOX[0]:
            before = self.batches.least.value
            self.batches.evaluate(self._chosen(directions, box, phase))
            better = self.batches.least.value < before - self.settled
            box = min(BOX[1], box * BOX_CHANGES[better])
            last = [each.value for each in self.batches.found[-2 * len(HOPES) :]]
            if max(last) - min(last) < self.settled:
                return

    def _chosen(self, directions: FloatArray, box: float, phase: int) -> list[FloatArray]:
        """A batch, each place as if those before it had given what is expected."""
        places = np.array([each.place for each in self.batches.found])
        values = learnable([each.value for each in self.batches.found])
        known = Surrogate.of(places, values, self.kinds)
        passed = np.array([each.value < NOT_PASSED for each in self.batches.found])
        expected = np.where(passed | ~passed.any(), known.at(places)[0], np.inf)
        centre = self._numbers(directions, places[int(np.argmin(expected))])
        chosen: list[FloatArray] = []
        for hope in HOPES:
            seed = (*self.seed, phase, len(self.batches.found), len(chosen))
            place = directions @ _least_within(known, directions, centre, box, hope, seed)
            chosen.append(place)
            known = known.believing(place)
        return chosen

    @staticmethod
    def _numbers(directions: FloatArray, place: FloatArray) -> FloatArray:
        """By how much of each direction a place is reached, or the nearest to it."""
        return np.asarray(np.linalg.lstsq(directions, place)[0], np.float64)


def _least_within(
    known: Surrogate, directions: FloatArray, centre: FloatArray, box: float, hope: float, seed: Sequence[int]
) -> FloatArray:
    """Where mean less `hope` deviations is least, within a box about the centre and the unit cube (m,)."""
    limits = np.stack([np.maximum(centre - box, 0.0), np.minimum(centre + box, 1.0)], axis=1)
    optimiser = optimiser_within(limits, np.clip(centre, *limits.T), 0.4 * box, seed)
    best, least = centre, math.inf
    for _ in range(ASKED):
        asked = np.array([optimiser.ask() for _ in range(optimiser.population_size)])
        mean, deviation = known.at(asked @ directions.T)
        values = mean - hope * deviation
        optimiser.tell(list(zip(asked, values.tolist(), strict=True)))
        if values.min() < least:
            best, least = asked[int(np.argmin(values))], float(values.min())
        if optimiser.should_stop():
            break
    return best
