"""The repetition of a run, finer in one choice at a time: what is refined, and how far the end moves."""

from dataclasses import replace

import numpy as np
import pytest

from skisnow import Run, Scenario
from skisnow.scenario import Solver, load_scenario
from skisnow.simulation.simulated_run import simulate
from skisnow.simulation.verification import (
    Refinement,
    limit_warnings,
    nudged_scenarios,
    refined_solvers,
    repetitions,
    verification_dict,
    verify,
)

from .straight_run import STRAIGHT, straight_run

KEYS = ["solver.tolerance_mm", "solver.elements", "solver.line_spacing_mm", "solver.groove_tolerance"]
NUDGED = ["start.speed_m_per_s", "sledge.edge_angle_deg", "snow.H_V_N_per_mm3", "snow.S_f_N_per_mm2"]


def test_each_repetition_refines_one_choice_from_what_was_in_force() -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))  # in force: 40 elements, 18 mm, 4 mm
    plain = run.scenario.solver
    assert refined_solvers(run) == {
        "solver.tolerance_mm": replace(plain, tolerance=plain.tolerance / 2.0),
        "solver.elements": replace(plain, elements=80),
        "solver.line_spacing_mm": replace(plain, line_spacing=0.009),
        "solver.groove_tolerance": replace(plain, groove_tolerance=5e-5),
    }


def test_a_fixed_step_is_halved_in_place_of_the_tolerance() -> None:
    run = straight_run(load_scenario("carved-46m", changes={**STRAIGHT, "fixed": True, "step_ms": 0.4}))
    found = refined_solvers(run)
    assert list(found) == ["solver.step_ms", *KEYS[1:]]
    assert found["solver.step_ms"].step == pytest.approx(0.2e-3, rel=1e-15)


def test_the_places_of_a_delayed_depth_are_refined_where_there_is_one() -> None:
    run = straight_run(load_scenario("carved-46m", changes={**STRAIGHT, "delayed_share": 0.2}))
    found = refined_solvers(run)
    assert list(found) == [*KEYS, "solver.delayed_spacing_mm"]
    assert found["solver.delayed_spacing_mm"].delayed_spacing == pytest.approx(0.5e-3)


def test_end_moves_by_what_the_choice_changes() -> None:
    """The made-up run misses by 40 mm / elements: from 40 to 80 its end moves by 0.5 mm."""
    found = verification_dict(verify(straight_run(load_scenario("carved-46m", changes=STRAIGHT)), straight_run))
    assert list(found) == [*KEYS, "snow.shear_displacement_mm", *NUDGED]
    moved = {key: each["end_moves_cm"] for key, each in found.items() if key in KEYS}
    assert moved == pytest.approx({**dict.fromkeys(KEYS, 0.0), "solver.elements": 0.05}, rel=1e-9, abs=1e-12)
    assert {key: (each["was"], each["now"]) for key, each in found.items() if key in KEYS} == {
        "solver.tolerance_mm": pytest.approx((0.001, 0.0005)),
        "solver.elements": (40.0, 80.0),
        "solver.line_spacing_mm": pytest.approx((18.0, 9.0)),
        "solver.groove_tolerance": pytest.approx((1e-4, 5e-5)),
    }
    assert {each["outcome"] for each in found.values()} == {"finished"}


def test_half_of_the_shear_displacement_and_a_thousandth_of_the_inputs() -> None:
    """In the made-up run a start that is 0.1 % faster than 5 m/s ends 0.005 m/s · 2 s = 1 cm farther; no other does."""
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    found = {each.key: each for each in verify(run, straight_run)}
    assert repetitions(run) == (*KEYS, "snow.shear_displacement_mm", *(key for key in NUDGED for _ in "+-"))
    half = found["snow.shear_displacement_mm"]
    assert (half.was, half.now) == pytest.approx((0.02, 0.01), rel=1e-12)
    assert found["start.speed_m_per_s"].end_moves == pytest.approx(0.01, rel=1e-9)
    assert abs(found["start.speed_m_per_s"].now - 5.0) == pytest.approx(0.005, rel=1e-9)
    speeds = [each.start.speed for each in nudged_scenarios(run)["start.speed_m_per_s"]]
    assert speeds == pytest.approx([5.005, 4.995], rel=1e-12)
    assert [found[key].end_moves for key in NUDGED[1:]] == pytest.approx([0.0] * 3, abs=1e-12)
    assert limit_warnings(run, found.values()) == ()


def test_none_finer_than_the_range_allows() -> None:
    changes = {**STRAIGHT, "shear_displacement_mm": 0.015, "edge_angle_deg": 0.0}
    run = straight_run(load_scenario("carved-46m", changes=changes))
    assert not {"snow.shear_displacement_mm", "sledge.edge_angle_deg"} & set(repetitions(run))


@pytest.mark.parametrize(("moves", "near"), [(0.004, False), (0.006, True)])
def test_near_the_limit_a_thousandth_moves_the_end_by_more_than_five_of_the_run(moves: float, near: bool) -> None:
    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    moved = moves * run.run_length
    found = (
        Refinement("snow.S_f_N_per_mm2", 0.5, 0.5005, moved, "finished"),
        Refinement("solver.elements", 40.0, 80.0, 10.0 * run.run_length, "finished"),
    )
    warned = limit_warnings(run, found)
    assert len(warned) == near
    if near:
        assert warned[0].startswith(
            f"near the limit of grip: the end moves {moved:.2g} m for 0.1 % of snow.S_f_N_per_mm2"
        )


@pytest.mark.slow
def test_a_run_at_the_limit_of_its_grip_is_told() -> None:
    """On H_V = 1, with u_y = 0.5 mm, a turn that holds gives way to a skid near S_f = 0.339, within a thousandth."""
    skidded = 30.0  # energy of shear (J): 11 where the edge holds, 50 and more where it does not

    def turn(strength: float) -> Run:
        snow = {"H_V_N_per_mm3": 1.0, "S_f_N_per_mm2": strength, "shear_displacement_mm": 0.5}
        return simulate(load_scenario("carved-46m", changes={f"snow.{key}": value for key, value in snow.items()}))

    low, high = 0.33, 0.34
    assert turn(low).energies["shear"][-1] > skidded > turn(high).energies["shear"][-1]
    while high - low > 1e-3 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if turn(middle).energies["shear"][-1] > skidded else (low, middle)
    holds, skids = turn(high), turn(low)
    moves = float(np.linalg.norm(holds.place[-1] - skids.place[-1]))
    assert limit_warnings(holds, [Refinement("snow.S_f_N_per_mm2", high, low, moves, skids.outcome)])


def test_a_carve_is_not_near_the_limit() -> None:
    carve = simulate(load_scenario("carved-46m", changes={"run.duration_s": 1.5}))
    slower = simulate(carve.scenario.with_(speed_m_per_s=carve.scenario.start.speed * 0.999))
    moves = float(np.linalg.norm(carve.place[-1] - slower.place[-1]))
    assert limit_warnings(carve, [Refinement("start.speed_m_per_s", 7.0, 6.993, moves, slower.outcome)]) == ()


def test_interrupted_repetition_keeps_those_before_it() -> None:
    asked: list[Solver] = []

    def interrupted_third(scenario: Scenario) -> Run:
        asked.append(scenario.solver)
        return straight_run(scenario, outcome="interrupted" if len(asked) == 3 else "finished")

    run = straight_run(load_scenario("carved-46m", changes=STRAIGHT))
    assert [each.key for each in verify(run, interrupted_third)] == KEYS[:2]
    assert len(asked) == 3
