"""A wedge and a side-slip, down the fall line to a stop."""

import math

import numpy as np
import pytest

from skisnow import Run, Scenario, load_scenario, simulate
from skisnow.skier import BalancedSkier
from skisnow.skier.posture import LEFT_EDGE, RIGHT_EDGE, RIGHT_TOE, STANCE
from skisnow.skier.wedge import regulator
from skisnow.skier.yaw import Body

RACE, RECREATIONAL, TO_TIP = (0.21, 0.52), (0.16, 0.086), 0.72


def straight(slope: float, snow: tuple[float, float], duration: float, **changes: object) -> Scenario:
    """5 m/s down, on snow whose H_V and S_f (N/mm³, N/mm²) the skier assumes."""
    keys = {
        "solver.method": "fast",
        "slope.angle_deg": slope,
        "snow.H_V_N_per_mm3": snow[0],
        "snow.S_f_N_per_mm2": snow[1],
        "skier.assumed_H_V_N_per_mm3": snow[0],
        "skier.assumed_S_f_N_per_mm2": snow[1],
        "start.speed_m_per_s": 5.0,
        "run.duration_s": duration,
    }
    return load_scenario("skier-10deg", changes=keys | changes)


def stopped(run: Run) -> bool:
    return bool(run.speed[run.time > run.time[-1] - 1.0].max() < 0.2)


def require_stop(scenario: Scenario) -> None:
    """Below 0.2 m/s for the last second, within the limits of a wedge, and its tips apart."""
    skier = BalancedSkier(scenario)
    run = simulate(scenario, boots=skier)
    assert run.outcome == "finished"
    assert stopped(run)
    numbers = np.array([record.posture for record in skier.records])
    assert np.degrees(np.abs(numbers[:, RIGHT_TOE]).max()) <= 30.0
    assert np.degrees(np.abs(numbers[:, [LEFT_EDGE, RIGHT_EDGE]]).max()) <= 45.0
    assert numbers[:, STANCE].max() <= 0.85
    assert (numbers[:, STANCE] - 2.0 * TO_TIP * np.sin(numbers[:, RIGHT_TOE])).min() > 0.0


@pytest.mark.parametrize("toes_in", [0.05, 0.4])
def test_the_regulator_settles(toes_in: float) -> None:
    """Poles left of the axis, by equations written down again; skis turned to the left are pushed to the right."""
    body, brake, stance = Body(75.0, 7.4, 2.1, 0.6), 200.0, 0.6
    gain = regulator(body, brake, stance, toes_in)
    y, skis, trunk, load = np.eye(8)[::2]
    rates = np.array(
        [
            np.eye(8)[1],
            -brake / 75.0 * skis + math.cos(toes_in) / 75.0 * gain[0],
            np.eye(8)[3],
            (-3.0 * np.eye(8)[3] - 0.5 * stance * math.sin(toes_in) * gain[0] - gain[1]) / 1.3,
            np.eye(8)[5],
            (-brake * load + gain[1]) / 2.1,
            np.eye(8)[7],
            -gain[2],
        ]
    )
    assert np.linalg.eigvals(rates).real.max() < -0.1
    assert (gain @ y)[0] < 0.0  # who is too far left gets more force on the left ski, which pushes to the right
    assert (gain @ trunk)[1] < 0.0  # a body that is turned ahead of the skis is turned back by its reaction


def test_a_wedge_stops() -> None:
    require_stop(straight(10.0, RACE, 4.2, **{"skier.steers": "wedge", "start.speed_m_per_s": 2.5}))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("slope", "snow", "hardness", "strength", "duration"),
    [
        (10.0, RACE, 2.0, 0.7, 9.0),
        (15.0, RACE, 0.5, 1.4, 9.0),
        (15.0, RACE, 2.0, 0.8, 9.0),
        (10.0, RECREATIONAL, 1, 1, 25.0),
    ],
)
def test_a_wedge_stops_on_snow_that_is_not_as_assumed(
    slope: float, snow: tuple[float, float], hardness: float, strength: float, duration: float
) -> None:
    other = {"snow.H_V_N_per_mm3": hardness * snow[0], "snow.S_f_N_per_mm2": strength * snow[1]}
    require_stop(straight(slope, snow, duration, **other, **{"skier.steers": "wedge"}))


def across(side: float, duration: float, **changes: object) -> Scenario:
    keys = {
        "skier.steers": "side-slip",
        "skier.brakes_to_m_per_s": 2.0,
        "start.heading_deg": 90.0 * side,
        "start.speed_m_per_s": 0.0,
    }
    return straight(15.0, RACE, duration, **keys | changes)


@pytest.mark.slow
@pytest.mark.parametrize(("snow", "damping"), [(RACE, 150.0), (RACE, 200.0), (RACE, 250.0), ((1.0, 0.52), 200.0)])
def test_a_side_slip_stops(snow: tuple[float, float], damping: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.skier.posture.HIP_DAMPING", damping)
    keys = ("snow.H_V_N_per_mm3", "skier.assumed_H_V_N_per_mm3")
    run = simulate(across(1.0, 5.5, **dict.fromkeys(keys, snow[0])))
    assert run.outcome == "finished"
    assert run.speed[(run.time > 2.0) & (run.time < 2.9)] == pytest.approx(2.0, rel=0.1)
    assert stopped(run)


def test_a_side_slip_to_the_left_is_as_to_the_right() -> None:
    ends = [simulate(across(side, 0.3, **{"solver.method": "default"})).place[-1] for side in (1.0, -1.0)]
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-9)
    assert ends[0][1] == pytest.approx(-ends[1][1], abs=1e-9)
