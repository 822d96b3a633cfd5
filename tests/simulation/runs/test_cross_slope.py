"""A sledge set down across a slope: it holds while S_f ∫ e ds of both edges exceeds m g sin α.

Beyond it slides, braked by μ N as well.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import Run
from skisnow.forces.shear.displacement import SHEAR_DISPLACEMENT as HOLDING
from skisnow.scenario import Solver
from skisnow.simulation.simulated_run import simulate

from .sledges import GRAVITY, rigid_ski, scenario, total_mass

SLOPE_DEG, LENGTH, HARDNESS, FRICTION = 10.0, 1.6, 0.2, 0.05


def across(*, strength: float, duration: float, heading_deg: float = 90.0, edge_deg: float = 20.0) -> Run:
    """Facing left, the edges on the left, uphill, down."""
    solver = Solver(step=2e-3, fixed=True, output_interval=0.1)
    return simulate(
        scenario(
            ski=rigid_ski(length=LENGTH),
            hardness=HARDNESS,
            angle_deg=SLOPE_DEG,
            edge_deg=edge_deg,
            heading_deg=heading_deg,
            strength=strength,
            friction=FRICTION,
            centre_height=0.05,
            duration=duration,
            solver=solver,
        )
    )


def sufficient_strength() -> float:
    """S_f (N/mm²) = m g sin α/(e₁ L + e₂ L), with the depths e at which both edges are at the start."""
    run = across(strength=1.0, duration=2e-3)
    assert run.outcome == "finished"
    demand = total_mass(run.scenario) * GRAVITY * math.sin(math.radians(SLOPE_DEG))
    return float(demand / (LENGTH * run.skis.edge_depth[0].mean(axis=1).sum())) / 1e6


@pytest.mark.parametrize("share", [0.5, 0.9, 0.97])
def test_holds_below_the_limit(share: float) -> None:
    """It gives way by some millimetres as the load comes on at once, and stands, swinging in its grip."""
    run = across(strength=sufficient_strength() / share, duration=3.0)
    assert run.outcome == "finished"
    assert np.ptp(run.place[10:, 0]) < 1.25 * HOLDING
    # the load comes on at once: it stops where the work of the weight is that of the grip, elastic, then full
    given_way = HOLDING * ((share - 0.5) / (1.0 - share) + 1.0) if share > 0.5 else 2.0 * share * HOLDING
    assert run.place[-1, 0] < 1.1 * given_way
    assert np.abs(run.place[:, 1]).max() < 1e-6


@pytest.mark.parametrize("share", [1.03, 1.1])
def test_slips_above_the_limit(share: float) -> None:
    """Downhill, ever faster, about as fast as what is lacking allows: (1 - 1/share) g (sin α - μ cos α) t²/2."""
    slope = math.radians(SLOPE_DEG)
    left = math.sin(slope) - FRICTION * math.cos(slope)
    run = across(strength=sufficient_strength() * left / math.sin(slope) / share, duration=3.0)
    free = (1.0 - 1.0 / share) * GRAVITY * left * 3.0**2 / 2.0
    assert np.all(np.diff(run.place[5:, 0]) > 0.0)
    assert 0.5 * free < run.place[-1, 0] < 2.5 * free


def test_mirrored_it_holds_as_well() -> None:
    """Facing right with the right edges down: the same, mirrored."""
    strength = sufficient_strength() / 0.9
    left = across(strength=strength, duration=1.0)
    right = across(strength=strength, duration=1.0, heading_deg=-90.0, edge_deg=-20.0)
    assert right.place == pytest.approx(left.place * [1.0, -1.0, 1.0], abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("strength", [0.1, 0.5])
def test_no_creep_in_a_minute(strength: float) -> None:
    """30 000 steps of 2 ms; a shear force that depends on the sliding speed alone would creep."""
    run = across(strength=strength, duration=60.0)
    assert run.outcome == "finished"
    assert np.linalg.norm(run.place[-1] - run.place[100]) < 1.25 * HOLDING  # it swings in its grip
    assert np.ptp(run.place, axis=0).max() < 1e-3
    assert abs(run.heading[-1] - math.pi / 2.0) < 1e-6
