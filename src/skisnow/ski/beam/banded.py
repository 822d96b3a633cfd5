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
