"""Eqns 7-9 by hand, and intervals against simulation."""

import math

import numpy as np
import pytest

from skisnow.campaign import Campaign
from skisnow.estimation.shear import shear_stress

from .conftest import MakeCampaign

ROW = ("s1", "A", "blade", 90, 6, 250, 30)


def one(campaign: Campaign) -> tuple[float, float, list[float]]:
    assert campaign.shear is not None
    found = shear_stress(campaign, campaign.shear)
    return float(found.force[0]), float(found.value[0]), found.interval[0].tolist()


def test_moment_arm_depth_and_length_by_hand(make_campaign: MakeCampaign) -> None:
    """30 N m at 250 mm is 120 N; over 100 mm × 6 mm it is 0.2 N/mm²."""
    force, stress, _ = one(make_campaign(shear=[ROW]))
    assert force == pytest.approx(120.0, rel=1e-14)
    assert stress == pytest.approx(0.2e6, rel=1e-12)


def test_relative_uncertainties_add_in_squares(make_campaign: MakeCampaign) -> None:
    """3 % of the moment, 4 % of the arm, none of the depth: 5 % together, interval exp(± 1.96 · 0.05)."""
    _, stress, interval = one(make_campaign(shear=[ROW], moment=0.9, arm=10.0, gauge=1e-9))
    np.testing.assert_allclose(np.log(np.array(interval) / stress), [-0.0979982, 0.0979982], rtol=1e-5)


def test_the_gauge_enters_by_its_step_over_root_twelve(make_campaign: MakeCampaign) -> None:
    _, stress, interval = one(make_campaign(shear=[ROW], gauge=0.6))
    assert math.log(interval[1] / stress) == pytest.approx(1.959964 * 0.1 / math.sqrt(12), rel=1e-5)


def test_depth_zero_has_a_force_and_no_stress(make_campaign: MakeCampaign) -> None:
    force, stress, interval = one(make_campaign(shear=[("s1", "A", "blade", 90, 0, 250, 30)], moment=1))
    assert force == 120.0
    assert math.isnan(stress)
    assert np.isnan(interval).all()


def test_moment_zero_gives_zero_with_a_one_sided_interval(make_campaign: MakeCampaign) -> None:
    """1.96 · 0.5 N m / 250 mm over 600 mm², the depth's share aside."""
    _, stress, interval = one(make_campaign(shear=[("s1", "A", "blade", 90, 6, 250, 0)], moment=0.5, gauge=1e-9))
    assert stress == 0.0
    assert interval == pytest.approx([0.0, 1.959964 * 0.5 / 0.25 / 6e-4], rel=1e-5)


def test_intervals_cover_the_truth_as_often_as_they_claim(make_campaign: MakeCampaign) -> None:
    """20,000 tests with stated errors of 4 %, 3 % and 2 %: 95 % within 3 binomial deviations."""
    rng, n = np.random.default_rng(3), 20_000
    depth, arm, truth = 5.0, 250.0, 0.2
    moment = truth * 100 * depth * arm / 1000
    columns = depth + rng.normal(0, 0.1, n), arm + rng.normal(0, 7.5, n), moment * (1 + rng.normal(0, 0.04, n))
    rows = [(f"s{i}", "A", "blade", 90, *cells) for i, cells in enumerate(zip(*columns, strict=True))]
    campaign = make_campaign(shear=rows, gauge=0.1 * math.sqrt(12), moment=0.04 * moment, arm=7.5)
    assert campaign.shear is not None
    found = shear_stress(campaign, campaign.shear)
    covered = np.mean((found.interval[:, 0] <= truth * 1e6) & (truth * 1e6 <= found.interval[:, 1]))
    assert abs(covered - 0.95) < 3 * math.sqrt(0.95 * 0.05 / n) + 0.002
