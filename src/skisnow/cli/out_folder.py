"""The folder of ``--out`` before the work begins."""

from __future__ import annotations

import sys
from pathlib import Path

from .first_figure import fonts_listed


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
