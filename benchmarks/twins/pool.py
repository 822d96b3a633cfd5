"""Twins on several processes; each that is finished is kept at once, and one that is kept is not computed again."""

import math
import multiprocessing
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import TypeAlias

from .kept import KeptTwins, Row

Twin: TypeAlias = Callable[[str, int], list[tuple[str, Row]]]
"""From a case and a seed to rows by case; the first of them is the case itself, the last to be kept."""


def run_twins(
    twin: Twin, asked: Iterable[tuple[str, int]], kept: KeptTwins, *, workers: int, seconds: float = math.inf
) -> int:
    """Compute what is missing and return how many were kept; the first that ends after `seconds` is the last."""
    missing = [each for each in asked if each not in kept.rows]
    begun, done = time.monotonic(), 0
    for done, (seed, rows) in enumerate(_finished(twin, missing, workers), 1):
        for case, row in reversed(rows):
            kept.add(case, seed, row)
        passed = time.monotonic() - begun
        print(f"  {rows[0][0]}: {done} of {len(missing)} twins, {passed:.0f} s", file=sys.stderr, flush=True)
        if passed > seconds:
            break
    return done


def _finished(
    twin: Twin, missing: Sequence[tuple[str, int]], workers: int
) -> Iterator[tuple[int, list[tuple[str, Row]]]]:
    """Seeds and rows of the twins, as they come."""
    if workers == 1:
        yield from ((seed, twin(case, seed)) for case, seed in missing)
        return
    with ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        seeds = {pool.submit(twin, case, seed): seed for case, seed in missing}
        try:
            for future in as_completed(seeds):
                yield seeds[future], future.result()
        finally:
            pool.shutdown(cancel_futures=True)
