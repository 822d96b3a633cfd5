"""Laws for one place on the snow: elastic, hypoplastic, which keeps most of the groove, and by a mean pressure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Final

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...snow.published.moessner_2013 import ANGLE_TERM
from ..parameter_checks import ABOVE_ZERO, NOT_BELOW_ZERO, PRESSURE_OFFSET, PRESSURE_SLOPE, SNOW_HARDNESS
from .law import DeepeningPoint, PointLaw


@dataclass(frozen=True, slots=True)
class ElasticPoint(PointLaw):
    """p = H_V ε for ε > 0, else 0 (Eqn 12), loading and unloading on the same line.

    Attributes
    ----------
    snow_hardness
        H_V (N/m³).

    See Also
    --------
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range: that of `VolumeLaw`. Source: Mössner and others (2013), who measured only loading. No groove is left and no
    energy is lost: snow does not behave so, but most simulations of skiing do.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    0.2 N/mm³, 5 mm deep: 1 N/mm², and ½·0.2·5² = 2.5 N/mm = 2,500 J/m².

    >>> snow = ElasticPoint(snow_hardness=0.2e9)
    >>> float(snow.stress(0.005, 0.008)), float(snow.stored_energy(0.005, 0.008))
    (1000000.0, 2500.0)
    """

    snow_hardness: Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Stress H_V ε (N/m²) at depth ε (m), 0 above the snow; the maximum depth has no effect."""
        depth, _ = np.broadcast_arrays(np.asarray(depth, float), np.asarray(deepest, float))
        result: FloatArray = self.snow_hardness * np.maximum(depth, 0.0)
        return result

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """Depth (m) of the groove that is left: 0."""
        return np.zeros(np.shape(deepest))

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that comes back when the place is unloaded from depth ε: ½ H_V ε²."""
        return self.stress(depth, deepest) ** 2 / (2.0 * self.snow_hardness)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that is lost in a groove: 0."""
        return np.zeros(np.shape(deepest))


class _Hypoplastic(PointLaw):
    """Base of laws with loading along a multiple of H_V, unloading and reloading along the steeper k_u."""

    __slots__ = ()
    snow_hardness: float
    unloading_ratio: float
    _factor: ClassVar[float] = 1.0
    """Growth of the stress of virgin snow with depth, over H_V."""

    def _check_further(self) -> None:
        """Reject an unloading_ratio below 1, which would create energy."""
        if not self.unloading_ratio >= 1.0:
            raise ParameterError(
                "{kind}: unloading_ratio k_u/H_V is {unloading_ratio!r}; it must be at least 1 (1 is elastic, math.inf "
                "rigid-plastic): unloading softer than loading would give energy away"
            ).tag("out_of_range", kind=type(self).__name__, unloading_ratio=self.unloading_ratio)

    @property
    def _loading_stiffness(self) -> float:
        """Increase of the pressure by depth on first loading (N/m³)."""
        return self._factor * self.snow_hardness

    @property
    def _kept(self) -> float:
        """Share 1 - H_V/k_u of depth and work that stays in the snow."""
        return 1.0 - 1.0 / self.unloading_ratio

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Stress p (N/m², ≥ 0) at depth ε (m) of a place that has been at ε_max (m) before; unloading along k_u."""
        depth = np.asarray(depth, float)
        reached = self.deepest_after(depth, deepest)
        risen = reached - depth
        # inf times 0 has no value; at the deepest depth itself nothing has been released
        released = np.multiply(self.unloading_ratio, risen, out=np.zeros(risen.shape), where=risen != 0)
        result: FloatArray = self._loading_stiffness * np.maximum(reached - released, 0.0)
        return result

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """Depth ε_res (m) of the groove that is left when the place is unloaded: ε_max (1 - H_V/k_u)."""
        return np.asarray(deepest, float) * self._kept

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that comes back when the place is unloaded from depth ε: p²/(2 k_u)."""
        return self.stress(depth, deepest) ** 2 / (2.0 * self.unloading_ratio * self._loading_stiffness)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that the groove of depth ε_max has cost: ½ H_V ε_max² (1 - H_V/k_u)."""
        return 0.5 * self._loading_stiffness * np.asarray(deepest, float) ** 2 * self._kept


@dataclass(frozen=True, slots=True)
class HypoplasticPoint(_Hypoplastic):
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

    snow_hardness: Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]
    unloading_ratio: float


@dataclass(frozen=True, slots=True)
class VolumeWithAnglePoint(_Hypoplastic):
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

    snow_hardness: Annotated[float, ABOVE_ZERO, SNOW_HARDNESS]
    unloading_ratio: float
    _factor: ClassVar[float] = ANGLE_TERM[0]

    def stress_and_energy(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray) -> FloatArray:
        """Stress (N/m²) and energy per area (J/m²), (2, n); both grow linearly with the edge angle (rad)."""
        b0, b1 = ANGLE_TERM
        return (1.0 + b1 / b0 * edge_angle) * PointLaw.stress_and_energy(self, depth, deepest, edge_angle)


RAMP_DEPTH: Final = 0.5e-3
"""Depth (m) over which B comes in (modelling assumption: not measured; the law of the paper, all of it at once, is
its limit 0)."""


@dataclass(frozen=True, slots=True)
class MeanPressurePoint(DeepeningPoint):
    """p = 2 A ε + B min(1, ε/ε_B), of a force along the base's normal; unloading along a steeper line.

    * Virgin loading, ε ≥ ε_max: p = q(ε) = 2 A ε + B min(1, ε/ε_B), and ε_max becomes ε.
    * Below, ε < ε_max: p = max(0, q(ε_max) - k_u (ε_max - ε)), k_u = unloading_ratio · (2 A + B/ε_B).

    The force on a wedge of depth e is the sum of q over its width: the mean pressure times area, (A e + B) e L/tan ϑ
    along the snow normal, is the integral of 2 A ε + B. Its part along the surface, tan ϑ times as much, is the maximum
    side force of an edge: the law needs no shear strength (S_f = 0).

    Attributes
    ----------
    pressure_slope, pressure_offset
        A (N/m³), > 0; B (N/m²), ≥ 0: as `MeanPressureLaw`'s.
    unloading_ratio
        Steepness of unloading over the steepest of loading, ≥ 1 and finite. Not published, so it has no default.
    ramp_depth
        ε_B (m), > 0: at the surface itself the law would jump to B.

    See Also
    --------
    skisnow.forces.penetration.MeanPressureLaw
    skisnow.forces.penetration.HypoplasticPoint

    Notes
    -----
    Range, source: as `MeanPressureLaw`; ramp and unloading are ours. On a wedge the ramp takes B ε_B/(2 e) off the mean
    pressure. That the part across is a most and no force that always acts is ours too: a base that is pushed along the
    surface at its own depth does no work on the snow, and would be given energy without end.

    References
    ----------
    * Federolf and others (2006), "Deformation of snow during a carved ski turn", Cold Reg. Sci. Technol. 46, 69-77,
      doi 10.1016/j.coldregions.2006.06.006.
    * Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
      snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    A race piste, A = 0.034 N/mm³ and B = 0.35 N/mm²: 10 mm deep 0.68 + 0.35 N/mm².

    >>> snow = MeanPressurePoint(pressure_slope=0.034e9, pressure_offset=0.35e6, unloading_ratio=10.0)
    >>> [round(float(p)) for p in snow.stress([0.00025, 0.0005, 0.010], 0.0)]
    [192000, 384000, 1030000]
    """

    pressure_slope: Annotated[float, ABOVE_ZERO, PRESSURE_SLOPE]
    pressure_offset: Annotated[float, NOT_BELOW_ZERO, PRESSURE_OFFSET]
    unloading_ratio: float
    ramp_depth: Annotated[float, ABOVE_ZERO] = RAMP_DEPTH
    along_base_normal: ClassVar[bool] = True

    @property
    def bends(self) -> tuple[float, ...]:
        """Depth (m) above 0 at which the stress of first loading bends: where the ramp ends."""
        return (self.ramp_depth,)

    def _loading(self, deepest: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pressure (N/m²), its integral over depth (N/m) and unloading stiffness (N/m³) at the largest depth (m)."""
        deepest = np.asarray(deepest, float)
        ramp = np.minimum(deepest, self.ramp_depth)
        loaded = 2.0 * self.pressure_slope * deepest + self.pressure_offset * np.minimum(1.0, deepest / self.ramp_depth)
        by_offset = self.pressure_offset * (deepest - ramp + 0.5 * ramp**2 / self.ramp_depth)
        unloading = self.unloading_ratio * (2.0 * self.pressure_slope + self.pressure_offset / self.ramp_depth)
        return loaded, self.pressure_slope * deepest**2 + by_offset, np.asarray(unloading)
