"""End of a command: SIGTERM stops workers and keeps finished results, as Ctrl-C does; a report of unforeseen errors."""

from __future__ import annotations

import contextlib
import os
import platform
import secrets
import signal
import sys
import tempfile
import threading
import traceback
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

LATER: Final = "writing the computed results first; a second request stops at once"


class Ended(KeyboardInterrupt):
    """The system requested the end of this process."""


@dataclass(slots=True)
class Ending:
    """Requests to end this process, kept also if the interrupt was caught.

    Attributes
    ----------
    requested
        True after a request of the system.
    pressed
        True after Ctrl-C during `finishing`.
    """

    requested: bool = False
    pressed: bool = False

    def status(self) -> int:
        """Exit status of an interrupted command: 143 after a request of the system, otherwise 130."""
        return 143 if self.requested else 130

    @contextmanager
    def finishing(self) -> Iterator[None]:
        """Finish a block that takes seconds, such as the writing of a run; a second request interrupts it."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {number: signal.signal(number, self._ask_later) for number in (signal.SIGINT, signal.SIGTERM)}
        already, self._later = self._later, False
        try:
            yield
        finally:
            self._later = already
            for number, handler in before.items():
                signal.signal(number, handler)

    _later: bool = False

    def _ask(self, *_: Any) -> None:
        self.requested = True
        raise Ended

    def _ask_later(self, number: int, _: Any) -> None:
        by_system = number == signal.SIGTERM
        self.requested, self.pressed = self.requested or by_system, self.pressed or not by_system
        if self._later:
            raise Ended if by_system else KeyboardInterrupt
        self._later = True
        with contextlib.suppress(OSError):  # past Python's own buffer, which may be in use at this very moment
            os.write(2, f"{LATER}\n".encode())


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


def report_interrupt(stopped: KeyboardInterrupt, place: Path) -> int:
    """Print where the finished part of the work is kept; returns the exit status."""
    ended = isinstance(stopped, Ended)
    print(f"\nskisnow: {'ended' if ended else 'interrupted'}; what is finished is kept in {place}.\n"
          "The same command goes on with it.", file=sys.stderr)  # fmt: skip
    return 143 if ended else 130


STATUS: Final = 70
"""Exit status after an unforeseen error; ``EX_SOFTWARE`` of sysexits.h."""


def report_failure(error: Exception) -> int:
    """Write the traceback to a file and print its path; returns the exit status."""
    reference = secrets.token_hex(4)
    place = _write_log(f"error-{reference}.txt", _trace(error, reference))
    where = f"The trace is in {place}; please send it with what you did." if place else "The trace:"
    what = f"{type(error).__name__}: {error}".splitlines()[0][:200]
    print(f"skisnow: an error that was not foreseen ({what}). Reference {reference}. {where}", file=sys.stderr)
    if place is None:
        traceback.print_exception(error)
    return STATUS


def _trace(error: Exception, reference: str) -> str:
    from importlib.metadata import version

    head = (
        f"reference {reference}, {datetime.now(UTC):%Y-%m-%d %H:%M:%S} UTC",
        f"skisnow {version('skisnow')}, Python {platform.python_version()}, {platform.platform()}",
        f"command {sys.argv}",
    )
    return "\n".join((*head, "", *traceback.format_exception(error)))


def _write_log(name: str, text: str) -> Path | None:
    """Path of the written file, in the user's log folder or the temporary folder; None if neither can be written."""
    from platformdirs import user_log_path

    for folder in (user_log_path("skisnow"), Path(tempfile.gettempdir())):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8", errors="backslashreplace")
        except OSError:
            continue
        return folder / name
    return None
