"""Figures of an identification: measurements, fits and residuals, and profiles of parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import numpy.typing as npt
from matplotlib.lines import Line2D

from ..figures.style import BLACK, BLUE, COLOURS, DOUBLE_MM, GREY, ORANGE, PALE, legend_below, new_figure
from ..symbols import figure_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ...identification.problem import Fit
    from ...identification.result import Identification

FloatArray = npt.NDArray[np.float64]
_MARKERS: Final = ("o", "^", "s", "D", "v", "P", "X")
_LARGEST_MM, _SMALLEST_MM = 120.0, 55.0
_MOST_RUNS: Final = 7


def tracks_above(fits: Sequence[Fit]) -> Figure:
    """Measured points and identified lines from above, the same scale along both axes."""
    places = np.vstack([fit.measured[:, :2] for fit in fits])
    x, y = np.ptp(places[:, 0]) + 2.0, np.ptp(places[:, 1]) + 2.0
    height = float(np.clip((DOUBLE_MM - 25.0) * y / x + 25.0, _SMALLEST_MM, _LARGEST_MM))
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height)
    axes = figure.subplots()
    handles: list[Line2D] = []
    for number, fit in enumerate(fits[:_MOST_RUNS]):
        colour = COLOURS[number % len(COLOURS)]
        axes.plot(fit.fitted[:, 0], fit.fitted[:, 1], color=colour, zorder=3)
        marker = _MARKERS[number % len(_MARKERS)]
        points = axes.plot(
            fit.measured[:, 0],
            fit.measured[:, 1],
            linestyle="none",
            marker=marker,
            markerfacecolor="none",
            markersize=3.0,
            color=BLACK,
            zorder=2,
            label=f"{figure_text(fit.name)}, measured",
        )
        handles += [*points, Line2D([], [], color=colour, label=f"{figure_text(fit.name)}, identified")]
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x, down the fall line (m)")
    axes.set_ylabel("y, to the left (m)")
    legend_below(figure, handles)
    return figure


def residuals_along(fits: Sequence[Fit]) -> Figure:
    """Measured minus identified for each quantity; the band is twice the standard deviation."""
    labels = [label for i, label in enumerate(fits[0].labels) if any(_known(fit, i).any() for fit in fits)]
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=30.0 + 34.0 * len(labels))
    rows = figure.subplots(len(labels), 1, sharex=True, squeeze=False)[:, 0]
    handles = []
    for number, fit in enumerate(fits[:_MOST_RUNS]):
        colour, marker = COLOURS[number % len(COLOURS)], _MARKERS[number % len(_MARKERS)]
        for axes, label in zip(rows, labels, strict=True):
            _residual(axes, fit, fit.labels.index(label), colour, marker)
        handles.append(Line2D([], [], color=colour, marker=marker, markerfacecolor="none", label=figure_text(fit.name)))
    for axes, label in zip(rows, labels, strict=True):
        axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
        axes.set_ylabel(f"{label.replace(' (', chr(10) + 'measured − identified (')}")
    rows[-1].set_xlabel(
        {"track": "time (s)", "photo_cells": "distance from the start (m)", "marks": "place"}[fits[0].kind]
    )
    figure.align_ylabels()
    legend_below(figure, handles)
    return figure


def _known(fit: Fit, i: int) -> npt.NDArray[np.bool_]:
    return np.isfinite(fit.measured[:, i]) & np.isfinite(fit.sd[:, i])


def _residual(axes: Axes, fit: Fit, i: int, colour: str, marker: str) -> None:
    use = _known(fit, i)
    if not use.any():
        return
    along, residual, sd = fit.along[use], fit.residual[use, i], fit.sd[use, i]
    axes.fill_between(along, -2.0 * sd, 2.0 * sd, color=PALE, alpha=0.35, linewidth=0.0, zorder=0)
    axes.plot(along, residual, color=colour, marker=marker, markerfacecolor="none", linewidth=0.6, zorder=3)


def profiles_drawn(found: Identification) -> Figure:
    """One panel for each parameter: the profile, what the curvature foretells, the limit of the 95 % interval."""
    from matplotlib.lines import Line2D

    columns = min(3, len(found.profiles))
    rows = -(-len(found.profiles) // columns)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=20.0 + 50.0 * rows)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, profile in zip(panels, found.profiles, strict=False):
        each = found[profile.key]
        known = np.isfinite(profile.rise)
        axes.plot(profile.value[known], profile.rise[known], color=BLUE, marker="o", markerfacecolor="none")
        if each.value is not None and each.standard_error:
            at = np.linspace(profile.value[0], profile.value[-1], 101)
            curve = ((at - each.value) / each.standard_error) ** 2
            axes.plot(at, curve, color=ORANGE, linestyle=(0, (4, 2)))
        axes.axhline(profile.limit, color=GREY, linewidth=0.8, linestyle=(0, (1, 1.2)))
        unit = f" ({each.parameter.unit})" if each.parameter.unit else ""
        axes.set_xlabel(f"{each.parameter.name.replace('_', ' ')}{unit}")
        axes.set_ylim(-0.5, 3.0 * profile.limit)
    for axes in panels[len(found.profiles) :]:
        axes.set_visible(False)
    panels[0].set_ylabel("rise of the sum of squares")
    handles = [
        Line2D([], [], color=BLUE, marker="o", markerfacecolor="none", label="others refitted"),
        Line2D([], [], color=ORANGE, linestyle=(0, (4, 2)), label="from the curvature"),
        Line2D([], [], color=GREY, linestyle=(0, (1, 1.2)), label="limit of the 95 % interval"),
    ]
    legend_below(figure, handles)
    for axes in panels:
        axes.tick_params(colors=BLACK)
    return figure
