"""Comparisons of sites, tools, observers and days against scipy, statsmodels and simulations."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from scipy import stats
from statsmodels.regression.linear_model import OLS
from statsmodels.stats.multitest import multipletests

import skisnow
from skisnow.estimation.group_comparisons import Measured, compare_groups, letters_of_groups, measured
from skisnow.estimation.parts import site_means

from .conftest import MakeCampaign


def of(logs: np.ndarray, error: float | np.ndarray = 0.0, **labels: list[str]) -> Measured:
    return Measured("H_V", logs, np.broadcast_to(np.asarray(error) ** 2, logs.shape), labels)


def test_equal_scatter_is_students_pooled_test() -> None:
    rng = np.random.default_rng(4)
    a, b = rng.normal(0.4, 0.3, 12), rng.normal(0.0, 0.3, 8)
    (row,) = compare_groups(of(np.concatenate((b, a)), site=["B"] * 8 + ["A"] * 12), "site")
    peer = stats.ttest_ind(a, b)
    interval = peer.confidence_interval(0.95)
    assert (row.group_a, row.group_b, row.n_a, row.n_b) == ("A", "B", 12, 8)
    assert row.ratio == pytest.approx(math.exp(a.mean() - b.mean()), rel=1e-12)
    assert row.p == pytest.approx(peer.pvalue, rel=1e-9)
    np.testing.assert_allclose(row.interval, np.exp([interval.low, interval.high]), rtol=1e-9)


def test_unequal_scatter_is_welchs_test() -> None:
    rng = np.random.default_rng(4)
    a, b = rng.normal(0.3, 0.1, 12), rng.normal(0.0, 0.6, 9)
    (row,) = compare_groups(of(np.concatenate((a, b)), site=["A"] * 12 + ["B"] * 9), "site")
    peer = stats.ttest_ind(a, b, equal_var=False)
    assert row.p == pytest.approx(peer.pvalue, rel=1e-9)
    interval = peer.confidence_interval(0.95)
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
    """Against statsmodels; of equal sites some pair is below 0.05 in one campaign of twenty, 400 campaigns."""
    rng = np.random.default_rng(6)
    names = np.repeat(list("ABCDE"), 8).tolist()
    below = []
    for _ in range(400):
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
    for _ in range(400):
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
