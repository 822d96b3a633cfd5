"""A track to identify from: the turn of the benchmarks with other parameters, 2 cm of noise at 10 Hz."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.track.track import Track

SCENARIO: Final = "carved-46m"
NOISE: Final = 0.02
"""Standard deviation (m) of each coordinate."""
INTERVAL: Final = 0.1
"""Between points (s)."""


@dataclass(frozen=True, slots=True)
class Case:
    """What is looked for, and the truth.

    Attributes
    ----------
    name, goal_s
        In the table; the time to stay below.
    truth
        By key; the search begins at the scenario's values.
    """

    name: str
    goal_s: float
    truth: Mapping[str, float]

    @property
    def keys(self) -> tuple[str, ...]:
        """Full names of what is looked for."""
        return tuple(self.truth)


THREE: Final = Case(
    "three parameters", 4.0, {"friction.mu_0": 0.03, "friction.mu_1_s_per_m": 0.002, "drag.drag_area_m2": 0.5}
)
SIX: Final = Case(
    "six parameters",
    8.0,
    {
        **THREE.truth,
        "snow.S_f_N_per_mm2": 0.4,
        "snow.H_V_N_per_mm3": 0.25,
        "sledge.edge_angle_deg": 31.0,
    },
)


def twin(case: Case, *, seed: int = 1, duration_s: float = 5.0) -> Track:
    """The track of the truth with noise."""
    run = simulate(load_scenario(SCENARIO, changes={**case.truth, "run.duration_s": duration_s}))
    at = np.searchsorted(run.time, np.arange(0.0, duration_s, INTERVAL) + 1e-9) - 1
    at = np.maximum(at, 0)
    place = run.place[at] + NOISE * np.random.default_rng(seed).standard_normal((len(at), 3))
    return Track(
        name="twin",
        time=run.time[at],
        place=place,
        speed=np.full(len(at), np.nan),
        time_scale="local",
        frame="slope",
        place_sd=np.full((len(at), 3), NOISE),
        axes="slope",
    )
