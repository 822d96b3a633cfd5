"""Fig 11 of the paper: failure shear stress against snow hardness at the same spots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...estimate.observations import HARDNESS_KEY, STRESS_KEY
from ..number_formatting import counted, p_equals
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import legend_below, logarithmic, mark_synthetic, new_figure, scatter, spans_a_decade

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "fig11_stress_hardness"


def stress_hardness(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """One point for each spot with both."""
    spots = data.observations["spots"]
    if not spots.site:
        reason = "no spot has both a used penetration and a used shear experiment"
        return LeftOut(NAME, "Failure shear stress against snow hardness", reason)
    hardness, stress = spots.columns[HARDNESS_KEY], spots.columns[STRESS_KEY]
    figure = new_figure(height_mm=70.0)
    axes = figure.add_subplot()
    handles = scatter(axes, hardness, stress, np.array(spots.site), styles)
    if spans_a_decade(hardness):
        logarithmic(axes, "x", hardness)
    axes.set_ylim(0.0, float(stress.max()) * 1.08 or 1.0)
    axes.set_xlabel(r"snow hardness $H_\mathrm{V}$ (N/mm³)")
    axes.set_ylabel(r"failure shear stress $S_\mathrm{f}$ (N/mm²)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    row = data.regression("S_f_N_per_mm2", "H_V_N_per_mm3")
    caption = prose(
        "Failure shear stress S_f against snow hardness H_V at {spots} (the paper's Fig. 11): geometric mean of H_V "
        "and mean of S_f over the used experiments of a spot.{found}",
        spots=counted(len(spots.site), "spot"),
        found=f" Linear regression: {p_equals(row['p'])}." if row and row["p"] is not None else "",
    )
    return Drawing(
        NAME,
        caption,
        "Failure shear stress against snow hardness, one point for each spot.",
        figure,
        points=len(stress),
    )
