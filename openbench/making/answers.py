"""Answers as files: exact ones from formulas, twins from the results of two programs, measured ones by their data."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, TypeAlias

from .. import CASES, VERSION, sand
from ..reading import read_case
from .exact import EXACT, formula

Json: TypeAlias = dict[str, Any]

DIGITS = 12
"""Printed of each number that is exact."""
LICENCE = "CC-BY-4.0"


def exact(name: str) -> Json:
    """From the formula."""
    case = read_case(name)
    values = {key: [_digits(v) for v in row] for key, row in EXACT[name][1](case).items()}
    return _answer(
        name,
        "exact",
        f"closed form: {formula(name)} python -m openbench.making exact",
        values,
        {key: 10.0**-DIGITS * _rms(row) for key, row in values.items()},
    )


def twin(name: str, runs: Path, sensitivity: Json | None = None) -> Json:
    """The mean of two independent programs at their finest; uncertainty: the largest difference between them."""
    both = [json.loads((runs / each / name / "result.json").read_text(encoding="utf-8")) for each in TWINS]
    first, second = (each["values"] for each in both)
    values = {key: [round(0.5 * (a + b), 9) for a, b in zip(first[key], second[key], strict=True)] for key in first}
    apart = {key: max(abs(a - b) for a, b in zip(first[key], second[key], strict=True)) for key in first}
    words = f"mean of {' and '.join(TWINS)}, two programs without a line in common; uncertainty: their largest "
    words += "difference. python -m openbench.making twins RUNS"
    answer = _answer(name, "twin", words, values, {key: float(f"{each:.2g}") for key, each in apart.items()})
    return answer | ({"sensitivity": sensitivity} if sensitivity else {})


TWINS = ("skisnow-finest", "numpy-finest")


def measured(data: Path) -> Json:
    """Case 05: what the data are, their scatter, and no number of theirs."""
    case = read_case("05-sand")
    values = sand.split(case, data)[1]
    answer = _answer(
        "05-sand",
        "measured",
        "github robomechanics/3d-terramechanics, commit 55a6e92 (MIT, Copyright 2022 Catherine Pavlov, Carnegie Mellon "
        "University). The numbers are read from the data when they are scored and are not part of this "
        "set; uncertainty: root mean square of what repeated trials differ by from their mean. "
        "python -m openbench.making measured DATA",
        values,
        {"load_N": _plate_scatter(case, data), "side_force_N": _wheel_scatter(case, data)},
    )
    del answer["values"]
    answer["values_from"] = {"source": case["data"]["source"], "sha256": sand.fingerprints(case, data)}
    return answer


def _plate_scatter(case: Json, data: Path) -> float:
    """Of the loads of repeated trials at each one's own levels, brought to one depth by the line through the origin."""
    shown, values = sand.split(case, data)
    rows = [
        *shown["plates"],
        *({**row, "load_N": load} for row, load in zip(shown["held_back_plates"], values["load_N"], strict=True)),
    ]
    left = []
    for size in {row["diameter_m"] for row in rows}:
        of = [row for row in rows if row["diameter_m"] == size]
        # log load over log depth, one line for all trials of a size: what a trial is off is what repeats differ by
        x, y = [math.log(row["depth_m"]) for row in of], [math.log(row["load_N"]) for row in of]
        mx, my = sum(x) / len(x), sum(y) / len(y)
        slope = sum((a - mx) * (b - my) for a, b in zip(x, y, strict=True)) / sum((a - mx) ** 2 for a in x)
        left += [math.exp(b) - math.exp(my + slope * (a - mx)) for a, b in zip(x, y, strict=True)]
    return float(f"{_rms(left):.2g}")


def _wheel_scatter(case: Json, data: Path) -> float:
    """Of repeated runs at one slip angle and slip ratio."""
    shown, values = sand.split(case, data)
    held = [{**row, "side_force_N": f} for row, f in zip(shown["held_back_wheel"], values["side_force_N"], strict=True)]
    groups: dict[tuple[float, float], list[float]] = {}
    for row in held:
        groups.setdefault((row["slip_angle_deg"], round(row["slip_ratio_1"], 1)), []).append(row["side_force_N"])
    left = [f - sum(each) / len(each) for each in groups.values() if len(each) > 1 for f in each]
    return float(f"{_rms(left):.2g}")


def _answer(name: str, kind: str, words: str, values: Json, uncertainty: Json) -> Json:
    scale = {key: float(f"{_scale(key, row):.6g}") for key, row in values.items()}
    return {
        "openbench": VERSION,
        "case": name,
        "kind": kind,
        "provenance": words,
        "licence": LICENCE,
        "values": values,
        "uncertainty": {key: float(f"{each:.2g}") for key, each in uncertainty.items()},
        "scale": scale,
    }


def _scale(key: str, row: list[float]) -> float:
    """What errors are compared with: the size of the answer; of a place how far the last one is from the start."""
    return math.hypot(*row[-2:]) if key == "place_m" else _rms(row)


def _rms(values: list[float]) -> float:
    return math.sqrt(sum(v * v for v in values) / len(values))


def _digits(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def write(name: str, answer: Json) -> None:
    """Into its case's folder."""
    (CASES / name / "answer.json").write_text(json.dumps(answer, indent=1) + "\n", encoding="utf-8")
