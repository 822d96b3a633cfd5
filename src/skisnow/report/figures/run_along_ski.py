"""Depth of the edge and normal force per length along both skis over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt

from ..._support.units import MM
from .style import BLACK, DOUBLE_MM, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import QuadMesh
    from matplotlib.figure import Figure

    from ...simulation.run import Run

FloatArray = npt.NDArray[np.float64]
SKIS: Final = ("left ski", "right ski")
_SHARE_SHOWN: Final = 99.5
"""Percentile of the forces at which the colours end: single peaks would leave the rest dark."""


def run_along_ski(run: Run) -> Figure:
    """Draw four maps with the tip at the top; white: the edge is above the snow, or the snow does not press."""
    depth, force = run.skis.edge_depth / MM, run.skis.force_per_length
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=112.0)
    grid = figure.subplots(2, 2, sharex=True, sharey=True)
    for row, (values, label) in zip(
        grid, ((depth, "edge depth (mm)"), (force, "normal force per length (N/m)")), strict=True
    ):
        top = highest(values)
        for ski, axes in enumerate(row):
            mesh = along_ski_map(axes, run, np.where(values[:, ski] > 0.0, values[:, ski], np.nan), top)
        figure.colorbar(
            mesh, ax=list(row), label=label, pad=0.01, aspect=20, extend="max" if top < values.max() else "neither"
        )
    label_maps(grid)
    return figure


def highest(values: FloatArray) -> float:
    """Where the colours of a map end."""
    positive = values[values > 0.0]
    return float(np.percentile(positive, _SHARE_SHOWN)) if positive.size else 1.0


def along_ski_map(axes: Axes, run: Run, values: FloatArray, top: float) -> QuadMesh:
    """One map: values (n, m) over time and station, time to the right and the tip up."""
    mesh = axes.pcolormesh(
        run.time, run.skis.station, np.ma.masked_invalid(values.T), shading="nearest", cmap="cividis", vmin=0.0,
        vmax=top, rasterized=True,
    )  # fmt: skip
    axes.axhline(0.0, color=BLACK, linewidth=0.5, linestyle=(0, (4, 3)))
    axes.set_ylim(float(run.skis.station.min()), float(run.skis.station.max()))
    return mesh


def label_maps(grid: npt.NDArray[np.object_]) -> None:
    """Names of the skis above, time below, station at the left."""
    for ski, axes in enumerate(grid[0]):
        axes.set_title(SKIS[ski], loc="left", fontsize=8.0)
    for axes in grid[-1]:
        axes.set_xlabel("time (s)")
    for axes in grid[:, 0]:
        axes.set_ylabel("position along the ski (m);\nboot = 0, tip up")
