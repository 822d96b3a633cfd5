"""Models of the compiled loops as dense matrices, and their vectors as plain arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skisnow.simulate.motion.model import PADDING, Model
from skisnow.simulate.motion.system import Vector, new_vector

FloatArray = npt.NDArray[np.float64]
INNER = slice(PADDING, -PADDING)


def lower(model: Model, matrix: FloatArray) -> FloatArray:
    """Dense matrix of a band that keeps its lower half."""
    n = len(model.mass)
    full = np.zeros((n, n))
    for i in range(n):
        for j in range(max(0, i - 5), i + 1):
            full[i, j] = full[j, i] = matrix[i, i - j]
    return full


def dense_mass(model: Model) -> FloatArray:
    """M of sledge and skis (6 + 2 n)."""
    n = len(model.mass)
    whole = np.zeros((6 + 2 * n, 6 + 2 * n))
    whole[:6, :6] = model.rigid
    for k in range(2):
        part = slice(6 + k * n, 6 + (k + 1) * n)
        whole[part, part] = lower(model, model.mass)
        whole[part, :6], whole[:6, part] = model.coupling[k], model.coupling[k].T
    return whole


def dense_stiffness(model: Model) -> FloatArray:
    """K of the skis, zero for the rigid body (6 + 2 n)."""
    n = len(model.mass)
    whole = np.zeros((6 + 2 * n, 6 + 2 * n))
    for k in range(2):
        part = slice(6 + k * n, 6 + (k + 1) * n)
        whole[part, part] = lower(model, model.stiffness)
    return whole


def as_vector(values: FloatArray) -> Vector:
    """Padded."""
    vector = new_vector((len(values) - 6) // 2)
    vector.rigid[:] = values[:6]
    vector.bend[:, INNER] = values[6:].reshape(2, -1)
    return vector


def as_array(vector: Vector) -> FloatArray:
    """Without padding."""
    return np.concatenate([vector.rigid, vector.bend[:, INNER].ravel()])
