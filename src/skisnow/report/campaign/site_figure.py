"""Figure of the sites: means with intervals, and letters of the sites that are not shown to differ."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ..._support.messages import Message
from ..figures.drawing import Drawing, LeftOut
from ..figures.style import BLUE, GREY, logarithmic, mark_synthetic, new_figure, spans_a_decade
from ..symbols import figure_text, prose
from .data import numbers, pairs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from ..._support.arrays import FloatArray
    from ..figures.style import SiteStyle
    from .data import Json, ReportData, TextArray

MOST_SITES: Final = 40
_ROW_MM: Final = 4.6
_MARGIN_MM: Final = 22.0
_GOLDEN_SHARE: Final = 0.618034
"""Its multiples spread points evenly across a row without a random number."""
_PANELS: Final = (
    ("H_V_N_per_mm3", Message("snow hardness $H_\\mathrm{{V}}$ (N/mm³)")),
    ("S_f_N_per_mm2", Message("failure shear stress $S_\\mathrm{{f}}$ (N/mm²)")),
)


def sites(data: ReportData, _styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Mean of each site with its 95 % interval and its letters, above the single experiments."""
    name = "sites"
    rows = {key: [row for row in data.results["site_means"] if row["quantity"] == key] for key, _ in _PANELS}
    panels = [(key, label) for key, label in _PANELS if len(rows[key]) > 1 and numbers(rows[key], "mean").min() > 0]
    if not panels:
        return LeftOut(name, Message("Sites compared"), Message("no two sites have used experiments of one kind"))
    if max(len(rows[key]) for key, _ in panels) > MOST_SITES:
        return LeftOut(name, Message("Sites compared"), Message("there are more than {most} sites", most=MOST_SITES))
    most = max(len(rows[key]) for key, _ in panels)
    figure = new_figure(width_mm=85.0 * len(panels), height_mm=_MARGIN_MM + _ROW_MM * most)
    for place, (key, label) in enumerate(panels, start=1):
        axes = figure.add_subplot(1, len(panels), place)
        single = (data.hardness, data.penetration_site) if key == _PANELS[0][0] else (data.stress, data.shear_site)
        _panel(axes, rows[key], *single)
        axes.set_xlabel(label)
    mark_synthetic(data, axes)
    caption = prose(
        "Sites compared: mean (of H_V: geometric) with its 95 % interval, and the single experiments. Sites that share "
        "a letter are not shown to differ (5 %, Holm’s correction for the number of pairs)."
    )
    alt = Message("Mean of each site with its interval, in the order of the means, with letters of groups.")
    points = len(data.hardness) + len(data.stress)
    return Drawing(name, caption, alt, figure, wide=len(panels) > 1, points=points)


def _panel(axes: Axes, rows: list[Json], values: FloatArray, site: TextArray) -> None:
    rows = sorted(rows, key=lambda row: row["mean"])
    for place, row in enumerate(rows):
        mine = values[(site == row["site"]) & (values > 0)]
        spread = 0.4 * (np.arange(len(mine)) * _GOLDEN_SHARE % 1.0) - 0.2
        axes.plot(mine, place + spread, ".", color=GREY, markersize=2.0, alpha=0.6, zorder=1)
    places = np.arange(len(rows))
    ends = pairs(rows, "interval")
    axes.hlines(places, ends[:, 0], ends[:, 1], color=BLUE, linewidth=1.6, zorder=2)
    axes.plot(numbers(rows, "mean"), places, "o", color=BLUE, markersize=4.0, zorder=3)
    axes.set_yticks(places, [figure_text(row["site"]) for row in rows])
    axes.set_ylim(-0.6, len(rows) - 0.4)
    everything = np.concatenate((values[values > 0], ends[np.isfinite(ends)]))
    if spans_a_decade(everything):
        logarithmic(axes, "x", everything)
    else:
        axes.set_xlim(0.0, float(everything.max()) * 1.06)
    for y, row in zip(places.tolist(), rows, strict=True):
        axes.annotate(
            row["letters"], (1.01, y), xycoords=("axes fraction", "data"), va="center", ha="left", annotation_clip=False
        )
