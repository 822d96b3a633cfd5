"""Speed, height and turn radius over the distance along a measured track."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ...track.curvature import INTERVAL_FACTOR
from .style import BLUE, DOUBLE_MM, GREY, PALE, SKY, new_figure
from .track_map import drawn_points

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...track.summary import TrackSummary

FloatArray = npt.NDArray[np.float64]

WALKING: Final = 2.0
"""Speed (m/s) from which a radius is drawn (modelling assumption)."""
KILOMETRE: Final = 1000.0
"""Metres in a kilometre."""
_IN_KILOMETRES: Final = 3000.0
"""Distances (m) that are longer are given in km."""
_RADII: Final = (2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 2000, 5000)
_TICKS: Final = 3
"""Radii named on each side of the axis."""
_SHARE_SHOWN: Final = 0.98
"""Share of the distance in runs whose curvature is inside the axis."""
_NEIGHBOURS: Final = 0.18
"""Least distance of two named radii, as a share of half the axis."""


def track_along(summary: TrackSummary) -> Figure:
    """Draw three curves over one axis of distance; runs stand on a tint, and only they have a radius."""
    with_height = bool(np.isfinite(summary.track.place[:, 2]).any())
    rows = 3 if with_height else 2
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=42.0 * rows + 10.0)
    grid = figure.subplots(rows, 1, sharex=True)
    numbers = drawn_points(0, len(summary.track) - 1)
    numbers = numbers[summary.track.usable[numbers]]
    arc_length = summary.motion.arc_length - summary.motion.arc_length[0]
    unit = KILOMETRE if arc_length[-1] > _IN_KILOMETRES else 1.0
    _speed(grid[0], summary, numbers, arc_length / unit)
    if with_height:
        _height(grid[1], summary, numbers, arc_length / unit)
    _radius(grid[-1], summary, arc_length / unit)
    for axes in grid:
        _tint_runs(axes, summary, arc_length / unit)
    grid[-1].set_xlabel(f"distance along the track ({'km' if unit == KILOMETRE else 'm'})")
    grid[-1].set_xlim(0.0, float(arc_length[-1]) / unit)
    figure.align_ylabels()
    figure.legend(handles=_handles(summary), loc="outside lower center", ncols=4)
    return figure


def _tint_runs(axes: Axes, summary: TrackSummary, arc_length: FloatArray) -> None:
    if len(summary.day.runs) < 2 and not summary.day.lifts:
        return
    for run in summary.day.runs:
        axes.axvspan(
            float(arc_length[run.first]), float(arc_length[run.last]), color=SKY, alpha=0.16, linewidth=0.0, zorder=0
        )


def _parted(summary: TrackSummary, numbers: npt.NDArray[np.int64], values: FloatArray) -> FloatArray:
    """Values at these points, the first after each gap not drawn, so that the line has a hole."""
    found = values[numbers].astype(float)
    found[1:][np.diff(summary.motion.smoothed.part[numbers]) > 0] = np.nan
    return found


def _speed(axes: Axes, summary: TrackSummary, numbers: npt.NDArray[np.int64], arc_length: FloatArray) -> None:
    speed = _parted(summary, numbers, summary.motion.speed)
    path = summary.motion.path
    if path is not None:
        half = INTERVAL_FACTOR * path.speed_sd_at(summary.track.time[numbers])
        low, high = np.maximum(speed - half, 0.0), speed + half
        axes.fill_between(arc_length[numbers], low, high, color=PALE, alpha=0.7, linewidth=0.0)
    axes.plot(arc_length[numbers], speed, color=BLUE, linewidth=0.8)
    highest = summary.max_speed_interval[1] if summary.max_speed_interval else summary.max_speed or 0.0
    axes.set_ylim(0.0, 1.1 * max(highest, 0.1))
    axes.set_ylabel(
        f"speed (m/s),\n{'as recorded' if summary.motion.speed_source == 'recorded' else 'from the places'}"
    )


def _height(axes: Axes, summary: TrackSummary, numbers: npt.NDArray[np.int64], arc_length: FloatArray) -> None:
    axes.plot(arc_length[numbers], _parted(summary, numbers, summary.track.place[:, 2]), color=BLUE, linewidth=0.8)
    words = {"east_north_up": "height above\nthe origin (m)", "slope": "out of the slope\n$z$ (m)", "file": "$z$ (m)"}
    axes.set_ylabel(words[summary.track.axes])


def _radius(axes: Axes, summary: TrackSummary, arc_length: FloatArray) -> None:
    """The curvature with its interval, its axis named by radii: a straight path lies at 0, where no radius could."""
    motion, ridden = summary.motion, _ridden_curvature(summary)
    for run in summary.day.runs:
        numbers = drawn_points(run.first, run.last)
        curvature, half = _parted(summary, numbers, ridden), INTERVAL_FACTOR * motion.curvature_sd[numbers]
        axes.fill_between(arc_length[numbers], curvature - half, curvature + half, color=PALE, alpha=0.7, linewidth=0.0)
        axes.plot(arc_length[numbers], curvature, color=BLUE, linewidth=0.8)
    reach = curvature_reach(summary)
    axes.axhline(0.0, color=GREY, linewidth=0.5, zorder=1)
    axes.set_ylim(-reach, reach)
    radii = named_radii(reach)
    axes.set_yticks([*(-1.0 / radius for radius in radii), 0.0, *(1.0 / radius for radius in reversed(radii))])
    axes.set_yticklabels([*map(str, radii), "straight", *map(str, reversed(radii))])
    axes.set_ylabel("turn radius (m),\nleft above, right below")


def _ridden_curvature(summary: TrackSummary) -> FloatArray:
    """The curvature where the track is faster than a walk; slower, feet make it and not skis."""
    return np.where(summary.motion.speed >= WALKING, summary.motion.curvature, np.nan)


def curvature_reach(summary: TrackSummary) -> float:
    """Where the axis of the curvature ends (1/m): above that of nearly all points, whatever happens near a rest."""
    ridden = np.abs(_ridden_curvature(summary))
    steps = np.gradient(summary.motion.arc_length)
    inside = np.zeros(len(ridden), dtype=bool)
    for run in summary.day.runs:
        inside[run.first : run.last + 1] = True
    order = np.argsort(ridden)[: int(np.count_nonzero(np.isfinite(ridden)))]  # unknown ones come last
    order = order[inside[order]]
    ways = np.cumsum(steps[order])
    if not len(order) or ways[-1] <= 0.0:
        return 1.0 / _RADII[-1]
    return max(1.25 * float(ridden[order[np.searchsorted(ways, _SHARE_SHOWN * ways[-1])]]), 1.0 / _RADII[-1])


def named_radii(reach: float) -> list[int]:
    """Radii (m) to be named on an axis of curvatures up to ``reach`` (1/m), the smallest first.

    >>> named_radii(0.1)
    [10, 15, 30]
    """
    found: list[int] = []
    for radius in _RADII:
        place = 1.0 / radius / reach
        apart = 1.0 / found[-1] / reach - place if found else 1.0
        if place <= 1.0 + 1e-9 and apart >= _NEIGHBOURS and place >= _NEIGHBOURS and len(found) < _TICKS:
            found.append(radius)
    return found


def _handles(summary: TrackSummary) -> list[Line2D | Patch]:
    handles: list[Line2D | Patch] = [Line2D([], [], color=BLUE, label="track")]
    handles.append(Patch(facecolor=PALE, alpha=0.7, label="95 % interval of the radius, noise alone"))
    if len(summary.day.runs) > 1 or summary.day.lifts:
        handles.append(Patch(facecolor=SKY, alpha=0.3, label="runs"))
    return handles
