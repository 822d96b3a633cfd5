"""Several runs side by side: tracks, distance between them, depth along the more heavily loaded ski."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D

from ..._support.units import MM
from ...scenario import Plane
from ...track.nearest_place import distance_beside
from ...track.polyline import arc_lengths
from ..symbols import figure_text
from .run_track import plan_axes, plan_height_mm, track_limits
from .style import COLOURS, DOUBLE_MM, GREY, PALE, legend_below, new_figure

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]
_SYMBOL: Final = re.compile(r"(?<!\w)([A-Za-z])_([A-Za-z0-9])(?!\w)")
LINE_STYLES: Final = ("-", (0, (5, 1.5)), (0, (1, 1)), "-.", (0, (7, 2, 1, 2, 1, 2)))


def runs_compared(runs: Mapping[str, Run], *, at: float | None = None) -> Figure:
    """Draw the runs by their names; the first is the one that the others are held against.

    Parameters
    ----------
    runs
        One at least, on one slope.
    at
        Time (s) at which the skis are drawn; None: the latest that all runs reached, less a tenth of it.
    """
    named = list(runs.items())
    limits = track_limits(np.concatenate([run.place for run in runs.values()]))
    height = plan_height_mm(limits)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height + 90.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(height + 10.0, 62.0))
    plan = figure.add_subplot(grid[0, :])
    for place, (_, run) in enumerate(named):
        plan.plot(run.place[:, 0], run.place[:, 1], **_line_style(place))
        plan.plot(*run.place[-1, :2], marker="s", markersize=3.0, linestyle="none", color=_line_style(place)["color"])
    plan_axes(plan, limits, profile=not isinstance(named[0][1].scenario.slope, Plane))
    _distances(figure.add_subplot(grid[1, 0]), named)
    moment = 0.9 * min(run.simulated_s for run in runs.values()) if at is None else at
    _depths(figure.add_subplot(grid[1, 1]), named, moment)
    legend_below(
        figure, [Line2D([], [], label=mathtext(name), **_line_style(place)) for place, (name, _) in enumerate(named)]
    )
    return figure


def mathtext(name: str) -> str:
    """A run's name for a figure, with its symbols set.

    >>> mathtext("hypoplastic, k_u / H_V = 10")
    'hypoplastic, $k_u$ / $H_V$ = 10'
    """
    return _SYMBOL.sub(r"$\1_\2$", figure_text(name, longest=60))


def _line_style(place: int) -> dict[str, Any]:
    return {"color": COLOURS[place % len(COLOURS)], "linestyle": LINE_STYLES[place % len(LINE_STYLES)]}


def _distances(axes: Axes, named: list[tuple[str, Run]]) -> None:
    (first, reference), *others = named
    for place, (_, run) in enumerate(others, start=1):
        axes.plot(arc_lengths(run.place), distance_beside(run.place, reference.place), **_line_style(place))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("distance travelled (m)")
    axes.set_ylabel(f"distance (m) from the track of\n{mathtext(first)}")


def _depths(axes: Axes, named: list[tuple[str, Run]], moment: float) -> None:
    """The more heavily loaded ski in the first run, in all runs at one time."""
    reference = named[0][1]
    ski = loaded_ski(reference, moment)
    for place, (_, run) in enumerate(named):
        now = int(np.argmin(abs(run.time - moment)))
        axes.plot(run.skis.station, run.skis.edge_depth[now, ski] / MM, **_line_style(place))
    deepest = max(float(np.nanmax(run.skis.edge_depth[_at(run, moment), ski])) for _, run in named) / MM
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
    axes.axvline(0.0, color=PALE, linewidth=0.5, zorder=0)
    axes.set_ylim(1.15 * max(deepest, 0.1), -0.35 * max(deepest, 0.1))
    axes.set_xlabel("position along the ski (m); boot = 0, tail left, tip right")
    axes.set_ylabel(f"edge depth (mm), {('left', 'right')[ski]} ski,\nat {moment:.2f} s")


def _at(run: Run, moment: float) -> int:
    return int(np.argmin(abs(run.time - moment)))


def loaded_ski(run: Run, moment: float) -> int:
    """The ski with the larger total force at a time (s): 0 left, 1 right."""
    return int(np.argmax(run.skis.total_force[_at(run, moment)]))
