"""Bordered banded systems against dense ones."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.simulate.motion.forces import Forces, new_forces
from skisnow.simulate.motion.model import PADDING, Model, sledge_model
from skisnow.simulate.motion.system import (
    Factored,
    add_band,
    add_mass,
    cholesky,
    factor,
    new_factored,
    solve,
    solve_corner,
)
from skisnow.simulate.motion.tangent import CHANNELS
from skisnow.simulate.sledge import RigidSledge
from skisnow.ski.beam.banded import dense
from skisnow.ski.beam.clamped import ClampedSki, clamped
from tests.simulate.equilibrium.synthetic import plain_ski, shovel

from .dense_model import as_array, as_vector, dense_mass, lower

FloatArray = npt.NDArray[np.float64]
INNER = slice(PADDING, -PADDING)


@pytest.fixture(scope="module")
def ski() -> ClampedSki:
    return clamped(plain_ski(base_height=shovel(1.2, 0.1, 1.6), running_length=1.2), 0.3, 10)


@pytest.fixture(scope="module")
def model(ski: ClampedSki) -> Model:
    return sledge_model(RigidSledge(80.0, (6.0, 8.0, 10.0), (0.1, 0.2), 0.5, 0.5), ski, damping_ratio=0.02)


def random_tangent(model: Model, rng: np.random.Generator) -> tuple[Forces, FloatArray, FloatArray]:
    """Sections of random stiffness as the snow would add them, the channels' rows, and the dense sum."""
    n = len(model.mass)
    forces, rows = new_forces(n, 4), rng.normal(size=(2, CHANNELS, 6))
    total = np.zeros((6 + 2 * n, 6 + 2 * n))
    for k in range(2):
        for _ in range(30):
            first = 3 * int(rng.integers(0, n // 3 - 1))
            beam, channel = np.zeros(n), rng.normal(size=CHANNELS)
            beam[first : first + 6] = rng.normal(size=6)
            for i in range(n):
                for d in range(min(i, 5) + 1):
                    forces.band[k, i, d] += beam[i] * beam[i - d]
            forces.channels[k] += np.outer(beam, channel)
            forces.corner[k] += np.triu(np.outer(channel, channel))
            row = np.zeros(6 + 2 * n)
            row[:6] = channel @ rows[k]
            row[6 + k * n : 6 + (k + 1) * n] = beam
            total += np.outer(row, row)
    return forces, rows, total


def factored(model: Model, forces: Forces, rows: FloatArray, structure: float, contact: float) -> Factored:
    system = new_factored(len(model.mass))
    assert factor(model, forces, rows, structure, contact, system)
    return system


def test_bands_keep_the_skis_matrices(model: Model, ski: ClampedSki) -> None:
    assert np.allclose(lower(model, model.mass), dense(ski.mass), rtol=1e-14, atol=1e-17)
    assert np.allclose(lower(model, model.stiffness), dense(ski.stiffness), rtol=1e-14)


@pytest.mark.parametrize(("structure", "contact"), [(0.0, 0.0), (1e-7, 0.0), (1e-7, 0.3), (1e-3, 100.0)])
def test_solution(model: Model, structure: float, contact: float) -> None:
    rng = np.random.default_rng(3)
    forces, rows, tangent = random_tangent(model, rng)
    n = len(model.mass)
    whole = dense_mass(model) + contact * tangent
    for k in range(2):
        part = slice(6 + k * n, 6 + (k + 1) * n)
        whole[part, part] += structure * lower(model, model.stiffness)
    right = rng.normal(size=6 + 2 * n)
    vector = as_vector(right)
    solve(factored(model, forces, rows, structure, contact), vector)
    known = np.linalg.solve(whole, right)
    # Cholesky is backward stable: the residual is rounding of |W| |x|
    residual = np.abs(whole @ as_array(vector) - right)
    assert np.all(residual <= 1e-13 * (np.abs(whole) @ np.abs(known)))
    assert not vector.bend[:, :PADDING].any()
    assert not vector.bend[:, -PADDING:].any()


def test_a_matrix_that_is_not_definite_is_told(model: Model) -> None:
    forces, rows, _ = random_tangent(model, np.random.default_rng(3))
    system = new_factored(len(model.mass))
    assert not factor(model, forces, rows, 0.0, -1e6, system)


def test_products(model: Model) -> None:
    rng = np.random.default_rng(5)
    whole, n = dense_mass(model), len(model.mass)
    values, start = rng.normal(size=6 + 2 * n), rng.normal(size=6 + 2 * n)
    given, out = as_vector(values), as_vector(start)
    add_mass(model, given.rigid, given.bend, -2.5, out)
    assert np.allclose(as_array(out), start - 2.5 * whole @ values, rtol=0.0, atol=1e-10)
    out = as_vector(start)
    add_band(model.stiffness, given.bend[0], 0.5, out.bend[0])
    known = start[6 : 6 + n] + 0.5 * lower(model, model.stiffness) @ values[6 : 6 + n]
    assert np.allclose(out.bend[0, INNER], known, rtol=0.0, atol=1e-13 * np.abs(model.stiffness).max() * n)


def test_small_systems() -> None:
    rng = np.random.default_rng(7)
    root = rng.normal(size=(6, 6))
    matrix, right = root @ root.T + np.eye(6), rng.normal(size=6)
    corner, found = matrix.copy(), right.copy()
    assert cholesky(corner)
    solve_corner(corner, found)
    assert np.allclose(found, np.linalg.solve(matrix, right), rtol=1e-12)
    assert not cholesky(-matrix)
