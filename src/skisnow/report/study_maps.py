"""Maps of a study: grip limit over edge angle and load, and turn radius over edge angle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .._support.messages import Message
from .._support.units import DEGREE
from ..studies import StudyTable
from .figures.style import BLACK, BLUE, COLOURS, GREY, MARKERS, VERMILLION, legend_below, logarithmic, plain_number
from .study_layout import MOST_LINES, Json, MapLayout, drawn_table, empty_map, label, lines_of, map_layout, short

LEVELS: Final = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)
"""Grip utilisations at which the colour changes; at 1 the edge loses grip."""
_COLOURS: Final = ("#2166AC", "#5E9BC9", "#A6CDE3", "#DDEBF3", "#FBE3D0", "#F4B183", "#DD7F4B", "#B8431C")
_LOG_FROM: Final = 20.0  # ratio of the largest to the smallest value of an input from which its axis is logarithmic
_LEAST: Final = 1e-3  # a flat ski draws no side force; its logarithm must exist


def grip_map(table: StudyTable) -> Figure:
    """Draw the grip utilisation, and the line at which the edge loses grip.

    Raises ParameterError: no number of the table varies, or the map would have too many panels.
    """
    layout = map_layout(table, second_is_number=True)
    table = drawn_table(table)
    ordinate = Message("side force / limit") if layout.second is None else label(layout.second)
    figure, panels = empty_map(table, layout, ordinate, row_mm=(70.0, 50.0))
    every = [axes for axes, _ in panels]
    for axes, rows in panels:
        if layout.second is None:
            _draw_share_lines(axes, rows, layout)
        else:
            if not layout.sampled:
                _draw_field(axes, rows, layout)
            _draw_points(axes, rows, layout)
    _set_scales(every[0], table.rows, layout.x, layout.second)
    if layout.second is None:
        shares = np.array([share_of_limit(row) for row in table.rows])
        every[0].set_ylim(0.0, 1.08 * float(shares[np.isfinite(shares)].max(initial=1.0)))
    else:
        for axes in every:  # room for the symbols at the rim
            axes.use_sticky_edges = False
            axes.margins(0.03)
    if layout.second is not None and not layout.sampled:
        bounds = [LEVELS[0] / 2.0, *LEVELS, LEVELS[-1] * 2.0]
        scale = ScalarMappable(BoundaryNorm(bounds, len(_COLOURS)), ListedColormap(_COLOURS))
        bar = figure.colorbar(scale, ax=every, pad=0.01, aspect=35, spacing="uniform")
        bar.set_ticks(list(LEVELS), labels=[plain_number(level) for level in LEVELS])
        bar.set_label(Message("side force / shear capacity"))
        bar.ax.axhline(1.0, color=BLACK, linewidth=1.8)
    for axes, rows in panels:
        axes.legend(handles=_grip_handles(layout, rows), loc="best", fontsize=5.5, frameon=True, framealpha=0.9)
    return figure


def share_of_limit(row: Json) -> float:
    """Side force divided by its limit, the shear capacity; NaN without an equilibrium."""
    force, limit = row["side_force_N"], row["side_force_limit_N"]
    if force is None or limit is None:
        return float("nan")
    if force == 0.0:
        return 0.0
    return float(force / limit) if limit > 0.0 else float("inf")


def _draw_field(axes: Axes, rows: Sequence[Json], layout: MapLayout) -> None:
    """Fill areas by the side force's share of its limit on a grid, with a line where it is 1."""
    second = str(layout.second)
    x, y = (np.array(sorted({float(row[name]) for row in rows})) for name in (layout.x, second))
    share = np.full((len(y), len(x)), np.nan)
    for row in rows:
        share[np.searchsorted(y, row[second]), np.searchsorted(x, row[layout.x])] = share_of_limit(row)
    logarithm = np.log(np.clip(share, _LEAST, 1.0 / _LEAST))
    bounds = np.log([_LEAST / 10.0, *LEVELS, 10.0 / _LEAST])
    axes.contourf(x, y, logarithm, levels=bounds, colors=_COLOURS, zorder=0)
    if np.nanmin(logarithm) < 0.0 < np.nanmax(logarithm):
        axes.contour(x, y, logarithm, levels=[0.0], colors=[BLACK], linewidths=1.8, zorder=2)


def _draw_points(axes: Axes, rows: Sequence[Json], layout: MapLayout) -> None:
    """Draw a mark for each row: holds, slips, or no equilibrium."""
    for holds, look in _marker_styles(layout.sampled).items():
        chosen = [row for row in rows if row["holds"] is holds]
        x, y = _numbers(chosen, layout.x), _numbers(chosen, str(layout.second))
        axes.plot(x, y, linestyle="none", zorder=3, **look)


def _marker_styles(sampled: bool) -> dict[bool | None, dict[str, Any]]:
    """Marker style by `holds`: True, False, or None without an equilibrium; larger for samples."""
    size = 3.6 if sampled else 2.4
    return {
        True: {"marker": "o", "color": BLUE, "markersize": size},
        False: {"marker": "^", "color": VERMILLION, "markerfacecolor": "white", "markersize": size + 0.6},
        None: {"marker": "x", "color": GREY, "markersize": size},
    }


def _draw_share_lines(axes: Axes, rows: Sequence[Json], layout: MapLayout) -> None:
    """Draw the share of the limit over one input, with a line at 1."""
    ordered = sorted(rows, key=lambda row: float(row[layout.x]))
    axes.plot([row[layout.x] for row in ordered], [share_of_limit(row) for row in ordered], color=GREY, zorder=1)
    for holds, look in _marker_styles(True).items():
        chosen = [row for row in ordered if row["holds"] is holds]
        axes.plot(_numbers(chosen, layout.x), list(map(share_of_limit, chosen)), linestyle="none", **look)
    axes.axhline(1.0, color=BLACK, linewidth=1.8, zorder=2)


def _set_scales(axes: Axes, rows: Sequence[Json], x: str, y: str | None) -> None:
    """Set logarithmic axes of inputs other than an angle whose values are positive and span a large factor."""
    for which, name in (("x", x), ("y", y)):
        if name not in (None, "edge_angle_deg"):
            values = _numbers(rows, str(name))
            if values.min() > 0 and values.max() > _LOG_FROM * values.min():
                logarithmic(axes, which, values)


def _grip_handles(layout: MapLayout, rows: Sequence[Json]) -> list[Line2D]:
    """Legend entries of the marks that occur, and of the limit if it is crossed."""
    texts = {True: Message("holds"), False: Message("slips"), None: Message("no equilibrium")}
    handles = [
        Line2D([], [], linestyle="none", label=texts[holds], **line_style)
        for holds, line_style in _marker_styles(layout.sampled).items()
        if any(row["holds"] is holds for row in rows)
    ]
    if not layout.sampled and len({row["holds"] for row in rows} - {None}) > 1:
        handles.append(Line2D([], [], color=BLACK, linewidth=1.8, label=Message("the edge loses grip")))
    return handles


RADIUS: Final = "turn_radius_boot_m"


def radius_map(table: StudyTable) -> Figure:
    """Draw the radius of the circle at the boot; filled symbols: the edge holds, open: it slips.

    Raises ParameterError: no number of the table varies, or the map would have too many panels.
    """
    layout = map_layout(table, second_is_number=False)
    table = drawn_table(table)
    scale = _colour_scale(layout, table.rows)
    ordinate = Message("turn radius (m):\ncircle through boot and ±0.4 m")
    figure, panels = empty_map(table, layout, ordinate, row_mm=(75.0, 52.0))
    values = [value for value, _ in lines_of(table.rows, layout.second)]
    for axes, rows in panels:
        if layout.x == "edge_angle_deg":
            _draw_sidecut(axes, rows)
        if _has_lines(layout, values):
            _draw_lines(axes, rows, layout, values)
        else:
            _draw_cloud(axes, rows, layout, scale)
    _set_scales(panels[0][0], table.rows, layout.x, None)
    radii = _numbers(table.rows, RADIUS)
    if np.isfinite(radii).any():
        panels[0][0].set_ylim(0.0, 1.08 * float(np.nanmax(radii)))
    if scale is not None and not _has_lines(layout, values):
        figure.colorbar(scale, ax=figure.axes, label=label(str(layout.second)), pad=0.01, aspect=40)
    legend_below(figure, _radius_handles(layout, values, table.rows))
    return figure


def _has_lines(layout: MapLayout, values: list[Any]) -> bool:
    """True if the radius is drawn as lines: the table is no sample and has few values of the second input."""
    return not layout.sampled and len(values) <= MOST_LINES


def _draw_lines(axes: Axes, rows: Sequence[Json], layout: MapLayout, values: list[Any]) -> None:
    """Draw the radius over the first input, one line per value of the second; open marks slip."""
    for value, of_line in lines_of(rows, layout.second):
        look = _line_look(values.index(value))
        ordered = sorted(of_line, key=lambda row: float(row[layout.x]))
        x, y = _numbers(ordered, layout.x), _numbers(ordered, RADIUS)
        axes.plot(x, y, color=look["color"], linewidth=0.8, zorder=2)
        for holds, face in ((True, look["color"]), (False, "white")):
            chosen = np.array([row["holds"] is holds for row in ordered], dtype=bool)
            axes.plot(x[chosen], y[chosen], linestyle="none", markerfacecolor=face, zorder=3, **look)


def _line_look(place: int) -> dict[str, Any]:
    """Colour and marker of a line by its number, repeating after the last one."""
    return {"color": COLOURS[place % len(COLOURS)], "marker": MARKERS[place % len(MARKERS)]}


def _colour_scale(layout: MapLayout, rows: Sequence[Json]) -> ScalarMappable | None:
    """Colours of the second input, for a sample or too many values for lines; None if no second number varies."""
    values = [] if layout.second is None else [row[layout.second] for row in rows]
    if not values or isinstance(values[0], str | bool):
        return None
    return ScalarMappable(Normalize(min(values), max(values)), "cividis")


def _draw_cloud(axes: Axes, rows: Sequence[Json], layout: MapLayout, scale: ScalarMappable | None) -> None:
    """Draw the radius as points, coloured by the second input if there is a scale; crosses slip."""
    for holds, marker in ((True, "o"), (False, "X")):
        chosen = [row for row in rows if row["holds"] is holds]
        x, y = _numbers(chosen, layout.x), _numbers(chosen, RADIUS)
        if scale is None:
            axes.scatter(x, y, color=BLUE, marker=marker, s=12, linewidths=0)
        else:
            shade = _numbers(chosen, str(layout.second))
            low, high = scale.get_clim()
            axes.scatter(x, y, c=shade, vmin=low, vmax=high, cmap=scale.cmap, marker=marker, s=12, linewidths=0)


def _draw_sidecut(axes: Axes, rows: Sequence[Json]) -> None:
    """Draw R_sc cos ϑ, the radius of a ski that is bent onto a hard plane without twist."""
    radii = {row["sidecut_radius_of_three_widths_m"] for row in rows} - {None}
    ends = [float(row["edge_angle_deg"]) for row in rows]
    angle = np.linspace(min(ends), max(ends), 91)
    for radius in radii:
        axes.plot(angle, radius * np.cos(angle * DEGREE), color=GREY, linestyle=(0, (1, 1.2)), linewidth=0.9, zorder=1)


def _radius_handles(layout: MapLayout, values: list[Any], rows: Sequence[Json]) -> list[Line2D]:
    """Legend entries of lines and marks that occur, and of sidecut radius × cos ϑ over the edge angle."""
    handles = []
    lined = _has_lines(layout, values)
    if lined and layout.second is not None:
        handles = [
            Line2D([], [], linewidth=0.8, label=short(layout.second, value), **_line_look(place))
            for place, value in enumerate(values)
        ]
    slips = {"marker": "o", "markerfacecolor": "white"} if lined else {"marker": "X"}
    texts: tuple[tuple[bool, str, dict[str, Any]], ...] = (
        (True, Message("holds"), {"marker": "o"}),
        (False, Message("slips: radius of an edge held by something else"), slips),
    )
    for value, text, look in texts:
        if any(row["holds"] is value and row[RADIUS] is not None for row in rows):
            handles.append(Line2D([], [], linestyle="none", color=GREY, label=text, **look))
    if layout.x == "edge_angle_deg":
        text = Message("sidecut radius × cos ϑ")
        handles.append(Line2D([], [], color=GREY, linestyle=(0, (1, 1.2)), linewidth=0.9, label=text))
    return handles


def _numbers(rows: Sequence[Json], name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Column of the rows, shape (n,), NaN for None."""
    return np.array([row[name] for row in rows], dtype=float)
