"""Groups: numbers of tests against statsmodels, and letters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.errors import FitError, ParameterError
from skisnow.statistics import two_groups

needed = two_groups.tests_per_group  # under its own name pytest would take it for a test


@pytest.mark.parametrize("seed", range(20))
def test_groups_share_a_letter_exactly_where_they_do_not_differ(seed: int) -> None:
    rng = np.random.default_rng(seed)
    upper = np.triu(rng.random((7, 7)) < rng.random(), 1)
    differ = upper | upper.T
    letters = two_groups.compact_letters(differ)
    for a in range(7):
        for b in range(7):
            assert bool(set(letters[a]) & set(letters[b])) == (a == b or not differ[a, b])


def test_many_different_groups_have_letters_with_a_number() -> None:
    letters = two_groups.compact_letters(~np.eye(28, dtype=bool))
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
