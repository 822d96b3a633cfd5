"""One function for many points on all cores or an executor: resumable, the same rows for any number of workers."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from functools import partial
from itertools import islice
from typing import Any, Final, Self, TypeAlias

from ..errors import ParameterError, SkisnowError
from ..messages import Message
from .crews import CHUNK_S, Crew, Done, Numbered, PointFunction, compute_rows, process_crew
from .kept_rows import KeptRows, NumberedText, Row, json_text

Progress: TypeAlias = Callable[[int, int], None]
"""Takes the number of finished points and that of all."""


def run_batch(
    points: Sequence[Any],
    function: PointFunction,
    *,
    kept: KeptRows | None = None,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Call a function for many points, in this or several processes; returns the rows of all points in their order.

    Parameters
    ----------
    points
        Inputs of the function; with several workers they are pickled.
    function
        Function from a point to a row of JSON values. With several workers it is pickled once for each of them: a
        function of a module, or an instance of a class of a module. An error that it raises ends the batch; a function
        for which single points may fail returns its errors as rows.
    kept
        Rows that are finished already, and where to keep new ones; None: nowhere.
    workers
        Number of processes; None: the number of cores available to this process; 1: this process.
    executor
        Executor instead of processes of this computer: "threads"; any `concurrent.futures.Executor`, which is not
        shut down. The rows do not depend on it.
    progress
        Called with the number of finished points and that of all.

    Returns
    -------
    list of dict
        One row for each point.

    Raises
    ------
    ParameterError
        The number of workers is below 1, or the executor is not valid.
    SkisnowError
        A worker ended unexpectedly, or has another version of skisnow; finished rows are kept.

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
    compute_missing(points, function, kept, workers=workers, executor=executor, progress=progress)
    return [row for number, row in kept.rows() if number < len(points)]


def compute_missing(
    points: Sequence[Any],
    function: PointFunction,
    kept: KeptRows,
    *,
    numbers: range | None = None,
    workers: int | None = None,
    executor: ExecutorLike | None = None,
    progress: Progress | None = None,
) -> None:
    """Compute the missing rows of points and add them to `kept`; memory does not grow with their number.

    numbers: numbers of the requested points; None: all.
    """
    wanted = worker_count(workers)
    numbers = range(len(points)) if numbers is None else numbers
    finished = bytearray(len(points))
    for number in kept.numbers():
        if 0 <= number < len(finished):
            finished[number] = True
    done = sum(finished[numbers.start : numbers.stop : numbers.step])
    missing = len(numbers) - done
    tell = progress or (lambda *_: None)
    tell(done, len(numbers))
    advice = Message("Finished points are kept. Start again, with fewer workers.")
    unfinished = ((number, points[number]) for number in numbers if not finished[number])
    with Pool(function, max(1, min(wanted, missing)), advice=advice, executor=executor) as pool:
        for rows in pool.rows(unfinished, missing):
            done += kept.add(rows)
            tell(done, len(numbers))


class Pool:
    """Workers that compute rows of points; to be used in a ``with`` statement, which ends them.

    function: function from a point to a row of JSON values; with several workers it is pickled once for each of them.
    workers: number of processes or threads, as `worker_count` gives it; 1 with no executor: this process itself.
    advice: text for the error of a process that ends unexpectedly: which rows are kept, and what to do.
    """

    def __init__(
        self, function: PointFunction, workers: int, *, advice: str, executor: ExecutorLike | None = None
    ) -> None:
        self._function, self._workers, self._advice, self._executor = function, workers, advice, executor
        self._crew: Crew | None = None
        self._running: set[Future[Done]] = set()

    def rows(self, points: Iterable[Numbered], count: int | None = None) -> Iterator[list[NumberedText]]:
        """Yield lists of finished rows with their numbers, in the order in which they are finished.

        points: pairs of number and point; an iterator is only advanced as needed.
        count: number of points; may be omitted for a list.
        """
        if self._executor is None and self._workers == 1:
            return ([(number, json_text(self._function(point)))] for number, point in points)
        if count is None:
            if not isinstance(points, Collection):
                raise ParameterError("count, the number of points, is missing.").tag("count_missing")
            count = len(points)
        if count == 0:
            return iter(())
        return self._compute_chunks(iter(points), count)

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        """End the workers; after an error or an interrupt at once, in the middle of their work."""
        unfinished = [future for future in self._running if not future.done()]
        for future in unfinished:
            future.cancel()
        if self._crew is not None:
            self._crew.close(kind is not None or bool(unfinished))
        self._crew = None

    def _compute_chunks(self, points: Iterator[Numbered], left: int) -> Iterator[list[NumberedText]]:
        """Yield the rows of each finished chunk of the `left` points; the size of chunks follows the time per point."""
        if self._crew is None:
            executor = "processes" if self._executor is None else self._executor
            self._crew = crew_of(executor, self._function, self._workers)
        crew, size, self._running = self._crew, 1, set()
        try:
            while left or self._running:
                most = 2 * crew.size
                fair = max(1, min(size, left // most))  # small at the end: all workers end together
                while left and len(self._running) < most:
                    chunk = list(islice(points, min(fair, left)))
                    left -= len(chunk)
                    self._running.add(crew.submit(chunk))
                ended, self._running = wait(self._running, return_when=FIRST_COMPLETED)
                for future in ended:
                    done = future.result()
                    size = max(1, min(crew.largest, int(CHUNK_S / max(done.seconds_per_point, 1e-9))))
                    yield done.rows
        except (BrokenExecutor, CancelledError) as error:
            raise SkisnowError("A worker ended unexpectedly, perhaps for lack of memory. {advice}").tag(
                "pool_failed", advice=self._advice
            ) from error


def worker_count(workers: int | None) -> int:
    """Number of workers: `workers`, or the available cores for None; rejects a number below 1."""
    if workers is None:
        return available_cores()
    if workers < 1:
        raise ParameterError("workers is {workers}; at least 1 is needed.").tag("too_few_workers", workers=workers)
    return workers


def available_cores() -> int:
    """Number of processor cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


ExecutorLike: TypeAlias = Executor | str
"""Executor: "processes" or "threads" of this computer, or any `concurrent.futures.Executor`."""

LOCAL: Final = ("processes", "threads")


def crew_of(executor: ExecutorLike, function: PointFunction, workers: int) -> Crew:
    """Crew for an executor: processes or threads of this computer, or an executor of the caller.

    workers: number of workers of this computer, or of an executor that does not report its number.
    """
    require_executor(executor)
    if isinstance(executor, Executor):
        return Crew(executor, partial(compute_rows, function), _workers_of(executor) or workers)
    if executor == "processes":
        return process_crew(function, workers)
    threads = ThreadPoolExecutor(workers)  # the compiled core lets other threads run while it computes
    compute = partial(compute_rows, function)
    return Crew(threads, compute, workers, lambda _: threads.shutdown(wait=True, cancel_futures=True))


def require_executor(executor: ExecutorLike | None) -> None:
    """Raise an error before the work if the executor is neither a valid word nor an `Executor`."""
    if executor is not None and executor not in LOCAL and not isinstance(executor, Executor):
        raise ParameterError(
            "executor is {executor!r}; it must be one of {names}, or a concurrent.futures.Executor"
        ).tag("unknown_executor", executor=executor, names=list(LOCAL))


def _workers_of(executor: Executor) -> int | None:
    """Number of workers of an executor of the standard library or mpi4py; None if it does not report one."""
    names = ("_max_workers", "num_workers")
    workers = next((getattr(executor, name) for name in names if hasattr(executor, name)), None)
    return workers if isinstance(workers, int) and workers > 0 else None
