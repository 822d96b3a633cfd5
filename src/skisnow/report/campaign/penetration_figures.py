"""Figures of the penetration experiments: Figs 5 and 6 of the paper, seating, unloading, SnowMicroPen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import Message, template
from ..._support.units import MM
from ...estimation.regressions import PEN_FORCE_KEY
from ...geometry import in_form
from ..charts import law_of_series
from ..figures import style
from ..figures.drawing import Drawing, LeftOut
from ..formatting import p_equals, prose, whole
from .data import Json, ReportData, numbers, pairs, texts
from .series_tables import count_resolved_offsets

MOST_SERIES: Final = 40  # maximum number of series in one panel of Fig 5
_THRESHOLD_MM: Final = 0.1
_HARDNESS: Final = Message("snow hardness $H_\\mathrm{{V}}$ (N/mm³)")


def force_depth(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Readings of the flat and one edged tool, with F = H_V V as a line for each series (Fig 5)."""
    name = "fig05_force_depth"
    tests = data.campaign.penetration
    angles = shown_angles(data)
    if tests is None or not angles:
        return LeftOut(name, Message("Load against penetration depth"), Message("no penetration experiment is used"))
    figure = style.new_figure(width_mm=style.DOUBLE_MM if len(angles) > 1 else style.SINGLE_MM, height_mm=80.0)
    panels = figure.subplots(1, len(angles), squeeze=False, sharey=True)[0]
    handles: dict[str, Line2D] = {}
    rows = list(enumerate(data.penetration))
    series = [[i for i, row in rows if row["used"] and row["edge_angle_deg"] == angle] for angle in angles]
    drawn = [_evenly_spaced(indices, data) for indices in series]
    counts = list(zip(angles, map(len, drawn), map(len, series), strict=True))
    deepest = ([tests.series(index).penetration_depth.max() for index in indices] for indices in drawn)
    wide_range = any(style.spans_a_decade(np.array(depths)) for depths in deepest)
    for panel, angle, indices in zip(panels, angles, drawn, strict=True):
        drawn_sites = _draw_panel(panel, data, indices, styles, wide_range=wide_range)
        handles |= {str(handle.get_label()): handle for handle in drawn_sites}
        panel.set_title(_angle_name(angle), loc="left")
    panels[0].set_ylabel(Message("load $F$ (N)"))
    style.mark_synthetic(data, panels[-1])
    style.legend_below(figure, [handles[site_style.label] for site_style in styles if site_style.label in handles])
    n_other = int(data.pressed.used.sum()) - sum(map(len, series))
    caption = _force_caption(counts, n_other, wide_range=wide_range)
    names = [_angle_name(angle) for angle in angles]
    alt = Message(
        "Scatter of load in newtons against penetration depth in millimetres, {names}, with a fitted law per series.",
        names=names,
    )
    return Drawing(name, caption, alt, figure, wide=len(angles) > 1)


def shown_angles(data: ReportData) -> list[float]:
    """Angles (degrees) that `force_depth` draws: that of the flat tool and the most frequent other one, if used."""
    angles = np.array([row["edge_angle_deg"] for row in data.penetration], dtype=float)[data.pressed.used]
    edged, counts = np.unique(angles[angles > 0], return_counts=True)
    # of equally frequent angles the one nearest to the paper's 45°
    best = sorted(zip(-counts, np.abs(edged - 45.0), edged, strict=True))[:1]
    return ([0.0] if np.any(angles == 0) else []) + [float(angle) for _, _, angle in best]


def _angle_name(angle: float) -> str:
    """Name of an edge angle (°), "edged" unless it is 0."""
    return "ϑ = 0°" if angle == 0 else str(Message("edged, ϑ = {angle:.4g}°", angle=angle))


def _evenly_spaced(indices: list[int], data: ReportData) -> list[int]:
    """At most `MOST_SERIES` of these series (indices), evenly spaced in the rank of their hardness."""
    if len(indices) <= MOST_SERIES:
        return indices
    by_hardness = sorted(indices, key=lambda index: data.penetration[index]["H_V_N_per_mm3"])
    places = np.linspace(0, len(indices) - 1, MOST_SERIES).round().astype(int)
    return [by_hardness[place] for place in places]


def _draw_panel(
    panel: Axes, data: ReportData, indices: list[int], styles: Sequence[style.SiteStyle], *, wide_range: bool
) -> list[Line2D]:
    """Draw the readings of series and the law F = H_V V of each; returns the handles of the legend."""
    tests, penetration = data.campaign.penetration, data.analysis.penetration
    assert tests is not None
    assert penetration is not None
    every = {index: tests.series(index) for index in indices}
    depth = np.concatenate([series.penetration_depth for series in every.values()]) / MM
    load = np.concatenate([series.load for series in every.values()])
    names = np.array([tests.site[index] for index in indices])
    site = np.repeat(names, [len(series.load) for series in every.values()])
    for site_style, mask in style.masks(styles, names):
        for index in np.array(indices)[mask].tolist():
            series = every[index]
            deepest = float(series.penetration_depth.max())
            e = np.geomspace(deepest * 1e-3, deepest, 60) if wide_range else np.linspace(0.0, deepest, 60)
            tool = in_form(data.campaign.tools[series.tool], data.analysis.geometry)
            hardness = float(penetration.hardness["H_V"].value[index])
            line = law_of_series(tool, series.edge_angle, hardness, e)
            panel.plot(*line, color=site_style.colour, linewidth=0.6, alpha=0.75, zorder=2)
    handles = style.scatter(panel, depth, load, site, styles, size=3.0)
    if wide_range:
        style.logarithmic(panel, "x", depth)
        style.logarithmic(panel, "y", load)
    else:
        panel.set_xlim(0.0, float(depth.max()) * 1.05)
        panel.set_ylim(0.0, float(load.max()) * 1.08)
    panel.set_xlabel(Message("penetration depth $e$ (mm)"))
    return handles


def _force_caption(counts: list[tuple[float, int, int]], n_other: int, *, wide_range: bool) -> Markup:
    """Caption of the loads; `counts`: edge angle (°), shown and total series of each panel."""
    panels = []
    for angle, shown, total in counts:
        words = template("{shown} of {total} ({angle})")
        if shown < total:
            words = template("{shown} of {total} ({angle}), evenly spaced in the rank of their hardness")
        panels.append(str(Message(words, shown=whole(shown), total=whole(total), angle=_angle_name(angle))))
    caption = prose(
        "Load against penetration depth (the paper's Fig. 5). Symbols: readings by site; lines: F = H_V V with each "
        "series' own H_V, which meets the reading under the largest load by definition. Series shown: {panels}.",
        panels="; ".join(panels),
    )
    if n_other:
        caption += prose(" Series at other edge angles, not shown: {number}.", number=whole(n_other))
    if wide_range:
        caption += prose(
            " Both axes are logarithmic, as the depths span more than a decade: the law is a straight line there, of "
            "slope 1 for a flat tool and 2 for a wedge; readings of depth 0 have no place on them."
        )
    return caption


def seating_offsets(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Offset of the depth zero of each series with its interval, against hardness."""
    name, rows = "seating", data.seating
    if not rows:
        reason = Message("no used series has the three readings that an offset needs")
        return LeftOut(name, Message("Offsets of the depth zero"), reason)
    offset, intervals = numbers(rows, "depth_offset_mm"), pairs(rows, "interval_mm")
    label = Message("depth offset $\\delta$ (mm)")
    plot = _plot_against_hardness(data, styles, rows, offset, intervals, label)
    plot.axes.axhline(0.0, color=style.GREY, linewidth=0.6, zorder=1)
    if np.abs(offset).max() > 10.0 * _THRESHOLD_MM:
        plot.axes.set_yscale("symlog", linthresh=_THRESHOLD_MM, linscale=0.8)
        plot.axes.yaxis.set_major_formatter(style.plain_number)
    caption = prose(
        "Offset δ of the depth zero of each used series with its 95 % interval, against the hardness: a positive δ is "
        "a gauge that read δ when the tool touched. {shown} of {all} intervals leave out zero; of series without any "
        "offset about one in twenty would.",
        shown=whole(count_resolved_offsets(rows)),
        all=whole(len(rows)),
    )
    alt = Message("Depth offset in millimetres with intervals against snow hardness, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=len(rows))


def unloading_ratios(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """k_u / H_V of each series with its interval, against hardness."""
    name = "unloading"
    rows = [row for row in data.unloaded if row["used"] and row["unloading_ratio_interval"] is not None]
    if not rows:
        reason = Message("no used series was read while its discs were taken off one by one")
        return LeftOut(name, Message("Unloading"), reason)
    ratio, intervals = numbers(rows, "unloading_ratio"), pairs(rows, "unloading_ratio_interval")
    label = Message("unloading ratio $k_\\mathrm{{u}}/H_\\mathrm{{V}}$")
    plot = _plot_against_hardness(data, styles, rows, ratio, intervals, label)
    if intervals.max() > 10.0 * intervals.min():
        plot.axes.set_yscale("log")
        plot.axes.yaxis.set_major_formatter(style.plain_number)
    caption = prose(
        "Unloading ratio k_u / H_V of {n} used series with its 95 % interval, against the hardness: 1 is elastic snow, "
        "which springs back; the larger the ratio, the larger the permanent depth of the groove.",
        n=whole(len(rows)),
    )
    alt = Message("Unloading ratio with intervals against snow hardness, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=len(rows))


def _plot_against_hardness(
    data: ReportData,
    styles: Sequence[style.SiteStyle],
    rows: Sequence[Json],
    values: FloatArray,
    ends: FloatArray,
    label: str,
) -> style.SitePlot:
    """Points with intervals ``ends`` over the hardness of their series."""
    hardness = numbers(rows, "H_V_N_per_mm3")
    plot = style.SitePlot(data, styles, _HARDNESS, label, height_mm=80.0)
    plot.draw(hardness, values, texts(rows, "site"), ends=ends, size=3.0)
    if hardness.min() > 0 and hardness.max() > 10.0 * hardness.min():
        plot.axes.set_xscale("log")
        plot.axes.xaxis.set_major_formatter(style.plain_number)
    return plot


def hardness_density(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Figure of H_V with intervals against snow density (kg/m³), the paper's Fig 6, or why it is left out."""
    name, title = "fig06_hardness_density", Message("Snow hardness against density")
    if not len(data.pressed):
        return LeftOut(name, title, Message("no penetration experiment is used"))
    if not np.isfinite(data.pressed.density).any():
        return LeftOut(name, title, Message("the campaign gives no snow density at its penetration experiments"))
    plot = style.SitePlot(data, styles, Message("snow density $\\rho$ (kg/m³)"), _HARDNESS, height_mm=80.0)
    n = _draw_hardness(plot, data.pressed.density)
    caption = prose(
        "Snow hardness H_V against density (the paper's Fig. 6) with the 95 % interval of each experiment."
    ) + _p_sentence(data.regression("H_V_N_per_mm3", "snow_density_kg_per_m3"))
    alt = Message("Snow hardness against snow density with intervals, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=n)


def hardness_mean_force(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Snow hardness with its interval against the mean force of a SnowMicroPen at the same place."""
    name, force = "hardness_mean_force", data.analysis.observations["penetration"].columns[PEN_FORCE_KEY]
    if not np.isfinite(force).any():
        reason = Message("no used recording is at the site of a used penetration experiment")
        return LeftOut(name, Message("Snow hardness against the SnowMicroPen's mean force"), reason)
    plot = style.SitePlot(data, styles, Message("mean force of the SnowMicroPen (N)"), _HARDNESS, height_mm=80.0)
    n = _draw_hardness(plot, force)
    if style.spans_a_decade(force[np.isfinite(force)]):
        style.logarithmic(plot.axes, "x", force)
    settings = data.results["snow_micro_pen"]
    caption = prose(
        "Snow hardness H_V against the mean force of the SnowMicroPen, {first} to {last} mm below the surface, at the "
        "same spot or else site, with the 95 % interval of each experiment.",
        first=settings["from_depth_mm"],
        last=settings["to_depth_mm"],
    ) + _p_sentence(data.regression("H_V_N_per_mm3", PEN_FORCE_KEY))
    alt = Message("Snow hardness against the SnowMicroPen's mean force with intervals, by site.")
    return Drawing(name, caption, alt, plot.finish(), points=n)


def _draw_hardness(plot: style.SitePlot, x: FloatArray) -> int:
    """Draw H_V with intervals against another quantity; returns the number of points."""
    finite, tests = np.isfinite(x), plot.data.pressed
    hardness, intervals = tests.value[finite], tests.interval[finite]
    plot.draw(x[finite], hardness, tests.site[finite], ends=intervals)
    if style.spans_a_decade(hardness):
        style.logarithmic(plot.axes, "y", np.concatenate((hardness, intervals[np.isfinite(intervals)])))
    return len(hardness)


def _p_sentence(row: Json | None) -> Markup:
    """Sentence with the p value of a regression; empty without one."""
    if row is None or row["p"] is None:
        return Markup("")
    return prose(" Linear regression over all: {p}.", p=p_equals(row["p"]))
