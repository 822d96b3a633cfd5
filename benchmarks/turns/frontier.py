"""Error against cost of a turn, one choice of the solver varied: ``python -m benchmarks frontier --out FILE``.

FILE is a table with a row for each run; what stands in it already is not computed again.
"""

from __future__ import annotations

import csv
import time
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Final

from skisnow._support.errors import SkisnowError
from skisnow.scenario.reading import load_scenario
from skisnow.simulation.run import Run
from skisnow.simulation.simulated_run import simulate

from .cases import FINE, FIRM, HARD_SNOW, SCENARIO, SKID, SOFT, finer_parts
from .speed import end_distance, told

SNOWS: Final[Mapping[str, Mapping[str, object]]] = {
    "H_V = 0.04 N/mm³": SOFT,
    "H_V = 0.2 N/mm³": {},
    "H_V = 1 N/mm³": FIRM,
    "H_V = 90 N/mm³": HARD_SNOW,
    "skid": SKID,
}
METHODS: Final[Mapping[str, Mapping[str, object]]] = {"default": {}, "fast": {"solver.method": "fast"}}
VARIED: Final[Mapping[str, tuple[float, ...]]] = {
    "solver.tolerance_mm": (3e-5, 1e-4, 3e-4, 1e-3, 3e-3),
    "solver.elements": (20, 28, 40, 56),
    "solver.line_spacing_mm": (10.0, 14.0, 20.0, 28.0, 40.0),
    "solver.groove_tolerance": (1e-5, 3e-5, 1e-4, 3e-4, 1e-3),
}
SHEAR_DISPLACEMENT: Final = "snow.shear_displacement_mm"
SHEAR_DISPLACEMENTS_MM: Final = (0.5, 0.1, 0.05, 0.02, 0.01)


@dataclass(frozen=True, slots=True)
class Point:
    """A run: its snow, what is varied from the method's own choices, what it costs and how far its end is off."""

    snow: str
    method: str
    key: str
    value: float
    cpu_s: float
    steps: int
    end_off_mm: float

    @property
    def name(self) -> tuple[str, str, str, float]:
        return self.snow, self.method, self.key, self.value


def wanted() -> Iterator[tuple[str, str, str, float]]:
    """Every point of the frontier."""
    for snow in SNOWS:
        for key, values in VARIED.items():
            yield from ((snow, "default", key, value) for value in values)
    for method in METHODS:
        yield from (("H_V = 0.2 N/mm³", method, SHEAR_DISPLACEMENT, value) for value in SHEAR_DISPLACEMENTS_MM)


def kept(path: Path) -> list[Point]:
    if not path.exists():
        return []
    with path.open(encoding="utf-8", newline="") as file:
        return [
            Point(
                row["snow"], row["method"], row["key"], float(row["value"]), float(row["cpu_s"]), int(row["steps"]),
                float(row["end_off_mm"]),
            )
            for row in csv.DictReader(file)
        ]  # fmt: skip


def compute(path: Path, *, repeats: int) -> None:
    """What is not in the file yet, row by row."""
    done = {each.name for each in kept(path)}
    references: dict[str, Run] = {}
    for name in wanted():
        if name in done:
            continue
        told(", ".join(str(part) for part in name))
        found = _point(*name, repeats, references)
        is_new = not path.exists()
        with path.open("a", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, [each.name for each in fields(Point)])
            if is_new:
                writer.writeheader()
            writer.writerow(asdict(found))


def _point(snow: str, method: str, key: str, value: float, repeats: int, references: dict[str, Run]) -> Point:
    varied: dict[str, object] = {key: int(value) if key == "solver.elements" else value}
    of_snow = dict(SNOWS[snow]) | (varied if key == SHEAR_DISPLACEMENT else {})
    name = repr(sorted(of_snow.items()))
    if name not in references:
        with finer_parts():
            references[name] = _run({**of_snow, **FINE})[0]
    found = [_run({**of_snow, **METHODS[method], **varied}) for _ in range(repeats)]
    run = found[0][0]
    cost = min(seconds for _, seconds in found)
    return Point(
        snow, method, key, value, round(cost, 4), run.steps, round(1e3 * end_distance(run, references[name]), 3)
    )


def _run(changes: Mapping[str, object]) -> tuple[Run, float]:
    """The turn, and the processor time (s) that it took."""
    scenario = load_scenario(SCENARIO, changes=dict(changes))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        start = time.process_time()
        run = simulate(scenario)
        seconds = time.process_time() - start
    if run.outcome != "finished":
        raise SkisnowError(f"the run with {dict(changes)} ended as {run.outcome}")
    return run, seconds


def print_table(path: Path, *, repeats: int) -> None:
    """Compute what lacks, then print all as Markdown."""
    compute(path, repeats=repeats)
    print("| snow | method | varied | value | processor time (s) | steps | end off (mm) |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for each in kept(path):
        print(
            f"| {each.snow} | {each.method} | `{each.key}` | {each.value:g} | {each.cpu_s:.3f} | {each.steps:,} | "
            f"{each.end_off_mm:.1f} |"
        )
