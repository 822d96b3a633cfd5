"""The carves: skisnow.carve."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from skisnow import Ski, SnowProperties
from skisnow.carving.equilibrium import carve

from .effort import Effort

HOLDS = 1e9
"""S_f (N/m²) of a snow that holds every edge: the case gives the side force, whatever draws it."""


def solve(case: dict[str, Any], effort: Effort) -> dict[str, list[float] | None]:
    """Radius, depth and contact of each point."""
    ski, snow, loads = ski_of(case["body"]), case["snow"], case["loads"]
    rows = []
    for hardness, load, angle in zip(
        snow["snow_hardness_N_per_m3"], loads["load_N"], loads["edge_angle_deg"], strict=True
    ):
        found = carve(
            ski,
            SnowProperties(hardness, HOLDS, source="openbench"),
            edge_angle=math.radians(angle),
            load=load,
            unloading_ratio=snow["unloading_ratio_1"],
            clamp_length=case["body"]["clamp_length_m"],
            elements=effort.elements,
        )
        if found.edge_depth is None or found.turn_radius_boot is None or found.contact_length is None:
            raise RuntimeError(f"no equilibrium: {found.outcome}")
        depth = float(np.interp(0.0, found.station[::-1], found.edge_depth[::-1]))
        rows.append((found.turn_radius_boot, depth, found.contact_length))
    radius, depths, contact = zip(*rows, strict=True)
    return {
        "turn_radius_at_boot_m": list(radius),
        "edge_depth_at_boot_m": list(depths),
        "contact_length_m": list(contact),
    }


def ski_of(body: dict[str, Any]) -> Ski:
    """The case's tables as skisnow takes them, in steps of 2.5 mm at most."""
    station = np.array(body["station_m"])
    fine = np.linspace(station[0], station[-1], 8 * (len(station) - 1) + 1)

    def along(key: str) -> Any:
        return np.interp(fine, station[::-1], np.array(body[key])[::-1])

    return Ski(
        name="openbench 06",
        source="openbench",
        station=fine,
        width=along("width_m"),
        base_height=along("base_height_m"),
        bending_stiffness=along("bending_stiffness_N_m2"),
        torsional_stiffness=along("torsional_stiffness_N_m2"),
        mass_per_length=np.ones_like(fine),
        running_length=1.4,
        sidecut_length=1.6,
    )
