"""Cutting after machining theory, with the thrust that the paper does not print."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..cutting import cutting_stress, cutting_thrust
from ..measured_ranges import FAILURE_SHEAR_STRESS
from ..parameter_checks import RIGHT_ANGLE, edge_angles, require_above_zero, require_not_below_zero
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

    dynamic_shear_strength: float
    transverse_friction: float
    least_shear_plane: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        require_above_zero(self, dynamic_shear_strength=self.dynamic_shear_strength)
        require_not_below_zero(self, transverse_friction=self.transverse_friction)
        if not 0.0 <= self.least_shear_plane <= RIGHT_ANGLE / 2.0:
            raise ParameterError(
                "MachiningShear: least_shear_plane is {least_shear_plane!r} rad; it must lie between 0 and π/4",
                code="out_of_range",
                least_shear_plane=self.least_shear_plane,
            )
        FAILURE_SHEAR_STRESS.warn_outside(2.0 * self.dynamic_shear_strength, "MachiningShear, 2 S", stacklevel=3)

    @property
    def exceptions(self) -> Mapping[str, str]:
        """See `ShearLaw.exceptions`."""
        return {
            "finite at every edge angle": "the force grows without bound as ϑ falls to β; below β there is no force"
        }

    def thrust_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        """See `ShearLaw.thrust_force`: S (cot²φ - 1) e L, φ = (ϑ - β)/2; with F_t it makes one force."""
        angle = self._cut_angle(edge_angles(edge_angle))
        thrust = cutting_thrust(self.dynamic_shear_strength, angle, transverse_friction=self.transverse_friction)
        return thrust * np.maximum(np.asarray(edge_depth, float), 0.0) * np.asarray(edge_length, float)

    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:  # noqa: ARG002
        cut = self._cut_angle(angle)
        return cutting_stress(self.dynamic_shear_strength, cut, transverse_friction=self.transverse_friction)

    def _cut_angle(self, angle: FloatArray) -> FloatArray:
        if self.least_shear_plane == 0.0:
            return angle
        return np.maximum(angle, np.arctan(self.transverse_friction) + 2.0 * self.least_shear_plane)
