"""Worker processes that stay: one function, many points, chunks of them handed out as workers get free."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any, Final, Self, TypeAlias

from ..errors import ParameterError, SkisnowError
from .kept_rows import NumberedText, Row, row_text
from .worker_process import begin_worker, interrupts_ignored

PointFunction: TypeAlias = Callable[[Any], Row]
Numbered: TypeAlias = tuple[int, Any]
"""A point and its number."""

CHUNK_SECONDS: Final = 0.25
"""Work that is handed over at once, and that a kill loses (modelling assumption: handing over costs 1 ms)."""
LARGEST_CHUNK: Final = 64
"""Points; their rows stay well below the 64 kB that a pipe takes in one piece."""


@dataclass(frozen=True, slots=True)
class _Done:
    rows: list[NumberedText]
    seconds_per_point: float


class Pool:
    """Processes that compute rows of points; to be used in a ``with`` statement, which ends them.

    Parameters
    ----------
    function
        From a point to a row of JSON values. With several workers it is pickled once for each of them.
    workers
        Number of processes, as `workers_in_force` gives it; 1: this process itself.
    advice
        What is kept and what to do, in words, should a process end unexpectedly.

    Notes
    -----
    Processes are started afresh ("spawn"), on every system alike, with the first points, and stay: loading the
    libraries takes long. They end with their parent, however that ends.
    """

    def __init__(self, function: PointFunction, workers: int, *, advice: str) -> None:
        self._function, self._workers, self._advice = function, workers, advice
        self._executor: ProcessPoolExecutor | None = None
        self._leash: Connection | None = None
        self._running: set[Future[_Done]] = set()

    def rows(self, points: Sequence[Numbered]) -> Iterator[list[NumberedText]]:
        """Rows as they come, in any order.

        Raises
        ------
        SkisnowError
            A process ended unexpectedly. What the function raises is passed on.
        """
        if self._workers == 1:
            return ([(number, row_text(self._function(point)))] for number, point in points)
        return self._shared(points)

    def __enter__(self) -> Self:
        """Start nothing yet."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the processes; after an error or an interrupt at once, in the middle of what they do."""
        if kind is not None or any(not future.done() for future in self._running):
            self._let_go()
        if self._executor is not None:
            self._executor.shutdown(wait=True, cancel_futures=True)
        self._let_go()
        self._executor = None

    def _let_go(self) -> None:
        if self._leash is not None:
            self._leash.close()
        self._leash = None

    def _shared(self, points: Sequence[Numbered]) -> Iterator[list[NumberedText]]:
        """Hand out chunks, two for each worker at a time; their size follows from the time that points take."""
        waiting, size, most = deque(points), 1, 2 * self._workers
        try:
            with interrupts_ignored():  # a worker that starts inherits this: Ctrl-C is for the parent alone
                self._running = {self._handed(waiting, 1) for _ in range(min(most, len(waiting)))}
            while self._running:
                ended, self._running = wait(self._running, return_when=FIRST_COMPLETED)
                for future in ended:
                    done = future.result()
                    size = max(1, min(LARGEST_CHUNK, int(CHUNK_SECONDS / max(done.seconds_per_point, 1e-9))))
                    yield done.rows
                fair = max(1, min(size, len(waiting) // most))  # small at the end: all workers end together
                while waiting and len(self._running) < most:
                    self._running.add(self._handed(waiting, fair))
        except BrokenProcessPool as error:
            raise SkisnowError(
                f"a worker process ended unexpectedly, perhaps for lack of memory; {self._advice}"
            ) from error

    def _handed(self, waiting: deque[Numbered], size: int) -> Future[_Done]:
        if self._executor is None:
            context = multiprocessing.get_context("spawn")
            alive, self._leash = context.Pipe(duplex=False)
            self._executor = ProcessPoolExecutor(
                self._workers, mp_context=context, initializer=_begin, initargs=(self._function, alive)
            )
        return self._executor.submit(_chunk, [waiting.popleft() for _ in range(min(size, len(waiting)))])


def workers_in_force(workers: int | None) -> int:
    """A number of workers; None: as many as this process has cores.

    Raises
    ------
    ParameterError
        It is below 1.
    """
    if workers is None:
        return available_cores()
    if workers < 1:
        raise ParameterError(f"workers is {workers}; at least 1 is needed")
    return workers


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _Worker:
    """What a worker process knows; in every other process it stays empty."""

    function: PointFunction | None = None


def _begin(function: PointFunction, alive: Connection) -> None:
    """Start a worker: it ends with its parent, however that ends."""
    begin_worker(alive)
    _Worker.function = function


def _chunk(points: list[Numbered]) -> _Done:
    function = _Worker.function
    if function is None:
        raise SkisnowError("a worker was not started by a Pool")
    start = time.perf_counter()
    rows = [(number, row_text(function(point))) for number, point in points]
    return _Done(rows, (time.perf_counter() - start) / max(len(rows), 1))
