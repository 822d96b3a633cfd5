"""Work of a worker (a chunk of points), and its executors: processes or threads here, or one of the caller."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Final, TypeAlias

from ..errors import SkisnowError
from .kept_rows import NumberedText, Row, json_text

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

    They start with the first chunk ("spawn", on every system) and stay, because loading the libraries takes long. They
    end when the connection to their parent closes, however the parent ends.
    """
    context = multiprocessing.get_context("spawn")
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


@contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Ignore interrupts while processes start, which inherit this; no effect outside the main thread."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def begin_worker(alive: Connection) -> None:
    """Set up a worker process: it ignores Ctrl-C and ends when the parent's end of `alive` is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_exit_when_parent_ends, args=(alive,), daemon=True).start()


def _exit_when_parent_ends(alive: Connection) -> None:
    """Wait until the parent process ends, then end this one at once with status 1."""
    try:
        alive.recv()
    except (EOFError, OSError):
        os._exit(1)


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
