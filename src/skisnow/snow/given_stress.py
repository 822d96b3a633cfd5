"""A failure shear stress that is given beside a named snow."""

from __future__ import annotations

from dataclasses import replace

from .._support.errors import ParameterError
from .._support.units import N_PER_MM2
from .properties import SnowProperties


def require_stress(snow: SnowProperties, S_f_N_per_mm2: float | None, *, carves: bool) -> None:
    """Refuse a named snow that has no S_f where one is needed, or one of its own beside a given one.

    Raises
    ------
    ParameterError
        S_f comes from both sides, or from none although the ski carves.
    """
    if S_f_N_per_mm2 is not None and snow.failure_shear_stress is not None:
        raise ParameterError(
            f"S_f_N_per_mm2 cannot stand beside this snow ({snow.source}), which has its own S_f. Leave one out, or "
            "give H_V_N_per_mm3 and S_f_N_per_mm2 as numbers"
        )
    if carves and S_f_N_per_mm2 is None and snow.failure_shear_stress is None:
        raise ParameterError(
            f"this snow ({snow.source}) has no failure shear stress S_f, which a carved turn needs. Give one beside "
            "it, S_f_N_per_mm2 (--S-f-N-per-mm2), or ask for the ski at rest (--at-rest)"
        )


def with_stress(snow: SnowProperties, S_f_N_per_mm2: float | None) -> SnowProperties:
    """The snow, with a given S_f where it has none."""
    if S_f_N_per_mm2 is None:
        return snow
    stress = S_f_N_per_mm2 * N_PER_MM2
    return replace(snow, failure_shear_stress=stress, source=f"{snow.source}; S_f given as a number")
