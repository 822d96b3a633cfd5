"""Force from the mean pressure on the base: the law of Federolf and others (2006)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ...snow import MeasuredRange
from ..measured_ranges import PRESSURE_OFFSET, PRESSURE_SLOPE
from ..parameter_checks import require_above_zero, require_not_below_zero
from .law import PenetrationLaw


@dataclass(frozen=True, slots=True)
class MeanPressureLaw(PenetrationLaw):
    """p = A e + B, the mean pressure normal to the base over the part of it that is in the snow.

    On an edged ski that part is e L/sin ϑ, so the force normal to the base is N = (A e + B) e L/sin ϑ. Its component
    along the snow normal, N cos ϑ = (A e + B) e L/tan ϑ, is the pressure times the contact area projected on the snow;
    so it is computed for every tool. Its other component, N sin ϑ, is `side_force`.

    Attributes
    ----------
    pressure_slope
        A (N/m³), > 0.
    pressure_offset
        B (N/m²), ≥ 0.

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw

    Notes
    -----
    Range: A = 0.0036-0.034 N/mm³ and B = 0.058-0.35 N/mm² on three snows; no range of edge angles is known to us.
    Source: Federolf and others (2006), in the form of Mössner and others (2013).
    The force mixes compaction and shearing: normal to the base it equals H_V V cos ϑ + S_f e L sin ϑ with
    A = H_V cos²ϑ/2 and B = S_f sin²ϑ, so that A and B belong to the edge angle of their measurement.
    The pressure at zero depth is B, not 0; the force is 0 all the same as long as the edge is inclined, because the
    area is. Flat, the formula with sin ϑ is singular: the whole base touches at once, and the force starts at B L W.
    Deeper than the upper edge of the base, e > W sin ϑ, the whole base is taken as loaded (modelling assumption).

    References
    ----------
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    A race piste, A = 0.034 N/mm³ and B = 0.35 N/mm², 10 mm deep at 45°: 0.69 N/mm² on 2,000 mm² of projected area.

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = MeanPressureLaw(pressure_slope=0.034e9, pressure_offset=0.35e6)
    >>> round(float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, math.radians(45))), 6)
    1380.0
    """

    pressure_slope: float
    pressure_offset: float
    edge_angle_range: ClassVar[MeasuredRange | None] = None

    def __post_init__(self) -> None:
        require_above_zero(self, pressure_slope=self.pressure_slope)
        require_not_below_zero(self, pressure_offset=self.pressure_offset)
        PRESSURE_SLOPE.warn_outside(self.pressure_slope, "MeanPressureLaw", stacklevel=3)
        PRESSURE_OFFSET.warn_outside(self.pressure_offset, "MeanPressureLaw", stacklevel=3)

    @property
    def exceptions(self) -> Mapping[str, str]:
        """See `PenetrationLaw.exceptions`."""
        if self.pressure_offset == 0:
            return {}
        return {"zero at zero depth": "a flat base feels B L W the moment it touches the snow"}

    def base_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Force N (N) normal to the base of a ski piece, ϑ < π/2: `reaction_force` over cos ϑ."""
        return self.reaction_force(tool, penetration_depth, edge_angle) / np.cos(edge_angle)

    def side_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Component (N) of `base_force` along the snow surface, across the edge, ϑ < π/2."""
        return self.reaction_force(tool, penetration_depth, edge_angle) * np.tan(edge_angle)

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return (self.pressure_slope * depth + self.pressure_offset) * tool.contact_area(depth, angle)
