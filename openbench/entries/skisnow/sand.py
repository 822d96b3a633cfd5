"""Sand: H_V of the given discs by skisnow's geometry, load = H_V V; the wheel by its regression on the slip angle."""

from __future__ import annotations

from typing import Any

import numpy as np

from skisnow.geometry import Disc
from skisnow.statistics import linear_fit


def solve(case: dict[str, Any]) -> dict[str, list[float] | None]:
    """Case 05. Mean of H_V over the given trials at their largest load, as the paper takes it."""
    given = case["given"]
    volumes = _volumes(given["plates"])
    loads = np.array([row["load_N"] for row in given["plates"]])
    hardness = float(volumes @ loads / (volumes @ volumes))
    angle = np.radians([row["slip_angle_deg"] for row in given["wheel"]])
    fit = linear_fit(np.array([row["side_force_N"] for row in given["wheel"]]), angle)
    held = np.radians([row["slip_angle_deg"] for row in given["held_back_wheel"]])
    return {
        "load_N": [float(v) for v in hardness * _volumes(given["held_back_plates"])],
        "side_force_N": [float(v) for v in fit.coefficients[0] + fit.coefficients[1] * held],
    }


def _volumes(rows: list[dict[str, float]]) -> Any:
    """Displaced (m³)."""
    return np.array([float(Disc(row["diameter_m"]).displaced_volume(row["depth_m"], 0.0)) for row in rows])
