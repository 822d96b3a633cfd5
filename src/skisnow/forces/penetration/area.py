"""Force by contact area alone: a rival that the measurements reject."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ..parameter_checks import require_above_zero
from .law import PenetrationLaw


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

    hardness_by_area: float

    def __post_init__(self) -> None:
        require_above_zero(self, hardness_by_area=self.hardness_by_area)

    @property
    def exceptions(self) -> Mapping[str, str]:
        """See `PenetrationLaw.exceptions`."""
        return {"zero at zero depth": "a flat base feels H_A L W the moment it touches the snow"}

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.hardness_by_area * tool.contact_area(depth, angle)
