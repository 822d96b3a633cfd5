"""For each key that may be looked for: its usual size, and the bounds where a user gives none. All are Choices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from ..simulate.scenario.keys import SCENARIO_KEYS


@dataclass(frozen=True, slots=True)
class Usual:
    """Size of a parameter in its key's unit (of its logarithm where `logarithmic`), and bounds.

    Attributes
    ----------
    size
        Derivatives step by 1 to 5 % of it.
    lower, upper
        Bounds; where `about` is set they count from the start of the search.
    """

    size: float
    lower: float
    upper: float
    about: bool = False
    logarithmic: bool = False


_USUAL: Final = {
    "slope.angle_deg": Usual(10.0, -15.0, 15.0, about=True),
    "snow.H_V_N_per_mm3": Usual(3.0, 0.002, 1000.0, logarithmic=True),  # ten times beyond what was measured
    "snow.S_f_N_per_mm2": Usual(3.0, 0.004, 5.0, logarithmic=True),
    "snow.unloading_ratio": Usual(3.0, 1.0, 1000.0, logarithmic=True),
    "friction.mu_0": Usual(0.1, 0.0, 0.5),
    "friction.mu_1_s_per_m": Usual(0.01, -0.05, 0.05),
    "drag.drag_area_m2": Usual(1.0, 0.0, 3.0),
    "drag.air_density_kg_per_m3": Usual(1.0, 0.5, 2.0),
    "drag.centre_of_pressure_height_m": Usual(0.5, 0.0, 3.0),
    "sledge.edge_angle_deg": Usual(30.0, -30.0, 30.0, about=True),
    "sledge.stance_width_m": Usual(0.5, 0.0, 3.0),
    "sledge.centre_of_mass_height_m": Usual(0.5, 0.0, 3.0),
    "sledge.centre_of_mass_forward_m": Usual(0.5, -1.0, 1.0),
    "start.x_m": Usual(1.0, -20.0, 20.0, about=True),
    "start.y_m": Usual(1.0, -20.0, 20.0, about=True),
    "start.speed_m_per_s": Usual(10.0, 0.0, 60.0),
    "start.heading_deg": Usual(30.0, -45.0, 45.0, about=True),
}
_TIMES_START: Final = 5.0


def usual(key: str, start: float) -> Usual:
    """Size and bounds of a key for a search that begins at `start`; bounds hold the start and the key's own range."""
    found = _USUAL.get(key.partition("@")[0])
    if found is None:
        size = abs(start) or 1.0
        found = Usual(size, -_TIMES_START * size, _TIMES_START * size, about=True)
    low, high = (found.lower + start, found.upper + start) if found.about else (found.lower, found.upper)
    own = SCENARIO_KEYS[key.partition("@")[0]]
    least = own.lowest + (1e-6 * found.size if own.above else 0.0)
    return Usual(
        found.size,
        min(max(low, least), start),
        max(min(high, own.highest), start),
        found.about,
        found.logarithmic,
    )
