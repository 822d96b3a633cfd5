"""Figure of one or several skis in snow: edge depth, force per length, deflection, twist, plan."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .._support.arrays import FloatArray
from .._support.messages import Message, outcome_words
from .._support.units import MM
from .figures.style import BLACK, DOUBLE_MM, GREY, PALE, legend_below, line_style, new_figure
from .formatting import figure_text, significant
from .summaries import Json, answers_of, ski_titles

_PANELS: Final = (
    ("edge_depth_mm", Message("edge depth $e$ (mm)")),
    ("force_per_length_N_per_m", Message("normal force\nper length (N/m)")),
    ("bending_mm", Message("deflection (mm)")),
    ("twist_deg", Message("twist (°)")),
)
BOOT_REACH: Final = 0.4  # distance (m) before and behind the boot at which the first circle meets the edge line
_BOOT_CIRCLE: Final = (0, (4, 1.5))
_CHORD_CIRCLE: Final = (0, (1, 1))


def carved_skis(contents: Json) -> Figure:
    """Draw the answers of `skisnow carve`, one colour and line style for each ski.

    contents: JSON of `skisnow.carving.answer.answers_dict`.
    """
    answers = answers_of(contents)
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=150.0)
    grid = figure.add_gridspec(3, 2, height_ratios=(1.0, 1.0, 1.15))
    first: Axes | None = None
    for place, (key, label) in enumerate(_PANELS):
        axes = figure.add_subplot(grid[place // 2, place % 2], sharex=first)
        first = first or axes
        _draw_along_ski(axes, answers, key, label)
    _draw_plan(figure.add_subplot(grid[2, :], sharex=first), answers)
    figure.suptitle(_inputs_in_words(answers[0]), x=0.01, ha="left", fontsize=8.0)
    handles = []
    for place, (title, answer) in enumerate(zip(ski_titles(answers), answers, strict=True)):
        outcome = "" if answer["outcome"] == "equilibrium" else f" ({outcome_words(answer['outcome'])})"
        handles.append(Line2D([], [], label=figure_text(title) + outcome, **line_style(place)))
    circles = (
        (Message("circle through boot and {reach} m to each side", reach=BOOT_REACH), _BOOT_CIRCLE),
        (Message("through boot and ends of contact"), _CHORD_CIRCLE),
    )
    handles += [Line2D([], [], color=BLACK, linestyle=style, linewidth=0.9, label=label) for label, style in circles]
    legend_below(figure, handles)
    return figure


def _inputs_in_words(answer: Json) -> str:
    """Text of an answer's angle, load and snow; "At rest" or "Steady carve"."""
    inputs = answer["inputs"]
    words: list[str] = [
        Message("ϑ = {angle:g}°, load {load:g} N", angle=inputs["edge_angle_deg"], load=inputs["load_N"]),
        f"$H_V$ = {significant(inputs['H_V_N_per_mm3'])} N/mm³",
    ]
    if inputs["S_f_N_per_mm2"] is not None:
        words.append(f"$S_f$ = {significant(inputs['S_f_N_per_mm2'])} N/mm²")
    if inputs["unloading_ratio"] is not None and not inputs["at_rest"]:
        words.append(f"$k_u/H_V$ = {significant(inputs['unloading_ratio'])}")
    if inputs["at_rest"]:
        return Message("At rest: {inputs}", inputs=words)
    return Message("Steady carve: {inputs}", inputs=words)


def _draw_along_ski(axes: Axes, answers: list[Json], key: str, label: str) -> None:
    """Draw the values `key` of each answer along the ski, and the snow's surface for the edge depth."""
    for place, answer in enumerate(answers):
        if answer[key] is not None:
            axes.plot(answer["station_m"], np.array(answer[key], dtype=float), **line_style(place))
    axes.axhline(0.0, color=GREY, linewidth=0.6, zorder=1)
    axes.axvline(0.0, color=PALE, linewidth=0.5, zorder=0)
    axes.set_ylabel(label)
    axes.set_xlabel(Message("position along the ski (m), boot = 0"))
    if key != "edge_depth_mm":
        return
    # depth downwards, and a limited height above the snow, so that the groove stays visible
    depths = [depth for answer in answers for depth in answer["edge_depth_mm"] or () if depth is not None]
    deepest = max(depths, default=1.0)
    axes.set_ylim(1.15 * deepest, -min(0.6 * deepest, max(0.0, -min(depths, default=0.0)) + 0.08 * deepest))
    axes.annotate(
        Message("undisturbed surface"), (0.52, 0.0), xycoords=("axes fraction", "data"), xytext=(0, 2),
        textcoords="offset points", ha="left", fontsize=6.5, color=GREY,
    )  # fmt: skip


def _draw_plan(axes: Axes, answers: list[Json]) -> None:
    """Draw each ski's edge from above with the arcs of two definitions of the radius; the scales of the axes differ."""
    for place, answer in enumerate(answers):
        if answer["edge_line_mm"] is None:
            continue
        colour = line_style(place)["color"]
        station, line = np.asarray(answer["station_m"])[::-1], np.array(answer["edge_line_mm"], dtype=float)[::-1] * MM
        line -= np.interp(0.0, station, line)
        axes.plot(station, line / MM, color=colour, linewidth=3.0, alpha=0.35, solid_capstyle="butt")
        circles = []
        if answer["turn_radius_boot_m"] is not None:
            circles.append((_BOOT_CIRCLE, (-BOOT_REACH, BOOT_REACH)))
        if answer["turn_radius_chord_m"] is not None:
            circles.append((_CHORD_CIRCLE, contact_ends(answer)))
        for style, (rear, front) in circles:
            x, y = arc_through(station, line, rear, front)
            axes.plot(x, y / MM, color=colour, linestyle=style, linewidth=0.9)
    axes.axvline(0.0, color=PALE, linewidth=0.5, zorder=0)
    axes.set_xlabel(Message("position along the ski (m); boot = 0, tail left, tip right"))
    axes.set_ylabel(Message("edge towards the\ninside of the turn (mm)"))


def contact_ends(answer: Json) -> tuple[float, float]:
    """Rear and front station (m) at which the edge passes the undisturbed surface."""
    station, depth = np.asarray(answer["station_m"])[::-1], np.array(answer["edge_depth_mm"], dtype=float)[::-1]
    below = np.flatnonzero(depth > 0.0)
    rear, front = int(below[0]), int(below[-1])

    def crossing(inside: int, outside: int) -> float:
        if not 0 <= outside < len(depth):
            return float(station[inside])
        share = depth[inside] / (depth[inside] - depth[outside])
        return float(station[inside] + share * (station[outside] - station[inside]))

    return crossing(rear, rear - 1), crossing(front, front + 1)


def arc_through(station: FloatArray, line: FloatArray, rear: float, front: float) -> tuple[FloatArray, FloatArray]:
    """Arc through an edge line at three places: rear, boot (0) and front.

    station, line: line (m) with rising stations.
    rear, front: stations of the ends of the arc (m).
    Returns: points of the arc (m) from rear to front.

    The parabola x²/20 through 0 and ±1 is a circle of (1 + 0.05²)/(2 × 0.05) = 10.025 m:

    >>> along = np.linspace(-1.0, 1.0, 2001)
    >>> x, y = arc_through(along, along**2 / 20.0, -1.0, 1.0)
    >>> round(float(y[0]), 6), abs(float(np.hypot(x[0], y[0] - 10.025)) - 10.025) < 1e-9
    (0.05, True)
    """
    places = np.array([rear, 0.0, front])
    ends = np.interp(places, station, line)
    # x² + y² + D x + E y + F = 0 through the three points
    D, E, F = np.linalg.solve(np.column_stack([places, ends, np.ones(3)]), -(places**2) - ends**2)
    x = np.linspace(rear, front, 121)
    root = np.sqrt(np.maximum((E / 2.0) ** 2 - (x**2 + D * x + F), 0.0))
    return x, -E / 2.0 - np.copysign(root, -E)
