"""Published relations that take density and surface area from a micro-penetrometer's force, by the names of users."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from .._support.arrays import FloatArray
from .published import calonne_2020, king_2020, proksch_2015

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


@dataclass(frozen=True, slots=True)
class PenetrometerRelation:
    """Density, and where there is one the surface area, from median force F (N) and element size L (m) of windows.

    Attributes
    ----------
    source
        The publication in short.
    window
        Length of the windows that it was fitted with (m).
    snow_density
        ρ (kg/m³) of F and L.
    specific_surface_area
        SSA (m²/kg) of F and L, or None.
    """

    source: str
    window: float
    snow_density: Callable[[FloatArray, FloatArray], FloatArray]
    specific_surface_area: Callable[[FloatArray, FloatArray], FloatArray] | None = None


PENETROMETER_RELATIONS: Final[Mapping[str, PenetrometerRelation]] = MappingProxyType(
    {
        "proksch-2015": PenetrometerRelation(
            proksch_2015.SOURCE,
            proksch_2015.WINDOW,
            proksch_2015.snow_density,
            proksch_2015.specific_surface_area,
        ),
        "calonne-2020": PenetrometerRelation(
            calonne_2020.SOURCE,
            calonne_2020.WINDOW,
            calonne_2020.snow_density,
            calonne_2020.specific_surface_area,
        ),
        "king-2020a": PenetrometerRelation(king_2020.SOURCE, king_2020.WINDOW, king_2020.snow_density_a),
        "king-2020b": PenetrometerRelation(king_2020.SOURCE, king_2020.WINDOW, king_2020.snow_density_b),
    }
)
"""By name. A further relation is one more publication's file and its entry here."""
