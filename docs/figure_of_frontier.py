"""Draw error against cost of a turn from the kept points: python docs/figure_of_frontier.py.

The points are those of ``python -m benchmarks frontier --out docs/_static/frontier.csv``.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Final

from skisnow.report.figures.style import DOUBLE_MM, journal_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DOCS: Final = Path(__file__).resolve().parent
POINTS: Final = DOCS / "_static" / "frontier.csv"
PICTURE: Final = DOCS / "_static" / "frontier.png"
PANELS: Final = {
    "solver.tolerance_mm": "tolerance of a step (mm)",
    "solver.elements": "elements",
    "solver.line_spacing_mm": "spacing of lines (mm)",
    "solver.groove_tolerance": "tolerance of the groove",
    "snow.shear_displacement_mm": "shear displacement (mm)",
}
MARKERS: Final = "osD^v"
EDGE: Final = {"default": "black", "fast": "grey"}
TICKS: Final = (0.3, 0.5, 1.0, 2.0)


def points(path: Path) -> list[dict[str, str]]:
    """Rows of the table."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def chart(rows: list[dict[str, str]]) -> Figure:
    """A panel for each choice: a line through the points of each snow, the value at its points."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=130.0)
    axes = figure.subplots(2, 3, sharex=True, sharey=True).ravel()
    for panel, (key, name) in zip(axes, PANELS.items(), strict=False):
        _panel(panel, [row for row in rows if row["key"] == key], key)
        panel.set_title(name, fontsize=7.5)
    handles, labels = axes[0].get_legend_handles_labels()
    more = axes[4].get_legend_handles_labels()
    axes[5].axis("off")
    axes[5].legend(handles + more[0], labels + more[1], loc="center", frameon=False, fontsize=7)
    figure.supxlabel("processor time (s) for 5 s", fontsize=8)
    figure.supylabel("distance of the end (mm)", fontsize=8)
    return figure


def _panel(axes: Axes, rows: list[dict[str, str]], key: str) -> None:
    of_edge = key.startswith("snow.")
    groups = dict.fromkeys(row["method" if of_edge else "snow"] for row in rows)
    for mark, group in zip(MARKERS, groups, strict=False):
        of = [row for row in rows if row["method" if of_edge else "snow"] == group]
        x, y = [float(row["cpu_s"]) for row in of], [float(row["end_off_mm"]) for row in of]
        (line,) = axes.plot(x, y, marker=mark, markersize=3, linewidth=0.9, label=group,
                             color=EDGE.get(group))  # fmt: skip
        for row, a, b in zip(of, x, y, strict=True):
            if row is of[0] or row is of[-1]:
                axes.annotate(f"{float(row['value']):g}", (a, b), (3, 3), textcoords="offset points", fontsize=5.5,
                              color=line.get_color())  # fmt: skip
    axes.set(xscale="log", yscale="log")
    axes.set_xticks(TICKS, labels=[f"{tick:g}" for tick in TICKS])
    axes.minorticks_off()


def main() -> None:
    """Write the picture."""
    with journal_style():
        chart(points(POINTS)).savefig(PICTURE, dpi=170)


if __name__ == "__main__":
    main()
