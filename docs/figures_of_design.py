"""Draw the figure of the tutorial on designing a ski: python docs/figures_of_design.py."""

from __future__ import annotations

import contextlib
import math
import runpy
from pathlib import Path
from tempfile import TemporaryDirectory

import skisnow
from skisnow.report.figures.style import BLUE, DOUBLE_MM, VERMILLION, journal_style, new_figure

PICTURE = Path(__file__).parent / "_static" / "ski" / "design.png"
EXAMPLE = Path(__file__).parents[1] / "examples" / "gallery" / "twelve_metres.py"


def draw_design() -> None:
    """Where stiffness acts on the radius, and the force along the edge before and after."""
    with TemporaryDirectory() as folder, contextlib.chdir(folder):
        example = runpy.run_path(str(EXAMPLE))
    carves = {
        name: skisnow.carve(ski, example["snow"], edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
        for name, ski in example["skis"].items()
    }
    fields = carves["slalom"].derivatives().fields("turn_radius_boot_m")
    with journal_style():
        figure = new_figure(width_mm=DOUBLE_MM, height_mm=95.0)
        stiffness, force = figure.subplots(2, 1, sharex=True)
        stiffness.plot(fields["beam_m"], fields["EI_per_N_m3"], color=BLUE)
        stiffness.set_ylabel("radius by EI\n(m per N m² over 1 m)")
        for (name, carve), colour in zip(carves.items(), (BLUE, VERMILLION), strict=True):
            force.plot(carve.station, carve.force_per_length, color=colour, label=name)
        force.set_ylabel("force per length\n(N/m)")
        force.set_xlabel("station from the boot (m)")
        force.legend(frameon=False)
        figure.savefig(PICTURE, dpi=150)


if __name__ == "__main__":
    draw_design()
    print(PICTURE)
