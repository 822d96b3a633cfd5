"""The nearest place on a path is the true one: held against every piece, one after the other."""

import itertools
import json
import math

import numpy as np
import pytest
from benchmarks.track_headings import KINDS, fitted_track, row
from scipy.integrate import quad

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.comparison import compare_tracks, comparison_dict
from skisnow.comparison.distances import OffsetSeries, distance_statistics, mean_lengths
from skisnow.comparison.nearest_place import Path, distance_from_path
from tests.coded import raises

from .made_tracks import build_track


def by_hand(point: FloatArray, path: FloatArray) -> float:
    """Distance to the nearest of all pieces, by geometry: foot of the perpendicular, or an end."""
    least = math.inf
    for first, last in itertools.pairwise(path):
        length = float(np.linalg.norm(last - first))
        if length == 0.0:
            least = min(least, float(np.linalg.norm(point - first)))
            continue
        along = float((point - first) @ (last - first)) / length
        if 0.0 <= along <= length:
            square = float((point - first) @ (point - first)) - along**2
            least = min(least, math.sqrt(max(square, 0.0)))
        else:
            least = min(least, float(np.linalg.norm(point - (first if along < 0.0 else last))))
    return least


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("far", [0.1, 3.0, 400.0])
def test_nearest_of_a_tangled_path_with_pieces_of_every_length(dimensions: int, far: float) -> None:
    random = np.random.default_rng(7)
    steps = random.normal(size=(60, dimensions)) * random.choice([1e-3, 0.1, 5.0, 80.0], size=(60, 1))
    path = np.cumsum(steps, axis=0)
    path = np.insert(path, [5, 20, 20], path[[5, 20, 20]], axis=0)  # standing still
    points = path[random.integers(0, len(path), 60)] + far * random.normal(size=(60, dimensions))
    found = Path(path).nearest(points)
    expected = np.array([by_hand(point, path) for point in points])
    # both lose digits in differences of squares of numbers around 10³ m
    assert found.distance == pytest.approx(expected, rel=1e-9, abs=1e-9 * 1e3)
    assert np.linalg.norm(points - found.foot, axis=1) == pytest.approx(found.distance, rel=1e-12)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_nearest_of_dense_paths_seen_aslant_from_far(dimensions: int) -> None:
    """Arcs about one centre, with 2 cm of noise in the second half and a standstill in the middle: 3000 pieces."""
    random = np.random.default_rng(3)
    angle = np.concatenate([np.linspace(0.0, 0.4, 1000), np.full(1000, 0.4), np.linspace(0.4, 0.8, 1001)])
    arc = np.zeros((3001, dimensions))
    arc[:, 0], arc[:, 1] = np.cos(angle), np.sin(angle)
    path = 1000.0 * arc
    path[1000:] += 0.02 * random.standard_normal((2001, dimensions))
    points = 500.0 * arc[random.integers(0, 3001, 8)]
    found = Path(path).nearest(points)
    # both lose digits in differences of squares of numbers around 10³ m
    assert found.distance == pytest.approx([by_hand(point, path) for point in points], rel=1e-10)
    assert np.linalg.norm(points - found.foot, axis=1) == pytest.approx(found.distance, rel=1e-12)


@pytest.mark.parametrize("ends", [2, 3, 5, 17, 33])
def test_nearest_of_few_pieces(ends: int) -> None:
    random = np.random.default_rng(ends)
    path = np.cumsum(random.normal(size=(ends, 2)), axis=0)
    points = 3.0 * random.normal(size=(50, 2))
    assert Path(path).nearest(points).distance == pytest.approx([by_hand(point, path) for point in points], rel=1e-9)


@pytest.mark.slow
def test_many_points_in_one_place_among_many_pieces() -> None:
    """Every piece is as near as every other: more than can be looked at at once, for one point and for all."""
    angle = np.linspace(0.0, math.tau, 2001)
    circle = 10.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    found = Path(circle).nearest(np.zeros((2000, 2)))
    assert found.distance == pytest.approx(np.full(2000, 10.0 * math.cos(math.pi / 2000)), rel=1e-12)


def test_centre_of_a_circle_where_everything_is_equally_near() -> None:
    angle = np.linspace(0.0, math.tau, 5001)
    circle = 10.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    found = Path(circle).nearest(np.array([[0.0, 0.0], [1e-9, 0.0]]))
    assert found.distance == pytest.approx([10.0 * math.cos(math.pi / 5000)] * 2, rel=1e-9)


def test_way_direction_and_what_is_beyond() -> None:
    corner = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])
    asked = np.array([[1.0, 2.0], [3.5, 1.0], [6.0, -2.0], [-1.0, 0.5], [2.0, 9.0], [0.0, -1.0], [7.0, 3.0]])
    found = Path(corner).nearest(asked)
    assert found.arc_length == pytest.approx([1.0, 5.0, 4.0, 0.0, 7.0, 0.0, 7.0])
    assert found.distance == pytest.approx(
        [2.0, 0.5, math.hypot(2.0, 2.0), math.hypot(1.0, 0.5), math.hypot(2, 6), 1, 3]
    )
    # the outside of a corner is beside the path; exactly abreast of an end is beside it too
    assert found.beyond.tolist() == [False, False, False, True, True, False, False]
    assert found.direction[[0, 1]] == pytest.approx(np.array([[1.0, 0.0], [0.0, 1.0]]))


def test_distance_beside_has_none_without_a_path_or_a_place() -> None:
    path = np.array([[0.0, 0.0], [np.nan, 1.0], [2.0, 0.0]])
    assert distance_from_path(np.array([[1.0, 1.0], [np.nan, 0.0]]), path) == pytest.approx([1.0, np.nan], nan_ok=True)
    assert np.isnan(distance_from_path(np.array([[1.0, 1.0]]), np.zeros((3, 2)))).all()


def test_a_path_in_one_place_is_rejected() -> None:
    with raises(ParameterError, "one_place"):
        Path(np.ones((4, 3)))


# Intervals of fitted headings: coverage over simulated tracks, and none where other headings fit as well


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in KINDS if not name.startswith("arc of")])
def test_coverage_of_200_tracks(name: str) -> None:
    """Seeds that were not used to design the interval."""
    tracks = [fitted_track(*KINDS[name], seed) for seed in range(1000, 1200)]
    covers = [track.covers for track in tracks if track.covers is not None]
    assert len(covers) > 160, row(name, tracks)
    assert 0.90 <= np.mean(covers) <= 0.99, row(name, tracks)


@pytest.mark.parametrize("seed", range(3))
def test_arc_of_one_radius_has_no_interval(seed: int) -> None:
    motion = fitted_track("arc", 0.0, seed).motion
    assert motion.rival is not None
    assert motion.turned_error is None


def test_a_comparison_reports_the_other_heading_instead_of_an_interval() -> None:
    angle = np.linspace(0.0, 2.0, 200)
    circle: FloatArray = 15.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    noise = 0.02 * np.random.default_rng(7).normal(size=(120, 2))
    found = compare_tracks(
        build_track(circle, angle), build_track(circle[40:160] + noise, angle[40:160]), fit=("start", "heading")
    )
    fitted = json.loads(json.dumps(comparison_dict(found)))["fitted"]
    assert fitted["turned_error_deg"] is None
    assert abs(fitted["rival"]["turned_deg"] - fitted["turned_deg"]) > 5.0
    assert fitted["rival"]["rms_m"] < 0.05
    assert len(found.warnings) == 1


# Means of lengths of vectors that change linearly, against integrals done by quadrature and by hand


def test_mean_length_against_quadrature() -> None:
    """From nearly constant vectors to ones that pass through nothing; both formulas and the seam between them."""
    random = np.random.default_rng(3)
    first = random.normal(size=(60, 3))
    change = random.normal(size=(60, 3)) * np.repeat([1e-12, 1e-3, 0.049, 0.051, 1.0, 50.0], 10)[:, None]
    found = mean_lengths(first, first + change)
    for begin, step, value in zip(first, change, found, strict=True):
        low = float(np.clip(-(begin @ step) / (step @ step), 0.0, 1.0))

        def length(share: float, begin: FloatArray = begin, step: FloatArray = step) -> float:
            return float(np.linalg.norm(begin + share * step))

        expected, _ = quad(length, 0.0, 1.0, points=[low], epsabs=0.0, epsrel=1e-12)
        assert value == pytest.approx(expected, rel=1e-11)


def test_numbers_of_a_straight_line_that_leaves_another() -> None:
    """d = s tan α: mean L tan α / 2, rms L tan α / √3, largest at the end; the standstill at 2 m weighs nothing."""
    arc_length = np.array([0.0, 2.0, 2.0, 7.0, 10.0])
    found = distance_statistics(OffsetSeries(arc_length, np.column_stack([0.0 * arc_length, 0.1 * arc_length])))
    assert found is not None
    assert (found.max, found.max_at, found.mean, found.compared) == pytest.approx((1.0, 10.0, 0.5, 10.0))
    assert found.rms == pytest.approx(1.0 / math.sqrt(3.0), rel=1e-14)


def test_what_has_no_offset_is_left_out() -> None:
    offset = np.array([[1.0, 0.0], [1.0, 0.0], [np.nan, np.nan], [3.0, 0.0], [3.0, 0.0]])
    found = distance_statistics(OffsetSeries(np.array([0.0, 1.0, 5.0, 6.0, 9.0]), offset))
    assert found is not None
    assert (found.compared, found.mean) == pytest.approx((4.0, (1.0 + 3.0 * 3.0) / 4.0))
    assert distance_statistics(OffsetSeries(np.array([0.0, 1.0]), np.full((2, 2), np.nan))) is None
    assert distance_statistics(OffsetSeries(np.array([1.0, 1.0]), np.ones((2, 2)))) is None
