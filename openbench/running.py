"""A program on the cases: each in a folder of its own without its answer, timed beside the calibration loop."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from . import CASES, VERSION, sand
from .calibration import loop_seconds
from .checking import problems
from .reading import case_names, read_case

LIMIT_S: Final = 600.0
"""After so long a case is given up, unless said otherwise."""
START: Final = "00-start"
"""A case that nobody knows: what it costs is what a program costs to start."""
ROOT: Final = Path(__file__).parents[1]


@dataclass(frozen=True)
class Asked:
    """Which cases are run, and how."""

    cases: tuple[str, ...] = tuple(case_names())
    data: Path | None = None
    repeats: int = 1
    limit_s: float = LIMIT_S


def _say(words: str) -> None:
    print(words, flush=True)


def run(
    name: str, command: Sequence[str], out: Path, asked: Asked, tell: Callable[[str], None] = _say
) -> dict[str, Any]:
    """Run a program on the cases; results and ``run.json`` go to ``out``/``name``."""
    folder = out / name
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    timings: dict[str, Any] = {}
    for case in (START, *asked.cases):
        timings[case] = found = _run_case(command, case, folder, asked)
        if case != START:
            wrong = found["problems"]
            tell(f"{name:16} {case:12} {found['wall_s']:8.2f} s  {'; '.join(wrong) or found['outcome']}")
    record = {
        "openbench": VERSION,
        "program": name,
        "command": shlex.join(command),
        "python": sys.version.split()[0],
        "cores": os.cpu_count(),
        "cases": timings,
    }
    (folder / "run.json").write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    return record


def _run_case(command: Sequence[str], name: str, folder: Path, asked: Asked) -> dict[str, Any]:
    kept = folder / name
    kept.mkdir()
    with tempfile.TemporaryDirectory() as place:
        case = _laid_out(name, Path(place) / name, asked.data)
        result = Path(place) / "result.json"
        before = loop_seconds()
        spent = [_timed([*command, str(Path(place) / name), str(result)], asked.limit_s) for _ in range(asked.repeats)]
        loop = min(before, loop_seconds())
        wrong = problems(case, result)
        if result.exists():
            shutil.copy(result, kept / "result.json")
    wall, cpu, code, said = min(spent, key=lambda each: each[1])
    if wrong and code:
        wrong.append(f"the command ended with {code}: {said}")
    return {
        "wall_s": wall,
        "cpu_s": cpu,
        "loop_cpu_s": loop,
        "outcome": _outcome(kept / "result.json", wrong),
        "problems": wrong,
    }


def _outcome(path: Path, wrong: list[str]) -> str:
    if wrong:
        return "refused"
    declined = json.loads(path.read_text(encoding="utf-8")).get("declined")
    return "done" if declined is None else f"declined: {declined}"


def _laid_out(name: str, place: Path, data: Path | None) -> dict[str, Any]:
    """The folder that the program sees: the case, and what is given of measured data."""
    place.mkdir()
    if name == START:
        case: dict[str, Any] = {"openbench": VERSION, "case": START, "asked": []}
        (place / "case.json").write_text(json.dumps(case), encoding="utf-8")
        return case
    shutil.copy(CASES / name / "case.json", place)
    case = read_case(name)
    if "data" in case and data is not None:
        (place / "given.json").write_text(json.dumps(sand.split(case, data)[0]), encoding="utf-8")
    return case


def _timed(command: list[str], limit_s: float) -> tuple[float, float, int, str]:
    """Wall and CPU seconds, exit code, last line that was said."""
    paths = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    start, cpu = time.perf_counter(), _children_cpu()
    try:
        done = subprocess.run(
            command, env=os.environ | threads | {"PYTHONPATH": paths}, capture_output=True, timeout=limit_s, check=False
        )
        code, said = done.returncode, done.stderr.decode(errors="replace").strip().rpartition("\n")[2]
    except subprocess.TimeoutExpired:
        code, said = 124, f"it took longer than {limit_s:g} s"
    except OSError as error:
        code, said = 127, str(error)
    return time.perf_counter() - start, _children_cpu() - cpu, code, said


def _children_cpu() -> float:
    try:
        import resource
    except ImportError:  # Windows, which counts in ticks
        times = os.times()
        return times.children_user + times.children_system
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
