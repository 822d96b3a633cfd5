"""Draw docs/_static/validation/hybrid-turns.png: python docs/figure_of_hybrid_turns.py.

Slip, edge and lean of a skier in the first four of 20 hybrid turns on 10°, and the load of each ski.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1]))
from benchmarks.skier.cases import HYBRID, Start

from skisnow import simulate
from skisnow.report.figures.style import BLUE, DOUBLE_MM, GREEN, GREY, PALE, VERMILLION, journal_style, new_figure
from skisnow.skier import BalancedSkier
from skisnow.skier.posture import ASIDE, LEFT_EDGE

PICTURE = Path(__file__).resolve().parent / "_static" / "validation" / "hybrid-turns.png"
CASE = replace(next(case for case in HYBRID if case.name.startswith("20 gates, 16 m")), gates=5)


def draw() -> None:
    """Draw the figure."""
    skier = BalancedSkier(CASE.scenario(Start()))
    run = simulate(skier.scenario, boots=skier)
    seen, posture = [each.seen for each in skier.records], np.array([each.posture for each in skier.records])
    x = np.array([each.place[0] for each in seen])
    lean = np.arctan2(posture[:, ASIDE], skier.scenario.sledge.centre_of_mass[1])
    weight = skier.scenario.sledge.mass * run.scenario.gravity
    with journal_style():
        figure = new_figure(width_mm=DOUBLE_MM, height_mm=110.0)
        angles, loads = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
        course = np.array([each.course for each in seen])
        for name, values, colour, width in (
            ("course from the fall line", course, GREY, 1.0),
            ("slip", np.array([each.slip for each in seen]), VERMILLION, 1.5),
            ("edge angle, left ski", posture[:, LEFT_EDGE], BLUE, 1.5),
            ("lean", lean, GREEN, 1.0),
        ):
            angles.plot(x, np.degrees(values), color=colour, linewidth=width, label=name)
        for axes in (angles, loads):
            for gate in run.scenario.course.gates if run.scenario.course else ():
                axes.axvline(gate.turning[0], color=PALE, linewidth=0.6, zorder=0)
        angles.axhline(0.0, color=PALE, linewidth=0.6, zorder=0)
        angles.set_ylabel("angle, positive to the left (°)")
        angles.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
        for name, load, colour in (
            ("left", [each.left for each in seen], BLUE),
            ("right", [each.right for each in seen], VERMILLION),
        ):
            smooth = np.convolve(np.array(load) / weight, np.full(4, 0.25), "same")
            loads.plot(x, smooth, color=colour, linewidth=1.0, label=f"{name} ski")
        loads.set_xlabel("place down the slope (m); grey: gates")
        loads.set_ylabel("load (weights)")
        loads.legend(ncols=2, loc="upper left", frameon=False)
        figure.savefig(PICTURE, dpi=150)


if __name__ == "__main__":
    draw()
