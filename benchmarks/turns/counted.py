"""Operations that the core executes in each case, counted by Valgrind, and the least time that they need.

The counted minimum: every floating-point operation of the loops over lines and beams in lanes of eight, one instruction
a cycle, and `MARK_CYCLES` for each mark without branches. The groove of a steady carve is found station by station, so
its operations count one by one. Loads, stores and counting cost nothing. Kernels are those for AVX2, with four lanes.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from ..page_tables import write_tables

ROOT: Final = Path(__file__).resolve().parents[2]
MARK_CYCLES: Final = 120
CARVE: Final = "equilibrium"
LANES: Final = 8
MARKS: Final = ("Ground::", "Touch::", "Pressing::", "SnowContact::press_", "GrooveLines::keep", "GrooveLines::fill")
ONE_BY_ONE: Final = ("GrooveAlongEdge::",)
_ARITHMETIC: Final = re.compile(
    r"v?(?:u?comi|add|sub|mul|div|sqrt|min|max|cmp\w*|blendv?|andn?|x?or|round|hadd)([ps]d)|v?cvt\w+"
)
_RUN: Final = """
import json, sys
from benchmarks.equilibrium import Answers, study_points
from benchmarks.turns import own_flight
from benchmarks.turns.former import CASES, DURATION
from skisnow.dynamics.motion import Dynamics
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate
second, points, counts = float(sys.argv[1]), study_points()[::90], {}
advance = Dynamics.advance
def counted(self, *args):
    ended = advance(self, *args)
    counts["last"] = self.counts
    return ended
Dynamics.advance = counted
rows = [["equilibrium", [len(points)]]]
list(map(Answers(), points))
for name, (scenario, changes) in CASES.items():
    simulate(load_scenario(scenario, changes={**changes, "run.duration_s": second}))
    rows.append([name, counts["last"]])
own_flight.flown(own_flight.released(1.0), 0.1)
print(json.dumps([*rows, ["free flight", counts["last"]]]))
"""
"""Prints each case with its steps, rejected steps, evaluations, matrices and iterations."""


@dataclass(frozen=True, slots=True)
class Count:
    """What one step or one equilibrium executes, on average.

    Attributes
    ----------
    evaluations, matrices, iterations
        Of the contact, and of Newton's method.
    sections, marks
        Sections of a ski that are cut, and bases that are pressed into a line.
    instructions, operations, one_by_one
        All; floating-point operations over `LANES`; those that follow each other.
    """

    evaluations: float
    matrices: float
    iterations: float
    sections: float
    marks: float
    instructions: float
    operations: float
    one_by_one: float

    def cycles(self, lanes: int = LANES) -> float:
        """Counted minimum."""
        return self.operations * LANES / lanes + self.one_by_one + MARK_CYCLES * self.marks


def print_table(folder: Path, simulated_s: float) -> None:
    """Count, print a Markdown table, and write it for the page of benchmarks."""
    lines = [
        "| one step | evaluations | matrices | iterations | sections | marks | instructions | operations / 8 "
        "| minimum (cycles) |",
        f"| --- |{' ---: |' * 8}",
    ]
    print(*lines, sep="\n")
    for name, one in counts(folder, simulated_s):
        numbers = (one.instructions, one.operations + one.one_by_one, one.cycles())
        cells = [f"{n:.2f}" for n in (one.evaluations, one.matrices, one.iterations)]
        cells += [f"{one.sections:.0f}", f"{one.marks:.0f}"]
        cells = [*(cells if name != CARVE else [""] * len(cells)), *(f"{n:,.0f}" for n in numbers)]
        lines.append(f"| {name} | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    write_tables("benchmarks", {"counted": lines})


def counts(folder: Path, simulated_s: float) -> Iterator[tuple[str, Count]]:
    """Each case, from the beginning of the run."""
    library, place = _built(folder)
    words = ["valgrind", "--tool=callgrind", "--dump-instr=yes", f"--callgrind-out-file={folder / 'counted'}"]
    words += ["--toggle-collect=skisnow::Dynamics::advance(double, long)", "--toggle-collect=skisnow::find_carve(*"]
    words += ["--dump-before=skisnow::Dynamics::begin()", sys.executable, "-c", _RUN, str(simulated_s)]
    environment = os.environ | {"PYTHONPATH": f"{place}:{ROOT}"}
    done = subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True, env=environment, cwd=folder)
    operations = _operations(library)
    rows = json.loads(done.stdout)
    for number, (name, numbers) in enumerate(rows, 1):
        last = number == len(rows)  # Valgrind writes the rest to the plain name
        yield name, _count(folder / ("counted" if last else f"counted.{number}"), operations, numbers)


def _built(folder: Path) -> tuple[Path, Path]:
    """The core with names of functions, and where to import it from."""
    place, tree = folder / "installed", folder / "tree"
    options = ("-DCMAKE_BUILD_TYPE=Named", "-DCMAKE_CXX_FLAGS_NAMED=-O3 -g1", f"-DPython_EXECUTABLE={sys.executable}")
    subprocess.run(["cmake", "-S", str(ROOT), "-B", str(tree), *options], check=True, stdout=sys.stderr)
    subprocess.run(["cmake", "--build", str(tree), "--target", "_core", "-j2"], check=True, stdout=sys.stderr)
    place.mkdir(parents=True, exist_ok=True)
    subprocess.run(["cp", "-r", str(ROOT / "src" / "skisnow"), str(place) + "/"], check=True)
    (library,) = tree.glob("_core*.so")
    subprocess.run(["cp", str(library), str(place / "skisnow" / "compiled")], check=True)
    return library, place


def _operations(library: Path) -> dict[int, int]:
    """Numbers that each instruction of floating-point arithmetic computes, by address."""
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", library], check=True, capture_output=True, text=True)
    found = {}
    for address, name, operands in re.findall(r"^ +([0-9a-f]+):\s+(\S+) *(.*)$", text.stdout, re.MULTILINE):
        if kind := _ARITHMETIC.fullmatch(name):
            alone = kind[1] != "pd" and "pd" not in name
            found[int(address, 16)] = 1 if alone else 4 if "%ymm" in operands else 2
    return found


def _count(path: Path, operations: Mapping[int, int], numbers: list[int]) -> Count:
    """From a file of callgrind: costs of instructions by function, and calls."""
    all_of, lanes, one_by_one, calls = 0, 0, 0, Counter[str]()
    for function, address, cost in _costs(path, calls):
        all_of += cost
        if any(word in function for word in ONE_BY_ONE):
            one_by_one += cost * bool(operations.get(address))
        elif not any(word in function for word in MARKS):
            lanes += cost * operations.get(address, 0)
    marks = sum(n for name, n in calls.items() if "Touch::press_base" in name)
    sections = 4 * sum(n for name, n in calls.items() if "cut_base" in name and "lambda" in name)
    steps, _, looks, factored, iterations = numbers if len(numbers) > 1 else [*numbers, 0, 0, 0, 0]
    each = (looks, factored, iterations, sections, marks, all_of, lanes / LANES, one_by_one)
    return Count(*(n / steps for n in each))


def _costs(path: Path, calls: Counter[str]) -> Iterator[tuple[str, int, int]]:
    """Function of the core, address and executions of each instruction; `calls` takes the calls of each function."""
    names: dict[str, str] = {}
    objects: dict[str, str] = {}
    inside, function, called, address, skips = False, "", "", 0, False

    def named(table: dict[str, str], word: str) -> str:
        number, _, name = word.partition(" ")
        return table.setdefault(number, name)

    for line in path.read_text(encoding="utf-8").splitlines():
        key, _, rest = line.partition("=")
        if key == "ob":
            inside = "_core" in named(objects, rest)
        elif key == "cob":
            named(objects, rest)
        elif key == "fn":
            function = named(names, rest)
        elif key == "cfn":
            called = named(names, rest)
        elif key == "calls":
            calls[called] += int(rest.split()[0])
            skips = True
        elif line[:1] in {"0", "+", "-", "*"}:
            where, _, cost = line.split()[:3]
            address = int(where, 16) if line[0] == "0" else address + int(where.replace("*", "0"), 0)
            if inside and not skips:
                yield function, address, int(cost)
            skips = False
