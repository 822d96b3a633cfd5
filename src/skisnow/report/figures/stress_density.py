"""Fig 10 of the paper: failure shear stress against density."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..number_formatting import interval, p_equals, significant
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .regression_line import draw_line, regression_line
from .stress_angle import SIGNIFICANT
from .style import BLACK, legend_below, mark_synthetic, new_figure, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import Json, ReportData
    from .style import SiteStyle

NAME: Final = "fig10_stress_density"


def stress_density(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Points by site, the pooled line with its band, dashed where the slope is not significant."""
    what = "Failure shear stress against density"
    if len(data.stress) == 0:
        return LeftOut(NAME, what, "no shear experiment is used")
    known = np.isfinite(data.shear_density)
    if not known.any():
        return LeftOut(NAME, what, "the campaign gives no snow density at its shear experiments")
    density, stress, site = data.shear_density[known], data.stress[known], data.shear_site[known]
    figure = new_figure(height_mm=76.0)
    axes = figure.add_subplot()
    handles = scatter(axes, density, stress, site, styles)
    row = data.regression("S_f_N_per_mm2", "snow_density_kg_per_m3")
    if row is not None:
        dashed = row["p"] is None or row["p"] >= SIGNIFICANT
        draw_line(axes, regression_line(row, density), colour=BLACK, dashed=dashed)
    axes.set_ylim(0.0, float(stress.max()) * 1.08 or 1.0)
    axes.set_xlabel(r"snow density $\rho$ (kg/m³)")
    axes.set_ylabel(r"failure shear stress $S_\mathrm{f}$ (N/mm²)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    caption = prose(
        "Failure shear stress S_f against density (the paper's Fig. 10), by site.{line}", line=_line(row) if row else ""
    )
    return Drawing(
        NAME,
        caption,
        "Failure shear stress against snow density with a regression line, by site.",
        figure,
        points=len(stress),
    )


def _judged(row: Json) -> str:
    if row["withheld"]:
        return "dashed because too few different densities allow no judgement"
    p = p_equals(row["p"])
    return f"{p}, dashed because not significant" if row["p"] is None or row["p"] >= SIGNIFICANT else p


def _line(row: Json) -> str:
    text = (
        f" Line: {significant(row['b'][0])} {'−' if row['b'][1] < 0 else '+'} {significant(abs(row['b'][1]))} ρ, "
        f"n = {row['n']}, {_judged(row)}; band: 95 % "
        "interval of its mean, as if all experiments were independent."
    )
    if row["interval_by_site"] and row["interval_by_site"][1]:
        text += f" With sites as clusters the slope's interval is {interval(row['interval_by_site'][1])}."
    return text
