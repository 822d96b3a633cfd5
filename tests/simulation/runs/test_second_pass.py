"""A ski that meets an older track: uphill until it stands, and back in its own groove."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import Run
from skisnow.scenario import Solver
from skisnow.simulation.simulated_run import simulate

from ...carving.synthetic import shovel
from .sledges import GRAVITY, rigid_ski, scenario

SPEED, ANGLE_DEG = 3.0, 10.0


def up_and_back(unloading_ratio: float, *, duration: float = 3.2) -> Run:
    """Up the fall line on flat rigid skis, without friction; backwards it meets the lines that it has left."""
    ski = rigid_ski(base_height=shovel(1.2, 0.03, 1.6), running_length=1.2)
    return simulate(
        scenario(
            ski=ski,
            angle_deg=ANGLE_DEG,
            hardness=0.001,
            unloading_ratio=unloading_ratio,
            heading_deg=180.0,
            speed=SPEED,
            duration=duration,
            solver=Solver(tolerance=1e-8),
        )
    )


def test_elastic_snow_gives_back_everything() -> None:
    """Up v²/(2 g sin α), and as fast down as up at the same place: snow that springs back has no second pass."""
    run = up_and_back(1.0)
    x = run.place[:, 0]
    assert x.min() == pytest.approx(-(SPEED**2) / (2.0 * GRAVITY * math.sin(math.radians(ANGLE_DEG))), rel=1e-3)
    top = int(np.argmin(x))
    height = math.sin(math.radians(ANGLE_DEG)) * (x - x[top])
    assert run.speed == pytest.approx(np.sqrt(2.0 * GRAVITY * np.maximum(height, 0.0)), rel=2e-3, abs=5e-3)
    assert abs(run.energies["penetration"][-1]) < 1e-3


def test_groove_is_paid_for_once() -> None:
    """The way back, 1.8 m in the groove of the way up, costs less than a tenth of what that part of it had cost."""
    run = up_and_back(10.0)
    x, lost = run.place[:, 0], run.energies["penetration"]
    top = int(np.argmin(x))
    back = x[-1] - x[top]
    assert back > 1.5
    first = lost[top] - np.interp(-x[-1], -x[: top + 1], lost[: top + 1])
    assert first > 2.5
    assert 0.0 <= lost[-1] - lost[top] < 0.1 * first
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < 1e-4


def test_it_stands_deeper_in_the_groove_than_in_virgin_snow() -> None:
    """The groove was cut by the shovel's load; on the way back it bears the even load without sinking further."""
    run = up_and_back(10.0)
    x = run.place[:, 0]
    top = int(np.argmin(x))
    up = float(np.interp(1.2, -x[: top + 1], run.skis.depth[: top + 1, 0]))
    down = float(np.interp(-1.2, x[top:], run.skis.depth[top:, 0]))
    cut = float(np.median(run.groove.depth))
    assert up < down < cut
    assert down == pytest.approx(cut, rel=0.02)


def test_a_track_counts_once() -> None:
    """All energy in the snow at the end, piece by piece of every 24 mm, does not exceed what was taken from the motion.

    On the way up pieces are archived; the way back takes them over and archives them again.
    Counted twice, the loss would double.
    """
    run, half = up_and_back(10.0), up_and_back(10.0, duration=1.7)
    assert run.energies["penetration"][-1] == pytest.approx(half.energies["penetration"][-1], rel=0.1)
