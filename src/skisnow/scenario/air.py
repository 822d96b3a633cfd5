"""The air of a run: its drag."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ..parameters import Quantity, Search, declared_text, require_declared


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
            label="drag area",
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
            label="density of the air",
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
            "height of the centre of pressure above the bases; left out: that of the centre of mass",
            label="height of the centre of pressure",
            lowest=0.0,
            highest=3.0,
            search=Search(0.5, 0.0, 3.0),
            needed=False,
        ),
    ]

    __repr__ = declared_text

    def __post_init__(self) -> None:
        require_declared(self)
