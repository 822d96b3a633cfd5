"""Figures of a turn: tracks of the ensemble with their bands, and the contacts side by side."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..._support.arrays import FloatArray, IntArray
from ..._support.messages import Message
from ..._support.units import MM
from ...comparison.distances import arc_lengths
from ...comparison.nearest_place import distance_from_path
from ...scenario import Plane
from ...simulation.run import Run
from ..figures import style
from ..formatting import figure_text
from ..run.track_figure import plan_axes, plan_height_mm, track_limits

QUANTILES: Final = (0.05, 0.25, 0.5, 0.75, 0.95)
FEWEST: Final = 3  # runs that make a band


@dataclass(frozen=True, slots=True, eq=False)
class TimedTrack:
    """A track from above: times (n,) rising (s), x and y (n,) (m)."""

    time: FloatArray
    x: FloatArray
    y: FloatArray


def track_band(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> Figure:
    """Draw the tracks from above, and the offsets of each run to the side of and ahead of the nominal run.

    nominal: run with the best values of the parameters.
    tracks: the ensemble, at least three. A run that ends earlier counts until its end.
    """
    aside, ahead = offsets(nominal, tracks)
    limits = track_limits(np.concatenate([np.stack([t.x, t.y], axis=1) for t in (nominal, *tracks)]))
    height = plan_height_mm(limits)
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=height + 78.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(height + 10.0, 50.0))
    plan = figure.add_subplot(grid[0, :])
    _draw_plan(plan, nominal, tracks, band_of(aside))
    plan_axes(plan, limits)
    labels = (Message("to the left of the nominal\nrun at the same time (m)"),
              Message("ahead of the nominal run\nat the same time (m)"))  # fmt: skip
    for column, (values, label) in enumerate(zip((aside, ahead), labels, strict=True)):
        _draw_over_time(figure.add_subplot(grid[1, column]), nominal.time, values, label)
    handles = [
        Line2D([], [], color=style.VERMILLION, label=Message("nominal run")),
        Line2D([], [], color=style.BLUE, linestyle=(0, (4, 1.5)), label=Message("median")),
        Line2D([], [], color=style.SKY, alpha=0.6, linewidth=5.0, label=Message("half of the runs")),
        Line2D([], [], color=style.PALE, alpha=0.6, linewidth=5.0, label=Message("90 % of the runs")),
        Line2D([], [], color=style.GREY, linewidth=0.5, label=Message("each of {count} runs", count=len(tracks))),
        Line2D([], [], color=style.BLACK, linestyle="none", marker=".", markersize=2.0, label=Message("end")),
    ]
    style.legend_below(figure, handles)
    return figure


def offsets(nominal: TimedTrack, tracks: Sequence[TimedTrack]) -> tuple[FloatArray, FloatArray]:
    """Offsets of tracks to the left and ahead of the nominal run at its times (m), each of shape (tracks, n).

    NaN after the end of a track.
    """
    direction = np.stack([np.gradient(nominal.x), np.gradient(nominal.y)], axis=1)
    length = np.linalg.norm(direction, axis=1)
    along = direction / np.where(length > 0.0, length, 1.0)[:, None]
    aside, ahead = [], []
    for track in tracks:
        dx = np.interp(nominal.time, track.time, track.x, right=np.nan) - nominal.x
        dy = np.interp(nominal.time, track.time, track.y, right=np.nan) - nominal.y
        ahead.append(dx * along[:, 0] + dy * along[:, 1])
        aside.append(dy * along[:, 0] - dx * along[:, 1])
    return np.array(aside), np.array(ahead)


def band_of(values: FloatArray) -> FloatArray:
    """The 5, 25, 50, 75 and 95 % quantiles of values (runs, n) at each time, (5, n); NaN with fewer than three runs."""
    band = np.full((len(QUANTILES), values.shape[1]), np.nan)
    enough = np.isfinite(values).sum(axis=0) >= FEWEST
    if enough.any():
        band[:, enough] = np.nanquantile(values[:, enough], QUANTILES, axis=0)
    return band


def _draw_plan(axes: Axes, nominal: TimedTrack, tracks: Sequence[TimedTrack], band: FloatArray) -> None:
    """Draw the tracks from above, with the band of the ensemble to the side of the nominal track."""
    slope = np.unwrap(np.arctan2(np.gradient(nominal.y), np.gradient(nominal.x)))
    to_left = np.stack([-np.sin(slope), np.cos(slope)], axis=1)
    outline = np.stack([nominal.x, nominal.y], axis=1) + band[:, :, None] * to_left  # shape (5, n, 2)
    for (low, high), colour in zip(((0, 4), (1, 3)), (style.PALE, style.SKY), strict=True):
        finite = np.isfinite(outline[low, :, 0])
        rim = np.concatenate([outline[low, finite], outline[high, finite][::-1]])
        axes.fill(rim[:, 0], rim[:, 1], color=colour, alpha=0.6, linewidth=0, zorder=1)
    for track in tracks:
        axes.plot(track.x, track.y, color=style.GREY, linewidth=0.3, zorder=2)
        axes.plot(track.x[-1], track.y[-1], marker=".", markersize=2.0, color=style.GREY, zorder=2)
    axes.plot(outline[2, :, 0], outline[2, :, 1], color=style.BLUE, linewidth=0.9, linestyle=(0, (4, 1.5)), zorder=3)
    axes.plot(nominal.x, nominal.y, color=style.VERMILLION, linewidth=1.0, zorder=4)


def _draw_over_time(axes: Axes, time: FloatArray, values: FloatArray, label: str) -> None:
    """Draw values of each run (runs, n) over time, with their band and a line at 0."""
    band = band_of(values)
    axes.plot(time, values.T, color=style.GREY, linewidth=0.3, zorder=2)
    axes.fill_between(time, band[0], band[4], color=style.PALE, alpha=0.6, linewidth=0, zorder=1)
    axes.fill_between(time, band[1], band[3], color=style.SKY, alpha=0.6, linewidth=0, zorder=1)
    axes.plot(time, band[2], color=style.BLUE, linewidth=0.9, linestyle=(0, (4, 1.5)), zorder=3)
    axes.axhline(0.0, color=style.VERMILLION, linewidth=0.8, zorder=3)
    style.label_time(axes, time)
    axes.set_ylabel(label)


_SYMBOL: Final = re.compile(r"(?<!\w)([A-Za-z])_([A-Za-z0-9])(?!\w)")


def draw_runs(runs: Mapping[str, Run]) -> Figure:
    """Draw runs on one slope by name: paths, distances from the first one, depths along the ski at one late time."""
    named = list(runs.items())
    limits = track_limits(np.concatenate([run.place for run in runs.values()]))
    height = plan_height_mm(limits)
    figure = style.new_figure(width_mm=style.DOUBLE_MM, height_mm=height + 90.0)
    grid = figure.add_gridspec(2, 2, height_ratios=(height + 10.0, 62.0))
    plan = figure.add_subplot(grid[0, :])
    for place, (_, run) in enumerate(named):
        plan.plot(run.place[:, 0], run.place[:, 1], **style.line_style(place))
        plan.plot(
            *run.place[-1, :2], marker="s", markersize=3.0, linestyle="none", color=style.line_style(place)["color"]
        )
    plan_axes(plan, limits, profile=not isinstance(named[0][1].scenario.slope, Plane))
    _draw_distances(figure.add_subplot(grid[1, 0]), named)
    moment = 0.9 * min(run.simulated_s for run in runs.values())
    _draw_depths(figure.add_subplot(grid[1, 1]), named, moment)
    style.legend_below(
        figure,
        [Line2D([], [], label=mathtext(name), **style.line_style(place)) for place, (name, _) in enumerate(named)],
    )
    return figure


def mathtext(name: str) -> str:
    """Name of a run for a figure, with markup for its symbols.

    >>> mathtext("hypoplastic, k_u / H_V = 10")
    'hypoplastic, $k_u$ / $H_V$ = 10'
    """
    return _SYMBOL.sub(r"$\1_\2$", figure_text(str(name), longest=60))


def _draw_distances(axes: Axes, named: list[tuple[str, Run]]) -> None:
    """Draw the distance (m) of each run from the track of the first, along its own track."""
    (first, reference), *others = named
    for place, (_, run) in enumerate(others, start=1):
        axes.plot(arc_lengths(run.place), distance_from_path(run.place, reference.place), **style.line_style(place))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(Message("distance travelled (m)"))
    axes.set_ylabel(Message("distance (m) from the track of\n{mathtext}", mathtext=mathtext(first)))


def _draw_depths(axes: Axes, named: list[tuple[str, Run]], moment: float) -> None:
    """Draw the depth along the ski that is more heavily loaded in the first run, for all runs at one time."""
    reference = named[0][1]
    ski = int(loaded_skis(reference)[_nearest_time_index(reference, moment)])
    depths = [run.skis.edge_depth[_nearest_time_index(run, moment), ski] / MM for _, run in named]
    for place, (_, run) in enumerate(named):
        axes.plot(run.skis.station, depths[place], **style.line_style(place))
    deepest = max(float(np.nanmax(depth)) for depth in depths)
    axes.axhline(0.0, color=style.GREY, linewidth=0.6, zorder=1)
    axes.axvline(0.0, color=style.PALE, linewidth=0.5, zorder=0)
    axes.set_ylim(1.15 * max(deepest, 0.1), -0.35 * max(deepest, 0.1))
    axes.set_xlabel(Message("position along the ski (m); boot = 0, tail left, tip right"))
    sides = (Message("edge depth (mm), left ski,\nat {moment:.2f} s", moment=moment),
             Message("edge depth (mm), right ski,\nat {moment:.2f} s", moment=moment))  # fmt: skip
    axes.set_ylabel(sides[ski])


def _nearest_time_index(run: Run, moment: float) -> int:
    """Index of the time nearest to a moment (s); the first or last one if it is outside of the run."""
    return int(np.argmin(abs(run.time - moment)))


def loaded_skis(run: Run) -> IntArray:
    """Index of the ski with the larger total force at each time, shape (n,): 0 left, 1 right."""
    return np.argmax(run.skis.total_force, axis=1)
