"""Fig 6 of the paper: snow hardness against density."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..number_formatting import p_equals
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import error_bars, legend_below, logarithmic, mark_synthetic, new_figure, scatter, spans_a_decade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "fig06_hardness_density"


def hardness_density(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """H_V with intervals; no line, the table has the regression."""
    what = "Snow hardness against density"
    if len(data.hardness) == 0:
        return LeftOut(NAME, what, "no penetration experiment is used")
    known = np.isfinite(data.penetration_density)
    if not known.any():
        return LeftOut(NAME, what, "the campaign gives no snow density at its penetration experiments")
    density, hardness = data.penetration_density[known], data.hardness[known]
    ends, site = data.hardness_interval[known], data.penetration_site[known]
    figure = new_figure(height_mm=80.0)
    axes = figure.add_subplot()
    error_bars(axes, density, ends, site, styles)
    handles = scatter(axes, density, hardness, site, styles)
    if spans_a_decade(hardness):
        logarithmic(axes, "y", np.concatenate((hardness, ends[np.isfinite(ends)])))
    axes.set_xlabel(r"snow density $\rho$ (kg/m³)")
    axes.set_ylabel(r"snow hardness $H_\mathrm{V}$ (N/mm³)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    row = data.regression("H_V_N_per_mm3", "snow_density_kg_per_m3")
    caption = prose(
        "Snow hardness H_V against density (the paper's Fig. 6) with the 95 % interval of each experiment.{found}",
        found=f" Linear regression over all: {p_equals(row['p'])}." if row and row["p"] is not None else "",
    )
    return Drawing(
        NAME, caption, "Snow hardness against snow density with intervals, by site.", figure, points=len(hardness)
    )
