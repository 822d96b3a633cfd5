"""Processor time and ends of turns beside those of a former commit, which is built into a separate environment."""

from __future__ import annotations

import csv
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, TypeAlias

from ..identify.twin import SIX, THREE
from ..page_tables import table_path, write_tables
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
AVX2, FLIGHT, CARVE, STUDY = "fast, AVX2", "free flight, one step", "one equilibrium, median", "equilibria, mean"
MANY: Final = "fast, a later run of a process"
GOALS: Final = dict(zip(CASES, (3.0, 2.9, 2.6, 2.5, 2.2, 2.8, 5.0), strict=True)) | {
    **{AVX2: 3.7, MANY: 2.8, FLIGHT: 12.0, CARVE: 2.7, STUDY: 3.7, "identify, three": 3.5, "identify, six": 3.3}
}
"""Ratios to reach."""
_NAMES: Final = """
import json, math, statistics, sys, time
import numpy as np
try:
    from skisnow.carving.equilibrium import carve
    from skisnow.identification import identify
    from skisnow.scenario import load_scenario as load
    from skisnow.simulation.run_setup import laid_out
    from skisnow.simulation.simulated_run import simulate
except ImportError:  # names of earlier commits
    from skisnow.carve.equilibrium import carve
    from skisnow.identify import identify
    from skisnow.scenario import read_scenario as load
    from skisnow.simulate.run_setup import laid_out
    from skisnow.simulate.simulated_run import simulate
def timed(call):
    begin = time.process_time()
    call()
    return time.process_time() - begin
"""
_PROGRAMS: Final[Mapping[str, str]] = {
    FLIGHT: """
setup = laid_out(load("carved-46m", changes={"solver.fixed": True, "solver.step_ms": 1.0}))
moves = setup.dynamics
moves.find_equilibrium()
moves.move_to(moves.position + np.array([0.0, 0.0, 100.0]), moves.rotation)
moves.begin(np.array([setup.scenario.start.speed, 0.0, 0.0, 0.0, 0.0, 0.0]))
print(min(timed(lambda: moves.advance(0.1 * n)) for n in range(1, 21)) / 100)
""",
    CARVE: """
from skisnow.ski import read_ski
from skisnow.snow.properties import SnowProperties
seconds = []
for name in ("slalom", "giant-slalom", "carver"):
    ski = read_ski(name)
    for hardness in (0.04e9, 0.2e9, 1e9, 10e9):
        snow = SnowProperties(hardness, 0.35e6, source="benchmark")
        for degrees in (5, 20, 35, 50, 65):
            for load_N in (400.0, 1500.0):
                for ratio in (1.0, 2.0, 10.0, 50.0):
                    def one():
                        carve(ski, snow, edge_angle=math.radians(degrees), load=load_N, unloading_ratio=ratio)
                    seconds.append(min(timed(one), timed(one)))
print(statistics.median(seconds), statistics.mean(seconds))
""",
    MANY: """
def one():
    simulate(load("carved-46m", changes={"solver.method": "fast"}))
one()
print(min(timed(one) for _ in range(3)))
""",
    "identify": """
from skisnow.track.track import Track
truth = json.loads(sys.argv[1])
run = simulate(load("carved-46m", changes={**truth, "run.duration_s": 5.0}))
at = np.maximum(np.searchsorted(run.time, np.arange(0.0, 5.0, 0.1) + 1e-9) - 1, 0)
noise = 0.02 * np.random.default_rng(1).standard_normal((len(at), 3))
track = Track(name="twin", time=run.time[at], place=run.place[at] + noise, speed=np.full(len(at), np.nan),
              time_scale="local", frame="slope", place_sd=np.full((len(at), 3), 0.02), axes="slope")
print(timed(lambda: identify("carved-46m", track, tuple(truth), workers=1)))
""",
}
"""Programs that print seconds of processor time, after `_NAMES`."""
_RUN: Final = """
from skisnow.dynamics.motion import Dynamics
if sys.argv[3:]:
    from skisnow.contact import SnowContact
    SnowContact.__init__.__kwdefaults__["instruction_set"] = sys.argv[3]
advance, in_core = Dynamics.advance, 0.0
def measured(*args):
    global in_core
    begin = time.process_time()
    try:
        return advance(*args)
    finally:
        in_core += time.process_time() - begin
Dynamics.advance = measured
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


def print_table(folder: Path, repeats: int, clock_GHz: float) -> None:
    """Run every case in turn with both builds, print a Markdown table, and write it for the page of benchmarks.

    The counted minimum is that of `counted`, for a processor of this clock. What a whole run does outside the core
    counts as it is, and identifications as their runs.
    """
    places, runs = (build(COMMIT, folder / COMMIT), ROOT / "src"), Runs(DURATION)
    cycles, now_of, least_of = _counted(), dict[str, float](), dict[str, float]()
    heads = (f"{COMMIT}, ms", "now, ms", "ratio", "counted minimum, ms", "its ratio", "ratio to reach", "end off (mm)")
    lines = [f"| processor time | {' | '.join(heads)} |", f"| --- |{' ---: |' * len(heads)}"]
    print(*lines, sep="\n")
    for name, former, now, steps, off in _measured(places, repeats, runs):
        if name in cycles:
            least = 1e-9 * steps * cycles[name] / clock_GHz
        elif name == MANY:
            least = now - now_of["fast"] + least_of["fast"]
        else:
            least = now * least_of[MANY] / now_of[MANY]
        now_of[name], least_of[name] = now, least
        cells = [_ms(former), _ms(now), f"{former / now:.2f}", _ms(least)]
        cells += [f"{former / least:.1f}", f"{min(GOALS[name], 0.8 * former / least):.1f}", off]
        lines.append(f"| {name} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    write_tables("benchmarks", {"former": lines})


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:,.0f}" if seconds > 0.1 else f"{1e3 * seconds:.3g}"


def _counted() -> dict[str, float]:
    """Cycles of a step, or of an equilibrium, by the table of `counted`."""
    rows = list(csv.DictReader(table_path("benchmarks", "counted").read_text("utf-8").splitlines()))

    def column(name: str) -> dict[str, float]:
        return {row["one step"]: float(row[name].replace(",", "")) for row in rows}

    found = column("minimum (cycles)")
    found[AVX2] = found["fast"] + column("operations / 8")["fast"]  # twice as many in lanes of four
    return found | {FLIGHT: found["free flight"], CARVE: found["equilibrium"], STUDY: found["equilibrium"]}


Measured: TypeAlias = tuple[str, float, float, float, str]
"""Name of a case, seconds of both builds, steps of the present one, how far its end is off."""


def _measured(places: Sequence[Path], repeats: int, runs: Runs) -> Iterator[Measured]:
    """Shortest times of both builds, taken in turn A B A B …"""
    for name, (scenario, changes) in {**CASES, AVX2: CASES["fast"]}.items():
        extra = ("avx2",) if name == AVX2 else ()
        rows = [[_turn(scenario, changes, place, *extra) for place in places] for _ in range(repeats)]
        former, now = (min(column) for column in zip(*([row[0] for row in pair] for pair in rows), strict=True))
        off = ""
        if scenario == SCENARIO:
            fine = runs.reference({**changes, "solver.method": "default", **FINE}).place[-1]
            off = f"{1e3 * math.dist(rows[0][1][4:6], fine[:2]):.1f}"
        yield name, former, now, rows[0][1][2], off
    for name, program, words in _programs():
        tried = [[_seconds(program, place, *words) for place in places] for _ in range(repeats)]
        for part, each in enumerate((name, STUDY) if name == CARVE else (name,)):
            former, now = (min(pair[build][part] for pair in tried) for build in range(2))
            yield each, former, now, 1.0, ""


def _programs() -> Iterator[tuple[str, str, tuple[str, ...]]]:
    for name in (MANY, FLIGHT, CARVE):
        yield name, _PROGRAMS[name], ()
    for name, case in (("identify, three", THREE), ("identify, six", SIX)):
        yield name, _PROGRAMS["identify"], (json.dumps(dict(case.truth)),)


def _seconds(program: str, place: Path, *words: str) -> list[float]:
    return [float(number) for number in _printed(program, place, *words).split()]


def _printed(program: str, place: Path, *words: str) -> str:
    """What a program prints with a build."""
    command = [sys.executable, "-W", "ignore", "-c", _NAMES + program, *words]
    environment = os.environ | {"PYTHONPATH": str(place)}
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment, cwd=place).stdout


def _turn(scenario: str, changes: Mapping[str, object], place: Path, *words: str) -> list[Any]:
    row: list[Any] = json.loads(_printed(_RUN, place, scenario, json.dumps(dict(changes)), *words))
    return row


def print_ends(folder: Path) -> None:
    """Print a Markdown table of the ends of today's built-in scenarios with both builds, and write it for the page."""
    places = (build(COMMIT, folder / COMMIT), ROOT / "src")
    lines = [f"| scenario | {COMMIT} (m) | now (m) | moved by (m) | outcome |", "| --- | --- | --- | ---: | --- |"]
    print(*lines, sep="\n")
    for file in sorted((places[0] / "skisnow/scenario/catalogue").glob("*.toml")):
        today = str(ROOT / "src/skisnow/scenario/catalogue" / file.name)
        rows = [_turn(today, {}, place) for place in places]
        ends = [row[4:6] for row in rows]
        outcomes = " → ".join(dict.fromkeys(row[-1].replace("_", " ") for row in rows))
        cells = " | ".join(f"{x:.3f}, {y:.3f}" for x, y in ends)
        lines.append(f"| `{file.stem}` | {cells} | {math.dist(*ends):.3f} | {outcomes} |")
        print(lines[-1], flush=True)
    write_tables("benchmarks", {"ends": lines})
