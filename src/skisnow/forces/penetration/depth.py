"""Force by penetration depth alone: a rival that the measurements reject."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ..parameter_checks import require_above_zero
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

    hardness_by_depth: float

    def __post_init__(self) -> None:
        require_above_zero(self, hardness_by_depth=self.hardness_by_depth)

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        return self.hardness_by_depth * depth
