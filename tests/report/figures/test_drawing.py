"""Drawings: files, compact paths and labels without overlap."""

import io
import math
import re
from collections.abc import Callable
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from skisnow._support.messages import in_language
from skisnow.report.campaign.data import ReportData
from skisnow.report.campaign.penetration_figures import force_depth, shown_angles
from skisnow.report.campaign.shear_figures import machining, regression_line, stress_angle
from skisnow.report.campaign.site_figures import residuals
from skisnow.report.figures.drawing import (
    FORMS,
    Drawing,
    LeftOut,
    Picture,
    compact_svg,
    drawing_svg,
    left_title,
    letter_panels,
    render,
)
from skisnow.report.figures.style import (
    SiteStyle,
    journal_style,
    local_axes,
    new_figure,
    site_styles,
    thinned,
)
from skisnow.report.run.track_figure import run_track

from ..conftest import Reported
from ..runs import circle_run

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
    from statsmodels.api import OLS, add_constant

    rng = np.random.default_rng(4)
    x = rng.uniform(400.0, 700.0, 25)
    y = 0.1 + 3e-4 * x + rng.normal(0.0, 0.05, 25)
    peer = OLS(y, add_constant(x)).fit()
    row = {"b": peer.params.tolist(), "rmse_dof": math.sqrt(peer.mse_resid)}
    places, mean, low, high = regression_line(row, x)
    frame = peer.get_prediction(add_constant(places)).summary_frame()
    # both are a dozen double-precision operations
    assert mean == pytest.approx(frame["mean"].to_numpy(), rel=1e-10)
    assert low == pytest.approx(frame["mean_ci_lower"].to_numpy(), rel=1e-10)
    assert high == pytest.approx(frame["mean_ci_upper"].to_numpy(), rel=1e-10)


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


def test_each_file_is_drawn_once_after_the_axes_were_placed(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[tuple[float, ...]] = []
    draw = Figure.draw
    places: list[Axes] = []

    def noted(figure: Figure, renderer: object) -> None:
        drawn.append(places[0].get_position().bounds if places else ())
        draw(figure, renderer)  # type: ignore[arg-type]

    with journal_style():
        figure = new_figure()
        axes = figure.subplots()
        places.append(axes)
        axes.set_ylabel("a label")
        before = axes.get_position().bounds
        monkeypatch.setattr(Figure, "draw", noted)
        picture = render(Drawing("name", Markup(""), "words", figure))
    assert picture.svg.lstrip().startswith("<?xml") and picture.png.startswith(b"\x89PNG")
    assert len(drawn) == 3  # each form once
    assert drawn[0] == drawn[1] == drawn[2] != before  # of what the layout made of it


def test_files_of_print_are_the_same_each_time() -> None:
    def once() -> Picture:
        with journal_style():
            figure = new_figure()
            figure.subplots().plot([0, 1], [0, 1], alpha=0.5)
            return render(Drawing("name", Markup(""), "words", figure))

    first, second = once(), once()
    assert first.pdf.startswith(b"%PDF")
    assert (first.pdf, first.csv) == (second.pdf, second.csv)
    assert first.files.keys() == set(FORMS)


NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
TAG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def svg() -> str:
    with journal_style():
        figure = new_figure()
        axes = figure.subplots()
        x = np.linspace(0.0, 1.0, 60)
        axes.plot(x, np.sin(9.0 * x), "o")
        axes.plot(x, np.cos(9.0 * x))
        axes.imshow([[0.0, 1.0], [0.5, 0.2]], extent=(0.0, 0.5, 0.0, 0.5))
        axes.set_xlabel("0.123456 < a word")
        return drawing_svg(Drawing("name", Markup(""), "words", figure))


def elements(text: str) -> list[ElementTree.Element]:
    style = f"{TAG}style"
    return [each for each in ElementTree.fromstring(text).iter() if each.tag != style]


def test_it_is_the_same_picture_in_fewer_bytes(svg: str) -> None:
    compact = compact_svg(svg)
    assert len(compact) < 0.7 * len(svg)
    before, after = elements(svg), elements(compact)
    assert [each.tag for each in after] == [each.tag for each in before]
    assert [(each.text or "").strip() for each in after] == [(each.text or "").strip() for each in before]
    for one, other in zip(before, after, strict=True):
        for key in ("d", "x", "y", "transform", "viewBox", "width", "height"):
            given = [float(each) for each in NUMBER.findall(one.get(key, ""))]
            assert [float(each) for each in NUMBER.findall(other.get(key, ""))] == pytest.approx(given, abs=0.0051)


def test_styles_and_references_lead_to_what_they_were(svg: str) -> None:
    compact = compact_svg(svg)
    rules = dict(re.findall(r"\.(s\d+)\{([^}]*)\}", compact))
    styles = [each.get("style") or rules.get(each.get("class", "")) for each in elements(compact)]
    assert styles == [each.get("style") for each in elements(svg)]
    href = "{http://www.w3.org/1999/xlink}href"
    before, after = paths_of_uses(svg, href), paths_of_uses(compact, "href")
    assert len(after) > 60
    assert after == pytest.approx(before, abs=0.0051)


def paths_of_uses(text: str, href: str) -> list[float]:
    """The numbers of all paths that are used, in order."""
    paths = {each.get("id"): each.get("d", "") for each in elements(text)}
    used = [paths[each.get(href, "")[1:]] for each in elements(text) if each.tag == f"{TAG}use"]
    return [float(number) for path in used for number in NUMBER.findall(path)]


def words_of(axes: Axes) -> list[Text]:
    """Texts in and above a panel, and the numbers at its axes."""
    low, high = axes.get_ylim()
    left, right = axes.get_xlim()
    found = [each for each in axes.get_yticklabels() if low <= each.get_position()[1] <= high]
    found += [each for each in axes.get_xticklabels() if left <= each.get_position()[0] <= right]
    title = left_title(axes)
    every = (*found, *axes.texts, *([title] if title else []))
    return [each for each in every if each.get_visible() and each.get_text().strip()]


def over_one_another(figure: Figure) -> list[tuple[str, str]]:
    figure.savefig(io.BytesIO(), format="svg")  # lays the panels out
    found = []
    for axes in figure.axes:
        boxes = [(each.get_text(), each.get_window_extent()) for each in words_of(axes)]
        found += [(a, b) for (a, one), (b, other) in combinations(boxes, 2) if one.overlaps(other)]
    return found


@pytest.mark.parametrize(("radius", "duration", "language"), [(17.0, 2.0, "de"), (12.0, 4.0, "en")])
def test_a_run_from_above(radius: float, duration: float, language: str) -> None:
    with journal_style(), in_language(language):
        figure = run_track(circle_run(radius=radius, duration=duration))
        local_axes(figure)
        letter_panels(figure)
        assert over_one_another(figure) == []


def test_time_marks_are_as_far_apart_as_their_label_says() -> None:
    with journal_style(), in_language("en"):
        run = circle_run(radius=12.0, duration=20.0)
        figure = run_track(run)
        expected = np.transpose([np.interp(np.arange(0.0, 21.0, 2.0), run.time, run.place[:, k]) for k in (0, 1)])
        np.testing.assert_allclose(np.asarray(figure.axes[0].lines[2].get_xydata()), expected, atol=1e-9)
        assert figure.legends[0].get_texts()[2].get_text().startswith("every 2 s")
