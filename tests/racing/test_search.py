"""The search against known optima, seeded, interrupted and continued."""

import math
import sys
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow import QuickestLine, Scenario, load_scenario, race, simulate
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow._support.processes.batch import Pool
from skisnow._support.processes.kept_rows import KeptRows
from skisnow.racing import compare_variants, drawn_for_race, follower_line
from skisnow.racing.line import first_gates
from skisnow.racing.point import run_score, ski_line
from skisnow.racing.search import Batches, Evaluated, Evaluations, minimise
from skisnow.racing.surrogate import Surrogate, times_of
from tests.present import present

from .test_point import WAY, glide, straight_course

SLALOM = load_scenario("slalom-20-gates")
EASY = SLALOM.with_(greatest_edge_deg=75.0)
"""A point may turn there as the follower does."""


@dataclass(frozen=True)
class Polyline:
    """Time without friction from rest over straight pieces to a point aside; nodes at fixed places down the slope."""

    down: float = 2.0
    x: tuple[float, ...] = (0.0, 1.0, 3.0, 6.0, 10.0)
    aside: float = 8.0

    def pieces(self, y: Any) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Length, mean speed and rise aside of each piece."""
        whole = np.array([0.0, *y, self.aside])
        speed = np.sqrt(2.0 * self.down * np.array(self.x))
        rise = np.diff(whole)
        return np.hypot(rise, np.diff(self.x)), 0.5 * (speed[1:] + speed[:-1]), rise

    def __call__(self, place: tuple[float, ...]) -> dict[str, Any]:
        length, speed, _ = self.pieces(self.aside * np.array(place))
        return {"place": list(place), "value": float(np.sum(length / speed))}


def batches(made: Evaluations) -> Batches:
    """Of places only, without reports of progress."""
    return Batches(evaluations=made, point_of=lambda place: tuple(place.tolist()), told=lambda *_: None, first=0)


def test_a_brachistochrone_of_pieces_obeys_snell() -> None:
    """At the optimum the sine of the angle over the mean speed is the same on each piece."""
    pytest.importorskip("cmaes")
    line = Polyline()
    with Pool(line, 1, advice="") as pool:
        made = batches(Evaluations(pool, KeptRows(), []))
        best = minimise(made, np.full(3, 0.5), count=600, population=None, spread=0.2, seed=(5,))
    length, speed, rise = line.pieces(line.aside * np.array(best.place))
    assert rise / length / speed == pytest.approx(np.full(4, (rise / length / speed).mean()), rel=1e-4)
    assert cycloid(line.x[-1], line.aside, line.down) < best.value < 1.03 * cycloid(line.x[-1], line.aside, line.down)
    assert best.value < 0.97 * 2.0 * math.hypot(10.0, 8.0) / math.sqrt(2.0 * 2.0 * 10.0)  # the straight line


def cycloid(x: float, y: float, down: float) -> float:
    """Time of the brachistochrone to a point."""
    low, high = 1e-6, 2.0 * math.pi - 1e-6
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (middle - math.sin(middle)) / (1.0 - math.cos(middle)) < y / x else (low, middle)
    return low * math.sqrt(x / (1.0 - math.cos(low)) / down)


def raced(asked: Scenario = SLALOM, **named: Any) -> QuickestLine:
    pytest.importorskip("cmaes")
    usual: dict[str, Any] = {"gates": 2, "model": "point", "evaluations": 40, "workers": 1, "room": 0.0}
    return race(asked, **usual | named)


def test_gates_that_the_fall_line_passes_are_raced_straight() -> None:
    """From where both sides turn by 0.2 m to the straight glide, whose time is known."""
    found = raced(SLALOM.with_(course=straight_course(), mass_kg=80.0), gates=3, evaluations=120, spread=0.1, seed=3)
    from skisnow.racing import PointRacer

    _, exact = glide(PointRacer.of(found.scenario), WAY)
    assert present(found.start_score.time) - exact > 2e-3
    assert 0.0 <= present(found.score.time) - exact < 2e-4
    assert [turn.aside for turn in found.line.turns] == pytest.approx([1.0, 1.0, 1.0], abs=0.08)


def test_the_same_seed_gives_the_same_bits_and_another_another_line() -> None:
    first, again, third = (raced(EASY, seed=seed, evaluations=16).line.turns for seed in (7, 7, 8))
    assert first == again
    assert first != third


def test_interrupted_and_gone_on_with(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    whole = raced(seed=2, evaluations=24)

    def stop(text: str) -> None:
        if " 12 of 24" in text:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        raced(seed=2, evaluations=24, checkpoint=kept, progress=stop)
    done = len(KeptRows.read(kept))
    assert 10 < done < 24
    told: list[str] = []
    found = raced(seed=2, evaluations=24, checkpoint=kept, progress=told.append)
    assert [each.row for each in found.history] == [each.row for each in whole.history]
    assert found.line.turns == whole.line.turns
    assert len(told) == len(whole.history) - done
    with pytest.raises(ParameterError, match="of another study"):
        raced(seed=3, checkpoint=kept)


def test_it_is_never_slower_than_where_it_began() -> None:
    found = raced(EASY, evaluations=12)
    assert present(found.gained) >= 0.0
    assert found.history[0].value == found.start_score.value
    assert found.score.value == min(each.value for each in found.history)


@pytest.mark.slow
def test_five_seeds_find_the_same_time_through_four_gates() -> None:
    """The first line is too tight for the ski."""
    found = [raced(gates=4, evaluations=3000, seed=seed) for seed in range(1, 6)]
    times = [each.score.time for each in found]
    assert found[0].start_score.time is None
    assert times == pytest.approx([7.499] * 5, abs=0.003)


@pytest.mark.slow
def test_a_window_that_moves_on_finds_what_the_whole_search_finds() -> None:
    parts, whole = (
        raced(EASY, gates=6, evaluations=n, window=window, step=1) for n, window in ((500, 3), (1500, None))
    )
    assert parts.score.time == pytest.approx(whole.score.time, abs=0.02)
    assert present(parts.gained) > 0.1


@pytest.mark.parametrize(
    ("named", "words"),
    [
        ({"gates": 1}, "gates is 1"),
        ({"gates": 21}, "from 2 to 20"),
        ({"evaluations": 0}, "evaluations is 0"),
        ({"population": 3}, "population is 3"),
        ({"spread": 0.0}, "spread is 0"),
        ({"room": 1.5}, "room is 1.5"),
        ({"ahead": -1}, "ahead is -1"),
        ({"settled": -1.0}, "settled is -1"),
        ({"search": "grid"}, "search is .grid."),
        ({"window": 3}, "window is 3"),
        ({"window": 2, "step": 3}, "step is 3"),
    ],
)
def test_rejected_input(named: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        race(SLALOM, **({"gates": 2} | named))


def test_without_cmaes_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cmaes", None)
    with pytest.raises(ParameterError, match=r"skisnow\[racing\]"):
        race(SLALOM, gates=2, model="point")


def test_a_scenario_without_a_skier_is_rejected() -> None:
    with pytest.raises(ParameterError, match="no skier"):
        race(replace(SLALOM, skier=None))


DRAWN = np.random.default_rng(4).random((9, 2))
GIVEN = 5.0 + np.sin(3.0 * DRAWN[:, 0]) + 0.5 * DRAWN[:, 1] ** 2


def matern(first: FloatArray, second: FloatArray, lengths: FloatArray) -> FloatArray:
    """(1 + √5 r + 5 r²/3) exp(-√5 r), one pair after the other."""
    found = np.zeros((len(first), len(second)))
    for i, j in product(range(len(first)), range(len(second))):
        r = math.sqrt(sum(((a - b) / length) ** 2 for a, b, length in zip(first[i], second[j], lengths, strict=True)))
        found[i, j] = (1.0 + math.sqrt(5.0) * r + 5.0 * r**2 / 3.0) * math.exp(-math.sqrt(5.0) * r)
    return found


def test_the_process_is_that_of_the_textbook() -> None:
    """m + s k (K + σ² 1)⁻¹ z, and s² (1 - k (K + σ² 1)⁻¹ k), by plain linear algebra."""
    known, asked = Surrogate.of(DRAWN, GIVEN, 2), np.array([[0.2, 0.4], [0.9, 1.3]])
    inner = matern(DRAWN, DRAWN, known.lengths) + known.noise**2 * np.eye(9)
    outer = matern(asked, DRAWN, known.lengths)
    level, scale = np.mean(GIVEN), np.std(GIVEN)
    mean = level + scale * outer @ np.linalg.solve(inner, (GIVEN - level) / scale)
    variance = 1.0 - np.einsum("ij,ji->i", outer, np.linalg.solve(inner, outer.T))
    found = known.at(asked)
    assert found[0] == pytest.approx(mean, rel=1e-5)
    assert found[1] == pytest.approx(scale * np.sqrt(variance), rel=1e-3)


def test_the_process_is_the_likeliest() -> None:
    """Of its length (the same for both numbers) and noise every other is less likely, with a pull towards 0.7."""
    known = Surrogate.of(DRAWN, GIVEN + 0.05 * np.cos(40.0 * DRAWN[:, 0]), 1)
    standard = np.sin(3.0 * DRAWN[:, 0]) + 0.5 * DRAWN[:, 1] ** 2 + 0.05 * np.cos(40.0 * DRAWN[:, 0])
    standard = (standard - standard.mean()) / standard.std()

    def misfit(length: float, noise: float) -> float:
        inner = matern(DRAWN, DRAWN, np.full(2, length)) + (noise**2 + 1e-9) * np.eye(9)
        likelihood = 0.5 * standard @ np.linalg.solve(inner, standard) + 0.5 * np.linalg.slogdet(inner)[1]
        return float(likelihood + 0.1 * math.log(length / 0.7) ** 2)

    length, noise = float(known.lengths[0]), known.noise
    least = misfit(length, noise)
    assert known.lengths[1] == length
    others = [(length * 1.1, noise), (length / 1.1, noise), (length, max(noise * 1.2, 1e-3)), (length, noise / 1.2)]
    assert all(misfit(*other) > least - 1e-6 for other in others if other[1] > 1e-3)
    assert misfit(length * 1.3, noise) > least + 1e-3


def test_values_that_are_all_alike_are_learnt() -> None:
    assert Surrogate.of(DRAWN, np.full(9, 7.0), 2).at(DRAWN)[0] == pytest.approx(7.0)


def test_times_of_failures_by_hand() -> None:
    """A failure has its time at the last gate; one without, or a detour, three quarter widths above the median."""
    times = [8.0, 8.1, 8.2, 8.3]
    found = [Evaluated(i, (0.0,), {"value": time}) for i, time in enumerate(times)]
    straddled = Evaluated(4, (0.0,), {"value": 1000.4, "gates": [["straddled", 4.0], ["passed", 8.4]]})
    fell = Evaluated(5, (0.0,), {"value": 2003.0, "gates": [["passed", 4.0], ["not_reached", None]]})
    most = 8.2 + 3.0 * 0.2
    assert times_of([*found, straddled, fell]) == pytest.approx([*times, 8.4, most])
    detour = Evaluated(6, (0.0,), {"value": 20.0})
    assert times_of([*found, straddled, detour])[5] == pytest.approx(8.25 + 3.0 * 0.25)
    assert times_of([fell, Evaluated(7, (0.0,), {"value": math.inf})]) == pytest.approx(np.log([2003.0, 1e6]))


RACE = load_scenario("slalom-20-gates").with_(method="fast")
FOUR = first_gates(follower_line(RACE), 4)
MARGIN = 0.3
"""Time (s) by which four gates are quicker than the path follower."""


def test_on_the_followers_line_it_does_what_the_follower_does() -> None:
    short = RACE.with_(duration_s=0.4)
    own, lines = simulate(short), ski_line(short, follower_line(short))
    assert lines.place[-1] == pytest.approx(own.place[-1], abs=1e-9)
    assert lines.boots_by == "moved by LineSkier"


SKIDDED = load_scenario("slalom-15deg").with_(method="fast")


def test_a_skier_in_skidded_turns_brakes_to_the_speed_of_the_line() -> None:
    line = follower_line(SKIDDED)
    faster = replace(line, turns=tuple(replace(turn, speed=1.5) for turn in line.turns))
    ends = [ski_line(SKIDDED.with_(duration_s=2.0), each).speed[-1] for each in (line, faster)]
    assert ends[1] > ends[0] + 1.0


@pytest.mark.slow
def test_in_skidded_turns_line_and_speed_are_searched_and_skis_compared() -> None:
    pytest.importorskip("cmaes")
    found = race(SKIDDED, gates=3, evaluations=24, seed=0)
    assert {turn.speed for turn in found.line.turns} != {1.0}
    snows = drawn_for_race(SKIDDED.contact.snow, 4, spread=0.2, seed=0)
    (margin,) = compare_variants(found.scenario, {}, found.line, snows, start=found.start)
    others = {"giant-slalom": SKIDDED.with_(ski="giant-slalom")}  # falls on the line that was found
    (ski,) = compare_variants(found.scenario, others, found.start, snows)
    assert margin.verdict == "slower"
    assert margin.on_own_snow == pytest.approx(found.gained)
    assert ski.verdict == "faster"


def test_a_run_that_ends_early_counts_by_what_is_missing() -> None:
    found = run_score(ski_line(RACE.with_(duration_s=0.1), FOUR))
    assert (found.time, found.passed) == (None, 0)
    assert 4000.0 < found.value < 4100.0
    assert "not reached" in found.words


@pytest.mark.slow
def test_four_gates_are_raced_quicker_than_by_the_follower() -> None:
    """With the turns alike already."""
    pytest.importorskip("cmaes")
    found = race(RACE, gates=4, evaluations=13, seed=1)
    assert present(found.gained) > MARGIN
