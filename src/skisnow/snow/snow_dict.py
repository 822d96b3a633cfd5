"""A snow as JSON values: SI numbers become the units that the keys name."""

from __future__ import annotations

from typing import Any

from .._support.units import MM, N_PER_MM2, N_PER_MM3
from .properties import SnowProperties


def snow_dict(snow: SnowProperties) -> dict[str, Any]:
    """Where a snow comes from, and its intervals in the units of the contract; of k_u/H_V where it was measured."""

    def interval(ends: tuple[float, float] | None, unit: float) -> list[float] | None:
        return None if ends is None else [end / unit for end in ends]

    told = {
        "source": snow.source,
        "H_V_interval_N_per_mm3": interval(snow.snow_hardness_interval, N_PER_MM3),
        "S_f_interval_N_per_mm2": interval(snow.failure_shear_stress_interval, N_PER_MM2),
    }
    if snow.unloading_ratio_interval is not None:
        told["unloading_ratio_interval"] = list(snow.unloading_ratio_interval)
    if snow.shear_displacement_interval is not None:
        told["shear_displacement_interval_mm"] = interval(snow.shear_displacement_interval, MM)
    return told
