"""Nested F test: statsmodels, the values that follow from the paper's printed rmse, and the undefined cases."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.statistics import nested_f_test, one_way_anova

READINGS = 1652  # 236 series of 7 loads


def test_against_statsmodels() -> None:
    from statsmodels.api import OLS

    rng = np.random.default_rng(2)
    X = rng.normal(size=(50, 4))  # no intercept, as Eqn 6 has none
    y = X @ [1.0, 0.5, 0.1, 0.0] + rng.normal(size=50)
    full, reduced = OLS(y, X).fit(), OLS(y, X[:, :2]).fit()
    F, p, df1 = full.compare_f_test(reduced)
    test = nested_f_test(full.ssr, reduced.ssr, n=50, n_parameters_full=4, n_parameters_reduced=2)
    np.testing.assert_allclose([test.F, test.p, test.df1, test.df2], [F, p, df1, 46], rtol=1e-12)


def from_rmse(full: float, reduced: float, p_full: int, p_reduced: int) -> float:
    sums = READINGS * full**2, READINGS * reduced**2  # rmse over n
    test = nested_f_test(*sums, n=READINGS, n_parameters_full=p_full, n_parameters_reduced=p_reduced)
    assert (test.df1, test.df2) == (p_full - p_reduced, READINGS - p_full)
    return test.F


def test_values_that_follow_from_the_printed_rmse() -> None:
    # (Mössner and others 2013) H_V with linear a and b 53.6 N, with linear b alone 53.8, constant b 54.9, b = 1 56.1
    assert from_rmse(53.6, 53.8, 4, 2) == pytest.approx(6.2, abs=0.05)
    assert from_rmse(53.8, 54.9, 2, 1) == pytest.approx(68, abs=0.5)
    assert from_rmse(53.8, 56.1, 2, 0) == pytest.approx(72, abs=0.5)
    # printed to 0.1 N: what the rounding leaves open
    assert from_rmse(53.65, 53.75, 4, 2) == pytest.approx(3.1, abs=0.05)
    assert from_rmse(53.55, 53.85, 4, 2) == pytest.approx(9.3, abs=0.05)


def test_all_those_simpler_models_are_rejected() -> None:
    for full, reduced, p_full, p_reduced in ((53.6, 53.8, 4, 2), (53.8, 54.9, 2, 1), (53.8, 56.1, 2, 0)):
        test = nested_f_test(
            full**2 * READINGS,
            reduced**2 * READINGS,
            n=READINGS,
            n_parameters_full=p_full,
            n_parameters_reduced=p_reduced,
        )
        assert test.p < 0.01


def test_two_numerator_degrees_of_freedom_have_an_elementary_p() -> None:
    # P(F(2, m) > F) = (1 + 2 F/m)^(-m/2)
    test = nested_f_test(10.0, 14.0, n=24, n_parameters_full=4, n_parameters_reduced=2)
    np.testing.assert_allclose(test.F, 4.0, rtol=1e-14)
    assert test.p == pytest.approx((1 + 8 / 20) ** -10, rel=1e-12)


@pytest.mark.parametrize(("n", "p_full", "p_reduced"), [(10, 2, 2), (4, 4, 2), (3, 4, 2)])
def test_undefined_tests_are_nan(n: int, p_full: int, p_reduced: int) -> None:
    test = nested_f_test(1.0, 2.0, n=n, n_parameters_full=p_full, n_parameters_reduced=p_reduced)
    assert np.isnan([test.F, test.p]).all()
    assert (test.df1, test.df2) == (p_full - p_reduced, n - p_full)


def test_perfect_fits() -> None:
    found = nested_f_test(0.0, 1.0, n=9, n_parameters_full=2, n_parameters_reduced=1)
    assert (found.F, found.p) == (float("inf"), 0.0)
    both = nested_f_test(0.0, 0.0, n=9, n_parameters_full=2, n_parameters_reduced=1)
    assert np.isnan([both.F, both.p]).all()


def test_rounding_below_zero_counts_as_equal() -> None:
    found = nested_f_test(1.0, 1.0 - 1e-15, n=9, n_parameters_full=2, n_parameters_reduced=1)
    assert (found.F, found.p) == (0.0, 1.0)


def test_swapped_models_are_an_error() -> None:
    with raises(ParameterError, "contradiction"):
        nested_f_test(2.0, 1.0, n=9, n_parameters_full=1, n_parameters_reduced=2)
    with raises(ParameterError, "out_of_range"):
        nested_f_test(-2.0, 1.0, n=9, n_parameters_full=2, n_parameters_reduced=1)


def test_silicon_resistivity(nist: Callable[[str], Any], digits: Callable[..., float]) -> None:
    file = nist("SiRstv")
    instrument, resistance = file.data.T
    found = one_way_anova([resistance[instrument == k] for k in range(1, 6)])
    df_between, ss_between, _, F = file.numbers_after("Between Instrument")
    df_within, ss_within, _ = file.numbers_after("Within Instrument")
    assert (found.df_between, found.df_within) == (df_between, df_within)
    assert digits([found.ss_between, found.ss_within, found.F], [ss_between, ss_within, F]) >= 9
    assert digits(found.r2, file.numbers_after("Certified R-Squared")) >= 9
    assert digits(found.residual_sd, file.numbers_after("Standard Deviation")) >= 9


def test_p_and_unequal_groups_against_scipy() -> None:
    from scipy.stats import f_oneway

    rng = np.random.default_rng(1)
    groups = [rng.normal(mean, 1.0, size) for mean, size in ((0.0, 3), (0.5, 8), (1.0, 5))]
    peer = f_oneway(*groups)
    found = one_way_anova(groups)
    np.testing.assert_allclose([found.F, found.p], [peer.statistic, peer.pvalue], rtol=1e-11)


def test_common_digits_cost_nothing(digits: Callable[..., float]) -> None:
    groups = np.array([[0.25, 0.5, 1.0], [0.75, 1.25, 0.5]])
    assert digits(one_way_anova(list(groups + 2.0**30)).F, one_way_anova(list(groups)).F) > 14


def test_undefined() -> None:
    assert np.isnan([one_way_anova([[1.0, 2.0]]).F, one_way_anova([[1.0], [2.0]]).p]).all()
    for groups in ([], [[1.0], []], [[1.0, float("nan")], [2.0]]):
        with pytest.raises(ParameterError):
            one_way_anova(groups)


def test_a_value_that_is_no_number_is_told_with_its_group() -> None:
    with raises(ParameterError, "not_a_number", name="group 2"):
        one_way_anova([[1.0, 2.0], [3.0, float("nan")], [4.0]])
