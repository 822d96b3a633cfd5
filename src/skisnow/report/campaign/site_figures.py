"""Figures of the sites beside each other, of SnowMicroPen profiles, and of the nine candidate models."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import Message
from ..._support.units import MM
from ...campaign.records import DensitySamples
from ...estimation.snow_micro_pen import depth_profile
from ..figures import style
from ..figures.drawing import Drawing, LeftOut
from ..formatting import figure_text, html, prose, significant, whole
from .data import Json, ReportData, TextArray, numbers, pairs
from .model_tables import formula

MOST_SITES: Final = 40
_ROW_MM: Final = 4.6
_TWO_LINES_MM: Final = 7.4
_LINE: Final = 15  # longest line of a site's name; with many sites a name has one line
_MANY_SITES: Final = 24
_TICKS: Final = 4
_MARGIN_MM: Final = 22.0
_GOLDEN_SHARE: Final = 0.618034  # its multiples spread points evenly across a row without a random number
_SITES: Final = (
    ("H_V_N_per_mm3", Message("snow hardness $H_\\mathrm{{V}}$ (N/mm³)")),
    ("S_f_N_per_mm2", Message("failure shear stress $S_\\mathrm{{f}}$ (N/mm²)")),
)


def sites(data: ReportData, _styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Mean of each site with its 95 % interval and its letters, above the single experiments."""
    name, title = "sites", Message("Sites compared")
    rows = {key: [row for row in data.results["site_means"] if row["quantity"] == key] for key, _ in _SITES}
    panels = [(key, label) for key, label in _SITES if len(rows[key]) > 1 and numbers(rows[key], "mean").min() > 0]
    most = max((len(rows[key]) for key, _ in panels), default=0)
    if not panels:
        return LeftOut(name, title, Message("no two sites have used experiments of one kind"))
    if most > MOST_SITES:
        return LeftOut(name, title, Message("there are more than {most} sites", most=MOST_SITES))
    names = {row["site"]: _site_lines(row["site"], most) for key, _ in panels for row in rows[key]}
    row_mm = _TWO_LINES_MM if any("\n" in name for name in names.values()) else _ROW_MM
    figure = style.new_figure(width_mm=85.0 * len(panels), height_mm=_MARGIN_MM + row_mm * most)
    figure.set_layout_engine("constrained", wspace=0.08)
    points = len(data.pressed) + len(data.sheared)
    for place, (key, label) in enumerate(panels, start=1):
        axes = figure.add_subplot(1, len(panels), place)
        tests = data.pressed if key == _SITES[0][0] else data.sheared
        _panel(axes, rows[key], names, tests.value, tests.site, points)
        axes.set_xlabel(label)
    style.mark_synthetic(data, axes)
    caption = prose(
        "Sites compared: mean (of H_V: geometric) with its 95 % interval, and the single experiments. Sites that share "
        "a letter are not shown to differ (5 %, Holm’s correction for the number of pairs)."
    )
    alt = Message("Mean of each site with its interval, in the order of the means, with letters of groups.")
    return Drawing(name, caption, alt, figure, wide=len(panels) > 1, points=points)


def _site_lines(site: str, count: int) -> str:
    """Name of a site in one or two short lines."""
    if count > _MANY_SITES:
        return figure_text(site, longest=_LINE)
    lines = textwrap.wrap(figure_text(site), _LINE)
    return "\n".join(lines if len(lines) <= 2 else textwrap.wrap(figure_text(site, longest=_LINE), _LINE))


def _panel(
    axes: Axes, rows: list[Json], names: Mapping[str, str], values: FloatArray, site: TextArray, points: int
) -> None:
    """Draw means with intervals and letters of sites above single experiments; `points`: number in the whole figure."""
    rows = sorted(rows, key=lambda row: row["mean"])
    many, drawn = points > style.RASTERISE_FROM, (values[style.thinned(points)], site[style.thinned(points)])
    for place, row in enumerate(rows):
        mine = drawn[0][(drawn[1] == row["site"]) & (drawn[0] > 0)]
        spread = 0.4 * (np.arange(len(mine)) * _GOLDEN_SHARE % 1.0) - 0.2
        axes.plot(mine, place + spread, ".", color=style.GREY, markersize=2.0, alpha=0.6, zorder=1, rasterized=many)
    places = np.arange(len(rows))
    ends = pairs(rows, "interval")
    axes.hlines(places, ends[:, 0], ends[:, 1], color=style.BLUE, linewidth=1.6, zorder=2)
    axes.plot(numbers(rows, "mean"), places, "o", color=style.BLUE, markersize=4.0, zorder=3)
    axes.set_yticks(places, [names[row["site"]] for row in rows])
    axes.set_ylim(-0.6, len(rows) - 0.4)
    everything = np.concatenate((values[values > 0], ends[np.isfinite(ends)]))
    if style.spans_a_decade(everything):
        style.logarithmic(axes, "x", everything)
    else:
        axes.set_xlim(0.0, float(everything.max()) * 1.06)
        axes.locator_params(axis="x", nbins=_TICKS)
    letters = axes.secondary_yaxis("right")
    letters.set_yticks(places, [row["letters"] for row in rows])
    letters.tick_params(length=0)
    letters.spines["right"].set_visible(False)


MOST_DRAWN: Final = 24  # recordings that stay legible in one figure; the first ones are drawn
_PANELS: Final = (
    ("force", Message("force (N)")),
    ("snow_density", Message("density (kg/m³)")),
    ("specific_surface_area", Message("specific surface area (m²/kg)")),
)


def snow_profiles(data: ReportData, _styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:
    """Force, density and surface area of each used recording, and densities of samples, against the depth."""
    name, samples = "snow_profiles", _samples_by_site(data.campaign.density)
    pen, profiles = data.analysis.snow_micro_pen, []
    if pen is not None:
        used = [index for index, recording in enumerate(pen.evaluated) if recording.is_used]
        recordings = pen.recordings
        for index in used[:MOST_DRAWN]:
            profile = depth_profile(recordings.profile(index), recordings.settings, pen.evaluated[index].surface)
            profiles.append((recordings.site[index], profile))
    if not profiles and not samples:
        return LeftOut(name, Message("Profiles of the snow"), Message("no recording is used"))
    sites = sorted({site for site, _ in profiles} | samples.keys())
    colours = {site: style.COLOURS[place % len(style.COLOURS)] for place, site in enumerate(sites)}
    lines = [(colours[site], profile) for site, profile in profiles]
    panels = [
        (key, label) for key, label in _PANELS
        if any(np.isfinite(getattr(profile, key)).any() for _, profile in lines) or (samples and key == "snow_density")
    ]  # fmt: skip
    figure = style.new_figure(width_mm=max(85.0, 60.0 * len(panels)), height_mm=100.0)
    every = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for axes, (key, label) in zip(every, panels, strict=True):
        for colour, profile in lines:
            values = getattr(profile, key)  # a force in the noise of the air has no place on a logarithmic axis
            positive = np.where(values > 0.0, values, np.nan)
            axes.plot(positive, profile.depth / MM, color=colour, linewidth=0.6, alpha=0.8)
        for site, (depth, density) in samples.items() if key == "snow_density" else ():
            axes.plot(density, depth / MM, "o-", color=colours[site], markersize=3.0, linewidth=0.8)
        axes.set_xlabel(label)
    forces = np.concatenate([profile.force for _, profile in lines] or [np.ones(1)])
    if style.spans_a_decade(forces):
        style.logarithmic(every[0], "x", forces)
    every[0].set_ylabel(Message("depth below the snow surface (mm)"))
    depths = [profile.depth for _, profile in lines] + [depth for depth, _ in samples.values()]
    every[0].set_ylim(1.03 * float(np.concatenate(depths).max()) / MM, 0.0)
    style.legend_below(figure, [Line2D([], [], color=colours[site], label=figure_text(site)) for site in sites])
    style.mark_synthetic(data, every[-1])
    caption = prose("Profiles over the depth below the snow surface, by site; points are samples of the density.")
    if profiles and pen is not None:
        caption += prose(
            " SnowMicroPen: force, density and specific surface area in overlapping windows. Density and surface area "
            "by {relation}, which was fitted to ungroomed snow.",
            relation=pen.recordings.settings.relation,
        )
    alt = Message("Force, density and specific surface area against depth, one line for each recording or pit.")
    return Drawing(name, caption, alt, figure, wide=len(panels) > 1)


def _samples_by_site(samples: DensitySamples | None) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Depths in rising order, and densities, of the samples of each site that have a depth."""
    if samples is None:
        return {}
    place, site = samples.in_profile, np.array(samples.site)
    by_site = {}
    for name in sorted(set(site[place].tolist())):
        rows = np.flatnonzero(place & (site == name))
        rows = rows[np.argsort(samples.sample_depth[rows])]
        by_site[name] = samples.sample_depth[rows], samples.snow_density[rows]
    return by_site


MOST_GROUPS: Final = 12
TOO_FEW: Final = Message("the series are too few, or all at one edge angle")


def residuals(data: ReportData, styles: Sequence[style.SiteStyle]) -> Drawing | LeftOut:  # noqa: ARG001
    """Force of the selected model minus applied load, with median and 90 % range along the load."""
    name, title, penetration = "residuals", Message("Residuals of the selected law"), data.analysis.penetration
    if penetration is None or penetration.table is None:
        return LeftOut(name, title, Message("no penetration experiment is used"))
    if penetration.selected is None:
        return LeftOut(name, title, TOO_FEW)
    readings = penetration.readings.of(penetration.screened.used)
    selected = penetration.selected
    hardness = penetration.hardness[selected.model.hardness].value[penetration.screened.used]
    angle = readings.edge_angle[readings.series]
    # a slope that the angles do not determine is NaN and counts as 0
    a, b = selected.a0 + np.nan_to_num(selected.a1) * angle, selected.b0 + np.nan_to_num(selected.b1) * angle
    force = hardness[readings.series] * (a * readings.contact_area + b * readings.displaced_volume)
    residual = force - readings.load
    figure = style.new_figure(height_mm=62.0)
    axes = figure.add_subplot()
    axes.axhline(0.0, color=style.GREY, linewidth=0.6, zorder=1)
    part = style.thinned(readings.n)
    axes.plot(
        readings.load[part], residual[part], ".", markersize=3.0, markeredgewidth=0.0, color=style.PALE, zorder=2,
        rasterized=readings.n > style.RASTERISE_FROM,
    )  # fmt: skip
    _draw_ranges_by_load(axes, readings.load, residual)
    axes.set_xlabel(Message("load $F$ (N)"))
    axes.set_ylabel(Message("law − load (N)"))
    axes.set_xlim(0.0, float(readings.load.max()) * 1.05)
    style.mark_synthetic(data, axes)
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
    return Drawing(name, caption, alt, figure, points=readings.n)


def _draw_ranges_by_load(axes: Axes, load: FloatArray, residual: FloatArray) -> None:
    """Draw median, mean and 5 to 95 % range of the residuals for each group of loads (N)."""
    values = np.unique(load)
    edges = values if len(values) <= MOST_GROUPS else np.unique(np.quantile(load, np.arange(MOST_GROUPS) / MOST_GROUPS))
    group = np.searchsorted(edges, load, side="right") - 1
    for index in range(len(edges)):
        part = residual[group == index]
        place = float(np.median(load[group == index]))
        low, middle, high = np.percentile(part, (5.0, 50.0, 95.0))
        axes.vlines(place, low, high, color=style.BLUE, linewidth=1.1, zorder=3)
        axes.plot([place], [middle], marker="o", color=style.BLUE, markersize=3.6, zorder=4)
        axes.plot(
            [place], [part.mean()], marker="_", color=style.VERMILLION, markersize=6.0, markeredgewidth=1.2, zorder=5
        )
