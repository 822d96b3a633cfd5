"""A free beam on an elastic foundation that also pulls: Hetényi (1946), *Beams on elastic foundation*."""

from __future__ import annotations

import math

import numpy as np
import pytest

from .conftest import banded_solution, chain, observed_order

EI, GJ, LOAD = 250.0, 100.0, 700.0


def depths(reach: float, elements: int) -> tuple[float, float]:
    """Depth under the middle load and at the ends, over P λ/(2 k), of a free beam with λ l = reach."""
    length = 1.6
    rate = reach / length
    foundation = 4.0 * EI * rate**4
    beam = chain(length, elements, held=False)
    # ∫ k N_i N_j is the mass matrix of a beam with k for its mass per length
    matrix = beam.stiffness(beam.same(EI), beam.same(GJ)) + beam.mass(beam.same(foundation), beam.same(1.0))
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


def test_where_snow_would_have_to_pull() -> None:
    """The ends come to the surface at λl = π, where the depth is coth(π/2) of the endless beam's, and rise beyond."""
    middle, end = depths(math.pi, 160)
    assert middle == pytest.approx(1.0 / math.tanh(math.pi / 2.0), rel=3e-8)  # order 4: 1e-8 off with 80 elements
    assert abs(end) < 1e-8
    assert depths(0.98 * math.pi, 160)[1] > 0.0 > depths(1.02 * math.pi, 160)[1]


def test_order_of_convergence() -> None:
    """Hermite elements: order 4 or better under the load."""
    exact = 1.0 / math.tanh(math.pi / 2.0)
    orders = observed_order([abs(depths(math.pi, elements)[0] / exact - 1.0) for elements in (4, 8, 16)])
    assert np.all(orders > 3.8)
