"""Residuals of the selected law against the load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...estimate.hardness import DEFINITIONS
from ...estimate.readings import readings_of
from ...units import DEGREE, MM2, MM3
from ..material import numbers
from ..numerals import significant, whole
from ..symbols import html, prose
from ..tables.models import law
from .drawing import Drawing, LeftOut
from .style import BLUE, GREY, PALE, RASTERISE_FROM, VERMILLION, mark_synthetic, new_figure, thinned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

    from ...estimate.readings import Readings
    from ..material import FloatArray, Json, Material
    from .style import SiteStyle

NAME: Final = "residuals"
MOST_GROUPS: Final = 12


def residuals(material: Material, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """F of the law minus F applied, all used readings, with medians and 90 % ranges along the load."""
    selected, tests = material.results["penetration"]["selected"], material.campaign.penetration
    if selected is None or tests is None:
        return LeftOut(NAME, "Residuals of the selected law", "no penetration experiment is used")
    row = next(row for row in material.results["penetration"]["models"] if row["id"] == selected["id"])
    geometry = material.results["provenance"]["options"]["geometry"]
    every = readings_of(tests, material.campaign.tools, geometry=geometry)
    used = every.of(material.penetration_used)
    departure = _force(material, row, used) - used.load
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
    mark_synthetic(material, axes)
    caption = prose(
        "Residuals of the selected law, F = {law}, against the load: {n} readings of {m} series. Blue: median and the "
        "range of 90 % of the readings along the load; red: mean. The last reading of each series defines its "
        "hardness. rmse {rmse} N.",
        law=html(law(row["id"])),
        n=whole(used.n),
        m=whole(used.n_series),
        rmse=significant(row["rmse_N"], 4),
    )
    return Drawing(
        NAME, caption, "Residuals of the selected law in newtons against the load in newtons.", figure, points=used.n
    )


def _force(material: Material, row: Json, used: Readings) -> FloatArray:
    """F = H (a(ϑ) A + b(ϑ) V) in the units of the table."""
    H = numbers(material.penetration, DEFINITIONS[row["hardness"]].key)[material.penetration_used][used.series]
    angle = np.array([item["edge_angle_deg"] for item in material.penetration], dtype=float) * DEGREE
    of_reading = angle[material.penetration_used][used.series]
    a, b = (row[f"{letter}0"] + (row[f"{letter}1"] or 0.0) * of_reading for letter in "ab")
    force: FloatArray = H * (a * used.contact_area / MM2 + b * used.displaced_volume / MM3)
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
