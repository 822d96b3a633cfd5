"""Highest speed and length of tracks without speeds: simulated truths, exact paths, and limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.track_intervals import KINDS, Kind, estimates, row, simulated_track

from skisnow.track.path_estimate import PathEstimate, estimate_path
from skisnow.track.summary import summary_dict, track_summary
from skisnow.track.track import Track

from .paths import FloatArray, circle, track

SLOPE = 0.25


def linked_turns(period: float, *, speed: float = 12.0, count: int = 60, rate: float = 1.0) -> FloatArray:
    """Places (n, 3) of turns at constant speed, the heading swinging by 60 degrees, on a slope; without noise."""
    kind = Kind(noise=0.0, rate=rate, duration=(count - 1) / rate)
    fine = np.arange(0.0, kind.duration + 1e-9, 1e-3)
    heading = np.radians(60.0) * np.cos(2.0 * np.pi * fine / period)
    steps = 1e-3 * speed * np.stack([np.sin(heading), np.cos(heading)], axis=1)
    path = np.concatenate([[[0.0, 0.0]], np.cumsum((steps[1:] + steps[:-1]) / 2.0, axis=0)])
    place = path[:: round(1e3 / rate)]
    return np.column_stack([place, -SLOPE * place[:, 1]])


def estimate(place: FloatArray, *, rate: float = 1.0) -> PathEstimate:
    one = np.zeros(len(place), dtype=np.int64)
    found = estimate_path(np.arange(float(len(place))) / rate, place, one, one)
    assert found is not None
    return found


@pytest.mark.parametrize("rate", [1.0, 2.0, 10.0])
@pytest.mark.parametrize("period", [4.0, 5.0, 6.0, 10.0, 17.0])
def test_linked_turns_at_constant_speed(period: float, rate: float) -> None:
    """No maximum at an end, and no length below the polyline's."""
    place = linked_turns(period, rate=rate, count=round(50 * rate))
    found = estimate(place, rate=rate)
    speed = found.max_speed()
    assert speed is not None
    assert speed.value == pytest.approx(12.0, rel=0.03)
    duration = (len(place) - 1) / rate
    assert found.length(with_heights=False).value == pytest.approx(12.0 * duration, rel=5e-3)
    steps = np.diff(place, axis=0)
    assert found.length().value >= float(np.sum(np.linalg.norm(steps, axis=1))) * (1.0 - 1e-6)
    assert found.length().value > found.length(with_heights=False).value


@pytest.mark.parametrize("name", ["constant speed, noise 0.5 m", "varied speed, noise 0.5 m"])
def test_intervals_contain_the_truth(name: str) -> None:
    """A short form of the benchmark: of 16 tracks chance leaves out at most 4 in 999 of 1000 cases."""
    found = estimates(replace(KINDS[name], duration=15.0), range(16))
    assert len(found) == 16
    for truths, intervals in (
        ([each.track.max_speed for each in found], [each.max_speed for each in found]),
        ([each.track.length for each in found], [each.length for each in found]),
    ):
        inside = [low <= truth <= high for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert sum(inside) >= 12
        widths = [(high - low) / truth for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert 0.0 < float(np.median(widths)) < 0.15


@pytest.mark.slow
@pytest.mark.parametrize("name", list(KINDS))
def test_coverage_of_200_tracks(name: str) -> None:
    """Seeds that were not used to design the intervals; at least 90 %, less two binomial standard errors."""
    least = 0.90 - 2.0 * float(np.sqrt(0.90 * 0.10 / 200.0))
    found = estimates(KINDS[name], range(5000, 5200))
    for truths, intervals in (
        ([each.track.max_speed for each in found], [each.max_speed for each in found]),
        ([each.track.length for each in found], [each.length for each in found]),
    ):
        inside = [low <= truth <= high for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert sum(inside) / 200 >= least, row(name, found)
        half = [(high - low) / (2.0 * truth) for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        errors = [value / truth - 1.0 for truth, (value, _, _) in zip(truths, intervals, strict=True)]
        assert float(np.median(half)) < 4.0 * float(np.sqrt(np.mean(np.square(errors)))), row(name, found)


def test_more_noise_is_a_wider_interval() -> None:
    widths = []
    for noise in (0.05, 0.5, 2.0):
        made = simulated_track(Kind(noise=noise, duration=40.0), 3)
        length = estimate(made.place).length()
        widths.append(length.high - length.low)
    assert widths[0] < widths[1] < widths[2]


def test_same_track_gives_the_same_numbers() -> None:
    place = simulated_track(Kind(duration=20.0), 1).place
    assert estimate(place).max_speed() == estimate(place).max_speed()


def test_gap_is_straight_and_a_pause_is_nothing() -> None:
    time = np.arange(40.0)
    place = np.column_stack([10.0 * time, np.zeros(40), np.full(40, np.nan)])
    time[20:] += 60.0
    place[20:, 0] += 600.0
    part = np.repeat([0, 1], 20)
    for segment, expected in ((np.zeros(40, dtype=np.int64), 990.0), (part, 380.0)):
        found = estimate_path(time, place, part.astype(np.int64), segment.astype(np.int64))
        assert found is not None
        assert found.length().value == pytest.approx(expected, rel=1e-3)
        assert found.length(0.0, 19.0).value == pytest.approx(190.0, rel=1e-3)
        assert found.arc_length_at(np.array([99.0]))[0] == pytest.approx(expected, rel=1e-3)


def test_standing_still_is_hardly_a_path() -> None:
    """30 s of noise; its polyline would have more than 25 m."""
    place = np.column_stack([0.7 * np.random.default_rng(5).standard_normal((31, 2)), np.full(31, np.nan)])
    assert float(np.sum(np.hypot(*np.diff(place[:, :2], axis=0).T))) > 25.0
    assert estimate(place).length().value < 5.0


@pytest.mark.parametrize("points", [0, 1, 2, 3, 6])
def test_few_points(points: int) -> None:
    place = np.column_stack([10.0 * np.arange(float(points)), np.zeros(points), np.zeros(points)])
    one = np.zeros(points, dtype=np.int64)
    found = estimate_path(np.arange(float(points)), place, one, one)
    assert (found is None) == (points < 2)


@pytest.mark.parametrize("interval", [0.001, 0.02, 30.0])
def test_any_interval_between_points(interval: float) -> None:
    made: Track = track(circle(15.0, 8.0, duration=400 * interval, interval=interval), interval=interval)
    summary = track_summary(made)
    assert summary.max_speed is not None
    if interval < 1.0:
        assert summary.max_speed == pytest.approx(8.0, rel=0.01)
        assert summary.distances["places"] == pytest.approx(8.0 * 400 * interval, rel=0.01)


def test_recorded_speeds_have_no_interval() -> None:
    made = track(circle(15.0, 8.0), speed=np.full(81, 8.0))
    values = summary_dict(track_summary(made))
    assert values["max_speed_m_per_s"] == 8.0
    assert [key for key, value in values.items() if "interval" in key and value is not None] == []
    places = summary_dict(track_summary(track(circle(15.0, 8.0), noise=0.02)))
    low, high = places["max_speed_interval_m_per_s"]
    assert low < places["max_speed_m_per_s"] < high
    assert places["runs"][0]["max_speed_interval_m_per_s"] is not None
