"""The interface of every law for the force of a pressed tool."""

from __future__ import annotations

import abc
from collections.abc import Mapping
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from ..._support.arrays import FloatArray
from ...geometry import Tool
from ...snow import MeasuredRange
from ..measured_ranges import PENETRATION_EDGE_ANGLE
from ..parameter_checks import edge_angles


class PenetrationLaw(abc.ABC):
    """Force of snow against a tool pressed into it, normal to the snow surface.

    A rival law is one frozen dataclass in a separate file, listed in ``LAWS``; it defines ``_force_in_contact``. If it
    fails one of the shared checks of physics, ``exceptions`` states the reason.
    """

    __slots__ = ()
    edge_angle_range: ClassVar[MeasuredRange | None] = PENETRATION_EDGE_ANGLE
    """Edge angles of the measurements behind the law; outside, `RangeWarning`."""

    @property
    def exceptions(self) -> Mapping[str, str]:
        """Shared checks of physics that this law fails, each with the reason."""
        return {}

    def reaction_force(self, tool: Tool, penetration_depth: npt.ArrayLike, edge_angle: npt.ArrayLike) -> FloatArray:
        """Component F_n (N) of the snow's force along the snow normal, ≥ 0.

        Parameters
        ----------
        tool
            The body pressed in; it gives area and volume.
        penetration_depth
            e (m), any shape; below 0 the tool is above the snow and feels nothing.
        edge_angle
            ϑ (rad), 0 ≤ ϑ ≤ π/2, any shape that broadcasts with the depth.

        Returns
        -------
        array
            Force in the common shape of depth and angle.

        Raises
        ------
        ParameterError
            An edge angle is outside 0 to π/2.

        Warns
        -----
        RangeWarning
            An edge angle is outside the law's measured range.
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
