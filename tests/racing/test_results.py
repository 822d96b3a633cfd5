"""Results of a race: windows, words, tables, and gains of variants, by hand."""

import csv
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, read_ski
from skisnow._support.errors import ParameterError
from skisnow.racing import (
    LineTurn,
    PointRacer,
    RacingLine,
    Score,
    Worth,
    compare_variants,
    drawn_for_race,
    follower_line,
    quickest,
    worth_changes,
    write_line,
)
from skisnow.racing.line import first_gates
from skisnow.racing.point import Racer
from skisnow.racing.quickest import _fingerprint
from skisnow.racing.worth import AS_IT_IS, _variant_on_snow, wider
from skisnow.track.course.gates_table import GateGap
from tests.present import present

from .test_point import WAY, glide, straight_course
from .test_search import EASY, SLALOM, raced

FOLLOWED = follower_line(SLALOM)
OTHER = RacingLine(
    first_gates(FOLLOWED, 3).course,
    FOLLOWED.start,
    (LineTurn(aside=0.5, along=0.1, turning=0.6), LineTurn(aside=1.2, along=-0.2), LineTurn(aside=0.4, turning=0.4)),
)


@pytest.mark.parametrize(
    ("gates", "window", "step", "turns", "searched"),
    [
        (5, 3, 1, [5, 5, 5, 5], [5, 3, 3, 3]),
        (6, 3, 2, [6, 5, 6, 6], [6, 3, 3, 2]),
        (6, 3, 3, [6, 5, 6], [6, 3, 3]),
        (4, 4, 1, [4], [4]),
    ],
)
def test_windows_reach_the_last_gate(gates: int, window: int, step: int, turns: list[int], searched: list[int]) -> None:
    """The whole, then so many gates behind each other, raced through two more; one evaluation each: where it begins."""
    found = raced(EASY, gates=gates, window=window, step=step, evaluations=1)
    assert [len(each.row["turns"]) for each in found.history] == turns
    assert [len(each.place) for each in found.history] == [3 * count for count in searched]
    assert len(found.line.turns) == gates
    assert found.start_score == Racer(found.scenario, "point").score(found.start)


def test_a_turn_that_enters_begins_as_the_whole_had_it() -> None:
    """The whole once, ten evaluations of two turns, of which the best go on; the third begins as the line began."""
    found = raced(EASY, gates=3, window=2, evaluations=10)
    whole, first, second = found.history[0].place, found.history[1:11], found.history[11]
    best = min(first, key=lambda each: each.value).place
    assert best[:3] != pytest.approx(best[3:])
    assert second.place == pytest.approx((*best[3:], *whole[6:]))


def test_a_line_that_is_given_stays_where_it_was_not_searched() -> None:
    start = RacingLine(OTHER.course, OTHER.start, (*OTHER.turns[:2], LineTurn(aside=0.9, turning=0.5)))
    found = raced(EASY, gates=3, window=2, evaluations=1, start=start)
    for turn, own in zip(found.line.turns, start.turns, strict=True):
        assert (turn.aside, turn.along, turn.turning) == pytest.approx((own.aside, own.along, own.turning))


def test_words_of_a_search() -> None:
    told: list[str] = []
    found = raced(EASY, evaluations=2, population=4, progress=told.append)
    assert told[0].startswith("gates 1 to 2: 1 of 2 ")
    assert told[-1].endswith(f" {found.history[0].value:.3f} s")
    assert [words in repr(found) for words in ("through 2 gates", "began from", "evaluations  5")] == [True] * 3
    tight = raced(SLALOM.with_(greatest_edge_deg=20.0), evaluations=1)
    assert "through 2 gates" in repr(tight)
    assert tight.gained is None


def test_the_table_of_a_line(tmp_path: Path) -> None:
    """Edging begins and ends at the turn's share of half the way to its neighbours; the last ends at its apex."""
    write_line(OTHER, tmp_path / "line.csv")
    rows = list(csv.DictReader((tmp_path / "line.csv").read_text(encoding="utf-8").splitlines()))
    x = [each[0] for each in OTHER.apexes]
    assert [row["gate"] for row in rows] == ["1", "2", "3"]
    for i, (row, turn) in enumerate(zip(rows, OTHER.turns, strict=True), start=1):
        assert float(row["aside_m"]) == turn.aside
        assert float(row["apex_x_m"]) == pytest.approx(x[i], abs=1e-4)
        assert float(row["apex_y_m"]) == pytest.approx(OTHER.apexes[i][1], abs=1e-4)
        before = x[i] - 0.5 * turn.turning * (x[i] - x[i - 1])
        behind = x[i] + 0.5 * turn.turning * (x[i + 1] - x[i]) if i < 3 else x[i]
        assert float(row["edging_from_x_m"]) == pytest.approx(before, abs=1e-4)
        assert float(row["edging_to_x_m"]) == pytest.approx(behind, abs=1e-4)
    third = RacingLine(OTHER.course, OTHER.start, (LineTurn(aside=1.0 / 3.0, along=0.01 / 3.0),) * 3)
    write_line(third, tmp_path / "line.csv")
    (row, *_) = csv.DictReader((tmp_path / "line.csv").read_text(encoding="utf-8").splitlines())
    assert (row["aside_m"], row["along"], row["apex_x_m"]) == (
        repr(1 / 3),
        repr(0.01 / 3.0),
        f"{third.apexes[1][0]:.6g}",
    )


def test_words_of_a_line() -> None:
    shown = repr(OTHER)
    assert "3 turns" in shown
    assert [words in shown for words in ("0.4 m to 1.2 m", "-0.2 to 0.1", "0.4 to 1")] == [True] * 3


def test_a_point_that_never_moves_passes_nothing() -> None:
    stuck = PointRacer(slope_angle=0.1, mass=80.0, friction=0.9, drag=0.0, speed=0.01)
    found = stuck.score(RacingLine(straight_course(), (0.0, 0.0), (LineTurn(aside=1.0),) * 3))
    assert (found.value, found.time, found.passed) == (math.inf, None, 0)


def test_a_last_apex_before_its_gate_is_gone_on_from() -> None:
    """A metre behind the gate, straight on."""
    free = PointRacer(slope_angle=0.2, mass=80.0, friction=0.0, drag=0.0, speed=4.0)
    line = RacingLine(straight_course(), (0.0, 0.0), (*(LineTurn(aside=1.0),) * 2, LineTurn(aside=1.0, along=-0.4)))
    result, end = free.race(line)
    assert present(result).passed == 3
    assert end == pytest.approx((31.0, 0.0))


def test_friction_that_grows_with_speed() -> None:
    """Of v' = -μ₁ g v on level snow: the speed falls by μ₁ g for each metre."""

    class Straight:
        def at(self, x: float) -> tuple[float, float, float]:
            return 0.0, 0.0, 0.0 * x

    racer = PointRacer(slope_angle=0.0, mass=80.0, friction=0.0, drag=0.0, speed=8.0, friction_by_speed=0.05)
    _, square, _ = racer.motion(Straight(), [0.0, 10.0])
    assert math.sqrt(square[-1]) == pytest.approx(8.0 - 0.05 * 9.81 * 10.0, abs=1e-5)


def score(time: float | None, *gates: tuple[str, float | None]) -> Score:
    return Score(value=1500.0 if time is None else time, time=time, passed=0, words="", gates=gates)


def test_differences_are_rated_by_their_noise() -> None:
    """Of five snows two on which one of them fails: -0.2, 0.1 and -0.05 s."""
    mine, base = (9.0, 10.0, None, 8.0, 7.95), (9.2, 9.9, 9.0, None, 8.0)
    found = Worth(name="wax", scores=tuple(map(score, mine)), base=tuple(map(score, base)))
    assert found.differences == pytest.approx([-0.2, 0.1, -0.05])
    assert found.on_own_snow == pytest.approx(-0.2)
    assert found.mean == pytest.approx(-0.05)
    assert found.deviation == pytest.approx(math.sqrt((0.15**2 + 0.15**2 + 0.0) / 2.0))
    assert found.faster == 2
    assert "faster on" in repr(found) and "2 of 3 snows" in repr(found)
    two = Worth(name="wax", scores=(score(9.0), score(8.0)), base=(score(9.0), score(9.0)))
    assert two.faster == 1
    assert two.deviation == pytest.approx(math.sqrt(0.5))
    half = 12.7062 * math.sqrt(0.5) * math.sqrt(1.5)  # Student's t of one degree of freedom
    assert two.interval == pytest.approx((-0.5 - half, -0.5 + half), rel=1e-5)
    one = Worth(name="wax", scores=(score(9.0),), base=(score(9.5),))
    assert (one.deviation, one.mean, one.interval, one.verdict) == (None, -0.5, None, "undecided")


@pytest.mark.parametrize(
    ("gaps", "verdict"), [((-0.2, -0.21), "faster"), ((0.2, 0.21), "slower"), ((-0.2, -0.3), "undecided")]
)
def test_a_ski_is_faster_only_where_the_whole_interval_says_so(gaps: tuple[float, ...], verdict: str) -> None:
    found = Worth(name="ski", scores=tuple(score(9.0 + gap) for gap in gaps), base=(score(9.0),) * 2)
    assert found.verdict == verdict


def test_on_a_drawn_snow_a_skier_assumes_the_scenarios_own() -> None:
    snow = replace(STRAIGHT.contact.snow, snow_hardness=9e8)
    assumed = present(_variant_on_snow(STRAIGHT, STRAIGHT, snow).skier)
    assert assumed.assumed_hardness == STRAIGHT.contact.snow.snow_hardness
    assert assumed.assumed_strength == STRAIGHT.contact.snow.failure_shear_stress
    assert Worth(name="", scores=(score(None),), base=(score(1.0),)).on_own_snow is None
    assert Worth(name="", scores=(score(1.0),), base=(score(None),)).on_own_snow is None


def test_gaps_at_gates_are_those_on_the_own_snow() -> None:
    mine = score(3.0, ("passed", 1.0), ("passed", 3.0))
    base = score(2.5, ("passed", 1.2), ("passed", 2.5))
    other = score(9.0, ("passed", 4.0), ("passed", 9.0))
    found = Worth(name="wax", scores=(mine, other), base=(base, other)).gaps(["a", "b"])
    assert all(isinstance(each, GateGap) for each in found)
    assert [each.gap_s for each in found] == pytest.approx([-0.2, 0.5])


def test_a_comparison_is_reported_and_kept(tmp_path: Path) -> None:
    line = RacingLine(straight_course(), (0.0, 0.0), (LineTurn(aside=1.0),) * 3)
    told: list[str] = []
    base, kept = load_scenario("slalom-20-gates"), tmp_path / "kept"

    def worth(**named: Any) -> tuple[Worth, ...]:
        usual: dict[str, Any] = {"model": "point", "workers": 1, "checkpoint": kept, "progress": told.append}
        return compare_variants(base, {"same": base}, line, [base.contact.snow], **usual | named)

    (found,) = worth()
    assert told[-1] == "race 2 of 2"
    assert found.name != AS_IT_IS
    count = len(told)
    assert worth()[0].scores == found.scores
    assert len(told) - count <= 1
    with pytest.raises(ParameterError, match="of another"):
        compare_variants(base, {"same": base}, OTHER, [base.contact.snow], model="point", workers=1, checkpoint=kept)
    with pytest.raises(ParameterError, match="one snow"):
        compare_variants(base, {"same": base}, line, [])


def test_a_checkpoint_is_that_of_its_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every setting, the racer and the line are in its mark."""
    racer, settings = Racer(SLALOM, "point"), (10, "cma", None, 0.1, 0.0, 3, 1, 0)
    mark = _fingerprint(racer, OTHER, settings)
    assert mark == _fingerprint(racer, OTHER, settings)
    others = [
        _fingerprint(Racer(SLALOM, "skier"), OTHER, settings),
        _fingerprint(Racer(EASY, "point"), OTHER, settings),
        _fingerprint(racer, first_gates(FOLLOWED, 3), settings),
        _fingerprint(racer, OTHER, (*settings[:-1], 1)),
        _fingerprint(racer, OTHER, (1, *settings[1:])),
    ]
    assert len({mark, *others}) == 6
    versions = {"skisnow": "1", "cmaes": "1"}
    monkeypatch.setattr(quickest, "version", versions.__getitem__)
    single = (1, *settings[1:])
    before = [_fingerprint(racer, OTHER, each) for each in (settings, single)]
    versions["cmaes"] = "2"  # which a search of one evaluation does not ask for
    after = [_fingerprint(racer, OTHER, each) for each in (settings, single)]
    assert [one == other for one, other in zip(before, after, strict=True)] == [False, True]


def test_a_spread_of_ten_is_the_greatest() -> None:
    snow = SLALOM.contact.snow
    drawn = drawn_for_race(snow, 200, spread=10.0, seed=1)
    shares = np.log([each.snow_hardness / snow.snow_hardness for each in drawn[1:]])
    assert np.quantile(shares, [0.025, 0.975]) == pytest.approx([-math.log(11.0), math.log(11.0)], rel=0.05)
    with pytest.raises(ParameterError, match=r"10\.1"):
        drawn_for_race(snow, 4, spread=10.1, seed=1)


STRAIGHT = load_scenario("slalom-20-gates").with_(course=straight_course())
LINE = RacingLine(straight_course(), (0.0, 0.0), (LineTurn(aside=1.0),) * 3)


def test_less_friction_on_a_straight_line_is_worth_what_the_glide_says() -> None:
    snows = drawn_for_race(STRAIGHT.contact.snow, 3, spread=0.2, seed=1)
    slower = STRAIGHT.with_(mu_0=0.06)
    found = {
        each.name: each
        for each in compare_variants(
            STRAIGHT, {"same": STRAIGHT, "more friction": slower}, LINE, snows, model="point", workers=1
        )
    }
    assert found["same"].differences.tolist() == [0.0, 0.0, 0.0, 0.0]
    exact = glide(PointRacer.of(slower), WAY)[1] - glide(PointRacer.of(STRAIGHT), WAY)[1]
    more = found["more friction"]
    assert more.on_own_snow == pytest.approx(exact, rel=1e-6)
    assert more.mean == pytest.approx(exact, rel=1e-6)
    assert more.faster == 0
    assert more.deviation == pytest.approx(0.0, abs=1e-12)


def test_a_race_that_fails_is_left_out_of_the_differences() -> None:
    stuck = STRAIGHT.with_(mu_0=0.9)
    (found,) = compare_variants(STRAIGHT, {"stuck": stuck}, LINE, [STRAIGHT.contact.snow], model="point", workers=1)
    assert found.on_own_snow is None
    assert (found.mean, found.deviation, len(found.differences)) == (None, None, 0)
    assert "not reached" in found.scores[0].words
    with pytest.raises(ParameterError, match="one variant"):
        compare_variants(STRAIGHT, {}, LINE, [STRAIGHT.contact.snow])


def test_drawn_snows_lie_about_the_scenarios_own() -> None:
    snow = STRAIGHT.contact.snow
    assert drawn_for_race(snow, 0, spread=None, seed=0) == [snow]
    own, *drawn = drawn_for_race(snow, 400, spread=0.2, seed=0)
    assert own.snow_hardness == snow.snow_hardness
    shares = np.log([each.snow_hardness / snow.snow_hardness for each in drawn])
    assert np.quantile(shares, [0.025, 0.5, 0.975]) == pytest.approx([-math.log(1.2), 0.0, math.log(1.2)], abs=0.01)
    again = drawn_for_race(snow, 400, spread=0.2, seed=0)
    assert [each.snow_hardness for each in again[1:]] == [each.snow_hardness for each in drawn]
    with pytest.raises(ParameterError, match="no interval"):
        drawn_for_race(snow, 4, spread=None, seed=0)
    with pytest.raises(ParameterError, match="above 0"):
        drawn_for_race(snow, 4, spread=0.0, seed=0)


def test_what_a_variant_changes_of_the_snow_it_changes_of_each_snow() -> None:
    from skisnow.racing.worth import _variant_on_snow

    snow = replace(STRAIGHT.contact.snow, snow_hardness=2e8, failure_shear_stress=4e5)
    changes = worth_changes(STRAIGHT)
    harder, stronger = (
        _variant_on_snow(changes[name], STRAIGHT, snow).contact.snow for name in ("H_V 10 % more", "S_f 10 % more")
    )
    assert (harder.snow_hardness, harder.failure_shear_stress) == pytest.approx((2.2e8, 4e5))
    assert (stronger.snow_hardness, stronger.failure_shear_stress) == pytest.approx((2e8, 4.4e5))
    assert changes["stiffness 5 % more"].stiffness_factor == pytest.approx(1.05)
    assert changes["friction 10 % less"].contact.friction == pytest.approx(0.045)
    stiffer = worth_changes(replace(STRAIGHT, stiffness_factor=1.2, contact=replace(STRAIGHT.contact, friction=0.1)))
    assert stiffer["stiffness 5 % more"].stiffness_factor == pytest.approx(1.26)
    assert stiffer["friction 10 % less"].contact.friction == pytest.approx(0.09)
    assert stiffer["friction 10 % less"].stiffness_factor == 1.2


def test_a_snow_whose_strength_is_not_known_is_raced_on_by_nobody() -> None:
    snow = replace(STRAIGHT.contact.snow, failure_shear_stress=None, failure_shear_stress_interval=None)
    with pytest.raises(ParameterError, match="S_f"):
        compare_variants(STRAIGHT, {"same": STRAIGHT}, LINE, [snow], model="point", workers=1)


def test_a_millimetre_more_waist_makes_the_sidecut_radius_larger() -> None:
    slalom = read_ski("slalom")
    other = wider(slalom, 1e-3)
    assert other.waist_width - slalom.waist_width == pytest.approx(1e-3, abs=2e-5)
    tip, waist, tail = slalom.sidecut_widths
    depth = (tip + tail - 2.0 * waist) / 4.0
    growth = other.sidecut_radius_of_three_widths / slalom.sidecut_radius_of_three_widths
    assert growth == pytest.approx(depth / (depth - 0.5e-3), rel=0.01)
