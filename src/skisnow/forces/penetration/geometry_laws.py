"""Penetration forces by depth, area or number of elements instead of the volume."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ...snow import MeasuredRange
from ..parameter_checks import (
    ABOVE_ZERO,
    NOT_BELOW_ZERO,
    PRESSURE_OFFSET,
    PRESSURE_SLOPE,
    SNOW_HARDNESS,
    edge_angles,
)
from .law import PenetrationLaw


@dataclass(frozen=True, slots=True)
class DepthLaw(PenetrationLaw):
    """F_n = H_e e, with the hardness by depth of Eqn 1.

    Attributes
    ----------
    hardness_by_depth
        H_e (N/m), for one tool at one edge angle: a spring does not depend on the area.

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw
    skisnow.forces.penetration.AreaLaw

    Notes
    -----
    Range: edge angles 0-60°; no range of H_e was published.
    Source: Mössner and others (2013), rejected there: rmse 207 N (140 N with every coefficient free).

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    40 N/mm, 10 mm deep.

    >>> from skisnow.geometry import SkiPiece
    >>> law = DepthLaw(hardness_by_depth=40e3)
    >>> float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, 0.0))
    400.0
    """

    hardness_by_depth: Annotated[float, ABOVE_ZERO]

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return self.hardness_by_depth * depth


@dataclass(frozen=True, slots=True)
class AreaLaw(PenetrationLaw):
    """F_n = H_A A, with the hardness by area of Eqn 1: a constant stress, as of a perfectly plastic solid.

    Attributes
    ----------
    hardness_by_area
        H_A (N/m²).

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw
    skisnow.forces.penetration.DepthLaw

    Notes
    -----
    Range: edge angles 0-60°; no range of H_A was published.
    Source: Mössner and others (2013), rejected there: rmse 75.2 N (58.4 N with every coefficient free).
    It cannot describe a flat base: that would meet H_A L W at any depth, and none at all until it touches.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    200 mm of ski at 45°, 10 mm deep: A = 2,000 mm², at 0.2 N/mm².

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = AreaLaw(hardness_by_area=0.2e6)
    >>> round(float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, math.radians(45))), 9)
    400.0
    """

    hardness_by_area: Annotated[float, ABOVE_ZERO]

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.hardness_by_area * tool.contact_area(depth, angle)


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

    pressure_slope: Annotated[float, ABOVE_ZERO, PRESSURE_SLOPE]
    pressure_offset: Annotated[float, NOT_BELOW_ZERO, PRESSURE_OFFSET]
    edge_angle_range: ClassVar[MeasuredRange | None] = None

    def base_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Force N (N) normal to the base of a ski piece, ϑ < π/2: `reaction_force` over cos ϑ."""
        return self.reaction_force(tool, penetration_depth, edge_angle) / np.cos(edge_angle)

    def side_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Component (N) of `base_force` along the snow surface, across the edge, ϑ < π/2."""
        return self.reaction_force(tool, penetration_depth, edge_angle) * np.tan(edge_angle)

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return (self.pressure_slope * depth + self.pressure_offset) * tool.contact_area(depth, angle)


@dataclass(frozen=True, slots=True)
class ElementCountLaw(PenetrationLaw):
    """F_n = N f, with N the elements of the microstructure that resist and f the force of each.

    Here N = n V: the elements that were in the snow that the tool displaces, n of them in a unit of volume (modelling
    assumption).

    Attributes
    ----------
    elements_per_volume
        n (1/m³).
    force_per_element
        f (N).

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw

    Notes
    -----
    With n f = H_V this is the volume law: so Mössner and others (2013) argue in their discussion that the count of
    elements supports a force proportional to the volume. Only the product n f is identifiable from a penetration test.
    Range: that of `VolumeLaw` for n f. Source: Johnson and Schneebeli (1999), as quoted in the paper of 2013. Their own
    count is of the elements in contact with the tip of a penetrometer at one time.

    References
    ----------
    * Johnson and Schneebeli (1999), "Characterizing the microstructural and micromechanical properties of snow", Cold
      Reg. Sci. Technol. 30, 91-100, doi 10.1016/S0165-232X(99)00013-0.
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    Two elements in a mm³ of 0.02 N each make H_V = 0.04 N/mm³. In 10,000 mm³ there are 20,000 of them: 400 N.

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = ElementCountLaw(elements_per_volume=2e9, force_per_element=0.02)
    >>> tool = SkiPiece(length=0.2, width=0.062)
    >>> round(float(law.element_count(tool, 0.010, math.radians(45))), 6)
    20000.0
    >>> round(float(law.reaction_force(tool, 0.010, math.radians(45))), 9)
    400.0
    """

    elements_per_volume: Annotated[float, ABOVE_ZERO]
    force_per_element: Annotated[float, ABOVE_ZERO]

    def _check_further(self) -> None:
        """Warn of a hardness outside the measured range."""
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "ElementCountLaw", stacklevel=4)

    @property
    def snow_hardness(self) -> float:
        """H_V = n f (N/m³) of the volume law that gives the same force."""
        return self.elements_per_volume * self.force_per_element

    def element_count(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """N, the elements in the displaced volume, at depths of at least 0."""
        return self.elements_per_volume * tool.displaced_volume(penetration_depth, edge_angles(edge_angle))

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.element_count(tool, depth, angle) * self.force_per_element
