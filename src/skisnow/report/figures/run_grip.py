"""How much of the snow's shear strength the skis use, along them and over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D

from .run_along_ski import SKIS, along_ski_map, label_maps
from .run_track import SKI_COLOURS
from .style import DOUBLE_MM, GREY, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...simulate.run import Run

FloatArray = npt.NDArray[np.float64]


def run_grip(run: Run) -> Figure:
    """Draw the share S/(S_f e) along each ski, and that of each whole ski; 1: the snow yields."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=112.0)
    grid = figure.add_gridspec(2, 2)
    maps = [figure.add_subplot(grid[0, 0])]
    maps.append(figure.add_subplot(grid[0, 1], sharex=maps[0], sharey=maps[0]))
    share = used_share(run)
    for ski, axes in enumerate(maps):
        mesh = along_ski_map(axes, run, share[:, ski], 1.0)
    figure.colorbar(mesh, ax=maps, label="grip utilisation", pad=0.01, aspect=20)
    label_maps(np.array([maps]))
    below = figure.add_subplot(grid[1, :], sharex=maps[0])
    for ski, colour in enumerate(SKI_COLOURS):
        below.plot(run.time, used_share_of_skis(run)[:, ski], color=colour)
    below.axhline(1.0, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)))
    below.set_ylim(-0.02, 1.12)
    below.set_ylabel("grip utilisation of\nthe ski (1: side-slip)")
    below.set_xlabel("time (s)")
    legend_below(
        figure, [Line2D([], [], color=colour, label=name) for colour, name in zip(SKI_COLOURS, SKIS, strict=True)]
    )
    return figure


def used_share(run: Run) -> FloatArray:
    """|shear per length| / (S_f e), (n, 2, m); nan where the edge is above the snow."""
    limit = _limit(run)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(limit > 0.0, np.abs(run.skis.shear_per_length) / limit, np.nan)


def used_share_of_skis(run: Run) -> FloatArray:
    """|∫ shear ds| / (S_f ∫ e ds) of each ski, (n, 2); nan where a ski is off the snow."""
    station = run.skis.station
    force = np.abs(np.trapezoid(run.skis.shear_per_length, -station, axis=2))
    limit = np.trapezoid(_limit(run), -station, axis=2)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(limit > 0.0, force / limit, np.nan)


def _limit(run: Run) -> FloatArray:
    """S_f e (N/m), 0 above the snow."""
    strength = run.scenario.contact.snow.failure_shear_stress
    assert strength is not None  # a scenario has it
    return np.asarray(strength * np.maximum(run.skis.edge_depth, 0.0))
