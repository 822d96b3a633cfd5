"""The interface of every law for the force at which snow fails sideways, and its shear displacement."""

from __future__ import annotations

import abc
from typing import ClassVar, Final, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...snow import MeasuredRange
from ..parameter_checks import CheckedParameters, edge_angles


class ShearLaw(CheckedParameters, abc.ABC):
    """Force along the snow surface, across the edge, at which snow fails.

    A rival law is one frozen dataclass in a separate file, listed in ``LAWS``; it defines ``_stress``. The force acts
    against the side on which the edge presses; it is equal on both sides (modelling assumption).
    """

    __slots__ = ()
    edge_depth_range: ClassVar[MeasuredRange | None] = None
    edge_angle_range: ClassVar[MeasuredRange | None] = None
    """Measured range, if known; outside it, `RangeWarning`."""

    def failure_stress(self, edge_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Tangential force per length and depth of the edge, F_t/(L e) (N/m²).

        edge_depth: e (m), any shape; below 0 the edge is above the snow.
        edge_angle: ϑ (rad), 0 ≤ ϑ ≤ π/2, any shape that broadcasts with the depth.
        Raises ParameterError: an edge angle is outside 0 to π/2.
        Warns RangeWarning: a depth or an edge angle is outside the law's measured range.
        """
        return self._checked_stress(edge_depth, edge_angle)

    def failure_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        """Tangential force F_t (N, ≥ 0) at which the snow fails along a length L (m) of edge at depth e (m)."""
        depth = np.maximum(np.asarray(edge_depth, float), 0.0)
        return self._checked_stress(edge_depth, edge_angle) * depth * np.asarray(edge_length, float)

    def thrust_force(
        self, edge_depth: npt.ArrayLike, edge_length: npt.ArrayLike, edge_angle: npt.ArrayLike
    ) -> FloatArray:
        """Force (N) along the snow normal that comes with the tangential one, pushing the edge out; 0 if none does."""
        shape = np.broadcast_shapes(np.shape(edge_depth), np.shape(edge_length), edge_angles(edge_angle).shape)
        return np.zeros(shape)

    def stress_and_thrust(self, edge_depth: FloatArray, edge_angle: FloatArray) -> FloatArray:
        """F_t/(L e) and thrust/(L e) (N/m²), (2, n), for depths above 0. For loops: nothing is warned of."""
        thrust = self.thrust_force(edge_depth, np.ones_like(edge_depth), edge_angle) / edge_depth
        return np.stack([np.broadcast_to(self._stress(edge_depth, edge_angle), edge_depth.shape), thrust])

    def _checked_stress(self, edge_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """F_t/(L e) (N/m²) after checks of angle and measured ranges; depths below 0 count as 0."""
        angle = edge_angles(edge_angle)
        depth, angle = np.broadcast_arrays(np.maximum(np.asarray(edge_depth, float), 0.0), angle)
        for measured, value in ((self.edge_depth_range, depth), (self.edge_angle_range, angle)):
            if measured is not None:
                measured.warn_outside(value, type(self).__name__, stacklevel=3)
        return self._stress(depth, angle)

    @abc.abstractmethod
    def _stress(self, depth: FloatArray, angle: FloatArray) -> FloatArray:
        """F_t/(L e) (N/m²) for depths of at least 0 and angles of the same shape."""


SHEAR_DISPLACEMENT: Final = 0.02e-3
"""u_y (m) (modelling assumption: not measured). The law of the paper, all of S_f or nothing, is its limit 0.

With this one a circle at 80 % of the grip is half a percent wide, and a smaller one gains nothing:
docs/methods/side-force.md.
"""

RESIDUAL_RATIO: Final = 1.0
"""Strength after slip over that before it, r of 1 - (1 - r) min(slip/d, 1) (modelling assumption: not measured).

Mössner and others (2013) presume that snow that is being sheared is weaker than S_f. McClung (1977, J. Glaciol. 19(81))
found softening after the peak in direct shear of snow.
"""
SLIP_WEAKENING: Final = 1e-3
"""Slip d (m) over which it is reached, in proportion to the slip (modelling assumption)."""

Bearing: TypeAlias = Literal["whole-edge", "loaded-height"]
"""Height by which an edge holds against a motion inwards: all of its depth, or the part whose base bears, the square
root of the force over that of virgin snow (modelling assumption)."""
