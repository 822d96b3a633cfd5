"""The nearest place on a path is the true one: held against every piece, one after the other."""

import itertools
import math

import numpy as np
import numpy.typing as npt
import pytest

from skisnow._support.errors import ParameterError
from skisnow.comparison.nearest_place import Path, distance_from_path
from tests.coded import raises

FloatArray = npt.NDArray[np.float64]


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
    points = path[random.integers(0, len(path), 200)] + far * random.normal(size=(200, dimensions))
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
    points = 500.0 * arc[random.integers(0, 3001, 60)]
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


def test_a_path_in_one_place_is_refused() -> None:
    with raises(ParameterError, "one_place"):
        Path(np.ones((4, 3)))
