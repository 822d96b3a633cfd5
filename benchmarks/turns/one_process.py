"""What the first run of a process costs, and each further one: ``python -m benchmarks.turns.one_process SECONDS``.

Prints JSON. A process of its own: the peak of its memory is that of the run.
"""

from __future__ import annotations

import json
import resource
import sys
import time
import tracemalloc
from pathlib import Path

KILOBYTE, MEGABYTE = 1024.0, 1e6
FURTHER_RUNS = 8


def peak_MB() -> float:
    """Largest resident memory of this process so far (MB).

    Where there is a /proc it is asked: `getrusage` counts what the parent held when it started this process.
    """
    status = Path("/proc/self/status")
    if status.exists():
        (line,) = (line for line in status.read_text(encoding="ascii").splitlines() if line.startswith("VmHWM:"))
        return float(line.split()[1]) * KILOBYTE / MEGABYTE
    unit = 1.0 if sys.platform == "darwin" else KILOBYTE
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / MEGABYTE


def costs(duration_s: float) -> dict[str, float]:
    """Seconds until the first run begins to move, and memory (MB)."""
    start = time.perf_counter()
    from .cases import Runs

    runs = Runs(duration_s)
    wall_s = runs.of({}).wall_s
    ready_s = time.perf_counter() - start - wall_s
    one = peak_MB()
    for _ in range(FURTHER_RUNS):
        runs.of({})
    growth = (peak_MB() - one) / FURTHER_RUNS
    tracemalloc.start()
    runs.of({})
    arrays = tracemalloc.get_traced_memory()[1] / MEGABYTE
    tracemalloc.stop()
    return {
        "ready_s": ready_s,
        "one_run_MB": one,
        "growth_per_run_MB": growth,
        "arrays_of_a_run_MB": arrays,
    }


if __name__ == "__main__":
    print(json.dumps(costs(float(sys.argv[1]))))
