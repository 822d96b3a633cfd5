"""The sledge of a run: what is rigid about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from .._support.errors import ParameterError
from .._support.messages import Message
from ..parameters import Quantity, Search, declared_text, require_declared


@dataclass(frozen=True, slots=True, repr=False)
class RigidSledge:
    """The sledge without its skis, SI.

    Attributes
    ----------
    mass
        (kg), > 0.
    inertia
        Roll, pitch and yaw moments of inertia at its centre of mass (kg m²), each > 0, none above the sum of the
        others.
    centre_of_mass
        Forward of the boots, and above the bases (m).
    stance_width
        Between the middles of the skis (m), > 0.
    edge_angle
        Of both skis' bases, positive: left edges down (rad).

    See Also
    --------
    skisnow.Scenario
    """

    mass: Annotated[
        float,
        Quantity(
            "sledge.mass_kg",
            "mass without the skis",
            label=Message("mass of the sledge"),
            symbol="m",
            lowest=0.0,
            highest=1000.0,
            above=True,
        ),
    ]
    inertia: Annotated[
        tuple[float, float, float],
        Quantity(
            "sledge.inertia_kg_m2",
            "roll, pitch and yaw moments of inertia at the centre of mass, without the skis",
            label=Message("moments of inertia"),
            symbol="I",
            lowest=0.0,
            above=True,
            origin="none is more than the sum of the others",
        ),
    ]
    centre_of_mass: Annotated[
        tuple[float, float],
        Quantity(
            "sledge.centre_of_mass_height_m",
            "height of the centre of mass above the bases",
            label=Message("height of the centre of mass"),
            lowest=0.0,
            highest=3.0,
            search=Search(0.5, 0.0, 3.0),
            index=1,
        ),
        Quantity(
            "sledge.centre_of_mass_forward_m",
            "how far the centre of mass lies before the boots",
            label=Message("centre of mass ahead of the boots"),
            lowest=-1.0,
            highest=1.0,
            default=0.0,
            origin="choice: over the boots",
            search=Search(0.5, -1.0, 1.0),
            index=0,
        ),
    ]
    stance_width: Annotated[
        float,
        Quantity(
            "sledge.stance_width_m",
            "between the middles of the skis; at least a ski's maximum width",
            label=Message("stance width"),
            lowest=0.0,
            highest=3.0,
            above=True,
            search=Search(0.5, 0.0, 3.0),
        ),
    ]
    edge_angle: Annotated[
        float,
        Quantity(
            "sledge.edge_angle_deg",
            "angle of both skis' bases to the sledge; positive: left edges down, a turn to the left",
            label=Message("edge angle"),
            symbol="ϑ",
            lowest=-85.0,
            highest=85.0,
            origin="at 90° an edge bears nothing",
            search=Search(30.0, -30.0, 30.0, about=True),
        ),
    ]

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)
        roll, pitch, yaw = self.inertia
        if 2.0 * max(self.inertia) > roll + pitch + yaw:
            raise ParameterError(
                "inertia is {inertia} kg m²; each moment must be above 0 and none more than the sum of the others",
                code="out_of_range",
                inertia=self.inertia,
            )


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Air:
    """Air drag: drag area C_dA (m²), density (kg/m³), height of the centre of pressure above the bases (m).

    See Also
    --------
    skisnow.Scenario
    """

    drag_area: Annotated[
        float,
        Quantity(
            "drag.drag_area_m2",
            "drag area C_dA; 0: no drag",
            label=Message("drag area"),
            symbol="$C_d A$",
            lowest=0.0,
            highest=10.0,
            origin="skiers 0.23 to 0.66; a warning beyond",
            search=Search(1.0, 0.0, 3.0),
        ),
    ]
    density: Annotated[
        float,
        Quantity(
            "drag.air_density_kg_per_m3",
            "density of the air",
            label=Message("density of the air"),
            symbol="ρ",
            lowest=0.0,
            highest=2.0,
            above=True,
            origin="choice: 0 °C at 700 m above the sea",
            search=Search(1.0, 0.5, 2.0),
        ),
    ] = 1.2
    centre_of_pressure_height: Annotated[
        float,
        Quantity(
            "drag.centre_of_pressure_height_m",
            "height of the centre of pressure above the bases; default: that of the centre of mass",
            label=Message("height of the centre of pressure"),
            lowest=0.0,
            highest=3.0,
            search=Search(0.5, 0.0, 3.0),
            needed=False,
        ),
    ]

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)
