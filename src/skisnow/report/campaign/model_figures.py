"""Figures of the nine candidate models: their rmse, and the residuals of the selected one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ...estimation.models import FORMS, ModelFit
from ...estimation.readings import Readings
from ...snow.published.moessner_2013 import PRINTED_RMSE_N
from ..figures.drawing import Drawing, LeftOut
from ..figures.style import (
    BLUE,
    GREY,
    PALE,
    RASTERISE_FROM,
    VERMILLION,
    SiteStyle,
    legend_below,
    mark_synthetic,
    new_figure,
    thinned,
)
from ..formatting import html, prose, significant, whole
from .data import Json, ReportData
from .model_tables import formula

MOST_GROUPS: Final = 12
TOO_FEW: Final = Message("the series are too few, or all at one edge angle")
_WIDE_RATIO: Final = 20.0


def model_rmse(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """Dot chart of the rmse in this campaign (filled) and in the paper (open)."""
    rows = [row for row in data.results["penetration"]["models"] if row["n"]]
    if not rows:
        return LeftOut("model_rmse", Message("rmse of the nine laws"), Message("no penetration experiment is used"))
    if data.results["penetration"]["selected"] is None:
        return LeftOut("model_rmse", Message("rmse of the nine laws"), TOO_FEW)
    own = [row["rmse_N"] for row in rows]
    printed = [PRINTED_RMSE_N.get(row["id"], math.nan) for row in rows]
    finite = [value for value in own + printed if math.isfinite(value)]
    figure = new_figure(height_mm=70.0)
    axes = figure.add_subplot()
    places = range(len(rows))
    axes.hlines(places, own, printed, color=PALE, linewidth=0.7, zorder=1)
    axes.plot(printed, places, linestyle="none", marker="D", color=VERMILLION, markerfacecolor="white", zorder=3)
    axes.plot(own, places, linestyle="none", marker="o", color=BLUE, markersize=4.4, zorder=4)
    axes.set_yticks(list(places), [_line_label(row, data) for row in rows])
    axes.invert_yaxis()
    if max(finite) > _WIDE_RATIO * max(min(finite), 1e-9):
        axes.set_xscale("log")
    else:
        axes.set_xlim(0.0, max(finite) * 1.06)
    axes.set_xlabel(Message("rmse over all readings (N)"))
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color="#E6E6E6", linewidth=0.5)
    axes.set_axisbelow(True)
    mark_synthetic(data, axes)
    handles = [
        Line2D([], [], linestyle="none", marker="o", color=BLUE, markersize=4.4, label=Message("this campaign")),
        Line2D(
            [],
            [],
            linestyle="none",
            marker="D",
            color=VERMILLION,
            markerfacecolor="white",
            label=Message("paper, printed"),
        ),
    ]
    legend_below(figure, handles)
    caption = prose(
        "Root-mean-square error of the nine laws over all readings, with the values printed by Mössner and others "
        "(2013) for their data, which are not public. The pointer marks the selected law."
    )
    alt = Message("Dot chart of the rmse of nine laws, this campaign and the paper.")
    return Drawing("model_rmse", caption, alt, figure)


def _line_label(row: Json, data: ReportData) -> str:
    selected = data.results["penetration"]["selected"]
    terms = "$b = 1$" if row["b"] == "one" else f"$b$ {FORMS[row['b']]}"
    if row["a"] != "none":
        terms = f"$a$, $b$ {FORMS[row['b']]}"
    text = f"${row['hardness'][0]}_\\mathrm{{{row['hardness'][2]}}}$: {terms}"
    return f"▸ {text}" if selected and selected["id"] == row["id"] else text


def residuals(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """Force of the selected model minus applied load, with median and 90 % range along the load."""
    penetration = data.analysis.penetration
    if penetration is None or penetration.table is None:
        return LeftOut(
            "residuals", Message("Residuals of the selected law"), Message("no penetration experiment is used")
        )
    if penetration.selected is None:
        return LeftOut("residuals", Message("Residuals of the selected law"), TOO_FEW)
    readings = penetration.readings.of(penetration.screened.used)
    selected = penetration.selected
    hardness = penetration.hardness[selected.model.hardness].value[penetration.screened.used]
    residual = _force(selected, hardness[readings.series], readings) - readings.load
    figure = new_figure(height_mm=62.0)
    axes = figure.add_subplot()
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
    part = thinned(readings.n)
    axes.plot(
        readings.load[part],
        residual[part],
        linestyle="none",
        marker=".",
        markersize=3.0,
        markeredgewidth=0.0,
        color=PALE,
        rasterized=readings.n > RASTERISE_FROM,
        zorder=2,
    )
    _draw_ranges_by_load(axes, readings.load, residual)
    axes.set_xlabel(Message("load $F$ (N)"))
    axes.set_ylabel(Message("law − load (N)"))
    axes.set_xlim(0.0, float(readings.load.max()) * 1.05)
    mark_synthetic(data, axes)
    caption = prose(
        "Residuals of the selected law, F = {law}, against the load: {n} readings of {m} series. Blue: median and the "
        "range of 90 % of the readings along the load; red: mean. The last reading of each series defines its "
        "hardness. rmse {rmse} N.",
        law=html(formula(selected.model.id)),
        n=whole(readings.n),
        m=whole(readings.n_series),
        rmse=significant(selected.rmse, 4),
    )
    alt = Message("Residuals of the selected law in newtons against the load in newtons.")
    return Drawing("residuals", caption, alt, figure, points=readings.n)


def _force(fit: ModelFit, hardness: FloatArray, readings: Readings) -> FloatArray:
    """F = H (a(ϑ) A + b(ϑ) V) of each reading (N)."""
    angle = readings.edge_angle[readings.series]
    # a slope that the angles do not determine is NaN and counts as 0
    a, b = fit.a0 + np.nan_to_num(fit.a1) * angle, fit.b0 + np.nan_to_num(fit.b1) * angle
    force: FloatArray = hardness * (a * readings.contact_area + b * readings.displaced_volume)
    return force


def _draw_ranges_by_load(axes: Axes, load: FloatArray, residual: FloatArray) -> None:
    values = np.unique(load)
    edges = values if len(values) <= MOST_GROUPS else np.unique(np.quantile(load, np.arange(MOST_GROUPS) / MOST_GROUPS))
    group = np.searchsorted(edges, load, side="right") - 1
    for index in range(len(edges)):
        part = residual[group == index]
        place = float(np.median(load[group == index]))
        low, middle, high = np.percentile(part, (5.0, 50.0, 95.0))
        axes.vlines(place, low, high, color=BLUE, linewidth=1.1, zorder=3)
        axes.plot([place], [middle], marker="o", color=BLUE, markersize=3.6, zorder=4)
        axes.plot([place], [part.mean()], marker="_", color=VERMILLION, markersize=6.0, markeredgewidth=1.2, zorder=5)
