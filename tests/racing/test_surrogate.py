"""A Gaussian process against what it was given, and a search that asks it against known optima."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import erfcx
from scipy.stats import norm

from skisnow._support.arrays import FloatArray
from skisnow._support.processes.batch import Pool
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.racing.score import Score, with_room
from skisnow.racing.search import Evaluated, Evaluations
from skisnow.racing.surrogate import MOST_MARGIN, Prospects, Surrogate, SurrogateSearch, margins_of, times_of

from .test_search import EASY, SLALOM, Polyline, batches, cycloid, raced

PLACES = np.random.default_rng(1).random((40, 4))
VALUES = 3.0 + np.sin(2.0 * PLACES[:, 0]) + PLACES[:, 1] ** 2 - 0.5 * PLACES[:, 2]
"""The last number moves nothing."""


def test_it_gives_back_what_it_was_given_and_knows_what_is_between() -> None:
    known = Surrogate.of(PLACES[:30], VALUES[:30], 4)
    mean, deviation = known.at(PLACES[:30])
    assert mean == pytest.approx(VALUES[:30], abs=0.01)
    assert deviation.max() < 0.05
    mean, deviation = known.at(PLACES[30:])
    assert mean == pytest.approx(VALUES[30:], abs=0.1)
    assert np.abs(mean - VALUES[30:]).max() < 4.0 * deviation.max()
    assert known.lengths[3] > 2.0 * known.lengths[0]
    far = known.at(np.full((1, 4), 40.0))
    assert (far[0][0], far[1][0]) == pytest.approx((float(known.level), float(known.scale)), rel=1e-6)


def test_scatter_is_taken_for_scatter() -> None:
    x = np.linspace(0.0, 1.0, 80)[:, None]
    scatter = 0.1 * np.random.default_rng(3).standard_normal(80)
    known = Surrogate.of(x, np.sin(3.0 * x[:, 0]) + scatter, 1)
    assert known.noise * known.scale == pytest.approx(0.1, rel=0.25)
    assert known.at(x)[0] == pytest.approx(np.sin(3.0 * x[:, 0]), abs=0.1)


def test_what_it_believes_changes_no_mean_but_is_known() -> None:
    known, place = Surrogate.of(PLACES[:30], VALUES[:30], 4), np.array([0.1, 0.9, 0.1, 0.9])
    more = known.with_mean_at(place)
    assert more.at(PLACES)[0] == pytest.approx(known.at(PLACES)[0], abs=1e-4)
    assert more.at(place[None, :])[1][0] < 0.5 * known.at(place[None, :])[1][0]


def test_numbers_of_one_kind_have_one_length() -> None:
    assert Surrogate.of(PLACES, VALUES, 2).lengths.tolist()[:2] == Surrogate.of(PLACES, VALUES, 2).lengths.tolist()[2:]


def test_kinds_of_values_have_their_own_mean_and_deviation() -> None:
    two = Surrogate.of(PLACES[:30], np.stack([VALUES[:30], 10.0 - 4.0 * VALUES[:30]], axis=1), 4)
    one = Surrogate.of(PLACES[:30], VALUES[:30], 4)
    (mean, deviation), (alone, _) = two.at(PLACES[30:]), one.at(PLACES[30:])
    assert mean[:, 0] == pytest.approx(alone, abs=0.05)
    assert mean[:, 1] == pytest.approx(10.0 - 4.0 * mean[:, 0])
    assert deviation[:, 1] == pytest.approx(4.0 * deviation[:, 0])
    assert two.with_mean_at(PLACES[35]).at(PLACES[30:])[0] == pytest.approx(mean, abs=1e-4)


@pytest.mark.parametrize("seed", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_a_brachistochrone_of_pieces_in_forty_evaluations(seed: int) -> None:
    """Whose optimum obeys Snell, as the other test shows; a simplex finds its time."""
    pytest.importorskip("cmaes")
    line = Polyline()
    with Pool(line, 1, advice="") as pool:
        made = Evaluations(pool, KeptRows(), [])
        search = SurrogateSearch(batches=batches(made), count=38, kinds=3, spread=0.2, seed=(seed,))
        best = search.least(np.full(3, 0.5))
    assert len(made.done) < 42

    def time_of(place: FloatArray) -> float:
        return float(line(tuple(place.tolist()))["value"])

    least = minimize(time_of, np.full(3, 0.3), method="Nelder-Mead").fun
    assert cycloid(line.x[-1], line.aside, line.down) < least < best.value < 1.0005 * least
    length, speed, rise = line.pieces(line.aside * np.array(best.place))
    assert rise / length / speed == pytest.approx(np.full(4, (rise / length / speed).mean()), rel=0.1)


@pytest.mark.slow
def test_turns_are_searched_alike_then_each_for_itself_and_gone_on_with(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    found = raced(EASY, search="surrogate", evaluations=22, seed=2, checkpoint=kept)
    assert found.gained is not None
    assert found.gained > 0.05
    alike = [each.place[:3] == pytest.approx(each.place[3:]) for each in found.history]
    assert all(alike[:9])
    assert not any(alike[-8:])
    told: list[str] = []
    again = raced(EASY, search="surrogate", evaluations=22, seed=2, checkpoint=kept, progress=told.append)
    assert [each.row for each in again.history] == [each.row for each in found.history]
    assert told == []


def test_it_ends_where_three_batches_make_nothing_quicker() -> None:
    found = raced(EASY, search="surrogate", evaluations=60, settled=5.0)
    assert len(found.history) < 40


@pytest.mark.slow
def test_five_seeds_find_the_same_time_through_four_gates() -> None:
    """By a point that may edge to 72°, for which the first line is not too tight."""
    wide = SLALOM.with_(greatest_edge_deg=72.0)
    found = [raced(wide, gates=4, search="surrogate", evaluations=80, seed=seed).score.time for seed in range(1, 6)]
    assert found == pytest.approx([7.5] * 5, abs=0.01)


RNG = np.random.default_rng(4)


def evaluated(number: int, place: tuple[float, ...]) -> Evaluated:
    """A time that falls with the first number, and a gate that is passed while the second is above 0.4."""
    time, margin = 8.0 - place[0], 0.5 * place[1] - 0.2
    row: dict[str, Any] = {
        "value": time if margin > 0.0 else 1000.0 - margin,
        "gates": [["passed" if margin > 0.0 else "missed", time]],
        "margins": [margin],
    }
    return Evaluated(number, place, row)


FOUND = [evaluated(i, tuple(place)) for i, place in enumerate(RNG.random((40, 2)).tolist())]


def test_a_failure_tells_its_time_and_its_margin() -> None:
    assert times_of(FOUND) == pytest.approx([8.0 - each.place[0] for each in FOUND])
    assert margins_of(FOUND)[:, 0] == pytest.approx([0.5 * each.place[1] - 0.2 for each in FOUND])


def test_who_never_comes_to_a_gate_is_slow_and_missed_it() -> None:
    fell = Evaluated(40, (0.5, 0.5), {"value": 2000.0, "gates": [["not_reached", None]], "margins": [None]})
    times = times_of([*FOUND, fell])
    assert times[40] > times[:40].max()
    assert times[40] < times[:40].max() + 2.0
    assert margins_of([*FOUND, fell])[40, 0] == -MOST_MARGIN


def test_rows_without_margins_only_pass_or_fail() -> None:
    bare = [Evaluated(i, (0.1 * i,), {"value": value}) for i, value in enumerate((8.0, 1000.0, 7.5))]
    assert margins_of(bare).tolist() == [[1.0], [-1.0], [1.0]]
    assert np.isfinite(times_of(bare)).all()
    none = times_of([Evaluated(0, (0.1,), {"value": 2000.0}), Evaluated(1, (0.2,), {"value": math.inf})])
    assert none[0] < none[1] < math.inf


def test_what_is_known_of_time_and_gate_is_foreseen() -> None:
    known = Prospects.of(FOUND, 2)
    passed = max(each.place[0] for each in FOUND if each.place[1] > 0.4)
    assert known.least == pytest.approx(8.0 - passed, abs=0.01)
    beside, far, near = np.array([[0.98, 0.2]]), np.array([[0.98, 0.9]]), np.array([[0.98, 0.41]])
    assert known.through(far)[0] > -0.01
    assert known.through(beside)[0] < known.through(near)[0] < known.through(far)[0]
    assert known.worth(far)[0] > known.worth(beside)[0] + 5.0
    assert known.worth(far)[0] > known.worth(np.array([[0.3, 0.9]]))[0] + 5.0
    assert known.worth(near, caution=4.0)[0] - known.worth(near)[0] == pytest.approx(3.0 * known.through(near)[0])
    slower = np.array([[0.9, 0.9]])  # where nothing is gained but by surprise
    assert known.worth(slower, curiosity=0.1)[0] < 10.0 * known.worth(slower)[0] < 0.0
    after = known.with_mean_at(far[0])
    assert after.worth(far)[0] < known.worth(far)[0]


def test_where_nothing_fails_all_come_through() -> None:
    passed = [each for each in FOUND if each.place[1] > 0.4]
    assert Prospects.of(passed, 2).through(np.array([[0.5, 0.0]])).tolist() == [0.0]


@pytest.mark.parametrize("hope", [-30.0, -11.0, -9.0, -3.0, -0.5, 0.0, 0.7, 6.0, 60.0])
def test_the_improvement_is_that_of_a_normal_value(hope: float) -> None:
    from skisnow.racing.surrogate import _log_improvement

    steps = np.linspace(max(-hope, -hope), 45.0 + abs(hope), 400_001)
    exact = norm.logpdf(steps) + np.log(np.maximum(hope + steps, 1e-300))
    most = exact.max()
    expected = most + math.log(np.trapezoid(np.exp(exact - most), steps))
    assert _log_improvement(np.array([hope]))[0] == pytest.approx(expected, abs=0.02)


def test_a_gate_has_to_be_passed_with_room() -> None:
    """Two gates passed by 4 and 12 cm: with 5 cm of room the first one fails by 1 cm."""
    gates = (("passed", 2.0), ("passed", 4.0))
    score = Score(value=4.0, time=4.0, passed=2, words="finished", gates=gates, margins=(0.04, 0.12, 0.3))
    assert with_room(score, 0.0) == score
    assert with_room(score, 0.03).value == 4.0
    assert with_room(score, 0.03).margins == pytest.approx((0.01, 0.09, 0.3))  # the last is not a gate
    narrow = with_room(score, 0.05)
    assert narrow.value == pytest.approx(1000.01)
    assert (narrow.time, narrow.passed) == (None, 1)
    assert "than 0.05 m" in narrow.words
    both = with_room(score, 0.2)
    assert both.value == pytest.approx(2000.0 + 0.16 + 0.08)
    missed = replace(score, time=None, value=1000.3, passed=1, margins=(-0.3, None, 0.3))
    assert with_room(missed, 0.05).value == 1000.3
    assert with_room(missed, 0.05).margins == (-0.35, None, 0.3)


def test_far_below_0_an_improvement_is_that_of_the_scaled_error_function() -> None:
    """φ(z) (1 - |z| √(π/2) erfcx(|z|/√2)); what the series leaves out at -30 is 105/30⁶."""
    from skisnow.racing.surrogate import _log_improvement

    rest = 1.0 - 30.0 * math.sqrt(math.pi / 2.0) * float(erfcx(30.0 / math.sqrt(2.0)))
    expected = -450.0 - 0.5 * math.log(2.0 * math.pi) + math.log(rest)
    assert _log_improvement(np.array([-30.0]))[0] == pytest.approx(expected, abs=3e-7)


def test_who_misses_a_gate_has_less_margin_than_who_straddles_its_pole() -> None:
    from skisnow.racing.score import ABREAST, _margin_of_passage

    found = [
        _margin_of_passage(cast("Any", SimpleNamespace(clearance=clearance, outcome=outcome)))
        for clearance, outcome in ((-0.2, "missed"), (-0.2, "straddled"), (0.3, "passed"), (None, "not_reached"))
    ]
    assert found == [-0.2 - ABREAST, -0.2, 0.3, None]
    assert ABREAST > 0.0
