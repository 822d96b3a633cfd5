"""Vector products of arrays."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow._support.arrays import cross


@pytest.mark.parametrize("shape", [(3,), (2, 3), (5, 2, 3)])
def test_a_vector_product_has_the_bits_of_numpy(shape: tuple[int, ...]) -> None:
    """Also its sign: ahead by left is up."""
    random = np.random.default_rng(1)
    first, second = random.normal(size=shape), random.normal(size=shape)
    assert np.array_equal(cross(first, second), np.cross(first, second))
    assert cross(np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])).tolist() == [0.0, 0.0, 1.0]
