"""Banded storage and its LU against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh

from skisnow.compiled import core
from skisnow.ski.beam import HALF_BANDWIDTH, assembled, dense, lowest_eigenvalue

from .conftest import FloatArray, banded_solution, chain


def random_band(size: int, seed: int) -> FloatArray:
    """A banded matrix that is not symmetric and whose symmetric part is positive definite."""
    rng = np.random.default_rng(seed)
    matrix = rng.uniform(-1.0, 1.0, (size, 2 * HALF_BANDWIDTH + 1))
    matrix[:, HALF_BANDWIDTH] += 2.5 * HALF_BANDWIDTH
    for i in range(size):
        for k in range(2 * HALF_BANDWIDTH + 1):
            if not 0 <= i + k - HALF_BANDWIDTH < size:
                matrix[i, k] = 0.0
    return matrix


@given(st.integers(1, 40), st.sampled_from([1, 4]), st.integers(0, 2**32 - 1))
def test_solution_is_that_of_numpy(size: int, columns: int, seed: int) -> None:
    matrix = random_band(size, seed)
    right = np.random.default_rng(seed + 1).normal(size=(size, columns))
    expected = np.linalg.solve(dense(matrix), right)
    found = core.banded_solution(core.banded_factors(matrix), right, 0)
    assert found == pytest.approx(expected, rel=1e-10, abs=1e-13)


@pytest.mark.parametrize("size", [2, 7, 40])
def test_lowest_eigenvalue_is_that_of_scipy(size: int) -> None:
    """Of a chain between springs and masses that grow along it."""

    def chained(spring: FloatArray, mass: FloatArray) -> FloatArray:
        out = np.zeros((size, 2 * HALF_BANDWIDTH + 1))
        out[:, HALF_BANDWIDTH] = spring[:-1] + spring[1:] + mass
        out[1:, HALF_BANDWIDTH - 1] = out[:-1, HALF_BANDWIDTH + 1] = -spring[1:-1]
        return out

    along = np.linspace(1.0, 3.0, size + 1)
    stiffness, mass = chained(along, np.zeros(size)), chained(np.full(size + 1, 0.1), along[1:])
    known = eigh(dense(stiffness), dense(mass), eigvals_only=True)[0]
    found = lowest_eigenvalue(stiffness, mass, np.stack([along[:-1], along[:-1] ** 2], axis=1))
    assert found == pytest.approx(known, rel=1e-11)


@given(st.integers(1, 40), st.integers(0, 2**32 - 1))
def test_factors_multiply_to_the_matrix(size: int, seed: int) -> None:
    """The diagonal holds the inverse pivots."""
    matrix = random_band(size, seed)
    full = dense(core.banded_factors(matrix))
    upper = np.triu(full, 1) + np.diag(1.0 / np.diag(full))
    product = (np.tril(full, -1) + np.eye(size)) @ upper
    assert product == pytest.approx(dense(matrix), abs=1e-12)


@pytest.mark.parametrize("columns", [1, 4])
def test_rows_of_zeros_in_front_need_no_solving(columns: int) -> None:
    factors = core.banded_factors(random_band(30, 3))
    right = np.random.default_rng(4).normal(size=(30, columns))
    right[:12] = 0.0
    assert np.array_equal(core.banded_solution(factors, right, 12), core.banded_solution(factors, right, 0))


def test_assembly_adds_what_shares_a_number_and_drops_what_is_held() -> None:
    rng = np.random.default_rng(5)
    element = rng.normal(size=(3, 6, 6))
    dof = np.array([[-1, -1, -1, 0, 1, 2], [0, 1, 2, 3, 4, 5], [3, 4, 5, 6, 7, 8]], dtype=np.int64)
    expected = np.zeros((9, 9))
    expected[:3, :3] += element[0, 3:, 3:]
    expected[:6, :6] += element[1]
    expected[3:, 3:] += element[2]
    assert dense(assembled(element, dof, 9)) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(("elements", "digits_kept"), [(160, 1e-7), (640, 1e-4)])
def test_a_fine_beam_loses_no_more_digits_than_numpy(elements: int, digits_kept: float) -> None:
    """Condition number ~ elements⁴: rounding, not the mesh, limits a tip load that is exact on any mesh."""
    beam = chain(0.8, elements, held=True)
    stiffness = beam.stiffness(beam.same(200.0), beam.same(100.0))
    right = np.zeros(beam.size)
    right[-3] = 1.0
    exact = 0.8**3 / 600.0
    ours = abs(banded_solution(stiffness, right)[-3] / exact - 1.0)
    numpys = abs(np.linalg.solve(dense(stiffness), right)[-3] / exact - 1.0)
    assert ours < digits_kept
    assert ours < 10.0 * numpys
