"""An error that nobody foresaw: one sentence, a reference, and the trace in a file that can be sent."""

from __future__ import annotations

import platform
import secrets
import sys
import tempfile
import traceback
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

STATUS: Final = 70
"""Of a command that ended so; ``EX_SOFTWARE`` of sysexits.h."""


def report_failure(error: Exception) -> int:
    """Write the trace down and say where; returns the exit status."""
    reference = secrets.token_hex(4)
    place = _kept(f"error-{reference}.txt", _trace(error, reference))
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


def _kept(name: str, text: str) -> Path | None:
    """The file, in the user's folder for logs, else in that for temporary files; None where neither can be written."""
    from platformdirs import user_log_path

    for folder in (user_log_path("skisnow"), Path(tempfile.gettempdir())):
        try:
            folder.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text, encoding="utf-8", errors="backslashreplace")
        except OSError:
            continue
        return folder / name
    return None
