"""The inputs of a carved turn as users name them, in the command line, in studies and in JSON: one table."""

from __future__ import annotations

import math
from typing import Final

from ..units import DEGREE, N_PER_MM2, N_PER_MM3
from .carve import CLAMP_LENGTH, ELEMENTS, GREATEST_EDGE_ANGLE
from .input_keys import InputKey

MOST_ELEMENTS: Final = 4000
"""Elements of 0.4 mm: finer ones would only cost time (Choice)."""

_KEYS: Final = (
    InputKey(name="ski", kind="text", meaning="a ski of the catalogue, or the path of a ski file"),
    InputKey(
        name="edge_angle_deg",
        meaning="angle ϑ of the base under the boot to the snow surface",
        unit="°",
        factor=DEGREE,
        lowest=0.0,
        highest=round(GREATEST_EDGE_ANGLE / DEGREE, 9),
        origin="at 90° the side force of a balanced turn has no bound",
    ),
    InputKey(
        name="load_N",
        meaning="force on this ski along the snow normal, at the boot",
        unit="N",
        lowest=0.0,
        above=True,
    ),
    InputKey(
        name="H_V_N_per_mm3",
        meaning="snow hardness H_V",
        unit="N/mm³",
        factor=N_PER_MM3,
        lowest=0.0,
        above=True,
        origin="measured 0.022 to 90; a warning beyond",
    ),
    InputKey(
        name="S_f_N_per_mm2",
        meaning="failure shear stress S_f; not needed at rest",
        unit="N/mm²",
        factor=N_PER_MM2,
        lowest=0.0,
        above=True,
        origin="measured 0.04 to 0.52; a warning beyond",
    ),
    InputKey(name="results", kind="text", meaning="results.json of an analysed campaign, in place of H_V and S_f"),
    InputKey(name="site", kind="text", meaning="one site of those results; left out: all of them"),
    InputKey(name="published", kind="text", meaning="name of a published snow, in place of H_V and S_f"),
    InputKey(
        name="unloading_ratio",
        meaning="k_u/H_V: 1 is elastic snow, inf rigid-plastic snow (computed as 1000); plays no part at rest",
        lowest=1.0,
        infinite=True,
        origin="not published: a parameter",
        example="--unloading-ratio 10 (1 elastic, inf rigid-plastic)",
    ),
    InputKey(
        name="moment_Nm",
        meaning="boot moment about the cross axis (see moment_balance), positive where it presses the tip down",
        unit="N m",
        default=0.0,
        origin="load at the boot",
    ),
    InputKey(
        name="moment_balance",
        kind="text",
        choices=("boot", "free"),
        meaning="boot: that moment balances the load alone, about the horizontal, and the boot holds what the side "
        "force does besides; free: it is about the ski's own cross axis, and all that the boot holds there",
        default="boot",
        origin="choice: boot and skier lean as they must; plays no part at rest",
    ),
    InputKey(
        name="clamp_length_m",
        meaning="length of ski that boot and binding keep straight",
        unit="m",
        lowest=0.0,
        default=CLAMP_LENGTH,
        origin="choice: about a boot's sole",
    ),
    InputKey(
        name="side_force_bending",
        kind="switch",
        meaning="whether the side force, too, bends and twists the ski",
        default=True,
        origin="exact: its part normal to the base is sin ϑ of it",
    ),
    InputKey(
        name="groove",
        kind="text",
        choices=("edge", "path"),
        meaning="whether the groove lies under the edge of the afterbody, or on the circle of the turn",
        default="edge",
        origin="choice: a carved track is one edge wide",
    ),
    InputKey(
        name="twist",
        kind="switch",
        meaning="whether the ski twists, or keeps its edge angle everywhere",
        default=True,
        origin="exact: skis twist",
    ),
    InputKey(
        name="elements",
        kind="whole number",
        meaning="finite elements over the whole ski",
        lowest=4,
        highest=MOST_ELEMENTS,
        default=ELEMENTS,
        origin="choice: 1 cm each",
    ),
    InputKey(
        name="at_rest",
        kind="switch",
        meaning="set down on virgin snow, without side force, in place of carving",
        default=False,
        origin="the question is the turn",
    ),
)

CARVE_KEYS: Final = {key.name: key for key in _KEYS}
"""By name, in the order of tables."""

SUSPICIOUS_EDGE_ANGLE_DEG: Final = 1.6
"""Angles below it, but 0, look like radians: 1.6 is just above 90° in radians."""


def in_degrees_if_radians(edge_angle_deg: float) -> float | None:
    """The degrees that are meant where the number looks like radians, else None.

    >>> round(in_degrees_if_radians(0.785), 1), in_degrees_if_radians(45.0), in_degrees_if_radians(0.0)
    (45.0, None, None)
    """
    return math.degrees(edge_angle_deg) if 0.0 < edge_angle_deg < SUSPICIOUS_EDGE_ANGLE_DEG else None
