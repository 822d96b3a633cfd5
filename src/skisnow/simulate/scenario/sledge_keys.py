"""Keys of friction, drag, sledge and skis."""

from __future__ import annotations

from typing import Final

from ...units import DEGREE
from ..input_keys import InputKey

FRICTION_AND_DRAG_KEYS: Final = (
    InputKey(
        name="friction.mu_0",
        meaning="μ_0 of the glide friction μ = μ_0 + μ_1 v",
        lowest=0.0,
        highest=1.0,
        origin="measured μ 0.023 to 0.139; a warning beyond",
    ),
    InputKey(
        name="friction.mu_1_s_per_m",
        meaning="μ_1 of it, with the speed v",
        unit="s/m",
        lowest=-0.1,
        highest=0.1,
        default=0.0,
        origin="choice: friction that does not depend on speed",
    ),
    InputKey(
        name="drag.drag_area_m2",
        meaning="drag area C_dA; 0: no drag",
        unit="m²",
        lowest=0.0,
        highest=10.0,
        origin="skiers 0.23 to 0.66; a warning beyond",
    ),
    InputKey(
        name="drag.air_density_kg_per_m3",
        meaning="density of the air",
        unit="kg/m³",
        lowest=0.0,
        highest=2.0,
        above=True,
        default=1.2,
        origin="choice: 0 °C at 700 m above the sea",
    ),
    InputKey(
        name="drag.centre_of_pressure_height_m",
        meaning="height of the centre of pressure above the bases; left out: that of the centre of mass",
        unit="m",
        lowest=0.0,
        highest=3.0,
    ),
)
SLEDGE_KEYS: Final = (
    InputKey(
        name="sledge.mass_kg",
        meaning="mass without the skis",
        unit="kg",
        lowest=0.0,
        highest=1000.0,
        above=True,
    ),
    InputKey(
        name="sledge.inertia_kg_m2",
        kind="three numbers",
        meaning="roll, pitch and yaw moments of inertia at the centre of mass, without the skis",
        unit="kg m²",
        lowest=0.0,
        above=True,
        origin="none is more than the sum of the others",
    ),
    InputKey(
        name="sledge.centre_of_mass_height_m",
        meaning="height of the centre of mass above the bases",
        unit="m",
        lowest=0.0,
        highest=3.0,
    ),
    InputKey(
        name="sledge.centre_of_mass_forward_m",
        meaning="how far the centre of mass lies before the boots",
        unit="m",
        lowest=-1.0,
        highest=1.0,
        default=0.0,
        origin="choice: over the boots",
    ),
    InputKey(
        name="sledge.stance_width_m",
        meaning="between the middles of the skis; at least a ski's greatest width",
        unit="m",
        lowest=0.0,
        highest=3.0,
        above=True,
    ),
    InputKey(
        name="sledge.edge_angle_deg",
        meaning="angle of both skis' bases to the sledge; positive: left edges down, a turn to the left",
        unit="°",
        factor=DEGREE,
        lowest=-85.0,
        highest=85.0,
        origin="at 90° an edge bears nothing",
    ),
)
SKI_KEYS: Final = (
    InputKey(name="ski.name", kind="text", meaning="a ski of the catalogue"),
    InputKey(name="ski.file", kind="text", meaning="the path of a ski file, in place of a name"),
    InputKey(
        name="ski.clamp_length_m",
        meaning="length of ski that boot and binding keep straight",
        unit="m",
        lowest=0.0,
        default=0.3,
        origin="choice: about a boot's sole",
    ),
    InputKey(
        name="ski.damping_ratio",
        meaning="damping ratio of the ski's first bending mode",
        lowest=0.0,
        highest=1.0,
        default=0.02,
        origin="choice: a lightly damped beam",
    ),
)
