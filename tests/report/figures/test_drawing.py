"""A figure becomes its two files."""

from __future__ import annotations

import pytest
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from skisnow.report.figures.drawing import Drawing, pictured
from skisnow.report.figures.style import journal_style, new_figure


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
        picture = pictured(Drawing("name", Markup(""), "words", figure))
    assert picture.svg.lstrip().startswith("<?xml") and picture.png.startswith(b"\x89PNG")
    assert len(drawn) == 2  # SVG and PNG
    assert drawn[0] == drawn[1] != before  # of what the layout made of it
