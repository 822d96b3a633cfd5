"""A skier that balances: in linked turns on 10°, in a steady turn on level snow, pushed, and what it refuses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from skisnow import BootMoment, Run, Scenario, scenario, simulate
from skisnow.errors import ParameterError
from skisnow.skier import BalancedSkier, BalanceTuning, TurnPlan

STEADY = BalanceTuning(edge_change=1.0, edge_gain=0.3, lean_more=1.0)


def tall(**changes: object) -> Scenario:
    """75 kg with the centre of mass 0.9 m over giant-slalom skis 0.44 m apart, in the air as one who stands up."""
    given = {
        "mass_kg": 75.0, "inertia_kg_m2": [10.0, 10.0, 2.0], "centre_of_mass_height_m": 0.9, "stance_width_m": 0.44,
        "edge_angle_deg": 0.0, "heading_deg": 0.0, "speed_m_per_s": 4.0, "H_V_N_per_mm3": 0.3, "mu_0": 0.05,
        "drag_area_m2": 0.66, "duration_s": 11.0, "method": "fast",
    }  # fmt: skip
    return scenario("carved-46m").with_(**given | changes)


class Held(BalancedSkier):
    """At its speed by a force at the centre of mass, and pushed aside by another for 0.2 s from 4 s on."""

    aside = 0.0
    missing = 0.0

    def push(self, moment: BootMoment) -> tuple[Sequence[float], Sequence[float]]:
        velocity = moment.rotation @ moment.velocity[:3]
        speed = float(np.linalg.norm(velocity))
        ahead = np.array([velocity[0], velocity[1], 0.0]) / max(speed, 1e-9)
        self.missing += 0.6 * (self.scenario.start.speed - speed)
        force = (150.0 * (self.scenario.start.speed - speed) + self.missing) * ahead
        if 4.0 <= moment.time < 4.2:
            force += self.aside * np.array([-ahead[1], ahead[0], 0.0])
        return force.tolist(), [0.0, 0.0, self.scenario.sledge.centre_of_mass[1]]


def steady(aside: float, duration: float, **changes: float) -> tuple[Run, Held]:
    level = {"angle_deg": 0.0, "mu_0": 0.02, "drag_area_m2": 0.0, "speed_m_per_s": 7.0, "duration_s": duration}
    turn = tall(**level | changes)
    skier = Held(turn, TurnPlan(turn_time=1e3, turns=np.inf), STEADY)
    skier.aside = aside
    return simulate(turn, boots=skier), skier


def test_a_steady_turn_is_kept_and_a_push_of_50_N_is_survived() -> None:
    """tan Ψ of the lean from the pressure to the centre of mass is v²/(R g); pushed, it is there again 2 s later."""
    run, skier = steady(50.0, 6.0)
    assert run.outcome == "finished"
    assert run.energy_balance_error == pytest.approx(0.0, abs=1e-3)
    lean = {round(each.time, 2): each for each in skier.records}
    before, after = lean[3.9], lean[5.9]
    assert np.degrees(before.lean) > 14.0
    assert after.lean == pytest.approx(before.lean, abs=np.radians(0.5))
    k = (run.time > 5.0) & (run.time < 5.9)
    centre = (run.place + 0.9 * run.attitude[:, :, 2])[k]
    velocity = np.gradient(centre, run.time[k], axis=0)
    acceleration = np.gradient(velocity, run.time[k], axis=0)[5:-5]
    speed = np.linalg.norm(velocity[5:-5, :2], axis=1)
    turning = np.mean((velocity[5:-5, 0] * acceleration[:, 1] - velocity[5:-5, 1] * acceleration[:, 0]) / speed) / 9.81
    seen = np.mean(
        [np.tan(each.lean) - each.pressure_aside / (0.9 * np.cos(each.lean)) for each in skier.records[500:590]]
    )
    assert seen == pytest.approx(turning, rel=0.01)


@pytest.mark.slow
def test_linked_turns_on_10_degrees() -> None:
    """4½ turns without a fall, at five speeds of the start; edge angles go over without a jump; energy closes."""
    plan = TurnPlan(first=0.8)
    for speed in (3.5, 3.8, 4.0, 4.2, 4.5):
        turn = tall(speed_m_per_s=speed)
        skier = BalancedSkier(turn, plan)
        run = simulate(turn, boots=skier)
        assert run.outcome == "finished", speed
        assert run.energy_balance_error == pytest.approx(0.0, abs=1e-3)
        edge = np.degrees([each.edge_angle for each in skier.records])
        assert np.abs(np.diff(edge)).max() < 4.0  # in 10 ms
        heading = np.degrees([each.heading for each in skier.records])
        ends = heading[[180, 380, 580, 780, 980]]
        assert (ends[::2] > 8.0).all()
        assert (ends[1::2] < -12.0).all()
        assert abs(run.energies["boots"][-1]) > 50.0  # the muscles'


@pytest.mark.slow
def test_the_last_bits_stay_small_while_it_balances() -> None:
    """10⁻¹² of the start speed moves the end of 20 s by less than a millimetre."""
    ends = [steady(0.0, 20.0, speed_m_per_s=speed)[0].place[-1] for speed in (7.0, 7.0 * (1.0 + 1e-12))]
    assert np.linalg.norm(ends[0] - ends[1]) < 1e-3


def test_left_and_right_mirror() -> None:
    """The first turn."""
    ends = []
    for to_left in (True, False):
        turn = tall(duration_s=1.6)
        run = simulate(turn, boots=BalancedSkier(turn, TurnPlan(first=0.5, to_left=to_left)))
        ends.append(run.place[-1])
    assert abs(ends[0][1]) > 0.05
    assert ends[0][0] == pytest.approx(ends[1][0], abs=1e-4)
    assert ends[0][1] == pytest.approx(-ends[1][1], abs=1e-4)


def test_plan() -> None:
    """A half turn, then whole ones to the other side."""
    plan = TurnPlan(first=1.0, turn_time=2.0, turns=4.5)
    assert [plan.sense(time) for time in (0.9, 1.1, 1.9, 2.1, 3.9, 4.1, 9.9, 10.1)] == [0, 1, 1, -1, -1, 1, 1, 0]
    assert replace(plan, to_left=False).sense(1.5) == -1.0
    with pytest.raises(ParameterError, match="above 0"):
        TurnPlan(turn_time=0.0)


def test_what_it_does_not_know_is_refused() -> None:
    with pytest.raises(ParameterError, match="must be 0"):
        BalancedSkier(tall(edge_angle_deg=5.0), TurnPlan())
