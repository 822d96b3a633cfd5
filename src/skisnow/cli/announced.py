"""A line on stderr for a step that may take long and tells nothing of itself."""

from __future__ import annotations

import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from .progress import PAUSE_S, MovingLine

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def announced(doing: str, *, patience_s: float = 2.0, usual_s: float | None = None) -> Iterator[None]:
    """Say what is being done if it takes longer than that; on a terminal also for how long, and how long it takes."""
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
