"""Force from a stress that is bilinear in depth and edge angle: the general form that the paper fits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...geometry import Tool
from ..parameter_checks import require_above_zero, require_finite
from .law import PenetrationLaw


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

    hardness: float
    a0: float
    a1: float
    b0: float
    b1: float

    def __post_init__(self) -> None:
        require_above_zero(self, hardness=self.hardness)
        require_finite(self, a0=self.a0, a1=self.a1, b0=self.b0, b1=self.b1)

    @property
    def exceptions(self) -> Mapping[str, str]:
        """See `PenetrationLaw.exceptions`: with a > 0 the law has the threshold of the area law."""
        if self.a0 <= 0:
            return {}
        return {"zero at zero depth": "with a > 0 a flat base feels H a L W the moment it touches the snow"}

    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        a = self._at("a", self.a0, self.a1, angle)
        b = self._at("b", self.b0, self.b1, angle)
        return self.hardness * (a * tool.contact_area(depth, angle) + b * tool.displaced_volume(depth, angle))

    def _at(self, name: str, at_zero: float, slope: float, angle: FloatArray) -> FloatArray:
        value: FloatArray = at_zero + slope * angle
        if np.any(value < 0):
            worst = float(angle.flat[int(np.argmin(value))])
            raise ParameterError(
                "BilinearLaw: {name} = {at_zero:g} + {slope:g} ϑ is negative at ϑ = {worst:.4g} rad: the snow would "
                "pull. Use the law where {name} ≥ 0, or coefficients that were fitted with that bound",
                code="out_of_range",
                name=name,
                at_zero=at_zero,
                slope=slope,
                worst=worst,
            )
        return value
