"""The mean over estimates that vary: a published meta-analysis, the plain t interval, and coverage."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow.statistics import expanded_factor
from skisnow.statistics.combined_uncertainty import random_effects_mean

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
    assert random_effects_mean([1.0, 1.1, 0.9], [1.0, 1.0, 1.0]).spread == 0.0


def test_one_estimate_has_no_interval() -> None:
    found = random_effects_mean([3.0], [0.1])
    assert found.mean == 3.0
    assert np.isnan([found.low, found.high]).all()


def test_exact_estimates_do_not_divide_by_zero() -> None:
    found = random_effects_mean([2.0, 2.0, 2.0], [0.0, 0.0, 0.0])
    assert (found.mean, found.low, found.high) == pytest.approx((2.0, 2.0, 2.0))
    assert random_effects_mean([0.0, 0.0], [0.0, 0.0]).mean == 0.0


@pytest.mark.parametrize(("spread", "least", "most"), [(0.0, 0.95, 1.0), (1.0, 0.91, 0.96), (3.0, 0.92, 0.97)])
def test_coverage(spread: float, least: float, most: float) -> None:
    """Over eight estimates whose errors differ up to five times 92 to 99 % of 1000 intervals hold the mean (± 2 %)."""
    rng = np.random.default_rng(2)
    errors = np.linspace(0.3, 1.5, 8)
    draws = 4.0 + np.hypot(spread, errors) * rng.standard_normal((1000, 8))
    found = [random_effects_mean(x, errors) for x in draws]
    assert least < np.mean([each.low <= 4.0 <= each.high for each in found]) <= most
