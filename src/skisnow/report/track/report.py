"""Report of a measured track: figures and track.json; and the figure of two compared tracks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray
from ..._support.messages import ENGLISH, Message, in_language
from ..._support.staging import require_writable, staged, write_file
from ...comparison import Comparison, Distances
from ...comparison.distances import DistanceStatistics, OffsetSeries
from ...track.course import CourseResult
from ...track.course.gates_table import gates_csv
from ...track.summary import TrackSummary, summary_dict
from ..figures import style
from ..figures.course import course_line
from ..figures.drawing import Drawing, Progress, picture_files, silent, write_pictures
from ..formatting import figure_text, json_text, prose, significant
from ..run.track_figure import plan_axes, plan_height_mm, track_limits
from .figures import LABELS, coloured_map, drawn_points, track_along, track_map
from .summary import GPX_FILE, POINTS_FILE, TITLES, TURNS_FILE, points_csv, track_gpx, turns_csv

FIGURES: Final = ("map", "speed", "radius", "along", "course")
"""Names of a track's figures, in figures/ as .png and .svg; the last one only with gates."""


def write_track_report(
    summary: TrackSummary,
    folder: str | Path,
    *,
    values: Mapping[str, Any] | None = None,
    gates: CourseResult | None = None,
    language: str = ENGLISH,
    progress: Progress = silent,
) -> Path:
    """Write figures, track.json, turns.csv, points.csv, and track.gpx of a track with latitude and longitude.

    summary: result of `skisnow.track.summary.track_summary`.
    folder: output folder, created if necessary; other files in it stay.
    values: contents of track.json (default: those of `summary_dict`).
    gates: passages of a course; adds gates.csv and figures/course, the line over the gates coloured by speed.
    language: language of the figures (en, de).
    progress: callback for progress messages.
    Returns: Path of track.json, which is written last.
    Raises OutputError: a file cannot be written.
    """
    folder = Path(folder)
    require_writable(folder)
    text = json_text(summary_dict(summary) if values is None else values)
    with staged(folder, last="track.json") as stage:
        stage.stale += [*picture_files(FIGURES), "gates.csv", GPX_FILE]
        tables = {TURNS_FILE: turns_csv(summary), POINTS_FILE: points_csv(summary), GPX_FILE: track_gpx(summary)}
        for name, content in tables.items():
            if content is not None:
                write_file(stage.path / name, content)
        if gates is not None:
            write_file(stage.path / "gates.csv", gates_csv(gates))
        with in_language(language):
            write_pictures(track_drawings(summary, gates), stage.path / "figures", progress=progress)
        write_file(stage.path / "track.json", f"{text}\n")
    return folder / "track.json"


def track_drawings(summary: TrackSummary, gates: CourseResult | None = None) -> Iterator[Drawing]:
    """All figures in order; each is drawn when it is requested, so that it gets the style in force."""
    name = summary.track.name
    caption = prose("{name} from above, the same scale along both axes.", name=name)
    yield Drawing("map", caption, Message("{name} from above.", name=name), track_map(summary), wide=True)
    caption = prose("{name} from above; colour: speed.", name=name)
    alt = Message("{name} from above, coloured by speed.", name=name)
    yield Drawing("speed", caption, alt, coloured_map(summary, "speed"), wide=True)
    caption = prose("{name} from above; colour: turn radius, even in 1/radius, positive to the left.", name=name)
    alt = Message("{name} from above, coloured by turn radius.", name=name)
    yield Drawing("radius", caption, alt, coloured_map(summary, "radius"), wide=True)
    caption = prose(
        "Speed, height and turn radius along {name}. The axis of the radius is even in 1/radius: straight is in the "
        "middle. The smoothing keeps half of an oscillation of the curvature with a period of {half:.2g} s.",
        name=name,
        half=summary.motion.smoothed.resolution.half_period,
    )
    if summary.max_speed_interval is not None and summary.distance_interval is not None:
        (slow, fast), (short, long) = summary.max_speed_interval, summary.distance_interval
        caption += prose(
            " Highest speed: {speed:.4g} m/s (95 % interval {slow:.4g} to {fast:.4g} m/s); length: {length:.5g} m "
            "({short:.5g} to {long:.5g} m).",
            speed=summary.max_speed, slow=slow, fast=fast, length=summary.distances["places"], short=short, long=long,
        )  # fmt: skip
    alt = Message("Speed, height and turn radius along {name}.", name=name)
    yield Drawing("along", caption, alt, track_along(summary), wide=True)
    if gates is not None:
        caption = prose("The line of {name} over the course, from above; colour: speed.", name=name)
        alt = Message("Line of {name} over the gates, coloured by speed.", name=name)
        place, speed = summary.track.place[summary.track.usable], summary.motion.speed[summary.track.usable]
        figure = course_line(gates, place, speed, label=Message("speed (m/s)"), diverging=False)
        yield Drawing("course", caption, alt, figure, wide=True)


MEASURED: Final[dict[str, Any]] = {"color": style.BLACK, "linewidth": 1.1}
SIMULATED: Final[dict[str, Any]] = {"color": style.VERMILLION, "linewidth": 1.1, "linestyle": (0, (5, 1.5))}
BEFORE: Final[dict[str, Any]] = {"color": style.PALE, "linewidth": 0.8}
LINE_STYLES: Final[dict[str, dict[str, Any]]] = {
    "nearest": {"color": style.BLUE, "linestyle": "-"},
    "arc_length": {"color": style.GREEN, "linestyle": (0, (5, 1.5))},
    "time": {"color": style.PURPLE, "linestyle": (0, (1, 1))},
}
EXACTNESS: Final = 1e-6  # distance (m) below which two places are equal
_HIDES: Final = 20.0
_MARGIN: Final = 0.02
_DISTANCES_MM: Final = 58.0
_FRAME_MM: Final = 34.0


def track_comparison(comparison: Comparison) -> Figure:
    """Draw both tracks from above, and the three distances along the measured one with marked maxima."""
    lines = [comparison.measured, comparison.simulated]
    if comparison.fitted is not None:
        lines.append(comparison.fitted.before.simulated)
    points = np.concatenate([line.place[:, :2] for line in lines])
    limits = track_limits(points, margin=0.6 + _MARGIN * float(np.ptp(points, axis=0).max()))
    height = plan_height_mm(limits)
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=height + _DISTANCES_MM + _FRAME_MM)
    grid = figure.add_gridspec(2, 1, height_ratios=(height + 10.0, _DISTANCES_MM))
    plan = figure.add_subplot(grid[0])
    _draw_plan(plan, comparison)
    plan_axes(plan, limits, labels=None if comparison.axes == "slope" else LABELS[comparison.axes])
    _draw_distances(figure.add_subplot(grid[1]), comparison)
    style.legend_below(figure, _legend_handles(comparison))
    return figure


def comparison_drawing(comparison: Comparison) -> Drawing:
    """Figure that compares two tracks from above and by their distance, with its caption."""
    names = dict(zip(("simulated", "measured"), comparison.names, strict=True))
    caption = prose("{simulated} and {measured} from above, and the distance between them along the latter.", **names)
    alt = Message("{simulated} and {measured} from above, and the distance between them.", **names)
    return Drawing("track_comparison", caption, alt, track_comparison(comparison), wide=True)


def _draw_plan(axes: Axes, comparison: Comparison) -> None:
    """Draw both tracks from above, the one before a fit, and a line at each maximum distance."""
    if comparison.fitted is not None:
        before = comparison.fitted.before.simulated.place
        axes.plot(*_thinned(before[:, 0], before[:, 1]), **BEFORE)
    for line, line_style in ((comparison.measured, MEASURED), (comparison.simulated, SIMULATED)):
        axes.plot(*_thinned(line.place[:, 0], line.place[:, 1]), **line_style)
        axes.plot(*line.place[0, :2], marker="o", markersize=3.2, linestyle="none", color=line_style["color"])
        axes.plot(*line.place[-1, :2], marker="s", markersize=3.2, linestyle="none", color=line_style["color"])
    for apart, _, line_style in _computed_distances(comparison):
        largest = int(np.nanargmax(apart.distance))  # a line between both places of the maximum distance
        own = comparison.measured.at_arc_length(apart.arc_length[[largest]])[0, :2]
        ends = np.stack([own, own + apart.offset[largest, :2]])
        axes.plot(*ends.T, color=line_style["color"], linewidth=1.4, solid_capstyle="butt", zorder=4)


def _computed_distances(
    comparison: Comparison,
) -> Iterator[tuple[OffsetSeries, DistanceStatistics, dict[str, Any]]]:
    """Offsets, statistics and line style of each definition of distance that could be computed."""
    for kind, line_style in LINE_STYLES.items():
        distances: Distances = getattr(comparison, kind)
        if distances.numbers is not None and distances.apart is not None:
            yield distances.apart, distances.numbers, line_style


def _draw_distances(axes: Axes, comparison: Comparison) -> None:
    """Draw the distances along the measured track (m), on a logarithmic scale if their maxima differ much."""
    largest = []
    for apart, numbers, line_style in _computed_distances(comparison):
        axes.plot(*_thinned(apart.arc_length, apart.distance), **line_style)
        dot = {"color": line_style["color"], "marker": "o", "markersize": 3.0, "linestyle": "none"}
        axes.plot(numbers.max_at, numbers.max, clip_on=False, zorder=4, **dot)
        largest += [numbers.max] if numbers.max > EXACTNESS else []
    axes.set_xlim(0.0, comparison.measured.length)
    if largest and max(largest) > _HIDES * min(largest):
        axes.set_yscale("log")
        axes.set_ylim(0.01 * min(largest), 2.0 * max(largest))
        axes.yaxis.set_major_formatter(style.plain_number)
    else:
        axes.set_ylim(bottom=0.0)
    if comparison.axes != "slope":  # two files: both may be measured
        axes.set_xlabel(Message("distance along {track} (m)", track=figure_text(comparison.names[1], longest=40)))
        axes.set_ylabel(Message("distance between\nthe tracks (m)"))
    else:
        axes.set_xlabel(Message("distance along the measured track (m)"))
        axes.set_ylabel(Message("distance of the\nsimulated track (m)"))


def _thinned(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Evenly spaced points (x, y) of a long line; all points of a short one."""
    chosen = drawn_points(0, len(x) - 1)
    return x[chosen], y[chosen]


FITTED: Final = {"start": Message("start"), "heading": Message("heading"), "time": Message("time")}


def _legend_handles(comparison: Comparison) -> list[Line2D]:
    """Legend entries of both tracks, of the fit, and of each definition with its maximum."""
    simulated, measured = (figure_text(name, longest=40) for name in comparison.names)
    label: str = Message("simulated: {simulated}", simulated=simulated)
    if comparison.fitted is not None:
        what = [FITTED.get(name, name) for name in comparison.fitted.what]
        label = Message("simulated: {simulated}, {fitted} fitted", simulated=simulated, fitted=what)
    elif comparison.axes != "slope":
        label = simulated
    own = measured if comparison.axes != "slope" else Message("measured: {measured}", measured=measured)
    handles = [Line2D([], [], label=own, **MEASURED), Line2D([], [], label=label, **SIMULATED)]
    if comparison.fitted is not None:
        handles.append(Line2D([], [], label=Message("simulated, before the fit"), **BEFORE))
    for kind, line_style in LINE_STYLES.items():
        numbers, text = getattr(comparison, kind).numbers, Message("none")
        if numbers is not None:
            text = Message("maximum {distance} m", distance=significant(numbers.max))
        handles.append(Line2D([], [], label=f"{TITLES[kind]}: {text}", **line_style))
    return handles
