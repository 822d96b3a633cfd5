"""One function for many points on all cores or an executor: resumable, the same rows for any number of workers.

Workers are processes or threads of this computer, or an executor of the caller; they compute chunks of points.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from dataclasses import dataclass
from functools import partial
from itertools import islice
from multiprocessing.connection import Connection
from typing import Any, Final, Self, TypeAlias

from ..errors import ParameterError, SkisnowError
from ..messages import Message
from .kept_rows import KeptRows, NumberedText, Row, json_text
from .starting import interrupts_ignored, worker_context

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
    Workers share nothing with this process. A script that calls this with several workers needs the usual
    ``if __name__ == "__main__":``.

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
    """Compute the missing rows of points (only those in `numbers` if given) in little memory, and keep them."""
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
        count: number of points (default: counted, so that an iterator is read to its end first).
        """
        if self._executor is None and self._workers == 1:
            return ([(number, json_text(self._function(point)))] for number, point in points)
        if count is None:
            points = list(points)
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
    """Crew for an executor of the caller, or of `workers` processes or threads of this computer."""
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


LARGEST_FOR_A_PIPE: Final = 64
"""Points; their rows stay well below the 64 kB that a pipe takes in one piece."""
LARGEST: Final = 10_000
"""Points of one chunk: some megabytes of rows."""
CHUNK_S: Final = 0.25
"""Work (s) that is handed over at once, and that a kill loses (handing over costs 1 ms here)."""


@dataclass(frozen=True, slots=True)
class Crew:
    """Workers of an executor that compute chunks of points; a submitted chunk returns a future with its rows.

    executor: it is not shut down here.
    compute: function from the points of a chunk to its rows; see `compute_rows`.
    size: number of chunks that the executor computes at once.
    close: function that stops the workers that this crew started; at once, in the middle of their work, if its argument
        is True.
    largest: maximum number of points of a chunk.
    """

    executor: Executor
    compute: Callable[[list[Numbered]], Done]
    size: int
    close: Callable[[bool], object] = bool
    largest: int = LARGEST

    def submit(self, points: list[Numbered]) -> Future[Done]:
        """Submit a chunk to the workers; a process that starts with it ignores Ctrl-C, which the parent handles."""
        with interrupts_ignored():
            return self.executor.submit(self.compute, points)


def process_crew(function: PointFunction, workers: int) -> Crew:
    """Crew of new processes on this computer.

    They start with the first chunk and stay, and end when the connection to their parent closes, however the parent
    ends.
    """
    context = worker_context()
    alive, leash = context.Pipe(duplex=False)
    executor = ProcessPoolExecutor(workers, mp_context=context, initializer=_prepare_worker, initargs=(function, alive))

    def close(at_once: bool) -> None:
        if at_once:
            leash.close()
        executor.shutdown(wait=True, cancel_futures=True)
        leash.close()

    return Crew(executor, _compute_in_worker, workers, close, LARGEST_FOR_A_PIPE)


class _Worker:
    """Function of this worker process, set by `_prepare_worker`; None in every other process."""

    function: PointFunction | None = None


def _prepare_worker(function: PointFunction, alive: Connection) -> None:
    """Store the function in this worker process, and end the process when its parent ends, however that ends."""
    begin_worker(alive)
    _Worker.function = function


def _compute_in_worker(points: list[Numbered]) -> Done:
    """Compute points in this worker process by the function that its pool set; an error without a pool."""
    if _Worker.function is None:
        raise SkisnowError("A worker was not started by a Pool.").tag("no_pool")
    return compute_rows(_Worker.function, points)


def begin_worker(alive: Connection) -> None:
    """Set up a worker process: it ignores Ctrl-C, and ends at once when the parent's end of `alive` is closed."""

    def exit_when_closed() -> None:
        try:
            alive.recv()
        except (EOFError, OSError):
            os._exit(1)

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=exit_when_closed, daemon=True).start()


PointFunction: TypeAlias = Callable[[Any], Row | list[Any]]
Numbered: TypeAlias = tuple[int, Any]
"""A point and its number."""


@dataclass(frozen=True, slots=True)
class Done:
    """Result of a chunk: its rows with their numbers, and the mean wall time of a point (s)."""

    rows: list[NumberedText]
    seconds_per_point: float


def compute_rows(function: PointFunction, points: Sequence[Numbered]) -> Done:
    """Call a function for numbered points; returns their rows and the mean time of a point (s)."""
    start = time.perf_counter()
    rows = [(number, json_text(function(point))) for number, point in points]
    return Done(rows, (time.perf_counter() - start) / max(len(rows), 1))
