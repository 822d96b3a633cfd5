"""Fig 7 of the paper: failure shear force against depth."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..report_data import numbers
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import legend_below, mark_synthetic, new_figure, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "fig07_shear_force_depth"


def shear_force_depth(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """F_t of every used test."""
    if len(data.stress) == 0:
        return LeftOut(NAME, "Failure shear force against depth", "no shear experiment is used")
    force = numbers(data.shear, "F_t_N")[data.shear_used]
    figure = new_figure(height_mm=76.0)
    axes = figure.add_subplot()
    handles = scatter(axes, data.shear_depth, force, data.shear_site, styles)
    axes.set_xlim(0.0, float(data.shear_depth.max()) * 1.06)
    axes.set_ylim(0.0, float(force.max()) * 1.08 or 1.0)
    axes.set_xlabel("penetration depth $e$ (mm)")
    axes.set_ylabel(r"failure shear force $F_\mathrm{t}$ (N)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    caption = prose(
        "Failure shear force F_t against penetration depth of the plate (the paper's Fig. 7), by site. With one plate, "
        "points of equal S_f lie on a straight line through the origin."
    )
    return Drawing(
        NAME,
        caption,
        "Failure shear force in newtons against depth in millimetres, by site.",
        figure,
        points=len(force),
    )
