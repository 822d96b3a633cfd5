"""Snows drawn from a measured one have the intervals that they were drawn from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.snow import SnowProperties
from skisnow.snow.mean_snow import drawn_snows, log_normal

SNOW = SnowProperties(
    2.0e8, 1.4e5, source="site X", snow_hardness_interval=(1.0e8, 4.0e8), failure_shear_stress_interval=(1.0e5, 1.8e5)
)


def test_the_intervals_come_back() -> None:
    """Of 40,000 draws: the 2.5 % quantile of a normal is known to 0.7 % of its half-width (1.96 × 0.0134 × 0.27)."""
    snows = drawn_snows(SNOW, np.random.default_rng(1).random((40_000, 2)))
    hardness = np.array([snow.snow_hardness for snow in snows])
    stress = np.array([snow.failure_shear_stress for snow in snows])
    assert np.quantile(hardness, [0.025, 0.5, 0.975]) == pytest.approx([1.0e8, 2.0e8, 4.0e8], rel=0.04)
    assert np.quantile(stress, [0.025, 0.5, 0.975]) == pytest.approx([1.0e5, np.sqrt(1.8) * 1e5, 1.8e5], rel=0.02)
    assert abs(np.corrcoef(np.log(hardness), np.log(stress))[0, 1]) < 0.02
    assert "site X" in snows[0].source


def test_a_share_of_one_half_is_the_middle_and_more_is_more() -> None:
    low, middle, high = drawn_snows(SNOW, np.array([[0.025, 0.025], [0.5, 0.5], [0.975, 0.975]]))
    assert middle.snow_hardness == pytest.approx(2.0e8)
    assert middle.failure_shear_stress == pytest.approx(np.sqrt(1.0e5 * 1.8e5), rel=1e-6)
    assert (low.snow_hardness, high.snow_hardness) == pytest.approx((1.0e8, 4.0e8))
    assert (low.failure_shear_stress, high.failure_shear_stress) == pytest.approx((1.0e5, 1.8e5), rel=1e-6)


def test_snow_without_interval_is_refused() -> None:
    with raises(ParameterError, "no_data", quantity="S_f"):
        drawn_snows(replace(SNOW, failure_shear_stress_interval=None), np.full((3, 2), 0.5))
    with raises(ParameterError, "out_of_range", stress=0.0):
        drawn_snows(replace(SNOW, failure_shear_stress_interval=(0.0, 2.0)), np.full((3, 2), 0.5))


def test_a_value_with_an_uneven_interval_keeps_both() -> None:
    """1.5 standard deviations to either side: a half of 95 % is 1.96 of them, so the ends to the power 1.5/1.96."""
    shares = np.array([0.025, 0.5, 0.975, 0.0668072013, 0.9331927987])
    expected = [6.0, 9.0, 27.0, 9.0 * (6.0 / 9.0) ** (1.5 / 1.959964), 9.0 * 3.0 ** (1.5 / 1.959964)]
    assert log_normal(9.0, (6.0, 27.0), shares) == pytest.approx(expected, rel=1e-6)


def test_an_even_interval_is_drawn_from_as_that_of_s_f() -> None:
    shares = np.random.default_rng(2).random((50, 2))
    stress = [snow.failure_shear_stress for snow in drawn_snows(SNOW, shares)]
    middle = float(np.sqrt(1.0e5 * 1.8e5))
    assert log_normal(middle, (1.0e5, 1.8e5), shares[:, 1]) == pytest.approx(stress, rel=1e-12)
