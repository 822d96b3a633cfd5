"""Residuals of the selected law against the load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..number_formatting import significant, whole
from ..symbols import html, prose
from ..tables.models import law
from .drawing import Drawing, LeftOut
from .model_rmse import TOO_FEW
from .style import BLUE, GREY, PALE, RASTERISE_FROM, VERMILLION, mark_synthetic, new_figure, thinned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from ...estimate.models import ModelFit
    from ...estimate.readings import Readings
    from ..report_data import FloatArray, ReportData
    from .style import SiteStyle

NAME: Final = "residuals"
MOST_GROUPS: Final = 12


def residuals(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """F of the law minus F applied, all used readings, with medians and 90 % ranges along the load."""
    found = data.analysis.penetration
    if found is None or found.table is None:
        return LeftOut(NAME, "Residuals of the selected law", "no penetration experiment is used")
    if found.selected is None:
        return LeftOut(NAME, "Residuals of the selected law", TOO_FEW)
    used = found.readings.of(found.screened.used)
    hardness = found.hardness[found.selected.model.hardness].value[found.screened.used]
    departure = _force(found.selected, hardness[used.series], used) - used.load
    figure = new_figure(height_mm=62.0)
    axes = figure.add_subplot()
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
    part = thinned(used.n)
    axes.plot(
        used.load[part],
        departure[part],
        linestyle="none",
        marker=".",
        markersize=3.0,
        markeredgewidth=0.0,
        color=PALE,
        rasterized=used.n > RASTERISE_FROM,
        zorder=2,
    )
    _ranges(axes, used.load, departure)
    axes.set_xlabel("load $F$ (N)")
    axes.set_ylabel("law − load (N)")
    axes.set_xlim(0.0, float(used.load.max()) * 1.05)
    mark_synthetic(data, axes)
    caption = prose(
        "Residuals of the selected law, F = {law}, against the load: {n} readings of {m} series. Blue: median and the "
        "range of 90 % of the readings along the load; red: mean. The last reading of each series defines its "
        "hardness. rmse {rmse} N.",
        law=html(law(found.selected.model.id)),
        n=whole(used.n),
        m=whole(used.n_series),
        rmse=significant(found.selected.rmse, 4),
    )
    return Drawing(
        NAME, caption, "Residuals of the selected law in newtons against the load in newtons.", figure, points=used.n
    )


def _force(fit: ModelFit, hardness: FloatArray, used: Readings) -> FloatArray:
    """F = H (a(ϑ) A + b(ϑ) V) of each reading, SI."""
    angle = used.edge_angle[used.series]
    # a slope that the angles do not tell is none
    a, b = fit.a0 + np.nan_to_num(fit.a1) * angle, fit.b0 + np.nan_to_num(fit.b1) * angle
    force: FloatArray = hardness * (a * used.contact_area + b * used.displaced_volume)
    return force


def _ranges(axes: Axes, load: FloatArray, departure: FloatArray) -> None:
    values = np.unique(load)
    edges = values if len(values) <= MOST_GROUPS else np.unique(np.quantile(load, np.arange(MOST_GROUPS) / MOST_GROUPS))
    group = np.searchsorted(edges, load, side="right") - 1
    for index in range(len(edges)):
        part = departure[group == index]
        place = float(np.median(load[group == index]))
        low, middle, high = np.percentile(part, (5.0, 50.0, 95.0))
        axes.vlines(place, low, high, color=BLUE, linewidth=1.1, zorder=3)
        axes.plot([place], [middle], marker="o", color=BLUE, markersize=3.6, zorder=4)
        axes.plot([place], [part.mean()], marker="_", color=VERMILLION, markersize=6.0, markeredgewidth=1.2, zorder=5)
