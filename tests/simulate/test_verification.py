"""The repetition of a run, finer in one choice at a time: what is refined, and how far the end moves."""

from dataclasses import replace

import pytest

from skisnow import Run, Scenario
from skisnow.scenario import Solver, read_scenario
from skisnow.simulate.verification import refined_solvers, verification_dict, verify

from .straight_run import STRAIGHT, straight_run

KEYS = ["solver.tolerance_mm", "solver.elements", "solver.line_spacing_mm", "solver.groove_tolerance"]


def test_each_repetition_refines_one_choice_from_what_was_in_force() -> None:
    run = straight_run(read_scenario("carved-46m", changes=STRAIGHT))  # in force: 40 elements, 18 mm, 4 mm
    plain = run.scenario.solver
    assert refined_solvers(run) == {
        "solver.tolerance_mm": replace(plain, tolerance=plain.tolerance / 2.0),
        "solver.elements": replace(plain, elements=80),
        "solver.line_spacing_mm": replace(plain, line_spacing=0.009),
        "solver.groove_tolerance": replace(plain, groove_tolerance=5e-5),
    }


def test_a_fixed_step_is_halved_in_place_of_the_tolerance() -> None:
    run = straight_run(read_scenario("carved-46m", changes={**STRAIGHT, "fixed": True, "step_ms": 0.4}))
    found = refined_solvers(run)
    assert list(found) == ["solver.step_ms", *KEYS[1:]]
    assert found["solver.step_ms"].step == pytest.approx(0.2e-3, rel=1e-15)


def test_end_moves_by_what_the_choice_changes() -> None:
    """The made-up run misses by 40 mm / elements: from 40 to 80 its end moves by 0.5 mm."""
    found = verification_dict(verify(straight_run(read_scenario("carved-46m", changes=STRAIGHT)), straight_run))
    assert list(found) == KEYS
    moved = {key: each["end_moves_cm"] for key, each in found.items()}
    assert moved == pytest.approx({**dict.fromkeys(KEYS, 0.0), "solver.elements": 0.05}, rel=1e-9, abs=1e-12)
    assert {key: (each["was"], each["now"]) for key, each in found.items()} == {
        "solver.tolerance_mm": pytest.approx((0.0003, 0.00015)),
        "solver.elements": (40.0, 80.0),
        "solver.line_spacing_mm": pytest.approx((18.0, 9.0)),
        "solver.groove_tolerance": pytest.approx((1e-4, 5e-5)),
    }
    assert {each["outcome"] for each in found.values()} == {"finished"}


def test_interrupted_repetition_keeps_those_before_it() -> None:
    asked: list[Solver] = []

    def interrupted_third(scenario: Scenario) -> Run:
        asked.append(scenario.solver)
        return straight_run(scenario, outcome="interrupted" if len(asked) == 3 else "finished")

    run = straight_run(read_scenario("carved-46m", changes=STRAIGHT))
    assert [each.key for each in verify(run, interrupted_third)] == KEYS[:2]
    assert len(asked) == 3
