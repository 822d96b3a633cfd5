from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from skisnow.errors import ParameterError
from skisnow.ski.station_table import StationTable, evenly_spread


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


def test_a_straight_line_is_kept() -> None:
    table = StationTable(np.array([0.7, 0.1, -0.3, -0.7]), np.array([0.7, 0.1, -0.3, -0.7]) * 100 + 200)
    at = np.linspace(0.7, -0.7, 29)
    assert table.at(at) == pytest.approx(at * 100 + 200, rel=1e-12)


def test_tip_is_listed_first() -> None:
    table = evenly_spread([1.0, 2.0, 4.0], 0.6, -0.6)
    assert table.at(np.array([0.6, 0.0, -0.6])) == pytest.approx([1.0, 2.0, 4.0])


def test_bad_tables() -> None:
    with pytest.raises(ParameterError, match="3 values stand at 2 stations"):
        StationTable(np.array([0.5, 0.0]), np.ones(3))
    with pytest.raises(ParameterError, match="List them from tip to tail"):
        StationTable(np.array([0.0, 0.5]), np.ones(2))
