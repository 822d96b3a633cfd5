"""A line by three numbers a turn: half waves as the follower's, straights between turns, its table."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow import load_scenario
from skisnow._support.errors import ParameterError
from skisnow.racing import LineTurn, RacingLine, follower_line, read_line, write_line
from skisnow.racing.line import first_gates, with_numbers
from skisnow.skier.plan import half_waves

SLALOM = load_scenario("slalom-20-gates")
FOLLOWED = follower_line(SLALOM)


def other(*turns: LineTurn) -> RacingLine:
    return RacingLine(first_gates(FOLLOWED, len(turns)).course, FOLLOWED.start, turns)


CURVED = other(
    LineTurn(aside=0.5, along=0.1, turning=0.6),
    LineTurn(aside=1.2, along=-0.2, turning=1.0),
    LineTurn(aside=0.4, along=0.0, turning=0.4),
)


def test_the_followers_line_is_half_waves_from_apex_to_apex() -> None:
    for x in (0.5, 7.3, 14.2, 55.0):
        assert FOLLOWED.at(x) == pytest.approx(half_waves(FOLLOWED.apexes, x), rel=1e-9)


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
    line = with_numbers(CURVED, [0.7, 0.05, 0.5], 1)
    assert line.turns == (CURVED.turns[0], LineTurn(aside=0.7, along=0.05, turning=0.5), CURVED.turns[2])


@pytest.mark.parametrize(
    ("turns", "words"),
    [
        ((LineTurn(aside=0.5),), "1 turns"),
        ((LineTurn(aside=0.5, turning=0.1), LineTurn(aside=0.5)), "gate 1: turning is 0.1"),
        ((LineTurn(aside=0.5, along=0.6), LineTurn(aside=0.5, along=-0.6)), "gate 2: its apex"),
    ],
)
def test_what_is_no_line(turns: tuple[LineTurn, ...], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        RacingLine(first_gates(FOLLOWED, 2).course, (0.0, 0.0), turns)


def test_a_line_comes_back_from_its_table(tmp_path: Path) -> None:
    write_line(CURVED, tmp_path / "line.csv")
    assert SLALOM.course is not None
    read = read_line(tmp_path / "line.csv", SLALOM.course, CURVED.start)
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
    assert SLALOM.course is not None
    with pytest.raises(ParameterError, match=words):
        read_line(place, SLALOM.course, CURVED.start)
    with pytest.raises(ParameterError, match="cannot be read"):
        read_line(tmp_path / "none.csv", SLALOM.course, CURVED.start)


def test_a_race_needs_course_and_skier() -> None:
    with pytest.raises(ParameterError, match="no course"):
        follower_line(replace(SLALOM, course=None, skier=None))
