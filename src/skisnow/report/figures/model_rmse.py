"""The rmse of the nine laws beside the paper's printed ones, as dots."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from matplotlib.lines import Line2D

from ...snow.published.moessner_2013 import PRINTED_RMSE_N
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import BLUE, PALE, VERMILLION, legend_below, mark_synthetic, new_figure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markupsafe import Markup

    from ..report_data import Json, ReportData
    from .style import SiteStyle

NAME: Final = "model_rmse"
TOO_FEW: Final = "the series are too few, or all at one edge angle"
_WIDE_RATIO: Final = 20.0


def model_rmse(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """Own rmse over n, filled; the paper's, open; the selected law marked."""
    rows = [row for row in data.results["penetration"]["models"] if row["n"]]
    if not rows:
        return LeftOut(NAME, "rmse of the nine laws", "no penetration experiment is used")
    if data.results["penetration"]["selected"] is None:
        return LeftOut(NAME, "rmse of the nine laws", TOO_FEW)
    own = [row["rmse_N"] for row in rows]
    printed = [PRINTED_RMSE_N.get(row["id"], math.nan) for row in rows]
    known = [value for value in own + printed if math.isfinite(value)]
    figure = new_figure(height_mm=70.0)
    axes = figure.add_subplot()
    places = range(len(rows))
    axes.hlines(places, own, printed, color=PALE, linewidth=0.7, zorder=1)
    axes.plot(printed, places, linestyle="none", marker="D", color=VERMILLION, markerfacecolor="white", zorder=3)
    axes.plot(own, places, linestyle="none", marker="o", color=BLUE, markersize=4.4, zorder=4)
    axes.set_yticks(list(places), [_label(row, data) for row in rows])
    axes.invert_yaxis()
    if max(known) > _WIDE_RATIO * max(min(known), 1e-9):
        axes.set_xscale("log")
    else:
        axes.set_xlim(0.0, max(known) * 1.06)
    axes.set_xlabel("rmse over all readings (N)")
    axes.tick_params(axis="y", length=0)
    axes.grid(axis="x", color="#E6E6E6", linewidth=0.5)
    axes.set_axisbelow(True)
    mark_synthetic(data, axes)
    legend_below(figure, _handles())
    return Drawing(NAME, _caption(), "Dot chart of the rmse of nine laws, this campaign and the paper.", figure)


def _label(row: Json, data: ReportData) -> str:
    selected = data.results["penetration"]["selected"]
    text = f"${row['hardness'][0]}_\\mathrm{{{row['hardness'][2]}}}$: {_form(row)}"
    return f"▸ {text}" if selected and selected["id"] == row["id"] else text


def _form(row: Json) -> str:
    if row["a"] == "none":
        return "$b = 1$" if row["b"] == "one" else f"$b$ {row['b']}"
    return f"$a$, $b$ {row['b']}"


def _handles() -> list[Line2D]:
    return [
        Line2D([], [], linestyle="none", marker="o", color=BLUE, markersize=4.4, label="this campaign"),
        Line2D([], [], linestyle="none", marker="D", color=VERMILLION, markerfacecolor="white", label="paper, printed"),
    ]


def _caption() -> Markup:
    return prose(
        "Root-mean-square error of the nine laws over all readings, with the values printed by Mössner and others "
        "(2013) for their data, which are not public. The pointer marks the selected law."
    )
