"""Vectors in space as three numbers, for single ones several times faster than arrays; axes of a ski at its boot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from .._support.arrays import FloatArray

Vector: TypeAlias = Sequence[float]


def dot(a: Vector, b: Vector) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product.

    >>> cross((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    (0.0, 0.0, 1.0)
    """
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def plus(a: Vector, b: Vector) -> Vector:
    """Sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """Difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(factor: float, a: Vector) -> Vector:
    """Product of a number and a vector."""
    return factor * a[0], factor * a[1], factor * a[2]


def unit(a: Vector) -> Vector:
    """Vector of length 1 in the same direction."""
    return times(1.0 / math.hypot(*a), a)


def combined(numbers: Vector, axes: Sequence[Vector]) -> Vector:
    """Sum of three axes (rows), each times one of three components.

    >>> combined((2.0, 3.0, 4.0), ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    (3.0, 2.0, 4.0)
    """
    (x, y, z), (a, b, c) = numbers, axes
    return x * a[0] + y * b[0] + z * c[0], x * a[1] + y * b[1] + z * c[1], x * a[2] + y * b[2] + z * c[2]


def applied(rows: Sequence[Vector], a: Vector) -> Vector:
    """Product of a matrix, given by rows, and a vector.

    >>> applied(((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), (2.0, 3.0, 4.0))
    (3.0, 2.0, 4.0)
    """
    first, second, third = rows
    return dot(first, a), dot(second, a), dot(third, a)


def axes_of(edge_angle: float, pitch: float, heading: float) -> FloatArray:
    """Axes of a boot (ahead, left, off the base) from its angles (rad), as the rows of an array (3, 3)."""
    return np.array(axis_rows(edge_angle, pitch, heading))


def axis_rows(edge_angle: float, pitch: float, heading: float) -> tuple[Vector, Vector, Vector]:
    """Axes of a boot, ahead, left and off the base as rows.

    edge_angle: about the ski, the left edge down for positive ones (rad): the last rotation.
    pitch: the tip up for positive ones (rad).
    heading: to the left for positive ones (rad): the first rotation.
    """
    (sh, ch), (sp, cp), (se, ce) = ((math.sin(a), math.cos(a)) for a in (heading, pitch, edge_angle))
    level, above = (-sh, ch, 0.0), (-ch * sp, -sh * sp, cp)
    left, off = minus(times(ce, level), times(se, above)), plus(times(se, level), times(ce, above))
    return (ch * cp, sh * cp, sp), left, off


def angles_of(axes: FloatArray) -> FloatArray:
    """Edge angle, pitch and heading (rad) of axes, (…, 3, 3) to (…, 3): the inverse of `axes_of`.

    >>> [round(float(angle), 12) for angle in angles_of(axes_of(0.7, 0.1, -0.3))]
    [0.7, 0.1, -0.3]
    """
    ahead, left, off = (axes[..., i, :] for i in range(3))
    heading = np.arctan2(ahead[..., 1], ahead[..., 0])
    pitch = np.arctan2(ahead[..., 2], np.hypot(ahead[..., 0], ahead[..., 1]))
    return np.stack([np.arctan2(-left[..., 2], off[..., 2]), pitch, heading], axis=-1)
