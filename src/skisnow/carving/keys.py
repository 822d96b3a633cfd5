"""The inputs of a carved turn as users name them, in the command line, in studies and in JSON: one table."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any, Final, Literal

from .._support.messages import Message
from ..parameters import Quantity, own_quantities, require_declared
from ..ski.beam import CLAMP_LENGTH, MOST_ELEMENTS
from ..snow import SnowProperties
from .checks import GREATEST_EDGE_ANGLE
from .equilibrium import ELEMENTS

_SNOW: Final = {each.name: each for each in own_quantities(SnowProperties)}


@dataclass(frozen=True, slots=True, kw_only=True)
class CarveQuestion:
    """One question about a ski in snow, in the units that the names say; None where an input is not given."""

    ski: Annotated[str, Quantity("ski", "a ski of the catalogue, or the path of a ski file")]
    edge_angle_deg: Annotated[
        float,
        Quantity(
            "edge_angle_deg",
            "angle ϑ of the base under the boot to the snow surface",
            label=Message("edge angle"),
            symbol="ϑ",
            lowest=0.0,
            highest=round(math.degrees(GREATEST_EDGE_ANGLE), 9),
            origin="at 90° the side force of a balanced turn has no bound",
        ),
    ]
    load_N: Annotated[
        float,
        Quantity(
            "load_N",
            "force on this ski along the snow normal, at the boot",
            label=Message("load"),
            lowest=0.0,
            above=True,
        ),
    ]
    H_V_N_per_mm3: Annotated[float | None, _SNOW["H_V_N_per_mm3"]] = None
    S_f_N_per_mm2: Annotated[
        float | None, replace(_SNOW["S_f_N_per_mm2"], meaning=Message("failure shear stress S_f; not needed at rest"))
    ] = None
    results: Annotated[str | None, _SNOW["results"]] = None
    site: Annotated[str | None, _SNOW["site"]] = None
    published: Annotated[str | None, _SNOW["published"]] = None
    unloading_ratio: Annotated[
        float | None,
        Quantity(
            "unloading_ratio",
            "k_u/H_V: 1 is elastic snow, inf rigid-plastic snow (computed as 1000); plays no part at rest",
            symbol="$k_u/H_V$",
            lowest=1.0,
            infinite=True,
            origin="not published: a parameter",
            example="--unloading-ratio 10 (1 elastic, inf rigid-plastic)",
        ),
    ] = None
    moment_Nm: Annotated[
        float,
        Quantity(
            "moment_Nm",
            "boot moment about the cross axis (see moment_balance), positive where it presses the tip down",
            label=Message("boot moment"),
            origin="load at the boot",
        ),
    ] = 0.0
    moment_balance: Annotated[
        Literal["boot", "free"],
        Quantity(
            "moment_balance",
            "boot: that moment balances the load alone, about the horizontal, and the boot holds what the side "
            "force does besides; free: it is about the ski's own cross axis, and all that the boot holds there",
            origin="choice: boot and skier lean as they must; plays no part at rest",
        ),
    ] = "boot"
    clamp_length_m: Annotated[
        float,
        Quantity(
            "clamp_length_m",
            "length of ski that boot and binding keep straight",
            label=Message("clamp length"),
            lowest=0.0,
            origin="choice: about a boot's sole",
        ),
    ] = CLAMP_LENGTH
    footprint_stiffness_N_per_mm2: Annotated[
        float | None,
        Quantity(
            "footprint_stiffness_N_per_mm2",
            "stiffness of boot and binding under each metre of the clamp length, against bending; default: rigid",
            label=Message("footprint stiffness"),
            lowest=0.0,
            highest=1e4,
            above=True,
        ),
    ] = None
    side_force_bending: Annotated[
        bool,
        Quantity(
            "side_force_bending",
            "whether the side force, too, bends and twists the ski",
            origin="exact: its part normal to the base is sin ϑ of it",
        ),
    ] = True
    side_force_spread: Annotated[
        Literal["depth", "base-reaction"],
        Quantity(
            "side_force_spread",
            "how the side force goes along the edge: as its depth, or as the snow's force on the base",
            origin="choice: as the shear strength of the paper, S_f e; not measured",
        ),
    ] = "depth"
    groove: Annotated[
        Literal["edge", "path"],
        Quantity(
            "groove",
            "whether the groove lies under the edge of the afterbody, or on the circle of the turn",
            origin="choice: a carved track is one edge wide",
        ),
    ] = "edge"
    twist: Annotated[
        bool,
        Quantity("twist", "whether the ski twists, or keeps its edge angle everywhere", origin="exact: skis twist"),
    ] = True
    elements: Annotated[
        int,
        Quantity(
            "elements",
            "finite elements over the whole ski",
            label=Message("elements"),
            lowest=4,
            highest=MOST_ELEMENTS,
            origin="choice: 1 cm each",
        ),
    ] = ELEMENTS
    at_rest: Annotated[
        bool,
        Quantity(
            "at_rest",
            "set down on virgin snow, without side force, in place of carving",
            origin="the question is the turn",
        ),
    ] = False

    def __post_init__(self) -> None:
        require_declared(self)

    def as_dict(self) -> dict[str, Any]:
        """The inputs under their names."""
        return asdict(self)


CARVE_KEYS: Final = {key.name: key for key in own_quantities(CarveQuestion)}
"""By name, in the order of tables."""
