"""Fig 8 of the paper: failure shear stress against edge angle where the angle was varied."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...units import DEGREE
from ..number_formatting import p_equals
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .regression_line import draw_line, regression_line
from .style import error_bars, legend_below, mark_synthetic, masks, new_figure, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import FloatArray, Json, ReportData
    from .style import SiteStyle

NAME: Final = "fig08_stress_angle"
SIGNIFICANT: Final = 0.05
MOST_SENTENCES: Final = 6


def varied_sites(data: ReportData) -> list[Json]:
    """The regressions of S_f on edge angle of single sites."""
    return [
        row
        for row in data.results["regressions"]
        if row["terms"][1] == "edge_angle_rad" and row["group"] != "all" and row["b"] is not None
    ]


def shear_angles_deg(data: ReportData) -> FloatArray:
    """Edge angle of each used shear experiment (degrees)."""
    return data.shear_angle / DEGREE


def stress_angle(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Points of the sites with varied angle; line and band only where the slope is significant."""
    rows = varied_sites(data)
    if not rows:
        reason = "no site has five used shear experiments at three edge angles"
        return LeftOut(NAME, "Failure shear stress against edge angle", reason)
    chosen = np.isin(data.shear_site, [row["group"] for row in rows])
    theta, stress, site = data.shear_angle[chosen], data.stress[chosen], data.shear_site[chosen]
    angle = theta / DEGREE
    figure = new_figure(height_mm=70.0)
    axes = figure.add_subplot()
    error_bars(axes, angle, data.stress_interval[chosen], site, styles)
    handles = scatter(axes, angle, stress, site, styles)
    for style, mask in masks(styles, site):
        for row in rows:
            if row["group"] in style.sites and _significant(row):
                of_site = mask & (site == row["group"])
                line = regression_line(row, theta[of_site])
                draw_line(axes, line, colour=style.colour, x_unit=DEGREE)
    axes.set_xlim(0.0, 95.0)
    axes.set_xticks(range(0, 91, 15))
    axes.set_ylim(0.0, float(stress.max()) * 1.08 or 1.0)
    axes.set_xlabel(r"edge angle $\vartheta$ (°)")
    axes.set_ylabel(r"failure shear stress $S_\mathrm{f}$ (N/mm²)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    found = "; ".join(f"{row['group']}: n = {row['n']}, {_judged(row)}" for row in rows[:MOST_SENTENCES])
    caption = prose(
        "Failure shear stress S_f against edge angle at the sites where the angle was varied (the paper's Fig. 8), "
        "with the 95 % interval that the instruments allow. A regression line with the 95 % band of its mean is drawn "
        "only where p < 0.05. {found}.",
        found=found,
    )
    return Drawing(
        NAME, caption, "Failure shear stress against edge angle in degrees, by site.", figure, points=len(stress)
    )


def _judged(row: Json) -> str:
    return "too few different angles to judge" if row["withheld"] else p_equals(row["p"])


def _significant(row: Json) -> bool:
    return row["p"] is not None and row["p"] < SIGNIFICANT
