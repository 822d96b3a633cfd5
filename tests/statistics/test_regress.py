"""Regression of tables and resampling."""

import warnings
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from tests.coded import warns

from skisnow._support.errors import FitError, FitWarning, ParameterError
from skisnow.statistics import linear_fit, percentile_interval, regress, resampling_counts
from skisnow.statistics.shot_noise import shot_noise, windows_of

from ..versions import EXACT_QUANTILES

X1, X2, Y = [1, 2, 3, 3], [1, 3, 2, 5], [7, 15, 12, 20]
T9 = 2.2621571627982  # t(0.975; 9)
DESIGN = np.column_stack(([1] * 4, X1, X2)).astype(float)


def test_the_published_vector_exactly() -> None:
    # printed: b 3.8333, 0.8333, 2.8333; R² 0.98315, F 29.1667, p 0.12982, variance 1.5
    # b = (23, 5, 17)/6 is the answer because its residuals are orthogonal to all three columns
    b = [Fraction(23, 6), Fraction(5, 6), Fraction(17, 6)]
    residual = [y - (b[0] + b[1] * u + b[2] * v) for u, v, y in zip(X1, X2, Y, strict=True)]
    for column in ([1] * 4, X1, X2):
        assert sum(c * e for c, e in zip(column, residual, strict=True)) == 0
    sse = sum((e * e for e in residual), Fraction(0))
    sst = sum(Fraction(y) ** 2 for y in Y) - Fraction(sum(Y)) ** 2 / 4
    F = (sst - sse) / 2 / sse
    found = regress(Y, DESIGN)
    np.testing.assert_allclose(found.b, [float(c) for c in b], rtol=1e-13)
    np.testing.assert_allclose(found.r, [float(e) for e in residual], atol=1e-13)
    # F with (2, 1) degrees of freedom: P(> F) = 1/√(1 + 2 F)
    expected = [float(1 - sse / sst), float(F), 1 / np.sqrt(1 + 2 * float(F)), float(sse)]
    np.testing.assert_allclose(found.stats, expected, rtol=1e-12)
    # t(0.975; 1) = tan(0.475 π); the diagonal of (XᵀX)^-1 in rational arithmetic: (113, 35, 11)/54
    half = np.tan(0.475 * np.pi) * np.sqrt(1.5 * np.array([113, 35, 11]) / 54)
    np.testing.assert_allclose(found.bint, np.column_stack((found.b - half, found.b + half)), rtol=1e-10)


def test_the_place_of_the_ones_and_alpha_do_as_in_matlab() -> None:
    first, last = regress(Y, DESIGN, 0.1), regress(np.array(Y)[:, None], DESIGN[:, [1, 2, 0]], 0.1)
    np.testing.assert_allclose(last.b, first.b[[1, 2, 0]], rtol=1e-12)
    np.testing.assert_allclose(last.bint, first.bint[[1, 2, 0]], rtol=1e-12)
    wide = regress(Y, DESIGN, 0.05)
    ratio = np.diff(wide.bint) / np.diff(first.bint)
    np.testing.assert_allclose(ratio, np.tan(0.475 * np.pi) / np.tan(0.45 * np.pi), rtol=1e-10)


@EXACT_QUANTILES
def test_residual_intervals_come_from_the_fit_without_the_observation() -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(0, 1, 12)
    y = 2 + x + 0.1 * rng.normal(size=12)
    found = regress(y, np.column_stack((np.ones(12), x)))
    h = 1 / 12 + (x - x.mean()) ** 2 / np.sum((x - x.mean()) ** 2)
    for i in range(12):
        rest = np.arange(12) != i
        s = linear_fit(y[rest], x[rest]).rmse_dof
        half = T9 * s * np.sqrt(1 - h[i])
        np.testing.assert_allclose(found.rint[i], [found.r[i] - half, found.r[i] + half], rtol=1e-9)


def test_rows_with_nan_take_no_part() -> None:
    y = [7, 15, float("nan"), 12, 20, 9]
    X = np.vstack((DESIGN[:2], [1, 9, 9], DESIGN[2:], [1, float("nan"), 2]))
    found, plain = regress(y, X), regress(Y, DESIGN)
    np.testing.assert_allclose(found.b, plain.b, rtol=1e-13)
    np.testing.assert_allclose(found.stats, plain.stats, rtol=1e-13)
    assert np.flatnonzero(np.isnan(found.r)).tolist() == [2, 5]
    np.testing.assert_allclose(found.r[[0, 1, 3, 4]], plain.r, atol=1e-13)
    assert np.isnan(found.rint[[2, 5]]).all()


def test_no_constant_is_warned_of_and_an_implied_one_is_not() -> None:
    with warns(FitWarning, "no_constant_column"):
        found = regress([1.0, 2.0, 2.0], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(found.b, [11 / 14], rtol=1e-13)
    # R² = 1 - SSE/SST is what MATLAB gives there: SSE = 9 - 121/14, SST = 2/3
    np.testing.assert_allclose(found.stats.r2, 1 - (9 - 121 / 14) / (2 / 3), rtol=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        groups = regress([1.0, 3.0, 4.0, 6.0], [[1, 0], [1, 0], [0, 1], [0, 1]])
    np.testing.assert_allclose(groups.b, [2, 5], rtol=1e-13)
    np.testing.assert_allclose(groups.stats.F, 4.5, rtol=1e-12)  # the analysis of variance of the two groups


def test_dependent_columns_get_zero_with_a_warning_and_of_two_columns_of_ones_the_first_counts() -> None:
    X = np.column_stack((DESIGN[:, :2], 2 * DESIGN[:, 1]))
    with warns(FitWarning, "rank_deficient", rank=2):
        found = regress(Y, X)
    plain = regress(Y, DESIGN[:, :2])
    assert np.sum(found.b == 0) == 1
    np.testing.assert_allclose(Y - X @ found.b, plain.r, atol=1e-12)
    np.testing.assert_allclose(found.stats, plain.stats, rtol=1e-10)
    # The design of `test_the_published_vector_exactly` with ones on both sides: the same b, and 0 for the rest.
    with warns(FitWarning, "rank_deficient", count=4, rank=3):
        found = regress(Y, np.column_stack((DESIGN, np.ones(4))))
    np.testing.assert_allclose(found.b, [23 / 6, 5 / 6, 17 / 6, 0.0], rtol=1e-12, atol=1e-12)


def test_nothing_left_to_judge_by_and_the_constant_alone() -> None:
    found = regress([1.0, 3.0], [[1, 0], [1, 2]])
    np.testing.assert_allclose(found.b, [1, 1], rtol=1e-13)
    assert np.isnan(found.bint).all()
    assert np.isnan(found.rint).all()
    assert np.isnan(found.stats[1:]).all()
    found = regress([1.0, 2.0, 6.0], [1.0, 1.0, 1.0])
    np.testing.assert_allclose(found.b, [3.0], rtol=1e-14)
    assert found.stats.r2 == pytest.approx(0.0, abs=1e-15)
    assert np.isnan([found.stats.F, found.stats.p]).all()
    assert found.stats.error_variance == pytest.approx(7.0)


@pytest.mark.parametrize(
    ("y", "X", "error"),
    [
        ([1.0, 2.0], [[1.0], [1.0], [1.0]], ParameterError),
        ([1.0, float("inf")], [1.0, 1.0], ParameterError),
        ([float("nan")], [1.0], FitError),
        ([1.0, 2.0], [0.0, 0.0], FitError),
    ],
)
def test_bad_input(y: Any, X: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        regress(y, X)


@pytest.mark.parametrize("chunk", [1, 2, 7, 40, 1000])
@pytest.mark.parametrize("n_units", [1, 3, 236])
def test_counts_do_not_depend_on_the_chunk(n_units: int, chunk: int) -> None:
    whole = np.vstack(list(resampling_counts(n_units, 41, np.random.default_rng(9))))
    parts = list(resampling_counts(n_units, 41, np.random.default_rng(9), chunk=chunk))
    np.testing.assert_array_equal(np.vstack(parts), whole)
    assert max(len(part) for part in parts) <= chunk
    assert whole.shape == (41, n_units)
    assert whole.dtype == np.float64


def test_counts_are_multinomial_and_many_units_come_in_small_parts() -> None:
    n, B = 20, 40_000
    counts = np.vstack(list(resampling_counts(n, B, np.random.default_rng(4))))
    assert (counts.min(), set(counts.sum(axis=1))) == (0.0, {n})
    # mean 1, variance 1 - 1/n, covariance -1/n; five standard errors of each, about √(2/B)
    assert np.abs(counts.mean(axis=0) - 1).max() < 5 * np.sqrt(1 / B)
    covariance = np.cov(counts.T)
    assert np.abs(np.diag(covariance) - (1 - 1 / n)).max() < 5 * np.sqrt(3 / B)
    assert np.abs(covariance[~np.eye(n, dtype=bool)] + 1 / n).max() < 5 * np.sqrt(1 / B)
    # a unit is left out with probability (1 - 1/n)^n
    q = (1 - 1 / n) ** n
    assert abs(float(np.mean(counts == 0)) - q) < 5 * np.sqrt(q * (1 - q) / B)
    parts = resampling_counts(150_000, 3, np.random.default_rng(1))
    sizes = [part.nbytes for part in parts]
    assert sizes == [150_000 * 8] * 3


@pytest.mark.parametrize(("n_units", "n_resamples", "chunk"), [(0, 1, None), (1, -1, None), (1, 1, 0)])
def test_bad_sizes(n_units: int, n_resamples: int, chunk: int | None) -> None:
    with pytest.raises(ParameterError):
        resampling_counts(n_units, n_resamples, np.random.default_rng(1), chunk=chunk)


def test_percentiles_of_an_even_row_and_nan_is_not_forgotten() -> None:
    samples = np.random.default_rng(1).permutation(np.arange(1001.0))
    np.testing.assert_allclose(percentile_interval(samples), [25, 975], rtol=1e-13)
    shaped = percentile_interval(np.stack((samples, -2 * samples), axis=1)[:, None, :], confidence=0.8)
    np.testing.assert_allclose(shaped, [[[100, 900], [-1800, -200]]], rtol=1e-13)
    samples = np.ones((5, 2))
    samples[3, 1] = np.nan
    assert percentile_interval(samples)[0].tolist() == [1.0, 1.0]
    assert np.isnan(percentile_interval(samples)[1]).all()
    assert np.isnan(percentile_interval(np.empty((0, 3)))).all()
    few = np.append(np.arange(101.0), np.nan)  # it may be below or above all others: both ends are farther out
    np.testing.assert_allclose(percentile_interval(few, confidence=0.9), [4.05, 95.95], rtol=1e-13)
    with pytest.raises(ParameterError):
        percentile_interval(1.0)


# Shot noise whose parameters are known is drawn, and they are found again


STEP = 4e-6


def saw_teeth(force: float, deflection: float, intensity: float, length: float, seed: int) -> np.ndarray:
    """The sum of teeth that rise to ``force`` over ``deflection`` and begin at random places."""
    rng = np.random.default_rng(seed)
    place = np.arange(round(length / STEP)) * STEP
    found = np.zeros(len(place))
    for start in rng.uniform(-deflection, length, rng.poisson(intensity * (length + deflection))):
        first, last = np.searchsorted(place, (start, start + deflection))
        found[first:last] += force * (place[first:last] - start) / deflection
    return found


@pytest.mark.parametrize(("force", "deflection", "intensity"), [(0.02, 1e-4, 2e4), (0.05, 2e-4, 2e4)])
def test_parameters_of_drawn_shot_noise(force: float, deflection: float, intensity: float) -> None:
    """A window of 0.4 m with 8000 teeth; ten seeds scatter by 2 % in f₀ and δ and 4 % in λ about the true value."""
    found = shot_noise(saw_teeth(force, deflection, intensity, 0.4, seed=3), STEP)
    assert float(found.rupture_force) == pytest.approx(force, rel=0.05)
    assert float(found.deflection) == pytest.approx(deflection, rel=0.05)
    assert float(found.intensity) == pytest.approx(intensity, rel=0.1)


def test_force_and_length_have_their_scales_and_a_line_beneath_does_not_lengthen_the_deflection() -> None:
    """Twice the force: twice f₀ alone. Twice the distance between samples: twice δ, half λ."""
    drawn = saw_teeth(0.02, 1e-4, 4e5, 0.01, seed=1)
    one, stronger, longer = shot_noise(drawn, STEP), shot_noise(2 * drawn, STEP), shot_noise(drawn, 2 * STEP)
    np.testing.assert_allclose(
        [stronger.rupture_force / one.rupture_force, stronger.deflection / one.deflection], [2, 1]
    )
    np.testing.assert_allclose([longer.deflection / one.deflection, longer.intensity / one.intensity], [2, 0.5])
    # A layer that grows harder: without the line taken off, δ would be several times as long.
    slope = np.linspace(0.0, 5.0, len(drawn))
    np.testing.assert_allclose(shot_noise(drawn + slope, STEP).deflection, shot_noise(drawn, STEP).deflection)


def test_what_says_nothing_is_nan() -> None:
    flat, below, alternating = np.ones(50), -np.ones(50) + np.arange(50) % 2 / 10, np.zeros(50)
    found = shot_noise(np.stack([flat, below, alternating]), STEP)
    for each in (found.rupture_force, found.deflection, found.intensity):
        assert np.isnan(each).all()


def test_windows_are_whole_and_overlap() -> None:
    assert windows_of(np.arange(7.0), 4, 2).tolist() == [[0, 1, 2, 3], [2, 3, 4, 5]]
    assert windows_of(np.arange(3.0), 4, 2).shape == (0, 4)
