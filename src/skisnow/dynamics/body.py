"""A rigid body on flexible skis: masses, stiffness and loads, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .._support.arrays import FloatArray
from .._support.errors import ParameterError
from .._support.units import ShownFields
from ..compiled import core


def shaped(name: str, given: npt.ArrayLike, shape: tuple[int, ...]) -> FloatArray:
    """An array of finite numbers as compiled code takes it; it checks no shape itself."""
    array = np.asarray(given, float, order="C")
    if array.shape != shape:
        raise ParameterError("{name} has shape {shape}; it must be {needed}").tag(
            "wrong_shape", name=name, shape=str(array.shape), needed=str(shape)
        )
    if not np.isfinite(array).all():
        raise ParameterError("{name} contains a number that is not finite").tag("not_a_number", name=name)
    return array


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
        Times the stiffness (s): Kelvin–Voigt damping.
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
        """The same as an object of the core."""
        boot, axes, unknown, mass, stiffness, coupling = (
            np.ascontiguousarray(each, float)
            for each in (self.boot, self.axes, self.unknown, self.mass, self.stiffness, self.coupling)
        )
        return core.flexible_ski(boot, axes, unknown, mass, stiffness, coupling, self.damping)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, repr=False)
class Body(ShownFields):
    """A rigid body on skis, SI, vectors in its own frame but for gravity.

    Attributes
    ----------
    inertia
        Mass matrix of the body with its undeformed skis: place, then rotation, (6, 6).
    mass, first_moment
        Of both together (kg); mass times place of the centre of mass (kg m), (3,).
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
        """The same as an object of the core."""
        inertia, moment, gravity = (
            np.ascontiguousarray(each, float) for each in (self.inertia, self.first_moment, self.gravity)
        )
        skis = [each.compiled() for each in self.skis]
        return core.body(inertia, self.mass, moment, skis, gravity, self.drag, self.drag_height)
