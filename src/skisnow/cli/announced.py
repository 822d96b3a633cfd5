"""A line on stderr for a first step that may take long."""

from __future__ import annotations

import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def announced(doing: str, *, patience_s: float = 2.0) -> Iterator[None]:
    """Say what is being done if it takes longer than that."""
    timer = threading.Timer(patience_s, lambda: print(f"{doing} …", file=sys.stderr, flush=True))
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
