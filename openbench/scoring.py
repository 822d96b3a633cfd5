"""Error against cost: how far a result is from the answer, and what it took."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from . import CASES, sand
from .checking import problems
from .reading import case_names, read_answer, read_case
from .running import START
from .words import OpenbenchError

Json: TypeAlias = dict[str, Any]


@dataclass(frozen=True)
class Score:
    """Of one program on one case.

    ``error`` is the root mean square over the quantities of the case of each one's error over its scale, as a share of
    one; ``floor`` the same of the answer's own uncertainty. ``cost`` is CPU time over that of the calibration loop, the
    start of the program included. ``spread`` of the case with headings: largest less smallest over the mean.
    """

    program: str
    case: str
    outcome: str
    error: float | None = None
    floor: float = 0.0
    quantities: dict[str, float] = field(default_factory=dict)
    spread: float | None = None
    cost: float | None = None
    wall_s: float | None = None
    problems: tuple[str, ...] = ()


def answer_values(name: str, data: Path | None, folder: Path = CASES) -> dict[str, list[float]] | None:
    """What is right; None where the data that it is read from are not here."""
    answer = read_answer(name, folder)
    if "values" in answer:
        values: dict[str, list[float]] = answer["values"]
        return values
    if data is None:
        return None
    found = sand.fingerprints(read_case(name, folder), data)
    if found != answer["values_from"]["sha256"]:
        raise OpenbenchError(f"--data {data}: the files are not those of the answer of {name}; see its page")
    return sand.split(read_case(name, folder), data)[1]


def error_of(given: list[float], right: list[float], scale: float) -> float:
    """Root mean square of the differences, over the scale."""
    return math.sqrt(sum((a - b) ** 2 for a, b in zip(given, right, strict=True)) / len(right)) / scale


def spread_of(given: list[float], group: int) -> float:
    """Largest less smallest over the mean of each group, the mean of the groups."""
    groups = [given[i : i + group] for i in range(0, len(given), group)]
    return sum((max(each) - min(each)) * len(each) / sum(each) if sum(each) else 0.0 for each in groups) / len(groups)


def score_case(
    case: Json, answer: Json, right: dict[str, list[float]], values: Json
) -> tuple[float | None, float, dict[str, float], float | None]:
    """Error, floor, error of each quantity, spread."""
    errors, floors, spread = {}, {}, None
    for asked in case["asked"]:
        key = asked["key"]
        given = values[key]
        if given is None:
            continue
        scale = answer["scale"][key]
        errors[key] = error_of(given, right[key], scale)
        floors[key] = answer["uncertainty"][key] / scale
        if "spread_over" in asked:
            spread = spread_of(given, asked["spread_over"])
    return _rms(list(errors.values())), _rms(list(floors.values())) or 0.0, errors, spread


def _rms(values: list[float]) -> float | None:
    return math.sqrt(sum(value**2 for value in values) / len(values)) if values else None


def score(runs: Path, *, data: Path | None = None, cases: Path = CASES) -> list[Score]:
    """Of every program in a folder of runs, on every case; what is missing or wrong is told in ``outcome``."""
    folders = sorted(path.parent for path in runs.glob("*/run.json"))
    if not folders:
        raise OpenbenchError(f"{runs} holds no run; make one: python -m openbench run PROGRAM --out {runs}")
    return [_score(folder, name, data, cases) for folder in folders for name in case_names(cases)]


def _score(folder: Path, name: str, data: Path | None, cases: Path) -> Score:
    record = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    program, took = record["program"], record["cases"].get(name)
    if took is None or not (folder / name).is_dir():
        words = f"case {name} is missing from the run of {program}: run it, or let the program decline it"
        return Score(program, name, "missing", problems=(words,))
    case, answer = read_case(name, cases), read_answer(name, cases)
    wrong = problems(case, folder / name / "result.json")
    if wrong:
        return Score(program, name, "refused", problems=tuple(wrong))
    result = json.loads((folder / name / "result.json").read_text(encoding="utf-8"))
    if "declined" in result:
        return Score(program, name, f"declined: {result['declined']}")
    right = answer_values(name, data, cases)
    if right is None:
        return Score(program, name, "not scored: the data are not here; give --data")
    error, floor, quantities, spread = score_case(case, answer, right, result["values"])
    cost = took["cpu_s"] / took["loop_cpu_s"]
    return Score(program, name, "done", error, floor, quantities, spread, cost, took["wall_s"])


def start_costs(runs: Path) -> dict[str, float]:
    """What each program costs to start, in loops."""
    out = {}
    for path in sorted(runs.glob("*/run.json")):
        record = json.loads(path.read_text(encoding="utf-8"))
        took = record["cases"][START]
        out[record["program"]] = took["cpu_s"] / took["loop_cpu_s"]
    return out
