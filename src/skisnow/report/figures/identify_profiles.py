"""How the sum of squares rises along each parameter with all others refitted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .style import BLACK, BLUE, DOUBLE_MM, GREY, ORANGE, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ...identification.result import Identification


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
