"""What variants are worth in time: the difference on each snow, and on the scenario's own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D

from .style import BLACK, BLUE, GREY, SINGLE_MM, legend_below, new_figure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.figure import Figure

    from ...racing import Worth

_ROW_MM, _FRAME_MM = 9.0, 28.0


def race_worth(found: Sequence[Worth]) -> Figure:
    """One row for each variant; left of zero it is faster."""
    figure = new_figure(width_mm=1.5 * SINGLE_MM, height_mm=_FRAME_MM + _ROW_MM * len(found))
    axes = figure.add_subplot()
    for row, each in enumerate(found):
        values = each.differences
        axes.plot(values, np.full(len(values), row), "|", color=BLUE, markersize=9.0)
        if not len(values):
            axes.text(0.0, row, "not through all gates ", ha="right", va="center", fontsize=7.0)
        if each.on_own_snow is not None:
            axes.plot(each.on_own_snow, row, "D", color=BLACK, markersize=4.5)
    axes.axvline(0.0, color=GREY, linewidth=0.7)
    axes.set_yticks(range(len(found)), [each.name for each in found])
    axes.set_ylim(len(found) - 0.4, -0.6)
    axes.set_xlabel("time more than as it is (s)")
    legend_below(
        figure, [_handle(BLACK, "D", 4.5, "on the snow of the scenario"), _handle(BLUE, "|", 9.0, "on each snow")]
    )
    return figure


def _handle(colour: str, marker: str, size: float, label: str) -> Line2D:
    return Line2D([], [], color=colour, marker=marker, markersize=size, linestyle="none", label=label)
