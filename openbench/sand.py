"""Case 05: the measured numbers, read where they lie and split into what is given and what is held back.

They are no part of the set: github robomechanics/3d-terramechanics (MIT, © 2022 Catherine Pavlov, Carnegie Mellon
University).
"""

from __future__ import annotations

import csv
import hashlib
from pathlib import Path
from typing import Any, TypeAlias

from .words import OpenbenchError

Rows: TypeAlias = list[dict[str, float]]

MM = 1e-3
PLATES = {"plate_diameter_mm": ("diameter_m", MM), "depth_mm": ("depth_m", MM), "load_N": ("load_N", 1.0)}
WHEEL = {"slip_angle_deg": ("slip_angle_deg", 1.0), "slip_ratio": ("slip_ratio_1", 1.0), "Fx_N": ("side_force_N", 1.0)}


def split(case: dict[str, Any], data: Path) -> tuple[dict[str, Rows], dict[str, list[float]]]:
    """What a program is given, and the values that it does not see."""
    told = case["data"]
    plates, wheel = (_rows(data / name) for name in told["files"])
    trials = {float(each) for each in told["given_plate_trials_1"]}
    angles = set(told["given_slip_angle_deg"])
    given: Rows = []
    held: Rows = []
    for row in plates:
        (given if row["trial"] in trials else held).append(_in_si(row, PLATES))
    turned: Rows = []
    kept: Rows = []
    for row in wheel:
        (turned if row["slip_angle_deg"] in angles else kept).append(_in_si(row, WHEEL))
    values = {"load_N": [row.pop("load_N") for row in held], "side_force_N": [row.pop("side_force_N") for row in kept]}
    shown = {"plates": given, "held_back_plates": held, "wheel": turned, "held_back_wheel": kept}
    return shown, values


def fingerprints(case: dict[str, Any], data: Path) -> dict[str, str]:
    """SHA-256 of each file that was read."""
    return {name: hashlib.sha256((data / name).read_bytes()).hexdigest() for name in case["data"]["files"]}


def _rows(path: Path) -> list[dict[str, float]]:
    if not path.exists():
        raise OpenbenchError(
            f"--data {path.parent} has no {path.name}. It is a file of github robomechanics/3d-terramechanics (MIT), "
            "prepared as the page of case 05-sand says; without --data the case is left out."
        )
    with path.open(newline="", encoding="utf-8") as stream:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(stream)]


def _in_si(row: dict[str, float], columns: dict[str, tuple[str, float]]) -> dict[str, float]:
    return {name: row[column] * factor for column, (name, factor) in columns.items()}
