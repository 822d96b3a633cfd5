"""Windows of a search over a course: all turns at once, or those of a window that moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

import numpy as np

from .._support.arrays import FloatArray
from .line import RacingLine, first_gates, with_numbers
from .point import LinePoint, turns_in
from .score import NOT_PASSED
from .search import Batches, Evaluated, Evaluations, minimise
from .surrogate import SurrogateSearch

Progress: TypeAlias = Callable[[str], None]
Search: TypeAlias = Literal["surrogate", "cma"]

RANGES: Final = {"aside": (0.25, 1.75), "along": (-0.25, 0.25), "turning": (0.35, 1.0), "speed": (0.8, 1.6)}
"""Bounds of aside (m), along, turning and speed in the search; nearer to a pole than half a
stance the skier does not pass."""
_WIDTH: Final = np.array([high - low for low, high in RANGES.values()])
_LOW: Final = np.array([low for low, _ in RANGES.values()])


@dataclass(frozen=True, slots=True)
class Windows:
    """Search over a course, window by window.

    made: evaluations so far, to which the search appends.
    search, evaluations, population, spread, settled, seed, window, step, ahead: arguments of `quickest_line`.
    tell: callback for lines on the progress.
    kinds: how many numbers of each turn are searched, the first ones of `RANGES`.
    """

    made: Evaluations
    search: Search
    evaluations: int
    population: int | None
    spread: float
    settled: float
    seed: int
    tell: Progress
    window: int
    step: int
    ahead: int
    kinds: int

    def search_line(self, begun: RacingLine) -> Evaluated:
        """Evaluation of the best line through all gates; the first evaluation is that of the start line `begun`."""
        count = len(begun.turns)
        if self.window == count:
            return self._part(begun, 0, count, count)
        best = self._search_whole_course(begun)
        line = _with_best_turns(begun, best)
        first, end = 0, min(self.window + self.ahead, count)
        while True:
            last = min(first + self.window, count)
            part = self._part(line, first, last, end)
            if part.value < NOT_PASSED:
                line = _with_best_turns(line, part)
                if end == count and part.value < best.value:
                    best = part
                if last == count:
                    return best
                first, end = first + self.step, min(first + self.step + self.window + self.ahead, count)
            elif first == 0:
                return best
            else:
                first = max(0, first - self.step)

    def _search_whole_course(self, begun: RacingLine) -> Evaluated:
        """Best evaluation of a search with equal turns over the whole course; that of the start if its turns differ."""
        batches = self._make_batches(begun, 0, len(begun.turns), len(begun.turns))
        search, place = self._surrogate(batches, 0), self._place(begun, 0, len(begun.turns))
        if self.search == "surrogate" and search.starts_with_equal_turns(place):
            return search.minimise_equal_turns(place, self.evaluations)
        batches.evaluate([place])
        return batches.least

    def _part(self, line: RacingLine, first: int, last: int, end: int) -> Evaluated:
        """Best evaluation of a search over the turns `first` to `last` - 1 of a line; the race ends at gate `end`."""
        batches, place = self._make_batches(line, first, last, end), self._place(line, first, last)
        if self.search == "cma" or self.evaluations == 1:
            return minimise(
                batches, place, count=self.evaluations, population=self.population, spread=self.spread,
                seed=(self.seed, first), settled=self.settled,
            )  # fmt: skip
        return self._surrogate(batches, first).least(place, alike=self.window == len(line.turns))

    def _surrogate(self, batches: Batches, first: int) -> SurrogateSearch:
        """Search by a surrogate model, over the turns from gate `first` on; the seed depends on this gate."""
        return SurrogateSearch(
            batches=batches, count=self.evaluations, kinds=self.kinds, spread=self.spread, seed=(self.seed, first),
            settled=self.settled,
        )  # fmt: skip

    def _make_batches(self, line: RacingLine, first: int, last: int, end: int) -> Batches:
        """Evaluations of lines with new turns `first` to `last` - 1; the race ends at gate `end`."""
        part = first_gates(line, end)

        def point_of(place: FloatArray) -> LinePoint:
            """Racing line of a place (n,) of the search, each number from 0 to 1."""
            shares = np.clip(place, 0.0, 1.0).reshape(-1, self.kinds)  # rounding
            numbers = (_LOW[: self.kinds] + shares * _WIDTH[: self.kinds]).tolist()
            return LinePoint(with_numbers(part, numbers, first), tuple(place.tolist()))

        def told(done: int, least: float) -> None:
            best = f"best {least:.3f} s" if least < NOT_PASSED else "no line through all gates yet"
            self.tell(f"gates {first + 1} to {last}: {done} of {self.evaluations} evaluations, {best}")

        return Batches(evaluations=self.made, point_of=point_of, told=told, first=len(self.made.done))

    def _place(self, line: RacingLine, first: int, last: int) -> FloatArray:
        """Place in the unit cube of the turns `first` to `last` - 1 of a line: the searched numbers of each turn."""
        numbers = np.array([[getattr(turn, name) for name in RANGES] for turn in line.turns[first:last]])
        return np.clip((numbers - _LOW) / _WIDTH, 0.0, 1.0)[:, : self.kinds].ravel()


def _with_best_turns(line: RacingLine, evaluation: Evaluated) -> RacingLine:
    """A line with its first turns replaced by those of an evaluated line, which may have fewer turns."""
    turns = turns_in(evaluation.row)
    return RacingLine(line.course, line.start, (*turns, *line.turns[len(turns) :]))
