"""Cluster-robust intervals: the textbook formulas with dense matrices, exact special cases, coverage."""

import math

import numpy as np
import numpy.typing as npt
import pytest
from scipy import stats
from tests.coded import raises

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import FitError, ParameterError
from skisnow.statistics import cluster_intervals, f_tests, linear_fit


def textbook(y: FloatArray, X: FloatArray, cluster: npt.NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
    """CR2 standard errors and degrees of freedom, n × n matrices and all (Imbens and Kolesár 2016)."""
    n, p = X.shape
    bread = np.linalg.inv(X.T @ X)
    M = np.eye(n) - X @ bread @ X.T
    residual = M @ y
    meat, columns = np.zeros((p, p)), []
    for g in np.unique(cluster):
        own = cluster == g
        value, vector = np.linalg.eigh(M[np.ix_(own, own)])
        A = vector @ np.diag(value**-0.5) @ vector.T
        score = X[own].T @ A @ residual[own]
        meat += np.outer(score, score)
        columns.append(M[:, own] @ A @ X[own] @ bread)
    covariance = bread @ meat @ bread
    dof = []
    for j in range(p):
        G = np.stack([column[:, j] for column in columns], axis=1)
        value = np.linalg.eigvalsh(G.T @ G)
        dof.append(value.sum() ** 2 / np.sum(value**2))
    return np.sqrt(np.diag(covariance)), np.array(dof)


@pytest.mark.parametrize("seed", range(5))
def test_against_dense_matrices(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cluster = rng.integers(0, 5, 31)
    X = rng.normal(size=(31, 2)) * [1.0, 100.0] + [0.0, 450.0]
    y = X @ [1.0, 0.01] + rng.normal(size=5)[cluster] + rng.normal(size=31)
    found = cluster_intervals(y, X, cluster)
    errors, dof = textbook(y, np.column_stack((np.ones(31), X)), cluster)
    np.testing.assert_allclose(found.standard_errors, errors, rtol=1e-8)  # the dense way inverts raw normal equations
    np.testing.assert_allclose(found.degrees_of_freedom, dof, rtol=1e-8)
    np.testing.assert_allclose(found.coefficients, linear_fit(y, X).coefficients, rtol=1e-12)
    assert found.n_clusters == len(np.unique(cluster))


def test_mean_of_balanced_clusters_is_the_t_interval_of_their_means() -> None:
    rng = np.random.default_rng(3)
    table = rng.normal(size=(6, 7)) + rng.normal(size=(6, 1))
    sites = np.repeat(["f", "b", "a", "d", "c", "e"], 7)
    found = cluster_intervals(table.ravel(), np.empty((42, 0)), sites)
    means = table.mean(axis=1)
    error = means.std(ddof=1) / np.sqrt(6)
    np.testing.assert_allclose(found.degrees_of_freedom, [5.0], rtol=1e-12)
    np.testing.assert_allclose(found.standard_errors, [error], rtol=1e-12)
    half = 2.5705818356363 * error  # t(0.975; 5)
    np.testing.assert_allclose(found.intervals, [[means.mean() - half, means.mean() + half]], rtol=1e-11)


def test_coverage_with_few_unequal_clusters() -> None:
    rng = np.random.default_rng(12)
    cluster = np.repeat(np.arange(8), [3, 4, 5, 6, 8, 10, 14, 20])
    n, trials, robust, classical = len(cluster), 400, 0, 0
    for _ in range(trials):
        x = 0.5 * rng.normal(size=8)[cluster] + rng.normal(size=n)
        y = 2.0 + 0.3 * x + 0.7 * rng.normal(size=8)[cluster] + rng.normal(size=n)
        low, high = cluster_intervals(y, x, cluster).intervals[0]
        robust += int(low <= 2.0 <= high)
        low, high = linear_fit(y, x).intervals[0]
        classical += int(low <= 2.0 <= high)
    # 95 % of 400 has a standard error of 1.1 %; unequal clusters under a common effect leave it a few per cent short
    assert 0.91 <= robust / trials <= 0.98
    assert classical / trials < 0.75


def test_one_cluster_has_no_interval() -> None:
    # a second level that only site b has: between sites nothing tells how it scatters
    x = np.array([0.0, 0, 0, 0, 0, 1, 1, 1])
    y = np.array([1.0, 2, 1, 2, 3, 5, 6, 4])
    sites = ["a", "a", "c", "c", "d", "b", "b", "b"]
    found = cluster_intervals(y, x, sites)
    assert np.isnan(found.intervals[1]).all()
    assert np.isnan(found.degrees_of_freedom[1])
    # the intercept is the mean of sites a, c, d alone; the fit there is that of y over them
    alone = cluster_intervals(y[:5], np.empty((5, 0)), sites[:5])
    np.testing.assert_allclose(found.standard_errors[0], alone.standard_errors[0], rtol=1e-10)
    np.testing.assert_allclose(found.degrees_of_freedom[0], alone.degrees_of_freedom[0], rtol=1e-10)


def test_fewer_than_two_clusters_or_too_few_observations() -> None:
    one = cluster_intervals([1.0, 2.0, 4.0], [0.0, 1.0, 2.0], ["a", "a", "a"])
    assert one.n_clusters == 1
    exact = cluster_intervals([1.0, 2.0], [0.0, 1.0], ["a", "b"])
    np.testing.assert_allclose(exact.coefficients, [1.0, 1.0], rtol=1e-14)
    rng = np.random.default_rng(4)
    crowded = [cluster_intervals(rng.normal(size=6), rng.normal(size=(6, 5)), [0, 0, 0, 1, 1, 2]) for _ in range(9)]
    for undetermined in (one, exact, *crowded):
        assert np.isnan([undetermined.standard_errors, undetermined.degrees_of_freedom]).all()
        assert np.isnan(undetermined.intervals).all()


def test_two_sites_with_slopes_of_their_own() -> None:
    # x alike at both sites: the slope is the mean of two slopes b_a, b_b, its error |b_a - b_b|/2 with one degree
    x = np.tile([0.0, 1.0, 2.0, 3.0], 2)
    rng = np.random.default_rng(2)
    y = x + rng.normal(size=8)
    slopes = [linear_fit(y[part], x[part]).coefficients[1] for part in (slice(0, 4), slice(4, 8))]
    found = cluster_intervals(y, x, np.repeat([1, 2], 4))
    np.testing.assert_allclose(found.standard_errors[1], abs(slopes[0] - slopes[1]) / 2, rtol=1e-11)
    np.testing.assert_allclose(found.degrees_of_freedom, [1.0, 1.0], rtol=1e-11)


def test_bad_input() -> None:
    with raises(ParameterError, "wrong_shape"):
        cluster_intervals([1.0, 2.0, 3.0], [1.0, 2.0, 4.0], ["a", "b"])
    with pytest.raises(FitError):
        cluster_intervals([1.0, 2.0, 3.0], [1.0, 1.0, 1.0], ["a", "b", "b"])


# Groups: numbers of tests against statsmodels, and letters


needed = f_tests.tests_per_group  # under its own name pytest would take it for a test


@pytest.mark.parametrize("seed", range(20))
def test_groups_share_a_letter_exactly_where_they_do_not_differ(seed: int) -> None:
    rng = np.random.default_rng(seed)
    upper = np.triu(rng.random((7, 7)) < rng.random(), 1)
    differ = upper | upper.T
    letters = f_tests.compact_letters(differ)
    for a in range(7):
        for b in range(7):
            assert bool(set(letters[a]) & set(letters[b])) == (a == b or not differ[a, b])


def test_many_different_groups_have_letters_with_a_number() -> None:
    letters = f_tests.compact_letters(~np.eye(28, dtype=bool))
    assert letters[:2] == ["a", "b"]
    assert letters[26:] == ["a1", "b1"]


@pytest.mark.parametrize("sd_log", [0.05, 0.15, 0.4, 1.0])
@pytest.mark.parametrize(("ratio", "power", "alpha"), [(1.1, 0.8, 0.05), (0.8, 0.9, 0.01)])
def test_numbers_of_tests_against_statsmodels(sd_log: float, ratio: float, power: float, alpha: float) -> None:
    from statsmodels.stats.power import TTestIndPower

    n = needed(sd_log, ratio=ratio, power=power, alpha=alpha)

    def reached(size: int) -> float:
        effect = abs(math.log(ratio)) / sd_log
        return float(TTestIndPower().power(effect, size, alpha, ratio=1.0, alternative="two-sided"))

    assert reached(n) >= power
    assert reached(n - 1) < power


def test_a_level_at_which_scipy_has_no_chance_of_the_wrong_sign() -> None:
    """SciPy gives NaN for it with 64 in each group, of which the search took 64 as enough."""
    effect = 4.2 / math.sqrt(64 / 2.0)
    n = needed(math.log(1.1) / effect, ratio=1.1, power=0.8, alpha=1e-5)

    def reached(size: int) -> float:
        critical = stats.t.isf(0.5e-5, 2 * size - 2)
        return float(stats.nct.sf(critical, 2 * size - 2, effect * math.sqrt(size / 2.0)))

    assert reached(n) >= 0.8 > reached(n - 1)


def test_small_scatter_needs_three() -> None:
    # 11.16 standard deviations between the means. With n = 2, t > 9.925 needs χ²(2 degrees) below about
    # 2 (11.16/9.925)² = 2.53, which has the chance 1 - exp(-1.26) = 0.72; with n = 3 it is nearly sure.
    assert needed(0.02, ratio=0.8, power=0.9, alpha=0.01) == 3


@pytest.mark.parametrize(
    "wrong",
    [{"sd_log": 0.0}, {"sd_log": math.inf}, {"ratio": 0.0}, {"ratio": 1.0}, {"ratio": math.inf}, {"alpha": 0.0},
     {"alpha": 0.8}, {"alpha": 0.9}, {"power": 1.0}, {"power": math.nan}],
)  # fmt: skip
def test_scatter_ratio_level_and_power_have_bounds(wrong: dict[str, float]) -> None:
    with raises(ParameterError, "out_of_range"):
        needed(**{"sd_log": 0.2, "ratio": 1.1, "power": 0.8, "alpha": 0.05, **wrong})


def test_normal_counts_at_large_scatter() -> None:
    # n → 2 (z_0.975 + z_0.8)² (sd/ln ratio)², here far above a million
    expected = 2 * (1.959963984540054 + 0.8416212335729143) ** 2 * (50.0 / math.log(1.1)) ** 2
    assert needed(50.0) == pytest.approx(expected, rel=1e-4)


def test_ratio_and_its_inverse_need_the_same() -> None:
    assert needed(0.3, ratio=1.25) == needed(0.3, ratio=0.8)


def test_bad_arguments() -> None:
    for arguments in ({"ratio": 1.0}, {"ratio": -1.0}, {"power": 1.0}, {"power": 0.04}, {"alpha": 0.0}):
        with pytest.raises(ParameterError):
            needed(0.2, **arguments)
    for sd_log in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ParameterError):
            needed(sd_log)
    with raises(FitError, "too_many"):
        needed(1.0, ratio=1.00001)
