"""A campaign of two sites: the report leads with the sites, gives no interval over them and judges no slope on them."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from skisnow.campaign import Campaign
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.key_results import key_results
from skisnow.report.formatting import interval, significant

from .conftest import Reported, altered, analysis_of, first_series


def plain(markup: str) -> str:
    return re.sub(r"<[^>]+>", "", str(markup)).replace("\u00a0", " ")


@pytest.fixture(scope="module")
def data(campaign: Campaign) -> ReportData:
    two = replace(campaign, name="real", shear=None, penetration=first_series(campaign, 60))
    return ReportData(analysis_of(two))


def test_the_first_sentence_is_about_the_sites(data: ReportData) -> None:
    hardness = plain(key_results(data)[0])
    for row in data.results["site_means"]:
        assert f"{row['site']} {significant(row['mean'])} N/mm³ (95 % interval {interval(row['interval'])}" in hardness
    assert "fewer than 4" in hardness


def test_one_site_has_an_interval_over_its_experiments(campaign: Campaign) -> None:
    one = replace(campaign, name="real", shear=None, penetration=first_series(campaign, 30))
    analysis = analysis_of(one)
    results = analysis.results
    hardness = plain(key_results(ReportData(analysis))[0])
    own = next(row for row in results["comparisons"] if row["quantity"] == "H_V_N_per_mm3")
    assert f"{significant(own['own'])} N/mm³ (95 % interval {interval(own['own_interval'])}" in hardness
    assert "30 of 30 penetration" in hardness


def test_relations_stand_where_their_p_value_puts_them(reference: Reported) -> None:
    results = reference.results
    rows = [row for row in results["regressions"] if row["p"] is not None][:4]
    judged = [row | {"p": p, "interval_by_site": None} for row, p in zip(rows, (0.011, 0.05, 0.049, 0.6), strict=True)]
    other = altered(reference.analysis, results | {"regressions": judged})
    relations = plain(key_results(ReportData(other))[-1])
    yes, no = relations.split("; not significant: ")
    assert re.findall(r"p = ([0-9.]+)", yes) == ["0.011", "0.049"]
    assert re.findall(r"p = ([0-9.]+)", no.partition(". How large")[0]) == ["0.050", "0.60"]
