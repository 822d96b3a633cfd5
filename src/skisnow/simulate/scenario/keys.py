"""The keys of a scenario as users name them, in files, on the command line, in studies and in JSON: one table."""

from __future__ import annotations

from typing import Final

from .run_keys import SOLVER_KEYS, START_AND_RUN_KEYS
from .sledge_keys import FRICTION_AND_DRAG_KEYS, SKI_KEYS, SLEDGE_KEYS
from .snow_keys import SLOPE_KEYS, SNOW_KEYS

_KEYS: Final = (
    *SLOPE_KEYS,
    *SNOW_KEYS,
    *FRICTION_AND_DRAG_KEYS,
    *SLEDGE_KEYS,
    *SKI_KEYS,
    *START_AND_RUN_KEYS,
    *SOLVER_KEYS,
)

SCENARIO_KEYS: Final = {key.name: key for key in _KEYS}
"""By name, section.key, in the order of tables."""

SECTIONS: Final = tuple(dict.fromkeys(name.split(".")[0] for name in SCENARIO_KEYS))

REQUIRED: Final = (
    "friction.mu_0",
    "drag.drag_area_m2",
    "sledge.mass_kg",
    "sledge.inertia_kg_m2",
    "sledge.centre_of_mass_height_m",
    "sledge.stance_width_m",
    "sledge.edge_angle_deg",
    "start.speed_m_per_s",
)
"""Keys without a default that every scenario has; slope, snow, ski and end of the run have their own rules."""


def in_si(name: str, value: object) -> float:
    """A key's number in SI.

    >>> in_si("solver.step_ms", 0.5)
    0.0005
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"{name} is {value!r}, which is no number")
    return value * SCENARIO_KEYS[name].factor


def in_unit(name: str, value: float | None) -> float | None:
    """A number in SI in the unit that its key names; None stays.

    >>> in_unit("snow.H_V_N_per_mm3", 2e8)
    0.2
    """
    return None if value is None else value / SCENARIO_KEYS[name].factor
