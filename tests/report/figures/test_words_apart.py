"""Words in a picture of a run from above do not overlap."""

from __future__ import annotations

import io
from itertools import combinations
from typing import TYPE_CHECKING

import pytest

from skisnow._support.messages import in_language
from skisnow.report.figures.drawing import left_title, letter_panels
from skisnow.report.figures.style import journal_style, local_axes
from skisnow.report.run.track_figure import run_track

from ..runs import circle_run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Text


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
