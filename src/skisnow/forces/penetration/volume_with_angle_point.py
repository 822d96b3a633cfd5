"""Snow at one place that is a little harder under a steeper base: the point form of Eqn 11."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...snow.published.moessner_2013 import ANGLE_TERM
from .hypoplastic_point import HypoplasticPoint
from .point_law import PointLaw


@dataclass(frozen=True, slots=True)
class VolumeWithAnglePoint(PointLaw):
    """p = (0.99 + 0.14 ϑ) times the stress of `HypoplasticPoint`, ϑ in rad.

    Over a base at one edge angle this is F_n = (0.99 + 0.14 ϑ) H_V V on virgin snow, which is `VolumeWithAngleLaw`.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).
    unloading_ratio
        k_u/H_V ≥ 1.

    See Also
    --------
    skisnow.forces.penetration.VolumeWithAngleLaw
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range, source: as `VolumeWithAngleLaw`; the unloading is ours, as in `HypoplasticPoint`. Only ``stress_and_energy``
    depends on the angle: the other methods are those of a flat base, with a factor of 0.99. The energy of grooves cut
    at 60° is 15 % above `lost_energy`.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    0.2 N/mm³ pressed to 10 mm: 1.98 N/mm² flat, 2.199911 N/mm² at 45°.

    >>> import numpy as np
    >>> snow = VolumeWithAnglePoint(snow_hardness=0.2e9, unloading_ratio=10.0)
    >>> round(float(snow.stress(0.010, 0.0)))
    1980000
    >>> round(float(snow.stress_and_energy(np.array([0.010]), np.array([0.010]), np.radians([45.0]))[0, 0]))
    2199911
    """

    snow_hardness: float
    unloading_ratio: float

    def __post_init__(self) -> None:
        HypoplasticPoint(self.snow_hardness, self.unloading_ratio)  # which checks both

    @property
    def _flat(self) -> HypoplasticPoint:
        return HypoplasticPoint(ANGLE_TERM[0] * self.snow_hardness, self.unloading_ratio)

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stress`; under a flat base."""
        return self._flat.stress(depth, deepest)

    def stress_and_energy(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray) -> FloatArray:
        """See `PointLaw.stress_and_energy`."""
        b0, b1 = ANGLE_TERM
        return (1.0 + b1 / b0 * edge_angle) * self._flat.stress_and_energy(depth, deepest, edge_angle)

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.residual_depth`."""
        return self._flat.residual_depth(deepest)

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.stored_energy`; under a flat base."""
        return self._flat.stored_energy(depth, deepest)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """See `PointLaw.lost_energy`; under a flat base."""
        return self._flat.lost_energy(deepest)
