"""Skidded turns from disturbed starts on unknown snow, as the benchmark of the skier has them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from benchmarks.skier.__main__ import carved, outcome
from benchmarks.skier.cases import CASES, HYBRID, Start, starts

from skisnow import Scenario, simulate
from skisnow.skier import BalancedSkier
from skisnow.skier.posture import RISE

SURE = ("slalom 13 m, 15°", "slalom 13 m, 19°", "giant slalom 25 m, 19°")
FIRST = (Start(), *(start for start in starts(6, 91) if 0.7 <= start.force <= 1.4))


def named(name: str) -> Any:
    return next(case for case in CASES if case.name == name)


@pytest.mark.slow
@pytest.mark.parametrize("start", FIRST)
@pytest.mark.parametrize("name", SURE)
def test_five_gates_are_passed_near_the_assumed_side_force(name: str, start: Start) -> None:
    case = replace(named(name), gates=5)
    assert outcome(simulate(case.scenario(start))) == "finished"


@pytest.mark.slow
def test_ankles_give_way_on_25_degrees_so_that_the_pressure_does_not_rock() -> None:
    """It stays within 0.1 m of the centre of mass along the skis, as rms in turns; with stiff ankles a skier falls."""
    scenario = replace(named("slalom 13 m, 25°"), gates=2).scenario(Start())
    skier = BalancedSkier(scenario)
    assert outcome(simulate(scenario, boots=skier)) == "finished"
    turning = [each.seen for each in skier.records if each.seen.bears and abs(each.seen.across) > 200.0]
    assert np.sqrt(np.mean([(seen.pitching / seen.load) ** 2 for seen in turning])) < 0.1


@pytest.mark.slow
def test_eight_gates_10_m_apart_on_19_degrees() -> None:
    case = replace(named("slalom 10 m, 19°"), gates=8)
    assert outcome(simulate(case.scenario(Start()))) == "finished"


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.55, 0.8])
def test_the_outer_ski_bears_its_share_without_chatter(share: float) -> None:
    """Within 5 percentage points where the side force is above 200 N, and 15 % of the weight as rms above 5 Hz."""
    scenario = replace(named("slalom 13 m, 15°"), gates=5).scenario(Start())
    skier = BalancedSkier(scenario.with_(skier=replace(scenario.skier, outer_share=share)))
    run = simulate(skier.scenario, boots=skier)
    pushed = [each.seen for each in skier.records if each.seen.bears and abs(each.seen.across) > 200.0]
    shares = [(seen.right if seen.across > 0.0 else seen.left) / seen.load for seen in pushed if seen.time > 0.5]
    assert np.median(shares) == pytest.approx(share, abs=0.05)
    assert run.boots is not None
    forces = np.linalg.norm(run.boots.force, axis=2)
    parts, rates = np.fft.rfft(np.vstack([forces, forces[::-1]]), axis=0), np.fft.rfftfreq(2 * len(forces), 0.01)
    parts[rates < 5.0] = 0.0
    swings = np.fft.irfft(parts, 2 * len(forces), axis=0)[: len(forces)][np.abs(run.balance.lean) > np.radians(15.0)]
    assert np.sqrt((swings**2).mean(axis=0)).max() < 0.15 * scenario.sledge.mass * scenario.gravity


def require_carves(start: Start, gates: int, slope: float = 10.0) -> None:
    """All gates of linked hybrid turns on a slope (°) are passed, and each turn that ends carves."""
    case = replace(next(case for case in HYBRID[3:] if case.slope == slope), gates=gates)
    skier = BalancedSkier(case.scenario(start))
    assert outcome(simulate(skier.scenario, boots=skier)) == "finished"
    assert carved(skier, case) == [True] * (gates - 1)


def test_a_turn_that_skids_before_the_fall_line_carves_behind_it() -> None:
    require_carves(Start(), gates=2)


@pytest.mark.slow
@pytest.mark.parametrize("slope", [10.0, 15.0])
@pytest.mark.parametrize("start", starts(2, 57))
def test_linked_turns_carve_behind_the_fall_line_from_disturbed_starts(start: Start, slope: float) -> None:
    require_carves(start, gates=8, slope=slope)


def require_landing(scenario: Scenario) -> None:
    """0.4 s and more in the air, at most 2 m up; the legs give way nearly to their shortest and stretch again."""
    skier = BalancedSkier(scenario)
    run = simulate(scenario, boots=skier)
    assert run.outcome == "finished"
    rise = np.array([record.posture[RISE] for record in skier.records])
    in_air = np.array([record.seen.flies for record in skier.records])
    assert in_air.sum() * skier.period > 0.4
    assert max(record.seen.clearance for record in skier.records) < 2.0
    lowest = skier.skier.shortest_leg - scenario.sledge.centre_of_mass[1]
    assert lowest - 0.05 < rise.min() < lowest + 0.05
    assert abs(rise[-1]) < 0.1
    legs = np.hypot([record.posture[1] for record in skier.records], 0.6 + rise)
    assert legs.max() < skier.skier.longest_leg


def test_a_skier_lands_behind_a_kicker() -> None:
    require_landing(named("kicker, 10°").scenario(Start()).with_(duration_s=2.8))


@pytest.mark.slow
@pytest.mark.parametrize("start", starts(5, 57))
def test_a_skier_lands_on_unknown_snow_and_stays_up_over_rolls(start: Start) -> None:
    require_landing(named("kicker, 10°").scenario(start))
    assert simulate(named("five rolls, 10°").scenario(start)).outcome == "finished"


def test_a_flight_above_the_highest_ends_the_run() -> None:
    scenario = named("kicker, 10°").scenario(Start())
    low = replace(scenario.skier, highest_flight=0.5)
    run = simulate(scenario.with_(skier=low))
    assert run.outcome == "airborne"
    assert "skier.highest_flight_m" in run.remedy
