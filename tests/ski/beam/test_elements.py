"""Bending and torsion elements against beams that a pencil can solve."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from skisnow.ski.beam import (
    curvature_shape,
    deflection_shape,
    dense,
    slope_shape,
    stiffness_matrices,
    twist_shape,
)

from .conftest import banded_solution, chain, frequencies, observed_order

LENGTH, EI, GJ, MASS, INERTIA = 0.85, 260.0, 120.0, 1.4, 5.0e-4
FREE_FREE = (4.730040744862704, 7.853204624095838, 10.995607838001671)  # cos(βl) cosh(βl) = 1


@pytest.mark.parametrize("elements", [1, 2, 7])
def test_tip_load_on_a_clamped_beam(elements: int) -> None:
    """w = F l³/(3 EI), w' = F l²/(2 EI): a cubic, so exact for any number of elements."""
    beam = chain(LENGTH, elements, held=True)
    load = np.zeros(beam.size)
    load[-3] = 50.0
    u = banded_solution(beam.stiffness(beam.same(EI), beam.same(GJ)), load)
    assert u[-3] == pytest.approx(50.0 * LENGTH**3 / (3.0 * EI), rel=1e-11)  # rounding only
    assert u[-2] == pytest.approx(50.0 * LENGTH**2 / (2.0 * EI), rel=1e-11)
    assert u[-1] == 0.0


@pytest.mark.parametrize("elements", [1, 5])
def test_moments_at_the_tip(elements: int) -> None:
    """A bending moment: w = M l²/(2 EI); a torque: φ = M l/GJ. Neither moves the other."""
    beam = chain(LENGTH, elements, held=True)
    stiffness = beam.stiffness(beam.same(EI), beam.same(GJ))
    load = np.zeros(beam.size)
    load[-2], load[-1] = 9.0, 4.0
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


def test_rigid_motion_needs_no_force() -> None:
    matrix = stiffness_matrices(np.array([0.2]), np.full((1, 4), EI), np.full((1, 4), GJ))[0]
    assert np.allclose(matrix, matrix.T, rtol=1e-13, atol=0.0)
    for motion in ([1, 0, 0, 1, 0, 0], [0.0, 1, 0, 0.2, 1, 0], [0, 0, 1, 0, 0, 1]):
        assert matrix @ np.array(motion, float) == pytest.approx(np.zeros(6), abs=1e-13 * np.abs(matrix).max())
