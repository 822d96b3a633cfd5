"""Plain beams: chains of the elements, free at both ends or held at the first node."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

from skisnow._support.arrays import FloatArray
from skisnow.compiled import core
from skisnow.ski.beam import GAUSS_POINTS, assembled, mass_matrices, stiffness_matrices

from .dense import dense


@dataclass(frozen=True)
class Chain:
    """Elements between rising nodes; the first node is held or not."""

    node: FloatArray
    held: bool

    @property
    def length(self) -> FloatArray:
        return np.diff(self.node)

    @property
    def dof(self) -> npt.NDArray[np.int64]:
        number = np.arange(3 * len(self.node)).reshape(-1, 3) - (3 if self.held else 0)
        number[number < 0] = -1
        return np.hstack([number[:-1], number[1:]]).astype(np.int64)

    @property
    def size(self) -> int:
        return 3 * (len(self.node) - int(self.held))

    @property
    def gauss(self) -> FloatArray:
        """Places of the Gauss points, (elements, 4)."""
        return self.node[:-1, None] + self.length[:, None] * GAUSS_POINTS

    def stiffness(self, bending: FloatArray, torsional: FloatArray) -> FloatArray:
        return assembled(stiffness_matrices(self.length, bending, torsional), self.dof, self.size)

    def mass(self, per_length: FloatArray, inertia: FloatArray) -> FloatArray:
        return assembled(mass_matrices(self.length, per_length, inertia), self.dof, self.size)

    def same(self, value: float) -> FloatArray:
        return np.full((len(self.length), 4), value)


def chain(length: float, elements: int, *, held: bool) -> Chain:
    return Chain(np.linspace(0.0, length, elements + 1), held)


def banded_solution(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solution by the banded LU."""
    return core.banded_solution(core.banded_factors(matrix), np.ascontiguousarray(right.reshape(-1, 1)), 0)[:, 0]


def frequencies(stiffness: FloatArray, mass: FloatArray, degrees: tuple[int, ...]) -> FloatArray:
    """Angular frequencies (rad/s) of the degrees of freedom 0 deflection, 1 slope, 2 twist; rising."""
    chosen = np.isin(np.arange(len(stiffness)) % 3, degrees)
    square = eigh(dense(stiffness)[np.ix_(chosen, chosen)], dense(mass)[np.ix_(chosen, chosen)], eigvals_only=True)
    return np.sqrt(np.maximum(square, 0.0))


def observed_order(error: list[float]) -> FloatArray:
    """Orders between meshes that are each twice as fine as the one before."""
    return np.log2(np.array(error[:-1]) / np.array(error[1:]))
