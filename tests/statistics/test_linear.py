"""Linear fits against certified data, rational arithmetic and hand calculation."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import FitError, FitWarning, ParameterError
from skisnow.statistics import linear_fit, variance_shares
from skisnow.statistics.linear import cluster_intervals

NINE = 9.0  # digits asked for; the certified values have fifteen


def test_longley(table: Callable[[str], list[list[str]]], digits: Callable[..., float]) -> None:
    data = np.array([[float(cell) for cell in row[1:]] for row in table("longley_statsmodels.csv")[1:]])
    fit = linear_fit(data[:, 0], data[:, 1:])
    certified = np.array([[float(cell) for cell in row[1:]] for row in table("Longley_certified.csv")[1:]])
    anova = {row[0]: float(row[1]) for row in table("Longley_certified_anova.csv")[1:]}
    assert digits(fit.coefficients, certified[:, 0]) >= NINE
    assert digits(fit.standard_errors, certified[:, 1]) >= NINE
    assert digits(fit.rmse_dof, anova["residual_standard_deviation"]) >= NINE
    assert digits(fit.r2, anova["r_squared"]) >= NINE
    assert digits(fit.F, anova["f_statistic"]) >= NINE


def test_line_by_hand() -> None:
    # x = 0 1 2 3, y = 1 2 4 4: b1 = 11/10, b0 = 11/10, SSE = 7/10, SST = 27/4
    fit = linear_fit([1.0, 2.0, 4.0, 4.0], [0.0, 1.0, 2.0, 3.0])
    np.testing.assert_allclose(fit.coefficients, [1.1, 1.1], rtol=1e-14)
    np.testing.assert_allclose(fit.residuals, [-0.1, -0.2, 0.7, -0.4], atol=1e-14)
    np.testing.assert_allclose([fit.sse, fit.rmse**2, fit.rmse_dof**2], [0.7, 0.175, 0.35], rtol=1e-13)
    # Sxx = 5: var b1 = 0.35/5, var b0 = 0.35 (1/4 + 1.5²/5), cov = -0.35·1.5/5
    # t(0.975; 2) is elementary: c √(2/(1 - c²)), c = 0.95
    half = 0.95 * np.sqrt(2 / (1 - 0.95**2)) * np.sqrt([0.245, 0.07])
    np.testing.assert_allclose(fit.intervals, np.stack((1.1 - half, 1.1 + half), axis=1), rtol=1e-12)
    np.testing.assert_allclose([fit.r2, fit.F], [1 - 0.7 / 6.75, 6.05 / 0.35], rtol=1e-13)
    # with one slope F is its t squared; the t distribution with 2 degrees of freedom is elementary
    t = np.sqrt(fit.F)
    np.testing.assert_allclose(fit.p, 1 - t / np.sqrt(2 + t * t), rtol=1e-12)
    assert (fit.n, fit.n_parameters) == (4, 2)


def test_against_statsmodels_with_two_predictors() -> None:
    from statsmodels.regression.linear_model import OLS
    from statsmodels.tools.tools import add_constant

    rng = np.random.default_rng(7)
    X = rng.normal(size=(40, 2)) * [1.0, 300.0] + [5.0, 450.0]
    y = 0.05 + X @ [0.01, 2e-4] + 0.01 * rng.normal(size=40)
    fit, peer = linear_fit(y, X), OLS(y, add_constant(X)).fit()
    np.testing.assert_allclose(fit.coefficients, peer.params, rtol=1e-9)  # the peer works on raw columns
    np.testing.assert_allclose(fit.standard_errors, peer.bse, rtol=1e-9)
    np.testing.assert_allclose(fit.intervals, peer.conf_int(alpha=0.05), rtol=1e-8)
    np.testing.assert_allclose([fit.r2, fit.F, fit.p], [peer.rsquared, peer.fvalue, peer.f_pvalue], rtol=1e-8)


def test_as_many_coefficients_as_observations_and_mean_alone_and_perfect_and_constant_responses() -> None:
    fit = linear_fit([1.0, 3.0], [0.0, 2.0])
    np.testing.assert_allclose(fit.coefficients, [1.0, 1.0], rtol=1e-14)
    assert np.isnan(fit.intervals).all()
    assert np.isnan(fit.standard_errors).all()
    assert np.isnan([fit.rmse_dof, fit.F, fit.p]).all()
    assert fit.sse < 1e-28
    fit = linear_fit([1.0, 2.0, 6.0], np.empty((3, 0)))
    assert fit.coefficients.tolist() == [3.0]
    np.testing.assert_allclose(fit.standard_errors[0] ** 2, 7 / 3, rtol=1e-14)
    assert np.isnan([fit.F, fit.p]).all()
    perfect = linear_fit([1.0, 2.0, 3.0], [0.0, 1.0, 2.0])
    assert perfect.r2 == 1.0
    assert perfect.p < 1e-10
    still = linear_fit([0.3, 0.1 + 0.2, 0.3, 0.3], [0.0, 1.0, 2.0, 4.0])
    np.testing.assert_allclose(still.coefficients, [0.3, 0.0], atol=1e-15)
    assert np.isnan([still.r2, still.F, still.p]).all()


@pytest.mark.parametrize(
    ("predictors", "message"),
    [
        ([[0.1], [0.1], [0.1], [0.1]], coded("rank_deficient", rank=1)),
        ([[0.3], [0.1 + 0.2], [0.3], [0.3]], coded("rank_deficient", rank=1)),
        ([[1.0, 10.3], [2.0, 20.3], [4.0, 40.3], [5.0, 50.3]], coded("rank_deficient", rank=2, count=3)),
        (np.eye(4), coded("too_few_data", n=4, p=5)),
    ],
)
def test_undetermined_coefficients_are_an_error(predictors: npt.ArrayLike, message: str | Coded) -> None:
    with raises(FitError, message):
        linear_fit([1.0, 2.0, 2.5, 4.0], predictors)


def test_bad_input_is_named() -> None:
    with raises(ParameterError, "not_a_number", name="predictors"):
        linear_fit([1.0, 2.0, 3.0], [1.0, float("nan"), 2.0])
    with raises(ParameterError, "not_a_number", name="response", value=float("inf")):
        linear_fit([1.0, 2.0, float("inf")], [1.0, 4.0, 2.0])
    nothings: list[npt.ArrayLike] = [[], 3.0]
    for nothing in nothings:
        with raises(ParameterError, "wrong_shape"):
            linear_fit(nothing, [])
    with raises(ParameterError, "wrong_shape"):
        linear_fit([1.0, 2.0, 3.0], [1.0, 2.0])


def filip_like() -> tuple[FloatArray, FloatArray]:
    """Powers 1 to 10 of 82 points on -9 … -3, the layout of NIST's Filip."""
    rng = np.random.default_rng(20130)
    x = np.round(rng.uniform(-9.0, -3.0, 82), 6)
    return np.sin(x), np.stack([x**j for j in range(1, 11)], axis=1)


def wampler5() -> tuple[FloatArray, FloatArray]:
    """NIST's Wampler5: 1 + x + … + x⁵ on 0 … 20 plus 100,000 times the deviations of Wampler4 over 100."""
    x = np.arange(21.0)
    delta = [759, -2048, 2048, -2048, 2523, -2048, 2048, -2048, 1838, -2048, 2048]
    deviation = np.array([*delta, *delta[-2::-1]], dtype=float)
    return sum(x**j for j in range(6)) + 100.0 * deviation, np.stack([x**j for j in range(1, 6)], axis=1)


@pytest.mark.parametrize("data", [filip_like, wampler5])
def test_each_linear_regression_warns_by_condition_number(data: Callable[[], tuple[FloatArray, FloatArray]]) -> None:
    y, X = data()
    regressions: tuple[Callable[[], object], ...] = (
        lambda: linear_fit(y, X),
        lambda: cluster_intervals(y, X, np.arange(len(y)) % 3),
    )
    for fit in regressions:
        with pytest.warns(FitWarning, match="condition number"):
            fit()


def test_wampler5_has_the_coefficients_of_its_design_to_the_digits_that_are_left(digits: Callable[..., float]) -> None:
    """All six certified coefficients are 1, the residual standard deviation is 0.2369 million."""
    y, X = wampler5()
    with pytest.warns(FitWarning):
        fit = linear_fit(y, X)
    assert digits(fit.coefficients, np.ones(6)) > 6.0
    assert fit.rmse_dof == pytest.approx(236_014.502, rel=1e-6)


# Shares of variance where they are known: sums of independent inputs, an input without effect, an interplay


def test_a_weighted_sum_has_the_shares_of_its_squared_weights() -> None:
    """y = 3 x₁ - 2 x₂ + noise of variance 3, x of variance 1: 9/16, 4/16, 0 and 3/16 left; a correlation of two of
    the columns, drawn independently, moves a share by 2 · 3 · 2/16/√n."""
    rng = np.random.default_rng(1)
    x = rng.standard_normal((4000, 3))
    y = x @ [3.0, -2.0, 0.0] + np.sqrt(3.0) * rng.standard_normal(4000)
    found = variance_shares(y, x)
    assert found.share == pytest.approx([9 / 16, 4 / 16, 0.0], abs=0.03)
    assert found.left == pytest.approx(3 / 16, abs=0.02)
    assert found.interval[:2, 0] == pytest.approx([9 / 16, 4 / 16], abs=0.06)
    assert np.all(found.interval[:, 0] <= found.share)
    assert np.all(found.share <= found.interval[:, 1])
    for unit in (1e-3, 1e3):
        np.testing.assert_allclose(variance_shares(unit * y, x).interval, found.interval, rtol=1e-9, atol=1e-15)


def test_interval_of_a_share_ends_at_one() -> None:
    """Four points, slope 0.95 ± 2.01: 2.96 at most has more than the variance of y, and 0 is inside."""
    found = variance_shares([0.0, 2.0, 1.0, 3.5], [[0.0], [1.0], [2.0], [3.0]])
    assert found.interval.tolist() == [[0.0, 1.0]]


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


def test_an_output_that_does_not_vary_has_no_shares_and_an_input_that_does_not_vary_is_rejected() -> None:
    found = variance_shares(np.ones(5), np.random.default_rng(3).random((5, 2)))
    assert (found.share.tolist(), found.left) == ([0.0, 0.0], 0.0)
    with pytest.raises(FitError):
        variance_shares([1.0, 2.0, 4.0], [[1.0], [1.0], [1.0]])
