"""What a second is worth on this machine: one loop, stated here, timed beside every case.

The loop is 10⁶ steps of the logistic map x ← 3.9 x (1 − x) from 0.5 in plain Python: CPU time over the CPU time of
this loop is the cost of a case, so that machines compare.
"""

from __future__ import annotations

import time
from typing import Final

STEPS: Final = 1_000_000


def loop() -> float:
    """The loop; what it gives is of no use, but keeps it from being left out."""
    x = 0.5
    for _ in range(STEPS):
        x = 3.9 * x * (1.0 - x)
    return x


def loop_seconds(tries: int = 3) -> float:
    """CPU seconds of the quickest of some loops."""
    best = float("inf")
    for _ in range(tries):
        start = time.process_time()
        loop()
        best = min(best, time.process_time() - start)
    return best
