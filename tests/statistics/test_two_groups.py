"""Two groups: Welch's test against scipy, numbers of tests against statsmodels."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.errors import FitError, ParameterError
from skisnow.statistics import ratio_of_means, two_groups

needed = two_groups.tests_per_group  # under its own name pytest would take it for a test


@pytest.mark.parametrize("seed", range(4))
def test_against_scipy(seed: int) -> None:
    from scipy.stats import ttest_ind

    rng = np.random.default_rng(seed)
    a, b = rng.normal(0.3, 0.2, 9), rng.normal(0.0, 0.6, 5)
    peer = ttest_ind(a, b, equal_var=False)
    interval = peer.confidence_interval(0.9)
    found = ratio_of_means(a, b, confidence=0.9)
    assert found.ratio == pytest.approx(math.exp(a.mean() - b.mean()), rel=1e-13)
    assert found.p == pytest.approx(float(peer.pvalue), rel=1e-10)
    np.testing.assert_allclose(found.interval, np.exp([interval.low, interval.high]), rtol=1e-10)


def test_swapping_the_groups_inverts_the_ratio() -> None:
    a, b = np.log([2.0, 3.0, 5.0]), np.log([1.0, 1.5, 1.2, 0.9])
    one, other = ratio_of_means(a, b), ratio_of_means(b, a)
    assert one.ratio > 1
    assert one.ratio * other.ratio == pytest.approx(1.0, rel=1e-14)
    assert one.p == other.p
    np.testing.assert_allclose(one.interval * other.interval[::-1], 1.0, rtol=1e-13)


def test_groups_that_tell_too_little() -> None:
    single = ratio_of_means([math.log(6.0)], np.log([2.0, 2.0, 2.0]))
    assert single.ratio == pytest.approx(3.0)
    still = ratio_of_means([0.5, 0.5], [0.5, 0.5])
    for found in (single, still):
        assert np.isnan(found.interval).all()
        assert math.isnan(found.p)
    for a in ([], [0.1, float("nan")]):
        found = ratio_of_means(a, [0.1, 0.2])
        assert math.isnan(found.ratio)
        assert np.isnan(found.interval).all()
        assert math.isnan(found.p)
    with raises(ParameterError, "wrong_shape", name="logs_b"):
        ratio_of_means([0.1, 0.2], [0.1, -math.inf])


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


def test_small_scatter_needs_three() -> None:
    # 11.16 standard deviations between the means. With n = 2, t > 9.925 needs χ²(2 degrees) below about
    # 2 (11.16/9.925)² = 2.53, which has the chance 1 - exp(-1.26) = 0.72; with n = 3 it is nearly sure.
    assert needed(0.02, ratio=0.8, power=0.9, alpha=0.01) == 3


def test_numbers_of_tests_at_large_scatter_follow_the_normal_formula() -> None:
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
