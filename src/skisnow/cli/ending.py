"""SIGTERM as an orderly end: workers are stopped and what was finished is kept, as with Ctrl-C."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator


class Ended(KeyboardInterrupt):
    """The system asked this process to end."""


@dataclass(slots=True)
class Ending:
    """Whether the system asked this process to end: also where the interrupt was caught on its way."""

    asked: bool = False

    def status(self) -> int:
        """The exit status of an interrupted command: 143 where the system asked, else 130."""
        return 143 if self.asked else 130

    def _ask(self, *_: Any) -> None:
        self.asked = True
        raise Ended


@contextmanager
def ending_is_an_interrupt() -> Iterator[Ending]:
    """Raise `Ended` at SIGTERM; only the main thread can, in another one nothing changes."""
    ending = Ending()
    if threading.current_thread() is not threading.main_thread():
        yield ending
        return
    before = signal.signal(signal.SIGTERM, ending._ask)
    try:
        yield ending
    finally:
        signal.signal(signal.SIGTERM, before)
