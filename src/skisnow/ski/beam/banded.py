"""Banded linear systems of a beam: storage, assembly, LU without pivoting.

Row i of a banded matrix keeps the columns i - 5 … i + 5: two neighbouring nodes with three degrees of freedom each. The
matrices here are stiffness plus contact tangent (or mass plus steps of them): their symmetric part is positive
definite, so no pivoting is needed.
"""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from ...machine_code import compiled

FloatArray: TypeAlias = npt.NDArray[np.float64]
IntArray: TypeAlias = npt.NDArray[np.int64]

HALF_BANDWIDTH: Final = 5


def assembled(element_matrices: FloatArray, dof: IntArray, size: int) -> FloatArray:
    """Banded matrix (size, 11) of element matrices (n, 6, 6); `dof` (n, 6) numbers the unknowns, -1 where held."""
    matrix = np.zeros((size, 2 * HALF_BANDWIDTH + 1))
    rows = np.broadcast_to(dof[:, :, None], element_matrices.shape)
    columns = np.broadcast_to(dof[:, None, :], element_matrices.shape)
    free = (rows >= 0) & (columns >= 0)
    np.add.at(matrix, (rows[free], columns[free] - rows[free] + HALF_BANDWIDTH), element_matrices[free])
    return matrix


def dense(matrix: FloatArray) -> FloatArray:
    """The same matrix as a dense (size, size) array, for tests and eigenvalues."""
    size = len(matrix)
    full = np.zeros((size, size))
    for i in range(size):
        for j in range(max(0, i - HALF_BANDWIDTH), min(size, i + HALF_BANDWIDTH + 1)):
            full[i, j] = matrix[i, j - i + HALF_BANDWIDTH]
    return full


@compiled(error_model="numpy")
def factor(matrix: FloatArray) -> None:
    """Replace the banded matrix by its LU factors, in place."""
    size = matrix.shape[0]
    for k in range(size):
        pivot = 1.0 / matrix[k, 5]
        for i in range(k + 1, min(k + 6, size)):
            ratio = matrix[i, 5 + k - i] * pivot
            matrix[i, 5 + k - i] = ratio
            if ratio != 0.0:
                for j in range(1, 6):
                    if k + j < size:
                        matrix[i, 5 + k + j - i] -= ratio * matrix[k, 5 + j]


@compiled(error_model="numpy")
def solve(factors: FloatArray, right: FloatArray, columns: int) -> None:
    """Solve for the first `columns` columns of `right` (size, ≥ columns), in place, with the factors of `factor`."""
    size = factors.shape[0]
    for i in range(size):
        for k in range(max(0, i - 5), i):
            ratio = factors[i, 5 + k - i]
            if ratio != 0.0:
                for c in range(columns):
                    right[i, c] -= ratio * right[k, c]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, min(i + 6, size)):
            entry = factors[i, 5 + k - i]
            for c in range(columns):
                right[i, c] -= entry * right[k, c]
        pivot = 1.0 / factors[i, 5]
        for c in range(columns):
            right[i, c] *= pivot


@compiled(error_model="numpy")
def multiplied(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Product of a banded matrix with a vector (size,)."""
    size = matrix.shape[0]
    product = np.zeros(size)
    for i in range(size):
        total = 0.0
        for j in range(max(0, i - 5), min(size, i + 6)):
            total += matrix[i, 5 + j - i] * vector[j]
        product[i] = total
    return product
