"""A figure becomes its files: of print, of screens."""

from __future__ import annotations

from typing import Any, cast

import pytest
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from skisnow.report.figures.drawing import FORMS, Drawing, Picture, make_opaque, render
from skisnow.report.figures.style import DOUBLE_MM, journal_style, legend_below, new_figure


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
    assert len(drawn) == 4  # each form once
    assert drawn[0] == drawn[1] == drawn[2] != before  # of what the layout made of it


def two_panels() -> Figure:
    figure = new_figure(width_mm=DOUBLE_MM)
    left, right = figure.subplots(1, 2, sharey=True)
    band = left.fill_between([0, 1], [0, 0], [1, 1], color="#0000ff", alpha=0.25, label="a band")
    left.set_title("a title that takes more room than a telephone has for it beside another one", loc="left")
    left.set_ylabel("depth (mm)")
    figure.colorbar(left.imshow([[0.0, 1.0]], aspect="auto"), ax=right)
    twin = right.twinx()
    twin.plot([0, 1], [0, 1], alpha=0.5, color="#ff0000")
    legend_below(figure, [band])
    return figure


def test_eps_has_no_transparency_but_its_colour_on_white() -> None:
    with journal_style():
        figure = two_panels()
        make_opaque(figure)
    left, *_, twin = figure.axes
    band = next(each for each in left.collections if each.get_label() == "a band")
    (line,) = twin.lines
    colours: list[Any] = [cast("Any", band.get_facecolor())[0], line.get_color()]
    # a quarter of blue, and half of red, on white
    assert [to_hex(each, keep_alpha=True) for each in colours] == ["#bfbfffff", "#ff8080ff"]
    assert line.get_alpha() is None


def test_files_of_print_are_the_same_each_time() -> None:
    def once() -> Picture:
        with journal_style():
            figure = new_figure()
            figure.subplots().plot([0, 1], [0, 1], alpha=0.5)
            return render(Drawing("name", Markup(""), "words", figure))

    first, second = once(), once()
    assert first.pdf.startswith(b"%PDF") and first.eps.startswith(b"%!PS-Adobe-3.0 EPSF")
    assert (first.pdf, first.eps) == (second.pdf, second.eps)
    assert first.files.keys() == set(FORMS)
