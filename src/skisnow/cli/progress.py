"""Progress on stderr for what takes longer than a second."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Self

if TYPE_CHECKING:
    from types import TracebackType


class Progress:
    """A callable that says what is being done, once the work has taken a second and then at most twice a second.

    On a terminal one line is rewritten; elsewhere each message is a line of its own.
    """

    def __init__(self, *, patience_s: float = 1.0, pause_s: float = 0.5) -> None:
        self._next = time.monotonic() + patience_s
        self._pause = pause_s
        self._width = 0

    def __call__(self, text: str) -> None:
        """Take note of what is being done."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + self._pause
        if sys.stderr.isatty():
            sys.stderr.write("\r" + text.ljust(self._width))
            self._width = len(text)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def __enter__(self) -> Self:
        """Start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the terminal on a fresh line."""
        if self._width:
            sys.stderr.write("\n")
            sys.stderr.flush()
