"""Draw the figure of the tutorial on designing a ski: python docs/figures_of_design.py."""

from __future__ import annotations

import math
from pathlib import Path

import skisnow
from skisnow.report.figures.style import BLUE, DOUBLE_MM, VERMILLION, journal_style, new_figure

PICTURE = Path(__file__).parent / "_static" / "ski" / "design.png"
TURN = {"published": "race-piste", "unloading_ratio": 10, "edge_angle_deg": 45, "load_N": 800}
TASK = {
    "ski": "slalom",
    "variables": {"sidecut_mm": [-10, 10], "EI_factor": [0.6, 1.6]},
    "conditions": [TURN],
    "goals": [{"output": "turn_radius_boot_m", "target": 12.0}],
    "starts": 2,
}


def draw_design() -> None:
    """Where stiffness acts on the radius, and the force along the edge before and after."""
    found = skisnow.design_ski(TASK)
    snow = skisnow.load_snow("race-piste")
    carves = [
        skisnow.carve(ski, snow, edge_angle=math.radians(45.0), load=800.0, unloading_ratio=10.0)
        for ski in (found.before, found.ski)
    ]
    fields = carves[0].derivatives().fields("turn_radius_boot_m")
    with journal_style():
        figure = new_figure(width_mm=DOUBLE_MM, height_mm=95.0)
        stiffness, force = figure.subplots(2, 1, sharex=True)
        stiffness.plot(fields["beam_m"], fields["EI_per_N_m3"], color=BLUE)
        stiffness.set_ylabel("radius by EI\n(m per N m² over 1 m)")
        for name, carve, colour in zip(("slalom", "12 m"), carves, (BLUE, VERMILLION), strict=True):
            force.plot(carve.station, carve.force_per_length, color=colour, label=name)
        force.set_ylabel("force per length\n(N/m)")
        force.set_xlabel("station from the boot (m)")
        force.legend(frameon=False)
        figure.savefig(PICTURE, dpi=150)


if __name__ == "__main__":
    draw_design()
    print(PICTURE)
