"""Separate processes: with limits on time and memory for uploads, and a worker for long tasks such as figures."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import multiprocessing
import os
import signal
import sys
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Final, ParamSpec, TypeVar

from .._support.errors import FieldDataError, OutputError, ParameterError, SkisnowError, StoreError

Given = ParamSpec("Given")
Answer = TypeVar("Answer")

_LOG: Final = logging.getLogger("skisnow.web")
_LAST_WORDS: Final = 4000


@dataclass(frozen=True, slots=True)
class Bounds:
    """Limits on time and memory; a campaign with a million readings takes 20 s and 1 GB on a laptop."""

    seconds: float = 120.0
    memory_bytes: int = 3_000_000_000


BOUNDS: Final = Bounds()
SKI_BOUNDS: Final = Bounds(seconds=60.0)  # most of it is the start of the process, on a busy laptop


def confined(bounds: Bounds, work: Callable[Given, Answer], *args: Given.args, **named: Given.kwargs) -> Answer:
    """Call a function of a module in a separate process with limits; arguments and result are copies.

    Raises ParameterError: the function exceeds the limits or ends its process. Errors of the function are raised here,
        too.
    """
    assert not named
    context = multiprocessing.get_context("spawn")  # never by fork: the server has threads
    hears, tells = context.Pipe(duplex=False)
    process = context.Process(target=_run_confined, args=(tells, bounds, work, args), daemon=True)
    process.start()
    tells.close()
    try:
        if not hears.poll(bounds.seconds):
            raise ParameterError("it was not read within {seconds:g} s; give less of it, or check the file").tag(
                "too_slow", seconds=bounds.seconds
            )
        answer, trace = hears.recv()
    except EOFError as end:
        raise _limit_error(bounds) from end
    finally:
        process.kill()
        process.join()
        hears.close()
    if trace:
        _LOG.error("an upload could not be read: %s", trace)
    if isinstance(answer, SkisnowError):
        raise answer
    result: Answer = answer
    return result


def _limit_error(bounds: Bounds) -> ParameterError:
    return ParameterError(
        "reading it failed: it is damaged, nested too deep, or takes more than {seconds:g} s and {megabytes} MB; "
        "check the file"
    ).tag("cannot_read", seconds=bounds.seconds, megabytes=bounds.memory_bytes // 1_000_000)


def _run_confined(tells: Connection, bounds: Bounds, work: Callable[..., object], args: tuple[object, ...]) -> None:
    """Function of the new process: set limits, call the function, send the result."""
    end_with_server()
    _set_limits(bounds)
    answer: tuple[object, str]
    try:
        answer = (work(*args), "")
    except (FieldDataError, StoreError, OutputError) as error:
        answer = (error, "")
    except SkisnowError as error:
        answer = (ParameterError(error.message).tag(error.code), "")
    except Exception:  # logged by the server
        answer = (_limit_error(bounds), traceback.format_exc()[-_LAST_WORDS:])
    tells.send(answer)


def _set_limits(bounds: Bounds) -> None:
    """Set the limits of the operating system if it has them; the caller limits the time as well."""
    if sys.platform == "win32":
        return
    import resource

    seconds = int(bounds.seconds) + 1
    limits = ((resource.RLIMIT_CPU, seconds), (resource.RLIMIT_DATA, bounds.memory_bytes), (resource.RLIMIT_CORE, 0))
    for kind, most in limits:
        with contextlib.suppress(ValueError, OSError):  # already lower, or not supported
            resource.setrlimit(kind, (most, most))


class Worker:
    """Worker process for one task after another, started for the first one."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    async def do(self, work: Callable[Given, Answer], *args: Given.args, **named: Given.kwargs) -> Answer:
        """Call a function of a module in the worker process; arguments and result are copies."""
        assert not named
        if self._pool is None:
            # never by fork: the server has threads
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=end_with_server)
        return await asyncio.get_running_loop().run_in_executor(self._pool, work, *args)

    def end(self) -> None:
        """End the process after its current task; waiting tasks are cancelled."""
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)


def end_with_server() -> None:
    """Ignore Ctrl-C, which the server handles, and end with the server."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    assert parent is not None

    def watch() -> None:
        wait([parent.sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
