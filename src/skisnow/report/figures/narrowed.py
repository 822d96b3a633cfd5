"""A wide figure laid out again for a telephone: the same panels, closer or below each other, words in the same size."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Final

from matplotlib.gridspec import GridSpec

from .panels import left_title, panels_of
from .style import MM_PER_INCH, legend_below

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Text

WIDTH_MM: Final = 96.0
"""As wide as a telephone of 390 pixels shows it with its words in their own size."""
_LETTER_MM: Final = 1.55
_EQUAL: Final = 0.62
"""Of the height, where a panel has the same scale along both axes and grows narrower with the figure (about)."""
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
    elif any(axes.get_aspect() != "auto" for axes in panels):
        height_mm *= _EQUAL
    figure.set_size_inches(WIDTH_MM / MM_PER_INCH, height_mm / MM_PER_INCH)
    for axes in panels:
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
