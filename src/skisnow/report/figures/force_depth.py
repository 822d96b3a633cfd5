"""Fig 5 of the paper: loads against depths of the flat and of one edged tool, with the law of each series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from ...geometry import in_form
from ...units import MM
from ..curves import law_of_series
from ..number_formatting import whole
from ..symbols import prose
from .drawing import Drawing, LeftOut
from .style import (
    DOUBLE_MM,
    SINGLE_MM,
    legend_below,
    logarithmic,
    mark_synthetic,
    masks,
    new_figure,
    scatter,
    spans_a_decade,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markupsafe import Markup
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from ...field.records import PenetrationTests
    from ..report_data import FloatArray, ReportData
    from .style import SiteStyle

NAME: Final = "fig05_force_depth"
MOST_SERIES: Final = 40
"""Series in one panel; of more, as many are drawn, evenly spaced in the rank of their hardness."""


def force_depth(data: ReportData, styles: Sequence[SiteStyle]) -> Drawing | LeftOut:
    """Readings as points, F = H_V V as a line for each series."""
    tests = data.campaign.penetration
    angles = shown_angles(data)
    if tests is None or not angles:
        return LeftOut(NAME, "Load against penetration depth", "no penetration experiment is used")
    figure = new_figure(width_mm=DOUBLE_MM if len(angles) > 1 else SINGLE_MM, height_mm=80.0)
    panels = figure.subplots(1, len(angles), squeeze=False, sharey=True)[0]
    handles: dict[str, Line2D] = {}
    members = [_members(data, angle) for angle in angles]
    drawn = [_spread(of_angle, data) for of_angle in members]
    counts = [(angle, len(some), len(every)) for angle, some, every in zip(angles, drawn, members, strict=True)]
    deepest = [np.array([tests.series(i).penetration_depth.max() for i in some]) for some in drawn]
    wide_range = any(spans_a_decade(depths) for depths in deepest)
    for panel, angle, chosen in zip(panels, angles, drawn, strict=True):
        for handle in _panel(panel, data, tests, chosen, styles, wide_range=wide_range):
            handles.setdefault(str(handle.get_label()), handle)
        panel.set_title(_angle_name(angle), loc="left")
    panels[0].set_ylabel("load $F$ (N)")
    mark_synthetic(data, panels[-1])
    legend_below(figure, [handles[style.label] for style in styles if style.label in handles])
    elsewhere = int(data.penetration_used.sum()) - sum(len(every) for every in members)
    caption = _caption(counts, elsewhere, wide_range=wide_range)
    return Drawing(NAME, caption, _alt(counts), figure, wide=len(angles) > 1)


def shown_angles(data: ReportData) -> list[float]:
    """The flat tool and the most frequent edge angle (degrees) of the used experiments."""
    angles = np.array([row["edge_angle_deg"] for row in data.penetration], dtype=float)[data.penetration_used]
    edged, counts = np.unique(angles[angles > 0], return_counts=True)
    # of equally frequent angles the one nearest to the paper's 45°
    best = sorted(zip(-counts, np.abs(edged - 45.0), edged, strict=True))[:1]
    return ([0.0] if np.any(angles == 0) else []) + [float(angle) for _, _, angle in best]


def _angle_name(angle: float) -> str:
    return "ϑ = 0°" if angle == 0 else f"edged, ϑ = {angle:.4g}°"


def _members(data: ReportData, angle: float) -> list[int]:
    return [i for i, row in enumerate(data.penetration) if row["used"] and row["edge_angle_deg"] == angle]


def _spread(members: list[int], data: ReportData) -> list[int]:
    if len(members) <= MOST_SERIES:
        return members
    by_hardness = sorted(members, key=lambda index: data.penetration[index]["H_V_N_per_mm3"])
    places = np.linspace(0, len(members) - 1, MOST_SERIES).round().astype(int)
    return [by_hardness[place] for place in places]


def _panel(
    panel: Axes,
    data: ReportData,
    tests: PenetrationTests,
    chosen: list[int],
    styles: Sequence[SiteStyle],
    *,
    wide_range: bool,
) -> list[Line2D]:
    depth = np.concatenate([tests.series(i).penetration_depth for i in chosen]) / MM
    load = np.concatenate([tests.series(i).load for i in chosen])
    site = np.repeat([tests.site[i] for i in chosen], [len(tests.series(i).load) for i in chosen])
    for style, mask in masks(styles, np.array([tests.site[i] for i in chosen])):
        for index in np.array(chosen)[mask].tolist():
            e, F = _law(data, tests, index, wide_range)
            panel.plot(e, F, color=style.colour, linewidth=0.6, alpha=0.75, zorder=2)
    handles = scatter(panel, depth, load, site, styles, size=3.0)
    if wide_range:
        logarithmic(panel, "x", depth)
        logarithmic(panel, "y", load)
    else:
        panel.set_xlim(0.0, float(depth.max()) * 1.05)
        panel.set_ylim(0.0, float(load.max()) * 1.08)
    panel.set_xlabel("penetration depth $e$ (mm)")
    return handles


def _law(data: ReportData, tests: PenetrationTests, index: int, wide_range: bool) -> tuple[FloatArray, FloatArray]:
    series, found = tests.series(index), data.analysis.penetration
    assert found is not None  # there are tests
    deepest = float(series.penetration_depth.max())
    e = np.geomspace(deepest * 1e-3, deepest, 60) if wide_range else np.linspace(0.0, deepest, 60)
    tool = in_form(data.campaign.tools[series.tool], data.geometry)
    return law_of_series(tool, series.edge_angle, float(found.hardness["H_V"].value[index]), e)


def _caption(counts: list[tuple[float, int, int]], elsewhere: int, *, wide_range: bool) -> Markup:
    panels = "; ".join(
        f"{whole(shown)} of {whole(total)} ({_angle_name(angle)})"
        + (", evenly spaced in the rank of their hardness" if shown < total else "")
        for angle, shown, total in counts
    )
    return prose(
        "Load against penetration depth (the paper's Fig. 5). Symbols: readings by site; lines: F = H_V V with each "
        "series' own H_V, which meets the reading under the largest load by definition. Series shown: "
        "{panels}.{others}{axes}",
        panels=panels,
        others=f" Series at other edge angles, not shown: {whole(elsewhere)}." if elsewhere else "",
        axes=" Both axes are logarithmic, as the depths span more than a decade: the law is a straight line there, of "
        "slope 1 for a flat tool and 2 for a wedge; readings of depth 0 have no place on them."
        if wide_range
        else "",
    )


def _alt(counts: list[tuple[float, int, int]]) -> str:
    angles = " and ".join(_angle_name(angle) for angle, _, _ in counts)
    return (
        f"Scatter of load in newtons against penetration depth in millimetres, {angles}, with a fitted law per series."
    )
