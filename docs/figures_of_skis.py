"""Draw the figure of the pages on skis: python docs/figures_of_skis.py."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from skisnow.report.figures.style import BLUE, DOUBLE_MM, GREEN, GREY, VERMILLION, journal_style, new_figure
from skisnow.ski import ski_named

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from skisnow.ski import Ski

FOLDER = Path(__file__).parent / "_static" / "ski"
COLOURS = {"slalom": BLUE, "giant-slalom": VERMILLION, "carver": GREEN}
APART_MM = 150.0  # of the outlines drawn above each other


def draw_outline(axes: Axes, ski: Ski, row: int, colour: str) -> None:
    """The ski from above, sideways stretched, with its contact points."""
    middle, half = -row * APART_MM, ski.width * 1e3 / 2.0
    axes.fill_between(ski.station, middle - half, middle + half, color=colour, alpha=0.18, linewidth=0)
    for edge in (middle - half, middle + half):
        axes.plot(ski.station, edge, color=colour)
    tip_half = half[0]
    axes.plot([ski.station[0]] * 2, [middle - tip_half, middle + tip_half], color=colour)
    axes.plot([ski.station[-1]] * 2, [middle - half[-1], middle + half[-1]], color=colour)
    for station in ski.contact_points:
        reach = float(ski.at(station).width) * 1e3 / 2.0
        axes.plot([station] * 2, [middle - reach, middle + reach], color=colour, linewidth=0.6, linestyle=(0, (2, 2)))
    radius = ski.sidecut_radius_of_edge_line
    tip, waist, tail = (width * 1e3 for width in ski.sidecut_widths)
    text = f"{ski.name}   {tip:.0f}-{waist:.0f}-{tail:.0f} mm   radius {radius:.1f} m   {ski.mass:.2f} kg"
    axes.text(0.0, middle, text, ha="center", va="center", fontsize=7.0)


def draw_skis() -> None:
    """Outline, base and stiffness of the three skis of the catalogue."""
    with journal_style():
        figure = new_figure(width_mm=DOUBLE_MM, height_mm=165.0)
        rows = figure.subplots(4, 1, sharex=True, height_ratios=[2.4, 1.3, 1.3, 1.3])
        for row, (name, colour) in enumerate(COLOURS.items()):
            ski = ski_named(name)
            draw_outline(rows[0], ski, row, colour)
            for axes, table in (
                (rows[1], ski.base_height * 1e3),
                (rows[2], ski.bending_stiffness),
                (rows[3], ski.torsional_stiffness),
            ):
                axes.plot(ski.station, table, color=colour, label=name)
        rows[0].set_ylabel("outline (mm)")
        rows[0].set_yticks([-2 * APART_MM - 50, -2 * APART_MM, -2 * APART_MM + 50], ["−50", "0", "50"])
        rows[1].set_ylabel("base height (mm)")
        rows[1].set_ylim(-10.0, 46.0)
        rows[2].set_ylabel("EI (N m²)")
        rows[3].set_ylabel("GJ (N m²)")
        for axes in rows[1:]:
            axes.axvline(0.0, color=GREY, linewidth=0.5)
        for axes in rows[2:]:
            axes.set_ylim(bottom=0.0)
        rows[3].set_xlabel("position along the ski (m), boot = 0, tip to the right")
        rows[1].legend(loc="upper left", ncols=3)
        FOLDER.mkdir(parents=True, exist_ok=True)
        figure.savefig(FOLDER / "skis.png", dpi=200)


if __name__ == "__main__":
    draw_skis()
