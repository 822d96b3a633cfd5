"""Share of the snow's shear strength that each whole ski uses, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D

from .run_along_ski import SKIS
from .run_track import SKI_COLOURS
from .style import DOUBLE_MM, GREY, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]


def run_grip(run: Run) -> Figure:
    """Draw the grip utilisation of each whole ski over time; 1: side-slip."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=62.0)
    axes = figure.subplots()
    for share, colour, name in zip(used_share_of_skis(run).T, SKI_COLOURS, SKIS, strict=True):
        axes.plot(run.time, share, color=colour, label=name)
    axes.axhline(1.0, color=GREY, linewidth=0.8, linestyle=(0, (4, 2)))
    axes.set_xlim(float(run.time[0]), float(run.time[-1]))
    axes.set_ylim(-0.02, 1.12)
    axes.set_ylabel("grip utilisation of\nthe ski (1: side-slip)")
    axes.set_xlabel("time (s)")
    legend_below(
        figure, [Line2D([], [], color=colour, label=name) for colour, name in zip(SKI_COLOURS, SKIS, strict=True)]
    )
    return figure


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
