"""Six parameters from one simulated track: six that it tells, and six of which it tells the sum and not the parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import pytest

from skisnow.identification import Identification, identify
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.track.track import Track

SCENARIO: Final = "carved-46m"
NOISE: Final = 0.02
TOLD: Final = {
    "friction.mu_0": 0.03,
    "sledge.edge_angle_deg": 31.0,
    "start.speed_m_per_s": 7.2,
    "start.heading_deg": -28.0,
    "start.x_m": 0.3,
    "start.y_m": -0.2,
}
OF_THE_SNOW: Final = {
    "friction.mu_0": 0.03,
    "friction.mu_1_s_per_m": 0.002,
    "drag.drag_area_m2": 0.5,
    "snow.S_f_N_per_mm2": 0.4,
    "snow.H_V_N_per_mm3": 0.25,
    "sledge.edge_angle_deg": 31.0,
}


def twin(truth: Mapping[str, float], duration_s: float) -> Track:
    """Ten points a second with 2 cm of noise, stated."""
    run = simulate(load_scenario(SCENARIO, changes={**truth, "run.duration_s": duration_s, "run.output_ms": 10.0}))
    time, place = run.time[::10], run.place[::10].copy()
    place += NOISE * np.random.default_rng(6).standard_normal(place.shape)
    return Track(
        name="twin", time=time, place=place, speed=np.full(len(time), np.nan), time_scale="local", frame="slope",
        place_sd=np.full(place.shape, NOISE), axes="slope",
    )  # fmt: skip


def rms_residual(found: Identification) -> float:
    return float(np.sqrt(np.mean([(fit.residual[:, :2] / fit.sd[:, :2]) ** 2 for fit in found.fits])))


@pytest.mark.slow
def test_six_that_a_track_tells() -> None:
    """Each within four standard errors. The six squares go with χ²: below 22.5 but for one case in a thousand."""
    found = identify(SCENARIO, twin(TOLD, 3.0), list(TOLD))
    assert found.outcome == "converged"
    values = np.array([found[key].value for key in TOLD], dtype=float)
    away = values - np.array(list(TOLD.values()))
    errors = np.array([found[key].standard_error for key in TOLD], dtype=float)
    assert np.all(np.abs(away) < 4.0 * errors)
    assert float(away @ np.linalg.solve(found.covariance, away)) < 22.5
    assert errors[0] < 0.01
    assert errors[1] < 1.0
    assert rms_residual(found) == pytest.approx(1.0, abs=0.35)  # of 62 - 6: ± 0.09


@pytest.mark.slow
def test_six_that_a_track_does_not_tell_are_said_to_be_untold() -> None:
    """One carved turn on one slope: three that brake alike, two that bend alike, and a strength that holds anyway."""
    found = identify(SCENARIO, twin(OF_THE_SNOW, 4.0), list(OF_THE_SNOW))
    assert found.outcome == "not_identifiable"
    assert rms_residual(found) == pytest.approx(1.0, abs=0.35)  # the track itself is met
    told = "\n".join(found.warnings)
    for one, other in (("mu_0", "drag_area"), ("mu_1", "drag_area"), ("H_V", "edge_angle")):
        assert f"{one} and {other} " in told
    braking = ("mu_0", "mu_1", "drag_area")
    for name in braking:
        others = " and ".join(each for each in braking if each != name)
        assert not found[name].identifiable
        assert f"{name} is left" in told
        assert f" {others} were" in told
    for key, true in OF_THE_SNOW.items():  # wide as they are, the intervals hold the truth
        interval = found[key].interval
        if interval is not None:
            low, high = interval
            assert low is not None
            assert high is not None
            assert low < true < high
