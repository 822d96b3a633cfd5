"""Who computes the points of a study: threads against processes, and what handing work out costs.

``python -m benchmarks.executors`` prints ratios of times that were taken in turn.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from skisnow._support.processes.batch import compute_missing
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.studies import read_study
from skisnow.studies.run import point_values

TASK_S: Final = 0.05
WORKERS: Final = 2
CARVE: Final = """
out = "table.csv"
[fixed]
ski = "slalom"
published = "race-piste"
unloading_ratio = 10
[grid]
load_N = { from = 300, to = 1500, n = 10 }
edge_angle_deg = { from = 10, to = 60, n = 20 }
"""
RUNS: Final = """
out = "table.csv"
scenario = "carved-46m"
[fixed]
"run.duration_s" = {duration}
[grid]
"start.speed_m_per_s" = {{ from = 6, to = 9, n = {speeds} }}
mu_0 = [0.02, 0.05]
"""
STUDIES: Final = {
    "carved turns": CARVE,
    "runs of 0.3 s": RUNS.format(duration=0.3, speeds=10),
    "runs of 1 s": RUNS.format(duration=1, speeds=8),
    "runs of 5 s": RUNS.format(duration=5, speeds=5),
}


def asleep(_point: Any) -> dict[str, Any]:
    """A task that takes its time and no core."""
    time.sleep(TASK_S)
    return {}


class Warm:
    """Wall time from the first rows on: loading the libraries is not counted."""

    def __init__(self) -> None:
        self.first: tuple[float, int] | None = None

    def __call__(self, done: int, _total: int) -> None:
        if self.first is None and done:
            self.first = (time.perf_counter(), done)

    def seconds_per_point(self, count: int) -> float:
        assert self.first is not None
        return (time.perf_counter() - self.first[0]) / (count - self.first[1])


def study_seconds(folder: Path, text: str, executor: str | None) -> float:
    """Of a point, with two workers or, without an executor, in this process."""
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8")
    study = read_study(path)
    warm, rows = Warm(), KeptRows()
    workers = 1 if executor is None else WORKERS
    values = partial(point_values, study.subject, study.columns[:-1])
    compute_missing(study.points, values, rows, workers=workers, executor=executor, progress=warm)
    return warm.seconds_per_point(len(study.points))


def asleep_seconds(count: int, executor: Any) -> float:
    """Of all tasks; a few before them start the workers."""
    begin = time.perf_counter()
    compute_missing(range(count), asleep, KeptRows(), workers=WORKERS, executor=executor)
    return time.perf_counter() - begin


def main() -> None:
    """Print two tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=1000, help="that sleep for 50 ms")
    parser.add_argument("--repeats", type=int, default=5, help="in turn; the median of their ratios counts")
    parser.add_argument("--studies", nargs="*", choices=list(STUDIES), default=list(STUDIES))
    asked = parser.parse_args()
    print("| points | one process | two threads: times as fast | two processes | threads over processes (range) |")
    print("| --- | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as name:
        for title in asked.studies:
            times: dict[str | None, list[float]] = {None: [], "threads": [], "processes": []}
            for repeat in range(asked.repeats):
                for executor in list(times)[:: 1 if repeat % 2 else -1]:  # whoever went first goes last
                    times[executor].append(study_seconds(Path(name), STUDIES[title], executor))
            one, threads, processes = (np.array(found) for found in times.values())
            faster = processes / threads
            print(
                f"| {title} | {1e3 * one.min():.1f} ms | {np.median(one / threads):.2f} | "
                f"{np.median(one / processes):.2f} | {np.median(faster):.2f} "
                f"({faster.min():.2f} to {faster.max():.2f}) |",
                flush=True,
            )
    ideal = asked.tasks * TASK_S / WORKERS
    print("\n| executor | time over tasks × 50 ms / 2 |\n| --- | ---: |")
    print(f"| threads | {asleep_seconds(asked.tasks, 'threads') / ideal:.3f} |")


if __name__ == "__main__":
    main()
