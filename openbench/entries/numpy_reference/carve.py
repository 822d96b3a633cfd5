"""The carves by the slow solution."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .slow_carve import Answer, Case, solved

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Tables:
    """A ski's tables from tip to tail (m, N m²), straight between stations."""

    station: FloatArray
    width: FloatArray
    base_height: FloatArray
    bending_stiffness: FloatArray
    torsional_stiffness: FloatArray

    @classmethod
    def of(cls, body: dict[str, Any]) -> Tables:
        keys = ("station_m", "width_m", "base_height_m", "bending_stiffness_N_m2", "torsional_stiffness_N_m2")
        return cls(*(np.array(body[key]) for key in keys))

    def at(self, station: npt.ArrayLike, /) -> Tables:
        where = np.asarray(station, float)
        tables = (self.width, self.base_height, self.bending_stiffness, self.torsional_stiffness)
        return Tables(where, *(np.interp(where, self.station[::-1], row[::-1]) for row in tables))


def solve(case: dict[str, Any], *, knots: int, across: int) -> dict[str, list[float] | None]:
    """Radius, depth and contact of each point."""
    ski, snow, loads = Tables.of(case["body"]), case["snow"], case["loads"]
    points = zip(snow["snow_hardness_N_per_m3"], loads["load_N"], loads["edge_angle_deg"], strict=True)
    found = [
        solved(
            Case(
                ski=ski,
                hardness=hardness,
                edge_angle=math.radians(angle),
                load=load,
                unloading_ratio=snow["unloading_ratio_1"],
                clamp_length=case["body"]["clamp_length_m"],
                knots=knots,
                across=across,
            )
        )
        for hardness, load, angle in points
    ]
    return {
        "turn_radius_at_boot_m": [each.radius_at_boot() for each in found],
        "edge_depth_at_boot_m": [_at_boot(each) for each in found],
        "contact_length_m": [front - rear for front, rear in (each.contact_ends() for each in found)],
    }


def _at_boot(answer: Answer) -> float:
    return float(np.interp(0.0, answer.station[::-1], answer.edge_depth[::-1]))
