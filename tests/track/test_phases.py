"""Turning points of heights."""

import numpy as np
import pytest

from skisnow.track.phases import turning_points


def test_small_ups_and_downs_do_not_count() -> None:
    height = np.array([100.0, 104.0, 101.0, 180.0, 176.0, 179.0, 90.0, 96.0, 85.0, 130.0, 128.0])
    assert turning_points(height, 10.0) == [0, 3, 8, 9, 10]
    assert turning_points(height, 1.0) == list(range(11))


@pytest.mark.parametrize("values", [[5.0], [5.0, 5.0, 5.0], [0.0, 4.0, 0.0]])
def test_level_has_only_its_ends(values: list[float]) -> None:
    assert turning_points(np.array(values), 10.0) == sorted({0, len(values) - 1})


def test_upside_down_has_the_same_turning_points() -> None:
    height = np.cumsum(np.random.default_rng(4).standard_normal(500))
    assert turning_points(height, 3.0) == turning_points(-height, 3.0)


def test_neighbours_differ_enough() -> None:
    height = np.cumsum(np.random.default_rng(5).standard_normal(2000))
    corners = turning_points(height, 4.0)
    assert len(corners) > 20
    assert np.abs(np.diff(height[corners]))[1:-1].min() >= 4.0
    assert np.all(np.diff(np.sign(np.diff(height[corners])))[1:-1] != 0)
