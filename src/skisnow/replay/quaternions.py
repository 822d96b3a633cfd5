"""Rotation matrices as unit quaternions: a quarter of the numbers less, and they can be blended."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

FloatArray: TypeAlias = npt.NDArray[np.float64]


def quaternions(matrices: FloatArray) -> FloatArray:
    """Unit quaternions (n, 4), w, x, y, z, of rotation matrices (n, 3, 3); none is opposite to the one before.

    Examples
    --------
    >>> quarter = np.array([[[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])  # about z, to the left
    >>> quaternions(quarter).round(6).tolist()
    [[0.707107, 0.0, 0.0, 0.707107]]
    """
    if not len(matrices):
        return np.zeros((0, 4))
    return continuous(np.roll(Rotation.from_matrix(np.array(matrices)).as_quat(canonical=True), 1, axis=1))


def continuous(found: FloatArray) -> FloatArray:
    """The same rotations by quaternions (n, 4) of which none is opposite to the one before."""
    turned = np.sum(found[1:] * found[:-1], axis=1) < 0.0
    return np.asarray(found * np.cumprod(np.append(1.0, np.where(turned, -1.0, 1.0)))[:, None])
