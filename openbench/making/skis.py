"""The skis of the cases, as tables from tip to tail: made here, no maker's."""

from __future__ import annotations

import math


def _stations(reach: float, count: int) -> list[float]:
    return [round(reach - 2.0 * reach * i / (count - 1), 6) for i in range(count)]


def carving_ski() -> dict[str, list[float]]:
    """1.6 m, sidecut radius 13 m, shovel and tail of 0.1 m, stiffest in its middle."""
    s = _stations(0.8, 81)
    width = [0.066 + 2.0 * (13.0 - math.sqrt(13.0**2 - x * x)) for x in s]
    height = [0.05 * (max(abs(x) - 0.7, 0.0) / 0.1) ** 2 for x in s]
    bending = [60.0 + 340.0 * (1.0 - (x / 0.8) ** 2) ** 2 for x in s]
    torsional = [0.5 * each for each in bending]
    names = ("station_m", "width_m", "base_height_m", "bending_stiffness_N_m2", "torsional_stiffness_N_m2")
    return {
        name: [round(v, 9) for v in row]
        for name, row in zip(names, (s, width, height, bending, torsional), strict=True)
    }


def turning_ski(angle: float) -> dict[str, list[float]]:
    """1.6 m and rigid: bent so that at this edge angle (rad) its edge is nearly as deep all along; the tip rises."""
    s = _stations(0.8, 81)
    grows = [0.02 * (x / 0.8) ** 2 for x in s]
    width = [2.0 * (0.033 + g) for g in grows]
    height = [0.97 * g * math.tan(angle) + 0.02 * (max(x - 0.6, 0.0) / 0.2) ** 2 for x, g in zip(s, grows, strict=True)]
    names = ("station_m", "width_m", "base_height_m")
    return {name: [round(v, 9) for v in row] for name, row in zip(names, (s, width, height), strict=True)}
