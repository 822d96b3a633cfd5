"""Force as a number of broken elements: the law of Johnson and Schneebeli (1999)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ..measured_ranges import SNOW_HARDNESS
from ..parameter_checks import edge_angles, require_above_zero
from .law import PenetrationLaw


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

    elements_per_volume: float
    force_per_element: float

    def __post_init__(self) -> None:
        require_above_zero(self, elements_per_volume=self.elements_per_volume, force_per_element=self.force_per_element)
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "ElementCountLaw", stacklevel=3)

    @property
    def snow_hardness(self) -> float:
        """H_V = n f (N/m³) of the volume law that gives the same force."""
        return self.elements_per_volume * self.force_per_element

    def element_count(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """N, the elements in the displaced volume, at depths of at least 0."""
        return self.elements_per_volume * tool.displaced_volume(penetration_depth, edge_angles(edge_angle))

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.element_count(tool, depth, angle) * self.force_per_element
