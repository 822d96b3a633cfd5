"""Time lost gate by gate between two ways through the same gates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..symbols import figure_text, prose
from .drawing import Drawing
from .style import BLUE, DOUBLE_MM, PALE, VERMILLION, new_figure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...track.course.gate_gaps import GateGap

MOST_NAMES = 26
"""Gates above which only some have their names on the axis."""


def gate_gaps_drawing(gaps: Sequence[GateGap], names: tuple[str, str]) -> Drawing:
    """The figure with its words; names of the run and of the one that it is held against."""
    known = [each for each in gaps if each.gap is not None]
    last = f" {last_words(gaps, names)}" if known else ""
    return Drawing(
        "gate_gaps",
        prose(
            "(a) Gap of {own} to {other} at each gate, both from their starts. (b) What was lost since the gate before "
            "that both crossed. Above 0 {own} is behind or loses.",
            own=names[0], other=names[1],
        ),
        f"Gap in time at each gate and time lost between gates, {names[0]} against {names[1]}.{last}",
        gate_gaps_figure(gaps, names),
        wide=True,
    )  # fmt: skip


def last_words(gaps: Sequence[GateGap], names: tuple[str, str]) -> str:
    """Who is ahead at the last gate that both crossed."""
    last = [each for each in gaps if each.gap is not None][-1]
    gap = last.gap or 0.0
    own, other = names
    if abs(gap) < 0.005:
        return f"{own} and {other} cross gate {last.gate} level."
    return f"{own} crosses gate {last.gate} {abs(gap):.2f} s {'behind' if gap > 0 else 'ahead of'} {other}."


def gate_gaps_figure(gaps: Sequence[GateGap], names: tuple[str, str]) -> Figure:
    """Draw gap over gates, and below it what was lost between them."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=100.0)
    above, below = figure.subplots(2, 1, sharex=True)
    known = [i for i, each in enumerate(gaps) if each.gap is not None]
    gap, lost = (np.array([getattr(gaps[i], name) for i in known], dtype=float) for name in ("gap", "lost"))
    for axes in (above, below):
        axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)
    above.plot(known, gap, marker="o", markersize=3.4, color=BLUE, linewidth=1.1)
    above.set_ylabel(f"gap to {figure_text(names[1], longest=24)} (s)\nbehind +")
    below.bar(known, lost, width=0.7, color=[VERMILLION if each > 0 else BLUE for each in lost.tolist()])
    below.set_ylabel("lost since the\ngate before (s)")
    below.set_xlabel("gate")
    _names(below, gaps)
    figure.align_ylabels()
    return figure


def _names(axes: Axes, gaps: Sequence[GateGap]) -> None:
    every = range(0, len(gaps), 1 + (len(gaps) - 1) // MOST_NAMES)
    axes.set_xticks(list(every), [figure_text(gaps[i].gate, longest=8) for i in every])
    axes.set_xlim(-0.7, len(gaps) - 0.3)
