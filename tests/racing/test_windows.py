"""A window that moves on, over a made course on which whoever is too fast fails two gates later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import pytest

from skisnow._support.processes.batch import Pool
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.racing import RacingLine, follower_line
from skisnow.racing.line import first_gates
from skisnow.racing.racers import LinePoint, turns_in
from skisnow.racing.score import NOT_PASSED
from skisnow.racing.search import Evaluated, Evaluations
from skisnow.racing.windows import How, Search, Windows

from .test_search import SLALOM

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
        "turns": [[turn.aside, turn.along, turn.turning] for turn in point.line.turns],
    }


@dataclass
class Searched:
    """Record of a search."""

    race: Callable[[LinePoint], dict[str, Any]] = made_race
    told: list[str] = field(default_factory=list)
    done: list[Evaluated] = field(default_factory=list)

    def best(self, begun: RacingLine, search: Search, window: int, ahead: int, evaluations: int = 40) -> Evaluated:
        pytest.importorskip("cmaes")
        how = How(search, evaluations, None, 0.15, 0.0, 1, self.told.append)
        with Pool(self.race, 1, advice="") as pool:
            made = Evaluations(pool, KeptRows(), self.done)
            return Windows(made, how, window, 2, ahead).search_line(begun)

    @property
    def order(self) -> list[str]:
        """Windows, one after another."""
        names = [text.partition(":")[0] for text in self.told]
        return [name for i, name in enumerate(names) if i == 0 or name != names[i - 1]]


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
