"""The cause that a fall or a missed gate is given."""

import math
from typing import Any

import numpy as np
import pytest

from skisnow import Course, Gate, load_scenario
from skisnow.scenario.skier import Skier
from skisnow.simulation.simulated_run import _through_gates
from skisnow.skier import BalanceRecord
from skisnow.skier.control import Balance
from skisnow.skier.failure import cause_of
from tests.present import present
from tests.simulation.straight_run import STRAIGHT, straight_run

from .test_steps import HEIGHT, saw

WEIGHT = 720.0
HOLDS = {"across": 0.5 * WEIGHT, "slip": 0.3, "edge": (0.1, 0.1)}
"""A skid in balance: the snow holds half the weight, for a lean of half the height."""


def records(*crossed: tuple[float, dict[str, Any]], wanted: float = 0.5 * HEIGHT) -> list[BalanceRecord]:
    """Records of 3 s in balance; from each time in `crossed` on, those values replace the former."""
    found = []
    for time in np.arange(0.0, 3.0, 0.005):
        changes: dict[str, Any] = dict(HOLDS, time=float(time), place=(6.0 * float(time), 0.0))
        for since, seen in crossed:
            changes |= seen if time >= since - 1e-9 else {}
        place = changes.pop("wanted", wanted)
        found.append(BalanceRecord(saw(**changes), Balance(0.0, place, 0.0, 0.0, 3.5), np.zeros(10)))
    return found


@pytest.mark.parametrize(
    ("code", "seen"),
    [
        ("speed", {"wanted": HEIGHT * math.tan(math.radians(50.0)), "across": WEIGHT}),
        ("hips", {"body_heading": 0.2 + math.radians(61.0)}),
        ("edge_lost", {"slip": 0.01}),
        ("grip", {"across": 0.2 * WEIGHT}),
        ("grip", {"across": -0.5 * WEIGHT}),
        ("leg_force", {"left": 1.6 * WEIGHT, "right": 1.6 * WEIGHT}),
        ("leg_force", {"left": 0.05 * WEIGHT, "right": 0.05 * WEIGHT}),
    ],
)
def test_each_limit_is_named_with_time_and_place(code: str, seen: dict[str, Any]) -> None:
    found = present(cause_of(records((2.0, seen)), Skier(brakes_to=6.0), WEIGHT))
    assert found.code == code
    assert found.time == pytest.approx(2.0)
    assert found.place[0] == pytest.approx(12.0)


def test_the_first_limit_counts_and_who_stays_within_all_limits_or_was_beyond_one_long_ago_has_no_cause() -> None:
    hips, grip = {"body_heading": 2.0}, {"across": 0.0}
    for first, second, code in ((hips, grip, "hips"), (grip, hips, "grip")):
        found = present(cause_of(records((2.0, first), (2.2, second)), Skier(brakes_to=6.0), WEIGHT))
        assert found.code == code
    skier = Skier(brakes_to=6.0)
    long_ago = ((0.5, {"body_heading": 2.0}), (1.0, {"body_heading": 0.2}))
    assert cause_of(records(*long_ago), skier, WEIGHT) is None
    assert cause_of([], skier, WEIGHT) is None
    carving = records((2.0, {"slip": 0.0}))  # a carve follows its edges
    assert cause_of(carving, Skier(), WEIGHT) is None


@pytest.mark.parametrize(("since", "named"), [(0.2, True), (1.8, False)])
def test_a_missed_gate_names_a_limit_that_was_crossed_before_it(since: float, named: bool) -> None:
    """The second gate, at about 1.5 s, is on the other side; a limit that is crossed behind it does not count."""
    gates = tuple(Gate(name=str(x), turning=(x, y), side="left") for x, y in ((4.0, -1.0), (8.0, 1.0)))
    scenario = load_scenario("skier-10deg").with_(course=Course(gates=gates), skier=Skier(brakes_to=6.0), **STRAIGHT)
    found = _through_gates(straight_run(scenario), records((since, {"body_heading": 2.0})))
    assert found.outcome == "missed_gate"
    assert ("skier.greatest_hip_deg" in found.remedy) is named
