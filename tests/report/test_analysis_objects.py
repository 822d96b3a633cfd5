"""An analysis as a figure, a table of pandas, a dataset of xarray and a report."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import skisnow
from skisnow import Analysis
from skisnow._support.errors import ParameterError
from skisnow.campaign.reference import reference_campaign


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
