"""Sites of a campaign and their comparison."""

import math
from itertools import combinations

import numpy as np
import pytest
from scipy import stats

import skisnow
from skisnow.estimation import campaign_notes
from skisnow.estimation.comparisons import compare_with_published, own_mean
from skisnow.estimation.group_comparisons import Measured, compare_groups, letters_of_groups, measured
from skisnow.estimation.parts import site_means
from skisnow.estimation.regressions import (
    DENSITY_KEY,
    DROP_CONE_KEY,
    HARDNESS_KEY,
    STRESS_KEY,
    penetration_observations,
    shear_observations,
    spot_observations,
)

from .conftest import MakeCampaign


def test_own_mean_over_one_site_is_the_classical_interval() -> None:
    values = np.array([0.1, 0.2, 0.15, 0.3])
    own = own_mean(values, ["A"] * 4, geometric=True)
    logs = np.log(values)
    low, high = np.exp(stats.t.interval(0.95, 3, logs.mean(), logs.std(ddof=1) / 2))
    assert (own.value, own.low, own.high) == pytest.approx((math.exp(logs.mean()), low, high))
    assert (own.minimum, own.maximum) == (0.1, 0.3)


def test_own_mean_over_balanced_sites_is_the_interval_of_their_means() -> None:
    values, sites = np.array([1.0, 1.2, 2.0, 2.2, 4.0, 4.4, 3.0, 3.2]), [*"AABBCCDD"]
    own = own_mean(values, sites, geometric=True)
    means = np.log(values).reshape(4, 2).mean(axis=1)
    low, high = np.exp(stats.t.interval(0.95, 3, means.mean(), means.std(ddof=1) / 2))
    assert (own.value, own.low, own.high) == pytest.approx((math.exp(means.mean()), low, high))


def test_the_interval_of_a_plain_mean_is_that_of_its_logarithm_and_never_below_zero() -> None:
    """Delta method: the half-width of ln m is that of m over m."""
    values = np.array([0.02, 0.5, 0.03])
    own = own_mean(values, ["A"] * 3, geometric=False)
    low, high = stats.t.interval(0.95, 2, values.mean(), values.std(ddof=1) / math.sqrt(3))
    assert low < 0 < own.low < own.value < own.high
    assert math.log(own.high / own.low) == pytest.approx((high - low) / values.mean())
    assert own.low * own.high == pytest.approx(own.value**2)


@pytest.mark.parametrize("geometric", [True, False])
def test_two_or_three_sites_give_no_interval_over_them(geometric: bool) -> None:
    values = np.array([1.0, 1.2, 2.0, 2.2, 4.0, 4.4, 3.0, 3.2])
    for sites in ("AABB", "AABBCC"):
        own = own_mean(values[: len(sites)], [*sites], geometric=geometric)
        assert math.isnan(own.low)
        assert math.isnan(own.high)
    assert math.isfinite(own_mean(values, [*"AABBCCDD"], geometric=geometric).low)


def test_each_site_has_its_own_mean_with_the_interval_of_its_experiments() -> None:
    values = np.array([3.0, 0.1, 0.2, 0.15, 0.3])
    first, second = site_means("S_f_N_per_mm2", values, ["B", "A", "A", "A", "A"], geometric=False)
    assert (first.site, first.n, second.site, second.n) == ("A", 4, "B", 1)
    assert first.own == own_mean(values[1:], ["A"] * 4, geometric=False)
    assert second.own.value == 3.0
    assert math.isnan(second.own.low)


def test_values_without_a_logarithm_have_no_geometric_mean_and_no_interval() -> None:
    none = own_mean(np.array([0.0, 1.0]), ["A"] * 2, geometric=True)
    assert np.isnan([none.value, none.low, none.high, none.minimum, none.maximum]).all()
    below = own_mean(np.array([-1.0, 0.5]), ["A"] * 2, geometric=False)
    assert below.value == -0.25
    assert math.isnan(below.low) and math.isnan(below.high)


def test_published_values_are_those_that_the_paper_prints() -> None:
    own = own_mean(np.array([1.0, 2.0]), ["A", "A"], geometric=False)
    density = own_mean(np.array([500.0, 500.0]), ["A", "A"], geometric=False)
    rows = compare_with_published(own, own, (own, own), density)
    values = {(row.source, row.quantity): row.published for row in rows}
    hardness = [v for (s, q), v in values.items() if "Federolf" in s and q == "H_V_N_per_mm3"]
    stress = [v for (s, q), v in values.items() if "Federolf" in s and q == "S_f_N_per_mm2"]
    # as many digits as are printed
    assert [f"{value:.2g}" for value in hardness if isinstance(value, float)] == ["0.21", "0.16", "0.022"]
    assert [f"{value:.2g}" for value in stress if isinstance(value, float)] == ["0.52", "0.086", "0.094"]
    domine = next(v for (s, _), v in values.items() if "Domine" in s)
    assert domine == pytest.approx(1585e-6, rel=1e-3)
    eqn_14 = next(v for (s, _), v in values.items() if "Eqn 14" in s)
    assert eqn_14 == pytest.approx(0.108, abs=1e-6)
    assert values["Mössner and others 2013, range", "H_V_N_per_mm3"] == (0.04, 90.0)


DENSITY = "sample,site,snow_density_kg_per_m3\n1,oben,400\n2,untem,420\n"


def shear(name: str, site: str) -> tuple[object, ...]:
    return (name, site, "blade", 90, 6, 250, 30)


def test_sites_named_nearly_alike_and_densities_of_no_site(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(
        shear=[shear("s1", "oben"), shear("s2", "Oben"), shear("s3", "unten")],
        further={"density.csv": DENSITY, "Tests.ods": "not a table"},
    )
    alike, lost, unread = campaign_notes(campaign)
    assert "'Oben', 'oben'" in alike
    assert "'untem'" in lost
    assert unread.endswith("Tests.ods.")
    assert skisnow.results_dict(skisnow.analyse(campaign))["campaign"]["remarks"] == [alike, lost, unread]


def test_a_campaign_in_order_has_none(make_campaign: MakeCampaign) -> None:
    campaign = make_campaign(
        shear=[shear("s1", "oben"), shear("s2", "unten")], further={"density.csv": DENSITY.replace("untem", "unten")}
    )
    assert campaign_notes(campaign) == ()


def test_corrections_leave_their_trace_in_the_results(make_campaign: MakeCampaign) -> None:
    header = "file,experiment,row,column,old,new,who,when,why\n"
    rows = "shear.csv,s1,2,moment_Nm,30,33,AM,2024-03-14,misread\n"
    campaign = make_campaign(shear=[shear("s1", "oben")], further={"corrections.csv": header + rows})
    results = skisnow.results_dict(skisnow.analyse(campaign))
    assert results["shear"]["experiments"][0]["F_t_N"] == 33 / 0.25
    (told,) = results["campaign"]["corrections"]
    assert (told["file"], told["row"], told["column"], told["old"], told["new"]) == (
        "shear.csv",
        2,
        "moment_Nm",
        "30",
        "33",
    )
    assert (told["who"], told["when"], told["why"]) == ("AM", "2024-03-14", "misread")


# Which density, drop-cone depth and spot an experiment has


SNOW = {
    "density.csv": "sample,site,snow_density_kg_per_m3\n1,A,400\n2,A,440\n3,B,500\n",
    "drop_cone.csv": "test,site,repeat,drop_cone_depth_mm\nt1,A,1,10\nt1,A,2,12\nt2,A,1,21\n",
}


def series(name: str, site: str, depth: float, *more: object) -> list[tuple[object, ...]]:
    return [(name, site, "ski", 0, load, depth * load / 300, *more) for load in (100, 200, 300)]


def test_own_value_wins_else_the_site_s_mean_else_none(make_campaign: MakeCampaign) -> None:
    """Density: mean of samples. Drop cone: mean of the tests' means, (11 + 21)/2, not of the three repeats."""
    rows = [*series("p1", "A", 1, ""), *series("p2", "A", 1, 480), *series("p3", "C", 1, "")]
    campaign = make_campaign(rows, columns=",snow_density_kg_per_m3", further=SNOW)
    found = penetration_observations(campaign, np.ones(3), np.ones(3, dtype=bool))
    np.testing.assert_allclose(found.columns[DENSITY_KEY], [420, 480, math.nan])
    np.testing.assert_allclose(found.columns[DROP_CONE_KEY], [16, 16, math.nan])


def test_a_spot_pairs_geometric_mean_hardness_with_mean_stress(make_campaign: MakeCampaign) -> None:
    """The same spot name at another site is another spot; experiments not used take no part."""
    rows = [
        *series("p1", "A", 1, "x"),
        *series("p2", "A", 1, "x"),
        *series("p3", "B", 1, "x"),
        *series("p4", "A", 1, ""),
    ]
    shear = [
        (f"s{i}", site, "blade", 90, 6, 250, 30, spot)
        for i, (site, spot) in enumerate([("A", "x"), ("A", "x"), ("C", "x")])
    ]
    campaign = make_campaign(rows, shear, columns=",spot", shear_columns=",spot")
    hardness = penetration_observations(campaign, np.array([1e9, 4e9, 7e9, 9e9]), np.ones(4, dtype=bool))
    stress = shear_observations(campaign, np.array([1e5, 3e5, 9e5]), np.ones(3, dtype=bool))
    found = spot_observations(hardness, stress)
    assert (found.site, found.spot) == (("A",), ("x",))
    assert found.columns[HARDNESS_KEY].tolist() == pytest.approx([2.0])
    assert found.columns[STRESS_KEY].tolist() == pytest.approx([0.2])
    only_first = spot_observations(
        penetration_observations(campaign, np.array([1e9, 4e9, 7e9, 9e9]), np.array([True, False, True, True])), stress
    )
    assert only_first.columns[HARDNESS_KEY].tolist() == pytest.approx([1.0])


def test_regression_on_density_equals_a_line_by_numpy(make_campaign: MakeCampaign) -> None:
    density = [400, 450, 480, 520, 560, 600]
    moment = [10, 14, 13, 18, 22, 21]
    shear = [
        (f"s{i}", "AB"[i % 2], "blade", 90, 6, 250, m, d) for i, (m, d) in enumerate(zip(moment, density, strict=True))
    ]
    campaign = make_campaign(shear=shear, shear_columns=",snow_density_kg_per_m3")
    results = skisnow.results_dict(skisnow.analyse(campaign))
    row = next(r for r in results["regressions"] if r["terms"][1] == DENSITY_KEY and r["response"] == STRESS_KEY)
    slope, intercept = np.polyfit(density, np.array(moment) / 0.25 / 600, 1)
    assert row["b"] == pytest.approx([intercept, slope], rel=1e-9)
    assert row["n"] == 6
    assert row["rmse"] == pytest.approx(row["rmse_dof"] * math.sqrt(4 / 6))
    assert row["interval_by_site"] is not None


@pytest.mark.parametrize(
    ("density", "judged"), [([400, 450], False), ([400, 450, 520], False), ([400, 450, 520, 600], True)]
)
def test_a_predictor_needs_four_values(make_campaign: MakeCampaign, density: list[int], judged: bool) -> None:
    """The slope stands; F and p are withheld with the reason, however clear the relation looks."""
    values = [density[i % len(density)] for i in range(12)]
    shear = [(f"s{i}", "AB"[i % 2], "blade", 90, 6, 250, d / 20 + 0.1 * i, d) for i, d in enumerate(values)]
    campaign = make_campaign(shear=shear, shear_columns=",snow_density_kg_per_m3")
    results = skisnow.results_dict(skisnow.analyse(campaign, n_resamples=100))
    row = next(r for r in results["regressions"] if r["terms"][1] == DENSITY_KEY and r["response"] == STRESS_KEY)
    assert row["predictor_values"] == len(density)
    assert row["b"][1] > 0
    if judged:
        assert row["p"] < 1e-6
        assert row["withheld"] is None
    else:
        assert (row["F"], row["p"]) == (None, None)
        assert f"{len(density)} different values" in row["withheld"]


def of(logs: np.ndarray, error: float | np.ndarray = 0.0, **labels: list[str]) -> Measured:
    return Measured("H_V", logs, np.broadcast_to(np.asarray(error) ** 2, logs.shape), labels)


@pytest.mark.parametrize(("of_a", "of_b", "is_equal"), [(0.3, 0.3, True), (0.1, 0.6, False)])
def test_equal_scatter_is_students_pooled_test_and_unequal_is_welchs(of_a: float, of_b: float, is_equal: bool) -> None:
    rng = np.random.default_rng(4)
    a, b = rng.normal(0.4, of_a, 12), rng.normal(0.0, of_b, 8)
    (row,) = compare_groups(of(np.concatenate((b, a)), site=["B"] * 8 + ["A"] * 12), "site")
    peer = stats.ttest_ind(a, b, equal_var=is_equal)
    interval = peer.confidence_interval(0.95)
    assert (row.group_a, row.group_b, row.n_a, row.n_b) == ("A", "B", 12, 8)
    assert row.ratio == pytest.approx(math.exp(a.mean() - b.mean()), rel=1e-12)
    assert row.p == pytest.approx(peer.pvalue, rel=1e-9)
    np.testing.assert_allclose(row.interval, np.exp([interval.low, interval.high]), rtol=1e-9)


def test_errors_of_the_experiments_bound_the_interval_from_below() -> None:
    """Two tests at each site that agree by chance: the interval is that of their known errors at least."""
    (row,) = compare_groups(of(np.array([0.1, 0.1, 0.3, 0.3]), 0.2, site=[*"AABB"]), "site")
    half = stats.t.ppf(0.975, 2) * 0.2  # the variance of the difference is 0.2²/2 + 0.2²/2
    np.testing.assert_allclose(np.log(row.interval), [-0.2 - half, -0.2 + half], rtol=1e-9)


def test_a_site_with_one_test_has_the_scatter_of_the_others() -> None:
    rows = compare_groups(of(np.log([1.0, 1.2, 1.1, 2.0, 2.2, 3.0]), site=[*"AAABBC"]), "site")
    assert [row.n_pairs for row in rows] == [3, 3, 3]
    assert all(math.isfinite(row.p) for row in rows)
    (row,) = compare_groups(of(np.log([1.0, 2.0]), site=["A", "B"]), "site")
    assert row.ratio == pytest.approx(0.5)
    assert math.isnan(row.p)
    assert np.isnan(row.interval).all()
    assert row.n_needed is None


def test_tools_are_compared_at_their_common_sites() -> None:
    """Sites differ tenfold and one tool is used mostly at the harder one; against statsmodels."""
    from statsmodels.regression.linear_model import OLS

    rng = np.random.default_rng(1)
    site = ["A"] * 8 + ["B"] * 8
    tool = ["disc"] * 6 + ["ski"] * 2 + ["disc"] * 2 + ["ski"] * 6
    logs = rng.normal(0, 0.1, 16) + math.log(10.0) * (np.array(site) == "B") + 0.3 * (np.array(tool) == "ski")
    (row,) = compare_groups(of(logs, site=site, tool=tool), "tool")
    design = np.column_stack([np.ones(16), np.array(site) == "B", np.array(tool) == "disc"]).astype(float)
    peer = OLS(logs, design).fit()
    assert math.log(row.ratio) == pytest.approx(peer.params[2], rel=1e-9)
    assert row.p == pytest.approx(peer.pvalues[2], rel=1e-6)
    np.testing.assert_allclose(np.log(row.interval), peer.conf_int()[2], rtol=1e-8)


def test_tools_without_a_common_site_have_no_ratio() -> None:
    logs = np.array([0.0, 0.1, 1.0, 1.1])
    assert compare_groups(of(logs, site=[*"AABB"], tool=["x", "x", "y", "y"]), "tool") == ()
    rows = compare_groups(of(np.zeros(6), site=[*"AABBCC"], tool=["x", "y", "y", "z", "w", "w"]), "tool")
    assert [(row.group_a, row.group_b) for row in rows] == [("x", "y"), ("x", "z"), ("y", "z")]


def test_number_of_tests_for_the_chosen_difference() -> None:
    """Normal approximation n = 2 (z₀.₉₇₅ + z₀.₈)² s²/ln²1.1; Student's t asks for one or two more."""
    rng = np.random.default_rng(3)
    logs = rng.normal(0, 0.2, (2, 30))
    (row,) = compare_groups(of(logs.ravel(), site=["A"] * 30 + ["B"] * 30), "site", 0.1)
    pooled = math.sqrt((logs[0].var(ddof=1) + logs[1].var(ddof=1)) / 2)
    normal = 2 * (1.959964 + 0.841621) ** 2 * pooled**2 / math.log(1.1) ** 2
    assert row.n_needed is not None
    assert normal < row.n_needed < normal + 3


def test_pairs_are_corrected_for_their_number() -> None:
    """Against statsmodels; of equal sites some pair is below 0.05 in one campaign of twenty, 200 campaigns."""
    from statsmodels.stats.multitest import multipletests

    rng = np.random.default_rng(6)
    names = np.repeat(list("ABCDE"), 8).tolist()
    below = []
    for _ in range(200):
        rows = compare_groups(of(rng.normal(0.0, 0.3, 40), site=names), "site")
        below.append(min(row.p_holm for row in rows) < 0.05)
    assert [row.n_pairs for row in rows] == [10] * 10
    _, expected, _, _ = multipletests([row.p for row in rows], method="holm")
    np.testing.assert_allclose([row.p_holm for row in rows], expected, rtol=1e-12)
    assert np.mean(below) < 0.05 + 3.0 * math.sqrt(0.05 * 0.95 / 400)


@pytest.mark.parametrize("sizes", [(2, 2), (1, 5), (3, 3, 3, 3)])
def test_intervals_cover_the_ratio_of_equal_sites(sizes: tuple[int, ...]) -> None:
    rng = np.random.default_rng(7)
    names = [chr(65 + index) for index, size in enumerate(sizes) for _ in range(size)]
    covered = []
    for _ in range(200):
        rows = compare_groups(of(rng.normal(0.0, math.hypot(0.3, 0.05), len(names)), 0.05, site=names), "site")
        covered += [row.interval[0] <= 1.0 <= row.interval[1] for row in rows]
    assert 0.92 < np.mean(covered) < 0.98


def test_sites_share_a_letter_where_they_are_not_shown_to_differ() -> None:
    rng = np.random.default_rng(0)
    names = np.repeat(list("ABC"), 10).tolist()
    values = np.exp(rng.normal(0, 0.2, 30) + np.repeat([0.0, 0.05, 2.0], 10))
    pairs = compare_groups(of(np.log(values), site=names), "site")
    assert letters_of_groups(pairs, ["C", "B", "A"]) == {"C": "a", "B": "b", "A": "b"}
    means = site_means("H_V_N_per_mm3", values, names, geometric=True, pairs=pairs)
    assert [(row.site, row.letters) for row in means] == [("A", "b"), ("B", "b"), ("C", "a")]


def test_sites_are_lettered_from_the_largest_mean() -> None:
    scatter = 0.02 * np.array([-1.0, 0.0, 1.0, 0.5, -0.5])
    logs = np.concatenate([each + scatter for each in (0.0, 2.0, 1.99)])
    sites = [*"AAAAABBBBBCCCCC"]
    pairs = compare_groups(of(logs, site=sites), "site")
    means = site_means("H_V", np.exp(logs), sites, geometric=True, pairs=pairs)
    assert [(mean.site, mean.letters) for mean in means] == [("A", "b"), ("B", "a"), ("C", "a")]
    (alone,) = site_means("H_V", np.exp(logs[:5]), sites[:5], geometric=True)
    assert alone.letters == ""


def test_errors_come_from_the_intervals() -> None:
    value = np.array([2.0, 4.0, 0.0, 5.0])
    interval = value[:, None] * np.exp(1.959964 * np.array([[-0.1, 0.1], [np.nan, np.nan], [0, 0], [-0.2, 0.2]]))
    found = measured("H_V", value, interval, np.array([True, True, True, False]), {"site": ("A", "B", "C", "D")})
    np.testing.assert_allclose(found.logs, np.log([2.0, 4.0]))
    np.testing.assert_allclose(np.sqrt(found.error2), [0.1, 0.0], rtol=1e-6)
    assert found.labels == {"site": ["A", "B"]}


def test_observers_and_days_of_a_campaign_are_compared(make_campaign: MakeCampaign) -> None:
    """H_V of the second observer is 20 % larger at the same site, whatever the scatter."""
    rows = []
    for number, (observer, day) in enumerate([("Ann", "2026-01-05"), ("Ben", "2026-01-05")] * 4):
        factor = 1.2 if observer == "Ben" else 1.0
        depth = 2.0 * (1.0 + 0.01 * number) / factor
        rows += [(f"p{number}", "A", "disc", 0, load, depth * load / 300, observer, f"{day}T09:{number:02d}")
                 for load in (100, 200, 300)]  # fmt: skip
    found = skisnow.analyse(make_campaign(rows, columns=",observer,time"), n_resamples=100).results
    (row,) = found["group_comparisons"]
    assert (row["quantity"], row["by"], row["group_a"], row["group_b"]) == ("H_V", "observer", "Ann", "Ben")
    assert row["ratio"] == pytest.approx(1 / 1.2, rel=0.02)
    assert row["p_holm"] == row["p"] < 0.05


def test_every_pair_of_sites_is_compared_once(make_campaign: MakeCampaign) -> None:
    rows = [(f"p{site}{n}", site, "disc", 0, load, load / 100 * (1 + 0.1 * n)) for site in "ABC" for n in range(3)
            for load in (100, 200, 300)]  # fmt: skip
    found = skisnow.analyse(make_campaign(rows), n_resamples=100).group_comparisons
    assert [(row.group_a, row.group_b) for row in found] == list(combinations("ABC", 2))
