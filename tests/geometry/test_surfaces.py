"""Grids: what is taken, and every place or value that is refused."""

import math

import numpy as np
import pytest
from tests.coded import Coded, coded, raises

from skisnow._support.errors import ParameterError
from skisnow.compiled import core
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
        ([0.0, math.nan], [0.0], [[1.0], [2.0]], coded("not_a_number", name="x")),
        ([0.0, 1.0], [math.inf], [[1.0], [2.0]], coded("not_a_number", name="y")),
        ([0.0, 1.0], [0.0], [[1.0], [math.nan]], coded("not_a_number", name="values")),
        ([], [0.0], np.zeros((0, 1)), coded("wrong_shape", name="x", shape="(0,)")),
        ([0.0], [[0.0, 1.0]], [[1.0, 2.0]], coded("wrong_shape", name="y", shape="(1, 2)")),
        ([0.0, 0.0], [0.0], [[1.0], [2.0]], coded("not_rising", name="x", min=0.0, max=0.0)),
        ([1.0, 0.0], [0.0], [[1.0], [2.0]], coded("not_rising", name="x", min=-1.0, max=-1.0)),
        ([0.0], [0.0, 1.0, 3.0], [[1.0, 2.0, 3.0]], coded("not_rising", name="y", min=1.0, max=2.0)),
        ([0.0, 1.0], [0.0], [[1.0, 2.0]], coded("wrong_shape", shape="(1, 2)", n_x=2, n_y=1)),
    ],
)  # fmt: skip
def test_what_is_no_grid_is_refused(
    x: list[float], y: list[float], values: list[list[float]], said: str | Coded
) -> None:
    with raises(ParameterError, said):
        Grid(np.asarray(x), np.asarray(y), np.asarray(values))


def test_steps_may_differ_by_rounding_alone() -> None:
    """Steps of a tenth differ by some 1e-16 m; a micrometre in a metre is no rounding."""
    tenths = 0.1 * np.arange(1001)
    assert np.ptp(np.diff(tenths)) > 0.0
    Grid.along(tenths, tenths)
    with raises(ParameterError, "not_rising"):
        Grid.along([0.0, 1.0, 2.000001], np.zeros(3))


def test_patches_are_those_of_the_compiled_core() -> None:
    """Inside, on places, and beyond each border."""
    rng = np.random.default_rng(5)
    for n, m in ((9, 6), (1, 6), (2, 3), (3, 1)):
        grid = Grid(
            np.linspace(-1.0, 3.0, n) if n > 1 else np.zeros(1), np.linspace(0.0, 2.0, m), rng.normal(size=(n, m))
        )
        step_x, step_y = grid.steps
        for goes_on in (True, False):
            there = core.grid(grid.x[0], step_x, grid.y[0], step_y, grid.values.copy(), goes_on)
            for x, y in [*rng.uniform(-2.0, 4.0, (40, 2)).tolist(), (-1.0, 0.0), (3.0, 2.0)]:
                value, along_x, along_y = there.at(x, y)
                found = grid.heights(x, y) if goes_on else grid.values_at(x, y)
                assert float(found) == pytest.approx(value, abs=1e-12)
                assert [float(each) for each in grid.gradients(x, y)] == pytest.approx([along_x, along_y], abs=1e-12)
