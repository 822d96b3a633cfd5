"""Offsets of the depth zero, series by series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..number_formatting import whole
from ..report_data import numbers, pairs, texts
from ..symbols import prose
from ..tables.seating import offsets_that_show
from .drawing import Drawing, LeftOut
from .style import GREY, error_bars, legend_below, mark_synthetic, new_figure, plain_number, scatter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report_data import ReportData
    from .style import SiteStyle

NAME: Final = "seating"
_THRESHOLD_MM: Final = 0.1


def seating_offsets(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Offsets with their intervals in the order of the hardness, where their effect lies."""
    rows = data.seating
    if not rows:
        return LeftOut(NAME, "Offsets of the depth zero", "no used series has the three readings that an offset needs")
    offset, ends = numbers(rows, "depth_offset_mm"), pairs(rows, "interval_mm")
    hardness, site = numbers(rows, "H_V_N_per_mm3"), texts(rows, "site")
    figure = new_figure(height_mm=80.0)
    axes = figure.add_subplot()
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
    error_bars(axes, hardness, ends, site, styles)
    handles = scatter(axes, hardness, offset, site, styles, size=3.0)
    if hardness.min() > 0 and hardness.max() > 10.0 * hardness.min():
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(plain_number)
    if np.abs(offset).max() > 10.0 * _THRESHOLD_MM:
        axes.set_yscale("symlog", linthresh=_THRESHOLD_MM, linscale=0.8)
        axes.yaxis.set_major_formatter(plain_number)
    axes.set_xlabel(r"snow hardness $H_\mathrm{V}$ (N/mm³)")
    axes.set_ylabel(r"depth offset $\delta$ (mm)")
    mark_synthetic(data, axes)
    legend_below(figure, handles)
    caption = prose(
        "Offset δ of the depth zero of each used series with its 95 % interval, against the hardness: a positive δ is "
        "a gauge that read δ when the tool touched. {shown} of {all} intervals leave out zero; of series without any "
        "offset about one in twenty would.",
        shown=whole(offsets_that_show(rows)),
        all=whole(len(rows)),
    )
    return Drawing(
        NAME,
        caption,
        "Depth offset in millimetres with intervals against snow hardness, by site.",
        figure,
        points=len(rows),
    )
