"""Timing that a shared machine cannot fool much: the median of several runs, two rivals taken in turn."""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(frozen=True, slots=True)
class Measurement:
    """One row of the table; ``ratio`` is the peer's median time over ours."""

    what: str
    seconds: float
    goal: str
    peer: str = ""
    ratio: float | None = None

    @staticmethod
    def header() -> str:
        return f"{'what':<62} {'median':>12}  {'goal':<16} peer, its time over ours"

    def __str__(self) -> str:
        beside = "" if self.ratio is None else f"{self.peer}: {self.ratio:.1f} x"
        return f"{self.what:<62} {self.seconds * 1e3:>9.1f} ms  {self.goal:<16} {beside}"


def timed(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def in_turn(ours: Callable[[], object], theirs: Callable[[], object], *, runs: int = 7) -> tuple[float, float]:
    """Median seconds of both, A B A B …, after one run of each that is not counted."""
    ours()
    theirs()
    pairs = [(timed(ours), timed(theirs)) for _ in range(runs)]
    return statistics.median(a for a, _ in pairs), statistics.median(b for _, b in pairs)
