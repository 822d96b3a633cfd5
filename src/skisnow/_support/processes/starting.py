"""How worker processes are started."""

from __future__ import annotations

import multiprocessing
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext


def worker_context() -> ForkServerContext | SpawnContext:
    """Context that starts worker processes without the threads and locks of this process.

    On Linux a server process loads once what this process has loaded of skisnow, and each worker is a fork of it, which
    takes milliseconds. Elsewhere each worker loads skisnow again: Windows has no fork, and that of macOS is not safe
    after its libraries are loaded.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(sorted(name for name in sys.modules if _is_own(name)))
    return context


def load_for_workers() -> None:
    """Begin to load skisnow for later workers in the background, where they are forks; elsewhere do nothing."""
    if sys.platform == "linux":
        from multiprocessing import forkserver

        worker_context()
        with interrupts_ignored():  # at Ctrl-C it would print a trace while it loads
            forkserver.ensure_running()


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


def _is_own(module: str) -> bool:
    return module.partition(".")[0] == "skisnow" and not module.endswith("__main__")
