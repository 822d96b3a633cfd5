"""Boots that move against the body that carries them: poses, and motions from one to the next."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import DEGREE, Facts, Shown, ShownFields, amount
from ..geometry.boot_axes import angles_of, axes_of
from .body import shaped

FARTHEST_TURN: Final = 1.0
"""Angle (rad) by which a boot may turn within one motion: rotation vectors are single up to π."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BootPose(Shown):
    """Pose and motion of a boot in the frame of the body that carries it.

    Attributes
    ----------
    place
        (m), (3,): ahead, left, up.
    axes
        Axes of the ski: ahead, left across the base, off the base as rows, (3, 3).
    velocity, turning
        (m/s) and (rad/s), (3,) each.

    See Also
    --------
    skisnow.simulate
    skisnow.BootMoment
    """

    place: FloatArray
    axes: FloatArray
    velocity: FloatArray = field(default_factory=lambda: np.zeros(3))
    turning: FloatArray = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        for name, shape in (("place", (3,)), ("axes", (3, 3)), ("velocity", (3,)), ("turning", (3,))):
            object.__setattr__(self, name, shaped(f"BootPose: {name}", getattr(self, name), shape))
        off = np.abs(self.axes @ self.axes.T - np.eye(3)).max()
        if off > 1e-9 or np.linalg.det(self.axes) < 0.0:
            raise ParameterError(
                "BootPose: axes are off by {off:.1e} from right-handed orthonormal ones", code="not_a_rotation", off=off
            )

    def _facts(self) -> Facts:
        edge, pitch, heading = (amount(angle / DEGREE, "°") for angle in angles_of(self.axes))
        place = ", ".join(f"{each:.4g}" for each in self.place)
        speed, turning = (float(np.linalg.norm(each)) for each in (self.velocity, self.turning))
        rows = (
            ("place", f"({place}) m"),
            ("angles", f"edge {edge}, pitch {pitch}, heading {heading}"),
            ("motion", f"{amount(speed, 'm/s')}, {amount(turning, 'rad/s')}"),
        )
        return Facts("of a boot", rows)

    @classmethod
    def of(cls, place: npt.ArrayLike, edge_angle: float, pitch: float = 0.0, heading: float = 0.0) -> BootPose:
        """A boot at rest at a place (m), by its angles (rad)."""
        return cls(np.asarray(place, float), axes_of(edge_angle, pitch, heading))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BootMotion(ShownFields):
    """A boot on its way from one pose to another: place and rotation are cubics that meet both with their rates.

    Attributes
    ----------
    start, end
        Times (s), ``end`` after ``start``.
    first, last
        The poses there.

    Raises
    ------
    ParameterError
        It ends before it starts, or turns by more than a radian.
    """

    start: float
    end: float
    first: BootPose
    last: BootPose

    def __post_init__(self) -> None:
        if not self.start < self.end:
            raise ParameterError(
                "BootMotion: it starts at {start!r} s and ends at {end!r} s, not later",
                code="out_of_range",
                start=self.start,
                end=self.end,
            )
        turn = float(np.linalg.norm(self._turn))
        if turn > FARTHEST_TURN:
            raise ParameterError(
                "BootMotion: the boot turns by {degrees:.3g} degrees between {start:g} s and {end:g} s; at most "
                "{limit:.3g} are allowed. Give poses in between",
                code="out_of_range",
                degrees=math.degrees(turn),
                start=self.start,
                end=self.end,
                limit=math.degrees(FARTHEST_TURN),
            )

    @property
    def _turn(self) -> FloatArray:
        """Rotation vector from the first axes to the last, in the first."""
        return rotation_vector(self.first.axes @ self.last.axes.T)

    @property
    def numbers(self) -> FloatArray:
        """Row of 31 numbers for the core: start, place (4, 3), rotation vector (3, 3), axes (3, 3)."""
        span, first, last = self.end - self.start, self.first, self.last
        turn = self._turn
        rate_last = np.asarray(np.linalg.solve(_jacobian(turn), last.axes @ last.turning), float)
        place = _cubic(span, first.place, last.place, first.velocity, last.velocity)
        angle = _cubic(span, np.zeros(3), turn, first.axes @ first.turning, rate_last)
        return np.concatenate([[self.start], place.ravel(), angle[1:].ravel(), first.axes.ravel()])


def rotation_vector(rotation: FloatArray) -> FloatArray:
    """Rotation vector (3,) of a rotation matrix (3, 3) by less than π."""
    twist = 0.5 * np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                            rotation[1, 0] - rotation[0, 1]])  # fmt: skip
    sine = float(np.linalg.norm(twist))
    angle = math.atan2(sine, 0.5 * (float(np.trace(rotation)) - 1.0))
    return np.asarray(twist * (angle / sine if sine > 1e-12 else 1.0))


def _jacobian(turn: FloatArray) -> FloatArray:
    """From the rate of a rotation vector to the angular velocity in the turned axes: the right Jacobian, (3, 3)."""
    angle = float(np.linalg.norm(turn))
    cross: Any = np.array([[0.0, -turn[2], turn[1]], [turn[2], 0.0, -turn[0]], [-turn[1], turn[0], 0.0]])
    once = (1.0 - math.cos(angle)) / angle**2 if angle > 1e-4 else 0.5
    twice = (angle - math.sin(angle)) / angle**3 if angle > 1e-4 else 1.0 / 6.0
    return np.asarray(np.eye(3) - once * cross + twice * cross @ cross)


def _cubic(span: float, start: FloatArray, end: FloatArray, rate: FloatArray, rate_end: FloatArray) -> FloatArray:
    """Coefficients (4, 3) of the cubic in time that meets both ends with their rates, constant first."""
    way = (end - start) / span
    return np.array([start, rate, (3.0 * way - 2.0 * rate - rate_end) / span, (rate + rate_end - 2.0 * way) / span**2])
