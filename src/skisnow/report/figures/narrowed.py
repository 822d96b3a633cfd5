"""A wide figure laid out again for a telephone: the same panels, closer or below each other, words in the same size."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Final

from matplotlib.gridspec import GridSpec
from matplotlib.ticker import FixedLocator

from .panels import left_title, panels_of
from .style import MM_PER_INCH, legend_below
from .time_labels import thin_out

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import GridSpecBase
    from matplotlib.text import Text

WIDTH_MM: Final = 96.0
"""As wide as a telephone of 390 pixels shows it with its words in their own size."""
_LETTER_MM: Final = 1.55
_EQUAL: Final = 0.62
"""Of the height, where a panel has the same scale along both axes and grows narrower with the figure (about)."""
_LEAST_PLAN: Final = 0.35
"""Height of a plan over its width, at least: room for the words at a flat line."""
_ABOVE_PLAN: Final = 0.15
"""Height over the width of a plan that is added for the words at the ends of a line, most of it above (about)."""
_MOST_TICKS: Final = 4
"""Of numbers that were chosen one by one, beside another panel."""
_AROUND_PLAN_MM: Final = 16.0
"""Numbers, name of the axis and the line of words above a plan (about)."""
_BESIDE_MM: Final = 16.0
"""Ticks and label at the left of a panel, or a scale of colours at its right (about)."""


def narrow(figure: Figure) -> None:
    """Change the figure itself; call it last."""
    panels = panels_of(figure)
    columns = _columns(panels)
    height_mm = figure.get_figheight() * MM_PER_INCH
    if columns > 1 and _is_one_row(panels) and len(figure.axes) == len(panels):
        _stack(figure, panels)
        height_mm = 20.0 + (0.75 * height_mm - 8.0) * len(panels)
        columns = 1
    elif plans := [axes for axes in panels if axes.get_aspect() != "auto"]:
        height_mm = height_mm * _EQUAL if _is_one_row(panels) else _with_plans(plans, height_mm)
    figure.set_size_inches(WIDTH_MM / MM_PER_INCH, height_mm / MM_PER_INCH)
    for axes in panels:
        if columns > 1 and isinstance(axes.xaxis.get_major_locator(), FixedLocator):
            ticks = axes.get_xticks()
            axes.set_xticks(ticks[:: 2 if len(ticks) > _MOST_TICKS else 1])
        _wrap(axes, int((WIDTH_MM / columns - _BESIDE_MM) / _LETTER_MM))
    if figure.get_suptitle():
        figure.suptitle(_broken(figure.get_suptitle(), int(WIDTH_MM / _LETTER_MM)), x=0.01, ha="left", fontsize=8.0)
    legends_again(figure)
    figure.set_layout_engine("constrained")


def legends_again(figure: Figure) -> None:
    """Lay the legends below a figure out again, with what stands in them now."""
    for legend in list(figure.legends):
        handles = list(legend.legend_handles)
        for handle, text in zip(handles, legend.get_texts(), strict=True):
            if handle is not None:
                handle.set_label(text.get_text())
        legend.remove()
        legend_below(figure, [each for each in handles if each is not None])


def _with_plans(plans: list[Axes], height_mm: float) -> float:
    """Make the rows of plans as high as their scale needs, and leave the others as they are; gives the height."""
    grid = _grid_of(plans[0])
    ratios = [float(each) for each in grid.get_height_ratios()]  # type: ignore[arg-type, union-attr]  # numbers
    rows = [height_mm * ratio / sum(ratios) for ratio in ratios]
    for axes in plans:
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        across = abs(right - left)
        more = max(_ABOVE_PLAN * across, _LEAST_PLAN * across - (high - low))
        axes.set_ylim(low - 0.35 * more, high + 0.65 * more)  # what stands at the line stands above it
        place = axes.get_subplotspec()
        if place is not None:
            row = place.rowspan.start
            height = min((high - low + more) / across * (WIDTH_MM - _BESIDE_MM), rows[row])
            rows[row] = height + _AROUND_PLAN_MM
            thin_out(axes, min(height / (high - low + more), (WIDTH_MM - 2.0 * _BESIDE_MM) / across))
    grid.set_height_ratios(rows)
    return sum(rows)


def _grid_of(axes: Axes) -> GridSpecBase:
    place = axes.get_subplotspec()
    assert place is not None  # panels stand in a grid
    return place.get_gridspec()


def _columns(panels: list[Axes]) -> int:
    return max((place.get_gridspec().ncols for axes in panels if (place := axes.get_subplotspec())), default=1)


def _is_one_row(panels: list[Axes]) -> bool:
    return all(place.get_gridspec().nrows == 1 for axes in panels if (place := axes.get_subplotspec()))


def _stack(figure: Figure, panels: list[Axes]) -> None:
    """Panels of one row below each other; each has its own numbers at its axes again."""
    grid = GridSpec(len(panels), 1, figure=figure)
    label = panels[0].get_ylabel()
    for row, axes in enumerate(panels):
        axes.set_subplotspec(grid[row])
        axes.tick_params(labelleft=True, labelbottom=True)
        if not axes.get_ylabel():
            axes.set_ylabel(label)


def _wrap(axes: Axes, letters: int) -> None:
    texts: list[Text | None] = [left_title(axes), axes.xaxis.label]
    for text in texts:
        if text is not None and text.get_text():
            text.set_text(_broken(text.get_text(), letters))


def _broken(text: str, letters: int) -> str:
    lines = (textwrap.wrap(line, max(letters, 8), break_long_words=False) for line in text.split("\n"))
    return "\n".join(part for line in lines for part in line)
