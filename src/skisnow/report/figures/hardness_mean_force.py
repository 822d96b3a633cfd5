"""Snow hardness against the mean force of a SnowMicroPen at the same place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...estimate.observations import PEN_FORCE_KEY
from ..number_formatting import p_equals
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import error_bars, legend_below, logarithmic, mark_synthetic, new_figure, scatter, spans_a_decade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "hardness_mean_force"


def hardness_mean_force(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """H_V with intervals; no line, the table has the regression."""
    force = data.observations["penetration"].columns[PEN_FORCE_KEY]
    known = np.isfinite(force)
    if not known.any():
        reason = "no used recording is at the site of a used penetration experiment"
        return LeftOut(NAME, "Snow hardness against the SnowMicroPen's mean force", reason)
    force, hardness = force[known], data.hardness[known]
    ends, site = data.hardness_interval[known], data.penetration_site[known]
    figure = new_figure(height_mm=80.0)
    axes = figure.add_subplot()
    error_bars(axes, force, ends, site, styles)
    handles = scatter(axes, force, hardness, site, styles)
    if spans_a_decade(hardness):
        logarithmic(axes, "y", np.concatenate((hardness, ends[np.isfinite(ends)])))
    if spans_a_decade(force):
        logarithmic(axes, "x", force)
    axes.set_xlabel("mean force of the SnowMicroPen (N)")
    axes.set_ylabel(r"snow hardness $H_\mathrm{V}$ (N/mm³)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    row = data.regression("H_V_N_per_mm3", PEN_FORCE_KEY)
    settings = data.results["snow_micro_pen"]
    caption = prose(
        "Snow hardness H_V against the mean force of the SnowMicroPen, {first} to {last} mm below the surface, at the "
        "same spot or else site, with the 95 % interval of each experiment.{found}",
        first=f"{settings['from_depth_mm']:g}",
        last=f"{settings['to_depth_mm']:g}",
        found=f" Linear regression over all: {p_equals(row['p'])}." if row and row["p"] is not None else "",
    )
    alt = "Snow hardness against the SnowMicroPen's mean force with intervals, by site."
    return Drawing(NAME, caption, alt, figure, points=len(hardness))
