"""Force by the volume of snow displaced: the law that Mössner and others (2013) propose."""

from __future__ import annotations

from dataclasses import dataclass

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ..measured_ranges import SNOW_HARDNESS
from ..parameter_checks import require_above_zero
from .law import PenetrationLaw


@dataclass(frozen=True, slots=True)
class VolumeLaw(PenetrationLaw):
    """F_n = H_V V (Eqn 12), the sum over the base of the stress p = H_V ε.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).

    See Also
    --------
    skisnow.forces.penetration.VolumeWithAngleLaw
    skisnow.forces.penetration.BilinearLaw
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range: 0.022-90 N/mm³ on groomed ski slopes, edge angles 0-60°, loads of 12-492 N on a piece of ski of 200 × 62 mm.
    Source: Mössner and others (2013); rmse 56.1 N over 236 experiments.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    200 mm of ski at 45°, 10 mm deep, displace 200·10²/2 = 10,000 mm³; at 0.04 N/mm³ that is 400 N.

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = VolumeLaw(snow_hardness=0.04e9)
    >>> round(float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, math.radians(45))), 9)
    400.0
    """

    snow_hardness: float

    def __post_init__(self) -> None:
        require_above_zero(self, snow_hardness=self.snow_hardness)
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "VolumeLaw", stacklevel=3)

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.snow_hardness * tool.displaced_volume(depth, angle)
