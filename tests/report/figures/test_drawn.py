"""Drawn values of the figures, compared with the results and exact laws."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
import pytest
import statsmodels.api as sm

from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.model_figures import model_rmse, residuals
from skisnow.report.campaign.penetration_figures import force_depth, shown_angles
from skisnow.report.campaign.shear_figures import machining, regression_line, stress_angle
from skisnow.report.figures.drawing import Drawing, LeftOut
from skisnow.report.figures.style import SiteStyle, journal_style, site_styles, thinned

from ..conftest import Reported

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Draw = Callable[..., Drawing | LeftOut]


@pytest.fixture(scope="module")
def data(reference: Reported) -> ReportData:
    return ReportData(reference.analysis)


def _axes(data: ReportData, draw: Draw) -> list[Axes]:
    with journal_style():
        drawn = draw(data, site_styles(data))
    assert isinstance(drawn, Drawing)
    return drawn.figure.axes


def test_flat_and_the_most_frequent_edge_are_shown(data: ReportData) -> None:
    angles = [row["edge_angle_deg"] for row in data.penetration if row["edge_angle_deg"] > 0]
    assert shown_angles(data) == [0.0, max(set(angles), key=angles.count)]


def test_laws_of_fig_5_meet_the_last_reading(data: ReportData) -> None:
    """F = H_V V with Eqn 2 written out: at the largest depth it is the largest load."""
    flat, edged = _axes(data, force_depth)
    for axes, slope in ((flat, 1.0), (edged, 2.0)):
        laws = [line for line in axes.lines if line.get_linestyle() == "-"]
        assert laws
        for line in laws:
            e, F = np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)
            assert F[-1] == pytest.approx(492.0, rel=1e-9)
            # the wedge is one to 62 sin 45° = 44 mm, far below all depths here
            assert np.diff(np.log(F)) == pytest.approx(slope * np.diff(np.log(e)), rel=1e-9)


def test_dots_of_the_rmse_chart_are_the_rows(data: ReportData) -> None:
    (axes,) = _axes(data, model_rmse)
    printed, own = axes.lines
    assert np.asarray(own.get_xdata()).tolist() == [row["rmse_N"] for row in data.results["penetration"]["models"]]
    assert np.asarray(printed.get_xdata()).tolist() == [140.0, 58.4, 53.6, 207.0, 75.2, 54.8, 53.8, 54.9, 56.1]


def test_residuals_have_the_rmse_of_the_selected_row(data: ReportData) -> None:
    (axes,) = _axes(data, residuals)
    cloud = max(axes.lines, key=lambda line: len(np.asarray(line.get_xdata())))
    departure = np.asarray(cloud.get_ydata(), float)
    selected = data.results["penetration"]["selected"]["id"]
    row = next(row for row in data.results["penetration"]["models"] if row["id"] == selected)
    assert len(departure) == row["n"]
    assert math.sqrt(float(np.mean(departure**2))) == pytest.approx(row["rmse_N"], rel=1e-12)


def test_a_line_is_drawn_only_where_the_slope_is_significant(data: ReportData) -> None:
    rows = [row for row in data.results["regressions"] if row["terms"][1] == "edge_angle_rad"]
    expected = sum(row["group"] != "all" and row["p"] < 0.05 for row in rows)
    assert 0 < expected < len(rows) - 1
    (axes,) = _axes(data, stress_angle)
    lines = [line for line in axes.lines if line.get_linestyle() == "-"]
    assert len(lines) == expected
    row = next(row for row in rows if row["group"] != "all" and row["p"] < 0.05)
    degrees, stress = lines[0].get_xdata(), lines[0].get_ydata()
    assert stress == pytest.approx(row["b"][0] + row["b"][1] * np.radians(degrees), rel=1e-12)


def test_machining_meets_the_regression_at_90_degrees(data: ReportData) -> None:
    """Eqn 10 with β = 0: 2 S cot 45° = 2 S; at 60° it is 2 S cot 30° = 2 S √3."""
    (axes,) = _axes(data, machining)
    thick, thin = (line for line in axes.lines if line.get_linestyle() == "-")
    row = next(row for row in data.results["regressions"] if row["group"] == "site J")
    upright = row["b"][0] + row["b"][1] * math.pi / 2
    theta, stress = np.asarray(thick.get_xdata()), np.asarray(thick.get_ydata())
    assert stress[-1] == pytest.approx(upright, rel=1e-12)
    assert np.interp(60.0, theta, stress) == pytest.approx(upright * math.sqrt(3.0), rel=1e-4)
    assert np.all(np.asarray(thin.get_ydata())[100:] > stress[100:])
    assert thick.get_linewidth() > thin.get_linewidth()


def test_the_band_is_that_of_statsmodels() -> None:
    rng = np.random.default_rng(4)
    x = rng.uniform(400.0, 700.0, 25)
    y = 0.1 + 3e-4 * x + rng.normal(0.0, 0.05, 25)
    peer = sm.OLS(y, sm.add_constant(x)).fit()
    row = {"b": peer.params.tolist(), "rmse_dof": math.sqrt(peer.mse_resid)}
    line = regression_line(row, x)
    frame = peer.get_prediction(sm.add_constant(line.x)).summary_frame()
    # both are a dozen double-precision operations
    assert line.y == pytest.approx(frame["mean"].to_numpy(), rel=1e-10)
    assert line.low == pytest.approx(frame["mean_ci_lower"].to_numpy(), rel=1e-10)
    assert line.high == pytest.approx(frame["mean_ci_upper"].to_numpy(), rel=1e-10)


def test_sites_differ_by_symbol_and_many_share_one(data: ReportData) -> None:
    styles = site_styles(data)
    assert sorted(site for style in styles for site in style.sites) == sorted(data.sites)
    looks = [(style.marker, style.colour) for style in styles]
    assert len(set(looks)) == len(looks)
    assert len({style.marker for style in styles}) == len(styles)
    assert all(isinstance(style, SiteStyle) for style in styles)


@pytest.mark.parametrize("count", [10, 40_000, 40_001, 143_000, 1_001_112])
def test_thinning_keeps_every_load_step(count: int) -> None:
    kept = np.arange(count)[thinned(count)]
    assert len(kept) <= 40_000
    assert set((kept % 7).tolist()) == set((np.arange(min(count, 7)) % 7).tolist())
