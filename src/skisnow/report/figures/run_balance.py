"""Lean, edge angle and forces of a skier over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..._support.units import DEGREE
from .style import BLUE, DOUBLE_MM, GREY, ORANGE, PALE, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...simulation.run import Run


def run_balance(run: Run) -> Figure:
    """Draw four panels over one time axis: leans; total, normal and side force of the snow on each ski."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=156.0)
    leans, totals, normals, sides = figure.subplots(4, 1, sharex=True)
    balance, boots = run.balance, run.boots
    assert boots is not None
    edge = balance.lean + balance.angulation
    leans.plot(run.time, edge / DEGREE, color=ORANGE, label="edge angle")
    leans.plot(run.time, balance.lean / DEGREE, color=BLUE, label="lean")
    leans.plot(run.time, balance.balanced_lean / DEGREE, color=GREY, linewidth=0.8, linestyle=(0, (2, 1)),
               label="lean in balance")  # fmt: skip
    most = 1.15 * float(np.nanmax(np.abs(np.concatenate([edge, balance.lean])))) / DEGREE
    leans.set_ylim(-max(most, 1.0), max(most, 1.0))
    leans.set_ylabel("lean, edge angle (°)\nto the left +")
    left = np.cross(np.array([0.0, 0.0, 1.0]), boots.axes[:, :, 0])
    draw_both(totals, run, run.skis.total_force)
    totals.set_ylabel("total\nforce (N)")
    draw_both(normals, run, run.skis.normal_force)
    normals.set_ylabel("normal\nforce (N)")
    draw_both(sides, run, np.einsum("nka,nka->nk", run.skis.force, left))
    sides.set_ylabel("side force (N)\nto the left +")
    for axes in (leans, totals, normals, sides):
        axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    for axes in (leans, totals):
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.2, frameon=False)
    sides.set_xlabel("time (s)")
    sides.set_xlim(float(run.time[0]), float(run.time[-1]))
    figure.align_ylabels()
    return figure


def draw_both(axes: Axes, run: Run, values: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> None:
    """Both skis; the axis holds all but the last hundredth of peaks."""
    for ski, (name, colour) in enumerate((("left ski", BLUE), ("right ski", ORANGE))):
        hidden = ski == 0 and np.allclose(values[:, 0], values[:, 1])
        axes.plot(run.time, values[:, ski], color=colour, linewidth=2.4 if hidden else 0.8, label=name)
    low, high = np.quantile(values, [0.005, 0.995])
    room = 0.25 * max(high - low, 1.0)
    axes.set_ylim(low - 0.3 * room, high + room)
