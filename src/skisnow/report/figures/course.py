"""Figure of a line through the gates of a course from above, coloured by a quantity along it."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ..._support.arrays import FloatArray
from ..._support.errors import ParameterError
from ..._support.messages import Message
from ..._support.units import DEGREE
from ...scenario import Plane
from ...scenario.terrain import normals_of
from ...simulation.run import Run
from ...simulation.run_summary import run_gates
from ...track.course import CourseResult
from .style import BLACK, BLUE, DOUBLE_MM, GREY, VERMILLION, legend_below, new_figure

STRETCHED: Final = 5.0  # ratio of length to width of a course above which both axes have different scales
SINGLE_POLE: Final = 1.5  # drawn length (m) of the line of a gate without an outer pole
MOST_NAMES: Final = 40
_HEIGHT_MM: Final = 82.0
_MARGIN: Final = 0.04


def course_line(
    result: CourseResult,
    place: FloatArray,
    values: FloatArray,
    *,
    label: str,
    diverging: bool,
    axes_words: str = "$x$ (m)",
) -> Figure:
    """Draw a run from above with the gates of its course, coloured by a quantity.

    result: course with the passages of its gates.
    place: places of the line (m), shape (n, 2) or (n, 3).
    values: quantity shown as colour, shape (n,).
    label: label of the colour scale, with the unit.
    diverging: True for a colour scale that is symmetric about 0, such as left and right.
    axes_words: label of x with the unit (default: the symbol).
    """
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=_HEIGHT_MM)
    axes = figure.add_subplot()
    points = np.concatenate([place[:, :2], [gate.turning for gate in result.course.gates]])
    _draw_gates(axes, result)
    pieces = np.stack([place[:-1, :2], place[1:, :2]], axis=1)
    middle = 0.5 * (values[:-1] + values[1:])
    colours = "PuOr_r" if diverging else "viridis"
    line = LineCollection(list(pieces), array=middle, cmap=colours, linewidth=2.2, zorder=3, capstyle="round")
    magnitude = np.abs(middle[np.isfinite(middle)])
    largest = float(magnitude.max()) if magnitude.size else 1.0
    line.set_clim(-largest if diverging else 0.0, largest or 1.0)
    axes.add_collection(line)
    _set_axes(axes, points, axes_words)
    figure.colorbar(line, ax=axes, label=label, pad=0.01, aspect=22)
    legend_below(figure, _legend_handles(result))
    return figure


def _draw_gates(axes: Axes, result: CourseResult) -> None:
    """Draw the gates with their poles, names of a few, and a cross at each gate that was not passed."""
    for number, (passage, line) in enumerate(zip(result.passages, result.course.lines, strict=True)):
        reach = line.width if np.isfinite(line.width) else SINGLE_POLE
        end = line.pole + reach * line.across
        axes.plot(*np.stack([line.pole, end], axis=1), color=GREY, linewidth=0.7, zorder=1)
        colour = (VERMILLION, BLUE)[number % 2]
        axes.plot(*line.pole, marker="o", markersize=4.2, color=colour, linestyle="none", zorder=4)
        if np.isfinite(line.width):
            axes.plot(
                *end, marker="o", markersize=3.0, markerfacecolor="none", color=colour, linestyle="none", zorder=4
            )
        if passage.outcome != "passed":
            axes.plot(*line.pole, marker="x", markersize=8.0, color=BLACK, linestyle="none", zorder=5)
        if len(result.passages) <= MOST_NAMES:
            away = -9.0 * line.across
            axes.annotate(
                passage.gate.name, (float(line.pole[0]), float(line.pole[1])), (float(away[0]), float(away[1])),
                textcoords="offset points", ha="center", va="center", fontsize=6.5,
            )  # fmt: skip


def _set_axes(axes: Axes, points: FloatArray, words: str) -> None:
    """Set limits and labels (`words` at x) of a plan view; the scales differ if the course is long and narrow."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 1.0)
    margin = np.maximum(_MARGIN * size, 1.0)
    stretched = size.max() / size.min() > STRETCHED
    axes.set_xlim(low[0] - margin[0], high[0] + margin[0])
    axes.set_ylim(low[1] - margin[1] - 1.0, high[1] + margin[1] + 1.0)
    axes.set_aspect("auto" if stretched else "equal", adjustable="box")
    axes.set_xlabel(words)
    axes.set_ylabel(Message("to the left $y$ (m),\nanother scale") if stretched else Message("to the left $y$ (m)"))
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=2))


def _legend_handles(result: CourseResult) -> list[Line2D]:
    """Legend entries of poles, and of gates that were not passed if there are any."""
    style: dict[str, Any] = {"linestyle": "none", "marker": "o"}
    poles = ((VERMILLION, Message("turning pole of gate 1, 3, 5 …")), (BLUE, Message("of gate 2, 4, 6 …")))
    handles = [Line2D([], [], color=colour, markersize=4.2, label=label, **style) for colour, label in poles]
    if any(gate.outer is not None for gate in result.course.gates):
        label = Message("outer pole")
        handles.append(Line2D([], [], color=GREY, markerfacecolor="none", markersize=3.0, label=label, **style))
    if result.fault is not None:
        cross: dict[str, Any] = style | {"marker": "x", "markersize": 6.0}
        handles.append(Line2D([], [], color=BLACK, label=Message("not passed"), **cross))
    return handles


def run_course(run: Run) -> Figure:
    """Draw the line of a run over its course; ParameterError for a run without a course."""
    result = run_gates(run)
    if result is None:
        raise ParameterError(
            "the run has no course, or ended before its first step; give the scenario course.file"
        ).tag("no_course")
    level = isinstance(run.scenario.slope, Plane)
    words = Message("distance down the fall line $x$ (m)") if level else Message("horizontal distance $x$ (m)")
    label = Message("edge angle (°)")
    return course_line(result, run.place, edge_angles(run) / DEGREE, label=label, diverging=True, axes_words=words)


def edge_angles(run: Run) -> FloatArray:
    """Mean edge angle of both skis at the boots, shape (n,), positive with the left edges down (rad)."""
    return edge_angles_of_skis(run).mean(axis=1)


def edge_angles_of_skis(run: Run) -> FloatArray:
    """Edge angle of each ski (rad), positive with left edges down, (n, 2); (n, 1) if both are equal."""
    normal = normals_of(run.scenario.slope, run.place[:, 0], run.place[:, 1])
    if run.boots is not None:
        left = run.boots.axes[:, :, 1]
    else:
        angle = run.scenario.sledge.edge_angle
        left = (run.attitude @ np.array([0.0, np.cos(angle), -np.sin(angle)]))[:, None]
    return np.asarray(np.arcsin(np.clip(-np.einsum("nka,na->nk", left, normal), -1.0, 1.0)))
