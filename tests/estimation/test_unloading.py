"""Shear strength and unloading."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import skisnow
from skisnow._support.arrays import FloatArray
from skisnow.campaign import Campaign, ReferenceNoise, reference_campaign
from skisnow.estimation import results_dict
from skisnow.estimation.campaign_model import DEFAULT_PRIORS, fit_campaign
from skisnow.estimation.comparisons import site_values
from skisnow.estimation.hardness import (
    DEFINITIONS,
    hardness,
    hardness_at_largest_load,
    shear_displacement,
    shear_stress,
)
from skisnow.estimation.readings import ReadingUncertainty, readings_of
from skisnow.estimation.screening import quality_flags, series_estimates
from skisnow.estimation.unloading import Unloading, _stiffness_ratio, site_unloading, unloading
from skisnow.forces.penetration import HypoplasticPoint
from tests.key_names import SHEAR_DISPLACEMENT_INTERVAL
from tests.present import present

from .conftest import MakeCampaign

RATIO = 8.0
LENGTH, WIDTH, ANGLE = 200.0, 62.0, math.radians(30.0)
BRANCH = ",branch"
Row = tuple[object, ...]


def edged(name: str = "P1", ratio: float = RATIO, digits: int = 12, site: str = "A") -> list[Row]:
    """A wedge by hand: up along e = √(2 F tan ϑ/(H_V L)), H_V 0.1 N/mm³, down along F/F_m = (1 - κ d/e_m)²."""
    loads = [100.0, 200.0, 300.0, 400.0]
    deep = [math.sqrt(2 * load * math.tan(ANGLE) / (0.1 * LENGTH)) for load in loads]
    back = [deep[-1] * (1 - (1 - math.sqrt(load / 400)) / ratio) for load in loads[-2::-1]]
    up: list[Row] = [
        (name, site, "ski", 30, load, round(e, digits), "loading") for load, e in zip(loads, deep, strict=True)
    ]
    return up + [
        (name, site, "ski", 30, load, round(e, digits), "unloading")
        for load, e in zip(loads[-2::-1], back, strict=True)
    ]


def flat(name: str = "P1", ratio: float = RATIO) -> list[Row]:
    """A flat tool by hand: up along e = F/(H_V L W), down along a line k_u/H_V as steep."""
    loads = [100.0, 200.0, 300.0, 400.0]
    deep = [load / (0.02 * LENGTH * WIDTH) for load in loads]
    back = [deep[-1] - (400 - load) / (ratio * 0.02 * LENGTH * WIDTH) for load in loads[-2::-1]]
    up: list[Row] = [(name, "A", "ski", 0, load, e, "loading") for load, e in zip(loads, deep, strict=True)]
    return up + [(name, "A", "ski", 0, load, e, "unloading") for load, e in zip(loads[-2::-1], back, strict=True)]


def analysed(make_campaign: MakeCampaign, rows: list[Row], **how: Any) -> skisnow.Analysis:
    return skisnow.analyse(make_campaign(rows, columns=BRANCH, **how), n_resamples=100)


@pytest.mark.parametrize("rows", [edged(), flat()], ids=["edged", "flat"])
def test_an_exact_series_gives_its_ratio_back(rows: list[Row], make_campaign: MakeCampaign) -> None:
    found = analysed(make_campaign, rows).results["penetration"]
    row = found["experiments"][0]
    assert row["n_unloading"] == 3
    assert row["unloading_ratio"] == pytest.approx(RATIO, rel=1e-9)
    assert row["rebound_ratio"] == pytest.approx(1 / RATIO, rel=1e-9)
    assert row["k_u_N_per_mm3"] == pytest.approx(RATIO * row["H_V_N_per_mm3"], rel=1e-9)
    for key, value in (("unloading_ratio_interval", RATIO), ("k_u_interval_N_per_mm3", row["k_u_N_per_mm3"])):
        assert row[key][0] < value < row[key][1]
    own, of_ratio, of_hardness = (
        np.log(np.array(row[f"{key}_interval{unit}"]) / row[f"{key}{unit}"])
        for key, unit in (("k_u", "_N_per_mm3"), ("unloading_ratio", ""), ("H_V", "_N_per_mm3"))
    )
    np.testing.assert_allclose(own**2, of_ratio**2 + of_hardness**2, rtol=1e-9)


def test_an_exact_way_back_leaves_the_prior_of_its_scatter(make_campaign: MakeCampaign) -> None:
    """0.2 readings with r = 0.05 and two free ones without scatter: r² = 0.2 · 0.05²/(2 + 0.2)."""
    penetration = analysed(make_campaign, flat()).penetration
    assert penetration is not None and penetration.unloading is not None
    assert penetration.unloading.rebound_scatter == pytest.approx(math.sqrt(0.2 * 0.05**2 / 2.2), rel=1e-3)
    unloading = present(analysed(make_campaign, flat(), gauge=1e-9).penetration).unloading
    assert unloading.rebound_freedom == pytest.approx(2.2)
    assert np.isfinite(unloading.rebound_ratio_error).all()


def test_the_way_back_is_that_of_the_law_of_the_simulations() -> None:
    """The force of a wedge on the way back, integrated over its width from the pressure of `HypoplasticPoint`."""
    law, deepest = HypoplasticPoint(snow_hardness=0.1e9, unloading_ratio=RATIO), 4e-3
    along = (np.arange(20_000) + 0.5) / 20_000
    force = [float(law.stress(along * deepest - d, along * deepest).mean()) for d in (0.0, 1e-4, 3e-4)]
    expected = [(1 - RATIO * d / deepest) ** 2 for d in (0.0, 1e-4, 3e-4)]
    np.testing.assert_allclose(np.array(force) / force[0], expected, rtol=1e-3)


def test_the_hardness_does_not_know_of_the_way_back(make_campaign: MakeCampaign) -> None:
    """All numbers of a campaign without those rows, to the bit, those of the unloading apart."""
    rows = [*edged("P1", digits=2), *edged("P2", 4.0, digits=2), *flat("P3")]
    both = analysed(make_campaign, rows).results
    alone = analysed(make_campaign, [row for row in rows if row[-1] == "loading"]).results
    own = ("n_unloading", "unloading_ratio", "rebound_ratio", "k_u_")
    for results in (both, alone):
        results["penetration"].pop("unloading")
        results.pop("provenance")
        for group in results["penetration"]["campaign_model"]["groups"]:
            group.pop("rebound_scatter")
            group.pop("rebound_degrees_of_freedom")
        for row in results["penetration"]["experiments"]:
            for key in [key for key in row if key.startswith(own)]:
                row.pop(key)
    assert both == alone


def test_a_campaign_without_the_column_has_none(make_campaign: MakeCampaign) -> None:
    rows = [row[:-1] for row in edged() if row[-1] == "loading"]
    found = skisnow.analyse(make_campaign(rows), n_resamples=100)
    assert found.results["penetration"]["unloading"] == []
    assert found.results["penetration"]["experiments"][0]["n_unloading"] == 0
    assert found.results["penetration"]["experiments"][0]["unloading_ratio"] is None
    assert found.snow("A").unloading_ratio is None


def test_a_second_look_under_the_largest_load_begins_the_way_back(make_campaign: MakeCampaign) -> None:
    """The tool crept by 0.2 mm before the first disc was taken off."""
    rows = edged()
    start = float(rows[3][5])  # type: ignore[arg-type]
    crept = [("P1", "A", "ski", 30, 400, start + 0.2, "unloading")]
    back = [(*row[:5], float(row[5]) / start * (start + 0.2), row[6]) for row in rows[4:]]  # type: ignore[arg-type]
    row = analysed(make_campaign, [*rows[:4], *crept, *back]).results["penetration"]["experiments"][0]
    assert row["n_unloading"] == 4
    assert row["unloading_ratio"] == pytest.approx(RATIO, rel=1e-9)


def test_loads_that_do_not_fall_leave_the_hardness_and_take_the_ratio(make_campaign: MakeCampaign) -> None:
    rows = edged()
    rows[5] = (*rows[5][:4], 300, *rows[5][5:])
    campaign = make_campaign(rows, columns=BRANCH)
    row = skisnow.analyse(campaign, n_resamples=100).results["penetration"]["experiments"][0]
    assert row["flags"] == ["unloading_not_falling"]
    assert row["used"]
    assert row["unloading_ratio"] is None
    assert row["H_V_N_per_mm3"] == pytest.approx(0.1)
    (flag,) = quality_flags(campaign)
    assert (flag.code, flag.row, flag.column, flag.value) == ("unloading_not_falling", 7, "load_N", "300")


def test_a_tool_that_sinks_on_is_flagged(make_campaign: MakeCampaign) -> None:
    rows = edged()
    deepest = float(rows[3][5])  # type: ignore[arg-type]
    for depth, codes in ((deepest + 0.01, []), (deepest + 0.03, ["unloading_sinks"])):
        rows[4] = (*rows[4][:5], depth, rows[4][6])
        campaign = make_campaign(rows, columns=BRANCH)
        found = [flag for flag in quality_flags(campaign) if flag.code == "unloading_sinks"]
        assert [flag.code for flag in found] == codes
    assert found[0].row == 6


def test_too_little_rebound_is_flagged_and_tells_a_least_ratio(make_campaign: MakeCampaign) -> None:
    """A steepness of 500 moves the tool by less than the gauge's step of 0.01 mm."""
    found = analysed(make_campaign, edged(ratio=500.0, digits=2))
    row = found.results["penetration"]["experiments"][0]
    assert row["flags"] == ["rebound_unresolved"]
    assert row["unloading_ratio_interval"] is None
    low, high = row["rebound_ratio_interval"]
    assert low <= 0.0 < high < 1 / RATIO
    assert found.snow("A").unloading_ratio is None


@pytest.mark.parametrize(("ratio", "below"), [(115.0, False), (127.0, True)])
def test_rebound_of_a_step_of_the_gauge_is_the_limit(make_campaign: MakeCampaign, ratio: float, below: bool) -> None:
    """Down to a quarter of the load the loading has 3/4 · 400/(0.02 · 200 · 62) = 1.21 mm: 121 steps of 0.01 mm."""
    unloading = present(analysed(make_campaign, flat(ratio=ratio)).penetration).unloading
    assert unloading.below_step.tolist() == [below]


def test_one_reading_gives_a_ratio_without_an_interval(make_campaign: MakeCampaign) -> None:
    row = analysed(make_campaign, edged()[:5]).results["penetration"]["experiments"][0]
    assert row["unloading_ratio"] == pytest.approx(RATIO, rel=1e-9)
    assert row["unloading_ratio_interval"] is None


def test_the_mean_of_a_site_keeps_the_mean_rebound(make_campaign: MakeCampaign) -> None:
    """Series alike but for their ratios weigh alike: the harmonic mean of 5 and 20 is 8."""
    found = analysed(make_campaign, [*edged("P1", 5.0), *edged("P2", 20.0), *edged("P3", 9.0, site="B")])
    of_A, of_B, of_all = found.results["penetration"]["unloading"]
    assert [(row["site"], row["n"]) for row in (of_A, of_B, of_all)] == [("A", 2), ("B", 1), (None, 3)]
    assert of_A["unloading_ratio"] == pytest.approx(8.0, rel=0.01)
    assert of_A["k_u_N_per_mm3"] == pytest.approx(0.1 * 10.0)  # geometric
    assert (
        of_B["unloading_ratio_interval"] == found.results["penetration"]["experiments"][2]["unloading_ratio_interval"]
    )
    assert of_all["k_u_interval_N_per_mm3"] is None


def test_a_snow_takes_it_and_the_file_says_the_same(tmp_path: Path) -> None:
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    path = tmp_path / "results.json"
    path.write_text(json.dumps(results_dict(found)), encoding="utf-8")
    for site in ("B", None, "C"):
        snow, read = found.snow(site), skisnow.read_snow(path, site=site)
        assert replace(snow, source="") == replace(read, source="")
        assert (snow.unloading_ratio is None) == (site == "C")
    snow = found.snow("B")
    assert snow.unloading_ratio_interval is not None
    assert snow.unloading_ratio_interval[0] < present(snow.unloading_ratio) < snow.unloading_ratio_interval[1]
    turn = skisnow.load_scenario("carved-46m").with_(snow=snow.__class__(**_fields(snow, failure_shear_stress=2e5)))
    assert turn.contact.unloading_ratio == present(snow.unloading_ratio)
    assert found.snow("B", unloading_ratio=3.0).unloading_ratio == 3.0


def _fields(snow: skisnow.SnowProperties, **other: Any) -> dict[str, Any]:
    return {name: getattr(snow, name) for name in snow.__dataclass_fields__} | other


@pytest.mark.parametrize("seating_sd", [0.02e-3, 0.05e-3])
def test_truth_is_covered_without_bias(seating_sd: float) -> None:
    """Six campaigns, 530 series: mean error below 1 %, 95 % intervals cover 93 to 99 %; the page has a thousand."""
    errors, held, means = [], [], []
    for seed in range(6):
        drawn = reference_campaign(seed, noise=ReferenceNoise(seating_sd=seating_sd))
        campaign, tests = drawn.campaign(), drawn.penetration
        readings = readings_of(tests, campaign.tools, geometry="extended")
        found = series_estimates(campaign, tests, readings).unloading
        there = np.isfinite(drawn.unloading_ratio)
        assert (there == (found.n_readings > 0)).all()
        truth = 1.0 / drawn.unloading_ratio[there]
        low, high = found.rebound_ratio_interval[there].T
        errors += (found.rebound_ratio[there] / truth - 1.0).tolist()
        held += ((low <= truth) & (truth <= high)).tolist()
        means += [each.ratio for each in site_unloading(found, there, tests.site) if each.site is not None]
    assert abs(np.mean(errors)) < 0.01
    assert 0.93 < np.mean(held) < 0.99
    harmonic = 10.0 * math.exp(-(0.15**2) / 2.0)
    assert np.mean(means) == pytest.approx(harmonic, rel=0.01)  # 18 sites of 0.15/√30 each: 0.6 %


def test_an_error_of_the_deepest_reading_counts_once(make_campaign: MakeCampaign) -> None:
    """It moves the line and the depth that the rebound is compared with: the standard error against differences.

    Only the gauge errs, by u, and the depth zero is known: the variance is u² Σ (ds/de_j)².
    """
    campaign = make_campaign([*flat("P1", ratio=2.0), *edged("P2", ratio=2.0)], columns=BRANCH)
    tests, u, step = campaign.penetration, 1e-5, 1e-7
    assert tests is not None
    branch = present(tests.unloading)
    readings = readings_of(tests, campaign.tools, geometry="extended")
    H_V = hardness_at_largest_load(readings, DEFINITIONS["H_V"])
    priors = replace(DEFAULT_PRIORS, rebound=1e-9)
    model = fit_campaign(readings, H_V, ReadingUncertainty(depth=u, load=0.0), priors=priors)
    model = replace(model, offset=np.zeros(2), covariance=np.zeros((2, 3, 3)))
    value = hardness(readings, DEFINITIONS["H_V"], model)

    def fitted(top: float = 0.0, returning: FloatArray | float = 0.0) -> Unloading:
        depth = readings.penetration_depth.copy()
        depth[readings.largest] += top
        back = replace(branch, penetration_depth=branch.penetration_depth + returning)
        moved = replace(readings, penetration_depth=depth)
        return unloading(replace(tests, unloading=back), moved, value, model, np.zeros(2, dtype=bool))

    by_top = (fitted(top=step).rebound_ratio - fitted(top=-step).rebound_ratio) / (2 * step)
    squares = by_top**2
    for j in range(3):
        shift = np.where(np.arange(6) % 3 == j, step, 0.0)
        squares += ((fitted(returning=shift).rebound_ratio - fitted(returning=-shift).rebound_ratio) / (2 * step)) ** 2
    np.testing.assert_allclose(fitted().rebound_ratio_error, u * np.sqrt(squares), rtol=2e-3)
    deepest = readings.penetration_depth[readings.largest]
    above, limit = (
        unloading(tests, readings, value, replace(model, offset=share * deepest), np.zeros(2, dtype=bool))
        for share in (2.0, 0.9)
    )
    assert above.rebound_ratio.tolist() == limit.rebound_ratio.tolist()
    assert np.isfinite(limit.rebound_ratio).all()


def test_an_interval_that_reaches_zero_has_no_reciprocal() -> None:
    ratio, ends = _stiffness_ratio(np.array([0.1, 0.1]), np.array([[-0.1, 0.3], [0.05, 0.2]]))
    assert ratio.tolist() == [10.0, 10.0]
    assert np.isnan(ends[0]).all()
    assert ends[1].tolist() == [5.0, 20.0]


ROW = ("s1", "A", "blade", 90, 6, 250, 30)


def one(campaign: Campaign) -> tuple[float, float, list[float]]:
    found = shear_stress(campaign, present(campaign.shear))
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
    found = shear_stress(campaign, present(campaign.shear))
    covered = np.mean((found.interval[:, 0] <= truth * 1e6) & (truth * 1e6 <= found.interval[:, 1]))
    assert abs(covered - 0.95) < 3 * math.sqrt(0.95 * 0.05 / n) + 0.002


ARM, LARGEST, WAY = 250.0, 30.0, 2.0
"""r in mm, M_f in N m, u_y in mm."""
SHARES = (0.05, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0, 0.9)
COLUMN = ",turning_angle_deg"


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


def analysed_shear_tests(make_campaign: MakeCampaign, rows: list[Row], **how: Any) -> skisnow.Analysis:
    return skisnow.analyse(make_campaign((), rows, shear_columns=COLUMN, **how), n_resamples=100)


def test_an_exact_test_gives_its_way_back(make_campaign: MakeCampaign) -> None:
    row = analysed_shear_tests(make_campaign, turned()).results["shear"]["experiments"][0]
    assert row["n_turning"] == 4  # below 10 % the plate comes to lie, above 90 % the snow fails, behind it has failed
    assert row["shear_displacement_mm"] == pytest.approx(WAY, rel=1e-9)
    assert row["S_f_N_per_mm2"] == pytest.approx(LARGEST / 0.25 / 600)


def test_stated_uncertainties_widen_an_exact_test_s_interval(make_campaign: MakeCampaign) -> None:
    """2 % of the moment and 1.5 % of the lever arm are 2.5 % together; two of four readings are left."""
    rows = analysed_shear_tests(make_campaign, turned(), moment=0.02 * LARGEST, arm=0.015 * ARM).results["shear"]
    half = 0.025 * float(stats.t.ppf(0.975, 2))
    assert rows["experiments"][0][SHEAR_DISPLACEMENT_INTERVAL] == pytest.approx(
        [WAY * math.exp(-half), WAY * math.exp(half)], rel=1e-6
    )


def test_a_pole_that_twists_is_taken_off(make_campaign: MakeCampaign) -> None:
    """45 N m for a degree: under 30 N m the pole twists by 0.67°, which is 2.9 mm at the plate."""
    rows = turned(stiffness=45.0)
    alone = analysed_shear_tests(make_campaign, rows).results["shear"]["experiments"][0]
    assert alone["shear_displacement_mm"] == pytest.approx(WAY + ARM * math.radians(30 / 45))
    (tmp := make_campaign((), rows, shear_columns=COLUMN).folder).joinpath("campaign.toml").write_text(
        "pole_stiffness_Nm_per_deg = 45\n" + (tmp / "campaign.toml").read_text("utf-8"), encoding="utf-8"
    )
    results = skisnow.analyse(tmp, n_resamples=100).results
    assert results["shear"]["experiments"][0]["shear_displacement_mm"] == pytest.approx(WAY)
    assert results["campaign"]["pole_stiffness_Nm_per_deg"] == pytest.approx(45.0)


def test_two_readings_have_no_interval_and_one_has_nothing(make_campaign: MakeCampaign) -> None:
    rows = turned()
    for kept, known in (([1, 2, 6], True), ([1, 6], False)):
        row = analysed_shear_tests(make_campaign, [rows[index] for index in kept]).results["shear"]["experiments"][0]
        assert (row["shear_displacement_mm"] is not None) == known
        assert row[SHEAR_DISPLACEMENT_INTERVAL] is None


def test_a_snow_and_its_file_have_the_shear_displacement(make_campaign: MakeCampaign, tmp_path: Path) -> None:
    """Geometric mean of 1, 2 and 4 mm at site A: 2 mm."""
    rows = [row for name, way in (("S1", 1.0), ("S2", 2.0), ("S3", 4.0)) for row in turned(name, way)]
    pressed = [("P1", site, "ski", 30, load, load / 100) for site in ("A",) for load in (100, 200, 300)]
    campaign = make_campaign(pressed, [*rows, *turned("S4", 9.0, site="B")], shear_columns=COLUMN)
    found = skisnow.analyse(campaign, n_resamples=100)
    of_A, of_B, of_all = found.results["shear"]["displacement"]
    assert [(row["site"], row["n"]) for row in (of_A, of_B, of_all)] == [("A", 3), ("B", 1), (None, 4)]
    assert of_A["shear_displacement_mm"] == pytest.approx(2.0)
    assert of_all[SHEAR_DISPLACEMENT_INTERVAL] is None
    path = tmp_path / "results.json"
    path.write_text(json.dumps(results_dict(found)), encoding="utf-8")
    snow = found.snow("A")
    read = skisnow.read_snow(path, site="A")
    assert snow.shear_displacement == read.shear_displacement == pytest.approx(2e-3)
    assert snow.shear_displacement_interval == read.shear_displacement_interval
    turn = skisnow.load_scenario("carved-46m")
    assert turn.with_(snow=snow).contact.shear_displacement == snow.shear_displacement
    assert turn.with_(snow="race-piste").contact.shear_displacement == turn.contact.shear_displacement


def test_true_shear_displacement_is_covered_without_bias(make_campaign: MakeCampaign) -> None:
    """1000 tests of 2 mm whose angle is read with 0.03°, 0.13 mm at the plate: bias below 1 %, coverage 95 ± 2 %."""
    rng = np.random.default_rng(5)
    rows = [row for index in range(1000) for row in turned(f"S{index}", noise=rng, reading=0.03)]
    campaign = make_campaign((), rows, shear_columns=COLUMN)
    found = shear_displacement(campaign, present(campaign.shear))
    assert np.mean(found.value) == pytest.approx(WAY * 1e-3, rel=0.01)
    low, high = found.interval.T
    assert np.mean((low <= WAY * 1e-3) & (high >= WAY * 1e-3)) == pytest.approx(0.95, abs=0.021)
    sites = [f"{index % 50}" for index in range(1000)]
    means = [each for each in site_values(found.value, np.ones(1000, dtype=bool), sites) if each.site is not None]
    covered = np.mean([each.low <= WAY * 1e-3 <= each.high for each in means])
    assert covered >= 0.88  # 50 sites of 20 tests: 95 % ± 2.3 standard errors
