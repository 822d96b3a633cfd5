"""SIGTERM as an orderly end: workers are stopped and what was finished is kept, as with Ctrl-C."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator


class Ended(KeyboardInterrupt):
    """The system asked this process to end."""


@contextmanager
def ending_is_an_interrupt() -> Iterator[None]:
    """Raise `Ended` at SIGTERM; only the main thread can, in another one nothing changes."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, _end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _end(*_: Any) -> None:
    raise Ended
