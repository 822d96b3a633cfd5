"""The figure of two tracks shows the distances that the numbers say, where they are."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from matplotlib.axes import Axes

from skisnow.comparison import Comparison, compare_tracks
from skisnow.report.figures.style import journal_style
from skisnow.report.track.report import track_comparison
from skisnow.track.track import Track

FloatArray = npt.NDArray[np.float64]


def track_of(place: FloatArray) -> Track:
    return Track("a_b.csv", np.arange(len(place)) / 10.0, place, np.full(len(place), np.nan), "local", "made by hand")


def drawn(found: Comparison) -> tuple[Axes, Axes]:
    with journal_style():
        figure = track_comparison(found)
    plan, along = figure.axes
    return plan, along


def winding(count: int) -> FloatArray:
    way = np.linspace(0.0, 40.0, count)
    return np.column_stack([way, 3.0 * np.sin(way / 5.0), 0.0 * way])


def test_curves_begin_at_the_start_and_show_the_largest() -> None:
    place = winding(300)
    found = compare_tracks(
        track_of(place), track_of(place + np.array([0.0, 0.01, 0.0]) * np.arange(300)[:, None] / 3.0)
    )
    plan, along = drawn(found)
    curves = [line for line in along.lines if len(np.asarray(line.get_xdata())) > 1]
    for curve, each in zip(curves, (found.nearest, found.arc_length, found.time), strict=True):
        assert each.numbers is not None
        assert np.nanmax(np.asarray(curve.get_ydata())) == pytest.approx(each.numbers.max)
    assert np.asarray(curves[2].get_ydata())[-1] == pytest.approx(0.01 * 299 / 3.0)
    assert along.get_xlim() == pytest.approx((0.0, found.measured.length))
    assert plan.get_xlabel() == "$x$ (m)"
    assert not plan.texts  # the fall line is unknown
    slope = drawn(replace(found, axes="slope"))[0]
    assert "fall line" in slope.get_xlabel()


def test_a_fit_shows_the_track_before_it_and_a_missing_distance_is_none() -> None:
    place = winding(300)
    shifted = replace(track_of(place + np.array([0.0, 1.0, 0.0])), first_time=900.0)
    found = compare_tracks(track_of(place), shifted, fit=["start"])
    with journal_style():
        figure = track_comparison(found)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert any("before" in label for label in labels)
    assert "equal time: none" in labels
    assert any(label.endswith("start fitted") for label in labels)
    before = figure.axes[0].lines[0]
    assert np.asarray(before.get_ydata())[0] == pytest.approx(0.0)
