"""Where the energy goes: accounts of one run close."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.dynamics import Dynamics, Ended, StepControl

from .sledges import ahead, given, sledge, started

FloatArray = npt.NDArray[np.float64]
DURATION: Final = 0.5
SHARE: Final = 2e-4
CASES: Final = {
    "carves": {},
    "skids": {"snow__S_f_N_per_mm2": 0.1},
    "elastic": {"snow__unloading_ratio": 1.0},
    "edged": {"sledge__edge_angle_deg": 45.0},
    "hard": {"snow__H_V_N_per_mm3": 5.0},
}


def accounts(dynamics: Dynamics) -> FloatArray:
    """Kinetic, potential, elastic in the skis, taken by shear and friction, not given by the snow, air, damping (J)."""
    shear, friction, normal, drag, damping, _ = dynamics.work
    return np.array([*dynamics.energies, shear, friction, -normal, drag, damping])


def in_snow(dynamics: Dynamics) -> float:
    """Elastic in the snow, and lost in grooves (J)."""
    return dynamics.snow_energies[0] + dynamics.contact.groove_energy


@pytest.mark.parametrize("changes", CASES.values(), ids=CASES)
def test_the_balance_closes(changes: dict[str, float]) -> None:
    """Against what was turned over between looks 20 ms apart; slip loses what displaced edges do not hold."""
    dynamics = started(given(**changes))
    history = [accounts(dynamics)]
    for time in np.linspace(0.0, DURATION, 26)[1:]:
        assert dynamics.advance(float(time)) is Ended.REACHED
        history.append(accounts(dynamics))
    moved = np.diff(history, axis=0)
    turned_over = 0.5 * float(np.abs(moved).sum())
    assert turned_over > 400.0
    assert abs(moved.sum()) < SHARE * turned_over
    shear, friction, drag, damping = moved.sum(axis=0)[[3, 4, 6, 7]]
    assert shear > dynamics.snow_energies[1]
    assert min(friction, drag, damping) > 0.0


@pytest.mark.parametrize(("hardness", "within"), [(0.03, 3e-4), (0.2, 2e-3)])
def test_what_the_snow_takes_is_in_its_grooves(hardness: float, within: float) -> None:
    """Straight on with a ski whose edges are straight: a flare, and an edge that comes from the side, press the groove
    without a force of their own. A line enters under the tip at once: what that leaves goes down with the spacing.
    Grooves are pressed at the deepest place on the way, work is summed at ends of steps: 1 % apart at 3e-8."""
    scenario = given(sledge__edge_angle_deg=0.0, start__heading_deg=0.0, snow__H_V_N_per_mm3=hardness)
    straight = replace(scenario.ski, width=np.full_like(scenario.ski.width, 0.07))
    dynamics = sledge(replace(scenario, ski=straight), StepControl(tolerance=3e-9), spacing=0.005)
    dynamics.find_equilibrium()
    dynamics.begin(ahead(scenario.start.speed))
    before = in_snow(dynamics)
    assert dynamics.advance(DURATION) is Ended.REACHED
    kept = in_snow(dynamics) - before
    assert kept > 0.5
    assert -dynamics.work[2] == pytest.approx(kept, rel=within)
