"""The tables of methods/snow-micro-pen.md: python docs/tables_of_snow_micro_pen.py RECORDING.PNT ..."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from unittest.mock import patch

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.page_tables import write_tables

from skisnow._support.units import MM
from skisnow.campaign import SnowMicroPenProfile, read_snow_micro_pen
from skisnow.campaign.snow_micro_pen import SnowMicroPenSettings
from skisnow.estimation.snow_micro_pen import EvaluatedRecording, evaluate_profile
from skisnow.parameters import build_declared

CASES = {
    "as it is": {},
    "from 0 mm": {"from_depth_mm": 0.0},
    "from 10 mm": {"from_depth_mm": 10.0},
    "to 20 mm": {"to_depth_mm": 20.0},
    "to 50 mm": {"to_depth_mm": 50.0},
    "surface at a rise of 0.005 N": {"surface_rise_N": 0.005},
    "surface at a rise of 0.05 N": {"surface_rise_N": 0.05},
    "held over 1 mm": {"surface_hold_mm": 1.0},
    "held over 10 mm": {"surface_hold_mm": 10.0},
    "force of the air taken off": {"subtract_air_force": True},
}


CONSTANTS = {
    "block of 0.25 mm": ("campaign.snow_micro_pen.BLOCK", 0.25 * MM),
    "block of 1 mm": ("campaign.snow_micro_pen.BLOCK", 1.0 * MM),
    "air over 10 mm": ("campaign.snow_micro_pen.AIR", 10.0 * MM),
    "air over 40 mm": ("campaign.snow_micro_pen.AIR", 40.0 * MM),
    "windows overlap by 25 %": ("estimation.snow_micro_pen.OVERLAP", 0.25),
    "windows overlap by 75 %": ("estimation.snow_micro_pen.OVERLAP", 0.75),
}


def by_relation(profiles: Sequence[SnowMicroPenProfile]) -> Iterator[str]:
    """Shot noise, density and surface area of each recording by each relation."""
    yield "| recording | relation | windows | f₀ (N) | δ (mm) | L (mm) | ρ (kg/m³) | SSA (m²/kg) |"
    yield "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
    for profile in profiles:
        for name, found in evaluate_profile(profile, SnowMicroPenSettings()).windows.items():
            area = f"{found.specific_surface_area:.2f}" if math.isfinite(found.specific_surface_area) else ""
            yield (
                f"| {profile.name} | {name} | {found.n} | {found.rupture_force:.4f} | {found.deflection / MM:.4f} "
                f"| {found.element_size / MM:.3f} | {found.snow_density:.1f} | {area} |"
            )


def by_setting(profiles: Sequence[SnowMicroPenProfile]) -> Iterator[str]:
    """What each setting moves: surface, mean force, density of calonne-2020."""
    yield (
        "| setting | "
        + " | ".join(f"{profile.name}: surface (mm) | mean force (N) | ρ (kg/m³)" for profile in profiles)
        + " |"
    )
    yield "| --- |" + " ---: |" * 3 * len(profiles)
    for words, changes in CASES.items():
        found = [evaluate_profile(profile, build_declared(SnowMicroPenSettings, changes)) for profile in profiles]
        yield f"| {words} | " + " | ".join(map(_cells, found)) + " |"
    for words, (constant, value) in CONSTANTS.items():
        with patch(f"skisnow.{constant}", value):
            found = [evaluate_profile(profile, SnowMicroPenSettings()) for profile in profiles]
        yield f"| {words} | " + " | ".join(map(_cells, found)) + " |"


def _cells(found: EvaluatedRecording) -> str:
    density = found.windows["calonne-2020"].snow_density
    return f"{found.surface / MM:.1f} | {found.mean_force:.3f} | {density:.1f}"


def main() -> None:
    """Write both tables."""
    profiles = [read_snow_micro_pen(Path(name)) for name in sys.argv[1:]]
    write_tables("methods/snow-micro-pen", {"relations": by_relation(profiles), "settings": by_setting(profiles)})


if __name__ == "__main__":
    main()
