"""Penetration forces in proportion to the volume of the indentation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...geometry import Tool
from ...snow.published.moessner_2013 import ANGLE_TERM
from ..parameter_checks import ABOVE_ZERO, FINITE, SNOW_HARDNESS
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

    snow_hardness: Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        return self.snow_hardness * tool.displaced_volume(depth, angle)


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

    snow_hardness: Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        b0, b1 = ANGLE_TERM
        return (b0 + b1 * angle) * self.snow_hardness * tool.displaced_volume(depth, angle)


@dataclass(frozen=True, slots=True)
class BilinearLaw(PenetrationLaw):
    """F_n = H (a(ϑ) A + b(ϑ) V), from the stress p = H (a(ϑ) + b(ϑ) ε) (Eqns 4 and 5).

    a(ϑ) = a₀ + a₁ ϑ and b(ϑ) = b₀ + b₁ ϑ, ϑ in rad. Both must be ≥ 0 at every edge angle of the evaluation.

    Attributes
    ----------
    hardness
        H, any of the three hardnesses of Eqn 1 in SI.
    a0, a1, b0, b1
        Coefficients in SI: H a is a stress (N/m²), H b a stress per depth (N/m³), a₁ and b₁ per rad. With H = H_V, a is
        in m and b a pure number.

    See Also
    --------
    skisnow.forces.penetration.VolumeLaw
    skisnow.forces.penetration.AreaLaw

    Notes
    -----
    Range: edge angles 0-60°. Source: Mössner and others (2013), where the term in A is dropped as not needed.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    10 mm deep at 45°, A = 2,000 mm² and V = 10,000 mm³. With H = 0.04 N/mm³, a = 1 mm and b = 1:
    0.04 (1·2,000 + 10,000) = 480 N.

    >>> import math
    >>> from skisnow.geometry import SkiPiece
    >>> law = BilinearLaw(hardness=0.04e9, a0=1e-3, a1=0.0, b0=1.0, b1=0.0)
    >>> round(float(law.reaction_force(SkiPiece(length=0.2, width=0.062), 0.010, math.radians(45))), 9)
    480.0
    """

    hardness: Annotated[float, ABOVE_ZERO]
    a0: Annotated[float, FINITE]
    a1: Annotated[float, FINITE]
    b0: Annotated[float, FINITE]
    b1: Annotated[float, FINITE]

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        a = self._coefficient_at("a", self.a0, self.a1, angle)
        b = self._coefficient_at("b", self.b0, self.b1, angle)
        return self.hardness * (a * tool.contact_area(depth, angle) + b * tool.displaced_volume(depth, angle))

    def _coefficient_at(self, name: str, at_zero: float, slope: float, angle: FloatArray) -> FloatArray:
        """Coefficient at_zero + slope ϑ at edge angles (rad); rejects a negative one."""
        value: FloatArray = at_zero + slope * angle
        if np.any(value < 0):
            worst = float(angle.flat[int(np.argmin(value))])
            raise ParameterError(
                "BilinearLaw: {name} = {at_zero:g} + {slope:g} ϑ is negative at ϑ = {worst:.4g} rad: the snow would "
                "pull. Use the law where {name} ≥ 0, or coefficients that were fitted with that bound"
            ).tag("out_of_range", name=name, at_zero=at_zero, slope=slope, worst=worst)
        return value
