"""What each constant of the contact moves in motions prescribed by hand: python -m benchmarks.contact.

Constants that are literals of the C++ sources are varied in a copy of them, which needs cmake, ninja, nanobind and a
compiler: ``--literals``.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skisnow.compiled import core

from .ends import End, all_ends
from .paths import Answer, all_answers

ROOT = Path(__file__).resolve().parents[2]
KEYS: list[tuple[str, str, dict[str, Any]]] = [
    ("spacing", "0.02 m", {"0.01": {"spacing": 0.01}, "0.04": {"spacing": 0.04}}),
    ("part_along", "10 mm", {"5": {"part_along": 0.005}, "20": {"part_along": 0.02}}),
    ("part_across", "2 mm", {"1": {"part_across": 1e-3}, "4": {"part_across": 4e-3}}),
    ("knot_area", "1e-4", {"0": {"knot_area": 0.0}, "1e-3": {"knot_area": 1e-3}}),
    ("stick_displacement", "0.02 mm", {"0.01": {"stick_displacement": 1e-5}, "0.04": {"stick_displacement": 4e-5}}),
]


@dataclass(frozen=True)
class Literal:
    name: str
    file: str
    before: str
    values: tuple[str, str]


LITERALS = [
    Literal("MARGIN", "snow/lines.cpp", "0.12", ("0.06", "0.24")),
    Literal("MOST_UNEVEN", "snow/lines.cpp", "0.25", ("0.12", "0.5")),
    Literal("MOST_TURN", "snow/lines.cpp", "0.3", ("0.15", "0.6")),
    Literal("MOST_OFF", "snow/lines.cpp", "2e-4", ("1e-4", "4e-4")),
    Literal("FURTHER", "snow/lines.cpp", "0.03", ("0.01", "0.1")),
    Literal("SPARE", "contact/learn.cpp", "0.01", ("0.005", "0.05")),
    Literal("KNOTS", "snow/groove.hpp", "16", ("12", "32")),
    Literal("ALIKE", "snow/groove.cpp", r"1.0 + 1e-4", ("1.0 + 1e-6", "1.0 + 1e-3")),
    Literal("SLIPPING", "contact/march.cpp", "0.999", ("0.99", "0.9999")),
    Literal("EXACT", "snow/archive.cpp", "1e-14", ("1e-15", "1e-12")),
    Literal("AT_BORDER", "snow/archive.cpp", "1e-9", ("1e-10", "1e-8")),
    Literal("PARTS", "snow/archive.cpp", "4", ("2", "8")),
    Literal("TANGENT_STEP", "contact/contact.cpp", "1e-8", ("1e-9", "1e-7")),
    Literal("LEVEL", "contact/contact.cpp", "1e-6", ("1e-7", "1e-5")),
    Literal("NONE", "snow/delayed.hpp", "1e-10", ("1e-12", "1e-8")),
    Literal("RATE_STEP", "contact/rate.cpp", "1e-4", ("1e-5", "1e-3")),
    Literal("MOST_PLACES", "contact/march.cpp", "24", ("12", "48")),
    Literal("SLOW", "dynamics/dynamics.cpp", "0.5", ("0.25", "0.8")),
    Literal("UNSEEN", "dynamics/dynamics.cpp", "0.3", ("0.15", "0.6")),
    Literal("LEAST_ERROR", "dynamics/dynamics.cpp", "0.1", ("0.05", "0.2")),
    Literal("OVERSHOOT", "dynamics/dynamics.cpp", "0.3", ("0.15", "0.6")),
    Literal("FARTHEST", "dynamics/dynamics.cpp", "1.0", ("0.5", "2.0")),
    Literal("SAFETY", "dynamics/dynamics.cpp", "0.85", ("0.75", "0.95")),
    Literal("UP", "dynamics/dynamics.cpp", "1.35", ("1.2", "1.5")),
    Literal("DOWN", "dynamics/dynamics.cpp", "0.93", ("0.85", "0.99")),
    Literal("MILNE", "dynamics/dynamics.cpp", "0.35", ("0.25", "0.5")),
]


def row(name: str, standard: str, value: str, found: dict[str, Answer], base: dict[str, Answer]) -> str:
    """One row of the table, in per cent."""
    cells = [" / ".join(f"{each:.2g}" for each in found[path].apart(base[path])) for path in base]
    return f"| `{name}` | {standard} | {value} | {' | '.join(cells)} |"


def _built(folder: Path, literal: Literal, value: str) -> Path:
    """A package whose core has another value of a literal; the folder to import it from."""
    tree, package = folder / "tree", folder / "package"
    if not tree.exists():
        shutil.copytree(ROOT / "src/core", tree / "src/core")
        (tree / "src/skisnow/compiled").mkdir(parents=True)
        shutil.copy(ROOT / "src/skisnow/compiled/sources.py", tree / "src/skisnow/compiled")
        shutil.copy(ROOT / "CMakeLists.txt", tree)
        shutil.copytree(ROOT / "src/skisnow", package / "skisnow", ignore=shutil.ignore_patterns("_core*.so"))
        tools = ["-G", "Ninja", f"-DPython_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", tree, "-B", tree / "build", *tools], check=True, capture_output=True)
    source = tree / "src/core" / literal.file
    original = (ROOT / "src/core" / literal.file).read_text(encoding="utf-8")
    changed, count = re.subn(rf"\b({literal.name} = ){re.escape(literal.before)}\b", rf"\g<1>{value}", original)
    if count != 1:
        raise SystemExit(f"{literal.file} does not set {literal.name} to {literal.before}")
    source.write_text(changed, encoding="utf-8")
    subprocess.run(["cmake", "--build", tree / "build"], check=True, capture_output=True)
    source.write_text(original, encoding="utf-8")
    for library in (tree / "build").glob("_core*.so"):
        shutil.copy(library, package / "skisnow/compiled")
    return package


def _other(package: Path) -> tuple[dict[str, Answer], dict[str, End]]:
    """The answers and the ends of turns of another core, in a process that knows of no editable installation."""
    paths = os.pathsep.join([str(package), str(ROOT), str(Path(np.__file__).parents[1])])
    command = [sys.executable, "-S", "-m", "benchmarks.contact", "--answers"]
    said = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": paths}, check=True, capture_output=True, cwd=package
    )
    answers = json.loads(said.stdout)
    if not Path(answers.pop("core")).is_relative_to(package):
        raise SystemExit("another core answered than the one that was built")
    ends = answers.pop("ends")
    return {name: Answer.of(each) for name, each in answers.items()}, {
        name: End(place, looks) for name, (place, looks) in ends.items()
    }


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.contact")
    parser.add_argument("--literals", nargs="*", metavar="NAME", help="those of the C++ sources too, or some of them")
    parser.add_argument("--answers", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    base = all_answers({})
    if options.answers:
        lists = {name: each.as_lists() for name, each in base.items()}
        turns = {name: [each.place, each.looks] for name, each in all_ends().items()}
        print(json.dumps({"core": core.__file__, "ends": turns, **lists}))
        return
    print(f"| constant | as it is | varied to | {' | '.join(base)} |\n| --- | --- | --- |{' --- |' * len(base)}")
    for name, standard, values in KEYS:
        for value, changes in values.items():
            print(row(name, standard, value, all_answers(dict(changes)), base), flush=True)
    if options.literals is None:
        return
    chosen = [each for each in LITERALS if not options.literals or each.name in options.literals]
    ends, rows = all_ends(), []
    with tempfile.TemporaryDirectory() as folder:
        for literal in chosen:
            for value in literal.values:
                found, moved = _other(_built(Path(folder), literal, value))
                if literal.file != "dynamics/dynamics.cpp":
                    print(row(literal.name, literal.before, value, found, base), flush=True)
                cells = [moved[name].moved(end) for name, end in ends.items()]
                rows.append(f"| `{literal.name}` | {literal.before} | {value} | {' | '.join(cells)} |")
    print(f"\n| constant | as it is | varied to | {' | '.join(ends)} |\n| --- | --- | --- |{' --- |' * len(ends)}")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
