"""Hypoplastic snow at one place: it keeps most of the groove."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..parameter_checks import SNOW_HARDNESS, require_above_zero
from .law import PointLaw


@dataclass(frozen=True, slots=True)
class HypoplasticPoint(PointLaw):
    """Loading along H_V, unloading and reloading along the steeper k_u.

    * Virgin loading, ε ≥ ε_max: p = H_V ε, and ε_max becomes ε.
    * Below, ε < ε_max: p = max(0, H_V ε_max - k_u (ε_max - ε)), k_u ≥ H_V.

    Groove ε_max (1 - H_V/k_u); energy lost per area ½ H_V ε_max² (1 - H_V/k_u); energy stored per area p²/(2 k_u).

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).
    unloading_ratio
        k_u/H_V ≥ 1: 1 is elastic snow, `math.inf` rigid-plastic snow. It was measured but not published, so it has no
        default.

    See Also
    --------
    skisnow.forces.penetration.ElasticPoint
    skisnow.forces.penetration.VolumeLaw

    Notes
    -----
    Range: that of `VolumeLaw` for H_V; none is known for k_u/H_V. Source: Mössner and others (2013, Scand. J. Med. Sci.
    Sports, doi 10.1111/sms.12035) for the kind of law; the energies are exact.

    References
    ----------
    Mössner and others (2013), "Modeling the ski-snow contact in skiing turns using a hypoplastic vs an elastic
    force-penetration relation", Scand. J. Med. Sci. Sports, doi 10.1111/sms.12035.

    Examples
    --------
    0.2 N/mm³ pressed to 10 mm, then let go with k_u = 2 N/mm³: 2 N/mm² fall to 1 N/mm² in half a millimetre and to 0 in
    one; 9 mm of groove are left, and ½·0.2·10²·0.9 = 9 N/mm = 9,000 J/m² are lost.

    >>> snow = HypoplasticPoint(snow_hardness=0.2e9, unloading_ratio=10.0)
    >>> [round(float(p), 3) for p in snow.stress([0.010, 0.0095, 0.009, 0.005], 0.010)]
    [2000000.0, 1000000.0, 0.0, 0.0]
    >>> round(float(snow.residual_depth(0.010)), 6), round(float(snow.lost_energy(0.010)), 6)
    (0.009, 9000.0)
    """

    snow_hardness: float
    unloading_ratio: float

    def __post_init__(self) -> None:
        require_above_zero(self, snow_hardness=self.snow_hardness)
        if not self.unloading_ratio >= 1.0:
            raise ParameterError(
                "HypoplasticPoint: unloading_ratio k_u/H_V is {unloading_ratio!r}; it must be at least 1 (1 is "
                "elastic, math.inf rigid-plastic): unloading softer than loading would give energy away"
            ).tag("out_of_range", unloading_ratio=self.unloading_ratio)
        SNOW_HARDNESS.warn_outside(self.snow_hardness, "HypoplasticPoint", stacklevel=3)

    @property
    def exceptions(self) -> Mapping[str, str]:
        """Shared checks of physics that this law fails, each with the reason."""
        if np.isfinite(self.unloading_ratio):
            return {}
        return {"continuous in depth": "rigid-plastic snow lets go at once when the depth shrinks"}

    @property
    def _kept(self) -> float:
        """Share 1 - H_V/k_u of depth and work that stays in the snow."""
        return 1.0 - 1.0 / self.unloading_ratio

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stress`."""
        depth = np.asarray(depth, float)
        reached = self.deepest_after(depth, deepest)
        risen = reached - depth
        # inf times 0 has no value; at the deepest depth itself nothing has been released
        released = np.multiply(self.unloading_ratio, risen, out=np.zeros(risen.shape), where=risen != 0)
        result: FloatArray = self.snow_hardness * np.maximum(reached - released, 0.0)
        return result

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.residual_depth`: ε_max (1 - H_V/k_u)."""
        return np.asarray(deepest, float) * self._kept

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stored_energy`: p²/(2 k_u)."""
        return self.stress(depth, deepest) ** 2 / (2.0 * self.unloading_ratio * self.snow_hardness)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.lost_energy`: ½ H_V ε_max² (1 - H_V/k_u)."""
        return 0.5 * self.snow_hardness * np.asarray(deepest, float) ** 2 * self._kept
