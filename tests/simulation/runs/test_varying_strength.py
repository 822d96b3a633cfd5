"""Snow whose strength varies along the run."""

from __future__ import annotations

import numpy as np

from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

CHANGES = {"run.duration_s": 1.2, "solver.fixed": True}
WEAKER = 4.0
"""Distance (m) from which the snow is weaker."""


def test_the_same_strength_everywhere_gives_the_same_bits() -> None:
    scenario = load_scenario("carved-46m", changes=CHANGES)
    plain, asked = simulate(scenario), simulate(scenario, strength_along=lambda _: 1.0)
    assert np.array_equal(plain.place, asked.place)


def test_where_it_gets_weaker_the_edges_slip() -> None:
    """Nothing changes before; behind, the sledge runs wide like on snow that is weak from the beginning."""
    scenario = load_scenario("carved-46m", changes=CHANGES)
    distances: list[float] = []

    def strength(distance: float) -> float:
        distances.append(distance)
        return 0.1 if distance > WEAKER else 1.0

    plain, run = simulate(scenario), simulate(scenario, strength_along=strength)
    assert np.all(np.diff(distances) > 0.0)
    steps = np.linalg.norm(np.diff(plain.place, axis=0), axis=1)
    before = np.concatenate([[0.0], np.cumsum(steps)]) <= WEAKER
    assert 20 < before.sum() < len(before) - 20
    assert np.array_equal(run.place[: len(before)][before], plain.place[before])
    ahead = plain.place[-1] - plain.place[-2]
    aside = run.place[-1] - plain.place[-1]
    assert ahead[0] * aside[1] - ahead[1] * aside[0] < -0.05 * np.linalg.norm(ahead)  # the turn goes left
    assert run.energies["shear"][-1] > 1.2 * plain.energies["shear"][-1]  # 56 against 39 J
    assert run.energy_balance_error is not None
    assert run.energy_balance_error < 0.005
