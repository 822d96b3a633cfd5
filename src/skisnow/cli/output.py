"""Output of a command: JSON and warnings on the terminal, the folder for files, and the fonts of figures."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from .progress import announced

if TYPE_CHECKING:
    from collections.abc import Iterable


def print_json(contents: Any) -> None:
    """Print JSON with one space of indentation; a number that is not finite is an error."""
    print(json.dumps(contents, ensure_ascii=False, allow_nan=False, indent=1), flush=True)


def print_warnings(warnings: Iterable[object]) -> None:
    """Print each warning in a line of standard error."""
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)


USUAL_S: Final = 10.0
"""Seconds for a machine with a thousand fonts or more (milliseconds each); a hundred take less than a second."""


def list_fonts() -> None:
    """Let matplotlib scan the fonts before the work begins, with a message, if it has no list yet."""
    import matplotlib

    if not list(Path(matplotlib.get_cachedir()).glob("fontlist-*.json")):
        with announced("listing this machine's fonts for the figures, this once", usual_s=USUAL_S):
            import matplotlib.font_manager


def prepare_output(folder: Path) -> None:
    """Require a writable folder, clean up after killed processes with a message, and list the fonts for figures.

    Raises
    ------
    OutputError
        The folder cannot be made or written.
    """
    from .._support.staging import prepare_folder

    for sentence in prepare_folder(folder):
        print(sentence, file=sys.stderr)
    list_fonts()
