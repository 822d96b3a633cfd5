"""Parts of a search, by hand: its boxes, scores, a wider ski, and the limits of what is allowed."""

import math
from dataclasses import replace
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow import load_scenario, read_ski
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow._support.processes.batch import Pool
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.racing import LineTurn, RacingLine, follower_line, quickest_line, surrogate
from skisnow.racing.line import first_gates, turn_lengths
from skisnow.racing.point import Racer, run_score, ski_line
from skisnow.racing.quickest import _require_settings, _search_method, _start_line, _window_and_step
from skisnow.racing.score import score_of
from skisnow.racing.search import Evaluations, optimiser_within
from skisnow.racing.surrogate import BATCH, PointChoice, SurrogateSearch, _best_within
from skisnow.racing.worth import wider
from skisnow.track.course import MovingPoint, passages
from tests.coded import raises

from .test_point import WAY, straight_course
from .test_search import Polyline, batches

SLALOM = load_scenario("slalom-20-gates")
FOLLOWED = follower_line(SLALOM)


class Bowl:
    """A mean that is least at one place and a deviation that is greatest at another."""

    def __init__(self, least: Any, unknown: Any) -> None:
        self.least, self.unknown = np.array(least), np.array(unknown)

    def worth(self, places: FloatArray, curiosity: float, caution: float) -> FloatArray:
        assert caution == 4.0
        away, near = np.sum((places - self.least) ** 2, axis=1), np.sum((places - self.unknown) ** 2, axis=1)
        return np.asarray(curiosity * (3.0 - near) - away)


def least_of_bowl(bowl: Bowl, centre: Any, box: float, hope: float, directions: Any = ((1, 0), (0, 1))) -> FloatArray:
    pytest.importorskip("cmaes")
    known: Any = bowl
    moved = np.array(directions, float)
    return _best_within(known, moved, np.zeros(len(moved)), np.array(centre), box, PointChoice(hope, 4.0, 0.0), (1, 2))


def test_a_batch_is_asked_within_its_box_and_the_cube() -> None:
    bowl = Bowl((0.6, 0.45), (0.4, 0.5))
    assert least_of_bowl(bowl, (0.5, 0.5), 0.2, 0.0) == pytest.approx([0.6, 0.45], abs=1e-3)
    assert least_of_bowl(bowl, (0.5, 0.5), 0.2, 1.0) == pytest.approx([0.5, 0.475], abs=1e-3)
    assert least_of_bowl(bowl, (0.5, 0.9), 0.05, 0.0) == pytest.approx([0.55, 0.85], abs=2e-3)
    assert least_of_bowl(Bowl((1.4, -3.0), (0, 0)), (0.9, 0.1), 0.3, 0.0) == pytest.approx([1.0, 0.0], abs=2e-3)
    along = least_of_bowl(Bowl((0.5, 0.5), (0, 0)), (0.4,), 0.3, 0.0, ((1.0,), (1.0,)))
    assert along == pytest.approx([0.5], abs=1e-3)


def test_a_batch_is_asked_about_its_centre(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a deviation of 0.4 of half of the box, which ends where the cube does."""
    asked: list[Any] = []

    def kept(*told: Any) -> Any:
        asked.append(told)
        return optimiser_within(*told)

    monkeypatch.setattr(surrogate, "optimiser_within", kept)
    least_of_bowl(Bowl((0.5, 0.5), (0.0, 0.0)), (0.95, 0.5), 0.1, 0.0)
    ((limits, mean, spread, seed),) = asked
    assert limits == pytest.approx(np.array([[0.85, 1.0], [0.4, 0.6]]))
    assert mean.tolist() == [0.95, 0.5]
    assert spread == pytest.approx(0.04)
    assert seed == (1, 2)


def search_of(values: list[float], places: Any, **changes: Any) -> SurrogateSearch:
    """A search with evaluations that are made."""
    found = [
        SimpleNamespace(place=tuple(place), value=value, row={}) for place, value in zip(places, values, strict=True)
    ]
    least = found[int(np.argmin(values))]
    made: Any = SimpleNamespace(found=found, least=least)
    return SurrogateSearch(batches=made, count=9, kinds=2, spread=0.1, seed=(3,), **changes)


def test_a_batch_begins_where_the_least_is_expected() -> None:
    """A bowl with its least at (0.3, 0.6), evaluated on a grid: the first finds it, each place is its own."""
    pytest.importorskip("cmaes")
    places = np.array(list(product((0.1, 0.3, 0.5, 0.7), (0.2, 0.4, 0.6, 0.8))))
    values = (2.0 + (places[:, 0] - 0.3) ** 2 + (places[:, 1] - 0.6) ** 2).tolist()
    chosen = search_of(values, places)._choose_batch(np.eye(2), 0.1, 1)
    assert len(chosen) == len(BATCH)
    assert chosen[0] == pytest.approx([0.3, 0.6], abs=0.03)
    assert all(np.abs(each - [0.3, 0.6]).max() < 0.1 + 1e-9 for each in chosen)
    assert len({tuple(each) for each in chosen}) == 4


def test_failures_are_no_centre() -> None:
    """The only point that passed is (0.8, 0.8): the box is about it, though the process expects less elsewhere."""
    pytest.importorskip("cmaes")
    places = [(0.2, 0.2), (0.2, 0.5), (0.5, 0.2), (0.8, 0.8)]
    chosen = search_of([1000.2, 1000.3, 1000.1, 9.0], places)._choose_batch(np.eye(2), 0.05, 0)
    assert all(np.abs(each - 0.8).max() < 0.05 + 1e-9 for each in chosen)


def test_numbers_of_a_place() -> None:
    alike = np.tile(np.eye(2), (3, 1))
    assert SurrogateSearch._steps_along(alike, np.array([0.2, 0.6] * 3)) == pytest.approx([0.2, 0.6])
    assert SurrogateSearch._steps_along(alike, np.array([0.1, 0.6, 0.2, 0.6, 0.6, 0.9])) == pytest.approx([0.3, 0.7])
    assert SurrogateSearch.first_of(3) == 8


class Asked:
    """A search's batches that keep what is requested, of a function."""

    def __init__(self, function: Any) -> None:
        self.function, self.found, self.sizes = function, [], []  # type: ignore[var-annotated]

    @property
    def least(self) -> Any:
        return min(self.found, key=lambda each: each.value)

    def evaluate(self, batch: Any) -> None:
        self.sizes.append(len(batch))
        self.found += [SimpleNamespace(place=tuple(each), value=self.function(each), row={}) for each in batch]


def asked_by(function: Any, start: Any, **changes: Any) -> Asked:
    pytest.importorskip("cmaes")
    made: Any = Asked(function)
    usual: dict[str, Any] = {"count": 14, "kinds": 2, "spread": 0.1, "seed": (1,)}
    SurrogateSearch(batches=made, **usual | changes).least(np.array(start))
    return made


def bowl(place: FloatArray) -> float:
    return float(2.0 + np.sum((place - 0.5) ** 2))


def test_turns_alike_are_drawn_alike_first() -> None:
    """Of four numbers in two turns: the start, 6 alike, a quarter of 14 alike, then 2 of each for itself."""
    made = asked_by(bowl, [0.4, 0.6, 0.4, 0.6])
    assert made.sizes == [1, 6, 2, 4, 4]
    assert [each.place[:2] == pytest.approx(each.place[2:]) for each in made.found] == [True] * 7 + [False] * 10
    first = np.array([each.place for each in made.found[1:7]])
    assert np.abs(first - made.found[0].place).max() <= 0.2  # twice the spread
    assert np.abs(first - made.found[0].place).max() > 0.1
    second = np.array([each.place for each in made.found[7:9]])
    assert np.abs(second - np.array(min(made.found[:7], key=lambda each: each.value).place)).max() <= 0.1
    apart = asked_by(bowl, [0.4, 0.6, 0.4, 0.5], count=4)
    assert apart.sizes == [1, 2, 4]
    single = asked_by(bowl, [0.4, 0.6], count=4)
    assert single.sizes == [1, 1, 4]


def test_it_ends_where_three_batches_gain_nothing_or_the_box_is_small() -> None:
    flat = asked_by(lambda _: 3.0, [0.4, 0.6], count=400, settled=1e-3)
    assert flat.sizes == [1, 1, 4, 4, 4]
    shrunk = asked_by(lambda _: 3.0, [0.4, 0.6], count=400, spread=0.03)
    assert shrunk.sizes == [1, 1, 4, 4]  # half of twice the spread, a fifth less after each: 30, 24, 19 thousandths


def test_the_time_of_a_race_that_failed() -> None:
    """1000 for each gate not passed, what it was missed by, at most 100 m, and the way that is left."""
    course, last = straight_course(), WAY

    def scored(y: float, to: float, *, finished: bool = True) -> Any:
        time = np.linspace(0.0, 10.0, 401)
        point = MovingPoint(time, np.column_stack([-5.0 + (to + 5.0) * time / 10.0, np.full(401, y)]))
        return score_of(passages(course, point, {}), (to, y), finished=finished, words="fell")

    beside = scored(30.0, last + 20.0)  # outer poles at 5 m, twice, and a turning pole at 1 m
    assert (beside.time, beside.passed) == (None, 0)
    assert beside.value == pytest.approx(3000.0 + 25.0 + 29.0 + 25.0)
    assert "was missed" in beside.words
    assert scored(0.0, -300.0).value == pytest.approx(3100.0)
    early = scored(0.0, last - 15.0, finished=False)
    assert (early.value, early.passed) == (pytest.approx(2000.0 + 15.0), 1)
    assert early.words == "fell"
    assert scored(0.0, last - 15.0).words.startswith("Gate 20 ")
    assert scored(0.0, last + 5.0, finished=False).value == pytest.approx(1000.0)
    through = scored(0.0, last + 5.0)
    assert through.time == through.value == pytest.approx(10.0 * (last + 5.0) / (last + 10.0))
    assert score_of(None, (0.0, 0.0), finished=True, words="stopped").value == math.inf


def test_a_wider_waist_is_widest_at_the_waist() -> None:
    """A parabola over the sidecut: all of it in its middle, three quarters half way out, none at its ends."""
    ski = replace(read_ski("slalom"), sidecut_middle=0.015)
    other = wider(ski, 2e-3)
    more = other.width - ski.width
    for share, part in ((0.0, 1.0), (0.5, 0.75), (-0.5, 0.75), (1.0, 0.0), (-1.0, 0.0)):
        place = ski.sidecut_middle + share * 0.5 * ski.sidecut_length
        assert np.interp(place, ski.station[::-1], more[::-1]) == pytest.approx(2e-3 * part, abs=2e-5)
    assert other.name == "slalom, waist +2 mm"


def test_a_skier_is_scored_by_its_run() -> None:
    short, line = SLALOM.with_(duration_s=0.02, method="fast"), first_gates(FOLLOWED, 2)
    assert Racer(short, "skier").score(line) == run_score(ski_line(short, line))
    assert Racer(short, "skier").score(line).value > 1000.0


def test_values_at_the_limits_are_accepted() -> None:
    _require_settings(evaluations=1, population=4, spread=1.0, settled=0.0, room=1.0)
    _require_settings(evaluations=2, population=None, spread=0.01, settled=999.0, room=0.0)
    usual = {"evaluations": 1, "population": None, "spread": 0.1, "settled": 0.0, "room": 0.0}
    for wrong in ({"spread": 1.01}, {"settled": 1000.0}, {"room": -0.1}):
        with pytest.raises(ParameterError):
            _require_settings(**(usual | wrong))  # type: ignore[arg-type]
    assert _window_and_step(6, None, 1, 0) == (6, 1)
    assert (_window_and_step(6, 2, 2, 9), _window_and_step(6, 6, 6, 0)) == ((2, 2), (6, 6))
    for window, step in ((1, 1), (7, 1), (3, 0)):
        with pytest.raises(ParameterError):
            _window_and_step(6, window, step, 0)
    cases = ((None, "skier"), (None, "point"), ("cma", "skier"))
    assert [_search_method(*case) for case in cases] == ["surrogate", "cma", "cma"]


def test_a_search_begins_from_a_line_of_some_of_the_gates() -> None:
    start = first_gates(FOLLOWED, 4)
    assert len(_start_line(SLALOM, 3, start).turns) == 3
    assert len(_start_line(SLALOM, 4, start).turns) == 4
    assert len(_start_line(SLALOM, None, None).turns) == 20
    with pytest.raises(ParameterError, match="4 turns"):
        _start_line(SLALOM, None, start)
    with pytest.raises(ParameterError, match="from 2 to 4"):
        _start_line(SLALOM, 5, start)


def test_a_search_begins_within_its_ranges() -> None:
    course, start = first_gates(FOLLOWED, 2).course, FOLLOWED.start

    def begun(**numbers: float) -> RacingLine:
        turns = (LineTurn(aside=0.8), LineTurn(**({"aside": 0.8} | numbers)))
        return _start_line(SLALOM, 2, RacingLine(course, start, turns))

    for name, low, high in (("aside", 0.25, 1.75), ("along", -0.25, 0.25), ("turning", 0.35, 1.0)):
        assert [getattr(begun(**{name: value}).turns[1], name) for value in (low, high)] == [low, high]
        with pytest.raises(ParameterError, match=f"gate 2: {name} is .* begins within {low:g} to {high:g}"):
            begun(**{name: low - 0.01})


def test_batches_of_either_search(tmp_path: Path) -> None:
    pytest.importorskip("cmaes")

    def made(**named: Any) -> int:
        usual: dict[str, Any] = {"gates": 2, "model": "point", "workers": 1, "seed": 1}
        return len(quickest_line(SLALOM, **usual | named).history)

    assert made(search="cma", evaluations=2, population=5) == 6
    assert made(search="surrogate", evaluations=1) == 1
    with pytest.raises(ParameterError, match="executor"):
        made(evaluations=1, executor=3)
    with pytest.raises(ParameterError):
        made(evaluations=1, executor=str(tmp_path / "none.toml"), checkpoint=tmp_path / "kept")
    assert not (tmp_path / "kept").exists()
    assert (
        made(search="surrogate", evaluations=2) == 4
    )  # one is enough of turns alike; half of six numbers of each for itself


def test_evaluations_are_those_that_were_asked_for() -> None:
    """A row of another place is refused: the file is of another machine or library."""
    line, kept = Polyline(), KeptRows()
    with Pool(line, 1, advice="") as pool:
        batches(Evaluations(pool, kept, [])).evaluate([np.array([0.2, 0.4, 0.6])])
        again = batches(Evaluations(pool, kept, []))
        again.evaluate([np.array([0.2, 0.4, 0.6])])
        assert again.least.place == (0.2, 0.4, 0.6)
        with raises(ParameterError, "different_versions"):
            batches(Evaluations(pool, kept, [])).evaluate([np.array([0.2, 0.4, 0.7])])


def test_the_nearer_neighbour_of_a_gate() -> None:
    x = [gate.turning[0] for gate in FOLLOWED.course.gates]
    found = turn_lengths(FOLLOWED.course, (x[0] - 4.0, 0.0))
    assert found[0] == pytest.approx(min(4.0, x[1] - x[0]))
    assert found[5] == pytest.approx(min(x[5] - x[4], x[6] - x[5]))
    assert found[-1] == pytest.approx(x[-1] - x[-2])
