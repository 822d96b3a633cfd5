"""Draw docs/_static/contact.png: python docs/figure_of_contact.py.

Frames, a line, and the plane section over it with edge, base, groove and pressure; the ground is what the core keeps.
"""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from skisnow.contact import Runner, SnowContact, SnowField

PLACE = Path(__file__).resolve().parent / "_static" / "contact.png"
ANGLE, HALF, DEEPEST, NOW = math.radians(35.0), 0.033, 5e-3, 4.75e-3
BLUE, BROWN, GREY, RED = "#1f5fa8", "#8a5a2b", "#888888", "#b3261e"


def arrow(axes: Axes, at: tuple[float, float], to: tuple[float, float], name: str, colour: str = "black") -> None:
    """An arrow with its name at the tip."""
    axes.annotate("", to, at, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.4})
    axes.annotate(name, to, xytext=(4, 4), textcoords="offset points", color=colour)


def plan(axes: Axes) -> None:
    """The ski from above, over its lines."""
    along = np.linspace(-0.8, 0.8, 81)
    half = 0.033 + along**2 / 36.0
    turn = math.radians(12.0)
    c, s = math.cos(turn), math.sin(turn)
    x, y = np.concatenate([along, along[::-1]]), np.concatenate([half, -half[::-1]])
    axes.fill(c * x - s * y, s * x + c * y, facecolor="#dce8f5", edgecolor=BLUE)
    for station in np.arange(-0.9, 0.95, 0.1):
        ends = np.array([-0.14, 0.14])
        marked = abs(station - 0.3) < 1e-9
        axes.plot(
            c * station - s * ends, s * station + c * ends, color=RED if marked else GREY, lw=1.4 if marked else 0.5
        )
    axes.annotate(
        "a line, origin o",
        (c * 0.3 + s * 0.14, s * 0.3 - c * 0.14),
        xytext=(4, -10),
        textcoords="offset points",
        color=RED,
    )
    arrow(axes, (0, 0), (0.45 * c, 0.45 * s), "0 ahead", BLUE)
    arrow(axes, (0, 0), (-0.2 * s, 0.2 * c), "1 left", BLUE)
    axes.plot(0, 0, "o", color=BLUE, ms=4)
    axes.annotate("boot c", (0, 0), xytext=(-16, -14), textcoords="offset points", color=BLUE)
    arrow(axes, (-0.95, -0.35), (-0.7, -0.35), "x")
    arrow(axes, (-0.95, -0.35), (-0.95, -0.1), "y")
    axes.set(xlim=(-1.05, 1.05), ylim=(-0.42, 0.42), aspect="equal", title="From above (lines drawn five times apart)")


def kept_ground() -> tuple[np.ndarray, np.ndarray]:
    """Place and depth of the groove that the core keeps after the deepest pose."""
    runner = Runner(np.array([0.4, -0.4]), np.full(2, HALF), np.zeros(2))
    contact = SnowContact(SnowField(2e8, 3e5, 10.0), [runner])
    contact.update(*pose(DEEPEST), 0.0)
    rows = contact.tracks()
    line = rows[rows[:, 1] == 0]
    return 1e3 * line[:, 3], -1e3 * line[:, 5]


def pose(depth: float) -> tuple[np.ndarray, np.ndarray]:
    """The boot and its rotation where the edge is that deep."""
    s, c = math.sin(ANGLE), math.cos(ANGLE)
    return np.array([[0.0, 0.0, HALF * s - depth]]), np.array([[[1, 0, 0], [0, c, s], [0, -s, c]]], float)


def section(axes: Axes) -> None:
    """Across: the base over the groove, its edge, and the pressure."""
    s, c = math.sin(ANGLE), math.cos(ANGLE)
    middle = 1e3 * (HALF * s - NOW)
    edge = np.array([1e3 * HALF * c, -1e3 * NOW])
    axes.axhline(0.0, color=GREY, lw=1)
    y, z = kept_ground()
    axes.plot(y, z, "o-", color=BROWN, ms=4, label="ground: greatest depth ever")
    axes.plot([y[-1], y[-1]], [z[-1], 0.0], ":", color=BROWN)  # virgin snow beside it
    axes.plot([-3.0, edge[0]], [middle + 3.0 * s / c, edge[1]], color=BLUE, lw=2, label="base now")
    for share in np.linspace(0.0, 1.0, 12):
        place = edge[0] - share * 1e3 * NOW * c / s
        depth = NOW * (1.0 - share)
        pressure = depth - 9.0 * max(DEEPEST * (1 + (place - y[-1]) * 1e-3 * s / c / DEEPEST) - depth, 0.0)
        if pressure > 0:
            axes.annotate(
                "",
                (place, -1e3 * depth),
                (place, -1e3 * depth - 600 * pressure),
                arrowprops={"arrowstyle": "->", "color": RED},
            )
    axes.plot(*edge, "o", color=BLUE)
    axes.annotate("edge: depth d, place y$_e$", edge, xytext=(8, -2), textcoords="offset points", color=BLUE)
    arrow(axes, (16.5, -7.2), (19.5, -7.2), "b (left)")
    arrow(axes, (16.5, -7.2), (16.5, -4.6), "n")
    axes.annotate("ϑ", (17.6, 0.3), color=BLUE)
    axes.annotate("p", (edge[0] - 2.3, -6.9), color=RED)
    axes.set(
        xlim=(15, 40),
        ylim=(-8.5, 6),
        xlabel="across, to the left (mm)",
        ylabel="out of the snow (mm)",
        aspect="equal",
        title="The plane section over that line",
    )
    axes.legend(loc="upper right", frameon=False)


if __name__ == "__main__":
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    plan(left)
    left.set_axis_off()
    section(right)
    figure.savefig(PLACE, dpi=130, metadata={"Software": None})
