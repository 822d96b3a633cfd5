"""Banded storage and its LU against dense linear algebra."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.linalg import eigh

from skisnow._support.arrays import FloatArray
from skisnow.compiled import core
from skisnow.ski.beam import (
    HALF_BANDWIDTH,
    assembled,
    curvature_shape,
    deflection_shape,
    lowest_eigenvalue,
    slope_shape,
    twist_shape,
)

from .conftest import banded_solution, chain, frequencies, observed_order
from .dense import dense


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


LENGTH, EI, GJ, MASS, INERTIA = 0.85, 260.0, 120.0, 1.4, 5.0e-4
FREE_FREE = (4.730040744862704, 7.853204624095838, 10.995607838001671)  # cos(βl) cosh(βl) = 1


@pytest.mark.parametrize("elements", [1, 2, 7])
def test_force_and_moments_at_the_tip(elements: int) -> None:
    """w = F l³/(3 EI), w' = F l²/(2 EI): a cubic, so exact for any number of elements.

    A bending moment: w = M l²/(2 EI); a torque: φ = M l/GJ. Neither moves the other.
    """
    beam = chain(LENGTH, elements, held=True)
    stiffness = beam.stiffness(beam.same(EI), beam.same(GJ))
    load = np.zeros(beam.size)
    load[-3] = 50.0
    u = banded_solution(stiffness, load)
    assert u[-3] == pytest.approx(50.0 * LENGTH**3 / (3.0 * EI), rel=1e-11)  # rounding only
    assert u[-2] == pytest.approx(50.0 * LENGTH**2 / (2.0 * EI), rel=1e-11)
    assert u[-1] == 0.0
    load[-3:] = 0.0, 9.0, 4.0
    u = banded_solution(stiffness, load)
    assert u[-3] == pytest.approx(9.0 * LENGTH**2 / (2.0 * EI), rel=1e-11)
    assert u[-2] == pytest.approx(9.0 * LENGTH / EI, rel=1e-11)
    assert u[-1] == pytest.approx(4.0 * LENGTH / GJ, rel=1e-11)


def test_bending_stiffness_that_falls_linearly() -> None:
    """w(l) = ∫ F (l - x)²/EI(x) dx by quadrature, and order 4 of the elements."""

    def curved(x: float) -> float:
        return 50.0 * (LENGTH - x) ** 2 / (EI * (1.0 - 0.75 * x / LENGTH))

    exact = quad(curved, 0.0, LENGTH, epsabs=0.0, epsrel=1e-13)[0]
    error = []
    for elements in (4, 8, 16, 32):
        beam = chain(LENGTH, elements, held=True)
        load = np.zeros(beam.size)
        load[-3] = 50.0
        u = banded_solution(beam.stiffness(EI * (1.0 - 0.75 * beam.gauss / LENGTH), beam.same(GJ)), load)
        error.append(abs(u[-3] / exact - 1.0))
    assert observed_order(error)[-1] == pytest.approx(4.0, abs=0.2)
    assert error[-1] < 1e-6


def test_torsional_stiffness_that_falls_linearly() -> None:
    """φ(l) = M ∫ dx/GJ = M l ln(4)/(0.75 GJ₀) where GJ falls to a quarter; order 2."""
    exact = 4.0 * LENGTH / GJ * math.log(4.0) / 0.75
    error = []
    for elements in (8, 16, 32, 64):
        beam = chain(LENGTH, elements, held=True)
        load = np.zeros(beam.size)
        load[-1] = 4.0
        torsional = GJ * (1.0 - 0.75 * beam.gauss / LENGTH)
        error.append(abs(banded_solution(beam.stiffness(beam.same(EI), torsional), load)[-1] / exact - 1.0))
    assert observed_order(error)[-1] == pytest.approx(2.0, abs=0.05)
    assert error[-1] < 1e-4


def test_bending_frequencies_of_a_free_beam() -> None:
    """ω = (βl)² √(EI/m')/l², two rigid modes before them; order 4."""
    exact = np.array(FREE_FREE) ** 2 * math.sqrt(EI / MASS) / LENGTH**2
    error = []
    for elements in (8, 16, 32):
        beam = chain(LENGTH, elements, held=False)
        mass = beam.mass(beam.same(MASS), beam.same(INERTIA))
        omega = frequencies(beam.stiffness(beam.same(EI), beam.same(GJ)), mass, (0, 1))
        assert np.all(omega[:2] < 1e-3 * exact[0])
        error.append(np.abs(omega[2:5] / exact - 1.0))
    for mode in range(3):
        orders = observed_order([float(each[mode]) for each in error])
        assert orders[-1] == pytest.approx(4.0, abs=0.1)
    assert np.all(error[-1] < 1e-5)


def test_torsional_frequencies_of_a_free_bar() -> None:
    """ω = n π √(GJ/I')/l; order 2, from above (a consistent mass matrix)."""
    exact = np.arange(1, 4) * math.pi * math.sqrt(GJ / INERTIA) / LENGTH
    error = []
    for elements in (16, 32, 64):
        beam = chain(LENGTH, elements, held=False)
        mass = beam.mass(beam.same(MASS), beam.same(INERTIA))
        omega = frequencies(beam.stiffness(beam.same(EI), beam.same(GJ)), mass, (2,))
        error.append(omega[1:4] / exact - 1.0)
    assert np.all(np.array(error) > 0.0)
    assert observed_order([float(each[0]) for each in error])[-1] == pytest.approx(2.0, abs=0.02)
    assert np.all(error[-1] < np.array([1.1e-4, 4.2e-4, 9.5e-4]))  # (nπ/64)²/24


def test_mass_of_rigid_motion() -> None:
    """Lifting the beam moves m l, turning it about its first node m l³/3, twisting it I' l."""
    beam = chain(LENGTH, 6, held=False)
    mass = beam.mass(beam.same(MASS), beam.same(INERTIA))
    lift, turn, twist = (np.zeros(beam.size) for _ in range(3))
    lift[0::3], twist[2::3] = 1.0, 1.0
    turn[0::3], turn[1::3] = beam.node, 1.0
    assert lift @ dense(mass) @ lift == pytest.approx(MASS * LENGTH, rel=1e-12)
    assert turn @ dense(mass) @ turn == pytest.approx(MASS * LENGTH**3 / 3.0, rel=1e-12)
    assert turn @ dense(mass) @ lift == pytest.approx(MASS * LENGTH**2 / 2.0, rel=1e-12)
    assert twist @ dense(mass) @ twist == pytest.approx(INERTIA * LENGTH, rel=1e-12)


def test_shapes_are_a_cubic_and_its_derivatives() -> None:
    """A cubic given by its end values and slopes comes back, with slope and curvature, anywhere."""
    start, length = 0.3, 0.17
    cubic = np.polynomial.Polynomial([0.4, -1.2, 3.0, 5.0])
    value = np.zeros(6)
    ends = np.array([start, start + length])
    value[[0, 3]], value[[1, 4]] = cubic(ends), cubic.deriv()(ends)
    local = np.linspace(0.0, 1.0, 9)
    x = start + length * local
    assert deflection_shape(local, length) @ value == pytest.approx(cubic(x), rel=1e-12)
    assert slope_shape(local, length) @ value == pytest.approx(cubic.deriv()(x), rel=1e-11, abs=1e-13)
    assert curvature_shape(local, length) @ value == pytest.approx(cubic.deriv(2)(x), rel=1e-10)
    assert twist_shape(local) @ np.array([0, 0, 2.0, 0, 0, 3.0]) == pytest.approx(2.0 + local, rel=1e-12)


BENDING, TORSION, LOAD = 250.0, 100.0, 700.0


def depths(reach: float, elements: int) -> tuple[float, float]:
    """Depth under the middle load and at the ends, over P λ/(2 k), of a free beam with λ l = reach."""
    length = 1.6
    rate = reach / length
    foundation = 4.0 * BENDING * rate**4
    beam = chain(length, elements, held=False)
    # ∫ k N_i N_j is the mass matrix of a beam with k for its mass per length
    matrix = beam.stiffness(beam.same(BENDING), beam.same(TORSION)) + beam.mass(beam.same(foundation), beam.same(1.0))
    right = np.zeros(beam.size)
    right[3 * (elements // 2)] = LOAD
    u = banded_solution(matrix, right)
    scale = LOAD * rate / (2.0 * foundation)
    return u[3 * (elements // 2)] / scale, u[0] / scale


@pytest.mark.parametrize("reach", [0.5, 1.0, 2.0, 3.0, math.pi])
def test_load_at_the_middle(reach: float) -> None:
    """(2 + cosh λl + cos λl)/(sinh λl + sin λl) under the load, 4 cosh(λl/2) cos(λl/2)/(…) at the ends."""
    below = math.sinh(reach) + math.sin(reach)
    # 40 elements: 1.6e-7 off at λl = π, with order 4; on softer ground finer meshes lose digits to rounding
    middle, end = depths(reach, 40)
    assert middle == pytest.approx((2.0 + math.cosh(reach) + math.cos(reach)) / below, rel=3e-7)
    assert end == pytest.approx(4.0 * math.cosh(reach / 2.0) * math.cos(reach / 2.0) / below, rel=3e-7, abs=3e-7)


def test_order_of_convergence() -> None:
    """Hermite elements: order 4 or better under the load."""
    exact = 1.0 / math.tanh(math.pi / 2.0)
    orders = observed_order([abs(depths(math.pi, elements)[0] / exact - 1.0) for elements in (4, 8, 16)])
    assert np.all(orders > 3.8)
