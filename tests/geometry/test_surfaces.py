"""Grids: what is taken, and every place or value that is refused."""

import math

import numpy as np
import pytest

from skisnow.errors import ParameterError
from skisnow.geometry.surfaces import Grid


def test_a_grid_keeps_its_numbers() -> None:
    grid = Grid(np.array([0.0, 0.1, 0.2]), np.array([-1.0, 1.0]), np.arange(6.0).reshape(3, 2))
    assert (grid.x.tolist(), grid.y.tolist()) == ([0.0, 0.1, 0.2], [-1.0, 1.0])
    assert grid.values.tolist() == [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]
    assert not any(array.flags.writeable for array in (grid.x, grid.y, grid.values))


def test_a_profile_is_the_same_at_every_y() -> None:
    profile = Grid.along([0.0, 2.0, 4.0], [1.0, 5.0, 2.0])
    assert (profile.x.tolist(), profile.y.tolist()) == ([0.0, 2.0, 4.0], [0.0])
    assert profile.values.tolist() == [[1.0], [5.0], [2.0]]


def test_one_place_is_enough() -> None:
    assert Grid(np.zeros(1), np.zeros(1), np.array([[3.0]])).values.tolist() == [[3.0]]


@pytest.mark.parametrize(
    ("x", "y", "values", "said"),
    [
        ([0.0, math.nan], [0.0], [[1.0], [2.0]], "x holds a number that is not finite"),
        ([0.0, 1.0], [math.inf], [[1.0], [2.0]], "y holds a number that is not finite"),
        ([0.0, 1.0], [0.0], [[1.0], [math.nan]], "values holds a number that is not finite"),
        ([], [0.0], np.zeros((0, 1)), r"x must be a row of one place or more, its shape is \(0,\)"),
        ([0.0], [[0.0, 1.0]], [[1.0, 2.0]], r"y must be a row of one place or more, its shape is \(1, 2\)"),
        ([0.0, 0.0], [0.0], [[1.0], [2.0]], "x must rise evenly; their steps go from 0 to 0 m"),
        ([1.0, 0.0], [0.0], [[1.0], [2.0]], "x must rise evenly; their steps go from -1 to -1 m"),
        ([0.0], [0.0, 1.0, 3.0], [[1.0, 2.0, 3.0]], "y must rise evenly; their steps go from 1 to 2 m"),
        ([0.0, 1.0], [0.0], [[1.0, 2.0]], r"values have shape \(1, 2\); for 2 places in x and 1 in y"),
    ],
)  # fmt: skip
def test_what_is_no_grid_is_refused(x: list[float], y: list[float], values: list[list[float]], said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        Grid(np.asarray(x), np.asarray(y), np.asarray(values))


def test_steps_may_differ_by_rounding_alone() -> None:
    """Steps of a tenth differ by some 1e-16 m; a micrometre in a metre is no rounding."""
    tenths = 0.1 * np.arange(1001)
    assert np.ptp(np.diff(tenths)) > 0.0
    Grid.along(tenths, tenths)
    with pytest.raises(ParameterError, match="rise evenly"):
        Grid.along([0.0, 1.0, 2.000001], np.zeros(3))
