"""A measured track from above: runs, lifts, and in a single run its turns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..number_formatting import counted
from .style import BLACK, BLUE, DOUBLE_MM, GREY, PALE, VERMILLION, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...track.summary import TrackSummary

FloatArray = npt.NDArray[np.float64]

_LABELS: Final = {
    "file": ("$x$ (m)", "$y$ (m)"),
    "east_north_up": ("east (m)", "north (m)"),
    "slope": ("distance down the fall line $x$ (m)", "to the left $y$ (m)"),
}
_MARGIN: Final = 0.04
_LARGEST_MM, _SMALLEST_MM = 150.0, 16.0
_FRAME_MM: Final = 26.0
MOST_TURNS: Final = 40
"""Turns that are told apart; more would be a pattern of dots."""
MOST_DRAWN: Final = 10_000
"""Points of a line that a page can show."""


def track_map(summary: TrackSummary) -> Figure:
    """Draw the places as recorded with equal scales; points that are marked as wrong are left out."""
    limits = map_limits(summary.track.place[summary.track.usable])
    height = float(np.clip((limits[3] - limits[2]) / (limits[1] - limits[0]) * 150.0, _SMALLEST_MM, _LARGEST_MM))
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height + _FRAME_MM)
    axes = figure.add_subplot()
    _line(axes, summary, 0, len(summary.track) - 1, color=PALE, linewidth=0.7, zorder=1)
    for lift in summary.day.lifts:
        _line(axes, summary, lift.first, lift.last, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)), zorder=2)
    if turns_are_distinct(summary):
        _turns(axes, summary)
    else:
        for run in summary.day.runs:
            _line(axes, summary, run.first, run.last, color=BLUE, linewidth=0.9, zorder=3)
    _ends(axes, summary)
    _frame(axes, limits, summary.track.axes)
    legend_below(figure, _handles(summary))
    return figure


def turns_are_distinct(summary: TrackSummary) -> bool:
    """Whether single turns are drawn."""
    return len(summary.day.runs) == 1 and 0 < len(summary.turns) <= MOST_TURNS


def map_limits(place: FloatArray) -> tuple[float, float, float, float]:
    """Least and greatest first and second coordinate of places (n, 2 or more) with a margin (m)."""
    low, high = np.nanmin(place[:, :2], axis=0), np.nanmax(place[:, :2], axis=0)
    margin = max(_MARGIN * float((high - low).max()), 0.5)
    return float(low[0] - margin), float(high[0] + margin), float(low[1] - margin), float(high[1] + margin)


def drawn_points(first: int, last: int) -> npt.NDArray[np.int64]:
    """Numbers of the points that a line needs, both ends among them."""
    return np.unique(np.linspace(first, last, min(last - first + 1, MOST_DRAWN)).round().astype(np.int64))


def _line(axes: Axes, summary: TrackSummary, first: int, last: int, **line_style: object) -> None:
    """A line through the usable points; gaps stay open."""
    numbers = drawn_points(first, last)
    numbers = numbers[summary.track.usable[numbers]]
    place = summary.track.place[numbers, :2]
    after_gap = np.flatnonzero(np.diff(summary.motion.smoothed.part[numbers])) + 1
    x, y = (np.insert(place[:, axis], after_gap, np.nan) for axis in (0, 1))
    axes.plot(x, y, **line_style)  # type: ignore[arg-type]


def _turns(axes: Axes, summary: TrackSummary) -> None:
    usable = summary.track.usable
    time, place = summary.motion.time[usable], summary.track.place[usable]
    for turn in summary.turns:
        first, last = int(np.searchsorted(time, turn.start, side="right")), int(np.searchsorted(time, turn.end))
        inside = drawn_points(first, max(last - 1, first))
        colour = BLUE if turn.direction == "left" else VERMILLION
        x, y = (np.interp([turn.start, *time[inside], turn.end], time, place[:, axis]) for axis in (0, 1))
        axes.plot(x, y, color=colour, linewidth=1.3, zorder=4)
    x, y = (np.interp(switch_times(summary), time, place[:, axis]) for axis in (0, 1))
    axes.plot(x, y, linestyle="none", marker="o", markersize=3.0, color=BLACK, zorder=5)


def switch_times(summary: TrackSummary) -> FloatArray:
    """Times (s) at which one turn ends and the next begins."""
    ends = np.array([turn.end for turn in summary.turns[:-1]])
    return ends[ends == np.array([turn.start for turn in summary.turns[1:]])]


def _ends(axes: Axes, summary: TrackSummary) -> None:
    chosen = np.flatnonzero(summary.track.usable)
    for number, word in ((chosen[0], "start"), (chosen[-1], "end")):
        x, y = summary.track.place[number, :2]
        axes.plot(x, y, marker="s", markersize=3.2, linestyle="none", color=BLACK, zorder=6)
        axes.annotate(word, (x, y), (5, 5), textcoords="offset points", fontsize=7.0, zorder=6)


def _frame(axes: Axes, limits: tuple[float, float, float, float], kind: str) -> None:
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(limits[0], limits[1])
    axes.set_ylim(limits[2], limits[3])
    across, up = _LABELS[kind]
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=2))


def _handles(summary: TrackSummary) -> list[Line2D]:
    handles = []
    if turns_are_distinct(summary):
        handles += [
            Line2D([], [], color=c, label=f"turn to the {s}") for c, s in ((BLUE, "left"), (VERMILLION, "right"))
        ]
        handles.append(Line2D([], [], color=BLACK, linestyle="none", marker="o", markersize=3.0, label="switch point"))
    elif summary.day.runs:
        handles.append(Line2D([], [], color=BLUE, label=counted(len(summary.day.runs), "run")))
    if summary.day.lifts:
        handles.append(Line2D([], [], color=GREY, linestyle=(0, (4, 2)), label=counted(len(summary.day.lifts), "lift")))
    return [*handles, Line2D([], [], color=PALE, label="neither" if handles else "track")]
