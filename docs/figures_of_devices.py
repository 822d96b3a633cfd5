"""Draw the two devices of the paper, and the frames of the simulated turn: python docs/figures_of_devices.py.

Our own drawings, after the description in Mössner and others (2013), Figs 1 to 4: what is measured and what the
equations call it. Nothing is to scale.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Arc, FancyArrowPatch, Polygon, Rectangle

from skisnow.report.figures.style import BLUE, DOUBLE_MM, GREY, VERMILLION, journal_style, new_figure

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Point = tuple[float, float]

PICTURES = Path(__file__).resolve().parent / "_static" / "drawings"
SNOW, METAL, DARK = "#DCE9F2", "#C9C9C9", "#333333"


def _blank(axes: Axes, width: Point, height: Point) -> None:
    axes.set(xlim=width, ylim=height, aspect="equal")
    axes.axis("off")


def _arrow(axes: Axes, start: Point, end: Point, colour: str = VERMILLION, style: str = "-|>") -> None:
    axes.add_patch(
        FancyArrowPatch(start, end, arrowstyle=style, mutation_scale=9, color=colour, linewidth=1.2, zorder=5)
    )


def _dimension(axes: Axes, start: Point, end: Point, text: str, place: Point) -> None:
    _arrow(axes, start, end, DARK, "<|-|>")
    axes.text(*place, text, ha="center", va="center", fontsize=8, zorder=6)


def _box(axes: Axes, corner: Point, width: float, height: float, colour: str = METAL, **more: Any) -> None:
    axes.add_patch(Rectangle(corner, width, height, facecolor=colour, edgecolor=DARK, linewidth=0.8, **more))


def _turned(points: Sequence[Point], degrees: float, about: Point) -> list[Point]:
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return [(about[0] + c * x - s * y, about[1] + s * x + c * y) for x, y in points]


def _piece(axes: Axes, points: list[Point], colour: str = METAL) -> None:
    axes.add_patch(Polygon(points, closed=True, facecolor=colour, edgecolor=DARK, linewidth=0.9, zorder=4))


def penetration_rig(axes: Axes) -> None:
    """The pole in its guide, loaded with discs, with the piece of ski at its lower end and the gauge beside it."""
    _blank(axes, (-3.6, 4.4), (-1.2, 8.6))
    _box(axes, (-3.6, -1.2), 8.0, 1.2, SNOW, linestyle="none")
    axes.plot([-3.6, 4.4], [0, 0], color=DARK, linewidth=0.9)
    for left in (-2.8, 0.9):  # the basal plate has a window for the tool
        _box(axes, (left, 0), 1.9, 0.22)
    for side in (-0.75, 0.5):
        _box(axes, (side, 0.22), 0.25, 4.2)
    _box(axes, (-1.05, 3.6), 2.1, 0.5)
    _box(axes, (-0.14, 0.05), 0.28, 6.2, "#EEEEEE", zorder=3)
    _box(axes, (-1.3, 6.25), 2.6, 0.16, zorder=3)
    for k in range(4):
        _box(axes, (-1.0, 6.43 + 0.28 * k), 2.0, 0.26, "#8A8A8A", zorder=3)
    edge = (-0.45, -0.5)
    _piece(axes, _turned([(0, 0), (1.35, 0), (1.35, 0.2), (0, 0.2)], 42, edge))
    _box(axes, (1.6, 2.5), 0.7, 0.7, "white", zorder=3)
    axes.add_patch(Arc((1.95, 2.85), 0.5, 0.5, theta1=20, theta2=320, color=DARK, linewidth=0.8, zorder=4))
    axes.plot([1.95, 2.1], [2.85, 3.0], color=VERMILLION, linewidth=1.1, zorder=5)
    axes.plot([0.75, 1.6], [2.85, 2.85], color=DARK, linewidth=0.9)
    axes.plot([0.14, 1.95, 1.95], [1.4, 1.4, 2.5], color=DARK, linewidth=0.9, zorder=3)
    _arrow(axes, (0.0, 8.5), (0.0, 7.65))
    labels = (
        ("load F: weight discs", (1.15, 7.0)),
        ("tray", (1.45, 6.3)),
        ("pole in its guide", (1.2, 3.85)),
        ("gauge: 0.01 mm", (2.45, 2.85)),
        ("basal plate,\nnot anchored", (2.6, 0.75)),
        ("piece of ski,\nL × W", (-3.5, 0.95)),
        ("snow", (3.5, -0.7)),
    )
    for text, place in labels:
        axes.text(*place, text, ha="left", va="center", fontsize=7.5)
    axes.plot([-2.2, -0.2], [0.85, 0.1], color=GREY, linewidth=0.6)
    axes.set_title("The rig for the penetration force", fontsize=8.5)


def edged_tool(axes: Axes) -> None:
    """The tool seen along its edge: depth e, edge angle ϑ, contact A, volume V and the stress of the snow."""
    _blank(axes, (-2.6, 5.4), (-2.6, 3.4))
    angle, depth = 35.0, 1.7
    tan = math.tan(math.radians(angle))
    edge, surface = (0.0, -depth), (depth / tan, 0.0)
    _box(axes, (-2.6, -2.6), 8.0, 2.6, SNOW, linestyle="none")
    axes.add_patch(Polygon([edge, surface, (0.0, 0.0)], facecolor="#FFFFFF", edgecolor="none", zorder=2))
    axes.add_patch(
        Polygon([edge, surface, (0.0, 0.0)], facecolor="none", edgecolor=BLUE, hatch="///", linewidth=0, zorder=2)
    )
    axes.plot([-2.6, 5.4], [0, 0], color=DARK, linewidth=0.9, zorder=3)
    _piece(axes, _turned([(0, 0), (4.2, 0), (4.2, 0.28), (0, 0.28)], angle, edge))
    for x in np.linspace(0.2, depth / tan - 0.25, 6):
        base = -depth + x * tan
        _arrow(axes, (x, base - 0.1 + 0.45 * base), (x, base - 0.06), BLUE)
    _arrow(axes, (0.35, 2.9), (0.35, 0.45))
    axes.text(0.55, 2.6, "F", fontsize=9, color=VERMILLION)
    _dimension(axes, (-0.6, -depth), (-0.6, 0.0), "e", (-0.95, -depth / 2))
    axes.plot([-0.75, 0.0], [-depth, -depth], color=GREY, linewidth=0.6)
    axes.plot([0.0, 2.2], [-depth, -depth], color=GREY, linewidth=0.6, zorder=5)
    axes.add_patch(Arc(edge, 2.6, 2.6, theta1=0, theta2=angle, color=DARK, linewidth=0.8, zorder=6))
    axes.text(1.5, -depth + 0.42, "ϑ", fontsize=9, zorder=6)
    _dimension(axes, (0.0, 0.3), (surface[0], 0.3), "A/L", (1.25, 0.58))
    axes.text(0.75, -0.45, "V", fontsize=9, zorder=6, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8})
    axes.text(2.6, -2.3, "p: stress of the snow", fontsize=7.5, color=BLUE)
    axes.text(3.45, 0.35, "surface", fontsize=7.5, color=GREY)
    axes.set_title("The edged tool in the snow", fontsize=8.5)


def shear_device(axes: Axes) -> None:
    """The anchored pole with the moment gauge at its top and the blade on a lever arm."""
    _blank(axes, (-3.2, 5.6), (-2.0, 6.4))
    _box(axes, (-3.2, -2.0), 8.8, 2.0, SNOW, linestyle="none")
    axes.plot([-3.2, 5.6], [0, 0], color=DARK, linewidth=0.9)
    _box(axes, (-0.14, -1.6), 0.28, 6.2, "#EEEEEE", zorder=3)
    _box(axes, (-0.3, -1.8), 0.6, 1.4, zorder=2)
    _box(axes, (-0.5, 4.6), 1.0, 0.55, "white", zorder=4)
    axes.text(0.0, 4.87, "M", ha="center", va="center", fontsize=8.5, zorder=5)
    _box(axes, (-2.4, 0.9), 5.6, 0.22, zorder=3)
    for x in (-2.3, 3.1):
        _box(axes, (x - 0.07, 0.35), 0.14, 0.6, zorder=3)
        _piece(axes, _turned([(0, 0), (1.5, 0), (1.5, 0.12), (0, 0.12)], 62, (x - 0.35, -0.85)), "#8A8A8A")
    axes.add_patch(Arc((0, 5.75), 2.2, 0.75, theta1=200, theta2=340, color=VERMILLION, linewidth=1.2))
    _arrow(axes, (0.9, 5.52), (1.1, 5.7))
    _dimension(axes, (0.0, 1.6), (3.1, 1.6), "r", (1.6, 1.9))
    labels = (
        ("moment gauge", (0.7, 4.87)),
        ("turned by hand", (1.3, 5.8)),
        ("lever arms", (-3.1, 1.5)),
        ("blade", (3.9, 0.5)),
        ("anchorage of\na slalom pole", (0.5, -1.3)),
        ("snow", (4.6, -1.6)),
    )
    for text, place in labels:
        axes.text(*place, text, ha="left", va="center", fontsize=7.5)
    axes.set_title("The device for the failure shear force", fontsize=8.5)


def blade(axes: Axes) -> None:
    """The blade seen along its edge: the snow's force F, its part along the surface F_t, depth and contact."""
    _blank(axes, (-2.8, 5.2), (-2.6, 3.4))
    angle, depth = 60.0, 1.8
    s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    edge = (0.0, -depth)
    _box(axes, (-2.8, -2.6), 8.0, 2.6, SNOW, linestyle="none")
    axes.plot([-2.8, 5.2], [0, 0], color=DARK, linewidth=0.9, zorder=3)
    _piece(axes, _turned([(0, 0), (3.6, 0), (3.6, -0.18), (0, -0.18)], angle, edge), "#8A8A8A")
    middle = (0.5 * depth * c / s + 0.18 * s, -0.5 * depth - 0.18 * c)  # on the lower face
    start = (middle[0] + 1.9 * s, middle[1] - 1.9 * c)
    _arrow(axes, start, middle)
    _arrow(axes, (start[0], middle[1]), middle, BLUE)
    axes.plot([start[0], start[0]], [start[1], middle[1]], color=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
    axes.text(start[0] + 0.12, start[1] - 0.1, "F, of the snow", fontsize=7.5, color=VERMILLION)
    axes.text(start[0] + 0.12, middle[1] - 0.1, "$F_t = F\\,\\sin\\vartheta$", fontsize=7.5, color=BLUE)
    _dimension(axes, (-1.3, -depth), (-1.3, 0.0), "e", (-1.6, -depth / 2))
    axes.plot([-1.45, 0.9], [-depth, -depth], color=GREY, linewidth=0.6, zorder=5)
    axes.add_patch(Arc(edge, 1.4, 1.4, theta1=0, theta2=angle, color=DARK, linewidth=0.8, zorder=6))
    axes.text(0.72, -depth + 0.28, "ϑ", fontsize=9, zorder=6)
    axes.text(0.5, 0.3, "contact A = L e/sin ϑ", fontsize=7.5, ha="right", zorder=6)
    _arrow(axes, (1.9, 2.4), (3.3, 2.4), DARK)
    axes.text(2.6, 2.65, "the blade is moved", ha="center", fontsize=7.5)
    axes.set_title("The blade in the snow", fontsize=8.5)


def _frames(axes: Axes) -> None:
    """The slope from above with the sledge, its heading and its frame."""
    _blank(axes, (-4.2, 4.2), (-4.6, 3.4))
    _arrow(axes, (-3.6, 2.6), (-3.6, 0.6), DARK)
    _arrow(axes, (-3.6, 2.6), (-1.9, 2.6), DARK)
    axes.text(-3.5, 0.25, "x, down the fall line", fontsize=7.5)
    axes.text(-1.75, 2.6, "y, to the left", fontsize=7.5, va="center")
    axes.text(-3.95, 2.85, "z, out of the snow", fontsize=7.5)
    axes.plot(-3.6, 2.6, "o", color=DARK, markersize=3)
    heading = 40.0  # from the fall line to the left: seen from above, y points right on this page
    ahead = (math.sin(math.radians(heading)), -math.cos(math.radians(heading)))
    left = (-ahead[1], ahead[0])
    middle = (1.2, -1.0)
    for side in (-0.55, 0.55):
        foot = (middle[0] + side * left[0], middle[1] + side * left[1])
        turn = heading - 90.0
        shape = [(-1.6, -0.13), (-0.9, -0.11), (0, -0.085), (1.1, -0.13), (1.75, -0.02), (1.75, 0.02), (1.1, 0.13)]
        _piece(axes, _turned([*shape, (0, 0.085), (-0.9, 0.11), (-1.6, 0.13)], turn, foot), METAL)
    axes.plot(*middle, "o", color=VERMILLION, markersize=4, zorder=7)
    axes.text(middle[0] - 0.35, middle[1] + 0.12, "O", fontsize=8, color=VERMILLION, zorder=7)
    end = (middle[0] + 2.5 * ahead[0], middle[1] + 2.5 * ahead[1])
    _arrow(axes, middle, end)
    axes.text(end[0] + 0.1, end[1] - 0.1, "v, ahead", fontsize=7.5, color=VERMILLION)
    axes.plot([middle[0]] * 2, [middle[1], middle[1] - 2.4], color=GREY, linewidth=0.8, linestyle=(0, (3, 2)))
    axes.add_patch(Arc(middle, 3.4, 3.4, theta1=-90, theta2=-90 + heading, color=DARK, linewidth=0.8))
    axes.text(middle[0] - 0.15, middle[1] - 2.1, "heading", fontsize=7.5, ha="right")
    axes.set_title("Space, seen from above", fontsize=8.5)


def _cross_section(axes: Axes) -> None:
    """The skis seen from behind, tilted by −ϑ about the sledge's x, with the vectors across and out of the base."""
    _blank(axes, (-4.2, 4.2), (-2.2, 3.0))
    _box(axes, (-4.2, -2.2), 8.4, 1.6, SNOW, linestyle="none")
    axes.plot([-4.2, 4.2], [-0.6, -0.6], color=DARK, linewidth=0.9)
    angle = 25.0
    for foot in ((-1.9, -0.25), (1.9, -0.25)):
        _piece(axes, _turned([(-0.95, 0), (0.95, 0), (0.95, 0.16), (-0.95, 0.16)], angle, foot))
        axes.plot([foot[0], 0.0], [foot[1] + 0.2, 1.5], color=GREY, linewidth=1.0, zorder=1)
    axes.plot(0.0, 1.5, "o", color=DARK, markersize=5)
    axes.text(0.15, 1.6, "centre of mass", fontsize=7.5)
    axes.plot(0.0, -0.25, "o", color=VERMILLION, markersize=4)
    axes.text(0.1, -0.12, "O", fontsize=8, color=VERMILLION)
    s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    foot = (-1.9, -0.25)
    _arrow(axes, foot, (foot[0] - 1.6 * c, foot[1] - 1.6 * s), BLUE)
    axes.text(foot[0] - 1.8 * c - 0.05, foot[1] - 1.8 * s + 0.1, "l", fontsize=9, color=BLUE)
    _arrow(axes, foot, (foot[0] - 1.6 * s, foot[1] + 1.6 * c), BLUE)
    axes.text(foot[0] - 1.75 * s - 0.2, foot[1] + 1.6 * c, "n", fontsize=9, color=BLUE)
    axes.plot([0.7, 3.4], [-0.25, -0.25], color=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
    axes.add_patch(Arc((1.9, -0.25), 2.3, 2.3, theta1=0, theta2=angle, color=DARK, linewidth=0.8))
    axes.text(3.1, 0.0, "ϑ", fontsize=9)
    _dimension(axes, (-1.9, -1.7), (1.9, -1.7), "stance b", (0.0, -1.45))
    axes.text(-4.1, 2.7, "from behind; y to the left", fontsize=7.5, color=GREY)
    axes.set_title("The sledge's frame and the tilted skis", fontsize=8.5)


def _lines(axes: Axes) -> None:
    """Lines of snow that stay in place while the ski passes over them; behind it they keep the groove."""
    _blank(axes, (-5.2, 5.2), (-2.2, 2.6))
    shape = [(-3.0, -0.4), (-1.5, -0.33), (0, -0.26), (1.8, -0.38), (2.9, -0.06)]
    axes.fill_between([-5.2, -2.9], -0.4, 0.4, color="#B9D3E6", zorder=1)
    axes.text(-5.1, -0.75, "groove", fontsize=7.5, color=BLUE)
    _piece(axes, [*shape, *[(x, -y) for x, y in reversed(shape)]], "#E9E9E9")
    for x in np.arange(-4.8, 5.1, 0.6):
        under = -3.0 < x < 2.9
        axes.plot([x, x], [-1.2, 1.2], color=BLUE if under else GREY, linewidth=1.3 if under else 0.7, zorder=6)
    _dimension(axes, (3.4, 1.45), (4.2, 1.45), "Δs", (3.8, 1.75))
    axes.text(-0.2, -1.65, "met by the base now", ha="center", fontsize=7.5, color=BLUE)
    axes.text(4.2, -1.65, "laid ahead", ha="center", fontsize=7.5, color=GREY)
    axes.text(-4.1, -1.65, "archive", ha="center", fontsize=7.5, color=GREY)
    _arrow(axes, (-0.6, 2.1), (1.0, 2.1))
    axes.text(1.15, 2.1, "the ski moves, the lines stay", va="center", fontsize=7.5, color=VERMILLION)
    axes.set_title("Transverse lines of snow, from above", fontsize=8.5)


def _groove(axes: Axes) -> None:
    """One line in section: the ground as knots, the base over it, and the pressure between."""
    _blank(axes, (-4.4, 4.4), (-2.6, 2.2))
    knots = [(-4.4, 0), (-2.6, 0), (-2.1, -0.6), (-0.9, -1.15), (-0.2, -0.9), (1.3, 0), (4.4, 0)]
    axes.add_patch(Polygon([*knots, (4.4, -2.6), (-4.4, -2.6)], facecolor=SNOW, edgecolor="none"))
    axes.plot(*zip(*knots, strict=True), color=DARK, linewidth=0.9, zorder=3)
    axes.plot(*zip(*knots[1:-1], strict=True), "o", color=DARK, markersize=3.5, zorder=4)
    axes.plot([-2.6, 1.3], [0, 0], color=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
    angle, edge = 27.0, (-1.55, -1.45)
    _piece(axes, _turned([(0, 0), (4.6, 0), (4.6, 0.2), (0, 0.2)], angle, edge))
    tan = math.tan(math.radians(angle))
    for x in np.linspace(-1.45, 0.7, 7):
        base = edge[1] + (x - edge[0]) * tan
        length = 0.6 * max(-base, 0.0) * (1.0 if x < -0.75 else 0.35)
        _arrow(axes, (x, base - 0.1 - length), (x, base - 0.03), BLUE)
    _dimension(axes, (-3.1, edge[1]), (-3.1, 0.0), "e", (-3.4, -0.7))
    axes.plot([-3.2, edge[0]], [edge[1]] * 2, color=GREY, linewidth=0.6)
    axes.text(1.5, -0.45, "groove before:\nat most 16 knots", fontsize=7.5, va="center")
    axes.text(-0.3, -2.3, "pressure", fontsize=7.5, color=BLUE, ha="center")
    axes.text(2.75, 0.75, "base", fontsize=7.5)
    axes.set_title("One line in section: groove and base", fontsize=8.5)


def _edge(axes: Axes) -> None:
    """The edge's hold: the place where it met the surface, its place now, and force over the way between."""
    axes.plot([0, 1, 2.4], [0, 1, 1], color=BLUE)
    axes.plot([1, 1], [0, 1], color=GREY, linewidth=0.6, linestyle=(0, (3, 2)))
    axes.plot([1.9, 1.45], [1, 0.55], color=BLUE, linewidth=0.8, linestyle=(0, (4, 2)))
    axes.text(1.02, 0.1, "$u_y$", fontsize=8.5)
    axes.text(0.34, 0.62, "holds", fontsize=7.5, ha="right")
    axes.text(1.65, 1.05, "slips: $y_a$ follows", fontsize=7.5, ha="center")
    axes.text(1.86, 0.62, "let back", fontsize=7.5)
    axes.set(
        xlim=(0, 2.5), ylim=(0, 1.25), xticks=[], yticks=[0, 1], yticklabels=["0", "1"],
        xlabel="way of the edge across, $y_e - y_a$", ylabel="shear force over $S_f\\,e\\,\\Delta s$",
    )  # fmt: skip
    axes.set_box_aspect(0.4)
    axes.set_title("The hold of an edge", fontsize=8.5)


def drawn(parts: Sequence[Callable[[Axes], None]], *, rows: int, height_mm: float) -> Figure:
    """The drawings beside each other."""
    figure = new_figure(width_mm=DOUBLE_MM, height_mm=height_mm)
    places = figure.subplots(rows, len(parts) // rows, squeeze=False)
    for part, axes in zip(parts, places.flat, strict=True):
        part(axes)
    return figure


def main() -> None:
    """Write the four pictures."""
    PICTURES.mkdir(exist_ok=True)
    with journal_style():
        for name, parts, rows, height in (
            ("penetration-device", (penetration_rig, edged_tool), 1, 92.0),
            ("shear-device", (shear_device, blade), 1, 80.0),
            ("turn-frames", (_frames, _cross_section), 1, 75.0),
            ("turn-groove", (_lines, _groove, _edge), 3, 190.0),
        ):
            drawn(parts, rows=rows, height_mm=height).savefig(PICTURES / f"{name}.png", dpi=170)


if __name__ == "__main__":
    main()
