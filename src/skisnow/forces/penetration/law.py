"""The interfaces of every law for the force of a pressed tool, and for one place on the snow."""

from __future__ import annotations

import abc
from typing import ClassVar, Final

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ...geometry import Tool
from ...snow import MeasuredRange
from ..parameter_checks import PENETRATION_EDGE_ANGLE, CheckedParameters, edge_angles

DAMPING: Final = 0.0
"""c of p = H_V ε + c ε̇ (N s/m³) (modelling assumption, not in the paper's law)."""
DELAYED_SHARE: Final = 0.0
"""H_V/H₂: the delayed depth under a load that stays, over the depth at once (modelling assumption: none)."""
RETARDATION_TIME: Final = 0.1
"""c₂/H₂ (s), in which 1 - 1/e of the delayed depth has come (modelling assumption; only for a delayed depth)."""
DELAYED_SPACING: Final = 1e-3
"""Spacing of places across a groove that keep their delayed depth (m) (modelling assumption, see tests of convergence).
"""


class PenetrationLaw(CheckedParameters, abc.ABC):
    """Force of snow against a tool pressed into it, normal to the snow surface.

    A rival law is one frozen dataclass in a separate file, listed in ``LAWS``; it defines ``_force_in_contact``.
    """

    __slots__ = ()
    edge_angle_range: ClassVar[MeasuredRange | None] = PENETRATION_EDGE_ANGLE
    """Edge angles of the measurements behind the law; outside, `RangeWarning`."""

    def reaction_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Component F_n (N) of the snow's force along the snow normal, ≥ 0.

        tool: The body pressed in; it gives area and volume.
        penetration_depth: e (m), any shape; below 0 the tool is above the snow and feels nothing.
        edge_angle: ϑ (rad), 0 ≤ ϑ ≤ π/2, any shape that broadcasts with the depth.
        Returns: Force in the common shape of depth and angle.
        Raises ParameterError: an edge angle is outside 0 to π/2.
        Warns RangeWarning: an edge angle is outside the law's measured range.
        """
        angle = edge_angles(edge_angle)
        if self.edge_angle_range is not None:
            self.edge_angle_range.warn_outside(angle, type(self).__name__)
        depth, angle = np.broadcast_arrays(np.asarray(penetration_depth, float), angle)
        force = self._force_in_contact(tool, np.maximum(depth, 0.0), angle)
        return np.where(depth < 0.0, 0.0, force)

    @abc.abstractmethod
    def _force_in_contact(self, tool: Tool, depth: FloatArray, angle: FloatArray) -> FloatArray:
        """F_n (N) for depths of at least 0 and angles of the same shape."""


class PointLaw(CheckedParameters, abc.ABC):
    """Stress along the snow normal at one place on the snow, from its depth now and its maximum depth so far.

    The state of a place is one number, the maximum depth ε_max (m, ≥ 0; 0 for untouched snow). It belongs to the snow
    and not to the ski: later parts of a ski meet the groove of earlier ones. Along any path the work done on the place
    is exactly ``stored_energy`` plus ``lost_energy``.

    A rival law is one frozen dataclass in a separate file, entered in ``POINT_LAWS``. It runs in a contact and in a
    turn as it is: `skisnow.contact.SnowField` takes it.
    """

    __slots__ = ()
    along_base_normal: ClassVar[bool] = False
    """Whether the snow's force is one along the normal of the base. Its part across, tan ϑ times the stress, is then
    the maximum side force of an edge; it grows with the displacement across, as every strength in a contact."""

    @property
    def bends(self) -> tuple[float, ...]:
        """Depths (m) above 0 at which the stress of first loading bends: integrals over a base are divided there."""
        return ()

    def deepest_after(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """New maximum depth (m) of a place with maximum depth ε_max (m) after it is brought to depth ε (m)."""
        return np.maximum(np.maximum(np.asarray(depth, float), np.asarray(deepest, float)), 0.0)

    @abc.abstractmethod
    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Stress p (N/m², ≥ 0) at depth ε (m) of a place that has been at ε_max (m) before; the shapes broadcast."""

    def stress_and_energy(self, depth: FloatArray, deepest: FloatArray, edge_angle: FloatArray) -> FloatArray:  # noqa: ARG002
        """Stress (N/m²) and energy per area (J/m²), (2, n), under a base at an edge angle (rad). For loops.

        The angle has no effect except in laws that state it.
        """
        return np.stack([self.stress(depth, deepest), self.stored_energy(depth, deepest)])

    @abc.abstractmethod
    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """Depth ε_res (m) of the groove that is left when the place is unloaded."""

    @abc.abstractmethod
    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that comes back when the place is unloaded from depth ε."""

    @abc.abstractmethod
    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that the groove of depth ε_max has cost for good."""


class DeepeningPoint(PointLaw):
    """Base of laws with a pressure q(ε) on first loading and linear unloading; k_u: a multiple of the steepest q'.

    A subclass defines ``unloading_ratio`` (that multiple) and `_loading`.
    """

    __slots__ = ()
    unloading_ratio: float

    @abc.abstractmethod
    def _loading(self, deepest: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pressure q (N/m²), work ∫q dε (J/m²) and k_u (N/m³) at maximum depths (m)."""

    def _check_further(self) -> None:
        """Reject an unloading_ratio that is below 1 or not finite."""
        if not 1.0 <= self.unloading_ratio < np.inf:
            raise ParameterError(
                "{kind}: unloading_ratio is {unloading_ratio!r}; it must be at least 1 and finite"
            ).tag("out_of_range", kind=type(self).__name__, unloading_ratio=self.unloading_ratio)

    def stress(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Stress p (N/m², ≥ 0) at depth ε (m) of a place that has been at ε_max (m) before; unloading along k_u."""
        depth = np.asarray(depth, float)
        reached = self.deepest_after(depth, deepest)
        loaded, _, unloading = self._loading(reached)
        return np.maximum(loaded - unloading * (reached - depth), 0.0)

    def residual_depth(self, deepest: npt.ArrayLike) -> FloatArray:
        """Depth ε_res (m) of the groove that is left when the place is unloaded: ε_max - p/k_u."""
        loaded, _, unloading = self._loading(deepest)
        return np.asarray(deepest, float) - loaded / unloading

    def stored_energy(self, depth: npt.ArrayLike, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) that comes back when the place is unloaded from depth ε: p²/(2 k_u)."""
        _, _, unloading = self._loading(self.deepest_after(depth, deepest))
        return self.stress(depth, deepest) ** 2 / (2.0 * unloading)

    def lost_energy(self, deepest: npt.ArrayLike) -> FloatArray:
        """Energy per area (J/m²) lost in the groove of depth ε_max: work of loading minus the recovered work."""
        loaded, work, unloading = self._loading(deepest)
        return np.maximum(work - loaded**2 / (2.0 * unloading), 0.0)  # elastic: rounding could be below 0
