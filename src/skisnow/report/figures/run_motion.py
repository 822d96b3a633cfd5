"""Speed, heading and turn radius of a run over time."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from ..._support.units import DEGREE
from .style import BLUE, DOUBLE_MM, GREY, PALE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]
_TIMES_MEDIAN: Final = 3.0
"""Radii above so many medians are hardly turns; the axis ends there."""


def run_motion(run: Run) -> Figure:
    """Draw three curves over one time axis."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=118.0)
    speed, heading, radius = figure.subplots(3, 1, sharex=True)
    speed.plot(run.time, run.speed, color=BLUE)
    speed.set_ylabel("speed (m/s)")
    speed.set_ylim(0.0, 1.12 * max(float(np.nanmax(run.speed)), 0.1))
    heading.plot(run.time, run.heading / DEGREE, color=BLUE)
    heading.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    heading.set_ylabel("heading (°)\nleft of the fall line +")
    _radius(radius, run)
    radius.set_xlabel("time (s)")
    radius.set_xlim(float(run.time[0]), float(run.time[-1]))
    figure.align_ylabels()
    return figure


def _radius(axes: Axes, run: Run) -> None:
    values = drawn_radius(run.turn_radius)
    axes.plot(run.time, values, color=BLUE)
    axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    angle = run.scenario.sledge.edge_angle
    if angle != 0.0 and run.boots_by is None:
        carved = math.copysign(run.scenario.ski.sidecut_radius_of_three_widths * math.cos(angle), angle)
        axes.axhline(carved, color=GREY, linestyle=(0, (1, 1.2)), linewidth=0.9)
        axes.annotate(
            "sidecut radius × cos ϑ", (1.0, carved), (0, 2), xycoords=("axes fraction", "data"),
            textcoords="offset points", ha="right", va="bottom", fontsize=6.5, color=GREY,
        )  # fmt: skip
    axes.set_ylabel("turn radius (m)\nto the left +")


def drawn_radius(radius: FloatArray) -> FloatArray:
    """The radii with gaps where the path is nearly straight: more than three times the median."""
    known = np.abs(radius[np.isfinite(radius)])
    if not known.size:
        return np.full_like(radius, np.nan)
    return np.where(np.abs(radius) <= _TIMES_MEDIAN * float(np.median(known)), radius, np.nan)
