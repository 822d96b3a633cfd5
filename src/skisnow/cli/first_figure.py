"""The fonts of this machine, which the drawing library lists before its first figure, once for each user."""

from __future__ import annotations

from typing import Final

from .announced import announced

USUAL_S: Final = 10.0
"""Seconds for a machine with a thousand fonts or more (milliseconds each); a hundred take less than a second."""


def fonts_listed() -> None:
    """See that the list is there before the work begins, and say so where it is made: nothing is slow unannounced."""
    from pathlib import Path

    import matplotlib

    if not list(Path(matplotlib.get_cachedir()).glob("fontlist-*.json")):
        with announced("listing this machine's fonts for the figures, this once", usual_s=USUAL_S):
            import matplotlib.font_manager
