"""Runs at edge angles of 0 to 5°, where both edges may be in the snow."""

from __future__ import annotations

import numpy as np
import pytest

from skisnow import Run
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

STRAIGHT = {"start.heading_deg": 0.0}


def turned(degrees: float, **changes: object) -> Run:
    return simulate(load_scenario("carved-46m", changes=STRAIGHT | changes | {"sledge.edge_angle_deg": degrees}))


@pytest.mark.parametrize(
    ("degrees", "end"), [(0.5, (41.75, 24.47)), (1.0, (27.88, 33.15)), (2.0, (14.47, 32.41)), (3.0, (14.387, 32.395))]
)
def test_it_ends_where_the_shear_moves_across_at_once(degrees: float, end: tuple[float, float]) -> None:
    """The former rule moved the place of the shear across the base over ±2°. Over ±0.02° its ends are these.

    It had friction along the ski. From 3° on its blend had no effect.
    """
    run = turned(degrees, **{"friction.direction": "along-ski"})
    assert run.outcome == "finished"
    assert float(np.hypot(*(run.place[-1, :2] - end))) < 0.015


@pytest.mark.parametrize("degrees", [0.05, 1.0])
def test_mirrored_runs_end_at_mirrored_places(degrees: float) -> None:
    one, other = turned(degrees), turned(-degrees)
    assert other.place[-1] == pytest.approx(one.place[-1] * [1.0, -1.0, 1.0], abs=1e-6)
    assert one.place[-1, 1] > 1.0  # to the side of the edge


@pytest.mark.parametrize("degrees", [0.0, 0.02, 0.3, 1.0, 2.0])
@pytest.mark.parametrize("hardness", [0.01, 0.2, 2.0])
def test_a_start_is_found(degrees: float, hardness: float) -> None:
    run = turned(degrees, **{"run.duration_s": 0.02, "snow.H_V_N_per_mm3": hardness})
    assert run.outcome == "finished"


def test_the_widening_tail_brakes() -> None:
    """For a flat ski both edges push snow aside. The work is the shear's, 1.5 N in 52 m on this snow."""
    run = turned(0.0)
    assert run.energies["shear"][-1] / run.run_length == pytest.approx(1.52, abs=0.02)
    assert run.energy_balance_error == pytest.approx(0.0, abs=1e-4)


@pytest.mark.parametrize("degrees", [0.0, 1.0])
def test_half_the_step(degrees: float) -> None:
    """Steps of 1 ms and 0.5 ms end within the method's error."""
    fixed = {"solver.fixed": True, "run.duration_s": 1.0}
    one, other = (turned(degrees, **fixed, **{"solver.step_ms": step}) for step in (1.0, 0.5))
    assert other.place[-1] == pytest.approx(one.place[-1], abs=1e-3)
