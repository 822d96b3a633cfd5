"""A sledge that side-slips down on its uphill edges: each ski is a wedge on virgin snow, whatever the snow keeps.

After a slip of its stance the uphill ski runs on the flat ground that the other has cut, at the depth e_g. With e_v on
virgin snow its wedge bears H_V (e² - e_g²)/2 + H_V² e_g²/(2 k_u) = H_V e_v²/2, so that e² = e_v² + e_g² (1 - H_V/k_u).
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from skisnow import Run
from skisnow.scenario import Solver
from skisnow.simulation.simulated_run import simulate

from .sledges import GRAVITY, load, rigid_ski, scenario, total_mass

HARDNESS, STRENGTH, LENGTH, STANCE = 0.2, 0.06, 1.6, 0.5
EDGE, SLOPE = math.radians(20.0), math.radians(20.0)


@cache
def slipping(ratio: float) -> Run:
    run = simulate(
        scenario(
            ski=rigid_ski(length=LENGTH),
            hardness=HARDNESS,
            strength=STRENGTH,
            unloading_ratio=ratio,
            angle_deg=math.degrees(SLOPE),
            edge_deg=math.degrees(EDGE),
            heading_deg=90.0,
            stance=STANCE,
            duration=1.4,
            solver=Solver(output_interval=0.02),
        )
    )
    assert run.outcome == "finished"
    return run


def acceleration(run: Run, low: float, high: float) -> float:
    """Mean over a part of the way (m/s²)."""
    way = run.place[:, 0]
    within = (way > low) & (way < high)
    return float(2.0 * np.polynomial.polynomial.polyfit(run.time[within], way[within], 2)[2])


def slipping_down(run: Run, depths: float) -> float:
    """g sin α - S_f L (e₁ + e₂)/m."""
    return GRAVITY * math.sin(SLOPE) - STRENGTH * 1e6 * LENGTH * depths / total_mass(run.scenario)


@pytest.mark.parametrize("ratio", [1.0, 10.0])
def test_virgin_snow_until_the_stance(ratio: float) -> None:
    """e = √(2 F tan ϑ/(H_V L)) for each ski, for any k_u; as they bear unequally the sum of depths is 0.3 % less."""
    run = slipping(ratio)
    depth = math.sqrt(load(run.scenario) * math.tan(EDGE) / (HARDNESS * 1e9 * LENGTH))
    assert acceleration(run, 0.05, 0.45) == pytest.approx(slipping_down(run, 2.0 * depth), rel=0.01)
    late = (run.place[:, 0] > 0.2) & (run.place[:, 0] < 0.45)
    assert run.skis.edge_depth[late].mean(axis=(0, 2)).sum() == pytest.approx(2.0 * depth, rel=5e-3)


def test_deeper_in_the_groove_of_the_other() -> None:
    """Where snow keeps its groove the grip grows by a fifth; where it springs back nothing changes.

    The uphill ski falls into the groove at once and swings there: that costs it 4 % over many swings.
    """
    run, elastic = slipping(10.0), slipping(1.0)
    before = (run.place[:, 0] > 0.2) & (run.place[:, 0] < 0.45)
    uphill, downhill = run.skis.edge_depth[before].mean(axis=(0, 2))
    deeper = math.sqrt(uphill**2 + downhill**2 * 0.9)
    assert acceleration(run, 0.6, 1.0) == pytest.approx(slipping_down(run, downhill + deeper), rel=0.05)
    assert acceleration(elastic, 0.6, 1.0) == pytest.approx(slipping_down(run, downhill + uphill), rel=0.01)
