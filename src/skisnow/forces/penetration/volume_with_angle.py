"""Force by the volume of snow displaced, a little larger at larger edge angles."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ...snow.published.moessner_2013 import ANGLE_TERM
from ..measured_ranges import SNOW_HARDNESS
from ..parameter_checks import require_above_zero
from .law import PenetrationLaw


@dataclass(frozen=True, slots=True)
class VolumeWithAngleLaw(PenetrationLaw):
    """F_n = (0.99 + 0.14 ϑ) H_V V, ϑ in rad (Eqn 11).

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw

    Notes
    -----
    Range: that of `VolumeLaw`. The factor is 0.99, 1.063, 1.100 and 1.137 at 0, 30, 45 and 60°.
    Source: Mössner and others (2013); rmse 53.8 N. The paper doubts that the term is real and proposes Eqn 12; its
    discussion prints Eqn 11 with 1 for 0.99.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    At 45° the factor is 0.99 + 0.14·0.7854 = 1.09996; of 400 N it makes 439.98 N.

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = VolumeWithAngleLaw(snow_hardness=0.04e9)
    >>> round(float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, math.radians(45))), 2)
    439.98
    """

    snow_hardness: float

    def __post_init__(self) -> None:
        require_above_zero(self, snow_hardness=self.snow_hardness)
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "VolumeWithAngleLaw", stacklevel=3)

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        b0, b1 = ANGLE_TERM
        return (b0 + b1 * angle) * self.snow_hardness * tool.displaced_volume(depth, angle)
