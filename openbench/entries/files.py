"""What every entry in Python does with files: ask for a case, write a result, decline what it cannot do."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

Case: TypeAlias = dict[str, Any]
Values: TypeAlias = dict[str, list[float] | None]
Solver: TypeAlias = Callable[[Case], Values]


def given(folder: Path) -> Case:
    """The case in a folder; with what is given beside it, where data are."""
    case: Case = json.loads((folder / "case.json").read_text(encoding="utf-8"))
    beside = folder / "given.json"
    if beside.exists():
        case["given"] = json.loads(beside.read_text(encoding="utf-8"))
    return case


def answer(program: str, solvers: Mapping[str, Solver], declines: Mapping[str, str], words: list[str]) -> None:
    """Solve the case of ``words`` (case folder, result file), or say why not."""
    folder, result = Path(words[0]), Path(words[1])
    case = given(folder)
    name = case["case"]
    out: Case = {"openbench": case["openbench"], "case": name, "program": program}
    solve = solvers.get(name)
    if solve is None:
        out["declined"] = declines.get(name, "no such case is known to this program")
    elif "data" in case and "given" not in case:
        out["declined"] = "the data are not here: no given.json"
    else:
        out["values"] = solve(case)
    result.write_text(json.dumps(out), encoding="utf-8")


def main(program: str, solvers: Mapping[str, Solver], declines: Mapping[str, str]) -> None:
    """For ``python -m``: case folder and result file are the last two words."""
    answer(program, solvers, declines, sys.argv[-2:])
