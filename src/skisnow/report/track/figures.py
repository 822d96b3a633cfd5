"""Figures of a measured track: map, and speed, height and turn radius over the distance."""

from __future__ import annotations

from itertools import product
from typing import Final, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..._support.arrays import FloatArray, IntArray
from ..._support.messages import Message
from ...track.curvature import INTERVAL_FACTOR
from ...track.summary import TrackSummary
from ..figures.style import BLACK, BLUE, DOUBLE_MM, GREY, PALE, SKY, VERMILLION, legend_below, new_figure
from ..formatting import counted
from ..run.track_figure import plan_axes, track_limits

LABELS: Final = {
    "file": ("$x$ (m)", "$y$ (m)"),
    "east_north_up": (Message("east (m)"), Message("north (m)")),
    "slope": (Message("distance down the fall line $x$ (m)"), Message("to the left $y$ (m)")),
}
_HEIGHT_LABELS: Final = {
    "file": "$z$ (m)",
    "east_north_up": Message("height above\nthe origin (m)"),
    "slope": Message("out of the slope\n$z$ (m)"),
}
_RADIUS_LABEL: Final = Message("turn radius (m),\nleft above, right below")
_MARGIN: Final = 0.04
_LARGEST_MM, _SMALLEST_MM = 150.0, 16.0
_FRAME_MM: Final = 26.0
_SPEED_RANGE: Final = 1.0  # minimum range (m/s) of the colours, so that a constant speed has one colour
MOST_TURNS: Final = 40  # maximum number of turns that are drawn separately
MOST_DRAWN: Final = 10_000  # maximum number of points of a line


def track_map(summary: TrackSummary) -> Figure:
    """Draw the usable places as recorded, with equal scales."""
    figure, axes = _new_map(summary, _SMALLEST_MM)
    _draw_line(axes, summary, 0, len(summary.track) - 1, color=PALE, linewidth=0.7, zorder=1)
    for lift in summary.day.lifts:
        _draw_line(axes, summary, lift.first, lift.last, color=GREY, linewidth=0.7, linestyle=(0, (4, 2)), zorder=2)
    if turns_are_distinct(summary):
        _draw_turns(axes, summary)
    else:
        for run in summary.day.runs:
            _draw_line(axes, summary, run.first, run.last, color=BLUE, linewidth=0.9, zorder=3)
    _draw_ends(axes, summary)
    legend_below(figure, _handles(summary))
    return figure


def coloured_map(summary: TrackSummary, what: Literal["speed", "radius"]) -> Figure:
    """Draw the places from above, coloured by speed, or by the signed curvature with radii as labels."""
    figure, axes = _new_map(summary, 3.0 * _SMALLEST_MM)
    numbers = _usable_points(summary, 0, len(summary.track) - 1)
    values = summary.motion.speed if what == "speed" else _ridden_curvature(summary)
    place, joined = summary.track.place[numbers, :2], np.diff(summary.motion.smoothed.part[numbers]) == 0
    pieces, middle = np.stack([place[:-1], place[1:]], axis=1), 0.5 * (values[numbers[:-1]] + values[numbers[1:]])
    line = LineCollection(list(pieces[joined]), array=middle[joined], linewidth=1.8, capstyle="round")
    line.set_cmap("viridis" if what == "speed" else "PuOr_r")
    axes.add_collection(line)
    _draw_ends(axes, summary)
    if what == "speed":
        line.autoscale()
        lowest, highest = line.get_clim()
        if joined.any() and highest - lowest < _SPEED_RANGE:
            lowest = max(0.5 * (lowest + highest - _SPEED_RANGE), 0.0)
            line.set_clim(lowest, lowest + _SPEED_RANGE)
        figure.colorbar(line, ax=axes, label=Message("speed (m/s)"), pad=0.01, aspect=22)
        return figure
    reach = curvature_reach(summary)
    line.set_clim(-reach, reach)
    bar = figure.colorbar(line, ax=axes, label=_RADIUS_LABEL, pad=0.01, aspect=22)
    ticks, labels = _radius_ticks(reach)
    bar.set_ticks(ticks, labels=labels)
    return figure


def _new_map(summary: TrackSummary, lowest_mm: float) -> tuple[Figure, Axes]:
    """Empty figure and axes for a map of the usable places, with equal scales and a minimum height (mm)."""
    limits = track_limits(summary.track.place[summary.track.usable], margin=0.5, share=_MARGIN)
    height = float(np.clip((limits[3] - limits[2]) / (limits[1] - limits[0]) * 150.0, lowest_mm, _LARGEST_MM))
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height + _FRAME_MM)
    axes = figure.add_subplot()
    plan_axes(axes, limits, labels=LABELS[summary.track.axes])
    return figure, axes


def turns_are_distinct(summary: TrackSummary) -> bool:
    """True if each turn is drawn in a colour: the track is a single run with few turns."""
    return len(summary.day.runs) == 1 and 0 < len(summary.turns) <= MOST_TURNS


def drawn_points(first: int, last: int) -> IntArray:
    """Indices of at most `MOST_DRAWN` points from first to last, including both."""
    return np.unique(np.linspace(first, last, min(last - first + 1, MOST_DRAWN)).round().astype(np.int64))


def _usable_points(summary: TrackSummary, first: int, last: int) -> IntArray:
    """Indices of usable points among those drawn from first to last."""
    numbers = drawn_points(first, last)
    return numbers[summary.track.usable[numbers]]


def _draw_line(axes: Axes, summary: TrackSummary, first: int, last: int, **line_style: object) -> None:
    """Draw a line through the usable points with breaks at gaps."""
    numbers = _usable_points(summary, first, last)
    place = summary.track.place[numbers, :2]
    after_gap = np.flatnonzero(np.diff(summary.motion.smoothed.part[numbers])) + 1
    x, y = (np.insert(place[:, axis], after_gap, np.nan) for axis in (0, 1))
    axes.plot(x, y, **line_style)  # type: ignore[arg-type]


def _draw_turns(axes: Axes, summary: TrackSummary) -> None:
    """Draw each turn in the colour of its side, and the switch points between turns."""
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


def _draw_ends(axes: Axes, summary: TrackSummary) -> None:
    """Mark the first and the last usable point as start and end."""
    chosen = np.flatnonzero(summary.track.usable)
    for number, word in ((chosen[0], Message("start")), (chosen[-1], Message("end"))):
        x, y = summary.track.place[number, :2]
        axes.plot(x, y, marker="s", markersize=3.2, linestyle="none", color=BLACK, zorder=6)
        axes.annotate(word, (x, y), (5, 5), textcoords="offset points", fontsize=7.0, zorder=6)


def _handles(summary: TrackSummary) -> list[Line2D]:
    """Legend entries of what is drawn: turns and switch points or runs, lifts, and the rest of the track."""
    handles = []
    if turns_are_distinct(summary):
        turns = ((BLUE, Message("turn to the left")), (VERMILLION, Message("turn to the right")))
        handles += [Line2D([], [], color=colour, label=label) for colour, label in turns]
        handles.append(
            Line2D([], [], color=BLACK, linestyle="none", marker="o", markersize=3.0, label=Message("switch point"))
        )
    elif summary.day.runs:
        handles.append(Line2D([], [], color=BLUE, label=counted(len(summary.day.runs), "{count} run", "{count} runs")))
    if summary.day.lifts:
        lifts = counted(len(summary.day.lifts), "{count} lift", "{count} lifts")
        handles.append(Line2D([], [], color=GREY, linestyle=(0, (4, 2)), label=lifts))
    return [*handles, Line2D([], [], color=PALE, label=Message("neither") if handles else Message("track"))]


WALKING: Final = 2.0  # speed (m/s) above which a radius is drawn: slower movement is a walk (modelling assumption)
KILOMETRE: Final = 1000.0
"""Metres in a kilometre."""
_IN_KILOMETRES: Final = 3000.0  # distance (m) above which the axis is in km
_RADII: Final = (2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 2000, 5000)
_TICKS: Final = 3  # maximum number of radii named on each side of the axis
_SHARE_SHOWN: Final = 0.98  # share of the distance in runs whose curvature is inside the axis
_NEIGHBOURS: Final = 0.18  # minimum distance of two named radii as a share of half the axis


def track_along(summary: TrackSummary) -> Figure:
    """Draw speed, height and turn radius over the distance; runs have a tinted background, and only they a radius."""
    with_height = bool(np.isfinite(summary.track.place[:, 2]).any())
    rows = 3 if with_height else 2
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=42.0 * rows + 10.0)
    grid = figure.subplots(rows, 1, sharex=True)
    numbers = _usable_points(summary, 0, len(summary.track) - 1)
    arc_length = summary.motion.arc_length - summary.motion.arc_length[0]
    unit = KILOMETRE if arc_length[-1] > _IN_KILOMETRES else 1.0
    _draw_speed(grid[0], summary, numbers, arc_length / unit)
    if with_height:
        height = _with_gaps(summary, numbers, summary.track.place[:, 2])
        grid[1].plot(arc_length[numbers] / unit, height, color=BLUE, linewidth=0.8)
        grid[1].set_ylabel(_HEIGHT_LABELS[summary.track.axes])
    _draw_radius(grid[-1], summary, arc_length / unit)
    noise = Patch(facecolor=PALE, alpha=0.7, label=Message("95 % interval of the radius, noise alone"))
    handles: list[Line2D | Patch] = [Line2D([], [], color=BLUE, label=Message("track")), noise]
    if len(summary.day.runs) > 1 or summary.day.lifts:
        handles.append(Patch(facecolor=SKY, alpha=0.3, label=Message("runs")))
        for axes, run in product(grid, summary.day.runs):
            ends = arc_length[[run.first, run.last]] / unit
            axes.axvspan(*ends.tolist(), color=SKY, alpha=0.16, linewidth=0.0, zorder=0)
    in_km = unit == KILOMETRE
    grid[-1].set_xlabel(Message("distance along the track (km)") if in_km else Message("distance along the track (m)"))
    grid[-1].set_xlim(0.0, float(arc_length[-1]) / unit)
    figure.align_ylabels()
    figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


def _with_gaps(summary: TrackSummary, numbers: IntArray, values: FloatArray) -> FloatArray:
    """Values at points with these indices, NaN at the first one after each gap, so that a line has a break there."""
    parted = values[numbers].astype(float)
    parted[1:][np.diff(summary.motion.smoothed.part[numbers]) > 0] = np.nan
    return parted


def _draw_speed(axes: Axes, summary: TrackSummary, numbers: IntArray, arc_length: FloatArray) -> None:
    """Draw the speed (m/s) over the arc length (m), with its 95 % interval if it is known."""
    speed = _with_gaps(summary, numbers, summary.motion.speed)
    path = summary.motion.path
    if path is not None:
        half = INTERVAL_FACTOR * path.speed_sd_at(summary.track.time[numbers])
        low, high = np.maximum(speed - half, 0.0), speed + half
        axes.fill_between(arc_length[numbers], low, high, color=PALE, alpha=0.7, linewidth=0.0)
    axes.plot(arc_length[numbers], speed, color=BLUE, linewidth=0.8)
    highest = summary.max_speed_interval[1] if summary.max_speed_interval else summary.max_speed or 0.0
    axes.set_ylim(0.0, 1.1 * max(highest, 0.1))
    is_recorded = summary.motion.speed_source == "recorded"
    axes.set_ylabel(Message("speed (m/s),\nas recorded") if is_recorded else Message("speed (m/s),\nfrom the places"))


def _draw_radius(axes: Axes, summary: TrackSummary, arc_length: FloatArray) -> None:
    """Draw the curvature with its interval; the axis has radii as labels, and a straight path is at 0."""
    motion, ridden = summary.motion, _ridden_curvature(summary)
    for run in summary.day.runs:
        numbers = drawn_points(run.first, run.last)
        curvature, half = _with_gaps(summary, numbers, ridden), INTERVAL_FACTOR * motion.curvature_sd[numbers]
        axes.fill_between(arc_length[numbers], curvature - half, curvature + half, color=PALE, alpha=0.7, linewidth=0.0)
        axes.plot(arc_length[numbers], curvature, color=BLUE, linewidth=0.8)
    reach = curvature_reach(summary)
    axes.axhline(0.0, color=GREY, linewidth=0.5, zorder=1)
    axes.set_ylim(-reach, reach)
    axes.set_yticks(*_radius_ticks(reach))
    axes.set_ylabel(_RADIUS_LABEL)


def _ridden_curvature(summary: TrackSummary) -> FloatArray:
    """Curvature (1/m) at each point with more than walking speed, NaN elsewhere."""
    return np.where(summary.motion.speed >= WALKING, summary.motion.curvature, np.nan)


def curvature_reach(summary: TrackSummary) -> float:
    """Limit of the axis of curvature (1/m), above the curvature of 98 % of the distance in runs."""
    ridden = np.abs(_ridden_curvature(summary))
    steps = np.gradient(summary.motion.arc_length)
    inside = np.zeros(len(ridden), dtype=bool)
    for run in summary.day.runs:
        inside[run.first : run.last + 1] = True
    order = np.argsort(ridden)[: int(np.count_nonzero(np.isfinite(ridden)))]  # NaN comes last
    order = order[inside[order]]
    ways = np.cumsum(steps[order])
    if not len(order) or ways[-1] <= 0.0:
        return 1.0 / _RADII[-1]
    return max(1.25 * float(ridden[order[np.searchsorted(ways, _SHARE_SHOWN * ways[-1])]]), 1.0 / _RADII[-1])


def named_radii(reach: float) -> list[int]:
    """Radii (m) that label an axis of curvatures up to ``reach`` (1/m), in rising order.

    >>> named_radii(0.1)
    [10, 15, 30]
    """
    radii: list[int] = []
    for radius in _RADII:
        place = 1.0 / radius / reach
        apart = 1.0 / radii[-1] / reach - place if radii else 1.0
        if place <= 1.0 + 1e-9 and apart >= _NEIGHBOURS and place >= _NEIGHBOURS and len(radii) < _TICKS:
            radii.append(radius)
    return radii


def _radius_ticks(reach: float) -> tuple[list[float], list[str]]:
    """Ticks of an axis of curvatures up to ``reach`` (1/m), and the radii that label them."""
    radii = named_radii(reach)
    ticks = [*(-1.0 / radius for radius in radii), 0.0, *(1.0 / radius for radius in reversed(radii))]
    return ticks, [*map(str, radii), Message("straight"), *map(str, reversed(radii))]
