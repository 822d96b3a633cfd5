"""Output and end of a command: JSON, warnings, progress, the folder for files, and signals."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Self


def print_json(contents: Any) -> None:
    """Print JSON with one space of indentation; a number that is not finite is an error."""
    print(json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1), flush=True)


def print_warnings(warnings: Iterable[object]) -> None:
    """Print each warning in a line of standard error."""
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)


def prepare_output(folder: Path | None) -> None:
    """Make a folder that can be written, and print notes on removed remains of killed processes; nothing for None."""
    from .._support.staging import prepare_folder

    for sentence in prepare_folder(folder) if folder is not None else ():
        print(sentence, file=sys.stderr)


def prepare_figure(place: Path | None) -> None:
    """Check before long work that a figure can be written to a path, as `require_drawable` does; nothing for None."""
    if place is not None:
        from ..report.figures.drawing import require_drawable

        require_drawable(place)


PAUSE_S: Final = 0.5
_COUNTED: Final = re.compile(r"(\d+) of (\d+)\b")
PAUSE_OF_LINES_S: Final = 10.0  # where no line can be rewritten, such as in a log
LINES_AT_ONCE: Final = "SKISNOW_PROGRESS_LINES"
"""Environment variable: for a program that reads them, lines come as often as a terminal's."""


class Progress:
    """Callable that prints the current step of long work, first after one second and then from time to time.

    On a terminal one line is rewritten at most twice a second; elsewhere a line is written at most every ten seconds.
    """

    def __init__(self, *, patience_s: float = 1.0, pause_s: float | None = None) -> None:
        self._rewrites = sys.stderr.isatty()
        self._width = 0
        self._next = time.monotonic() + patience_s
        self._begun: tuple[tuple[str, int], float, int] | None = None
        often = self._rewrites or LINES_AT_ONCE in os.environ
        self._pause = pause_s if pause_s is not None else PAUSE_S if often else PAUSE_OF_LINES_S

    def __call__(self, text: str) -> None:
        """Show the current step if it is time."""
        time_s = time.monotonic()
        if time_s < self._next:
            return
        self._next = time_s + self._pause
        self._show(text + self._time_left(text, time_s))

    def _time_left(self, text: str, time_s: float) -> str:
        """Text with the remaining time of work that is counted as in "3 of 15"; "" for the first text of its kind."""
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

    def __exit__(self, *_: object) -> None:
        """Erase the line."""
        if self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()

    def _show(self, text: str) -> None:
        """Overwrite the previous text of a terminal, cut at its width; elsewhere write a new line."""
        if self._rewrites:
            room = max(shutil.get_terminal_size().columns - 1, 10)
            shown = text if len(text) <= room else f"{text[: room - 1]}…"
            sys.stderr.write("\r" + shown.ljust(self._width))
            self._width = len(shown)
        else:
            sys.stderr.write(text + "\n")
        sys.stderr.flush()


LATER: Final = "writing the computed results first; a second request stops at once"


class Ended(KeyboardInterrupt):
    """Raised when the system asks this process to end (SIGTERM)."""


@dataclass(slots=True)
class Ending:
    """Record of requests to end: `requested` by the system (SIGTERM), `pressed` by Ctrl-C during `finishing`."""

    requested: bool = False
    pressed: bool = False

    def status(self) -> int:
        """Exit status of an interrupted command: 143 after a request of the system, otherwise 130."""
        return 143 if self.requested else 130

    @contextmanager
    def finishing(self) -> Iterator[None]:
        """Run a block, such as the writing of a run, to its end despite one interrupt; a second one stops it."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {number: signal.signal(number, self._record_request) for number in (signal.SIGINT, signal.SIGTERM)}
        already, self._later = self._later, False
        try:
            yield
        finally:
            self._later = already
            for number, handler in before.items():
                signal.signal(number, handler)

    _later: bool = False

    def _interrupt(self, *_: Any) -> None:
        """Signal handler: record the request and raise Ended."""
        self.requested = True
        raise Ended

    def _record_request(self, number: int, _: Any) -> None:
        """Signal handler in `finishing`: record the first request and go on; a second one raises."""
        by_system = number == signal.SIGTERM
        self.requested, self.pressed = self.requested or by_system, self.pressed or not by_system
        if self._later:
            raise Ended if by_system else KeyboardInterrupt
        self._later = True
        with contextlib.suppress(OSError):  # past Python's own buffer, which may be in use at this very moment
            os.write(2, f"{LATER}\n".encode())


@contextmanager
def ending_is_an_interrupt() -> Iterator[Ending]:
    """Raise `Ended` in the block at SIGTERM; yields the record of requests. Only the main thread can do this."""
    ending = Ending()
    if threading.current_thread() is not threading.main_thread():
        yield ending
        return
    before = signal.signal(signal.SIGTERM, ending._interrupt)
    try:
        yield ending
    finally:
        signal.signal(signal.SIGTERM, before)


def report_interrupt(stopped: KeyboardInterrupt, place: Path) -> int:
    """Print the place where the finished part of interrupted work is kept; returns the exit status."""
    ended = isinstance(stopped, Ended)
    print(f"\nskisnow: {'ended' if ended else 'interrupted'}; what is finished is kept in {place}.\n"
          "The same command goes on with it.", file=sys.stderr)  # fmt: skip
    return 143 if ended else 130
