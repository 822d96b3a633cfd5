"""Processor time and ends of turns beside those of a former commit, which is built into a separate environment."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from ..page_tables import write_tables
from .cases import FINE, FIRM, HARD_SNOW, SCENARIO, SKID, SOFT, Runs

ROOT: Final = Path(__file__).resolve().parents[2]
COMMIT: Final = "58cc12bf"
"""Commit to which the goals for speed relate."""
DURATION: Final = 5.0
"""Simulated time (s) of a turn."""
CASES: Final[Mapping[str, tuple[str, Mapping[str, object]]]] = {
    "fast": (SCENARIO, {"solver.method": "fast"}),
    "default": (SCENARIO, {}),
    "default, H_V = 0.04 N/mm³": (SCENARIO, SOFT),
    "default, H_V = 1 N/mm³": (SCENARIO, FIRM),
    "default, ice": (SCENARIO, HARD_SNOW),
    "default, skid": (SCENARIO, SKID),
    "slalom, fast": ("slalom-20-gates", {"solver.method": "fast"}),
}
_RUN: Final = """
import json, sys, time
try:
    from skisnow.scenario import load_scenario as load
    from skisnow.simulation.simulated_run import simulate
except ImportError:  # names of earlier commits
    from skisnow.scenario import read_scenario as load
    from skisnow.simulate.simulated_run import simulate
from skisnow.dynamics.motion import Dynamics
advance, in_core = Dynamics.advance, 0.0
def timed(*args):
    global in_core
    begin = time.process_time()
    try:
        return advance(*args)
    finally:
        in_core += time.process_time() - begin
Dynamics.advance = timed
scenario = load(sys.argv[1], changes=json.loads(sys.argv[2]))
begin = time.process_time()
run = simulate(scenario)
numbers = [in_core, time.process_time() - begin, run.steps, run.rejected_steps]
print(json.dumps([*numbers, *run.place[-1].tolist(), run.outcome]))
"""
"""Prints seconds in the core and in all, steps, rejected steps, the end of the boots' path (m), and the outcome."""


def build(commit: str, folder: Path) -> Path:
    """Install a commit of this repository in a folder, unless it is there; returns the path to import it from."""
    installed, source = folder / "installed", folder / "source"
    if not (installed / "skisnow").is_dir():
        source.mkdir(parents=True, exist_ok=True)
        archive = subprocess.run(["git", "archive", commit], cwd=ROOT, check=True, capture_output=True)
        subprocess.run(["tar", "-x"], cwd=source, check=True, input=archive.stdout)
        options = ("--no-deps", "--no-build-isolation", "--target", str(installed), str(source))
        subprocess.run([sys.executable, "-m", "pip", "install", *options], check=True, stdout=sys.stderr)
    return installed


def print_table(folder: Path, repeats: int) -> None:
    """Run every case in turn with both builds, print a Markdown table, and write it for the page of benchmarks."""
    places, runs = (build(COMMIT, folder / COMMIT), ROOT / "src"), Runs(DURATION)
    lines = [
        f"| run | {COMMIT}, ms | now, ms | ratio | ratio of the whole run | end off (mm) |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    print(*lines, sep="\n")
    for name in CASES:
        lines.append(f"| {name} | {' | '.join(_cells(name, places, repeats, runs))} |")
        print(lines[-1], flush=True)
    write_tables("benchmarks", {"former": lines})


def _cells(name: str, places: Sequence[Path], repeats: int, runs: Runs) -> Iterator[str]:
    """Shortest runs of both builds, taken in turn A B A B …"""
    rows = [[_numbers(name, place) for place in places] for _ in range(repeats)]
    former, now = ([min(column) for column in zip(*each, strict=True)] for each in zip(*rows, strict=True))
    yield from (f"{1e3 * former[0]:,.0f}", f"{1e3 * now[0]:,.0f}")
    yield from (f"{former[part] / now[part]:.2f}" for part in range(2))
    scenario, changes = CASES[name]
    if scenario != SCENARIO:
        yield ""
        return
    fine = runs.reference({**changes, "solver.method": "default", **FINE}).place[-1]
    yield f"{1e3 * math.dist(now[4:6], fine[:2]):.1f}"


def _numbers(name: str, place: Path) -> list[float]:
    *numbers, _ = _numbers_and_outcome(*CASES[name], place)
    return numbers


def print_ends(folder: Path) -> None:
    """Print a Markdown table of the ends of today's built-in scenarios with both builds, and write it for the page."""
    places = (build(COMMIT, folder / COMMIT), ROOT / "src")
    lines = [f"| scenario | {COMMIT} (m) | now (m) | moved by (m) | outcome |", "| --- | --- | --- | ---: | --- |"]
    print(*lines, sep="\n")
    for file in sorted((places[0] / "skisnow/scenario/catalogue").glob("*.toml")):
        today = str(ROOT / "src/skisnow/scenario/catalogue" / file.name)
        rows = [_numbers_and_outcome(today, {}, place) for place in places]
        ends = [row[4:6] for row in rows]
        outcomes = " → ".join(dict.fromkeys(row[-1].replace("_", " ") for row in rows))
        cells = " | ".join(f"{x:.3f}, {y:.3f}" for x, y in ends)
        lines.append(f"| `{file.stem}` | {cells} | {math.dist(*ends):.3f} | {outcomes} |")
        print(lines[-1], flush=True)
    write_tables("benchmarks", {"ends": lines})


def _numbers_and_outcome(scenario: str, changes: Mapping[str, object], place: Path) -> list[Any]:
    words = [sys.executable, "-W", "ignore", "-c", _RUN, scenario, json.dumps(dict(changes))]
    environment = os.environ | {"PYTHONPATH": str(place)}
    done = subprocess.run(words, check=True, capture_output=True, text=True, env=environment, cwd=place)
    row: list[Any] = json.loads(done.stdout)
    return row
