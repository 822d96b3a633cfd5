"""Figure of the SnowMicroPen recordings: force, density and specific surface area over the depth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.lines import Line2D

from ..._support.messages import Message
from ..._support.units import MM
from ...estimation.snow_micro_pen import depth_profile
from ..figures.drawing import Drawing, LeftOut
from ..figures.style import COLOURS, legend_below, logarithmic, mark_synthetic, new_figure, spans_a_decade
from ..symbols import figure_text, prose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...estimation.snow_micro_pen import DepthProfile
    from ..figures.style import SiteStyle
    from .data import ReportData

MOST_DRAWN: Final = 24
"""Recordings that stay legible in one figure; the first ones are drawn."""
_PANELS: Final = (
    ("force", Message("force (N)")),
    ("snow_density", Message("density (kg/m³)")),
    ("specific_surface_area", Message("specific surface area (m²/kg)")),
)


def snow_profiles(data: ReportData, _styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Force, density and surface area of each used recording against the depth below the snow surface."""
    name, pen = "snow_profiles", data.analysis.snow_micro_pen
    usable = [] if pen is None else [i for i, each in enumerate(pen.evaluated) if each.is_used]
    if pen is None or not usable:
        return LeftOut(name, "Profiles of the SnowMicroPen", Message("no recording is used"))
    recordings, drawn = pen.recordings, usable[:MOST_DRAWN]
    sites = sorted({recordings.site[index] for index in drawn})
    colours = {site: COLOURS[place % len(COLOURS)] for place, site in enumerate(sites)}
    found = [
        (colours[recordings.site[index]],
         depth_profile(recordings.profile(index), recordings.settings, pen.evaluated[index].surface))
        for index in drawn
    ]  # fmt: skip
    panels = [(key, label) for key, label in _PANELS if any(np.isfinite(getattr(each, key)).any() for _, each in found)]
    figure = new_figure(width_mm=60.0 * len(panels), height_mm=100.0)
    every = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, (key, label) in zip(every, panels, strict=True):
        for colour, profile in found:
            axes.plot(_shown(profile, key), profile.depth / MM, color=colour, linewidth=0.6, alpha=0.8)
        axes.set_xlabel(label)
    forces = np.concatenate([each.force for _, each in found])
    if spans_a_decade(forces):
        logarithmic(every[0], "x", forces)
    every[0].set_ylabel(Message("depth below the snow surface (mm)"))
    every[0].set_ylim(max(float(each.depth.max()) for _, each in found) / MM, 0.0)
    legend_below(figure, [Line2D([], [], color=colours[site], label=figure_text(site)) for site in sites])
    mark_synthetic(data, every[-1])
    caption = prose(
        "SnowMicroPen: force, density and specific surface area over the depth below the snow surface, by site, in "
        "overlapping windows. Density and surface area by {relation}, which was fitted to ungroomed snow.",
        relation=recordings.settings.relation,
    )
    alt = Message("Force, density and specific surface area against depth, one line for each recording.")
    return Drawing(name, caption, alt, figure, wide=len(panels) > 1)


def _shown(profile: DepthProfile, key: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Values of a panel; a force in the noise of the air has no place on a logarithmic axis."""
    values = getattr(profile, key)
    return np.where(values > 0.0, values, np.nan)
