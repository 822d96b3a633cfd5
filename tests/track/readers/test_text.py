"""Dates and times in the cells of tables."""

from __future__ import annotations

from datetime import datetime

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.track.readers.text import moment, spread_times


@pytest.mark.parametrize("cell", ["", "12:30:00", "2022-12-27", "20221227", "2022-12-27T15", "٢٠٢٢-١٢-٢٧T١٥:٥١"])
def test_a_moment_needs_a_date_and_minutes_in_plain_figures(cell: str) -> None:
    assert moment(cell) is None


def test_a_moment_without_a_zone_keeps_its_clock() -> None:
    assert moment("2022-12-27T15:51") == datetime(2022, 12, 27, 15, 51)


FloatArray = npt.NDArray[np.float64]


def straight(time: FloatArray) -> FloatArray:
    """10 m/s to the north."""
    return np.column_stack([np.zeros(len(time)), 10.0 * time])


@pytest.mark.parametrize("rate", [2.0, 3.0, 5.0, 10.0, 12.5, 18.18, 25.0, 100.0])
@pytest.mark.parametrize("begin", [0.0, 0.37, 0.9])
@pytest.mark.parametrize("unit", [1.0, 0.1])
def test_even_rates(rate: float, begin: float, unit: float) -> None:
    rate = rate if unit == 1.0 else 10.0 * rate
    true = begin * unit + np.arange(round(12.0 * unit * rate)) / rate
    found, moved = spread_times(unit * np.floor(true / unit + 1e-9), straight(true))
    assert moved.any()
    np.testing.assert_allclose(np.diff(found), 1.0 / rate, rtol=0.02)
    assert np.max(np.abs(found - true)) <= 1.01 / rate  # the phase within a stamp is not recorded


def test_lost_points_and_a_pause() -> None:
    """Each stamp keeps its points: the speed over whole seconds is right."""
    true = np.arange(0.0, 20.0, 0.1)
    true = np.delete(true, [33, 34, 35, 77, 150])
    true = true[(true < 8.0) | (true >= 12.0)]
    found, _ = spread_times(np.floor(true + 1e-9), straight(true))
    assert (np.diff(found) > 0.0).all()
    assert np.max(np.abs(found - true)) < 0.5
    assert np.max(np.diff(found)) == pytest.approx(4.1, abs=0.1)


def test_stamps_that_are_not_rounded_stay() -> None:
    time = np.arange(100.0)
    for stamps in (time, np.delete(np.sort(np.r_[time, 7.0, 8.0, 50.0]), 3), time[:1], time[:0]):
        found, moved = spread_times(stamps, straight(stamps))
        np.testing.assert_array_equal(found, stamps)
        assert not moved.any()


def test_points_recorded_twice_stay() -> None:
    time = np.repeat(np.arange(50.0), 2)
    found, moved = spread_times(time, straight(time))
    np.testing.assert_array_equal(found, time)
    assert not moved.any()
    nearby = straight(time) + np.tile([[0.0, 0.0], [1.0, 0.0]], (50, 1))  # two receivers 1 m apart
    assert not spread_times(time, nearby)[1].any()


def test_standing_still_stays() -> None:
    time = np.repeat(np.arange(10.0), 5)
    assert not spread_times(time, np.zeros((50, 2)))[1].any()


@pytest.mark.filterwarnings("error")
def test_places_known_only_between_stamps_say_nothing() -> None:
    time, place = np.repeat(np.arange(6.0), 4), np.full((24, 2), np.nan)
    place[[3, 4]] = [[0.0, 0.0], [1.0, 0.0]]  # the only step that is known begins a stamp
    assert not spread_times(time, place)[1].any()
