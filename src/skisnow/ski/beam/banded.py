"""Banded matrices of a beam: storage and assembly.

Row i of a banded matrix keeps the columns i - 5 … i + 5: two neighbouring nodes with three degrees of freedom each. The
compiled core factors and solves such systems.
"""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

HALF_BANDWIDTH: Final = 5
_CLOSE: Final = 1e-14  # by which share an eigenvalue still falls that is found
_MOST_ITERATIONS: Final = 200


def assembled(element_matrices: FloatArray, dof: IntArray, size: int) -> FloatArray:
    """Banded matrix (size, 11) of element matrices (n, 6, 6); `dof` (n, 6) numbers the unknowns, -1 where held."""
    matrix = np.zeros((size, 2 * HALF_BANDWIDTH + 1))
    rows = np.broadcast_to(dof[:, :, None], element_matrices.shape)
    columns = np.broadcast_to(dof[:, None, :], element_matrices.shape)
    free = (rows >= 0) & (columns >= 0)
    np.add.at(matrix, (rows[free], columns[free] - rows[free] + HALF_BANDWIDTH), element_matrices[free])
    return matrix


def dense(matrix: FloatArray) -> FloatArray:
    """The same matrix as a dense (size, size) array, for tests."""
    size = len(matrix)
    full = np.zeros((size, size))
    for i in range(size):
        for j in range(max(0, i - HALF_BANDWIDTH), min(size, i + HALF_BANDWIDTH + 1)):
            full[i, j] = matrix[i, j - i + HALF_BANDWIDTH]
    return full


def lowest_eigenvalue(stiffness: FloatArray, mass: FloatArray, start: FloatArray) -> float:
    """Smallest λ of K x = λ M x among what the start spans, by subspace iteration.

    Parameters
    ----------
    stiffness, mass
        K and M (size, 11), symmetric and positive definite.
    start
        Where the iteration begins (size, k); it converges as (λ of the first over λ of the k + 1st)².
    """
    from scipy.linalg import cho_solve_banded, cholesky_banded, eigh

    factor = cholesky_banded(_columns(stiffness), lower=True, check_finite=False)
    force, found = _product(mass, start), np.inf
    for _ in range(_MOST_ITERATIONS):
        shape = cho_solve_banded((factor, True), force, check_finite=False)
        moved = _product(mass, shape)
        values, mixed = eigh(shape.T @ force, shape.T @ moved, check_finite=False)
        before, found = found, float(values[0])
        if before - found <= _CLOSE * found:
            break
        force = moved @ mixed
    return found


def _columns(matrix: FloatArray) -> FloatArray:
    """Lower half as LAPACK has it: row k holds the k-th diagonal below the main one."""
    return np.array([np.roll(matrix[:, HALF_BANDWIDTH - k], -k) for k in range(HALF_BANDWIDTH + 1)])


def _product(matrix: FloatArray, vectors: FloatArray) -> FloatArray:
    around = np.pad(vectors, ((HALF_BANDWIDTH, HALF_BANDWIDTH), (0, 0)))
    rows = np.lib.stride_tricks.sliding_window_view(around, 2 * HALF_BANDWIDTH + 1, axis=0)
    return np.einsum("ij,ikj->ik", matrix, rows)
