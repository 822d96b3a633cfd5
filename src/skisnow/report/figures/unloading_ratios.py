"""How steep the unloading is, series by series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from ..number_formatting import whole
from ..report_data import numbers, pairs, texts
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import error_bars, legend_below, mark_synthetic, new_figure, plain_number, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "unloading"


def unloading_ratios(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """k_u / H_V of each used series with its interval, against the hardness."""
    rows = [row for row in data.unloaded if row["used"] and row["unloading_ratio_interval"] is not None]
    if not rows:
        return LeftOut(NAME, "Unloading", "no used series was read while its discs were taken off one by one")
    ratio, ends = numbers(rows, "unloading_ratio"), pairs(rows, "unloading_ratio_interval")
    hardness, site = numbers(rows, "H_V_N_per_mm3"), texts(rows, "site")
    figure = new_figure(height_mm=80.0)
    axes = figure.add_subplot()
    error_bars(axes, hardness, ends, site, styles)
    handles = scatter(axes, hardness, ratio, site, styles, size=3.0)
    if hardness.max() > 10.0 * hardness.min():
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(plain_number)
    if ends.max() > 10.0 * ends.min():
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(plain_number)
    axes.set_xlabel(r"snow hardness $H_\mathrm{V}$ (N/mm³)")
    axes.set_ylabel(r"unloading ratio $k_\mathrm{u}/H_\mathrm{V}$")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    caption = prose(
        "Unloading ratio k_u / H_V of {n} used series with its 95 % interval, against the hardness: 1 is elastic snow, "
        "which springs back; the larger the ratio, the larger the permanent depth of the groove.",
        n=whole(len(rows)),
    )
    alt = "Unloading ratio with intervals against snow hardness, by site."
    return Drawing(NAME, caption, alt, figure, points=len(rows))
