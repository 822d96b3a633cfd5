"""Results of an analysis as objects, summaries and verdicts."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection

import skisnow
from skisnow import Analysis
from skisnow._support.errors import ParameterError
from skisnow.campaign import Campaign, read_campaign
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation.result_rows import experiment_hardness
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.site_figures import sites
from skisnow.report.campaign.summary import summary
from skisnow.report.campaign.verdicts import verdict, verdicts
from skisnow.report.charts import series_curves
from skisnow.report.figures.drawing import Drawing, LeftOut
from skisnow.report.figures.style import thinned
from skisnow.report.formatting import interval, significant
from tests.coded import raises

from .conftest import Reported, analysis_of, first_series


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return skisnow.analyse(reference_campaign(1).campaign(), n_resamples=100)


def test_dataframe_has_a_row_for_each_experiment(analysis: Analysis) -> None:
    pytest.importorskip("pandas")
    table = analysis.to_dataframe()
    rows = analysis.results["penetration"]["experiments"]
    assert table["experiment"].tolist() == [row["experiment"] for row in rows]
    assert table["H_V_N_per_mm3"].tolist() == [row["H_V_N_per_mm3"] for row in rows]
    ends = table[["H_V_low_N_per_mm3", "H_V_high_N_per_mm3"]].to_numpy().tolist()
    assert ends == [row["H_V_interval_N_per_mm3"] for row in rows]
    assert len(analysis.to_dataframe("shear")) == len(analysis.results["shear"]["experiments"])


def test_dataset_has_the_numbers_and_units_of_both_kinds(analysis: Analysis) -> None:
    pytest.importorskip("xarray")
    dataset = analysis.to_xarray()
    stress = dataset["shear_S_f_N_per_mm2"]
    assert (stress.dims, stress.units) == (("shear_experiment",), "N/mm²")
    expected = [row["S_f_N_per_mm2"] for row in analysis.results["shear"]["experiments"]]
    np.testing.assert_array_equal(stress.values, expected)
    assert dataset["penetration_H_V_low_N_per_mm3"].units == "N/mm³"


def test_what_is_not_there_is_an_error(analysis: Analysis) -> None:
    for unknown in ("model_rsme", "hardness_mean_force"):
        with raises(ParameterError, "unknown_figure"):
            analysis.plot(unknown)
    with raises(ParameterError, "no_data"):
        skisnow.analyse(replace(reference_campaign(1).campaign(), shear=None), n_resamples=100).plot("stress_angle")
    pytest.importorskip("pandas")
    with raises(ParameterError, "unknown_kind"):
        analysis.to_dataframe("shera")


def test_notebook_table_has_values(analysis: Analysis) -> None:
    """H_V and S_f with their intervals are cells of the table, as in the terminal."""
    html = analysis._repr_html_()
    for row in repr(analysis).splitlines()[1:]:
        name, _, text = row.strip().rstrip(">").partition(" ")
        assert f">{name}</th>" in html
        assert f">{text.strip()}</td>" in html


def test_each_series_has_the_law_of_its_own_tool_and_angle(tmp_path: Path) -> None:
    """A wedge of 200 mm: V = L e² / (2 tan ϑ), and a disc of 10 cm²: V = A e; without a depth there is no law."""
    diameter = float(2.0 * np.sqrt(1000.0 / np.pi))
    (tmp_path / "campaign.toml").write_text(
        f'[[tool]]\nname = "d"\nshape = "disc"\ndiameter_mm = {diameter!r}\n'
        '[[tool]]\nname = "s"\nshape = "ski"\nlength_mm = 200\nwidth_mm = 62\n'
    )
    rows = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm", "1,A,s,45,20,1", "1,A,s,45,80,2", "2,A,d,0,20,0"]
    rows += ["3,A,d,0,20,1", "3,A,d,0,40,2", "4,A,s,30,30,1", "4,A,s,30,120,2"]
    (tmp_path / "penetration.csv").write_text("\n".join(rows) + "\n")
    campaign = read_campaign(tmp_path)
    first, none, disc, last = series_curves(campaign, experiment_hardness(campaign))
    assert (none.experiment, none.law_depth_mm, none.law_load_N) == ("2", (), ())
    assert disc.load_N == (20.0, 40.0)
    assert disc.depth_mm == pytest.approx((1.0, 2.0), rel=1e-12)
    # each is on its law: the loads of the wedges go with the square of the depth, that of the disc with the depth
    for curve, loads in ((first, (20.0, 80.0)), (disc, (20.0, 40.0)), (last, (30.0, 120.0))):
        middle = len(curve.law_depth_mm) // 2
        assert (curve.law_depth_mm[middle], curve.law_depth_mm[-1]) == pytest.approx((1.0, 2.0), rel=1e-12)
        assert (curve.law_load_N[middle], curve.law_load_N[-1]) == pytest.approx(loads, rel=1e-12)


def test_it_has_the_verdicts_and_the_key_results(reference: Reported) -> None:
    lines = summary(reference.analysis).splitlines()
    for verdict_ in verdicts(reference.results):
        assert f"{verdict_} (synthetic)" in lines
    own = next(row for row in reference.results["comparisons"] if row["quantity"] == "H_V_N_per_mm3")
    (hardness,) = (line for line in lines if line.startswith("Snow hardness H_V: geometric mean of each site"))
    assert f"Over all sites {own['own']:.3g} N/mm³ (95 % interval" in hardness
    (law,) = (line for line in lines if line.startswith("Selected law of the penetration force: F = H_V V."))
    assert "This is the law that the paper proposes" in law
    (relations,) = (line for line in lines if line.startswith("Relations: significant at 5 %: S_f on edge angle"))
    judged = [row for row in reference.results["regressions"] if row["p"] is not None]
    assert relations.count("(p = ") + relations.count("(p < ") == len(judged)


def test_synthetic_stands_beside_the_numbers(reference: Reported, campaign: Campaign) -> None:
    # H_V, S_f, k_u/H_V, law and relations, and each verdict
    assert summary(reference.analysis).count("(synthetic)") == 5 + len(verdicts(reference.results))
    real = replace(campaign, name="Hintertux", place="", penetration=None)
    assert "synthetic" not in summary(analysis_of(real))


def test_few_sites_come_first_with_their_comparison_and_no_interval_over_them(campaign: Campaign) -> None:
    """Two sites of thirty series each: no p value rests on two densities, and no interval on two sites."""
    tests = first_series(campaign, 60)
    few = analysis_of(replace(campaign, name="real", shear=None, penetration=tests))
    lines = summary(few).splitlines()
    place = next(i for i, line in enumerate(lines) if line.startswith("Snow hardness H_V: geometric mean of each"))
    for row in few.results["site_means"]:
        ends = f"{significant(row['mean'])} N/mm³ (95 % interval {interval(row['interval'])} N/mm³"
        assert f"{row['site']} {ends}, from the scatter between experiments), n = 30" in lines[place]
    (verdict,) = verdicts(few.results)
    assert lines.index(str(verdict)) < place
    assert "Over the 2 sites together" in lines[place] and "without an interval" in lines[place]
    assert any("not judged, as the predictor takes fewer than" in line for line in lines)


def test_a_campaign_with_nothing_has_a_summary(campaign: Campaign) -> None:
    silent = replace(campaign, penetration=None, shear=None, density=None, gauge_resolution=None, load_uncertainty=None)
    text = summary(analysis_of(silent))
    assert "penetration experiments: none" in text
    assert "there is no S_f" in text


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
        "B is harder than A by 54 % [−6, +152]: not certain. About 54 more tests with this scatter, 30 in each group, "
        "would find a difference of 20 % in four of five cases."
    )
    assert found.text("de") == (
        "B ist um 54 % härter als A [−6, +152]: nicht gesichert. Etwa 54 weitere Versuche mit dieser Streuung, 30 in "
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
        (letters,) = axes.child_axes
        assert [label.get_text() for label in letters.get_yticklabels()] == [each["letters"] for each in rows]
        (bars,) = axes.collections
        assert isinstance(bars, LineCollection)
        ends = [segment[:, 0] for segment in bars.get_segments()]
        np.testing.assert_allclose(ends, [each["interval"] for each in rows])


def test_of_many_experiments_those_it_names_are_drawn(reference: Reported, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.report.figures.style.MOST_POINTS", 30)
    data = ReportData(reference.analysis)
    drawing = sites(data, ())
    assert isinstance(drawing, Drawing)
    step = thinned(len(data.pressed) + len(data.sheared)).step
    assert step > 10 and str(step) in drawing.whole_caption
    for axes, values in zip(drawing.figure.axes, (data.pressed.value, data.sheared.value), strict=True):
        clouds = [line for line in axes.lines if line.get_marker() == "."]
        assert sum(np.size(cloud.get_xdata()) for cloud in clouds) == len(values[::step])


def test_one_site_has_neither_figure_nor_verdict(campaign: Campaign) -> None:
    analysis = analysis_of(replace(campaign, shear=None, penetration=first_series(campaign, 30)))
    assert isinstance(sites(ReportData(analysis), ()), LeftOut)
    assert verdicts(analysis.results) == []
