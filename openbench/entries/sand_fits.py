"""What a law can say of the sand: fits to the given half."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Values = dict[str, list[float] | None]


def linear_in_depth(case: dict[str, Any]) -> Values:
    """Load = H times displaced volume; the wheel is interpolated."""
    given = case["given"]
    volumes, loads = _volumes(given["plates"]), np.array([row["load_N"] for row in given["plates"]])
    hard = float(volumes @ loads / (volumes @ volumes))
    return {
        "load_N": [float(v) for v in hard * _volumes(given["held_back_plates"])],
        "side_force_N": interpolated(case),
    }


def bekker(case: dict[str, Any]) -> Values:
    """p = (k_c/b + k_phi) z^n of Bekker and Wong, b the radius: exponent by trial, the moduli by least squares."""
    given = case["given"]
    radius, depth, pressure = _columns(given["plates"])
    best = (math.inf, 1.0, np.zeros(2))
    for n in np.linspace(0.5, 2.0, 151):
        columns = np.column_stack([depth**n / radius, depth**n])
        moduli, *_ = np.linalg.lstsq(columns, pressure, rcond=None)
        left = float(np.sum((columns @ moduli - pressure) ** 2))
        best = min(best, (left, float(n), moduli), key=lambda each: each[0])
    radius, depth, _ = _columns(given["held_back_plates"])
    found = math.pi * radius**2 * depth ** best[1] * (best[2][0] / radius + best[2][1])
    return {"load_N": [float(v) for v in found], "side_force_N": interpolated(case)}


def interpolated(case: dict[str, Any]) -> list[float]:
    """Side force between the given slip angles, at the nearest slip ratio of those given."""
    rows = case["given"]["wheel"]
    angles = sorted({row["slip_angle_deg"] for row in rows})
    ratios = sorted({round(row["slip_ratio_1"], 1) for row in rows})

    def mean(angle: float, ratio: float) -> float:
        near = [r for r in rows if r["slip_angle_deg"] == angle]
        nearest = min(abs(r["slip_ratio_1"] - ratio) for r in near)
        of = [r["side_force_N"] for r in near if abs(r["slip_ratio_1"] - ratio) < nearest + 0.05]
        return sum(of) / len(of)

    table = {ratio: [mean(angle, ratio) for angle in angles] for ratio in ratios}
    return [
        float(np.interp(row["slip_angle_deg"], angles, table[min(ratios, key=lambda r: abs(r - row["slip_ratio_1"]))]))
        for row in case["given"]["held_back_wheel"]
    ]


def _columns(rows: list[dict[str, float]]) -> tuple[FloatArray, FloatArray, FloatArray]:
    radius, depth = (np.array([row[key] for row in rows]) for key in ("diameter_m", "depth_m"))
    load = np.array([row.get("load_N", 0.0) for row in rows])
    return radius / 2.0, depth, load / (math.pi * (radius / 2.0) ** 2)


def _volumes(rows: list[dict[str, float]]) -> FloatArray:
    radius, depth, _ = _columns(rows)
    return np.asarray(math.pi * radius**2 * depth)
