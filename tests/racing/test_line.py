"""A line by three numbers a turn: half waves as the follower's, straights between turns, its table."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize

from skisnow import load_scenario, race
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow._support.processes.batch import Pool
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.racing import LineTurn, PointRacer, RacingLine, follower_line, read_line, write_line
from skisnow.racing.line import NUMBERS, first_gates, with_numbers
from skisnow.racing.point import LinePoint, turns_in
from skisnow.racing.score import NOT_PASSED
from skisnow.racing.search import Evaluated, Evaluations
from skisnow.racing.windows import Search, Windows
from skisnow.skier.plan import HalfWaves
from tests.present import present

SLALOM = load_scenario("slalom-20-gates")
FOLLOWED = follower_line(SLALOM)


def other(*turns: LineTurn) -> RacingLine:
    return RacingLine(first_gates(FOLLOWED, len(turns)).course, FOLLOWED.start, turns)


CURVED = other(
    LineTurn(aside=0.5, along=0.1, turning=0.6),
    LineTurn(aside=1.2, along=-0.2, turning=1.0, speed=1.25),
    LineTurn(aside=0.4, along=0.0, turning=0.4, speed=0.9),
)


def test_the_followers_line_is_half_waves_from_apex_to_apex() -> None:
    for x in (0.5, 7.3, 14.2, 55.0):
        assert FOLLOWED.at(x) == pytest.approx(HalfWaves(FOLLOWED.apexes).at(x), rel=1e-9)


def test_it_goes_through_its_apexes_along_the_fall_line() -> None:
    for (x, y), turn, gate in zip(CURVED.apexes[1:], CURVED.turns, CURVED.course.gates, strict=True):
        aside, slope, _ = CURVED.at(x)
        assert (aside, slope) == pytest.approx((y, 0.0), abs=1e-12)
        assert (y - gate.turning[1]) * (1 if gate.side == "left" else -1) == pytest.approx(turn.aside)
    assert CURVED.apexes[2][0] == pytest.approx(22.0 - 0.2 * 10.0)


def test_slope_and_bend_are_the_derivatives_and_straights_are_straight() -> None:
    x = np.linspace(-0.5, 33.0, 6701)
    aside, slope, bend = np.array([CURVED.at(float(each)) for each in x]).T
    far = np.min(np.abs(x[:, None] - np.array(CURVED.breaks)), axis=1) > 0.02
    assert np.gradient(aside, x)[far] == pytest.approx(slope[far], abs=1e-5)
    assert np.gradient(slope, x)[far] == pytest.approx(bend[far], abs=2e-5)
    assert np.abs(np.diff(aside)).max() < 0.005
    assert np.abs(np.diff(slope)).max() < 0.005
    first, last = CURVED.breaks[1], CURVED.breaks[2]
    assert last - first == pytest.approx((1.0 - 0.5 - 0.3) * CURVED.apexes[1][0])
    assert {CURVED.at(float(each))[2] for each in np.linspace(first + 0.01, last - 0.01, 9)} == {0.0}


def test_the_greatest_curvature_is_at_an_apex() -> None:
    line = other(LineTurn(aside=0.8), LineTurn(aside=0.8))
    assert line.greatest_curvature() == pytest.approx(0.5 * 4.6 * (math.pi / 10.0) ** 2, rel=1e-6)


def test_numbers_from_a_gate_on() -> None:
    line = with_numbers(CURVED, [[0.7, 0.05, 0.5]], 1)
    assert line.turns == (CURVED.turns[0], LineTurn(aside=0.7, along=0.05, turning=0.5, speed=1.25), CURVED.turns[2])


def test_the_wanted_speed_is_that_of_the_next_apex() -> None:
    apexes = [x for x, _ in CURVED.apexes]
    places = (-5.0, apexes[0], apexes[1] - 0.1, apexes[1] + 0.1, apexes[2] + 0.1, apexes[3], 99.0)
    assert [CURVED.speed_at(x) for x in places] == [1.0, 1.0, 1.0, 1.25, 0.9, 0.9, 0.9]


@pytest.mark.parametrize(
    ("turns", "words"),
    [
        ((LineTurn(aside=0.5),), "1 turns"),
        ((LineTurn(aside=0.5, turning=0.1), LineTurn(aside=0.5)), "gate 1: turning is 0.1"),
        ((LineTurn(aside=0.5, speed=0.0), LineTurn(aside=0.5)), "gate 1: speed is 0"),
        ((LineTurn(aside=0.5, along=0.6), LineTurn(aside=0.5, along=-0.6)), "gate 2: its apex"),
    ],
)
def test_invalid_racing_lines_are_rejected(turns: tuple[LineTurn, ...], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        RacingLine(first_gates(FOLLOWED, 2).course, (0.0, 0.0), turns)


def test_a_line_comes_back_from_its_table(tmp_path: Path) -> None:
    write_line(CURVED, tmp_path / "line.csv")
    read = read_line(tmp_path / "line.csv", present(SLALOM.course), CURVED.start)
    assert read.turns == CURVED.turns
    assert read.apexes == CURVED.apexes


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("aside_m", "aside", "row 1.*aside_m"),
        ("\n2,", "\n7,", "row 3, column gate: '7'"),
        ("\n2,", "\n", "row 3, column gate"),
        ("\n2,1.2", "\n2,x", "row 3, column aside_m: 'x'"),
    ],
)
def test_a_table_that_is_no_line(old: str, new: str, words: str, tmp_path: Path) -> None:
    place = tmp_path / "line.csv"
    write_line(CURVED, place)
    place.write_text(place.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(ParameterError, match=words):
        read_line(place, present(SLALOM.course), CURVED.start)
    with pytest.raises(ParameterError, match="cannot be read"):
        read_line(tmp_path / "none.csv", present(SLALOM.course), CURVED.start)


def test_a_race_needs_course_and_skier() -> None:
    with pytest.raises(ParameterError, match="no course"):
        follower_line(replace(SLALOM, course=None, skier=None))


FOUR = first_gates(follower_line(SLALOM), 4)
NODES = 6
"""Length of each way from gate to gate."""
LOST = 0.01
"""Time (s)."""


@dataclass
class FreeLine:
    """A cubic spline through nodes, along the fall line at the start."""

    x: FloatArray
    y: FloatArray
    spline: Any = field(init=False)

    def __post_init__(self) -> None:
        ends: Any = ((1, 0.0), (2, 0.0))
        self.spline = CubicSpline(self.x, np.array([0.0, *self.y]), bc_type=ends)

    def at(self, x: float) -> tuple[float, float, float]:
        return float(self.spline(x)), float(self.spline(x, 1)), float(self.spline(x, 2))


def nodes() -> FloatArray:
    gates = [0.0, *(gate.turning[0] for gate in FOUR.course.gates)]
    return np.unique(np.concatenate([np.linspace(a, b, NODES + 1) for a, b in pairwise(gates)]))


def quickest_free_line(racer: PointRacer) -> tuple[float, FreeLine]:
    """Its time to the last gate (s), by sequential quadratic programming."""
    x = nodes()

    def line(y: FloatArray) -> FreeLine:
        return FreeLine(x, y)

    def time(y: FloatArray) -> float:
        return float(racer.motion(line(y), x.tolist())[2][-1])

    def clear(y: FloatArray) -> FloatArray:
        """Distance of the nearer side from each pole."""
        found = []
        for gate in FOUR.course.gates:
            place, slope, _ = line(y).at(gate.turning[0])
            beside = (place - gate.turning[1]) * (1.0 if gate.side == "left" else -1.0)
            found.append(beside - racer.half_width * np.hypot(1.0, slope))
        return np.array(found)

    def bent(y: FloatArray) -> FloatArray:
        """Below the greatest curvature."""
        place = np.linspace(x[0], x[-1], 241)
        spline = line(y).spline
        curvature = spline(place, 2) / (1.0 + spline(place, 1) ** 2) ** 1.5
        return np.concatenate([1.0 - racer.least_radius * curvature, 1.0 + racer.least_radius * curvature])

    begin = np.array([FOUR.at(float(each))[0] for each in x[1:]])
    constraints: Any = [{"type": "ineq", "fun": clear}, {"type": "ineq", "fun": bent}]
    found = minimize(time, begin, method="SLSQP", constraints=constraints, options={"maxiter": 200, "ftol": 1e-7})
    assert found.success, found.message
    assert clear(found.x).min() > -1e-6
    assert bent(found.x).min() > -1e-6
    return float(found.fun), line(found.x)


@pytest.mark.slow
def test_three_numbers_a_turn_lose_little_to_a_free_line() -> None:
    """The free line is a spline through more points than the line has numbers."""
    pytest.importorskip("cmaes")
    free, _ = quickest_free_line(PointRacer.of(SLALOM))
    race_of_point = race(SLALOM, gates=4, model="point", evaluations=3000, seed=1, workers=1, room=0.0)
    found = present(race_of_point.score.time)
    assert found - free < LOST


BEGUN = first_gates(follower_line(SLALOM), 8)
SLOW = 1.0
"""What the asides of two turns that follow each other must have together (m), or the gate two behind is missed."""


def made_race(point: LinePoint) -> dict[str, Any]:
    """Each turn takes as many seconds as its apex has metres."""
    aside = [turn.aside for turn in point.line.turns]
    margins = [1.0, 1.0, 1.0, *(one + other - SLOW for one, other in pairwise(aside))]
    margins = margins[: len(aside)]
    passed = next((i for i, margin in enumerate(margins) if margin <= 0.0), len(aside))
    time = sum(aside)
    failed = NOT_PASSED * (len(aside) - passed)
    return {
        "place": list(point.place),
        "value": failed or time,
        "time": None if failed else time,
        "passed": passed,
        "words": "",
        "gates": [["passed" if i < passed else "missed", sum(aside[: i + 1])] for i in range(len(aside))],
        "margins": margins,
        "turns": [[getattr(turn, name) for name in NUMBERS] for turn in point.line.turns],
    }


@dataclass
class Searched:
    """Record of a search."""

    race: Callable[[LinePoint], dict[str, Any]] = made_race
    told: list[str] = field(default_factory=list)
    done: list[Evaluated] = field(default_factory=list)

    def best(self, begun: RacingLine, search: Search, window: int, ahead: int, evaluations: int = 40) -> Evaluated:
        pytest.importorskip("cmaes")
        with Pool(self.race, 1, advice="") as pool:
            made = Evaluations(pool, KeptRows(), self.done)
            return Windows(
                made, search, evaluations, None, 0.15, 0.0, 1, self.told.append, window, 2, ahead, 3
            ).search_line(begun)

    @property
    def order(self) -> list[str]:
        """Windows, one after another."""
        names = [text.partition(":")[0] for text in self.told]
        return [name for i, name in enumerate(names) if i == 0 or name != names[i - 1]]


def test_a_place_beyond_its_range_by_rounding_is_a_line() -> None:
    made: Any = SimpleNamespace(done=[])
    batches = Windows(made, "cma", 1, None, 0.15, 0.0, 1, print, 8, 1, 0, 3)._make_batches(BEGUN, 0, 8, 8)
    assert batches.point_of(np.full(24, 1.0 + 1e-15)).line.turns == batches.point_of(np.ones(24)).line.turns


def test_a_window_sees_what_comes_after_it() -> None:
    searched = Searched()
    best = searched.best(BEGUN, "cma", 2, 2)
    assert searched.order == ["gates 1 to 8", "gates 1 to 2", "gates 3 to 4", "gates 5 to 6", "gates 7 to 8"]
    assert best.value == min(each.value for each in searched.done if len(each.row["turns"]) == 8)
    aside = [turn.aside for turn in turns_in(best.row)]
    assert len(aside) == 8
    assert best.value == pytest.approx(sum(aside))
    assert best.value < 0.85 * searched.done[0].value
    assert min(one + other for one, other in pairwise(aside[:6])) > SLOW
    assert [len(each.row["turns"]) for each in searched.done[1:3]] == [4, 4]


def test_where_nothing_comes_through_the_window_before_is_searched_again() -> None:
    """Without a look ahead the first windows are too fast for what follows."""
    searched = Searched()
    best = searched.best(BEGUN, "cma", 2, 0)
    again = [i for i, name in enumerate(searched.order) if i and name in searched.order[:i]]
    assert again
    assert searched.order[-1] in ("gates 7 to 8", "gates 1 to 2")
    assert best.value < NOT_PASSED
    assert best.value <= searched.done[0].value


@pytest.mark.slow
def test_the_whole_course_is_searched_alike_first() -> None:
    searched = Searched()
    best = searched.best(BEGUN, "surrogate", 4, 2, 18)
    whole = [each for each in searched.done if len(each.row["turns"]) == 8]
    first = [each.row["turns"] for each in searched.done[:17]]
    assert all(turn == turns[0] for turns in first for turn in turns)
    alike = min(each.value for each in whole[:20])
    assert alike < 0.75 * whole[0].value
    assert best.value <= alike


def never(point: LinePoint) -> dict[str, Any]:
    """No run passes the first gate."""
    return made_race(point) | {"value": 1000.0 * len(point.line.turns), "time": None, "passed": 0}


def test_a_course_that_nobody_gets_through_is_given_up_in_its_first_window() -> None:
    searched = Searched(race=never)
    found = searched.best(BEGUN, "cma", 2, 2, 2)
    assert found.value > NOT_PASSED
    assert searched.order == ["gates 1 to 8", "gates 1 to 2"]
