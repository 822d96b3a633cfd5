"""Keys of slope and snow."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from ...constants import STANDARD_GRAVITY
from ...units import DEGREE
from ..carve_keys import CARVE_KEYS
from ..input_keys import InputKey
from .slope import STEEPEST

SLOPE_KEYS: Final = (
    InputKey(
        name="slope.kind",
        kind="text",
        choices=("plane", "profile"),
        meaning="a plane, or a measured profile of heights",
        default="plane",
        origin="choice: the simpler one",
    ),
    InputKey(
        name="slope.angle_deg",
        meaning='inclination of the plane; only with kind = "plane"',
        unit="°",
        factor=DEGREE,
        lowest=0.0,
        highest=round(STEEPEST / DEGREE, 9),
        origin="choice: steeper is a cliff",
    ),
    InputKey(
        name="slope.profile",
        kind="text",
        meaning='CSV file with the columns x and y, horizontal distance and height in m; only with kind = "profile"',
    ),
    InputKey(
        name="slope.profile_gap",
        kind="text",
        choices=("error", "interpolate"),
        meaning="what to do where points of the profile are more than 5 m apart",
        default="error",
        origin="choice: nobody measured what lies between",
    ),
    InputKey(
        name="slope.gravity_m_per_s2",
        meaning="acceleration of gravity",
        unit="m/s²",
        lowest=0.0,
        highest=100.0,
        above=True,
        default=STANDARD_GRAVITY,
        origin="the value that the skiing literature computes with",
    ),
)
SNOW_KEYS: Final = (
    replace(CARVE_KEYS["H_V_N_per_mm3"], name="snow.H_V_N_per_mm3"),
    replace(CARVE_KEYS["S_f_N_per_mm2"], name="snow.S_f_N_per_mm2", meaning="failure shear stress S_f"),
    *(replace(CARVE_KEYS[name], name=f"snow.{name}") for name in ("results", "site", "published")),
    InputKey(
        name="snow.unloading_ratio",
        meaning='k_u/H_V: 1 is elastic snow, 1000 all but rigid-plastic; left out or 1 with penetration = "elastic"',
        lowest=1.0,
        highest=1000.0,
        origin="not published: a parameter",
    ),
    InputKey(
        name="snow.penetration",
        kind="text",
        choices=("hypoplastic", "elastic"),
        meaning="whether the snow keeps the groove, or springs back",
        default="hypoplastic",
        origin="snow keeps its tracks",
    ),
    InputKey(
        name="snow.compaction_resistance",
        kind="switch",
        meaning="whether pushing the groove brakes the ski",
        default=True,
        origin="exact: else a gliding ski would cut its groove for nothing",
    ),
)
