from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.interpolate import PchipInterpolator
from tests.coded import raises

from skisnow._support.errors import ParameterError
from skisnow.ski.table_file import StationTable, evenly_spread


@given(arrays(float, st.integers(1, 9), elements=st.floats(0.01, 1e4)), st.floats(-1.5, 1.5))
def test_values_stay_between_their_neighbours(values: np.ndarray, place: float) -> None:
    table = evenly_spread(values, 1.0, -1.0)
    value = float(table.at(np.array([place]))[0])
    if values.size == 1:
        low, high = values[0], values[0]
    else:
        before = int(np.clip((1.0 - place) / 2.0 * (values.size - 1), 0, values.size - 2))
        low, high = sorted(values[before : before + 2])
        if place >= 1.0:
            low = high = values[0]
        if place <= -1.0:
            low = high = values[-1]
    # the rounding of the cubic, and of the division that finds the neighbours
    assert low * (1 - 1e-9) - 1e-9 <= value <= high * (1 + 1e-9) + 1e-9


@given(
    st.lists(st.tuples(st.integers(1, 9), st.integers(-5, 5)), min_size=2, max_size=8),
    arrays(float, 5, elements=st.floats(0.0, 1.0)),
)
def test_cubics_are_those_of_scipy(points: list[tuple[int, int]], places: np.ndarray) -> None:
    """Steps of one to nine apart, values that rise, fall and stay."""
    x = np.cumsum([step for step, _ in points]) / 10.0
    y = np.array([value for _, value in points], float)
    at = x[0] + places * (x[-1] - x[0])
    assert StationTable(x[::-1], y[::-1]).at(at) == pytest.approx(PchipInterpolator(x, y)(at), rel=1e-12, abs=1e-13)


def test_a_straight_line_is_kept() -> None:
    table = StationTable(np.array([0.7, 0.1, -0.3, -0.7]), np.array([0.7, 0.1, -0.3, -0.7]) * 100 + 200)
    at = np.linspace(0.7, -0.7, 29)
    assert table.at(at) == pytest.approx(at * 100 + 200, rel=1e-12)


def test_tip_is_listed_first() -> None:
    table = evenly_spread([1.0, 2.0, 4.0], 0.6, -0.6)
    assert table.at(np.array([0.6, 0.0, -0.6])) == pytest.approx([1.0, 2.0, 4.0])


def test_bad_tables() -> None:
    with raises(ParameterError, "wrong_shape", size=3, size_2=2):
        StationTable(np.array([0.5, 0.0]), np.ones(3))
    with raises(ParameterError, "not_falling"):
        StationTable(np.array([0.0, 0.5]), np.ones(2))
    for nothing in (np.zeros(0), np.zeros((1, 2))):
        with raises(ParameterError, "wrong_shape", size=nothing.size, size_2=nothing.size):
            StationTable(nothing, nothing)
