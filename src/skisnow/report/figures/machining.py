"""Fig 9 of the paper: the soft snow's shear stress against machining theory."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.lines import Line2D

from ...forces.cutting import cutting_stress
from ...units import DEGREE
from ..number_formatting import significant
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .stress_angle import shear_angles_deg, varied_sites
from .style import BLACK, legend_below, mark_synthetic, new_figure, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import Json, ReportData
    from .style import SiteStyle

NAME: Final = "fig09_machining"
FRICTION: Final = 0.2
"""Transverse friction of the thin curve, as in the paper's figure."""
_CURVES: Final = ((0.0, 1.6, "machining, β = 0"), (FRICTION, 0.7, "β = arctan 0.2"))
_HEADROOM: Final = 2.5


def softest_varied(data: ReportData) -> tuple[Json, float] | None:
    """The regression of the site of varied angle with the least stress at 90°, and that stress (N/mm²)."""
    upright = [(row["b"][0] + row["b"][1] * math.pi / 2.0, row) for row in varied_sites(data)]
    positive = [pair for pair in upright if pair[0] > 0]
    if not positive:
        return None
    stress, row = min(positive, key=lambda pair: pair[0])
    return row, stress


def machining(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """F_t/(L e) with Eqn 10 for two frictions, S half of the regression's value at 90°."""
    found = softest_varied(data)
    if found is None:
        reason = "no site has five used shear experiments at three edge angles with a positive stress at 90°"
        return LeftOut(NAME, "Shear stress against machining theory", reason)
    row, upright = found
    mine = data.shear_site == row["group"]
    angle, stress = shear_angles_deg(data)[mine], data.stress[mine]
    figure = new_figure(height_mm=70.0)
    axes = figure.add_subplot()
    handles = scatter(axes, angle, stress, data.shear_site[mine], styles)
    theta = np.linspace(2.0, 90.0, 400)
    for friction, width, label in _CURVES:
        curve = cutting_stress(upright / 2.0, theta * DEGREE, transverse_friction=friction)
        axes.plot(theta, curve, color=BLACK, linewidth=width, zorder=2)
        handles.append(Line2D([], [], color=BLACK, linewidth=width, label=label))
    axes.set_xlim(0.0, 95.0)
    axes.set_xticks(range(0, 91, 15))
    axes.set_ylim(0.0, _HEADROOM * max(float(stress.max()), upright))
    axes.set_xlabel(r"edge angle $\vartheta$ (°)")
    axes.set_ylabel(r"$F_\mathrm{t}/(L\,e)$ (N/mm²)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    caption = prose(
        "Tangential stress F_t/(L e) at {site}, the softest site of varied edge angle, against machining theory (Eqn "
        "10; the paper's Fig. 9). S = {S} N/mm² is half of the regression's {upright} N/mm² at 90° (S_f = 2 S there "
        "without friction): a choice that makes the thick curve, β = 0, meet the data at 90°; thin: β = arctan 0.2.",
        site=row["group"],
        S=significant(upright / 2.0),
        upright=significant(upright),
    )
    return Drawing(NAME, caption, "Shear stress of one site against edge angle, with two curves of machining.", figure)
