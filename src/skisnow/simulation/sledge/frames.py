"""Frames of a sledge: x forward, y left, z up; its origin lies between the boots, at the level of the bases.

Each ski is rotated about x by minus the edge angle ϑ, so that its left edge goes down for ϑ > 0:
l = cos ϑ y - sin ϑ z points across the base to the left, n = sin ϑ y + cos ϑ z away from the snow.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]


def base_normal(edge_angle: float) -> FloatArray:
    """Unit vector n (3,) normal to the base, away from the snow, for the edge angle ϑ (rad)."""
    return np.array([0.0, math.sin(edge_angle), math.cos(edge_angle)])


def base_lateral(edge_angle: float) -> FloatArray:
    """Unit vector l (3,) across the base to the left, for the edge angle ϑ (rad)."""
    return np.array([0.0, math.cos(edge_angle), -math.sin(edge_angle)])


def cross_matrix(vector: npt.ArrayLike) -> FloatArray:
    """Matrix of the cross product, a × b = A b: (…, 3) to (…, 3, 3)."""
    v = np.asarray(vector, float)
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2] = -v[..., 2], v[..., 1]
    matrix[..., 1, 0], matrix[..., 1, 2] = v[..., 2], -v[..., 0]
    matrix[..., 2, 0], matrix[..., 2, 1] = -v[..., 1], v[..., 0]
    return matrix


def rotation(quaternion: npt.ArrayLike) -> FloatArray:
    """Rotation matrix (3, 3) from the sledge's frame to space of a unit quaternion (w, x, y, z)."""
    w, x, y, z = np.asarray(quaternion, float)
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )
