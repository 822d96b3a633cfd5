"""How finely skisnow computes."""

from __future__ import annotations

from dataclasses import dataclass

from skisnow.contact import SnowField


@dataclass(frozen=True)
class Effort:
    """Spacing of lines (m), tolerance of a step (m), elements of a ski, poses of a cycle, and numerics of the snow."""

    name: str
    spacing: float
    tolerance: float
    elements: int
    poses: int
    numerics: dict[str, float]


DEFAULT = Effort("skisnow", 0.02, 1e-6, 160, 200, {})
FAST = Effort("skisnow-fast", 0.04, 3e-6, 80, 50, {"knot_area": 1e-3})
FINEST = Effort(
    "skisnow-finest", 0.005, 1e-8, 640, 2000, {"knot_area": 1e-6, "part_along": 0.0025, "part_across": 5e-4}
)


def snow_field(effort: Effort, snow: dict[str, float], *, ratio: float | None = None) -> SnowField:
    """The snow of a case; what it does not say is not there."""
    return SnowField(
        snow["snow_hardness_N_per_m3"],
        snow.get("failure_shear_stress_N_per_m2", 0.0),
        snow["unloading_ratio_1"] if ratio is None else ratio,
        friction=snow.get("friction_1", 0.0),
        friction_direction="along-ski",  # as the cases have it
        shear_displacement=snow.get("shear_displacement_m", 5e-4),
        **effort.numerics,  # type: ignore[arg-type]
    )
