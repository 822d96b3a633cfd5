"""Eqns 7-9 by hand, and intervals against simulation."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import skisnow
from skisnow.campaign import Campaign
from skisnow.estimation import results_dict
from skisnow.estimation.comparisons import site_values
from skisnow.estimation.hardness import shear_displacement, shear_stress

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


ARM, LARGEST, WAY = 250.0, 30.0, 2.0
"""r in mm, M_f in N m, u_y in mm."""
SHARES = (0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0, 0.9)
COLUMN = ",turning_angle_deg"
Row = tuple[object, ...]


def turned(
    name: str = "S1",
    way: float = WAY,
    *,
    slack: float = 3.0,
    stiffness: float = math.inf,
    noise: np.random.Generator | None = None,
    site: str = "A",
    reading: float = 0.0,
) -> list[Row]:
    """M = M_f (φ - φ₀) r/u_y up to M_f, then a weaker snow farther on; φ in degrees, the pole's twist M/k in it."""
    rows: list[Row] = []
    for index, share in enumerate(SHARES):
        angle = math.degrees(share * way / ARM) if index < 7 else math.degrees(3 * way / ARM)
        angle += slack + share * LARGEST / stiffness + (0.0 if noise is None else reading * noise.standard_normal())
        rows.append((name, site, "blade", 90, 6, ARM, share * LARGEST, angle))
    return rows


def analysed(make_campaign: MakeCampaign, rows: list[Row], **how: Any) -> skisnow.Analysis:
    return skisnow.analyse(make_campaign((), rows, shear_columns=COLUMN, **how), n_resamples=100)


def test_an_exact_test_gives_its_way_back(make_campaign: MakeCampaign) -> None:
    row = analysed(make_campaign, turned()).results["shear"]["experiments"][0]
    assert row["n_turning"] == 4  # below 10 % the plate comes to lie, above 90 % the snow fails, behind it has failed
    assert row["shear_displacement_mm"] == pytest.approx(WAY, rel=1e-9)
    assert row["S_f_N_per_mm2"] == pytest.approx(LARGEST / 0.25 / 600)


def test_a_pole_that_twists_is_taken_off(make_campaign: MakeCampaign) -> None:
    """45 N m for a degree: under 30 N m the pole twists by 0.67°, which is 2.9 mm at the plate."""
    rows = turned(stiffness=45.0)
    alone = analysed(make_campaign, rows).results["shear"]["experiments"][0]
    assert alone["shear_displacement_mm"] == pytest.approx(WAY + ARM * math.radians(30 / 45))
    (tmp := make_campaign((), rows, shear_columns=COLUMN).folder).joinpath("campaign.toml").write_text(
        "pole_stiffness_Nm_per_deg = 45\n" + (tmp / "campaign.toml").read_text("utf-8"), encoding="utf-8"
    )
    results = skisnow.analyse(tmp, n_resamples=100).results
    assert results["shear"]["experiments"][0]["shear_displacement_mm"] == pytest.approx(WAY)
    assert results["campaign"]["pole_stiffness_Nm_per_deg"] == pytest.approx(45.0)


def test_the_stress_does_not_know_of_the_rising_part(make_campaign: MakeCampaign) -> None:
    both = analysed(make_campaign, [*turned("S1"), *turned("S2", 1.0)], moment=0.2, arm=1.0).results
    tops = [rows[6][:-1] for rows in (turned("S1"), turned("S2", 1.0))]
    alone = skisnow.analyse(make_campaign((), tops, moment=0.2, arm=1.0), n_resamples=100).results
    for results in (both, alone):
        results.pop("provenance")
        results["shear"].pop("displacement")
        for row in results["shear"]["experiments"]:
            for key in ("n_turning", "shear_displacement_mm", "shear_displacement_interval_mm"):
                row.pop(key)
    assert both == alone


def test_two_readings_have_no_interval_and_one_has_nothing(make_campaign: MakeCampaign) -> None:
    rows = turned()
    for kept, known in (([1, 2, 6], True), ([1, 6], False)):
        row = analysed(make_campaign, [rows[index] for index in kept]).results["shear"]["experiments"][0]
        assert (row["shear_displacement_mm"] is not None) == known
        assert row["shear_displacement_interval_mm"] is None


def test_a_snow_takes_it_and_the_file_says_the_same(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    """Geometric mean of 1, 2 and 4 mm at site A: 2 mm."""
    rows = [row for name, way in (("S1", 1.0), ("S2", 2.0), ("S3", 4.0)) for row in turned(name, way)]
    pressed = [("P1", site, "ski", 30, load, load / 100) for site in ("A",) for load in (100, 200, 300)]
    campaign = make_campaign(pressed, [*rows, *turned("S4", 9.0, site="B")], shear_columns=COLUMN)
    found = skisnow.analyse(campaign, n_resamples=100)
    of_A, of_B, of_all = found.results["shear"]["displacement"]
    assert [(row["site"], row["n"]) for row in (of_A, of_B, of_all)] == [("A", 3), ("B", 1), (None, 4)]
    assert of_A["shear_displacement_mm"] == pytest.approx(2.0)
    assert of_all["shear_displacement_interval_mm"] is None
    path = tmp_path / "results.json"
    path.write_text(json.dumps(results_dict(found)), encoding="utf-8")
    snow = found.snow("A")
    read = skisnow.read_snow(path, site="A")
    assert snow.shear_displacement == read.shear_displacement == pytest.approx(2e-3)
    assert snow.shear_displacement_interval == read.shear_displacement_interval
    turn = skisnow.load_scenario("carved-46m")
    assert turn.with_(snow=snow).contact.shear_displacement == snow.shear_displacement
    assert turn.with_(snow="race-piste").contact.shear_displacement == turn.contact.shear_displacement


def test_truth_is_covered_without_bias(make_campaign: MakeCampaign) -> None:
    """1000 tests of 2 mm whose angle is read with 0.03°, 0.13 mm at the plate: bias below 1 %, coverage 95 ± 2 %."""
    rng = np.random.default_rng(5)
    rows = [row for index in range(1000) for row in turned(f"S{index}", noise=rng, reading=0.03)]
    campaign = make_campaign((), rows, shear_columns=COLUMN)
    assert campaign.shear is not None
    found = shear_displacement(campaign, campaign.shear)
    assert np.mean(found.value) == pytest.approx(WAY * 1e-3, rel=0.01)
    low, high = found.interval.T
    assert np.mean((low <= WAY * 1e-3) & (high >= WAY * 1e-3)) == pytest.approx(0.95, abs=0.021)
    sites = [f"{index % 50}" for index in range(1000)]
    means = [each for each in site_values(found.value, np.ones(1000, dtype=bool), sites) if each.site is not None]
    covered = np.mean([each.low <= WAY * 1e-3 <= each.high for each in means])
    assert covered >= 0.88  # 50 sites of 20 tests: 95 % ± 2.3 standard errors
