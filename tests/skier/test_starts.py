"""Skidded turns from disturbed starts on unknown snow, as the benchmark of the skier has them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from benchmarks.skier.__main__ import outcome
from benchmarks.skier.cases import CASES, Start, starts

from skisnow import simulate

SURE = ("slalom 13 m, 15°", "slalom 13 m, 19°", "giant slalom 25 m, 19°")
FIRST = (Start(), *(start for start in starts(6, 91) if 0.7 <= start.force <= 1.4))


@pytest.mark.slow
@pytest.mark.parametrize("start", FIRST)
@pytest.mark.parametrize("name", SURE)
def test_five_gates_are_passed_near_the_assumed_side_force(name: str, start: Start) -> None:
    case = replace(next(case for case in CASES if case.name == name), gates=5)
    assert outcome(simulate(case.scenario(start))) == "finished"


@pytest.mark.slow
def test_eight_gates_10_m_apart_on_19_degrees() -> None:
    case = replace(next(case for case in CASES if case.name == "slalom 10 m, 19°"), gates=8)
    assert outcome(simulate(case.scenario(Start()))) == "finished"
