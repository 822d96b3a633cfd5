"""Figures of carves and of tracks, and their visible range."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.carving.answer import answer_question, answers_dict
from skisnow.carving.question import carve_question
from skisnow.comparison import Comparison, compare_tracks
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.page import DRAWERS
from skisnow.report.carving_figure import arc_through, carved_skis, contact_ends
from skisnow.report.figures.drawing import PNG_WIDTH, Drawing, require_drawable, write_figure
from skisnow.report.figures.style import journal_style, site_styles
from skisnow.report.run.drawings import run_drawings
from skisnow.report.study_layout import map_layout
from skisnow.report.study_maps import grip_map, radius_map, share_of_limit
from skisnow.report.track.report import comparison_drawing, track_comparison, track_drawings
from skisnow.studies import StudyTable
from skisnow.track.summary import track_summary
from skisnow.track.track import Track
from tests.coded import raises

from ..conftest import Reported
from ..runs import circle_run

ASKED = {"edge_angle_deg": 45, "load_N": 800, "published": "race-piste", "unloading_ratio": 10}


@pytest.fixture(scope="module")
def found() -> dict[str, Any]:
    return answers_dict([answer_question(carve_question(ASKED | {"ski": ski})) for ski in ("slalom", "giant-slalom")])


def made_up(**varied: list[Any]) -> StudyTable:
    """A grid whose side force meets its limit where angle × load is 36,000, and whose radius is 1000/angle."""
    grid = np.meshgrid(*(np.arange(len(values)) for values in varied.values()), indexing="ij")
    rows = []
    for place in zip(*(axis.ravel() for axis in grid), strict=True):
        row = {name: values[at] for (name, values), at in zip(varied.items(), place, strict=True)}
        force = row.get("edge_angle_deg", 30.0) * row.get("load_N", 800.0) / 100.0
        row |= {"side_force_N": force, "side_force_limit_N": 360.0, "holds": force <= 360.0, "outcome": "equilibrium"}
        row |= {"turn_radius_boot_m": 1000.0 / row.get("edge_angle_deg", 30.0)}
        rows.append(row | {"sidecut_radius_of_three_widths_m": 13.0})
    return StudyTable(tuple(rows[0]), rows, tuple(varied))


ANGLES, LOADS = [10.0, 30.0, 50.0, 70.0], [400.0, 800.0, 1200.0]


def test_curves_are_the_numbers(found: dict[str, Any]) -> None:
    with journal_style():
        figure = carved_skis(found)
    depth, force, bending, twist, _ = figure.axes
    keys = ("edge_depth_mm", "force_per_length_N_per_m", "bending_mm", "twist_deg")
    for axes, key in zip((depth, force, bending, twist), keys, strict=True):
        for line, answer in zip(axes.lines, found["skis"], strict=False):
            assert np.asarray(line.get_xdata()).tolist() == answer["station_m"]
            assert np.asarray(line.get_ydata()).tolist() == answer[key]
    top, bottom = depth.get_ylim()[::-1]
    assert top < 0 < bottom  # depth grows downwards and the undisturbed surface is in the picture


def test_circles_have_the_radii_of_the_answer(found: dict[str, Any]) -> None:
    """Edge line and contact ends are read off 1 cm stations: the radii agree to half a per cent."""
    for answer in found["skis"]:
        station = np.asarray(answer["station_m"])[::-1]
        line = np.asarray(answer["edge_line_mm"])[::-1] / 1e3
        line -= np.interp(0.0, station, line)
        for ends, key in (((-0.4, 0.4), "turn_radius_boot_m"), (contact_ends(answer), "turn_radius_chord_m")):
            x, y = arc_through(station, line, *ends)
            slope = np.gradient(y, x)
            curvature = np.gradient(slope, x) / (1.0 + slope**2) ** 1.5
            assert float(np.median(curvature)) == pytest.approx(1.0 / answer[key], rel=5e-3)
            assert y[[0, -1]] == pytest.approx(np.interp(ends, station, line), abs=1e-12)


def test_angle_lies_along_the_axis_load_as_lines_and_the_rest_as_panels() -> None:
    table = made_up(ski=["a", "b"], load_N=LOADS, edge_angle_deg=ANGLES)
    layout = map_layout(table, second_is_number=False)
    assert (layout.x, layout.second, layout.panels, layout.sampled) == ("edge_angle_deg", "load_N", ("ski",), False)
    skis = made_up(ski=["a", "b"], edge_angle_deg=ANGLES)
    assert map_layout(skis, second_is_number=False).second == "ski"
    grip = map_layout(skis, second_is_number=True)
    assert (grip.second, grip.panels) == (None, ("ski",))


def test_radius_map_draws_every_line_and_tells_slipping_edges() -> None:
    with journal_style():
        figure = radius_map(made_up(ski=["a", "b"], load_N=LOADS, edge_angle_deg=ANGLES))
    panels = figure.axes
    assert [axes.get_title(loc="left") for axes in panels] == ["a", "b"]
    for axes in panels:
        curves = [line for line in axes.lines if line.get_linestyle() == "-"]
        assert len(curves) == len(LOADS)
        for line in curves:
            assert np.asarray(line.get_ydata()) == pytest.approx([1000.0 / angle for angle in ANGLES])
        marks = [line for line in axes.lines if line.get_linestyle() == "None"]
        hollow = sum(len(np.asarray(line.get_xdata())) for line in marks if line.get_markerfacecolor() == "white")
        assert hollow == sum(angle * load > 36_000 for angle in ANGLES for load in LOADS)
        sidecut = next(line for line in axes.lines if line not in curves and line not in marks)
        theta, radius = np.asarray(sidecut.get_xdata(), float), np.asarray(sidecut.get_ydata(), float)
        assert np.interp(60.0, theta, radius) == pytest.approx(13.0 / 2.0, rel=1e-3)


def test_grip_map_draws_its_line_where_force_and_limit_are_equal() -> None:
    table = made_up(load_N=np.linspace(400, 1600, 13).tolist(), edge_angle_deg=np.linspace(10, 80, 15).tolist())
    with journal_style():
        figure = grip_map(table)
    axes = figure.axes[0]
    line = next(drawn for drawn in axes.collections if np.asarray(drawn.get_linewidth()).max() == 1.8)
    points = np.concatenate([path.vertices for path in line.get_paths()])
    # linear interpolation of ln(angle × load) between 20° and 25° is off by (5/22.5)²/8 = 0.6 %
    assert points[:, 0] * points[:, 1] == pytest.approx(np.full(len(points), 36_000.0), rel=7e-3)


def test_share_of_the_limit() -> None:
    assert share_of_limit({"side_force_N": 300.0, "side_force_limit_N": 600.0}) == 0.5
    assert share_of_limit({"side_force_N": 0.0, "side_force_limit_N": 0.0}) == 0.0
    assert math.isnan(share_of_limit({"side_force_N": None, "side_force_limit_N": None}))


def test_points_that_could_not_be_asked_stand_neither_in_map_nor_in_legend() -> None:
    whole = made_up(ski=["a", "b", "nowhere.toml"], load_N=LOADS, edge_angle_deg=[*ANGLES, 88.0])
    results = ("side_force_N", "side_force_limit_N", "holds", "turn_radius_boot_m", "sidecut_radius_of_three_widths_m")
    rows = [
        row | dict.fromkeys(results) | {"outcome": "error"}
        if row["ski"] == "nowhere.toml" or row["edge_angle_deg"] > 85 or row["load_N"] > 1000
        else row
        for row in whole.rows
    ]
    table = StudyTable(whole.columns, rows, whole.varied)
    for draw in (radius_map, grip_map):
        with journal_style():
            figure = draw(table)
        titles = [axes.get_title(loc="left") for axes in figure.axes]
        assert [title for title in titles if title] == ["a", "b"]
        assert figure.axes[0].get_xlim()[1] < 75.0
        panels = [axes.get_legend() for axes in figure.axes if axes.get_title(loc="left")]
        legends = figure.legends or [legend for legend in panels if legend is not None]
        assert len(legends) == (2 if draw is grip_map else 1)  # one for each panel of a grip map
        texts = [text.get_text() for text in legends[0].get_texts()]
        assert not {"1200 N", "no equilibrium"} & set(texts)
        assert "holds" in texts
    with raises(ParameterError, "nothing_to_draw"):
        radius_map(StudyTable(whole.columns, [row | {"outcome": "error"} for row in rows], whole.varied))


def test_skis_stand_under_their_own_names_where_these_tell_them_apart(found: dict[str, Any]) -> None:
    def titles(*names: str) -> list[str]:
        whole = made_up(ski=["one.toml", "two.toml"], edge_angle_deg=ANGLES)
        own = dict(zip(("one.toml", "two.toml"), names, strict=True))
        rows = [row | {"ski_name": own[row["ski"]]} for row in whole.rows]
        with journal_style():
            figure = radius_map(StudyTable(whole.columns, rows, whole.varied))
        return [text.get_text() for text in figure.legends[0].get_texts()][:2]

    assert titles("Short", "Long") == ["Long", "Short"]  # lines are in the order of their names
    assert titles("Same", "Same") == ["one.toml", "two.toml"]
    slalom, giant = found["skis"]
    renamed = {"skis": [slalom | {"ski": slalom["ski"] | {"name": "My own"}}, giant]}
    with journal_style():
        figure = carved_skis(renamed)
    assert [text.get_text() for text in figure.legends[0].get_texts()][:2] == ["My own", "giant-slalom"]


def test_maps_that_cannot_be_drawn_say_why() -> None:
    with raises(ParameterError, "nothing_varies"):
        radius_map(made_up(ski=["a", "b"]))
    with raises(ParameterError, "too_many_panels", count=13):
        radius_map(made_up(ski=[str(n) for n in range(13)], load_N=LOADS, edge_angle_deg=ANGLES))


def test_figure_files(tmp_path: Path, found: dict[str, Any]) -> None:
    path = tmp_path / "deep" / "skis.png"
    write_figure(path, lambda: carved_skis(found))
    assert int.from_bytes(path.read_bytes()[16:20], "big") == PNG_WIDTH  # width in the header of a PNG
    with raises(ParameterError, "unknown_ending"):
        require_drawable(tmp_path / "skis.bmp")


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


def test_a_figure_of_more_than_a_column_is_wide_so_that_it_scrolls_on_a_telephone(reference: Reported) -> None:
    data, track = ReportData(reference.analysis), track_of(winding(300))
    with journal_style():
        figures = [draw(data, site_styles(data)) for draw in DRAWERS]
        figures += [*track_drawings(track_summary(track)), comparison_drawing(compare_tracks(track, track))]
        drawings = [each for each in (*figures, *run_drawings(circle_run())) if isinstance(each, Drawing)]
        of_two_columns = {each.name for each in drawings if each.figure.get_figwidth() > 86.0 / 25.4}
    assert {each.name for each in drawings if each.wide} == of_two_columns


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
