"""Keys of slope and snow."""

from __future__ import annotations

from typing import Final

from ...constants import STANDARD_GRAVITY
from ...units import DEGREE, N_PER_MM2, N_PER_MM3
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
    InputKey(
        name="snow.H_V_N_per_mm3",
        meaning="snow hardness H_V",
        unit="N/mm³",
        factor=N_PER_MM3,
        lowest=0.0,
        above=True,
        origin="measured 0.022 to 90; a warning beyond",
    ),
    InputKey(
        name="snow.S_f_N_per_mm2",
        meaning="failure shear stress S_f",
        unit="N/mm²",
        factor=N_PER_MM2,
        lowest=0.0,
        above=True,
        origin="measured 0.04 to 0.52; a warning beyond",
    ),
    InputKey(name="snow.results", kind="text", meaning="results.json of an analysed campaign, in place of H_V and S_f"),
    InputKey(name="snow.site", kind="text", meaning="one site of those results; left out: all of them"),
    InputKey(name="snow.published", kind="text", meaning="name of a published snow, in place of H_V and S_f"),
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
