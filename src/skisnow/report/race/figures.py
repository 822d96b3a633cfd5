"""Figures of a race: lines from above, progress of the search, effect of variants on the time, gaps at gates."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..._support.messages import Message, joined
from ...racing import QuickestLine, Worth
from ...track.course.gates_table import GateGap
from ..figures.drawing import Drawing
from ..figures.style import BLACK, BLUE, DOUBLE_MM, GREY, PALE, SINGLE_MM, VERMILLION, legend_below, new_figure
from ..formatting import figure_text, prose

_HEIGHT_MM = 105.0


def race_lines(result: QuickestLine) -> Figure:
    """Draw both lines with the poles from above, and below them the times of all simulated lines of the search."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=_HEIGHT_MM)
    above, below = figure.subplots(2, 1, height_ratios=(1.2, 1.0))
    _draw_lines(above, result)
    _draw_history(below, result)
    legend_below(figure, above.get_legend_handles_labels()[0] + below.get_legend_handles_labels()[0])
    return figure


def _draw_lines(axes: Axes, result: QuickestLine) -> None:
    """Draw the quickest line, the start line, their apexes and the turning poles."""
    for line, colour, label in (
        (result.start, GREY, Message("where the search began")),
        (result.line, BLUE, Message("quickest line")),
    ):
        x = np.arange(line.start[0], line.apexes[-1][0] + 2.0, 0.1)
        y = [line.at(float(distance))[0] for distance in x]
        axes.plot(x, y, color=colour, linewidth=1.6, label=label)
        apex = np.array(line.apexes[1:])
        axes.plot(*apex.T, linestyle="none", marker="|", color=colour, markersize=7.0)
    poles = np.array([gate.turning for gate in result.line.course.gates])
    axes.plot(*poles.T, linestyle="none", marker="o", color=VERMILLION, markersize=4.2, label=Message("turning pole"))
    axes.set_xlabel(Message("down the slope $x$ (m)"))
    axes.set_ylabel(Message("to the left $y$ (m)"))
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=3))


def _draw_history(axes: Axes, result: QuickestLine) -> None:
    """Draw the time (s) of each evaluation over the whole course, the best so far, and failed ones at the top."""
    whole = [entry for entry in result.history if len(entry.row["turns"]) == len(result.line.turns)]
    number, value = np.array([(entry.number, entry.value) for entry in whole]).T
    through = value < 1000.0
    axes.plot(number[through], value[through], ".", color=PALE, markersize=3.0, label="evaluation")
    if through.any():
        best = np.minimum.accumulate(np.where(through, value, np.inf))
        axes.plot(number[np.isfinite(best)], best[np.isfinite(best)], color=BLUE, label=Message("best so far"))
        low = float(value[through].min())
        axes.set_ylim(low - 0.05, low + 0.03 + max(0.3, float(np.quantile(value[through], 0.9)) - low))
    lost = number[~through]
    transform, label = axes.get_xaxis_transform(), Message("not through all gates")
    axes.plot(lost, np.full(len(lost), 0.97), "x", color=VERMILLION, markersize=2.6, label=label, transform=transform)
    axes.set_xlabel("evaluation")
    axes.set_ylabel(Message("time to the last gate (s)"))


_ROW_MM, _FRAME_MM = 9.0, 28.0


def race_worth(variants: Sequence[Worth]) -> Figure:
    """Draw for each variant, in a row, its time less that of the unchanged scenario."""
    figure = new_figure(width_mm=1.5 * SINGLE_MM, height_mm=_FRAME_MM + _ROW_MM * len(variants))
    axes = figure.add_subplot()
    scenario_mark: dict[str, Any] = {"color": BLACK, "marker": "D", "markersize": 4.5, "linestyle": "none"}
    snow_mark: dict[str, Any] = {"color": BLUE, "marker": "|", "markersize": 9.0, "linestyle": "none"}
    for row, variant in enumerate(variants):
        values = variant.differences
        axes.plot(values, np.full(len(values), row), **snow_mark)
        if not len(values):
            axes.text(0.0, row, f"{Message('not through all gates')} ", ha="right", va="center", fontsize=7.0)
        if variant.on_own_snow is not None:
            axes.plot(variant.on_own_snow, row, **scenario_mark)
    axes.axvline(0.0, color=GREY, linewidth=0.7)
    axes.set_yticks(range(len(variants)), [variant.name for variant in variants])
    axes.set_ylim(len(variants) - 0.4, -0.6)
    axes.set_xlabel(Message("time more than as it is (s)"))
    own = Line2D([], [], label=Message("on the snow of the scenario"), **scenario_mark)
    legend_below(figure, [own, Line2D([], [], label=Message("on each snow"), **snow_mark)])
    return figure


MOST_NAMES = 26  # maximum number of gate names on the axis; of more gates, every k-th has its name


def gap_drawings(gaps: Sequence[GateGap], names: tuple[str, str]) -> Iterator[Drawing]:
    """Yield the figure of the gaps if both runs crossed a gate; ``names``: of the run, and of the one compared with."""
    if all(gap.gap_s is None for gap in gaps):
        return
    fields = {"own": names[0], "other": names[1]}
    alt = Message("Gap in time at each gate and time lost between gates, {own} against {other}.", **fields)
    caption = prose(
        "(a) Gap of {own} to {other} at each gate, both from their starts. (b) Time lost since the gate before "
        "that both crossed. Above 0 {own} is behind or loses.",
        **fields,
    )
    alt = joined([alt, last_words(gaps, names)])
    yield Drawing("gate_gaps", caption, alt, gate_gaps_figure(gaps, names), wide=True)


def last_words(gaps: Sequence[GateGap], names: tuple[str, str]) -> Message:
    """Sentence on who is ahead by how much at the last gate that both runs crossed, or that they crossed none."""
    last = next((gap for gap in reversed(gaps) if gap.gap_s is not None), None)
    if last is None:
        return Message("No gate was crossed by both.")
    gap = last.gap_s or 0.0
    fields = {"own": names[0], "other": names[1], "gate": last.gate, "gap": abs(gap)}
    if abs(gap) < 0.005:
        return Message("{own} and {other} cross gate {gate} level.", **fields)
    if gap > 0:
        return Message("{own} crosses gate {gate} {gap:.2f} s behind {other}.", **fields)
    return Message("{own} crosses gate {gate} {gap:.2f} s ahead of {other}.", **fields)


def gate_gaps_figure(gaps: Sequence[GateGap], names: tuple[str, str]) -> Figure:
    """Draw the gap at each gate, and below it the time lost between gates."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=100.0)
    above, below = figure.subplots(2, 1, sharex=True)
    crossed = [i for i, gate in enumerate(gaps) if gate.gap_s is not None]
    gap, lost = (np.array([getattr(gaps[i], name) for i in crossed], dtype=float) for name in ("gap_s", "lost_s"))
    for axes in (above, below):
        axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)
    above.plot(crossed, gap, marker="o", markersize=3.4, color=BLUE, linewidth=1.1)
    above.set_ylabel(Message("gap to {name} (s)\nbehind +", name=figure_text(names[1], longest=24)))
    below.bar(crossed, lost, width=0.7, color=np.where(lost > 0, VERMILLION, BLUE).tolist())
    below.set_ylabel(Message("lost since the\ngate before (s)"))
    below.set_xlabel(Message("gate"))
    every = range(0, len(gaps), 1 + (len(gaps) - 1) // MOST_NAMES)
    below.set_xticks(list(every), [figure_text(gaps[i].gate, longest=8) for i in every])
    below.set_xlim(-0.7, len(gaps) - 0.3)
    figure.align_ylabels()
    return figure
