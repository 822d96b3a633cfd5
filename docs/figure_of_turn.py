"""Draw the first picture of a turn, for the README and the start page: python docs/figure_of_turn.py."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from fewer_colours import write_fewer_colours
from matplotlib.lines import Line2D

from skisnow import load_scenario, simulate
from skisnow.report.figures.drawing import write_figure
from skisnow.report.figures.style import DOUBLE_MM, GREY, legend_below, new_figure
from skisnow.report.run.time_figures import along_ski_map, highest
from skisnow.report.run.track_figure import SKI_COLOURS, draw_plan, track_limits

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skisnow.simulation.run import Run

PICTURE = Path(__file__).resolve().parent / "_static" / "carved-turn.png"
SCENARIO = "carved-46m"
MOMENT = 3.0
"""Time (s) at which the ski is drawn."""
OUTER = 1
"""The more heavily loaded (outer) ski in a turn to the left: the right one."""


def turn(run: Run, elastic: Run) -> Figure:
    """Track from above; beside it the outer ski: its depth in both kinds of snow, and over time."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=92.0)
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.15))
    draw_plan(figure.add_subplot(grid[:, 0]), run, track_limits(run.skis.track.reshape(-1, 3)))
    _draw_along(figure.add_subplot(grid[0, 1]), run, elastic)
    _draw_depth(figure, figure.add_subplot(grid[1, 1]), run)
    names = ("left ski", "right ski")
    legend_below(figure, [Line2D([], [], color=c, label=name) for c, name in zip(SKI_COLOURS, names, strict=True)])
    return figure


def _draw_along(axes: Axes, run: Run, elastic: Run) -> None:
    """Depth of the edge along the outer ski when half of the turn is done."""
    for one, style, label in ((run, "-", "hypoplastic snow"), (elastic, (0, (5, 1.5)), "elastic snow")):
        now = int(np.argmin(abs(one.time - MOMENT)))
        depth = 1e3 * one.skis.edge_depth[now, OUTER]
        axes.plot(one.skis.station, depth, color=SKI_COLOURS[OUTER], linestyle=style, label=label)
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.set_ylim(1.1 * float(depth.max()) + 1.2, -0.5)
    axes.set_xlabel("position along the ski (m); boot = 0, tail left, tip right")
    axes.set_ylabel("edge depth\n(mm)")
    axes.set_title(f"right ski at {MOMENT:g} s", loc="left", fontsize=7.5)
    axes.legend(loc="lower right", ncols=2)


def _draw_depth(figure: Figure, axes: Axes, run: Run) -> None:
    depth = 1e3 * run.skis.edge_depth[:, OUTER]
    mesh = along_ski_map(axes, run, np.where(depth > 0.0, depth, np.nan), highest(depth))
    axes.set_xlabel("time (s)")
    axes.set_ylabel("position along the\nski (m), boot = 0")
    axes.set_title("right ski over time, hypoplastic snow", loc="left", fontsize=7.5)
    figure.colorbar(mesh, ax=axes, label="edge depth\n(mm)", pad=0.01, aspect=12)


def main() -> None:
    """Simulate and draw."""
    run, elastic = (
        simulate(load_scenario(SCENARIO, changes={"snow.penetration": kind})) for kind in ("hypoplastic", "elastic")
    )
    write_figure(PICTURE, lambda: turn(run, elastic))
    write_fewer_colours(PICTURE, colours=128)


if __name__ == "__main__":
    main()
