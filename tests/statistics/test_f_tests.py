"""F tests and combined uncertainty."""

import math

import numpy as np
import pytest
from scipy import integrate, stats
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.statistics import expanded_factor, nested_f_test, welch_satterthwaite
from skisnow.statistics.combined_uncertainty import percentile_interval, random_effects_mean, resampling_counts
from skisnow.statistics.f_tests import _power
from skisnow.statistics.shot_noise import shot_noise, windows_of

from ..versions import EXACT_QUANTILES


def test_against_statsmodels_and_two_numerator_degrees_of_freedom_have_an_elementary_p() -> None:
    from statsmodels.regression.linear_model import OLS

    rng = np.random.default_rng(2)
    X = rng.normal(size=(50, 4))  # no intercept, as Eqn 6 has none
    y = X @ [1.0, 0.5, 0.1, 0.0] + rng.normal(size=50)
    full, reduced = OLS(y, X).fit(), OLS(y, X[:, :2]).fit()
    F, p, df1 = full.compare_f_test(reduced)
    test = nested_f_test(full.ssr, reduced.ssr, n=50, n_parameters_full=4, n_parameters_reduced=2)
    np.testing.assert_allclose([test.F, test.p, test.df1, test.df2], [F, p, df1, 46], rtol=1e-12)
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


def test_leading_axes_and_edges() -> None:
    variances = np.array([[1.0, 0.0], [0.0, 0.0], [1.0, 1.0], [1.0, np.nan], [1.0, -1.0], [1.0, 1.0]])
    dof = np.array([[3.0, 0.0], [3.0, 3.0], [0.0, 9.0], [3.0, 3.0], [3.0, 3.0], [3.0, np.nan]])
    found = welch_satterthwaite(variances, dof)
    np.testing.assert_array_equal(found, [3.0, np.inf, 0.0, np.nan, np.nan, np.nan])


def test_tiny_and_huge_units_do_not_matter() -> None:
    for unit in (1e-200, 1e200):
        assert float(welch_satterthwaite([1.0 * unit, 3.0 * unit], [2.0, 8.0])) == pytest.approx(16 / (1 / 2 + 9 / 8))


@EXACT_QUANTILES
def test_closed_expanded_factors() -> None:
    # t with 1 degree: tan(π c/2); with 2: c √(2/(1 - c²)); the limit: normal
    c = 0.9545
    found = expanded_factor([1.0, 2.0, np.inf], c)
    expected = [np.tan(np.pi * c / 2), c * np.sqrt(2 / (1 - c * c)), 2.0000024438996027]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_unknown_scatter_has_no_factor() -> None:
    assert np.isnan(expanded_factor([0.0, -1.0, np.nan], 0.95)).all()
    for confidence in (0.0, 1.0, 95.0, float("nan")):
        with raises(ParameterError, "out_of_range"):
            expanded_factor(3.0, confidence)


LOG_RISK_RATIO = (
    *(-0.8893, -1.5854, -1.3481, -1.4416, -0.2175, -0.7861, -1.6209),
    *(0.0120, -0.4694, -1.3713, -0.3394, 0.4459, -0.0173),
)
VARIANCE = (0.3256, 0.1946, 0.4154, 0.0200, 0.0512, 0.0069, 0.2230, 0.0040, 0.0564, 0.0730, 0.0124, 0.5325, 0.0714)


def test_the_spread_is_that_of_another_program() -> None:
    """Thirteen trials of a vaccine (Colditz and others 1994, JAMA 271, 698-702); R's metafor, method PM: τ² 0.3181."""
    found = random_effects_mean(LOG_RISK_RATIO, np.sqrt(VARIANCE))
    assert found.spread**2 == pytest.approx(0.3181, abs=5e-5)
    assert found.mean == pytest.approx(-0.7150, abs=5e-5)


def test_equal_errors_leave_the_plain_t_interval() -> None:
    x = np.random.default_rng(1).normal(5.0, 2.0, 9)
    found = random_effects_mean(x, np.full(9, 0.3))
    half = float(expanded_factor(8.0, 0.95)) * x.std(ddof=1) / 3.0
    assert (found.mean, found.low, found.high) == pytest.approx((x.mean(), x.mean() - half, x.mean() + half))
    assert found.spread**2 == pytest.approx(x.var(ddof=1) - 0.3**2)


def test_estimates_that_agree_better_than_their_errors_have_no_spread() -> None:
    """(1.5²/2)/(1 + τ²) = 1 gives the least spread that is one."""
    assert random_effects_mean([1.0, 1.1, 0.9], [1.0, 1.0, 1.0]).spread == 0.0
    assert random_effects_mean([0.0, 1.5], [1.0, 1.0]).spread ** 2 == pytest.approx(0.125)


def test_one_estimate_has_no_interval_and_exact_estimates_do_not_divide_by_zero() -> None:
    found = random_effects_mean([3.0], [0.1])
    assert found.mean == 3.0
    assert np.isnan([found.low, found.high]).all()
    found = random_effects_mean([2.0, 2.0, 2.0], [0.0, 0.0, 0.0])
    assert (found.mean, found.low, found.high) == pytest.approx((2.0, 2.0, 2.0))
    assert random_effects_mean([0.0, 0.0], [0.0, 0.0]).mean == 0.0


@pytest.mark.parametrize(("spread", "least", "most"), [(0.0, 0.95, 1.0), (1.0, 0.91, 0.96), (3.0, 0.92, 0.97)])
def test_coverage(spread: float, least: float, most: float) -> None:
    """Over eight estimates whose errors differ up to five times 92 to 99 % of 500 intervals hold the mean (± 3 %)."""
    rng = np.random.default_rng(2)
    errors = np.linspace(0.3, 1.5, 8)
    draws = 4.0 + np.hypot(spread, errors) * rng.standard_normal((500, 8))
    found = [random_effects_mean(x, errors) for x in draws]
    assert least < np.mean([each.low <= 4.0 <= each.high for each in found]) <= most


@pytest.mark.parametrize(
    ("n", "alpha", "shift"),
    [(2, 1e-3, 31.0), (2, 0.05, 8.2), (5, 0.05, 3.0), (5, 0.05, 40.1), (30, 1e-3, 5.3), (100, 0.05, 38.8),
     (30, 1e-6, 4.1), (30, 1e-5, 4.4), (1000, 1e-9, 3.2), (10**6, 1e-4, 3.0)],
)  # fmt: skip
def test_power_is_that_of_an_integral_also_where_scipy_has_no_number(n: int, alpha: float, shift: float) -> None:
    """The normal power for each scatter that is drawn, over the distribution of drawn scatters."""
    freedom = 2.0 * n - 2.0
    critical = stats.t.isf(alpha / 2.0, freedom)
    drawn = stats.chi(freedom, scale=1.0 / math.sqrt(freedom))

    def missed(scatter: float) -> float:
        inside = np.asarray(stats.norm.cdf([critical * scatter - shift, -critical * scatter - shift]))
        return float((inside[0] - inside[1]) * drawn.pdf(scatter))

    expected = 1.0 - integrate.quad(missed, 0.0, drawn.isf(1e-14), epsabs=1e-9, limit=200)[0]
    assert _power(n, shift / math.sqrt(n / 2.0), alpha) == pytest.approx(expected, abs=1e-6)


def test_percentile_interval() -> None:
    """Linear between order statistics; an unknown sample is below the low end and above the high one."""
    samples = np.stack((np.arange(101.0), 1000.0 - 2.0 * np.arange(101.0)), axis=1)
    assert percentile_interval(samples, confidence=0.9) == pytest.approx(np.array([[5.0, 95.0], [810.0, 990.0]]))
    samples[3, 0] = np.nan  # 0, 1, 2, 4, 5, ...: the fifth known number from below, the sixth from above
    assert percentile_interval(samples, confidence=0.9)[0] == pytest.approx([5.0, 96.0])
    samples[:6, 1] = np.nan
    low, high = percentile_interval(samples, confidence=0.9).T
    assert np.isfinite([low[0], high[0]]).all()
    assert np.isnan([low[1], high[1]]).all()
    for shape in ((0,), (0, 3), (0, 2, 4)):
        none = percentile_interval(np.zeros(shape))
        assert none.shape == (*shape[1:], 2)
        assert np.isnan(none).all()
    with raises(ParameterError, "wrong_shape"):
        percentile_interval(1.0)
    for confidence in (-0.5, 0.0, 1.0, 1.5):
        with raises(ParameterError, "out_of_range"):
            percentile_interval(samples, confidence=confidence)


def test_resamples_come_in_pieces_of_some_megabytes_and_are_those_of_one_draw() -> None:
    pieces = list(resampling_counts(1000, 600, np.random.default_rng(5)))
    assert 1e6 < pieces[0].nbytes < 1e7
    drawn = np.random.default_rng(5).integers(0, 1000, size=(600, 1000))
    expected = np.stack([np.bincount(row, minlength=1000) for row in drawn])
    np.testing.assert_array_equal(np.vstack(pieces), expected)
    for units, resamples in ((0, 3), (3, -1)):
        with raises(ParameterError, "out_of_range"):
            list(resampling_counts(units, resamples, np.random.default_rng(5)))


def test_shot_noise_by_hand() -> None:
    """Mean 2 and variance 1 of 3, 1, 3, 1; ten times the force; no noise where the mean is below 0 or all is equal."""
    force = np.array([[3.0, 1.0, 3.0, 1.0], [30.0, 10.0, 30.0, 10.0], [-3.0, -1.0, -3.0, -1.0], [2.0, 2.0, 2.0, 2.0]])
    found, deflection = shot_noise(force, 1e-3), 1.5e-3 * 3.2 / (3.2 + 2.4)
    none = [np.nan, np.nan]
    np.testing.assert_allclose(found.rupture_force, [0.75, 7.5, *none], rtol=1e-12)
    np.testing.assert_allclose(found.deflection, [deflection, deflection, *none], rtol=1e-12)
    np.testing.assert_allclose(found.intensity, [16.0 / 3.0 / deflection] * 2 + none, rtol=1e-12)
    assert windows_of(np.arange(6.0), 3, 2).tolist() == [[0.0, 1.0, 2.0], [2.0, 3.0, 4.0]]
    assert [windows_of(np.arange(6.0), size, 1).shape for size in (6, 7)] == [(1, 6), (0, 7)]
