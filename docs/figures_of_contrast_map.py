"""Draw where elastic and hypoplastic runs part, and a fold: python docs/figures_of_contrast_map.py [--fold].

The map is drawn from the pairs in docs/gallery/contrast, which `python -m benchmarks.contrast --out
docs/gallery/contrast` computes; the fold takes some 40 runs of its own, whose ends are kept beside them in fold.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from benchmarks.contrast.found import Found, demand_and_strength, found, read_rows
from benchmarks.contrast.pairs import PARTED, SCENARIOS, turn
from benchmarks.contrast.unknowns import design
from fewer_colours import write_fewer_colours

from skisnow import simulate
from skisnow.report.figures.drawing import write_figure
from skisnow.report.figures.style import BLACK, BLUE, DOUBLE_MM, GREY, VERMILLION, legend_below, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DOCS = Path(__file__).resolve().parent
PAIRS = DOCS / "gallery" / "contrast"
FOLD = PAIRS / "fold.json"
RATIOS = np.array([1.0, 1.02, 1.05, 1.1, 1.15, 1.2, 1.3, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0])
FACTORS = np.geomspace(0.5, 2.0, 13)
"""Of S_f."""
FOLDED = 5
"""Point of the design whose carver pair is looked at: it parts by 13 m."""


def compute_fold() -> None:
    """Ends over k_u/H_V, and over S_f with both contacts, about a pair of the carver."""
    point = {"scenario": SCENARIOS[0], **design()[FOLDED]}
    ratio, strength = "snow.unloading_ratio", "snow.S_f_N_per_mm2"
    kept: dict[str, Any] = {"point": point, "ratio": [end_of(point | {ratio: float(each)}) for each in RATIOS]}
    for contact, own in (("elastic", 1.0), ("hypoplastic", point[ratio])):
        sweep = (point | {ratio: own, strength: float(factor) * point[strength]} for factor in FACTORS)
        kept[contact] = [end_of(each) for each in sweep]
    FOLD.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def end_of(point: dict[str, Any]) -> float | None:
    """How far to the left of its start (m) a run ends; None where it does not cover its length."""
    run = simulate(turn(point, fast=True))
    return float(run.place[-1, 1]) if run.outcome == "distance_reached" else None


def the_map(pairs: dict[str, Found]) -> Figure:
    """Distance of the tracks for each scenario: on the left over demand and strength, on the right over their ratio."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=150.0)
    for row, (name, each) in enumerate(pairs.items()):
        left, right = figure.add_subplot(2, 2, 2 * row + 1), figure.add_subplot(2, 2, 2 * row + 2)
        needed, drawn = np.array([demand_and_strength(one) for one in each.rows]).T
        _plane(left, each, needed, drawn)
        _over_ratio(right, each, needed / drawn)
        left.set_title(name, loc="left")
    legend_below(figure, _handles())
    return figure


def _plane(axes: Axes, each: Found, needed: np.ndarray, drawn: np.ndarray) -> None:
    there = each.complete
    parted = there.copy()
    parted[there] = each.share > PARTED
    size = np.zeros(len(there))
    size[there] = 4.0 + 12.0 * np.log10(np.maximum(each.share / PARTED, 1.0)) ** 1.5
    axes.plot(drawn[~there], needed[~there], "x", color=GREY, markersize=3.0, markeredgewidth=0.6)
    held = there & ~parted
    axes.scatter(drawn[held], needed[held], s=5.0, facecolors="none", edgecolors=BLUE, linewidths=0.6)
    axes.scatter(drawn[parted], needed[parted], s=size[parted], color=VERMILLION, alpha=0.7, linewidths=0)
    ends = np.array([drawn.min(), drawn.max()])
    for factor, style in ((1.0, "-"), (2.0, "--")):
        axes.plot(ends, factor * ends, color=BLACK, linewidth=0.6, linestyle=style)
    axes.set(xscale="log", yscale="log", ylim=(needed.min() / 1.3, needed.max() * 1.3))
    axes.set_xlabel("side force that elastic snow can give (N)")
    axes.set_ylabel("side force that the turn needs (N)")


def _over_ratio(axes: Axes, each: Found, ratio: np.ndarray) -> None:
    there = each.complete
    outside = each.column("outside_m") > 0.0
    percent = np.maximum(100.0 * each.share, 0.01)
    for which, colour, marker in ((outside, VERMILLION, "^"), (~outside, BLUE, "v")):
        axes.plot(
            ratio[there][which], percent[which], marker, color=colour, markersize=2.8, alpha=0.8, linestyle="none"
        )
    for factor, style in ((1.0, "-"), (2.0, "--")):
        axes.axvline(factor, color=BLACK, linewidth=0.6, linestyle=style)
    low, high = (100.0 * far / each.length for far in each.published_range)
    axes.axhspan(low, high, color=GREY, alpha=0.35, linewidth=0)
    axes.axhline(100.0 * PARTED, color=GREY, linewidth=0.6, linestyle=":")
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("needed / that elastic snow can give")
    axes.set_ylabel("tracks apart (% of the run)")


def _handles() -> list[Line2D]:
    def mark(marker: str, colour: str, label: str, **more: Any) -> Line2D:
        return Line2D([], [], marker=marker, color=colour, linestyle="none", label=label, **more)

    return [
        mark("o", VERMILLION, "left: parted by more than 1 %, larger: farther"),
        mark("o", BLUE, "not parted", markerfacecolor="none"),
        mark("x", GREY, "the elastic run does not cover the length"),
        mark("^", VERMILLION, "right: elastic run ends outside"),
        mark("v", BLUE, "inside"),
        Line2D([], [], color=GREY, alpha=0.35, linewidth=5.0, label="published"),
        Line2D([], [], color=BLACK, linewidth=0.6, label="needed = elastic strength"),
        Line2D([], [], color=BLACK, linewidth=0.6, linestyle="--", label="= that of snow that keeps its groove"),
    ]


def the_fold() -> Figure:
    """Ends of runs about one pair."""
    kept = json.loads(FOLD.read_text(encoding="utf-8"))
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=66.0)
    left, right = figure.subplots(1, 2, sharey=True)
    left.plot(RATIOS, np.array(kept["ratio"], dtype=float), marker="o", color=BLACK)
    for contact, colour in (("hypoplastic", BLUE), ("elastic", VERMILLION)):
        ends = np.array(kept[contact], dtype=float)
        right.plot(FACTORS * kept["point"]["snow.S_f_N_per_mm2"], ends, marker="o", color=colour)
    left.set_xlabel("$k_u$ / $H_V$ (1: elastic)")
    left.set_ylabel("end to the left of the start (m)")
    right.set_xlabel("failure shear stress $S_f$ (N/mm²)")
    for axes in (left, right):
        axes.set_xscale("log")
    right.axvline(kept["point"]["snow.S_f_N_per_mm2"], color=GREY, linewidth=0.6, linestyle=":")
    handles = [
        Line2D([], [], marker="o", color=BLUE, label=f"$k_u$ / $H_V$ = {kept['point']['snow.unloading_ratio']:.2g}")
    ]
    handles.append(Line2D([], [], marker="o", color=VERMILLION, label="elastic"))
    legend_below(figure, handles)
    return figure


def main() -> None:
    """Draw; with --fold its runs are computed anew."""
    pairs = found(read_rows(PAIRS))
    if "--fold" in sys.argv[1:]:
        compute_fold()
    for name, draw in (("map", lambda: the_map(pairs)), ("fold", the_fold)):
        path = DOCS / "_static" / "gallery" / f"turn-contrast-{name}.png"
        write_figure(path, draw)
        write_fewer_colours(path)


if __name__ == "__main__":
    main()
