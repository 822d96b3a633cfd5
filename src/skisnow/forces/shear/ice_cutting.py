"""Forces of cutting ice, scaled to snow."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...snow import MeasuredRange
from ...snow.published.lieu_mote_1985 import SNOW_OVER_ICE
from ..measured_ranges import ICE_CUTTING_DEPTH, ICE_CUTTING_EDGE_ANGLE
from ..parameter_checks import RIGHT_ANGLE, require_above_zero
from .law import ShearLaw


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
    snow_over_ice: float = field(default=SNOW_OVER_ICE, kw_only=True)
    edge_depth_range: ClassVar[MeasuredRange | None] = ICE_CUTTING_DEPTH
    edge_angle_range: ClassVar[MeasuredRange | None] = ICE_CUTTING_EDGE_ANGLE

    def __post_init__(self) -> None:
        require_above_zero(self, snow_over_ice=self.snow_over_ice)
        rows = self.ice_coefficients
        if len({len(row) for row in rows}) != 1 or not rows[0] or not np.all(np.isfinite(rows)):
            raise ParameterError(
                "IceCuttingShear: ice_coefficients are {rows!r}; they must be rows of finite numbers, equally long, "
                "a row for each power of the depth from 1, a column for each power of the rake angle from 0",
                code="not_a_number",
                rows=rows,
            )

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
        stress: FloatArray = self.snow_over_ice * np.polynomial.polynomial.polyval2d(
            depth, angle - RIGHT_ANGLE, np.asarray(self.ice_coefficients, float)
        )
        if np.any(stress < 0):
            worst = int(np.argmin(stress))
            raise ParameterError(
                "IceCuttingShear: the coefficients give a negative force at {depth:.4g} m depth and an edge angle of "
                "{edge_angle:.4g} rad: use them where the ice was measured",
                code="negative_force",
                depth=depth.flat[worst],
                edge_angle=angle.flat[worst],
            )
        return stress
