"""A campaign of two sites: the report leads with the sites, gives no interval over them and judges no slope on them."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from skisnow.field import Campaign
from skisnow.report.material import Material
from skisnow.report.numerals import interval, significant
from skisnow.report.sentences.caveats import caveats
from skisnow.report.sentences.key_results import key_results
from skisnow.report.sentences.regressions import regression_sentences

from .conftest import analysis_of, first_series


def plain(markup: str) -> str:
    return re.sub(r"<[^>]+>", "", str(markup)).replace("\u00a0", " ")


@pytest.fixture(scope="module")
def material(campaign: Campaign) -> Material:
    two = replace(campaign, name="real", shear=None, penetration=first_series(campaign, 60))
    return Material(analysis_of(two))


def test_the_first_sentence_is_about_the_sites(material: Material) -> None:
    hardness = plain(key_results(material)[0])
    (ratio,) = material.results["site_comparisons"]
    for row in material.results["site_means"]:
        assert f"{row['site']} {significant(row['mean'])} N/mm³ (95 % interval {interval(row['interval'])}" in hardness
    assert f"site A over site B: {significant(ratio['ratio'])} (95 % interval {interval(ratio['interval'])}" in hardness
    assert "without an interval: fewer than 4 sites" in hardness


def test_no_slope_on_two_densities_is_called_significant(material: Material) -> None:
    relations = plain(key_results(material)[-1])
    assert relations.startswith("Relations: significant at 5 %: none; not significant: none; not judged")
    density = next(text for text in map(plain, regression_sentences(material)) if text.startswith("HV on snow density"))
    assert "not judged: the predictor takes 2 different values" in density
    assert "significant" not in density


def test_warnings_of_fits_come_first_among_the_caveats(material: Material) -> None:
    told = replace_warnings(material, ["The rmse of H_e:a=linear,b=linear (15647 N) is above the loads."])
    assert plain(caveats(told)[0]).startswith("The rmse of He:a=linear,b=linear (15647 N)")


def replace_warnings(material: Material, warnings: list[str]) -> Material:
    found = material.analysis.penetration
    assert found is not None
    return Material(replace(material.analysis, penetration=replace(found, warnings=tuple(warnings))))
