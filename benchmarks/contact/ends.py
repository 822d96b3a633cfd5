"""Ends of whole turns, and what they cost: for constants of the steps, which no motion by hand meets."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skisnow.scenario import load_scenario
from skisnow.simulation.run_setup import set_up

from ..turns.cases import SCENARIO, SKID

SECONDS = 5
RATE = {"snow.damping_N_s_per_mm3": 0.01, "snow.delayed_share": 0.3}
TURNS: dict[str, dict[str, object]] = {"carve": {}, "skid": dict(SKID), "rate": dict(RATE)}


@dataclass(frozen=True)
class End:
    """Where a turn ends (m), after how many evaluations of the contact."""

    place: list[float]
    looks: int

    def moved(self, other: End) -> str:
        """By how much it moves (mm), at how many times the evaluations."""
        way = 1e3 * np.linalg.norm(np.subtract(self.place, other.place))
        return f"{way if way > 1e-6 else 0:.2g} / {self.looks / other.looks:.2f}"


def all_ends() -> dict[str, End]:
    """Of the turns, with the default solver."""
    ends = {}
    for name, changes in TURNS.items():
        dynamics = set_up(load_scenario(SCENARIO, changes=changes)).dynamics
        for hundredths in range(1, 100 * SECONDS + 1):
            dynamics.advance(0.01 * hundredths)
        ends[name] = End([float(each) for each in dynamics.position], dynamics.counts[2])
    return ends
