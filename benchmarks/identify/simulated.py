"""Identifications of simulated tracks by a former commit and by the present source.

``python -m benchmarks identified --count 50 --out FOLDER`` identifies 50 tracks with three and 50 with six parameters
with both programs, each on one core. A folder keeps the rows, and those that it holds are not computed again. The
former commit is built there. A row of the table counts the tracks on which the present source does as well.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from skisnow.identification import identify
from skisnow.scenario import scenario_file

from ..turns.former import ROOT, build
from .twin import SCENARIO, Case, twin

COMMIT: Final = "80cd8a90"
"""Former commit, with central differences and two last steps."""
DURATION: Final = 4.0
"""Simulated time (s) of a track, 10 Hz: 35 m."""
WORSE: Final = 1e-3
"""Share by which the sum of squares may be larger than that of the former commit."""
APART: Final = 0.1
"""Distance of the values of a parameter that both programs identify, in 95 % intervals of the former commit."""
COUNTS: Final = (3, 6)
"""Numbers of free parameters."""
SPREAD: Final = 0.3
"""Standard deviation of a true value in sizes of its parameter about the scenario's."""
SIZES: Final[Mapping[str, tuple[float, bool]]] = {
    "friction.mu_0": (0.05, False),
    "friction.mu_1_s_per_m": (0.005, False),
    "drag.drag_area_m2": (0.3, False),
    "snow.S_f_N_per_mm2": (1.0, True),
    "snow.H_V_N_per_mm3": (1.0, True),
    "sledge.edge_angle_deg": (5.0, False),
    "start.speed_m_per_s": (1.0, False),
    "start.heading_deg": (5.0, False),
}
"""Snow, friction, drag and start: size of each key, and whether it spans decades."""


def drawn_case(seed: int, count: int) -> Case:
    """`count` of the keys and true values about those of the scenario."""
    rng = np.random.default_rng([seed, count])
    keys = sorted(rng.choice(list(SIZES), count, replace=False).tolist(), key=list(SIZES).index)
    own = scenario_file(SCENARIO).values
    truth = {}
    for key in keys:
        size, logarithmic = SIZES[key]
        away = SPREAD * size * rng.standard_normal()
        value = float(own[key]) * np.exp(away) if logarithmic else float(own[key]) + away
        truth[key] = float(value if key == "start.heading_deg" else abs(value))
    return Case(f"{count} parameters", 0.0, truth)


def identified_row(seed: int, count: int) -> dict[str, Any]:
    """Sum of squares, values, intervals, runs and processor time (s) of one identification on one core."""
    case = drawn_case(seed, count)
    track = twin(case, seed=seed, duration_s=DURATION)
    begin = time.process_time()
    found = identify(SCENARIO, track, case.keys, workers=1)
    seconds = time.process_time() - begin
    residual = np.concatenate([(fit.residual[:, :2] / fit.sd[:, :2]).ravel() for fit in found.fits])
    values = {
        one.parameter.key: [one.value, *(one.interval or (None, None)), one.identifiable] for one in found.parameters
    }
    numbers = {"count": count, "seed": seed, "runs": found.effort.simulations, "seconds": round(seconds, 3)}
    return numbers | {"outcome": found.outcome, "squares": float(residual @ residual), "values": json.dumps(values)}


def kept_rows(path: Path) -> dict[tuple[int, int], dict[str, str]]:
    """Rows of a file by number of parameters and seed."""
    if not path.is_file():
        return {}
    with path.open(encoding="utf-8", newline="") as file:
        return {(int(row["count"]), int(row["seed"])): row for row in csv.DictReader(file)}


def add_rows(path: Path, seeds: int) -> None:
    """Compute the rows that a file lacks, and append each as it is finished."""
    kept = kept_rows(path)
    for seed in range(seeds):
        for count in COUNTS:
            if (count, seed) in kept:
                continue
            row = identified_row(seed, count)
            is_new = not path.exists()
            with path.open("a", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, list(row), lineterminator="\n")
                if is_new:
                    writer.writeheader()
                writer.writerow(row)


def _row(before: Mapping[str, str], now: Mapping[str, str]) -> list[float]:
    """Whether sum of squares, values and open parameters agree; relative change of the sum; runs and seconds."""
    old, new = json.loads(before["values"]), json.loads(now["values"])
    apart = [
        abs(new[key][0] - value) / (high - low)
        for key, (value, low, high, is_known) in old.items()
        if is_known and new[key][3]
    ]
    change = float(now["squares"]) / float(before["squares"]) - 1.0
    agree = [change <= WORSE, max(apart, default=0.0) <= APART, all(old[key][3] == new[key][3] for key in old)]
    return [*agree, change, *(float(row[name]) for name in ("runs", "seconds") for row in (before, now))]


def table(former: Path, present: Path) -> Iterator[str]:
    """Lines of a Markdown table of the tracks that both files have."""
    yield (
        "| parameters | tracks | squares agree | values agree | same open | median change of squares (%) "
        "| runs before | runs | seconds, ratio |"
    )
    yield f"| --- |{' ---: |' * 8}"
    old, new = kept_rows(former), kept_rows(present)
    for count in COUNTS:
        rows = np.array([_row(old[key], new[key]) for key in sorted(old.keys() & new.keys()) if key[0] == count])
        if len(rows):
            agree, median = rows[:, :3].sum(axis=0), np.median(rows, axis=0)
            ratio = np.median(rows[:, 6] / rows[:, 7])
            yield (
                f"| {count} | {len(rows)} | {agree[0]:g} | {agree[1]:g} | {agree[2]:g} | {100.0 * median[3]:.2g} "
                f"| {median[4]:g} | {median[5]:g} | {ratio:.1f} |"
            )


def print_table(folder: Path, seeds: int) -> None:
    """Compute the rows that are missing, each program in its own process, and print the table."""
    places = {folder / "former.csv": build(COMMIT, folder / COMMIT), folder / "present.csv": ROOT / "src"}
    for path, place in places.items():
        words = [sys.executable, "-W", "ignore", "-m", __name__, str(path), str(seeds)]
        subprocess.run(words, cwd=ROOT, check=True, env={**os.environ, "PYTHONPATH": str(place)})
    print(*table(*places), sep="\n")


if __name__ == "__main__":
    add_rows(Path(sys.argv[1]), int(sys.argv[2]))
