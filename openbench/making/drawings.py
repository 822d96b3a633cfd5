"""A drawing of each case, as SVG."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import matplotlib as mpl
import numpy as np

from .. import CASES
from ..reading import read_case

mpl.use("Agg")
mpl.rcParams["svg.hashsalt"] = "openbench"
SNOW, DARK, INK = "#dfe9f2", "#9db7cf", "#333333"
Axes = Any


def _snow(axes: Axes, x: tuple[float, float], bottom: float) -> None:
    axes.fill_between(x, [bottom] * 2, [0.0, 0.0], color=SNOW, linewidth=0)
    axes.plot(x, [0.0, 0.0], color=DARK, linewidth=1.0)


def _arrow(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], words: str = "", style: str = "->"
) -> None:
    axes.annotate("", end, start, arrowprops={"arrowstyle": style, "color": INK, "linewidth": 1.2})
    if words:
        axes.text(*start, f" {words}", fontsize=9, va="center", color=INK)


def _clean(axes: Axes, title: str = "") -> None:
    axes.set(aspect="equal")
    axes.axis("off")
    axes.set_title(title, fontsize=9)


def plate(figure: Any, case: dict[str, Any]) -> None:
    left, right = figure.subplots(1, 2)
    _snow(left, (-2, 2), -1.2)
    left.fill([-1, 1, 1, -1], [-0.6, -0.6, 0.0, 0.0], color="white")
    left.fill([-1, 1, 1, -1], [-0.35, -0.35, 0.1, 0.1], color="#c9a66b")
    _arrow(left, (0, 1.0), (0, 0.12), "load or depth")
    left.set(ylim=(-1.3, 1.5))
    _arrow(left, (1.5, 0), (1.5, -0.35), "", "<->")
    _arrow(left, (-1.5, 0), (-1.5, -0.6), "", "<->")
    left.text(1.6, -0.2, "d", fontsize=9)
    left.text(-1.45, -0.8, "d_max", fontsize=9)
    _clean(left, "plate lifted in its print")
    hard, ratio, deepest = 1.0, 10.0, 0.0
    path, forces = [0.0], [0.0]
    for depth in case["motion"]["depth_m"]:
        for d in np.linspace(path[-1], depth, 30)[1:]:
            deepest = max(deepest, d)
            path.append(float(d))
            forces.append(max(0.0, hard * deepest - ratio * (deepest - d)))
    area = case["body"]["length_m"] * case["body"]["width_m"] * case["snow"]["snow_hardness_N_per_m3"]
    right.plot(np.array(path) * 1e3, np.array(forces) * area / 1e3, color=INK)
    right.set(xlabel="depth (mm)", ylabel="force (kN)", title="the motion")


def edge(figure: Any, case: dict[str, Any]) -> None:
    left, right = figure.subplots(1, 2)
    _snow(left, (-2, 2.4), -1.2)
    for angle, style in zip(case["body"]["edge_angle_deg"], ("-", "--", ":"), strict=True):
        slope = math.tan(math.radians(angle))
        left.plot([-0.6, 2.2], [-0.8, -0.8 + 2.8 * slope], color=INK, linestyle=style, label=f"{angle:g}°")
    left.set(ylim=(-1.3, 1.6))
    left.legend(fontsize=8, loc="upper left", frameon=False)
    _arrow(left, (-1.2, 0), (-1.2, -0.8), "", "<->")
    left.text(-1.1, -0.5, "depth", fontsize=9)
    _clean(left, "across the edge")
    for x in np.arange(-2, 2.01, 0.25):
        right.plot([x, x], [-2, 2], color=DARK, linewidth=0.5)
        right.plot([-2, 2], [x, x], color=DARK, linewidth=0.5)
    for heading in case["motion"]["heading_deg"]:
        a = math.radians(heading)
        right.plot(
            [-1.9 * math.cos(a), 1.9 * math.cos(a)], [-1.9 * math.sin(a), 1.9 * math.sin(a)], color=INK, linewidth=1.0
        )
    _clean(right, "from above: headings to a grid")


def cycles(figure: Any, case: dict[str, Any]) -> None:
    left, right = figure.subplots(1, 2)
    deepest, ratio = 0.0, case["snow"]["unloading_ratio_1"]
    for peak in case["motion"]["peak_depth_m"]:
        down = np.linspace(1e-9, peak, 200)
        deeper = np.maximum(deepest, down)
        up = down * 1e3
        left.plot(up, (deeper * np.maximum(0.0, 1 - ratio * (1 - down / deeper))) ** 2 * 1e6, color=INK, linewidth=0.9)
        deepest = max(deepest, peak)
        left.plot(
            up, (deepest * np.maximum(0.0, 1 - ratio * (1 - down / deepest))) ** 2 * 1e6, color="C1", linewidth=0.9
        )
    left.set(xlabel="depth (mm)", ylabel="force (relative)", title="down (dark) and up")
    reach = case["snow"]["shear_displacement_m"]
    for amplitude in case["motion"]["shear_amplitude_m"]:
        a, f = amplitude * 1e3, min(1.0, amplitude / reach)
        b = max(-a, a - 2e3 * reach)
        right.plot(
            [a, b, -a, -b, a], [-f, f if a > 1e3 * reach else -b / a * f, f, -f if a > 1e3 * reach else b / a * f, -f]
        )
    right.set(xlabel="place across (mm)", ylabel="shear over strength", title="cycles aside")


def glide(figure: Any, case: dict[str, Any]) -> None:
    axes = figure.subplots()
    body = case["body"]
    _snow(axes, (-1.6, 1.8), -0.5)
    scale = 8.0
    depth = -0.0112 * scale
    axes.fill_between([-1.6, -0.8], [0.0, 0.0], [depth * 0.9] * 2, color="white")
    x = [body["tail_m"], body["bend_m"], body["tip_m"]]
    y = [depth, depth, depth + body["tip_height_m"] * scale]
    axes.plot(x, y, color="#c9a66b", linewidth=4)
    _arrow(axes, (-0.1, 0.55), (0.55, 0.55), "")
    axes.text(-0.1, 0.6, "10 m down a slope of 12°", fontsize=9)
    axes.set(ylim=(-0.5, 0.8))
    _arrow(axes, (0.2, 0.25), (-0.35, 0.25), "")
    axes.text(-0.4, 0.25, "friction, compaction, drag", fontsize=9, va="center", ha="right")
    axes.text(-1.55, -0.25, "groove: residual depth", fontsize=9)
    _clean(axes, "from the side, heights 8 times too large")


def sand(figure: Any, case: dict[str, Any]) -> None:
    left, right = figure.subplots(1, 2)
    _snow(left, (-2, 2), -1.2)
    for half, bottom, words in ((0.5, -0.7, "60"), (0.7, -0.5, "80"), (0.9, -0.35, "100 mm")):
        left.plot([-half, half], [bottom, bottom], color="#c9a66b", linewidth=3)
        left.text(half + 0.05, bottom, words, fontsize=8, va="center")
    _arrow(left, (0, 0.9), (0, 0.05), "load")
    left.set(ylim=(-1.3, 1.4))
    _clean(left, "discs: given 60 and 100, held back 80 and repeats")
    wheel = np.array([[-0.3, -0.9], [0.3, -0.9], [0.3, 0.9], [-0.3, 0.9], [-0.3, -0.9]])
    a = math.radians(-30.0)
    wheel = wheel @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
    right.fill(*wheel.T, color="#c9a66b")
    _arrow(right, (0, 0), (0, 1.6))
    right.text(0.08, 1.5, "way", fontsize=9)
    _arrow(right, (0, 0), (1.4, 0.0))
    right.text(0.9, 0.15, "side force", fontsize=9)
    right.text(-1.9, 1.2, "slip angle: given\n0, 30, 60, 90°", fontsize=9)
    right.set(xlim=(-2, 2), ylim=(-1.5, 1.9))
    _clean(right, "wheel from above")
    assert case["data"]


def carve(figure: Any, case: dict[str, Any]) -> None:
    above, below = figure.subplots(2, 1, height_ratios=(1.3, 1))
    body = case["body"]
    s, width = np.array(body["station_m"]), np.array(body["width_m"])
    above.fill_between(s, -width / 2, width / 2, color="#c9a66b")
    above.axvspan(-0.15, 0.15, color=INK, alpha=0.25, linewidth=0)
    above.set(ylim=(-0.08, 0.08), ylabel="width (m)", title="the ski; dark: the clamp")
    below.plot(s, np.array(body["bending_stiffness_N_m2"]), color=INK, label="EI")
    below.plot(s, np.array(body["torsional_stiffness_N_m2"]), color="C1", label="GJ")
    below.set(xlabel="station (m), tip to the right", ylabel="N m²")
    below.legend(fontsize=8, frameon=False)


def turn(figure: Any, case: dict[str, Any]) -> None:
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1))
    answer = CASES / case["case"] / "answer.json"
    if answer.exists():
        import json

        places = np.array(json.loads(answer.read_text(encoding="utf-8"))["values"]["place_m"]).reshape(2, -1, 2)
        for row, words in zip(places, ("k = 10 H", "k = H"), strict=True):
            way = np.vstack([[0.0, 0.0], row])
            left.plot(way[:, 0], way[:, 1], "o-", markersize=4, label=words)
        left.legend(fontsize=8, frameon=False)
    left.set(
        xlabel="x down the fall line (m)", ylabel="y (m)", aspect="equal", title="places after 0.5, 1, 1.5 and 2 s"
    )
    _snow(right, (-0.5, 0.5), -0.15)
    angle, w = math.radians(case["body"]["edge_angle_deg"]), 0.053
    for y in (0.2, -0.2):
        c = np.array([y, w * math.sin(angle) - 0.01])
        t = np.array([math.cos(angle), -math.sin(angle)])
        ends = np.array([c - w * t, c + w * t])
        right.plot(*ends.T, color="#c9a66b", linewidth=3)
    right.plot([-0.2, -0.2, 0.2, 0.2], [0.04, 0.18, 0.18, 0.04], color=INK, linewidth=1.0)
    right.plot(0.0, 0.18, "o", color=INK)
    _arrow(right, (0.0, 0.18), (0.0, -0.05))
    right.text(0.02, 0.08, "m g", fontsize=9)
    right.set(xlim=(-0.5, 0.5), ylim=(-0.16, 0.3))
    _clean(right, "from behind, mirrored: both\nleft edges down")


def crossing(figure: Any, case: dict[str, Any]) -> None:
    axes = figure.subplots()
    half = 0.5 * case["body"]["first_width_m"]
    axes.fill_between([-0.6, 0.6], -half, half, color=DARK, linewidth=0)
    axes.text(-0.58, half + 0.015, "older track", fontsize=9)
    length, width = 0.5 * case["body"]["second_length_m"], 0.5 * case["body"]["second_width_m"]
    corner = np.array([[-length, -width], [length, -width], [length, width], [-length, width], [-length, -width]])
    for angle in case["motion"]["crossing_angle_deg"]:
        a = math.radians(angle)
        turned = corner @ np.array([[math.cos(a), math.sin(a)], [-math.sin(a), math.cos(a)]])
        axes.plot(*turned.T, linewidth=1.2, label=f"{angle:g}°")
    axes.legend(fontsize=8, frameon=False, loc="lower right")
    axes.set(xlim=(-0.6, 0.6))
    _clean(axes, "from above: the second runner on the older track")


DRAWINGS: Final[dict[str, Callable[[Any, dict[str, Any]], None]]] = {
    "01-plate": plate, "02-edge": edge, "03-cycles": cycles, "04-glide": glide,
    "05-sand": sand, "06-carve": carve, "07-turn": turn, "08-crossing": crossing,
}  # fmt: skip


def draw_all(form: str = "svg") -> None:
    """Into the folders of the cases."""
    from matplotlib import pyplot as plt

    for name, draw in DRAWINGS.items():
        figure = plt.figure(figsize=(7.0, 3.4), layout="constrained")
        draw(figure, read_case(name))
        figure.savefig(CASES / name / f"drawing.{form}", dpi=90, metadata={"Date": None} if form == "svg" else None)
        plt.close(figure)
