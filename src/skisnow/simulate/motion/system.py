"""Bordered banded systems of the implicit steps: the bands of two skis, the sledge as their border.

Symmetric positive definite: factored as L D Lᵀ without pivoting, the skis first, then the sledge's Schur complement.
"""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled
from .compiled import PLAIN
from .forces import Forces
from .model import PADDING, Model
from .tangent import CHANNELS

FloatArray: TypeAlias = npt.NDArray[np.float64]


ONE, TWO, THREE, FOUR, FIVE = (np.uint64(i) for i in range(1, 6))


class Vector(NamedTuple):
    """Accelerations, forces or increments of rigid body and skis; the skis' rows are padded."""

    rigid: FloatArray  # (6,)
    bend: FloatArray  # (2, n + 10)


class Factored(NamedTuple):
    """Factors of a system's matrix; rows of the skis are padded before and behind."""

    band: FloatArray  # (2, n + 10, 6): reciprocal of D, and L below the diagonal
    border: FloatArray  # (2, n + 10, 6): border solved forwards
    corner: FloatArray  # (6, 6): Cholesky factor of the Schur complement, reciprocals on its diagonal
    rows: FloatArray  # (2, CHANNELS, 6) working space: how the channels follow from the rigid body
    side: FloatArray  # (CHANNELS, 6) working space


def new_vector(size: int) -> Vector:
    """Zeros for skis with that many unknowns."""
    return Vector(np.zeros(6), np.zeros((2, size + 2 * PADDING)))


def new_factored(size: int) -> Factored:
    """Room for the factors of skis with that many unknowns."""
    padded = size + 2 * PADDING
    return Factored(
        np.zeros((2, padded, 6)),
        np.zeros((2, padded, 6)),
        np.zeros((6, 6)),
        np.zeros((2, CHANNELS, 6)),
        np.zeros((CHANNELS, 6)),
    )


@compiled(**PLAIN, fastmath={"contract"})
def factor(
    model: Model, forces: Forces, rows: FloatArray, structure: float, contact: float, out: Factored
) -> bool:  # fmt: skip
    """Factor M + structure × K + contact × C, with K the skis' stiffness and C minus the snow's tangent.

    False if it fails.
    """
    n = len(model.mass)
    for a in range(6):
        for b in range(6):
            out.corner[a, b] = model.rigid[a, b]
    sound = True
    for k in range(2):
        L = out.band[k]
        Y = out.border[k]
        _rigid_tangent(forces, rows, k, contact, out.side, out.corner)
        for i in range(n):
            p = i + PADDING
            for c in range(6):
                total = 0.0
                for channel in range(CHANNELS):
                    total += forces.channels[k, i, channel] * rows[k, channel, c]
                Y[p, c] = model.coupling[k, i, c] + contact * total
            a0 = model.mass[i, 0] + structure * model.stiffness[i, 0] + contact * forces.band[k, i, 0]
            a1 = model.mass[i, 1] + structure * model.stiffness[i, 1] + contact * forces.band[k, i, 1]
            a2 = model.mass[i, 2] + structure * model.stiffness[i, 2] + contact * forces.band[k, i, 2]
            a3 = model.mass[i, 3] + structure * model.stiffness[i, 3] + contact * forces.band[k, i, 3]
            a4 = model.mass[i, 4] + structure * model.stiffness[i, 4] + contact * forces.band[k, i, 4]
            a5 = model.mass[i, 5] + structure * model.stiffness[i, 5] + contact * forces.band[k, i, 5]
            a4 -= a5 * L[p - 4, 1]
            a3 -= a5 * L[p - 3, 2] + a4 * L[p - 3, 1]
            a2 -= a5 * L[p - 2, 3] + a4 * L[p - 2, 2] + a3 * L[p - 2, 1]
            a1 -= a5 * L[p - 1, 4] + a4 * L[p - 1, 3] + a3 * L[p - 1, 2] + a2 * L[p - 1, 1]
            l5, l4, l3 = a5 * L[p - 5, 0], a4 * L[p - 4, 0], a3 * L[p - 3, 0]
            l2, l1 = a2 * L[p - 2, 0], a1 * L[p - 1, 0]
            pivot = a0 - (a5 * l5 + a4 * l4 + a3 * l3 + a2 * l2 + a1 * l1)
            sound = sound and pivot > 0.0
            scale = 1.0 / pivot
            L[p, 0], L[p, 1], L[p, 2], L[p, 3], L[p, 4], L[p, 5] = scale, l1, l2, l3, l4, l5
            for c in range(6):
                Y[p, c] -= l1 * Y[p - 1, c] + l2 * Y[p - 2, c] + l3 * Y[p - 3, c] + l4 * Y[p - 4, c] + l5 * Y[p - 5, c]
            for a in range(6):
                scaled = Y[p, a] * scale
                for b in range(a + 1):
                    out.corner[a, b] -= scaled * Y[p, b]
    return cholesky(out.corner) and sound


@compiled(**PLAIN, fastmath={"contract"})
def _rigid_tangent(
    forces: Forces, rows: FloatArray, k: int, contact: float, side: FloatArray, corner: FloatArray
) -> None:  # fmt: skip
    """Add what the snow's tangent of ski k puts on the rigid body, lower half."""
    for a in range(CHANNELS):
        for c in range(6):
            total = 0.0
            for b in range(CHANNELS):
                low, high = min(a, b), max(a, b)
                total += forces.corner[k, low, high] * rows[k, b, c]
            side[a, c] = contact * total
    for r in range(6):
        for c in range(r + 1):
            total = 0.0
            for a in range(CHANNELS):
                total += rows[k, a, r] * side[a, c]
            corner[r, c] += total


@compiled(**PLAIN, fastmath={"contract"})
def cholesky(corner: FloatArray) -> bool:
    """Cholesky factor of a symmetric matrix, lower half, in place."""
    n = len(corner)
    for a in range(n):
        for b in range(a + 1):
            total = corner[a, b]
            for c in range(b):
                total -= corner[a, c] * corner[b, c]
            if a == b:
                if not total > 0.0:
                    return False
                corner[a, a] = 1.0 / np.sqrt(total)
            else:
                corner[a, b] = total * corner[b, b]
    return True


@compiled(**PLAIN, fastmath={"contract"})
def solve_corner(corner: FloatArray, right: FloatArray) -> None:
    """Solve with the factor of `cholesky`, in place."""
    n = len(corner)
    for a in range(n):
        for c in range(a):
            right[a] -= corner[a, c] * right[c]
        right[a] *= corner[a, a]
    for a in range(n - 1, -1, -1):
        for c in range(a + 1, n):
            right[a] -= corner[c, a] * right[c]
        right[a] *= corner[a, a]


@compiled(**PLAIN, fastmath={"contract"})
def solve(system: Factored, vector: Vector) -> None:
    """Replace the right side by the solution."""
    forwards(system, vector)
    solve_corner(system.corner, vector.rigid)
    backwards(system, vector)


@compiled(**PLAIN, fastmath={"contract"})
def forwards(system: Factored, vector: Vector) -> None:
    """Solve the skis' rows forwards, and bring the border's right side to its Schur complement."""
    last = np.uint64(system.band.shape[1] - PADDING)
    L, Y, z = system.band[0], system.border[0], vector.bend[0]
    K, X, y = system.band[1], system.border[1], vector.bend[1]
    r0, r1, r2, r3, r4, r5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for p in range(np.uint64(PADDING), last):  # both skis at once: each waits for its own last number
        value = z[p] - (
            L[p, 5] * z[p - FIVE] + L[p, 4] * z[p - FOUR] + L[p, 3] * z[p - THREE] + L[p, 2] * z[p - TWO]
            + L[p, 1] * z[p - ONE]
        )  # fmt: skip
        other = y[p] - (
            K[p, 5] * y[p - FIVE] + K[p, 4] * y[p - FOUR] + K[p, 3] * y[p - THREE] + K[p, 2] * y[p - TWO]
            + K[p, 1] * y[p - ONE]
        )  # fmt: skip
        z[p], y[p] = value, other
        value *= L[p, 0]
        other *= K[p, 0]
        r0 += Y[p, 0] * value + X[p, 0] * other
        r1 += Y[p, 1] * value + X[p, 1] * other
        r2 += Y[p, 2] * value + X[p, 2] * other
        r3 += Y[p, 3] * value + X[p, 3] * other
        r4 += Y[p, 4] * value + X[p, 4] * other
        r5 += Y[p, 5] * value + X[p, 5] * other
    rigid = vector.rigid
    rigid[0] -= r0
    rigid[1] -= r1
    rigid[2] -= r2
    rigid[3] -= r3
    rigid[4] -= r4
    rigid[5] -= r5


@compiled(**PLAIN, fastmath={"contract"})
def backwards(system: Factored, vector: Vector) -> None:
    """Solve the skis' rows backwards, the border's solution being known."""
    first, last = np.uint64(PADDING), np.uint64(system.band.shape[1] - PADDING)
    x0, x1, x2 = vector.rigid[0], vector.rigid[1], vector.rigid[2]
    x3, x4, x5 = vector.rigid[3], vector.rigid[4], vector.rigid[5]
    L, Y, z = system.band[0], system.border[0], vector.bend[0]
    K, X, y = system.band[1], system.border[1], vector.bend[1]
    for p in range(first, last):
        border = Y[p, 0] * x0 + Y[p, 1] * x1 + Y[p, 2] * x2 + Y[p, 3] * x3 + Y[p, 4] * x4 + Y[p, 5] * x5
        z[p] = (z[p] - border) * L[p, 0]
        border = X[p, 0] * x0 + X[p, 1] * x1 + X[p, 2] * x2 + X[p, 3] * x3 + X[p, 4] * x4 + X[p, 5] * x5
        y[p] = (y[p] - border) * K[p, 0]
    for back in range(last - first):
        q = last - ONE - np.uint64(back)
        z[q] -= (
            L[q + ONE, 1] * z[q + ONE] + L[q + TWO, 2] * z[q + TWO] + L[q + THREE, 3] * z[q + THREE]
            + L[q + FOUR, 4] * z[q + FOUR] + L[q + FIVE, 5] * z[q + FIVE]
        )  # fmt: skip
        y[q] -= (
            K[q + ONE, 1] * y[q + ONE] + K[q + TWO, 2] * y[q + TWO] + K[q + THREE, 3] * y[q + THREE]
            + K[q + FOUR, 4] * y[q + FOUR] + K[q + FIVE, 5] * y[q + FIVE]
        )  # fmt: skip


@compiled(**PLAIN, fastmath={"contract"})
def add_band(matrix: FloatArray, vector: FloatArray, scale: float, out: FloatArray) -> None:
    """Add scale × matrix × vector, both vectors padded."""
    for i in range(len(matrix)):
        p = i + PADDING
        x = scale * vector[p]
        total = matrix[i, 0] * x
        for j in range(1, 6):
            a = matrix[i, j]
            total += scale * a * vector[p - j]
            out[p - j] += a * x
        out[p] += total


@compiled(**PLAIN, fastmath={"contract"})
def quadratic(matrix: FloatArray, vector: FloatArray) -> float:
    """Value of vectorᵀ × matrix × vector, the vector padded."""
    total = 0.0
    for i in range(len(matrix)):
        p = i + PADDING
        row = 0.5 * matrix[i, 0] * vector[p]
        for j in range(1, 6):
            row += matrix[i, j] * vector[p - j]
        total += 2.0 * vector[p] * row
    return total


@compiled(**PLAIN, fastmath={"contract"})
def add_mass(model: Model, rigid: FloatArray, bend: FloatArray, scale: float, out: Vector) -> None:
    """Add scale × M × (rigid, bend) to `out`."""
    for a in range(6):
        total = 0.0
        for b in range(6):
            total += model.rigid[a, b] * rigid[b]
        out.rigid[a] += scale * total
    x0, x1, x2, x3, x4, x5 = rigid[0], rigid[1], rigid[2], rigid[3], rigid[4], rigid[5]
    for k in range(2):
        B = model.coupling[k]
        add_band(model.mass, bend[k], scale, out.bend[k])
        r0, r1, r2, r3, r4, r5 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(len(model.mass)):
            p = i + PADDING
            u = scale * bend[k, p]
            out.bend[k, p] += scale * (
                B[i, 0] * x0 + B[i, 1] * x1 + B[i, 2] * x2 + B[i, 3] * x3 + B[i, 4] * x4 + B[i, 5] * x5
            )
            r0 += B[i, 0] * u
            r1 += B[i, 1] * u
            r2 += B[i, 2] * u
            r3 += B[i, 3] * u
            r4 += B[i, 4] * u
            r5 += B[i, 5] * u
        out.rigid[0] += r0
        out.rigid[1] += r1
        out.rigid[2] += r2
        out.rigid[3] += r3
        out.rigid[4] += r4
        out.rigid[5] += r5
