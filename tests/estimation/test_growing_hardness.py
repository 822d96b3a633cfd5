"""A hardness that grows with depth: exact series give it back, and intervals hold it where readings scatter."""

from __future__ import annotations

import math

import numpy as np
import pytest
from benchmarks.growing_hardness import ANGLE, TOOL, growing

import skisnow
from skisnow.campaign import reference_campaign
from skisnow.estimation.hardness import DEFINITIONS, hardness_at_largest_load
from skisnow.estimation.layering import growing_hardness, second_moment, site_growth
from skisnow.estimation.readings import ReadingUncertainty

from .conftest import MakeCampaign
from .test_errors_in_depth import series

GAUGE = 1e-5
UNCERTAINTY = ReadingUncertainty(GAUGE / math.sqrt(12.0))


def test_the_second_moment_by_hand() -> None:
    """Wedge: ∫ ε² dA = L e³/(3 tan ϑ); flat: L W e²."""
    load = np.array([100.0, 200.0])
    readings = series(np.array([[1e-3, 3e-3], [1e-3, 3e-3]]), np.array([ANGLE, 0.0]), load)
    found = second_moment(readings, readings.penetration_depth)
    depth = np.array([1e-3, 3e-3])
    expected = [*(TOOL.length * depth**3 / (3.0 * math.tan(ANGLE))), *(TOOL.length * 0.062 * depth**2)]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


@pytest.mark.parametrize("growth", [-0.3, 0.0, 0.2, 0.5, 2.0])
def test_an_exact_series_gives_its_growth_back(growth: float) -> None:
    hardness = np.array([1e8, 1e9, 1e10])
    readings = growing(hardness, growth)
    H = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    np.testing.assert_allclose(H, hardness, rtol=1e-9)
    found = growing_hardness(readings, H, ReadingUncertainty(1e-9))
    np.testing.assert_allclose(found.growth, growth, atol=1e-4)
    np.testing.assert_allclose(found.surface_hardness, hardness / (1.0 + 2.0 * growth / 3.0), rtol=1e-4)


@pytest.mark.parametrize("growth", [0.0, 0.2, 0.5])
def test_intervals_hold_it(growth: float) -> None:
    """3000 series of 2 % scatter, a gauge of 0.01 mm and offsets of 0.02 mm: 95 ± 2 % of the intervals; sites of 30."""
    readings = growing(np.full(3000, 1e8), growth, 0.02, 2e-5, step=GAUGE)
    found = growing_hardness(readings, hardness_at_largest_load(readings, DEFINITIONS["H_V"]), UNCERTAINTY)
    low, high = found.growth_interval.T
    assert np.isfinite(found.growth).mean() > 0.99
    assert np.mean((low <= growth) & (high >= growth)) == pytest.approx(0.95, abs=0.02)
    sites = [f"{index % 100}" for index in range(3000)]
    *means, _ = site_growth(found, np.ones(3000, dtype=bool), sites)
    assert np.mean([row.value for row in means]) == pytest.approx(growth, abs=0.02)
    assert np.mean([each.low <= growth <= each.high for each in means]) >= 0.88


def test_a_few_readings_leave_it_open(make_campaign: MakeCampaign) -> None:
    rows = [("P1", "A", "ski", 30, load, load / 100) for load in (100, 200, 300, 400)]
    found = skisnow.analyse(make_campaign(rows), n_resamples=100).results["penetration"]["growing_hardness"]
    assert found["sites"] == []
    assert found["experiments"][0]["growth_percent"] is None


def test_the_results_have_it_for_every_site() -> None:
    """Mean layering of the reference campaign is 0, of ± 0.15 from series to series."""
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    growth = found.results["penetration"]["growing_hardness"]
    assert len(growth["experiments"]) == 236
    assert [row["site"] for row in growth["sites"]] == [*(f"site {letter}" for letter in "ABCDEFGH"), None]
    low, high = growth["sites"][-1]["growth_interval_percent"]
    assert low < 0.0 < high
