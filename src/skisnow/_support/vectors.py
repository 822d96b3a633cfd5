"""Vectors in space as three numbers each: for single vectors several times faster than arrays."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TypeAlias

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
    """Sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """Difference."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(factor: float, a: Vector) -> Vector:
    """Multiple."""
    return factor * a[0], factor * a[1], factor * a[2]


def unit(a: Vector) -> Vector:
    """Vector of length 1 in the same direction."""
    return times(1.0 / math.hypot(*a), a)


def combined(numbers: Vector, axes: Sequence[Vector]) -> Vector:
    """Vector that has these numbers along three axes: their row times the matrix of the axes as rows.

    >>> combined((2.0, 3.0, 4.0), ((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    (3.0, 2.0, 4.0)
    """
    (x, y, z), (a, b, c) = numbers, axes
    return x * a[0] + y * b[0] + z * c[0], x * a[1] + y * b[1] + z * c[1], x * a[2] + y * b[2] + z * c[2]


def applied(rows: Iterable[Vector], a: Vector) -> Vector:
    """Matrix, as rows, times a vector.

    >>> applied(((0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)), (2.0, 3.0, 4.0))
    (3.0, 2.0, 4.0)
    """
    return tuple(dot(row, a) for row in rows)
