"""Many points, one function, all cores: parallel, resumable, and the same rows whatever the number of workers."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Final, TypeAlias

from ..errors import ParameterError, SkisnowError
from .batch_file import KeptRows, NumberedText, Row, row_text
from .worker_process import begin_worker, interrupts_ignored

PointFunction: TypeAlias = Callable[[Any], Row]
Told: TypeAlias = Callable[[int, int], None]
"""Takes the number of finished points and that of all."""

CHUNK_SECONDS: Final = 0.25
"""Work that is handed over at once, and that a kill loses (Choice: handing over costs 1 ms)."""
LARGEST_CHUNK: Final = 64
"""Points; their rows stay well below the 64 kB that a pipe takes in one piece."""


@dataclass(frozen=True, slots=True)
class _Done:
    rows: list[NumberedText]
    seconds_per_point: float


def run_batch(
    points: Sequence[Any],
    function: PointFunction,
    *,
    kept: KeptRows | None = None,
    workers: int | None = None,
    progress: Told | None = None,
) -> list[Row]:
    """Rows of all points, in their order.

    Parameters
    ----------
    points
        What the function takes; with several workers they are pickled.
    function
        From a point to a row of JSON values. With several workers it is pickled once for each of them: a function of a
        module, or an instance of a class of a module. An error that it raises ends the batch; a function whose points
        may fail one by one turns its errors into rows.
    kept
        Rows that are finished already, and where to keep new ones; None: nowhere.
    workers
        Number of processes; None: as many as this process has cores; 1: this process itself.
    progress
        Is told the number of finished points and that of all.

    Returns
    -------
    list of dict
        One row for each point.

    Raises
    ------
    ParameterError
        The number of workers is below 1.
    SkisnowError
        A worker ended unexpectedly; what was finished is kept.

    See Also
    --------
    skisnow.study : points from a file.

    Notes
    -----
    Workers are started afresh ("spawn"), on every system alike. A script that calls this with several workers needs
    the usual ``if __name__ == "__main__":``.

    References
    ----------
    The page docs/how-to/study.md.
    """
    kept = kept if kept is not None else KeptRows()
    require_workers(workers)
    wanted = available_cores() if workers is None else workers
    missing = [number for number in range(len(points)) if number not in kept.rows]

    def tell() -> None:
        if progress is not None:
            progress(len(kept.rows), len(points))

    tell()
    processes = min(wanted, len(missing))
    computed = _shared(points, function, missing, processes) if processes > 1 else _alone(points, function, missing)
    with closing(computed):  # also when interrupted here: workers must not outlive this call
        for done in computed:
            kept.add(done)
            tell()
    return [kept.rows[number] for number in range(len(points))]


def require_workers(workers: int | None) -> None:
    """Refuse a number of workers that is none."""
    if workers is not None and workers < 1:
        raise ParameterError(f"workers is {workers}; at least 1 is needed")


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _alone(points: Sequence[Any], function: PointFunction, missing: Sequence[int]) -> Generator[list[NumberedText]]:
    for number in missing:
        yield [(number, row_text(function(points[number])))]


def _shared(
    points: Sequence[Any], function: PointFunction, missing: Sequence[int], workers: int
) -> Generator[list[NumberedText]]:
    """Hand out chunks, two for each worker at a time; their size follows from the time that points take."""
    context = multiprocessing.get_context("spawn")
    alive, leash = context.Pipe(duplex=False)
    waiting, running = deque(missing), set[Future[_Done]]()
    size = 1
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_begin, initargs=(function, alive))
    try:
        with interrupts_ignored():  # a worker that starts inherits this: Ctrl-C is for the parent alone
            running = {pool.submit(_chunk, _taken(points, waiting, 1)) for _ in range(min(2 * workers, len(waiting)))}
        while running:
            ended, running = wait(running, return_when=FIRST_COMPLETED)
            for future in ended:
                done = future.result()
                size = max(1, min(LARGEST_CHUNK, int(CHUNK_SECONDS / max(done.seconds_per_point, 1e-9))))
                yield done.rows
            fair = max(1, min(size, len(waiting) // (2 * workers)))  # small at the end: all workers end together
            while waiting and len(running) < 2 * workers:
                running.add(pool.submit(_chunk, _taken(points, waiting, fair)))
    except BrokenProcessPool as error:
        raise SkisnowError(
            "a worker process ended unexpectedly, perhaps for want of memory; finished points are kept. "
            "Start again, with fewer workers"
        ) from error
    except BaseException:
        leash.close()  # workers leave in the middle of what they do
        raise
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
        leash.close()


def _taken(points: Sequence[Any], waiting: deque[int], size: int) -> list[tuple[int, Any]]:
    numbers = [waiting.popleft() for _ in range(min(size, len(waiting)))]
    return [(number, points[number]) for number in numbers]


class _Worker:
    """What a worker process knows; in every other process it stays empty."""

    function: PointFunction | None = None


def _begin(function: PointFunction, alive: Connection) -> None:
    """Start a worker: it ends with its parent, however that ends."""
    begin_worker(alive)
    _Worker.function = function


def _chunk(numbered: list[tuple[int, Any]]) -> _Done:
    function = _Worker.function
    if function is None:
        raise SkisnowError("a worker was not started by run_batch")
    start = time.perf_counter()
    rows = [(number, row_text(function(point))) for number, point in numbered]
    return _Done(rows, (time.perf_counter() - start) / max(len(rows), 1))
