"""Draw the figures of the pages on tracks: python docs/figures_of_tracks.py.

With the name of a file, the slalom of the figures is written there as a table, and nothing is drawn.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from skisnow.report.figures.drawing import write_figure
from skisnow.report.figures.style import BLUE, DOUBLE_MM, GREY, PALE, VERMILLION, legend_below, new_figure
from skisnow.report.track.figures import track_map
from skisnow.track.curvature import TrackMotion, track_motion
from skisnow.track.smoothing import Resolution
from skisnow.track.summary import track_summary
from skisnow.track.track import Track

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FOLDER = Path(__file__).resolve().parent / "_static" / "tracks"
NOISE = 0.02
"""m, white, on each coordinate."""
SPEED, TURN, LEAST_RADIUS = 10.0, 15.0, 12.0
"""m/s; length of a turn and its least radius in m."""
STEP = 0.01


def true_curvature(way: np.ndarray) -> np.ndarray:
    """Turns to the left and right, each half a sine."""
    return np.asarray(np.sin(np.pi * way / TURN) / LEAST_RADIUS)


def slalom() -> Track:
    """Six turns at 10 Hz with noise; the file is made up."""
    way = STEP * np.arange(round(6.0 * TURN / STEP) + 1)
    heading = np.concatenate([[0.0], np.cumsum(STEP * true_curvature(way[:-1] + STEP / 2.0))]) - 0.4
    middle = (heading[1:] + heading[:-1]) / 2.0
    place = np.concatenate([[[0.0, 0.0]], np.cumsum(STEP * np.stack([np.cos(middle), np.sin(middle)], axis=1), axis=0)])
    place = place[::100] + NOISE * np.random.default_rng(2013).standard_normal((len(way[::100]), 2))
    unknown = np.full(len(place), np.nan)
    time = 0.1 * np.arange(float(len(place)))
    return Track("slalom", time, np.column_stack([place, unknown]), unknown, "local", "made up", axes="slope")


def resolution_figure() -> Figure:
    """Curvature of a noisy slalom beside the truth; what windows let pass."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=72.0)
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
    _draw_curvature(left, track_motion(slalom()))
    for window, look in ((0.8, "-"), (1.6, (0, (5, 1.5))), (8.0, (0, (1, 1)))):
        resolution = Resolution.of_window(window, window / 8.0, NOISE, None)
        period = np.geomspace(0.4, 30.0, 300)
        passed = [resolution.share_passed(one) for one in period]
        right.plot(period, passed, color=BLUE, linestyle=look)
        spot = (resolution.half_period, 0.5)
        right.annotate(f"{window:g} s", spot, (6, -3), textcoords="offset points", fontsize=7.0)
        right.plot(resolution.half_period, 0.5, marker="o", markersize=3.5, color=VERMILLION, zorder=4)
    right.axhline(0.0, color=GREY, linewidth=0.5)
    right.set_xscale("log")
    right.set_xticks([0.5, 1.0, 2.0, 5.0, 10.0, 20.0], ["0.5", "1", "2", "5", "10", "20"])
    right.set_xticks([], minor=True)
    right.set_xlim(0.4, 30.0)
    right.set_xlabel("time of one swing of the curvature (s)")
    right.set_ylabel("share that passes")
    right.set_title("by the length of the window", loc="left", fontsize=7.5)
    handles = [
        Line2D([], [], color=BLUE, label="from the noisy track"),
        Patch(facecolor=PALE, alpha=0.7, label="95 % interval"),
        Line2D([], [], color=VERMILLION, linestyle=(0, (4, 2)), label="truth"),
        Line2D([], [], color=VERMILLION, linestyle="none", marker="o", markersize=3.5, label="stated resolution"),
    ]
    legend_below(figure, handles)  # type: ignore[arg-type]
    return figure


def _draw_curvature(axes: Axes, motion: TrackMotion) -> None:
    low, high = motion.curvature_interval()
    way = SPEED * motion.time
    axes.fill_between(way, low, high, color=PALE, alpha=0.7, linewidth=0.0)
    axes.plot(way, motion.curvature, color=BLUE)
    fine = np.linspace(0.0, way[-1], 600)
    axes.plot(fine, true_curvature(fine), color=VERMILLION, linestyle=(0, (4, 2)), linewidth=0.9)
    axes.set_xlim(0.0, float(way[-1]))
    axes.set_ylim(-0.12, 0.12)
    axes.set_xlabel("way (m)")
    axes.set_ylabel("curvature (1/m), left +")


def write_slalom(path: Path) -> None:
    """The slalom as a track file in local metres."""
    track = slalom()
    rows = np.column_stack([track.time, track.place[:, :2]])
    np.savetxt(path, rows, delimiter=",", header="time_s,x_m,y_m", comments="", fmt="%.6f")


def main() -> None:
    """Write both figures."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    write_figure(FOLDER / "resolution.png", resolution_figure)
    write_figure(FOLDER / "slalom-map.png", lambda: track_map(track_summary(slalom())))


if __name__ == "__main__":
    write_slalom(Path(sys.argv[1])) if sys.argv[1:] else main()
