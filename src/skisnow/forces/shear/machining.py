"""Shear as machining of the snow by the edge: by the cutting angle, or by the formula for ice."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...snow import MeasuredRange
from ...snow.published.lieu_mote_1985 import SNOW_OVER_ICE
from ..parameter_checks import (
    ABOVE_ZERO,
    FAILURE_SHEAR_STRESS,
    ICE_CUTTING_DEPTH,
    ICE_CUTTING_EDGE_ANGLE,
    NOT_BELOW_ZERO,
    RIGHT_ANGLE,
    edge_angles,
)
from .law import ShearLaw


@dataclass(frozen=True, slots=True)
class MachiningShear(ShearLaw):
    """F_t = 2 S cot((ϑ - β)/2) e L, β = arctan μ_t (Eqn 10); thrust S (cot²((ϑ - β)/2) - 1) e L.

    Attributes
    ----------
    dynamic_shear_strength
        S (N/m²): the strength of snow that is being cut, not the S_f at which failure starts.
    transverse_friction
        μ_t ≥ 0, the friction across the ski.
    least_shear_plane
        Lower limit (rad), 0 to π/4, of (ϑ - β)/2 (modelling assumption, for a contact in which edges may become flat);
        0: the theory without a limit.

    See Also
    --------
    skisnow.forces.shear.AngleShear
    skisnow.forces.shear.IceCuttingShear

    Notes
    -----
    Range: none was measured on groomed snow; an upright edge without friction fails at 2 S, and the warning compares
    that with the range of S_f. Source: Merchant's theory as in Mössner and others (2013), who did not find its
    dependence on ϑ. At and below ϑ = β there is no shear plane: NaN.

    References
    ----------
    Mössner, Innerhofer, Schindelwig, Kaps, Schretter and Nachbauer (2013), "Measurement of mechanical properties of
    snow for simulation of skiing", J. Glaciol.

    Examples
    --------
    S = 0.05 N/mm² at 90° without friction: 0.1 N/mm², no thrust. On 1 m of edge, 5 mm deep: 500 N.

    >>> import math
    >>> law = MachiningShear(dynamic_shear_strength=0.05e6, transverse_friction=0.0)
    >>> round(float(law.failure_force(0.005, 1.0, math.pi / 2)), 9)
    500.0
    """

    dynamic_shear_strength: Annotated[float, ABOVE_ZERO]
    transverse_friction: Annotated[float, NOT_BELOW_ZERO]
    least_shear_plane: float = field(default=0.0, kw_only=True)

    def _check_further(self) -> None:
        """Reject a least_shear_plane outside 0 to π/4, and warn of a strength outside the measured range."""
        if not 0.0 <= self.least_shear_plane <= RIGHT_ANGLE / 2.0:
            raise ParameterError(
                "MachiningShear: least_shear_plane is {least_shear_plane!r} rad; it must lie between 0 and π/4"
            ).tag("out_of_range", least_shear_plane=self.least_shear_plane)
        FAILURE_SHEAR_STRESS.warn_outside(2.0 * self.dynamic_shear_strength, "MachiningShear, 2 S", stacklevel=4)

    def thrust_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        """See `ShearLaw.thrust_force`: S (cot²φ - 1) e L, φ = (ϑ - β)/2; with F_t it makes one force."""
        angle = self._cut_angle(edge_angles(edge_angle))
        thrust = cutting_thrust(self.dynamic_shear_strength, angle, transverse_friction=self.transverse_friction)
        return thrust * np.maximum(np.asarray(edge_depth, float), 0.0) * np.asarray(edge_length, float)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Cutting stress of Eqn 10 (N/m²), by the edge angle (rad) only."""
        cut = self._cut_angle(angle)
        return cutting_stress(self.dynamic_shear_strength, cut, transverse_friction=self.transverse_friction)

    def _cut_angle(self, angle: FloatArray) -> FloatArray:
        """Edge angles (rad), raised where the shear plane would be below `least_shear_plane`."""
        if self.least_shear_plane == 0.0:
            return angle
        return np.maximum(angle, np.arctan(self.transverse_friction) + 2.0 * self.least_shear_plane)


@dataclass(frozen=True, slots=True)
class IceCuttingShear(ShearLaw):
    """F_t = c Σ k_ij e^i γ^j L with i ≥ 1, j ≥ 0, γ = ϑ - π/2 the rake angle; c = 0.02 for snow.

    Attributes
    ----------
    ice_coefficients
        k_ij in SI and rad: rows by the power of the depth from 1, columns by that of the rake angle from 0, so that
        Σ k_ij e^i γ^j is the tangential force per length of edge (N/m) on ice. They are the user's.
    snow_over_ice
        c, force on snow over force on ice; Lieu and Mote proposed 0.02.

    See Also
    --------
    skisnow.forces.shear.MachiningShear

    Notes
    -----
    Range: cuts in ice less than 1 mm deep, rake angles -60° to -15°, that is edge angles 30-75°; 0.01-1 m/s, the force
    about independent of the speed. Source: Lieu and Mote (1984, 1985). Their empirical formula is not reproduced: we
    have not seen it printed. The polynomial is ours (modelling assumption); it starts with the first power of the
    depth because an
    edge that is not in the snow feels no force. They found the force about normal to the cutting face, so the thrust is
    F_t cot ϑ, as in machining without friction.

    References
    ----------
    Lieu and Mote (1984), "Experiments in the machining of ice at negative rake angles", J. Glaciol. 30(104), 77-81.

    Examples
    --------
    10 N/mm² of ice at any angle: on snow 0.2 N/mm². On 1 m of edge, 0.5 mm deep: 100 N.

    >>> import math
    >>> law = IceCuttingShear(ice_coefficients=((10e6,),))
    >>> round(float(law.failure_force(0.5e-3, 1.0, math.radians(45))), 9)
    100.0
    """

    ice_coefficients: tuple[tuple[float, ...], ...]
    snow_over_ice: Annotated[float, ABOVE_ZERO] = field(default=SNOW_OVER_ICE, kw_only=True)
    edge_depth_range: ClassVar[MeasuredRange | None] = ICE_CUTTING_DEPTH
    edge_angle_range: ClassVar[MeasuredRange | None] = ICE_CUTTING_EDGE_ANGLE

    def _check_further(self) -> None:
        """Reject coefficients that are not finite, or whose rows are empty or of different lengths."""
        rows = self.ice_coefficients
        if len({len(row) for row in rows}) != 1 or not rows[0] or not np.all(np.isfinite(rows)):
            raise ParameterError(
                "IceCuttingShear: ice_coefficients are {rows!r}; they must be rows of finite numbers, equally long, "
                "a row for each power of the depth from 1, a column for each power of the rake angle from 0"
            ).tag("not_a_number", rows=rows)

    def thrust_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        """See `ShearLaw.thrust_force`: F_t cot ϑ, ϑ > 0, the force being normal to the cutting face."""
        force = (
            self._checked_stress(edge_depth, edge_angle) * np.maximum(edge_depth, 0.0) * np.asarray(edge_length, float)
        )
        with np.errstate(divide="ignore", invalid="ignore"):  # without bound at 0: no face to cut with
            return force / np.tan(edge_angle)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:
        """Stress (N/m²) by depth (m) and edge angle (rad); rejects a negative one."""
        stress: FloatArray = self.snow_over_ice * np.polynomial.polynomial.polyval2d(
            depth, angle - RIGHT_ANGLE, np.asarray(self.ice_coefficients, float)
        )
        if np.any(stress < 0):
            worst = int(np.argmin(stress))
            raise ParameterError(
                "IceCuttingShear: the coefficients give a negative force at {depth:.4g} m depth and an edge angle of "
                "{edge_angle:.4g} rad: use them where the ice was measured"
            ).tag("negative_force", depth=depth.flat[worst], edge_angle=angle.flat[worst])
        return stress


def cutting_stress(
    dynamic_shear_strength: npt.ArrayLike, edge_angle: npt.ArrayLike, *, transverse_friction: float
) -> FloatArray:
    """Tangential stress F_t/(L e) = 2 S cot((ϑ - β)/2), β = arctan μ_t (Eqn 10 of Mössner and others 2013).

    dynamic_shear_strength: S (N/m²).
    edge_angle: ϑ (rad), β < ϑ ≤ π/2. At and below β the theory has no shear plane: NaN.
    transverse_friction: μ_t ≥ 0, the dynamic friction transverse to the ski.

    Merchant's theory with the shear plane at φ = (ϑ - β)/2 to the snow surface. A vertical blade without friction has
    F_t/(L e) = 2 S. The paper did not find this dependence in the failure shear stress of groomed snow.

    >>> import math
    >>> round(float(cutting_stress(0.0172, math.pi / 2, transverse_friction=0.0)), 4)
    0.0344
    """
    S, half = np.asarray(dynamic_shear_strength, float), _shear_plane(edge_angle, transverse_friction)
    result: FloatArray = 2.0 * S / np.tan(half)
    return result


def cutting_thrust(
    dynamic_shear_strength: npt.ArrayLike, edge_angle: npt.ArrayLike, *, transverse_friction: float
) -> FloatArray:
    """Normal stress of the same cut, F_n/(L e) = S (cot²φ - 1), φ = (ϑ - β)/2, which the paper does not print (N/m²).

    >>> import math
    >>> round(float(cutting_thrust(1.0, math.pi / 2, transverse_friction=0.0)), 12)
    0.0
    """
    S, half = np.asarray(dynamic_shear_strength, float), _shear_plane(edge_angle, transverse_friction)
    result: FloatArray = S * (1.0 / np.tan(half) ** 2 - 1.0)
    return result


def _shear_plane(edge_angle: npt.ArrayLike, transverse_friction: float) -> FloatArray:
    """Angle φ = (ϑ - β)/2 (rad) of the shear plane to the snow surface; NaN where it is not above 0."""
    plane = (np.asarray(edge_angle, float) - np.arctan(transverse_friction)) / 2.0
    return np.where(plane > 0, plane, np.nan)
