"""The text for the terminal."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace

from skisnow.campaign import Campaign
from skisnow.report.campaign.summary import summary
from skisnow.report.campaign.verdicts import verdicts
from skisnow.report.formatting import interval, significant

from .conftest import Reported, first_series, results_of


def test_it_has_what_a_person_looks_for(reference: Reported) -> None:
    text = summary(reference.results)
    lines = text.splitlines()
    models = reference.results["penetration"]["models"]
    for model in models:
        line = next(line for line in lines if model["id"] in line[:40])
        assert f"{model['rmse_N']:.4g}" in line
    assert reference.results["penetration"]["selected"]["reason"] in text
    chosen = next(line for line in lines if line.startswith("* H_"))
    assert reference.results["penetration"]["selected"]["id"] in chosen
    own = next(row for row in reference.results["comparisons"] if row["quantity"] == "H_V_N_per_mm3")
    assert f"geometric mean {own['own']:.3g} N/mm³" in text
    assert "over 8 sites" in text
    judged = [row for row in reference.results["regressions"] if row["p"] is not None]
    told = text.partition("Regressions")[2]
    assert told.count("p = ") + told.count("p < ") == len(judged)


def test_synthetic_stands_beside_the_numbers(reference: Reported, campaign: Campaign) -> None:
    # a line for each site of H_V, of S_f, and of k_u/H_V, and for each verdict
    assert summary(reference.results).count("(synthetic)") == 4 + 8 + 7 + 4 + len(verdicts(reference.results))
    real = replace(campaign, name="Hintertux", place="", penetration=None)
    assert "synthetic" not in summary(results_of(real))


def test_few_sites_come_first_with_their_comparison_and_no_interval_over_them(campaign: Campaign) -> None:
    """Two sites of thirty series each: no p value rests on two densities, and no interval on two sites."""
    tests = first_series(campaign, 60)
    results = results_of(replace(campaign, name="real", shear=None, penetration=tests))
    lines = summary(results).splitlines()
    own = {row["site"]: row for row in results["site_means"]}
    places = [next(i for i, line in enumerate(lines) if f"H_V at {site}" in line) for site in ("site A:", "site B:")]
    for place, row in zip(places, own.values(), strict=True):
        told = (
            f"{significant(row['mean'])} N/mm³, 95 % interval {interval(row['interval'])} over its experiments, n = 30"
        )
        assert told in lines[place]
    (verdict,) = verdicts(results)
    ratio = lines.index(str(verdict))
    pooled = next(i for i, line in enumerate(lines) if line.startswith("H_V: geometric mean"))
    assert ratio < places[0] < places[1] < pooled
    assert "over 2 sites" in lines[pooled]
    density = next(line for line in lines if "H_V_N_per_mm3 on snow_density" in line)
    assert density.endswith("predictor: 2)")


def test_many_regressions_and_sites_are_cut_and_the_rest_counted(reference: Reported) -> None:
    row = next(row for row in reference.results["regressions"] if row["p"] is not None)
    sites = [each | {"site": f"{each['site']} {n}"} for each in reference.results["site_means"] for n in (1, 2)]
    for count in (20, 21, 23):
        text = summary(reference.results | {"regressions": [row] * count, "site_means": sites})
        assert text.count(f"  {row['response']} on {row['terms'][1]}") == 20
        assert (f" {count - 20} more in" in text) == (count > 20)
        assert "not judged" not in text
    counts = [sum(each["quantity"] == key for each in sites) for key in ("H_V_N_per_mm3", "S_f_N_per_mm2")]
    for count in counts:
        assert (f" {count - 8} more sites" in text) == (count > 8)
    assert max(counts) > 8


def test_a_campaign_with_nothing_has_a_summary(campaign: Campaign) -> None:
    silent = replace(campaign, penetration=None, shear=None, gauge_resolution=None, load_uncertainty=None)
    text = summary(results_of(silent))
    assert "penetration experiments: none" in text
    assert "no depth uncertainty" in text
    assert "load_uncertainty_N" in text


def test_it_prints_on_a_western_terminal(reference: Reported) -> None:
    text = summary(reference.results)
    assert text.encode("cp1252").decode("cp1252") == text


def test_it_does_not_wait_for_the_drawing_library() -> None:
    code = (
        "import sys, skisnow.report.campaign.summary; sys.exit('matplotlib' in sys.modules or 'jinja2' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
