"""Four gates by direct optimisation of a line through nodes, as Hirano (2006) solves them: what three numbers lose."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize

from skisnow import load_scenario, race
from skisnow.racing import PointRacer, follower_line
from skisnow.racing.line import first_gates

SLALOM = load_scenario("slalom-20-gates")
FOUR = first_gates(follower_line(SLALOM), 4)
NODES = 6
"""Length of each way from gate to gate."""
LOST = 0.01
"""Time (s)."""


@dataclass
class FreeLine:
    """A cubic spline through nodes, along the fall line at the start."""

    x: npt.NDArray[np.float64]
    y: npt.NDArray[np.float64]
    spline: Any = field(init=False)

    def __post_init__(self) -> None:
        ends: Any = ((1, 0.0), (2, 0.0))
        self.spline = CubicSpline(self.x, np.array([0.0, *self.y]), bc_type=ends)

    def at(self, x: float) -> tuple[float, float, float]:
        return float(self.spline(x)), float(self.spline(x, 1)), float(self.spline(x, 2))


def nodes() -> npt.NDArray[np.float64]:
    gates = [0.0, *(gate.turning[0] for gate in FOUR.course.gates)]
    return np.unique(np.concatenate([np.linspace(a, b, NODES + 1) for a, b in pairwise(gates)]))


def quickest_free_line(racer: PointRacer) -> tuple[float, FreeLine]:
    """Its time to the last gate (s), by sequential quadratic programming."""
    x = nodes()

    def line(y: npt.NDArray[np.float64]) -> FreeLine:
        return FreeLine(x, y)

    def time(y: npt.NDArray[np.float64]) -> float:
        return float(racer.motion(line(y), x.tolist())[2][-1])

    def clear(y: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Distance of the nearer side from each pole."""
        found = []
        for gate in FOUR.course.gates:
            place, slope, _ = line(y).at(gate.turning[0])
            beside = (place - gate.turning[1]) * (1.0 if gate.side == "left" else -1.0)
            found.append(beside - racer.half_width * np.hypot(1.0, slope))
        return np.array(found)

    def bent(y: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Below the greatest curvature."""
        place = np.linspace(x[0], x[-1], 241)
        spline = line(y).spline
        curvature = spline(place, 2) / (1.0 + spline(place, 1) ** 2) ** 1.5
        return np.concatenate([1.0 - racer.least_radius * curvature, 1.0 + racer.least_radius * curvature])

    begin = np.array([FOUR.at(float(each))[0] for each in x[1:]])
    constraints: Any = [{"type": "ineq", "fun": clear}, {"type": "ineq", "fun": bent}]
    found = minimize(time, begin, method="SLSQP", constraints=constraints, options={"maxiter": 200, "ftol": 1e-7})
    assert found.success, found.message
    assert clear(found.x).min() > -1e-6
    assert bent(found.x).min() > -1e-6
    return float(found.fun), line(found.x)


@pytest.mark.slow
def test_three_numbers_a_turn_lose_little_to_a_free_line() -> None:
    """What docs/how-to/race.md says."""
    pytest.importorskip("cmaes")
    free, _ = quickest_free_line(PointRacer.of(SLALOM))
    found = race(SLALOM, gates=4, model="point", evaluations=1000, seed=1, workers=1).score.time
    assert found is not None
    assert 0.0 < found - free < LOST
