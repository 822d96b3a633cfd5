"""Who computes the points of a study: threads against processes, and what handing work out costs.

``python -m benchmarks.executors`` prints ratios of times that were taken in turn; the parts with Dask need the extra.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path
from typing import Any, Final

from skisnow.parallel.batch import compute_missing
from skisnow.parallel.kept_rows import KeptRows
from skisnow.study import read_study
from skisnow.study.computing import StudyRows

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
"run.duration_s" = 0.3
[grid]
"start.speed_m_per_s" = { from = 6, to = 9, n = 10 }
mu_0 = [0.02, 0.05]
"""


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
    warm, rows = Warm(), KeptRows(columns=study.columns[:-1])
    workers = 1 if executor is None else WORKERS
    compute_missing(study.points, StudyRows.of(study), rows, workers=workers, executor=executor, progress=warm)
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
    parser.add_argument("--repeats", type=int, default=3, help="the shortest time counts")
    asked = parser.parse_args()
    print("| points | one process | two threads: times as fast | two processes: times as fast |")
    print("| --- | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as name:
        for title, text in (("carved turns", CARVE), ("runs of 0.3 s", RUNS)):
            times: dict[str | None, list[float]] = {None: [], "threads": [], "processes": []}
            for _ in range(asked.repeats):
                for executor, found in times.items():
                    found.append(study_seconds(Path(name), text, executor))
            one, threads, processes = (min(found) for found in times.values())
            print(f"| {title} | {1e3 * one:.2f} ms | {one / threads:.2f} | {one / processes:.2f} |", flush=True)
    print("\n| executor | time over tasks × 50 ms / 2 |\n| --- | ---: |")
    ideal = asked.tasks * TASK_S / WORKERS
    print(f"| threads | {asleep_seconds(asked.tasks, 'threads') / ideal:.3f} |", flush=True)
    try:
        import distributed
    except ImportError:
        print("| Dask | not installed |")
        return
    with (
        distributed.LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        asleep_seconds(4, client)
        print(f"| Dask, two workers | {asleep_seconds(asked.tasks, client) / ideal:.3f} |")


if __name__ == "__main__":
    main()
