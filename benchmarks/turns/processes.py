"""Turns in processes of their own: the first start, later starts, memory, and many turns on all cores."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skisnow._support.processes.batch import available_cores, run_batch

from ..timing import timed
from .cases import SCENARIO, Case, Runs
from .one_process import peak_MB

ROOT = Path(__file__).resolve().parents[2]
SPEEDS_M_PER_S = (6.9, 7.1)
"""At the start, first and last of many runs."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Many runs on all cores.

    Attributes
    ----------
    case
        What was run.
    runs, workers
        How many.
    per_s, per_s_running
        Simulated seconds per second: from the call to the last row, and from the moment the first run begins.
    alone_per_s
        Of one of these runs with the machine to itself.
    end_off_m
        Largest distance of an end from a run with the reference's step, of the first and the last run.
    same_bits
        Whether the rows checked here, in another process, have the same last digit.
    worker_MB
        Largest memory of a worker.
    """

    case: Case
    runs: int
    workers: int
    per_s: float
    per_s_running: float
    alone_per_s: float
    end_off_m: float
    same_bits: bool
    worker_MB: float


@dataclass(frozen=True, slots=True)
class Turn:
    """From a start speed (m/s) to a row; what each worker is sent."""

    duration_s: float
    changes: dict[str, object]

    def __call__(self, speed: float) -> dict[str, Any]:
        begin = time.time()
        run = Runs(self.duration_s).of({**self.changes, "start.speed_m_per_s": speed})
        return {
            "outcome": run.outcome,
            "end": run.place[-1].tolist(),
            "simulated_s": run.simulated_s,
            "begin": begin,
            "end_time": time.time(),
            "peak_MB": peak_MB(),
        }


def many(duration_s: float, case: Case, *, count: int, workers: int | None = None) -> Batch:
    """Many runs of a case, each from another speed."""
    speeds = [float(v) for v in np.linspace(*SPEEDS_M_PER_S, count)]
    turn, wanted = Turn(duration_s, dict(case.changes)), workers or available_cores()
    alone = min((turn(speeds[0]) for _ in range(3)), key=lambda row: row["end_time"] - row["begin"])
    start = time.perf_counter()
    rows = run_batch(speeds, turn, workers=wanted)
    seconds = time.perf_counter() - start
    simulated = sum(row["simulated_s"] for row in rows)
    running = max(row["end_time"] for row in rows) - min(row["begin"] for row in rows)
    ends = [(speeds[i], np.array(rows[i]["end"])) for i in (0, -1)]
    return Batch(
        case,
        count,
        wanted,
        simulated / seconds,
        simulated / running,
        alone["simulated_s"] / (alone["end_time"] - alone["begin"]),
        max(_end_off(duration_s, case, speed, end) for speed, end in ends),
        all(turn(speed)["end"] == end.tolist() for speed, end in ends),
        max(row["peak_MB"] for row in rows),
    )


def in_one_process(duration_s: float) -> dict[str, float]:
    """What `one_process.costs` tells."""
    words = [sys.executable, "-m", "benchmarks.turns.one_process", str(duration_s)]
    done = subprocess.run(words, check=True, capture_output=True, text=True, cwd=ROOT)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def start_s(*, repeats: int) -> float:
    """Least time of a command that simulates next to nothing (s)."""
    words = ["simulate", SCENARIO, "--set", "run.duration_s=0.01"]
    return _least(["-m", "skisnow", *words], repeats)


def bare_start_s(*, repeats: int) -> float:
    """Least time in which a process imports what every run needs of others: NumPy (s)."""
    return _least(["-c", "import numpy"], repeats)


def _least(words: list[str], repeats: int) -> float:
    def call() -> None:
        subprocess.run([sys.executable, *words], check=True, capture_output=True)

    call()
    return min(timed(call) for _ in range(repeats))


def _end_off(duration_s: float, case: Case, speed: float, end: np.ndarray[Any, Any]) -> float:
    reference = Runs(duration_s).of({**case.reference, "start.speed_m_per_s": speed})
    return float(np.linalg.norm(reference.place[-1] - end))
