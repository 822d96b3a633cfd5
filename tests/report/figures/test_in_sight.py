"""Every dot of a figure lies within its axes, and together they fill a good part of them: limits follow the numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection

from skisnow.comparison import compare_tracks
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.model_figures import model_rmse
from skisnow.report.campaign.page import DRAWERS
from skisnow.report.figures.drawing import Drawing
from skisnow.report.figures.style import journal_style, site_styles
from skisnow.report.study_maps import grip_map, radius_map

from ..conftest import Reported, altered
from .test_carve_maps import ANGLES, LOADS, made_up
from .test_track_comparison import drawn, track_of, winding

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Line = tuple[np.ndarray, np.ndarray]


@pytest.fixture(scope="module")
def data(reference: Reported) -> ReportData:
    return ReportData(reference.analysis)


def points_of(axes: Axes) -> Line:
    """Every dot that can be drawn; lines may run out of the picture."""
    places = [np.asarray(line.get_xydata(), dtype=float) for line in axes.lines if line.get_linestyle() == "None"]
    places += [
        np.asarray(drawn.get_offsets(), dtype=float) for drawn in axes.collections if isinstance(drawn, PathCollection)
    ]
    whole = np.concatenate([np.empty((0, 2)), *places])
    least = [0.0 if scale == "log" else -np.inf for scale in (axes.get_xscale(), axes.get_yscale())]
    x, y = whole[np.isfinite(whole).all(axis=1) & (whole > least).all(axis=1)].T
    return x, y


def share_in_sight(values: np.ndarray, ends: tuple[float, float], scale: str) -> float:
    """How much of the axis the values fill; they are all on it."""
    low, high = sorted(ends)
    slack = 1e-9 * (high - low)
    assert low - slack <= values.min() and values.max() <= high + slack
    change = np.log if scale == "log" else np.asarray
    return float(np.ptp(change(values)) / (change(high) - change(low)))


def require_in_sight(figure: Figure, *, least: float = 0.2) -> None:
    for axes in figure.axes:
        x, y = points_of(axes)
        if len(x) and axes.get_label() != "<colorbar>":
            assert share_in_sight(x, axes.get_xlim(), axes.get_xscale()) > least
            assert share_in_sight(y, axes.get_ylim(), axes.get_yscale()) > least


@pytest.mark.parametrize("draw", DRAWERS, ids=lambda draw: draw.__name__)
def test_figures_of_a_campaign(data: ReportData, draw: Callable[..., Drawing]) -> None:
    with journal_style():
        figure = draw(data, site_styles(data)).figure
    require_in_sight(figure)


@pytest.mark.parametrize("draw", [radius_map, grip_map])
def test_maps(draw: Callable[..., Figure]) -> None:
    with journal_style():
        require_in_sight(draw(made_up(load_N=LOADS, edge_angle_deg=ANGLES)))


def test_of_one_input_the_share_of_the_grip_is_drawn() -> None:
    """Force 8 θ N over a limit of 360 N: at 70° one and a half times as much."""
    with journal_style():
        (axes,) = grip_map(made_up(edge_angle_deg=ANGLES)).axes
    share = np.asarray(axes.lines[0].get_ydata(), dtype=float)
    assert share == pytest.approx([8.0 * angle / 360.0 for angle in ANGLES])
    assert axes.get_ylim() == pytest.approx((0.0, 1.08 * 560.0 / 360.0))
    assert axes.get_ylabel() == "side force / limit"


def test_distances_of_which_one_would_hide_another_are_drawn_by_their_logarithm() -> None:
    place = winding(300)
    beside = 0.01 * np.arange(300)[:, None] / 3.0
    _, along = drawn(
        compare_tracks(track_of(place), track_of(place + np.array([0.0, 0.01, 0.0]) + beside * [0.0, 1.0, 0.0]))
    )
    assert along.get_yscale() == "linear" and along.get_ylim()[0] == 0.0
    ahead = replace(track_of(place), time=np.arange(300) / 10.0 + 3.0 * np.linspace(0.0, 1.0, 300))
    found = compare_tracks(track_of(place), replace(ahead, place=place + np.array([0.0, 0.01, 0.0])))
    _, along = drawn(found)
    largest = [each.numbers.max for each in (found.nearest, found.arc_length, found.time) if each.numbers]
    assert max(largest) > 20.0 * min(largest)
    assert along.get_yscale() == "log"
    assert along.get_ylim() == pytest.approx((0.01 * min(largest), 2.0 * max(largest)))


def with_rmse(data: ReportData, values: list[float]) -> ReportData:
    penetration = data.results["penetration"]
    models = [row | {"rmse_N": value} for row, value in zip(penetration["models"], values, strict=True)]
    return ReportData(altered(data.analysis, data.results | {"penetration": penetration | {"models": models}}))


@pytest.mark.parametrize(("value", "scale"), [(100.0, "linear"), (1000.0, "linear"), (1080.0, "log"), (2.0, "log")])
def test_rmse_of_another_size_are_drawn_by_their_logarithm(data: ReportData, value: float, scale: str) -> None:
    """The paper's are 53.6 N to 207 N: twenty times as much is 1072 N, a twentieth of the greatest 10.35 N."""
    with journal_style():
        drawing = model_rmse(with_rmse(data, [value] * 9), [])
    assert isinstance(drawing, Drawing)
    (axes,) = drawing.figure.axes
    assert axes.get_xscale() == scale
    if scale == "linear":
        assert axes.get_xlim() == pytest.approx((0.0, 1.06 * max(207.0, value)))
