"""An analysis as a figure, a table of pandas, a dataset of xarray and a report."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import skisnow
from skisnow import Analysis
from skisnow._support.errors import ParameterError
from skisnow.campaign import read_campaign
from skisnow.campaign.reference import reference_campaign
from skisnow.estimation.result_rows import experiment_hardness, experiment_results
from skisnow.report.charts import series_curves


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


@pytest.mark.parametrize("what", ["model_rsme", "hardness_mean_force"])
def test_unknown_figure(analysis: Analysis, what: str) -> None:
    with pytest.raises(ParameterError) as caught:
        analysis.plot(what)
    assert caught.value.code == "unknown_figure"


def test_figure_without_data() -> None:
    campaign = replace(reference_campaign(1).campaign(), shear=None)
    with pytest.raises(ParameterError) as caught:
        skisnow.analyse(campaign, n_resamples=100).plot("stress_angle")
    assert caught.value.code == "no_data"


def test_unknown_kind_of_experiment(analysis: Analysis) -> None:
    pytest.importorskip("pandas")
    with pytest.raises(ParameterError) as caught:
        analysis.to_dataframe("shera")
    assert caught.value.code == "unknown_kind"


def test_notebook_table_has_values(analysis: Analysis) -> None:
    """H_V and S_f with their intervals are cells of the table, as in the terminal."""
    html = analysis._repr_html_()
    for row in repr(analysis).splitlines()[1:]:
        name, _, text = row.strip().rstrip(">").partition(" ")
        assert f">{name}</th>" in html
        assert f">{text.strip()}</td>" in html


def test_a_disc_by_hand(tmp_path: Path) -> None:
    """A disc of 10 cm² 4 mm deep under 80 N: V = 4000 mm³, H_V = 0.02 N/mm³, and half the load at half the depth."""
    diameter = float(2.0 * np.sqrt(1000.0 / np.pi))
    (tmp_path / "campaign.toml").write_text(f'[[tool]]\nname = "d"\nshape = "disc"\ndiameter_mm = {diameter!r}\n')
    rows = ["experiment,site,tool,edge_angle_deg,load_N,depth_mm", "1,A,d,0,20,1", "1,A,d,0,40,2", "1,A,d,0,80,4"]
    (tmp_path / "penetration.csv").write_text("\n".join(rows) + "\n")
    campaign = read_campaign(tmp_path)
    found = experiment_results(campaign)["penetration"]["experiments"]
    assert found[0]["H_V_N_per_mm3"] == pytest.approx(0.02, rel=1e-12)
    (curve,) = series_curves(campaign, experiment_hardness(campaign))
    assert curve.load_N == (20.0, 40.0, 80.0)
    assert curve.depth_mm == pytest.approx((1.0, 2.0, 4.0), rel=1e-12)
    assert (curve.law_depth_mm[-1], curve.law_load_N[-1]) == pytest.approx((4.0, 80.0), rel=1e-12)
    assert np.interp(2.0, curve.law_depth_mm, curve.law_load_N) == pytest.approx(40.0, rel=1e-12)


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
    # each is on its law: the loads of the wedges go with the square of the depth, that of the disc with the depth
    for curve, loads in ((first, (20.0, 80.0)), (disc, (20.0, 40.0)), (last, (30.0, 120.0))):
        middle = len(curve.law_depth_mm) // 2
        assert (curve.law_depth_mm[middle], curve.law_depth_mm[-1]) == pytest.approx((1.0, 2.0), rel=1e-12)
        assert (curve.law_load_N[middle], curve.law_load_N[-1]) == pytest.approx(loads, rel=1e-12)
