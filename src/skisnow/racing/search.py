"""A search by CMA-ES, batch by batch: the same numbers for the same seed, and no evaluation twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .._support.environment import import_extra
from .._support.errors import ParameterError
from .._support.messages import Message
from .._support.processes.batch import Pool
from .._support.processes.kept_rows import KeptRows, Row

Told: TypeAlias = Callable[[int, float], None]
"""Takes the number of evaluations so far and the least value among them."""

FAILED: Final = 1e6
"""Value of an evaluation that is not finite."""


@dataclass(frozen=True, slots=True)
class Evaluated:
    """Result of one evaluation: its number, place in the unit cube, and row.

    number: number in the order of the search, 0 or more.
    place: place of the evaluated point in the unit cube (n,).
    row: result of the evaluated function; its `value` is minimised.
    """

    number: int
    place: tuple[float, ...]
    row: Row

    @property
    def value(self) -> float:
        """Number that the search minimises: the time (s), or above 1000 for a line that fails."""
        return float(self.row["value"])


@dataclass(slots=True)
class Evaluations:
    """Evaluates batches of points in several processes and stores the results.

    pool: workers that compute the row of each point.
    kept: finished rows by number; each contains the place of its point.
    done: all evaluations, in their order.
    """

    pool: Pool
    kept: KeptRows
    done: list[Evaluated]

    def of(self, candidates: Sequence[tuple[Any, FloatArray]]) -> Iterator[int]:
        """Evaluate pairs of the function's input and its place; append the results to `done`.

        Yields the number of finished pairs from time to time.
        """
        first = len(self.done)
        points = {first + i: point for i, (point, _) in enumerate(candidates)}
        missing = [(number, point) for number, point in points.items() if number not in self.kept]
        finished = len(points) - len(missing)
        for rows in self.pool.rows(missing, len(missing)):
            finished += self.kept.add(rows)
            yield finished
        for number, (_, place) in zip(points, candidates, strict=True):
            row = self.kept.row(number)
            if row["place"] != place.tolist():
                raise ParameterError(
                    "a stored evaluation has another point than this search: it comes from another machine or "
                    "library. Remove the file to start again"
                ).tag("different_versions")
            self.done.append(Evaluated(number, tuple(place.tolist()), row))


@dataclass(frozen=True, slots=True, kw_only=True)
class Batches:
    """Evaluations of one search, batch by batch.

    point_of: function from a place in the unit cube to the input of the evaluated function.
    told: callback with the number of evaluations so far and the smallest value among them.
    first: number of the search's first evaluation.
    """

    evaluations: Evaluations
    point_of: Callable[[FloatArray], Any]
    told: Told
    first: int

    @property
    def found(self) -> list[Evaluated]:
        """Evaluations of this search so far."""
        return self.evaluations.done[self.first :]

    @property
    def least(self) -> Evaluated:
        """Evaluation with the smallest value so far; the first of equal ones."""
        return min(self.found, key=lambda evaluation: _finite_or_failed(evaluation.value))

    def evaluate(self, batch: Sequence[FloatArray]) -> None:
        """Evaluate a batch of places in the unit cube."""
        for more in self.evaluations.of([(self.point_of(place), place) for place in batch]):
            self.told(len(self.found) + more, self.least.value if self.found else FAILED)


def require_cmaes() -> Any:
    """Import the package cmaes; an error states how to install it."""
    return import_extra("cmaes", extra="racing", what=Message("A race"))


def minimise(
    batches: Batches,
    start: FloatArray,
    *,
    count: int,
    population: int | None,
    spread: float,
    seed: Sequence[int],
    settled: float = 0.0,
) -> Evaluated:
    """Best evaluation of a search by CMA-ES in the unit cube with about `count` evaluations, the first at the start.

    start: first point, (n,).
    count: evaluations after which no new batch begins.
    population: size of a batch; None: 4 + 3 ln n.
    spread: standard deviation of the first batch, in shares of each range.
    settled: ends the search earlier, when the values of a batch differ by less than this.

    * Hansen and Ostermeier (2001), "Completely derandomized self-adaptation in evolution strategies", Evolutionary
      Computation 9(2), 159-195, doi 10.1162/106365601750190398.
    """
    batches.evaluate([np.asarray(start, float)])
    if count == 1:
        return batches.least
    optimiser = optimiser_within(
        np.tile([0.0, 1.0], (len(start), 1)), np.clip(start, 0.0, 1.0), spread, seed, population=population
    )
    while len(batches.found) < count and not optimiser.should_stop():
        candidates = [optimiser.ask() for _ in range(optimiser.population_size)]
        batches.evaluate(candidates)
        values = [_finite_or_failed(evaluation.value) for evaluation in batches.found[-len(candidates) :]]
        optimiser.tell(list(zip(candidates, values, strict=True)))
        if max(values) - min(values) < settled:
            break
    return batches.least


def optimiser_within(
    limits: FloatArray, mean: FloatArray, spread: float, seed: Sequence[int], *, population: int | None = None
) -> Any:
    """Seeded optimiser CMA-ES within limits (n, 2), with the mean (n,) and standard deviation of its first batch."""
    state = int(np.random.SeedSequence(list(seed)).generate_state(1)[0])
    return require_cmaes().CMA(mean=mean, sigma=spread, bounds=limits, seed=state, population_size=population)


def _finite_or_failed(value: float) -> float:
    """The value, or the value of a failed evaluation if it is not finite."""
    return value if np.isfinite(value) else FAILED
