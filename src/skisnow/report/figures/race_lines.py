"""Two lines through a course from above, and how a search came to the better one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.ticker import MaxNLocator

from .style import BLUE, DOUBLE_MM, GREY, PALE, VERMILLION, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...racing import QuickestLine, RacingLine

_HEIGHT_MM = 105.0


def race_lines(found: QuickestLine) -> Figure:
    """Above the lines with the poles, below the values of all evaluations."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=_HEIGHT_MM)
    above, below = figure.subplots(2, 1, height_ratios=(1.2, 1.0))
    _lines(above, found)
    _history(below, found)
    legend_below(figure, above.get_legend_handles_labels()[0] + below.get_legend_handles_labels()[0])
    return figure


def _lines(axes: Axes, found: QuickestLine) -> None:
    for line, colour, label in ((found.start, GREY, "where the search began"), (found.line, BLUE, "quickest line")):
        x, y = _drawn(line)
        axes.plot(x, y, color=colour, linewidth=1.6, label=label)
        apex = np.array(line.apexes[1:])
        axes.plot(*apex.T, linestyle="none", marker="|", color=colour, markersize=7.0)
    poles = np.array([gate.turning for gate in found.line.course.gates])
    axes.plot(*poles.T, linestyle="none", marker="o", color=VERMILLION, markersize=4.2, label="turning pole")
    axes.set_xlabel("down the slope $x$ (m)")
    axes.set_ylabel("to the left $y$ (m)")
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=3))


def _drawn(line: RacingLine) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    x = np.arange(line.start[0], line.apexes[-1][0] + 2.0, 0.1)
    return x, np.array([line.at(float(each))[0] for each in x])


def _history(axes: Axes, found: QuickestLine) -> None:
    whole = [each for each in found.history if len(each.row["turns"]) == len(found.line.turns)]
    number, value = np.array([(each.number, each.value) for each in whole]).T
    through = value < 1000.0
    axes.plot(number[through], value[through], ".", color=PALE, markersize=3.0, label="evaluation")
    if through.any():
        least = np.minimum.accumulate(np.where(through, value, np.inf))
        axes.plot(number[np.isfinite(least)], least[np.isfinite(least)], color=BLUE, label="best so far")
        low = float(value[through].min())
        axes.set_ylim(low - 0.05, low + 0.03 + max(0.3, float(np.quantile(value[through], 0.9)) - low))
    lost = number[~through]
    axes.plot(lost, np.full(len(lost), 0.97), "x", color=VERMILLION, markersize=2.6, label="not through all gates",
              transform=axes.get_xaxis_transform())  # fmt: skip
    axes.set_xlabel("evaluation")
    axes.set_ylabel("time to the last gate (s)")
