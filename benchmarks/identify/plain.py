"""The same question put to `scipy.optimize.least_squares` as it comes: its own differences, run after run."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import least_squares

from skisnow.scenario import Stop, load_scenario, scenario_file
from skisnow.simulation.simulated_run import simulate
from skisnow.track.track import Track

from .twin import NOISE, SCENARIO, Case


@dataclass(frozen=True, slots=True)
class Plain:
    """What came out: values by key, rms residual (standard deviations), simulated runs."""

    values: dict[str, float]
    rms: float
    runs: int


def plainly_identified(case: Case, track: Track) -> Plain:
    """Trust region reflective, parameters scaled by their start (or 1), every run with the default solver."""
    keys = case.keys
    own = scenario_file(SCENARIO).values
    start = np.array([float(own[key]) for key in keys])
    scale = np.where(start != 0.0, np.abs(start), 0.01)
    runs = 0

    def residuals(scaled: np.ndarray) -> np.ndarray:
        nonlocal runs
        runs += 1
        values = {key: float(value) for key, value in zip(keys, scaled * scale, strict=True)}
        scenario = replace(load_scenario(SCENARIO, changes=values), stop=Stop(duration=float(track.time[-1]) + 1e-9))
        run = simulate(scenario)
        within = np.minimum(track.time, run.time[-1])
        place = CubicHermiteSpline(run.time, run.place[:, :2], run.velocity[:, :2])(within)
        return np.asarray((place - track.place[:, :2]).ravel() / NOISE)

    lower = np.array([-np.inf if key == "friction.mu_1_s_per_m" else 1e-4 for key in keys]) / scale
    found = least_squares(residuals, start / scale, bounds=(lower, np.full(len(keys), np.inf)))
    values = {key: float(value) for key, value in zip(keys, found.x * scale, strict=True)}
    return Plain(values, float(np.sqrt(np.mean(found.fun**2))), runs)
