"""Differences between runs, and from solutions apart, whose cause is known: docs/validation/simulated-turn.md."""

import math
from typing import Any

import numpy as np
import pytest

from skisnow import Run, simulate
from skisnow.scenario import load_scenario

pytestmark = pytest.mark.slow


def run(**changes: Any) -> Run:
    return simulate(load_scenario("carved-46m", changes=changes))


def test_on_ice_fixed_steps_keep_a_change_of_rounding_small() -> None:
    """7 · 10⁻¹² m/s of the start. Steps that adapt are shortened elsewhere, which moves the end by their error."""
    ice: dict[str, Any] = {"H_V_N_per_mm3": 90.0, "S_f_N_per_mm2": 0.3, "duration_s": 3.0}
    ends = [
        run(**ice, **{"solver.fixed": True, "solver.step_ms": 0.25, "start.speed_m_per_s": 7.0 * factor}).place[-1]
        for factor in (1.0, 1.0 + 1e-12)
    ]
    assert 1e-12 < math.dist(*ends) < 1e-9


@pytest.mark.parametrize(("hardness", "strength"), [(0.2, 0.1), (1.0, 0.25), (5.0, 0.3)])
def test_skids_end_within_the_error_of_the_method(hardness: float, strength: float) -> None:
    snow: dict[str, Any] = {"H_V_N_per_mm3": hardness, "S_f_N_per_mm2": strength, "length_m": 15.0}
    ends = [run(**snow, **more).place[-1] for more in ({}, {"solver.fixed": True, "solver.step_ms": 0.125})]
    assert math.dist(*ends) < 7e-3


def test_a_bent_ski_carries_the_sum_of_what_presses_on_its_base() -> None:
    """Friction at 52° acts on Σ max(0, N cos ϑ + Z sin ϑ), which is far above that sum for the whole ski."""
    angle = math.radians(52.0)
    turn = run(edge_angle_deg=52.0, mu_0=0.05, acts_on="base-normal", duration_s=2.0)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(turn.place, axis=0), axis=1))])
    load = np.gradient(turn.energies["friction"], way) / 0.05
    skis, spacing = turn.skis, np.abs(np.gradient(turn.skis.station))
    aside = np.sign((skis.shear_per_length * spacing).sum(axis=-1))[..., None] * skis.shear_per_length
    on_base = (skis.force_per_length * math.cos(angle) + aside * math.sin(angle)) * spacing
    whole, parts = on_base.sum(axis=(1, 2)), np.maximum(on_base, 0.0).sum(axis=(1, 2))
    late = slice(len(way) // 2, None)
    assert np.median(load[late] / parts[late]) == pytest.approx(1.0, abs=0.06)
    assert np.median(load[late] / whole[late]) > 1.5
