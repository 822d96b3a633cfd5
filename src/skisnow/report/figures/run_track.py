"""A run from above: the tracks of both skis, the groove that they left, time marks, the fall line."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ...simulate.scenario import Profile
from ...units import MM
from .style import BLACK, BLUE, DOUBLE_MM, GREY, VERMILLION, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...simulate.run import Run

FloatArray = npt.NDArray[np.float64]

SKI_COLOURS: Final = (BLUE, VERMILLION)
"""Of the left and the right ski."""
CUTOUT: Final = 2.0
"""Length (m) of track that is drawn a second time, large."""
_MARGIN: Final = 0.6
_LARGEST_MM, _SMALLEST_MM = 130.0, 32.0
_FRAME_MM: Final = 38.0
_SIDES_MM: Final = 38.0
"""What axis and colour bar take at the sides of the large piece."""
_MOST_MARKS: Final = 16
_LABEL_POINTS: Final = 12.0
"""How far to the left of the track a time stands."""


def run_track(run: Run) -> Figure:
    """Draw the whole run with equal scales, and below it a piece at half time with the groove in its true width."""
    limits = track_limits(run.skis.track.reshape(-1, 3))
    height, reach = plan_height_mm(limits), _reach(run)
    detail_height = (DOUBLE_MM - _SIDES_MM) * 2.0 * reach / CUTOUT
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height + detail_height + _FRAME_MM)
    above, detail = figure.subplots(2, 1, height_ratios=(height, detail_height))
    draw_plan(above, run, limits)
    _groove_detail(figure, detail, run)
    handles = [Line2D([], [], color=c, label=f"{s} ski") for c, s in zip(SKI_COLOURS, ("left", "right"), strict=True)]
    handles.append(
        Line2D([], [], linestyle="none", marker="o", markersize=3.0, color=BLACK, label="each second; square: end")
    )
    legend_below(figure, handles)
    return figure


def track_limits(points: FloatArray) -> tuple[float, float, float, float]:
    """Least and greatest x, and y, of points (n, 2 or more) with a margin (m)."""
    low, high = np.nanmin(points[:, :2], axis=0) - _MARGIN, np.nanmax(points[:, :2], axis=0) + _MARGIN
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def plan_height_mm(limits: tuple[float, float, float, float]) -> float:
    """Height that a plan as wide as the figure needs, within reason."""
    x_low, x_high, y_low, y_high = limits
    return float(np.clip((y_high - y_low) / (x_high - x_low) * (DOUBLE_MM - 22.0), _SMALLEST_MM, _LARGEST_MM))


def plan_axes(axes: Axes, limits: tuple[float, float, float, float], *, profile: bool = False) -> None:
    """Equal scales, x to the right and y up, as seen from above, with an arrow down the fall line."""
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(limits[0], limits[1])
    axes.set_ylim(limits[2], limits[3])
    axes.set_xlabel("horizontal distance $x$ (m)" if profile else "distance down the fall line $x$ (m)")
    axes.set_ylabel("to the left $y$ (m)")
    axes.yaxis.set_major_locator(MaxNLocator("auto", steps=[1, 2, 5, 10], min_n_ticks=2))
    axes.annotate(
        "", (0.13, 1.035), (0.0, 1.035), xycoords="axes fraction",
        arrowprops={"arrowstyle": "-|>", "color": GREY, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip
    axes.annotate("fall line", (0.14, 1.035), xycoords="axes fraction", va="center", fontsize=7.0, color=GREY)


def draw_plan(axes: Axes, run: Run, limits: tuple[float, float, float, float]) -> None:
    """Tracks of both skis, a mark each second, start and end."""
    for ski, colour in enumerate(SKI_COLOURS):
        axes.plot(run.skis.track[:, ski, 0], run.skis.track[:, ski, 1], color=colour, linewidth=0.9)
    _time_marks(axes, run)
    plan_axes(axes, limits, profile=isinstance(run.scenario.slope, Profile))


def _time_marks(axes: Axes, run: Run) -> None:
    every = max(1, math.ceil(run.simulated_s / _MOST_MARKS))
    marks = np.arange(0.0, run.simulated_s + 1e-9, every)
    x, y = (np.interp(marks, run.time, run.place[:, k]) for k in (0, 1))
    axes.plot(x, y, linestyle="none", marker="o", markersize=2.6, color=BLACK, zorder=4)
    aside = np.interp(marks, run.time, np.unwrap(run.heading))
    for mark, at_x, at_y, angle in zip(marks, x, y, aside, strict=True):
        offset = (-_LABEL_POINTS * math.sin(angle), _LABEL_POINTS * math.cos(angle))
        axes.annotate(
            "start" if mark == 0.0 else f"{mark:g} s", (float(at_x), float(at_y)), offset, textcoords="offset points",
            ha="center", va="center", fontsize=6.5,
        )  # fmt: skip
    axes.plot(*run.place[-1, :2], linestyle="none", marker="s", markersize=3.4, color=BLACK, zorder=4)
    ended = f"{run.outcome.replace('_', ' ')} at {run.simulated_s:.2f} s"
    axes.annotate(ended, (1.0, 1.035), xycoords="axes fraction", ha="right", va="center", fontsize=7.0)


def _groove_detail(figure: Figure, axes: Axes, run: Run) -> None:
    """The groove over a short way, in its true width, coloured by the depth that stays."""
    middle = len(run.time) // 2
    centre, heading = run.place[middle, :2], run.heading[middle]
    ahead = np.array([math.cos(heading), math.sin(heading)])
    aside = np.array([-ahead[1], ahead[0]])
    turned = np.stack([ahead, aside], axis=1)
    half = CUTOUT / 2.0
    tracks = (run.skis.track[..., :2] - centre) @ turned
    pieces = (run.groove.middle[:, :2] - centre) @ turned
    near = (abs(pieces[:, 0]) < 1.05 * half) & (abs(pieces[:, 1]) < half)
    if near.any():
        corners = (groove_corners(run)[near] - centre) @ turned
        drawn = PolyCollection(list(corners), array=run.groove.residual_depth[near] / MM, cmap="cividis_r", linewidth=0)
        drawn.set_clim(0.0, max(float(run.groove.residual_depth[near].max()) / MM, 1e-9))
        drawn.set_rasterized(True)
        axes.add_collection(drawn)
        figure.colorbar(drawn, ax=axes, label="depth of the groove\nthat stays (mm)", pad=0.01, aspect=12)
    for ski, colour in enumerate(SKI_COLOURS):
        axes.plot(tracks[:, ski, 0], tracks[:, ski, 1], color=colour, linewidth=0.8)
    axes.set_aspect("equal", adjustable="box")
    reach = _reach(run)
    axes.set_xlim(-half, half)
    axes.set_ylim(-reach, reach)
    axes.set_xlabel(f"ahead of the place at {run.time[middle]:.2f} s (m); grooves in their true width")
    axes.set_ylabel("to the left (m)")


def _reach(run: Run) -> float:
    """Half the height (m) of the piece that is drawn large: both tracks with some snow beside them."""
    return 0.12 + run.scenario.sledge.stance_width / 2.0


def groove_corners(run: Run) -> FloatArray:
    """Corners (k, 4, 2) of the groove's pieces from above: their width across, the lines' spacing along."""
    groove = run.groove
    left = groove.left[:, :2]
    ahead = np.stack([left[:, 1], -left[:, 0]], axis=1)
    aside = 0.5 * groove.width[:, None] * left
    along = 0.5 * run.numbers.get("line_spacing_m", 0.02) * ahead
    middle = groove.middle[:, :2]
    return np.stack(
        [middle + aside - along, middle + aside + along, middle - aside + along, middle - aside - along], axis=1
    )
