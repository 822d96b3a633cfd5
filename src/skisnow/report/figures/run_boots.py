"""Edge angles of boots that are moved, and what each ski does to its boot, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..._support.units import DEGREE
from .run_balance import draw_both
from .run_course import edge_angles_of_skis
from .style import DOUBLE_MM, PALE, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...simulation.run import Run


def run_boots(run: Run) -> Figure:
    """Draw four panels over one time axis; for runs with boots that something moves."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=150.0)
    panels = figure.subplots(4, 1, sharex=True)
    boots = run.boots
    assert boots is not None
    ahead, left, up = range(3)
    drawn = (
        (edge_angles_of_skis(run) / DEGREE, "edge angle (°)\nto the left +"),
        (boots.own_force[:, :, up], "force off\nthe base (N)"),
        (boots.own_force[:, :, left], "force across (N)\nto the left +"),
        (boots.own_moment[:, :, ahead], "edging moment\n(N m)"),
    )
    for axes, (values, label) in zip(panels, drawn, strict=True):
        draw_both(axes, run, values)
        axes.set_ylabel(label)
        axes.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
    panels[0].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, borderaxespad=0.2, frameon=False)
    panels[-1].set_xlabel("time (s)")
    panels[-1].set_xlim(float(run.time[0]), float(run.time[-1]))
    figure.align_ylabels()
    return figure
