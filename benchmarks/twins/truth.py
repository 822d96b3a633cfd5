"""A true run with finer numbers than those of an identification, and the track that a receiver makes of it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from skisnow import Run
from skisnow.scenario import Scenario, load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.track.track import Track

SCENARIOS: Final = ("giant-slalom-67m", "carver-42m")
SEEDS: Final = range(200)
FREE: Final = ("friction.mu_0", "drag.drag_area_m2", "start.heading_deg")
"""The unknowns, from the scenario's own values."""
NOISE: Final = 0.02
"""Standard deviation (m) of each coordinate."""
EVERY: Final = 10
"""A point for every tenth output: 10 Hz."""
FINER: Final = 2.0
"""By how much elements, lines, cells and tolerance are finer than those of the identification."""
ERRORS: Final = ("friction law", "varying S_f", "drift")
MU_1: Final = 0.003
"""s/m, of a friction that rises with speed where the identification knows a constant one."""
WAVE: Final = 20.0
"""Length (m) over which the true S_f falls to half of the one taken for granted, and rises again."""
DRIFT: Final = 0.01
"""m/s, of a receiver whose places wander off in one direction: 6 to 10 cm at the end."""


@dataclass(frozen=True, slots=True)
class Truth:
    """What is true of one seed: the values looked for by key, the model error ("" for none)."""

    values: Mapping[str, float]
    error: str


def truth_of(scenario: str, seed: int) -> Truth:
    """Even seeds without model error, odd ones with each of the three in turn."""
    rng = np.random.default_rng([seed, SCENARIOS.index(scenario)])
    values = (rng.uniform(0.02, 0.06), rng.uniform(0.15, 0.55), rng.uniform(-93.0, -87.0))
    return Truth(dict(zip(FREE, map(float, values), strict=True)), ERRORS[seed // 2 % 3] if seed % 2 else "")


def true_run(scenario: str, truth: Truth) -> Run:
    """The run of the truth, with its model error, on a finer mesh."""
    changes: dict[str, object] = dict(truth.values)
    if truth.error == "friction law":
        changes["friction.mu_1_s_per_m"] = MU_1
    asked = finer(load_scenario(scenario, changes=changes))
    return simulate(asked, strength_along=_strength_along if truth.error == "varying S_f" else None)


def _strength_along(distance: float) -> float:
    return 0.75 + 0.25 * math.cos(2.0 * math.pi * distance / WAVE)


def finer(asked: Scenario) -> Scenario:
    """Half the tolerance and, against what would be chosen, twice the elements, half the other choices."""
    chosen = simulate(replace(asked, stop=replace(asked.stop, duration=1e-3, length=None))).numbers
    solver = replace(
        asked.solver,
        tolerance=asked.solver.tolerance / FINER,
        elements=round(chosen["elements"] * FINER),
        line_spacing=chosen["line_spacing_m"] / FINER,
        groove_tolerance=asked.solver.groove_tolerance / FINER,
    )
    return replace(asked, solver=solver)


def track_of(run: Run, truth: Truth, seed: int, *, noise: float = NOISE) -> Track:
    """White noise at 10 Hz, and the drift where there is one; the receiver states its noise, not its drift."""
    rng = np.random.default_rng([seed, 7])
    time, place = run.time[::EVERY], run.place[::EVERY].copy()
    place += noise * rng.standard_normal(place.shape)
    if truth.error == "drift":
        azimuth = rng.uniform(0.0, 2.0 * math.pi)
        place[:, :2] += DRIFT * time[:, None] * [math.cos(azimuth), math.sin(azimuth)]
    sd = np.full(place.shape, NOISE)
    unknown = np.full(len(time), np.nan)
    return Track(
        name="twin", time=time, place=place, speed=unknown, time_scale="local", frame="slope", place_sd=sd, axes="slope"
    )
