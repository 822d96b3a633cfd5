"""Progress on stderr for work that takes longer than a second."""

from __future__ import annotations

import os
import re
import shutil
import sys
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final, Self

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import TracebackType

PAUSE_S: Final = 0.5
_COUNTED: Final = re.compile(r"(\d+) of (\d+)\b")
PAUSE_OF_LINES_S: Final = 10.0
"""Where no line can be rewritten, such as in a log."""
LINES_AT_ONCE: Final = "SKISNOW_PROGRESS_LINES"
"""Environment variable: for a program that reads them, lines come as often as a terminal's."""


class MovingLine:
    """One line of stderr that is written over and at last wiped; elsewhere than on a terminal each text is a line."""

    def __init__(self) -> None:
        self.moves = sys.stderr.isatty()
        self._width = 0

    def show(self, text: str) -> None:
        """Overwrite the previous text; longer texts are cut, because a second line would remain."""
        if self.moves:
            room = max(shutil.get_terminal_size().columns - 1, 10)
            shown = text if len(text) <= room else f"{text[: room - 1]}…"
            sys.stderr.write("\r" + shown.ljust(self._width))
            self._width = len(shown)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()

    def wipe(self) -> None:
        """Leave an empty line, with the next text at its beginning."""
        if self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()
            self._width = 0


class Progress:
    """Callable that prints the current step, first after one second and then from time to time.

    On a terminal one line is rewritten at most twice a second; elsewhere a line is written at most every ten seconds.
    """

    def __init__(self, *, patience_s: float = 1.0, pause_s: float | None = None) -> None:
        self._line = MovingLine()
        self._next = time.monotonic() + patience_s
        self._begun: tuple[tuple[str, int], float, int] | None = None
        often = self._line.moves or LINES_AT_ONCE in os.environ
        self._pause = pause_s if pause_s is not None else PAUSE_S if often else PAUSE_OF_LINES_S

    def __call__(self, text: str) -> None:
        """Show the current step if it is time."""
        time_s = time.monotonic()
        if time_s < self._next:
            return
        self._next = time_s + self._pause
        self._line.show(text + self._left(text, time_s))

    def _left(self, text: str, time_s: float) -> str:
        """The time left of work that is counted, "3 of 15", from the second text of its kind on."""
        counted = _COUNTED.search(text)
        if counted is None or "left" in text:
            return ""
        done, total = int(counted[1]), int(counted[2])
        kind = (text[: counted.start()], total)
        if self._begun is None or self._begun[0] != kind:
            self._begun = (kind, time_s, done)
        _, begun, before = self._begun
        if not before < done < total:
            return ""
        return f", about {(time_s - begun) * (total - done) / (done - before):.0f} s left"

    def __enter__(self) -> Self:
        """Start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Take the line away."""
        self._line.wipe()


@contextmanager
def announced(doing: str, *, patience_s: float = 2.0, usual_s: float | None = None) -> Iterator[None]:
    """Print the current step if it takes longer than this; on a terminal also the elapsed and the usual time."""
    line, done, begun = MovingLine(), threading.Event(), time.monotonic()
    about = "" if usual_s is None else f" of about {usual_s:.0f} s"

    def tell() -> None:
        if done.wait(patience_s):
            return
        if not line.moves:
            line.show(f"{doing} …{about and f' about {usual_s:.0f} s'}")
            return
        while True:
            line.show(f"{doing} … {time.monotonic() - begun:.0f} s{about}")
            if done.wait(PAUSE_S):
                return

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join()
        line.wipe()
