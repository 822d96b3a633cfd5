"""Figure of a run from above: tracks of both skis, grooves, time marks, fall line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from scipy.ndimage import median_filter

from ..._support.arrays import FloatArray
from ..._support.messages import Message, outcome_words
from ..._support.units import MM
from ...scenario import Plane
from ...simulation.run import Run
from ..figures.style import BLACK, BLUE, DOUBLE_MM, GREY, VERMILLION, legend_below, new_figure

SKI_COLOURS: Final = (BLUE, VERMILLION)  # colours of the left and the right ski
SKIS: Final = (Message("left ski"), Message("right ski"))
_GROOVES: Final = (
    Message("groove of the left ski, stretched across"),
    Message("groove of the right ski, stretched across"),
)
CUTOUT: Final = 2.0  # length (m) of the enlarged part of the track
_LARGEST_MM, _SMALLEST_MM = 130.0, 32.0
_PLAN_MM: Final = DOUBLE_MM - 22.0  # width (mm) of the plan
_FRAME_MM: Final = 38.0
_DETAIL_MM: Final = 38.0
_LEAST_REACH: Final = 2.0  # minimum of half the height (mm) of the detail
_SPACING: Final = 0.02
_MOST_MARKS: Final = 16
_HALO: Final = [withStroke(linewidth=2.2, foreground="white")]  # clears the lines behind a time mark's text
_LABEL_POINTS: Final = 12.0  # distance of a time mark's text from the track (points)
_APART_MM: Final = 9.0  # minimum distance (mm) of two time marks with texts


def run_track(run: Run) -> Figure:
    """Draw the whole run with equal scales, and the grooves over a short distance at half time."""
    x_low, x_high, y_low, y_high = track_limits(run.skis.track.reshape(-1, 3))
    # at least the height of the lowest plan, as space for the texts at a long, flat run
    lacking = max((x_high - x_low) * _SMALLEST_MM / _PLAN_MM - (y_high - y_low), 0.0)
    limits = x_low, x_high, y_low - 0.4 * lacking, y_high + 0.6 * lacking
    height = plan_height_mm(limits)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height + _DETAIL_MM + _FRAME_MM)
    grid = figure.add_gridspec(2, 2, height_ratios=(height + 12.0, _DETAIL_MM))
    draw_plan(figure.add_subplot(grid[0, :]), run, limits)
    _draw_groove_details(figure, [figure.add_subplot(grid[1, ski]) for ski in (0, 1)], run)
    handles = [Line2D([], [], color=colour, label=name) for colour, name in zip(SKI_COLOURS, SKIS, strict=True)]
    mark = Message("every {time:g} s; square: end", time=_mark_interval(run))
    handles.append(Line2D([], [], linestyle="none", marker="o", markersize=3.0, color=BLACK, label=mark))
    legend_below(figure, handles)
    return figure


def track_limits(points: FloatArray, *, margin: float = 0.6, share: float = 0.0) -> tuple[float, float, float, float]:
    """Minimum and maximum of x and of y of points (n, 2 or more), with a margin (m) or a share of the larger extent."""
    low, high = np.nanmin(points[:, :2], axis=0), np.nanmax(points[:, :2], axis=0)
    room = max(share * float((high - low).max()), margin)
    return float(low[0] - room), float(high[0] + room), float(low[1] - room), float(high[1] + room)


def plan_height_mm(limits: tuple[float, float, float, float]) -> float:
    """Height (mm) of a plan as wide as the figure, between a minimum and a maximum."""
    x_low, x_high, y_low, y_high = limits
    return float(np.clip((y_high - y_low) / (x_high - x_low) * _PLAN_MM, _SMALLEST_MM, _LARGEST_MM))


def plan_axes(
    axes: Axes,
    limits: tuple[float, float, float, float],
    *,
    profile: bool = False,
    labels: tuple[str, str] | None = None,
) -> None:
    """Set equal scales, x to the right and y up, and draw an arrow down the fall line without other labels."""
    down = Message("horizontal distance $x$ (m)") if profile else Message("distance down the fall line $x$ (m)")
    xlabel, ylabel = labels or (down, Message("to the left $y$ (m)"))
    axes.set_aspect("equal", adjustable="box")
    axes.set(xlim=limits[:2], ylim=limits[2:], xlabel=xlabel, ylabel=ylabel)
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=2))
    if labels is not None:
        return
    axes.annotate(
        "", (0.21, 1.035), (0.08, 1.035), xycoords="axes fraction",  # right of the panel's letter
        arrowprops={"arrowstyle": "-|>", "color": GREY, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip
    axes.annotate(Message("fall line"), (0.22, 1.035), xycoords="axes fraction", va="center", fontsize=7.0, color=GREY)


def draw_plan(axes: Axes, run: Run, limits: tuple[float, float, float, float]) -> None:
    """Draw the tracks of both skis with time marks, start and end."""
    for ski, colour in enumerate(SKI_COLOURS):
        axes.plot(run.skis.track[:, ski, 0], run.skis.track[:, ski, 1], color=colour, linewidth=0.9)
    _draw_time_marks(axes, run, min(_PLAN_MM / (limits[1] - limits[0]), _LARGEST_MM / (limits[3] - limits[2])))
    plan_axes(axes, limits, profile=not isinstance(run.scenario.slope, Plane))


def _mark_interval(run: Run) -> int:
    """Whole seconds between two time marks."""
    return max(1, math.ceil(run.simulated_s / _MOST_MARKS))


def _draw_time_marks(axes: Axes, run: Run, mm_per_metre: float) -> None:
    """Draw marks at equal times, each with its time unless the text before is too near; the end with its outcome."""
    marks = np.arange(0.0, run.simulated_s + 1e-9, _mark_interval(run))
    x, y = (np.interp(marks, run.time, run.place[:, k]) for k in (0, 1))
    axes.plot(x, y, linestyle="none", marker="o", markersize=2.6, color=BLACK, zorder=4)
    aside = np.interp(marks, run.time, np.unwrap(run.heading))
    labelled: tuple[float, float] | None = None
    for mark, at_x, at_y, angle in zip(marks, x, y, aside, strict=True):
        if labelled is not None and mm_per_metre * math.dist(labelled, (at_x, at_y)) < _APART_MM:
            continue
        labelled = float(at_x), float(at_y)
        aside_points, above_points = -_LABEL_POINTS * math.sin(angle), _LABEL_POINTS * math.cos(angle)
        words, is_first = (Message("start"), True) if mark == 0.0 else (Message("{time:g} s", time=mark), False)
        if is_first:  # clear of the numbers at the axis
            aside_points = max(aside_points, 0.0)
        axes.annotate(
            words, labelled, (aside_points, above_points), textcoords="offset points",
            ha="left" if is_first else "center", va="center", fontsize=6.5, path_effects=_HALO,
        )  # fmt: skip
    axes.plot(*run.place[-1, :2], linestyle="none", marker="s", markersize=3.4, color=BLACK, zorder=4)
    ended = Message("{outcome} at {time:.2f} s", outcome=outcome_words(run.outcome), time=run.simulated_s)
    axes.annotate(ended, (1.0, 1.035), xycoords="axes fraction", ha="right", va="center", fontsize=7.0)


def _draw_groove_details(figure: Figure, row: Sequence[Axes], run: Run) -> None:
    """Draw the grooves over a short distance at half time, stretched across and coloured by the residual depth."""
    centre = run.place[len(run.time) // 2]
    near = np.linalg.norm(run.groove.middle - centre, axis=1) < CUTOUT + run.scenario.sledge.stance_width
    top = max(float(run.groove.residual_depth[near].max(initial=0.0)) / MM, 1e-9)
    for ski, axes in enumerate(row):
        arc_length, aside = beside_track(
            run.groove.middle[near], run.skis.track[:, ski], run.skis.track[len(run.time) // 2, ski]
        )
        chosen = (abs(arc_length) < CUTOUT / 2.0) & (abs(aside) < run.scenario.sledge.stance_width / 2.0)
        width, depth = (values[near][chosen] for values in (run.groove.width, run.groove.residual_depth))
        along, across = arc_length[chosen], aside[chosen]
        across, width = steady_edges(along, across, width)
        corners = groove_corners(along, across, width, run.numbers.get("line_spacing_m", _SPACING))
        drawn = PolyCollection(list(corners), array=depth / MM, cmap="cividis_r", edgecolor="face", linewidth=0.6)
        drawn.set_clim(0.0, top)
        drawn.set_rasterized(True)
        axes.add_collection(drawn)
        axes.axhline(0.0, color=SKI_COLOURS[ski], linewidth=0.8)
        reach = 1.15 * max(float(abs(corners[..., 1]).max(initial=0.0)), _LEAST_REACH)
        axes.set_xlim(-CUTOUT / 2.0, CUTOUT / 2.0)
        axes.set_xticks(np.linspace(-CUTOUT / 2.0, CUTOUT / 2.0, 5))
        ticks = np.asarray(MaxNLocator(4, steps=[1, 2, 5, 10]).tick_values(-reach, reach))
        axes.set_yticks(ticks[abs(ticks) <= reach])  # fixed, because the layout reserves space for their first numbers
        axes.set_ylim(-reach, reach)
        axes.set_xlabel(Message("distance from the place at {time:.2f} s (m)", time=run.time[len(run.time) // 2]))
        axes.set_title(_GROOVES[ski], loc="left", fontsize=7.5)
    row[0].set_ylabel(Message("to the left of\nthe track (mm)"))
    figure.colorbar(drawn, ax=list(row), label=Message("depth that\nstays (mm)"), pad=0.01, aspect=12)


def beside_track(points: FloatArray, track: FloatArray, origin: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Arc length from ``origin`` and offset to the left of points (k, 3) at a track (n, 3), from above (m), each (k,).

    Each point belongs to the nearest piece of the track.
    """
    start, along = track[:-1, :2], np.diff(track[:, :2], axis=0)
    length = np.linalg.norm(along, axis=1)
    ahead = along / np.where(length > 0.0, length, 1.0)[:, None]
    ways = np.concatenate([[0.0], np.cumsum(length)])
    zero = ways[int(np.argmin(np.linalg.norm(track - origin, axis=1)))]
    apart = points[:, None, :2] - start
    share = np.clip((apart * ahead).sum(axis=2), 0.0, length)
    nearest = np.argmin(np.linalg.norm(apart - share[..., None] * ahead, axis=2), axis=1)
    number = np.arange(len(points))
    direction, offset = ahead[nearest], apart[number, nearest]
    aside = direction[:, 0] * offset[:, 1] - direction[:, 1] * offset[:, 0]
    return ways[nearest] + share[number, nearest] - zero, aside


def steady_edges(arc_length: FloatArray, aside: FloatArray, width: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Middle and width (m) with running medians of both edges over `STEADY` lines of snow.

    A flat ski hardly marks the snow at its edges, so that the outermost mark of single lines varies by centimetres.

    >>> ends = np.array([10.0, 10.0, 30.0, 10.0, 10.0])
    >>> [values.tolist() for values in steady_edges(np.arange(5.0), np.zeros(5), ends)]
    [[0.0, 0.0, 0.0, 0.0, 0.0], [10.0, 10.0, 10.0, 10.0, 10.0]]
    """
    if not len(width):
        return aside, width
    order = np.argsort(arc_length, kind="stable")
    edges = np.empty((2, len(order)))
    for side, sign in enumerate((0.5, -0.5)):
        edges[side, order] = median_filter((aside + sign * width)[order], size=STEADY, mode="nearest")
    return edges.mean(axis=0), edges[0] - edges[1]


def groove_corners(arc_length: FloatArray, aside: FloatArray, width: FloatArray, spacing: float) -> FloatArray:
    """Corners (k, 4, 2) of pieces of groove: along the track (m), across it (mm)."""
    half, wide = spacing / 2.0, width / 2.0
    x = np.stack([arc_length - half, arc_length + half, arc_length + half, arc_length - half], axis=1)
    y = np.stack([aside + wide, aside + wide, aside - wide, aside - wide], axis=1) / MM
    return np.stack([x, y], axis=2)


STEADY: Final = 9  # lines of snow over which the drawn edges of a groove are medians
