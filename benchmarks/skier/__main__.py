"""Run it: python -m benchmarks.skier ROWS.csv [--starts N] [--seed N] [--only WORD]; rows that are there are kept."""

from __future__ import annotations

import argparse
import csv
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from skisnow import Run, simulate, time_gates
from skisnow.skier import BalancedSkier
from skisnow.skier.posture import ASIDE, LEFT_EDGE

from .cases import CASES, Case, Start, Straight, starts

COLUMNS = ("case", "seed", "start", "f", "outcome", "passed", "gates", "mean_speed", "largest_load", "greatest_lean")
NEAR = (0.7, 1.4)
"""Force of a skid over the nominal one, within which most starts must succeed."""


def main() -> None:
    """Run what is missing, then tell how many succeeded."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.skier")
    parser.add_argument("rows", type=Path, metavar="ROWS.csv")
    parser.add_argument("--starts", type=int, default=40)
    parser.add_argument("--seed", type=int, default=57)
    parser.add_argument("--only", default="", metavar="WORD", help="cases with this in their name")
    options = parser.parse_args()
    for number, start in enumerate(starts(options.starts, options.seed)):
        for case in CASES:
            known = {(row["case"], row["seed"], row["start"]) for row in read(options.rows)}
            if options.only in case.name and (case.name, str(options.seed), str(number)) not in known:
                row = [case.name, options.seed, number, f"{start.force:.3f}", *measured(case, start)]
                new = not options.rows.exists()
                with options.rows.open("a", newline="", encoding="utf-8") as file:
                    csv.writer(file, lineterminator="\n").writerows([COLUMNS, row] if new else [row])
    print("\n".join(table(read(options.rows))))


def read(path: Path) -> list[dict[str, str]]:
    """Rows so far."""
    if not path.exists():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def measured(case: Case | Straight, start: Start) -> list[object]:
    """Outcome, gates passed, mean speed (m/s), largest load over 20 ms (weights) and greatest lean (°) of a run."""
    run = simulate(case.scenario(start))
    return [outcome(run), passed(run), case.gates, *(f"{each:.3g}" for each in numbers(run))]


def carved(skier: BalancedSkier, case: Case) -> list[bool]:
    """Whether each turn carves, up to the last edge change that the skier reaches.

    From the fall line to the edge change skis slip by less than 2° in at least half of the time, and then the median of
    their edge angle is within 10° of the lean.
    """
    x, course, slip = np.array([(each.seen.place[0], each.seen.course, each.seen.slip) for each in skier.records]).T
    posture = np.array([each.posture for each in skier.records])
    lean = np.arctan2(np.abs(posture[:, ASIDE]), skier.scenario.sledge.centre_of_mass[1])
    beyond = np.degrees(np.abs(posture[:, LEFT_EDGE]) - lean)
    turns = []
    for number in range(int(min(x.max() / case.down, case.gates - 1))):
        turning_left = 1.0 if number % 2 else -1.0
        behind = (x > case.down * number) & (x <= case.down * (number + 1)) & (turning_left * course > 0.0)
        grips = behind & (np.abs(slip) < math.radians(2.0))
        turns.append(bool(2 * grips.sum() >= behind.sum() > 0 and abs(np.median(beyond[grips])) < 10.0))
    return turns


def outcome(run: Run) -> str:
    """As of the run; one that lasted its time without a fault at a gate finished."""
    course = run.scenario.course
    if course is None:
        return run.outcome
    lasted = run.time[-1] > (run.scenario.stop.duration or np.inf) - 1e-6
    faults = {each.outcome for each in time_gates(course, run).passages} - {"passed", "not_reached"}
    return "finished" if lasted and not faults else run.outcome


def passed(run: Run) -> int:
    """Gates."""
    course = run.scenario.course
    if course is None:
        return 0
    return [each.outcome for each in time_gates(course, run).passages].count("passed")


def numbers(run: Run) -> tuple[float, float, float]:
    """Mean speed (m/s), largest load over 20 ms (weights), greatest lean (°)."""
    load = run.balance.load.sum(axis=1)
    if len(load) > 1:
        load = 0.5 * (load[1:] + load[:-1])
    weight = run.scenario.sledge.mass * run.scenario.gravity
    return float(run.speed.mean()), float(load.max() / weight), float(np.degrees(np.abs(run.balance.lean).max()))


def table(rows: list[dict[str, str]]) -> Iterator[str]:
    """Counts by case, near the nominal force of a skid and far from it, and the failures."""
    yield "| case | f 0.7 to 1.4 | other f | speed (m/s) | load over 20 ms (weights) | failures (f) |"
    yield "| --- | ---: | ---: | ---: | ---: | --- |"
    for name in dict.fromkeys(row["case"] for row in rows):
        found = [row for row in rows if row["case"] == name]
        good = [row for row in found if row["outcome"] == "finished"]
        near = [row for row in found if NEAR[0] <= float(row["f"]) <= NEAR[1]]
        counts = [
            f"{sum(row in good for row in part)} of {len(part)}" for part in (near, [r for r in found if r not in near])
        ]
        told = ", ".join(
            f"{row['outcome'].replace('_', ' ')} at gate {int(row['passed']) + 1} ({float(row['f']):.2f})"
            for row in found
            if row not in good
        )
        speed, load = (
            f"{np.median([float(row[key]) for row in good]):.3g}" if good else ""
            for key in ("mean_speed", "largest_load")
        )
        yield f"| {name} | {counts[0]} | {counts[1]} | {speed} | {load} | {told} |"


if __name__ == "__main__":
    main()
