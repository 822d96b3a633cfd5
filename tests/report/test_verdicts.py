"""Verdicts about pairs of sites: what is larger, whether that is certain, and how many tests it takes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection

from skisnow.campaign import Campaign
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.site_figures import sites
from skisnow.report.campaign.verdicts import verdict, verdicts
from skisnow.report.figures.drawing import Drawing, LeftOut

from .conftest import Reported, analysis_of, first_series


def row(ratio: float, low: float, high: float, value: float, **changes: Any) -> dict[str, Any]:
    """B against A, two tests at A and four at B."""
    pair = {
        "quantity": "H_V", "by": "site", "group_a": "A", "group_b": "B", "n_a": 2, "n_b": 4, "ratio": ratio,
        "interval": [low, high], "p": value, "p_holm": value, "n_pairs": 1, "n_needed": 30,
    }  # fmt: skip
    return pair | changes


def test_an_uncertain_pair_names_the_tests_that_would_decide() -> None:
    """The sentence of the specification, in both languages: 1/1.54 is A over B."""
    found = verdict(row(1 / 1.54, 1 / 2.52, 1 / 0.94, 0.07), 20.0)
    assert str(found) == (
        "B is harder than A by 54 % [-6, +152]: not certain. About 54 more tests with this scatter, 30 in each group, "
        "would find a difference of 20 % in four of five cases."
    )
    assert found.text("de") == (
        "B ist um 54 % härter als A [-6, +152]: nicht gesichert. Etwa 54 weitere Versuche mit dieser Streuung, 30 in "
        "jeder Gruppe, würden einen Unterschied von 20 % in vier von fünf Fällen erkennen."
    )


@pytest.mark.parametrize(
    ("pair", "ending"),
    [
        (row(0.5, 0.4, 0.6, 0.001), ": certain (p = 0.001)."),
        (row(0.5, 0.4, 0.6, 1e-9), ": certain (p < 0.001)."),
        (row(0.5, 0.4, 0.6, 0.01, p_holm=0.03, n_pairs=3), ": certain (p = 0.03, corrected for 3 pairs)."),
        (row(0.98, 0.9, 1.1, 0.7), ": the difference is below 20 %."),
        (
            row(0.9, 0.7, 1.1, 0.2, n_needed=2),
            ". The tests suffice to find a difference of 20 % in four of five cases.",
        ),
        (row(0.9, 0.7, 1.1, 0.2, p=None, p_holm=None, interval=None, n_needed=None), "the scatter is unknown."),
    ],
)
def test_endings(pair: dict[str, Any], ending: str) -> None:
    found = str(verdict(pair, 20.0))
    assert found.startswith("B is harder than A by ")
    assert found.endswith(ending)


def test_the_larger_group_comes_first_and_many_times_is_a_multiple() -> None:
    assert str(verdict(row(5.0, 4.0, 6.25, 1e-5), 20.0)).startswith("A is 5 times as hard as B [4, 6.25]: certain")
    shear = str(verdict(row(0.2, 0.16, 0.25, 1e-5, quantity="S_f"), 20.0))
    assert shear.startswith("B has 5 times the shear strength of A [4, 6.25]: certain")
    tool = str(verdict(row(1.5, 1.2, 1.9, 1e-5, by="tool"), 20.0))
    assert tool.startswith("The hardness is larger for A than for B, at the same sites, by 50 % [+20, +90]")


def test_many_sites_have_a_survey_and_their_uncertain_pairs(reference: Reported) -> None:
    found = verdicts(reference.results)
    rows = reference.results["group_comparisons"]
    for quantity, survey in zip(("H_V", "S_f"), (found[0], found[1]), strict=True):
        pairs = [pair for pair in rows if pair["quantity"] == quantity]
        fields = survey.fields["survey"].fields
        assert fields["certain"] == sum(pair["p_holm"] < 0.05 for pair in pairs)
        assert fields["pairs"] == len(pairs)
        means = {each["site"]: each["mean"] for each in reference.results["site_means"]
                 if each["quantity"].startswith(quantity)}  # fmt: skip
        assert fields["a"] == max(means, key=means.__getitem__)
        assert fields["b"] == min(means, key=means.__getitem__)
    assert all("not certain" in sentence for sentence in found[2:])


def test_the_figure_shows_each_site_with_mean_interval_and_letters(reference: Reported) -> None:
    drawing = sites(ReportData(reference.analysis), ())
    assert isinstance(drawing, Drawing)
    for axes, quantity in zip(drawing.figure.axes, ("H_V_N_per_mm3", "S_f_N_per_mm2"), strict=True):
        rows = sorted(
            (each for each in reference.results["site_means"] if each["quantity"] == quantity),
            key=lambda each: each["mean"],
        )
        assert [label.get_text() for label in axes.get_yticklabels()] == [each["site"] for each in rows]
        assert [text.get_text() for text in axes.texts] == [each["letters"] for each in rows]
        (bars,) = axes.collections
        assert isinstance(bars, LineCollection)
        ends = [segment[:, 0] for segment in bars.get_segments()]
        np.testing.assert_allclose(ends, [each["interval"] for each in rows])


def test_one_site_has_neither_figure_nor_verdict(campaign: Campaign) -> None:
    analysis = analysis_of(replace(campaign, shear=None, penetration=first_series(campaign, 30)))
    assert isinstance(sites(ReportData(analysis), ()), LeftOut)
    assert verdicts(analysis.results) == []
