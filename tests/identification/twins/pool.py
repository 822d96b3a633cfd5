"""Twins on several processes; each that is finished is kept at once, and one that is kept is not computed again."""

import multiprocessing
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from itertools import islice
from typing import TypeAlias

from skisnow._support.processes.crews import begin_worker, interrupts_ignored

from .kept import KeptTwins, Row

Twin: TypeAlias = Callable[[str, int], list[tuple[str, Row]]]
"""From a case and a seed to rows by case; the first of them is the case itself, the last to be kept."""


def run_twins(
    twin: Twin, asked: Iterable[tuple[str, int]], kept: KeptTwins, *, workers: int, seconds: float | None = None
) -> int:
    """Compute what is missing, in the order asked, and say how many were computed.

    After `seconds` no twin is begun any more. Ctrl-C ends those under way and keeps those that are finished.
    """
    missing = [each for each in asked if each not in kept.rows]
    if workers == 1 or not missing:
        return _one_by_one(twin, missing, kept, seconds)
    return _side_by_side(twin, missing, kept, workers, seconds)


def _one_by_one(twin: Twin, missing: Sequence[tuple[str, int]], kept: KeptTwins, seconds: float | None) -> int:
    begun, done = time.monotonic(), 0
    for case, seed in missing:
        if seconds is not None and time.monotonic() - begun > seconds:
            break
        _keep(kept, seed, twin(case, seed))
        done += 1
        _told(case, done, len(missing), begun)
    return done


def _side_by_side(
    twin: Twin, missing: Sequence[tuple[str, int]], kept: KeptTwins, workers: int, seconds: float | None
) -> int:
    begun, done, waiting = time.monotonic(), 0, iter(missing)
    under_way: dict[Future[list[tuple[str, Row]]], tuple[str, int]] = {}
    context = multiprocessing.get_context("spawn")
    alive, leash = context.Pipe(duplex=False)
    with leash, ProcessPoolExecutor(workers, mp_context=context, initializer=begin_worker, initargs=(alive,)) as pool:
        try:
            while True:
                late = seconds is not None and time.monotonic() - begun > seconds
                with interrupts_ignored():
                    for case, seed in islice(waiting, 0 if late else workers - len(under_way)):
                        under_way[pool.submit(twin, case, seed)] = (case, seed)
                if not under_way:
                    return done
                for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                    case, seed = under_way.pop(future)
                    _keep(kept, seed, future.result())
                    done += 1
                    _told(case, done, len(missing), begun)
        except KeyboardInterrupt:
            leash.close()  # a twin takes minutes; half of one does not count
            raise


def _keep(kept: KeptTwins, seed: int, rows: Sequence[tuple[str, Row]]) -> None:
    for case, row in reversed(rows):
        kept.add(case, seed, row)


def _told(case: str, done: int, of: int, begun: float) -> None:
    print(f"  {case}: {done} of {of} twins, {time.monotonic() - begun:.0f} s", file=sys.stderr, flush=True)
