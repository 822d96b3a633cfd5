"""A rigid body on flexible skis: masses, stiffness and loads, as arrays; poses and motions of its boots."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray, shaped
from .._support.errors import ParameterError
from .._support.units import DEGREE, Facts, Shown, ShownFields, amount
from ..compiled import core
from ..geometry.vectors import angles_of, axes_of


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class FlexibleSki(ShownFields):
    """A beam clamped to the body at its boot: three unknowns to a free node (deflection, its slope, twist).

    Attributes
    ----------
    boot
        Position of the ski's boot in the body's frame (m), (3,).
    axes
        Ahead, left across the base, off the base, as rows in the body's frame, (3, 3).
    unknown
        First unknown of each node from tip to tail, -1 where the binding clamps it, (nodes,).
    mass, stiffness
        Symmetric bands, lower half: [i, j] is A[i, i - j], (n, 6).
    coupling
        Block of the mass matrix between the beam's unknowns and the body's six, (n, 6).
    damping
        Factor (s) of the stiffness matrix that gives the damping matrix: Kelvin–Voigt damping.
    inertia
        Mass matrix of the undeformed ski about its boot, in its own axes, (6, 6): part of the body's, too. Without it
        the force of the ski on its boot is unknown, and its boot cannot move.

    Raises
    ------
    ParameterError
        Shapes do not fit, a number is not finite, or a node's unknowns lie outside the matrices.
    """

    boot: FloatArray
    axes: FloatArray
    unknown: FloatArray
    mass: FloatArray
    stiffness: FloatArray
    coupling: FloatArray
    damping: float
    inertia: FloatArray | None = None

    def __post_init__(self) -> None:
        n, nodes = len(self.mass), len(self.unknown)
        shapes = {"boot": (3,), "axes": (3, 3), "unknown": (nodes,)}
        shapes |= dict.fromkeys(("mass", "stiffness", "coupling"), (n, 6))
        for name, shape in shapes.items():
            shaped(f"FlexibleSki: {name}", getattr(self, name), shape)
        shaped("FlexibleSki: damping", self.damping, ())
        if self.inertia is not None:
            shaped("FlexibleSki: inertia", self.inertia, (6, 6))
        free = np.asarray(self.unknown)[np.asarray(self.unknown) >= 0]
        if not np.array_equal(np.sort(free), np.arange(0, n, 3)) or n % 3:
            raise ParameterError(
                "FlexibleSki: unknown gives {n_free} free nodes their first unknowns, the matrices have {n} rows; "
                "each node needs three separate ones"
            ).tag("wrong_shape", n_free=len(free), n=n)

    def compiled(self) -> core.FlexibleSki:
        """The ski as the core's type."""
        boot, axes, unknown, mass, stiffness, coupling = (
            np.ascontiguousarray(each, float)
            for each in (self.boot, self.axes, self.unknown, self.mass, self.stiffness, self.coupling)
        )
        return core.flexible_ski(boot, axes, unknown, mass, stiffness, coupling, self.damping)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Body(ShownFields):
    """A rigid body on skis in SI units; vectors are in its own frame, except gravity.

    Attributes
    ----------
    inertia
        Mass matrix of the body with its undeformed skis: place, then rotation, (6, 6).
    mass, first_moment
        Mass of body and skis together (kg); mass times place of the centre of mass (kg m), (3,).
    skis
        One or more.
    gravity
        In space (m/s²), (3,).
    drag, drag_height
        ½ ρ C_d A (kg/m); height of the air's centre of pressure above the body's origin (m).

    Raises
    ------
    ParameterError
        Shapes do not match, a number is not finite, or there is no ski.
    """

    inertia: FloatArray
    mass: float
    first_moment: FloatArray
    skis: tuple[FlexibleSki, ...]
    gravity: FloatArray
    drag: float = 0.0
    drag_height: float = 0.0

    def __post_init__(self) -> None:
        shapes = {"inertia": (6, 6), "first_moment": (3,), "gravity": (3,), "mass": (), "drag": (), "drag_height": ()}
        for name, shape in shapes.items():
            shaped(f"Body: {name}", getattr(self, name), shape)
        if not self.skis:
            raise ParameterError("Body: it needs one ski or more").tag("missing")

    def compiled(self) -> core.Body:
        """The body as the core's type."""
        inertia, moment, gravity = (
            np.ascontiguousarray(each, float) for each in (self.inertia, self.first_moment, self.gravity)
        )
        skis = [each.compiled() for each in self.skis]
        return core.body(inertia, self.mass, moment, skis, gravity, self.drag, self.drag_height)


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
        off = _off_rotation(self.axes.tolist())
        if off > 1e-9:
            raise ParameterError("BootPose: axes are off by {off:.1e} from right-handed orthonormal ones").tag(
                "not_a_rotation", off=off
            )

    @property
    def numbers(self) -> FloatArray:
        """Place, axes row by row, velocity and turning, (18,)."""
        return np.concatenate([self.place, self.axes.ravel(), self.velocity, self.turning])

    @classmethod
    def unchecked(cls, *arrays: FloatArray) -> BootPose:
        """Pose from valid arrays (place, axes, velocity, turning) without checks, which takes a seventh of the time."""
        pose = object.__new__(cls)
        for name, array in zip(cls.__slots__, arrays, strict=True):
            object.__setattr__(pose, name, array)
        return pose

    def _repr_facts(self) -> Facts:
        """Title, and rows with place (m), angles (°) and speeds."""
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
        """Pose of a boot at rest from its place (m), edge angle, pitch and heading (rad)."""
        return cls(np.asarray(place, float), axes_of(edge_angle, pitch, heading))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class BootMotion(ShownFields):
    """Motion of a boot between two poses: cubics of place and rotation that match poses and rates at both ends.

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
            raise ParameterError("BootMotion: it starts at {start!r} s and ends at {end!r} s, not later").tag(
                "out_of_range", start=self.start, end=self.end
            )
        cosine = 0.5 * (float(np.vdot(self.first.axes, self.last.axes)) - 1.0)
        turn = math.acos(max(-1.0, min(1.0, cosine)))
        if turn > FARTHEST_TURN:
            raise ParameterError(
                "BootMotion: the boot turns by {degrees:.3g} degrees between {start:g} s and {end:g} s; at most "
                "{limit:.3g} are allowed. Give poses in between"
            ).tag(
                "out_of_range",
                degrees=math.degrees(turn),
                start=self.start,
                end=self.end,
                limit=math.degrees(FARTHEST_TURN),
            )

    @property
    def numbers(self) -> FloatArray:
        """Row of 38 numbers for the core: start, end, and both poses."""
        return np.concatenate([(self.start, self.end), self.first.numbers, self.last.numbers])


def _off_rotation(axes: list[list[float]]) -> float:
    """Largest deviation from a right-handed orthonormal frame: the third axis is the product of the first two."""
    (a, b, c), (d, e, f), (x, y, z) = axes
    lengths = (a * a + b * b + c * c - 1.0, d * d + e * e + f * f - 1.0, a * d + b * e + c * f)
    return max(map(abs, (*lengths, b * f - c * e - x, c * d - a * f - y, a * e - b * d - z)))
