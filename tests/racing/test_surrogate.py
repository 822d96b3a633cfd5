"""A Gaussian process against what it was given, and a search that asks it against known optima."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import minimize

from skisnow._support.processes.kept_rows import KeptRows
from skisnow._support.processes.pool import Pool
from skisnow.racing.search import Evaluations
from skisnow.racing.surrogate import Surrogate
from skisnow.racing.surrogate_search import SurrogateSearch

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
    """Whose optimum obeys Snell, as the other test says; a simplex finds its time."""
    pytest.importorskip("cmaes")
    line = Polyline()
    with Pool(line, 1, advice="") as pool:
        made = Evaluations(pool, KeptRows(), [])
        search = SurrogateSearch(batches=batches(made), count=38, kinds=3, spread=0.2, seed=(seed,))
        best = search.least(np.full(3, 0.5))
    assert len(made.done) < 42

    def time_of(place: npt.NDArray[np.float64]) -> float:
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
    found = [raced(wide, gates=4, search="surrogate", evaluations=60, seed=seed).score.time for seed in range(1, 6)]
    assert found == pytest.approx([7.5] * 5, abs=0.01)
