"""Runners and poses that several tests share."""

import numpy as np

from skisnow._support.arrays import FloatArray
from skisnow.contact import Runner


def edged(angle: float, lean: float = 0.0, turn: float = 0.0) -> FloatArray:
    """Rotation of a runner: turned (rad) to the left, nose up by ``lean``, its left edge down by ``angle``."""

    def about(axis: int, by: float) -> FloatArray:
        a, b = (axis + 1) % 3, (axis + 2) % 3
        matrix = np.eye(3)
        matrix[a, a] = matrix[b, b] = np.cos(by)
        matrix[a, b], matrix[b, a] = -np.sin(by), np.sin(by)
        return matrix

    return about(2, turn) @ about(1, -lean) @ about(0, -angle)


def straight(*, length: float = 1.6, width: float = 0.06, nodes: FloatArray | None = None) -> Runner:
    """A runner with parallel edges and a level base."""
    ends = np.array([0.5, -0.5]) * length
    return Runner(ends, np.full(2, width / 2.0), np.zeros(2), nodes)
