"""Shares of variance where they are known: sums of independent inputs, an input without effect, an interplay."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow._support.errors import FitError
from skisnow.statistics import variance_shares


def test_a_weighted_sum_has_the_shares_of_its_squared_weights() -> None:
    """y = 3 x₁ + 2 x₂ + noise of variance 3, x of variance 1: 9/16, 4/16, 0 and 3/16 left; a correlation of two of
    the columns, drawn independently, moves a share by 2 · 3 · 2/16/√n."""
    rng = np.random.default_rng(1)
    x = rng.standard_normal((4000, 3))
    found = variance_shares(x @ [3.0, 2.0, 0.0] + np.sqrt(3.0) * rng.standard_normal(4000), x)
    assert found.share == pytest.approx([9 / 16, 4 / 16, 0.0], abs=0.03)
    assert found.left == pytest.approx(3 / 16, abs=0.02)
    assert found.interval[:2, 0] == pytest.approx([9 / 16, 4 / 16], abs=0.06)
    assert np.all(found.interval[:, 0] <= found.share)
    assert np.all(found.share <= found.interval[:, 1])


def test_what_no_input_takes_along_alone_is_left() -> None:
    """x₁ x₂ over a full grid has no first-order share at all."""
    x = np.array([[a, b] for a in (-1.0, 1.0) for b in (-1.0, 1.0)] * 3)
    found = variance_shares(x[:, 0] * x[:, 1], x)
    assert found.share.tolist() == [0.0, 0.0]
    assert found.left == pytest.approx(1.0)
    assert found.interval[:, 0].tolist() == [0.0, 0.0]


def test_intervals_hold_the_share_nineteen_times_in_twenty() -> None:
    """32 runs of y = x₁ + x₂ + noise, each of variance 1: a third each; 300 times."""
    rng = np.random.default_rng(2)
    inside = 0
    for _ in range(300):
        x = rng.standard_normal((32, 2))
        low, high = variance_shares(x.sum(axis=1) + rng.standard_normal(32), x).interval[0]
        inside += low <= 1 / 3 <= high
    assert inside >= 276  # of 300 with 95 %: 276 or more in 99 of 100 such tests


def test_an_output_that_does_not_vary_has_no_shares() -> None:
    found = variance_shares(np.ones(5), np.random.default_rng(3).random((5, 2)))
    assert (found.share.tolist(), found.left) == ([0.0, 0.0], 0.0)


def test_an_input_that_does_not_vary_is_refused() -> None:
    with pytest.raises(FitError):
        variance_shares([1.0, 2.0, 4.0], [[1.0], [1.0], [1.0]])
