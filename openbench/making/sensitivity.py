"""How far the end of the turn moves with each unknown, by a program that is asked through files."""

from __future__ import annotations

import copy
import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeAlias

from ..reading import read_case

Json: TypeAlias = dict[str, Any]

STEP: Final = 0.02
"""Each unknown goes up and down by this share: smaller ones see the kinks of the law."""
PROGRAM: Final = [sys.executable, "-m", "openbench.entries.skisnow"]


def _snow(key: str) -> Callable[[Json, float], None]:
    def change(case: Json, factor: float) -> None:
        given = case["snow"][key]
        case["snow"][key] = [1.0 + (v - 1.0) * factor for v in given] if isinstance(given, list) else given * factor

    return change


def _start(case: Json, factor: float) -> None:
    case["motion"]["start_speed_m_per_s"] *= factor


def _drag(case: Json, factor: float) -> None:
    case["body"]["drag_kg_per_m"] *= factor


UNKNOWNS: Final[dict[str, Callable[[Json, float], None]]] = {
    "snow_hardness_N_per_m3": _snow("snow_hardness_N_per_m3"),
    "unloading_ratio_1 less 1": _snow("unloading_ratio_1"),
    "failure_shear_stress_N_per_m2": _snow("failure_shear_stress_N_per_m2"),
    "shear_displacement_m": _snow("shear_displacement_m"),
    "friction_1": _snow("friction_1"),
    "drag_kg_per_m": _drag,
    "start_speed_m_per_s": _start,
}


def sensitivities(runs: Path) -> Json:  # noqa: ARG001 - computed anew, in seconds
    """Distance (m) by which the last place moves for 1 % of each unknown, on the first and on the second snow."""
    case = read_case("07-turn")
    told = {name: _moved(case, change) for name, change in UNKNOWNS.items()}
    words = f"distance of the last place for 1 % of each, from ± {100 * STEP:g} %, by skisnow as it comes"
    return {"words": words, "end_moves_m": told}


def _moved(case: Json, change: Callable[[Json, float], None]) -> list[float]:
    ends = []
    for factor in (1.0 + STEP, 1.0 - STEP):
        other = copy.deepcopy(case)
        change(other, factor)
        ends.append(_ends(other))
    return [round(math.dist(a, b) / (200.0 * STEP), 4) for a, b in zip(*ends, strict=True)]


def _ends(case: Json) -> list[tuple[float, float]]:
    with tempfile.TemporaryDirectory() as place:
        folder, result = Path(place) / "case", Path(place) / "result.json"
        folder.mkdir()
        (folder / "case.json").write_text(json.dumps(case), encoding="utf-8")
        subprocess.run([*PROGRAM, str(folder), str(result)], check=True)
        places = json.loads(result.read_text(encoding="utf-8"))["values"]["place_m"]
    half = len(places) // 2
    return [(places[half - 2], places[half - 1]), (places[-2], places[-1])]
