"""Effective degrees of freedom and expanded factors."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skisnow._support.errors import ParameterError
from skisnow.statistics import expanded_factor, welch_satterthwaite

from ..versions import EXACT_QUANTILES


def test_equal_contributions_add_their_degrees() -> None:
    # u⁴-weights equal: (k u²)²/(k u⁴/ν) = k ν
    assert float(welch_satterthwaite([4.0, 4.0, 4.0], 5.0)) == pytest.approx(15.0)


def test_known_contributions_raise_the_degrees() -> None:
    # half the variance known: (2)²/(1/ν) = 4 ν
    assert float(welch_satterthwaite([1.0, 1.0], [6.0, np.inf])) == pytest.approx(24.0)
    assert float(welch_satterthwaite([1.0, 2.0], np.inf)) == np.inf


def test_leading_axes_and_edges() -> None:
    variances = np.array([[1.0, 0.0], [0.0, 0.0], [1.0, 1.0], [1.0, np.nan], [1.0, -1.0], [1.0, 1.0]])
    dof = np.array([[3.0, 0.0], [3.0, 3.0], [0.0, 9.0], [3.0, 3.0], [3.0, 3.0], [3.0, np.nan]])
    found = welch_satterthwaite(variances, dof)
    np.testing.assert_array_equal(found, [3.0, np.inf, 0.0, np.nan, np.nan, np.nan])


def test_tiny_and_huge_units_do_not_matter() -> None:
    for unit in (1e-200, 1e200):
        assert float(welch_satterthwaite([1.0 * unit, 3.0 * unit], [2.0, 8.0])) == pytest.approx(16 / (1 / 2 + 9 / 8))


@given(
    st.lists(st.tuples(st.floats(1e-3, 1e3), st.floats(1.0, 100.0)), min_size=1, max_size=5),
)
def test_between_the_least_and_the_sum(parts: list[tuple[float, float]]) -> None:
    variances, dof = np.array(parts).T
    found = float(welch_satterthwaite(variances, dof))
    assert dof.min() * (1 - 1e-12) <= found <= dof.sum() * (1 + 1e-12)


@EXACT_QUANTILES
def test_expanded_factors_of_elementary_distributions() -> None:
    # t with 1 degree: tan(π c/2); with 2: c √(2/(1 - c²)); the limit: normal
    c = 0.9545
    found = expanded_factor([1.0, 2.0, np.inf], c)
    expected = [np.tan(np.pi * c / 2), c * np.sqrt(2 / (1 - c * c)), 2.0000024438996027]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_table_g2_of_the_gum() -> None:
    # columns 95 % and 99 % of its table of t, printed to two decimals
    table = {1: (12.71, 63.66), 5: (2.57, 4.03), 16: (2.12, 2.92), 50: (2.01, 2.68)}
    for dof, printed in table.items():
        np.testing.assert_allclose([expanded_factor(dof, 0.95), expanded_factor(dof, 0.99)], printed, atol=0.005)


def test_unknown_scatter_has_no_factor() -> None:
    assert np.isnan(expanded_factor([0.0, -1.0, np.nan], 0.95)).all()
    for confidence in (0.0, 1.0, 95.0, float("nan")):
        with pytest.raises(ParameterError, match="confidence"):
            expanded_factor(3.0, confidence)
