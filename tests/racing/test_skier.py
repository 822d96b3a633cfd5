"""The skier on a line: the follower's own, and the search over four gates."""

from __future__ import annotations

import pytest

from skisnow import load_scenario, race, simulate, time_gates
from skisnow.racing import LineTurn, RacingLine, follower_line
from skisnow.racing.line import first_gates
from skisnow.racing.racers import Racer, run_score, ski_line

SLALOM = load_scenario("slalom-20-gates").with_(method="fast")
FOUR = first_gates(follower_line(SLALOM), 4)
MARGIN = 0.3
"""Time (s) by which four gates are quicker than the path follower."""


def test_on_the_followers_line_it_does_what_the_follower_does() -> None:
    short = SLALOM.with_(duration_s=0.4)
    own, lines = simulate(short), ski_line(short, follower_line(short))
    assert lines.place[-1] == pytest.approx(own.place[-1], abs=1e-9)
    assert lines.boots_by == "moved by LineSkier"


def test_a_run_that_ends_early_counts_by_what_is_missing() -> None:
    found = run_score(ski_line(SLALOM.with_(duration_s=0.1), FOUR))
    assert (found.time, found.passed) == (None, 0)
    assert 4000.0 < found.value < 4100.0
    assert "not reached" in found.words


@pytest.mark.slow
def test_the_score_is_the_time_at_the_last_gate() -> None:
    run = ski_line(SLALOM, FOUR)
    times = time_gates(FOUR.course, run).times
    assert run_score(run).value == times[-1]
    assert Racer(SLALOM, "skier").score(FOUR).value == times[-1]


@pytest.mark.slow
def test_a_line_too_near_the_poles_straddles_or_misses() -> None:
    near = RacingLine(FOUR.course, FOUR.start, (LineTurn(aside=0.25, along=0.2, turning=0.35),) * 4)
    found = Racer(SLALOM, "skier").score(near)
    assert found.time is None
    assert found.value > 1000.0


@pytest.mark.slow
def test_four_gates_are_raced_quicker_than_by_the_follower() -> None:
    """By the margin that docs/how-to/race.md states, with the turns alike already."""
    pytest.importorskip("cmaes")
    found = race(SLALOM, gates=4, evaluations=13, seed=1)
    assert found.gained is not None
    assert found.gained > MARGIN
