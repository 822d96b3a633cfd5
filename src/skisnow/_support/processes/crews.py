"""Work of a worker (a chunk of points), and its executors: processes or threads here, one of the caller, Dask."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import platform
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache, partial
from importlib.metadata import version
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeAlias

from ...compiled import core
from ..environment import import_extra
from ..errors import ParameterError, SkisnowError
from ..messages import Message
from .kept_rows import NumberedText, Row, json_text

LOST: Final = "scheduler_lost"
"""Code of the error."""
LARGEST_FOR_A_PIPE: Final = 64
"""Points; their rows stay well below the 64 kB that a pipe takes in one piece."""
LARGEST: Final = 10_000
"""Points of one chunk: some megabytes of rows."""
CHUNK_S: Final = 0.25
"""Work (s) that is handed over at once, and that a kill loses (handing over costs 1 ms here)."""


LOST_WORKERS: Final = Message("The scheduler was lost, or gave the work up.")


class Crew:
    """Workers of an executor that compute chunks of points; a submitted chunk returns a future with its rows.

    executor: it is not shut down here.
    compute: function from the points of a chunk to its rows; see `on_workers`.
    size: function that returns how many chunks the executor computes at once, which may change while the work runs.
    close: function that stops the workers of this crew, at once if its argument is True; None: it started none.
    largest: maximum number of points of a chunk.
    """

    chunk_s: float = CHUNK_S
    """Work of one chunk (s)."""

    def __init__(
        self,
        executor: Executor,
        compute: Callable[[list[Numbered]], Done],
        size: Callable[[], int],
        close: Callable[[bool], None] | None = None,
        *,
        largest: int = LARGEST,
    ) -> None:
        self._executor, self._compute, self._size, self._close = executor, compute, size, close
        self.largest = largest

    def size(self) -> int:
        """Number of chunks that are computed at once."""
        return max(1, self._size())

    def submit(self, points: list[Numbered]) -> Future[Done]:
        """Submit a chunk to the workers; a process that starts with it ignores Ctrl-C, which the parent handles."""
        with interrupts_ignored():
            return self._executor.submit(self._compute, points)

    def explain(self, error: Exception) -> Message | None:
        """Message that explains a failure of the workers; None for an error that the computed function raised."""
        if isinstance(error, BrokenExecutor):
            return Message("A worker process ended unexpectedly, perhaps for lack of memory.")
        is_lost = isinstance(error, CancelledError) or (isinstance(error, SkisnowError) and error.code == LOST)
        return LOST_WORKERS if is_lost else None

    def require_alive(self) -> None:
        """Raise an error if no worker can compute the chunks; called regularly during the wait."""

    def end(self, *, at_once: bool) -> None:
        """Stop the workers that this crew started; `at_once`: in the middle of their work, if possible."""
        if self._close is not None:
            self._close(at_once)


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

    return Crew(executor, _in_worker, lambda: workers, close, largest=LARGEST_FOR_A_PIPE)


def on_workers(function: PointFunction) -> Callable[[list[Numbered]], Done]:
    """Function that computes a chunk on a worker of any computer; it contains `function` in pickled form."""
    return partial(compute_on_worker, pickle.dumps(function), own_identity(), str(Path.cwd()))


class _Worker:
    """Function of this worker process, set by `_prepare_worker`; None in every other process."""

    function: PointFunction | None = None


def _prepare_worker(function: PointFunction, alive: Connection) -> None:
    """Store the function in this worker process, and end the process when its parent ends, however that ends."""
    begin_worker(alive)
    _Worker.function = function


def _in_worker(points: list[Numbered]) -> Done:
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


class Identity(NamedTuple):
    """Version of skisnow and hash of its core's source: equal identities give the same bits on one kind of machine."""

    version: str
    core: str

    def __str__(self) -> str:
        """In words."""
        return f"skisnow {self.version} with the core {self.core}"


@lru_cache(maxsize=1)
def own_identity() -> Identity:
    """Version and core of this process's skisnow, cached because reading the version takes milliseconds."""
    return Identity(version("skisnow"), core.SOURCE_HASH)


def compute_rows(function: PointFunction, points: Sequence[Numbered]) -> Done:
    """Call a function for numbered points; returns their rows and the mean time of a point (s)."""
    start = time.perf_counter()
    rows = [(number, json_text(function(point))) for number, point in points]
    return Done(rows, (time.perf_counter() - start) / max(len(rows), 1))


def compute_on_worker(packed: bytes, identity: Identity, folder: str, points: Sequence[Numbered]) -> Done:
    """Compute rows of points by a pickled function; the worker caches the last four functions.

    identity: version and core of the sender's skisnow.
    folder: working folder of the sender; the worker changes to it if it exists here.
    """
    if identity != own_identity():
        raise SkisnowError(
            "The worker on {node} has {installed}, this computer has {expected}. Install the same on both."
        ).tag("different_versions", node=platform.node(), installed=own_identity(), expected=identity)
    return compute_rows(_unpacked(packed, folder), points)


@lru_cache(maxsize=4)
def _unpacked(packed: bytes, folder: str) -> Any:
    """Unpickle a function after a change to the sender's folder, and check that its input files are the same here."""
    if Path(folder).is_dir() and folder != str(Path.cwd()):
        os.chdir(folder)
    function = pickle.loads(packed)
    if (require_files := getattr(function, "require_files", None)) is not None:
        require_files()  # an error if a file differs from that of the sender
    return function


_NOT_LOADED: Final = ("Can't get attribute", "deserializ")
"""Texts of Python and Dask where a function is not there."""
WAIT_S: Final = 30.0
"""Time-out (s) for the answer of a scheduler."""
AWAY_S: Final = 10.0
"""Time (s) that a scheduler may be unreachable during the work."""
COUNTED_EVERY_S: Final = 1.0
"""Interval (s) between counts of the workers, which come and go."""


def require_scheduler(address: str) -> None:
    """Raise an error for an address without ``://``, or if Dask is not installed; no connection is made."""
    if "://" not in address:
        raise ParameterError(
            "The scheduler is {scheduler!r}. It must be an address such as tcp://host:8786, threads or processes."
        ).tag("unknown_executor", scheduler=address)
    _distributed()


def is_plain(address: str) -> bool:
    """True if the connection to a scheduler at this address is not encrypted, so that its network must be trusted."""
    return not address.startswith(("tls://", "wss://"))


def crew_of_scheduler(address: str, function: PointFunction) -> Crew:
    """Connect to a Dask scheduler and return its workers as a crew; certificates are those of Dask's configuration."""
    require_scheduler(address)
    try:
        client = _distributed().Client(address, timeout=WAIT_S, name="skisnow")
    except (OSError, ValueError, TypeError) as error:
        raise SkisnowError(_no_answer_message(address, error)).tag("no_scheduler") from error
    return DaskCrew(function, client, client.close)


def _no_answer_message(address: str, error: Exception) -> Message:
    if not is_plain(address):
        return Message(
            "No connection to the scheduler at {address} ({error}). It uses certificates. Check that it runs, and that "
            "Dask's configuration (distributed.comm.tls) names the same authority, and a certificate with its key.",
            address=address,
            error=error,
        )
    return Message(
        "No scheduler answers at {address} ({error}). Start one with `dask scheduler`, and workers with "
        "`dask worker`; both print their address.",
        address=address,
        error=error,
    )


class DaskCrew(Crew):
    """Workers of a Dask client. The scheduler repeats the chunk of a lost worker on another one."""

    chunk_s = 1.0  # from one piece to the next a worker takes some 10 ms, 50 where its cores are wanted by others

    def __init__(self, function: PointFunction, client: Any, close: Callable[[], None] | None = None) -> None:
        executor = client.get_executor(pure=False)
        super().__init__(executor, on_workers(function), self._threads, close and (lambda _: close()))
        self._client = client
        self._counted, self._at, self._last_seen = 1, -COUNTED_EVERY_S, time.monotonic()

    def _threads(self) -> int:
        if time.monotonic() - self._at > COUNTED_EVERY_S:
            with suppress(Exception):  # it does not answer: `require_alive` says so after a while
                self._counted = sum(self._client.nthreads(callback_timeout=COUNTED_EVERY_S).values())
            self._at = time.monotonic()
        return self._counted

    def require_alive(self) -> None:
        """Raise an error if the scheduler was unreachable for more than `AWAY_S` seconds or closed the connection."""
        if self._client.status == "running":
            self._last_seen = time.monotonic()
        elif time.monotonic() - self._last_seen > AWAY_S or self._client.status == "closed":
            raise SkisnowError(LOST_WORKERS).tag(LOST)

    def explain(self, error: Exception) -> Message | None:
        """Message that explains an error of Dask; for other errors as in `Crew`."""
        if isinstance(error, ImportError) or any(word in str(error) for word in _NOT_LOADED):
            return Message(
                "A worker cannot load the computation ({error}). Install the same skisnow there.", error=error
            )
        if type(error).__module__.startswith("distributed"):
            return Message("Dask gave up: {kind}: {error}.", kind=type(error).__name__, error=error)
        return super().explain(error)


def _distributed() -> Any:
    return import_extra("distributed", extra="dask", what=Message("A scheduler"))
