"""The fonts of this machine, which the drawing library lists before its first figure, once for each user."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Final

from .progress import announced

USUAL_S: Final = 10.0
"""Seconds for a machine with a thousand fonts or more (milliseconds each); a hundred take less than a second."""


def fonts_listed() -> None:
    """See that the list is there before the work begins, and say so where it is made: nothing is slow unannounced."""
    from pathlib import Path

    import matplotlib

    if not list(Path(matplotlib.get_cachedir()).glob("fontlist-*.json")):
        with announced("listing this machine's fonts for the figures, this once", usual_s=USUAL_S):
            import matplotlib.font_manager


def ready(folder: Path) -> None:
    """See that a folder can be written and figures drawn, tidy up what killed processes left in it, and say so.

    Raises
    ------
    OutputError
        It cannot be made or written.
    """
    from .._support.staging import tidied

    for sentence in tidied(folder):
        print(sentence, file=sys.stderr)
    fonts_listed()
