"""The quality flag that needs the hardness, and what flags do to an experiment."""

import numpy as np
import pytest

import skisnow
from skisnow._support.units import N_PER_MM2, N_PER_MM3
from skisnow.campaign import reference_campaign
from skisnow.estimation import quality_flags
from skisnow.estimation.screening import hardness_outliers, screened_penetration

from .conftest import MakeCampaign


def test_outlier_rule_by_hand() -> None:
    """ln H = 0, 0.1, 0.2, 0.3, 0.4 and x: limits 3.5 · 1.4826 · MAD around the median of all six."""
    H = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 0.4, 3.0]))
    used = np.ones(6, dtype=bool)
    # median 0.25, deviations .25 .15 .05 .05 .15 2.75: MAD 0.15, limit 0.778
    assert hardness_outliers(H, used, ["A"] * 6).tolist() == [False] * 5 + [True]
    inside = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 0.4, 1.02]))
    assert not hardness_outliers(inside, used, ["A"] * 6).any()


def test_a_site_needs_five_used_series_and_a_scatter() -> None:
    H = np.exp(np.array([0.0, 0.1, 0.2, 0.3, 9.0]))
    everything = np.ones(5, dtype=bool)
    assert hardness_outliers(H, everything, ["A"] * 5).any()
    assert not hardness_outliers(H, np.array([True] * 4 + [False]), ["A"] * 5).any()
    assert not hardness_outliers(np.exp(np.array([0, 0, 0, 0, 9.0])), everything, ["A"] * 5).any()
    assert not hardness_outliers(H, everything, ["A"] * 4 + ["B"]).any()


def series(name: str, hardness: float) -> list[tuple[object, ...]]:
    """A flat series of the ski piece with H_V in N/mm³."""
    return [(name, "A", "ski", 0, load, round(load / (hardness * 12400), 4)) for load in (100, 200, 300)]


@pytest.mark.parametrize(("extra", "used"), [("", True), ('[screening]\nexclude = ["hardness_outlier"]\n', False)])
def test_an_outlier_stays_unless_it_is_excluded(make_campaign: MakeCampaign, extra: str, used: bool) -> None:
    rows = [row for i, H in enumerate((0.1, 0.11, 0.12, 0.13, 0.14, 0.9)) for row in series(f"p{i}", H)]
    campaign = make_campaign(rows, extra=extra, gauge=0.0001)
    found = screened_penetration(campaign, geometry="extended")
    assert found.codes()[-1] == ["hardness_outlier"]
    assert found.used.tolist() == [True] * 5 + [used]
    flag = next(p for p in quality_flags(campaign) if p.code == "hardness_outlier")
    assert (flag.severity, flag.file, flag.experiment, flag.row) == ("mark", "penetration.csv", "p5", 19)


def test_excluding_flags_keep_a_series_out(make_campaign: MakeCampaign) -> None:
    rows = [*series("p1", 0.1), ("p2", "A", "ski", 0, 100, 1.0), ("p2", "A", "ski", 0, 200, 0.9)]
    campaign = make_campaign(rows)
    found = screened_penetration(campaign, geometry="extended")
    assert found.codes() == [[], ["too_few_loads", "depth_shrinks"]]
    assert found.used.tolist() == [True, False]


# The interval of a site's mean is one number, whether a report of the campaign or of a turn prints it


def test_the_snow_of_a_site_has_the_interval_of_its_mean() -> None:
    found = skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)
    means = {(row["quantity"], row["site"]): row for row in found.results["site_means"]}
    for letter in "CE":
        snow = found.snow(letter)
        for key, unit, value, interval in (
            ("H_V_N_per_mm3", N_PER_MM3, snow.snow_hardness, snow.snow_hardness_interval),
            ("S_f_N_per_mm2", N_PER_MM2, snow.failure_shear_stress, snow.failure_shear_stress_interval),
        ):
            row = means[key, f"site {letter}"]
            assert value is not None
            assert interval is not None
            assert value / unit == pytest.approx(row["mean"], rel=1e-12)
            assert [end / unit for end in interval] == pytest.approx(row["interval"], rel=1e-9)
