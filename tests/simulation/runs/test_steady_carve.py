"""A steady carve on a level slope: the path's radius against R_sc cos ϑ and against the ski under the same load."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import Run, carve
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import snow

EDGE_DEG = 30.0
LEVEL = {
    "slope.angle_deg": 0.0,
    "start.heading_deg": 0.0,
    "start.speed_m_per_s": 8.0,
    "friction.mu_0": 0.0,
    "drag.drag_area_m2": 0.0,
    "snow.compaction_resistance": False,
    "sledge.centre_of_mass_height_m": 0.0,
    "run.duration_s": 3.0,
    "run.output_ms": 3.7,  # every 10 ms would meet the lines, four of which pass in that time, always alike
}


def steady(hardness: float, strength: float) -> Run:
    return simulate(
        load_scenario("carved-46m", changes={**LEVEL, "snow.H_V_N_per_mm3": hardness, "snow.S_f_N_per_mm2": strength})
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hardness", "strength", "of_sidecut", "of_chord"),
    [(0.2, 5.0, 0.04, 0.01), (1.0, 5.0, 0.015, 0.012), (5.0, 20.0, 0.01, 0.02), (20.0, 50.0, 0.01, 0.03)],
)
def test_radius(hardness: float, strength: float, of_sidecut: float, of_chord: float) -> None:
    """The path is that of the whole contact: the circle through the boot and the contact's ends, not that at the boot.

    Measured against R_sc cos ϑ: -3.0, -0.1, -0.1, +0.1 % at 0.2, 1, 5, 20 N/mm³; in soft snow the middle is deeper.
    Against the mean of both skis' chord circles under the loads they have in the run: -0.3, -0.0, -1.4, -1.9 %.
    The circle at the boot ± 0.4 m is 10 to 16 % larger: the clamp of 0.3 m straightens the ski there.
    """
    run = steady(hardness, strength)
    ski, edge = run.scenario.ski, math.radians(EDGE_DEG)
    late = run.time > 1.5
    path = np.trapezoid(run.speed[late], run.time[late])
    radius = float(path / (run.heading[late][-1] - run.heading[late][0]))
    assert radius == pytest.approx(ski.sidecut_radius_of_edge_line * math.cos(edge), rel=of_sidecut)
    loads = -np.trapezoid(run.skis.force_per_length[late], run.skis.station, axis=2).mean(axis=0)
    weight = (run.scenario.sledge.mass + 2.0 * ski.mass) * 9.81
    assert loads.sum() == pytest.approx(weight, rel=0.02)  # sampled at the nodes, every 45 mm
    assert loads[0] < loads[1]  # the edges lie left of the skis' middles: the right ski bears more
    found = [
        carve(ski, snow(hardness, strength), edge_angle=edge, load=float(load), unloading_ratio=10.0) for load in loads
    ]
    chord = [each.turn_radius_chord for each in found]
    boot = [each.turn_radius_boot for each in found]
    assert None not in chord
    assert None not in boot
    assert radius == pytest.approx(np.mean(np.array(chord, float)), rel=of_chord)
    assert 1.08 < np.mean(np.array(boot, float)) / radius < 1.18
