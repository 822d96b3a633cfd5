"""What a whole track gives: a real day, a short run, bad input."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.cli.schema import json_schema
from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, half_wavelength, summary_dict, track_summary
from skisnow.track.track import Track
from tests.coded import raises

from .paths import NOISE, circle, track

SCHEMA = json_schema("track")
DAY = Path(__file__).resolve().parents[3] / "shared" / "data" / "ski-track" / "morin_heights_2022-12-27.csv"
DEVICE_DISTANCE, DEVICE_TOP_SPEED = 13731.42, 15.546


@pytest.fixture(scope="module")
def real_day() -> TrackSummary:
    if not DAY.exists():
        pytest.skip("the recorded day is not beside the repository")
    return track_summary(read_track(DAY))


def checked(summary: TrackSummary) -> dict[str, Any]:
    values = summary_dict(summary)
    text = json.dumps(values, allow_nan=False)
    jsonschema.validate(json.loads(text), SCHEMA)
    return values


def test_recorded_day_has_the_devices_distance_and_top_speed(real_day: TrackSummary) -> None:
    values = checked(real_day)
    assert values["points"] == 5898
    assert values["distance_m"] == pytest.approx(DEVICE_DISTANCE, rel=0.01)
    assert values["max_speed_m_per_s"] == pytest.approx(DEVICE_TOP_SPEED, abs=1e-3)
    assert sum(values["marked"].values()) >= 13  # repeated time stamps


def test_points_by_carrier_phase_are_counted() -> None:
    one = track(circle(12.0, 9.0))
    assert checked(track_summary(one))["solutions"] is None
    mixed = np.where(np.arange(len(one)) < 3, "float", "fixed")
    assert checked(track_summary(replace(one, solution=mixed)))["solutions"] == {"fixed": len(one) - 3, "float": 3}
    assert checked(track_summary(replace(one, solution=np.full(len(one), "code"))))["solutions"] is None


def test_recorded_day_has_nine_lifts_and_nine_runs(real_day: TrackSummary) -> None:
    """The heights show nine ascents from 306 to 436 m and as many descents; the last ends on the way, at 317 m."""
    values = checked(real_day)
    assert len(values["runs"]) == len(values["lifts"]) == 9
    for lift, run in zip(values["lifts"], values["runs"], strict=True):
        assert lift["end_s"] <= run["start_s"] < run["end_s"]
        assert 110.0 < run["descent_m"] < 135.0
        assert 600.0 < run["distance_m"] < 1100.0
        assert 8.0 < run["max_speed_m_per_s"] <= 15.546
        assert lift["max_speed_m_per_s"] < 3.0
    assert max(run["max_speed_m_per_s"] for run in values["runs"]) == values["max_speed_m_per_s"]
    for turn in values["turns"]:
        assert any(run["start_s"] <= turn["start_s"] < turn["end_s"] <= run["end_s"] for run in values["runs"])


def test_places_tell_the_days_distance_too(real_day: TrackSummary) -> None:
    """An independent way; 1 Hz is too coarse for much better, and places wander in queues."""
    assert real_day.distances["places"] == pytest.approx(DEVICE_DISTANCE, rel=0.03)
    assert any("recorded speed" in remark for remark in real_day.remarks)  # 10 % less: it lags


def test_short_local_track() -> None:
    made = track(circle(15.0, 8.0, duration=5.0), noise=NOISE)
    values = checked(track_summary(made))
    (run,) = values["runs"]
    assert (run["start_s"], run["end_s"], run["descent_m"]) == (0.0, 5.0, None)
    assert values["distance_m"] == pytest.approx(40.0, rel=0.01)
    assert values["distance_source"] == "places"
    (turn,) = values["turns"]
    assert turn["direction"] == "left"
    assert (turn["start_s"], turn["end_s"]) == pytest.approx((0.0, 5.0), abs=0.4)  # the ends are the least sure
    angle = np.degrees(8.0 * (turn["end_s"] - turn["start_s"]) / 15.0)
    assert turn["turned_angle_deg"] == pytest.approx(angle, abs=4.0 * turn["turned_angle_sd_deg"])
    assert turn["turned_angle_sd_deg"] < 2.5
    low, high = turn["least_radius_interval_m"]
    assert low < turn["least_radius_m"] < high
    assert turn["least_radius_m"] == pytest.approx(15.0, rel=0.15)  # the largest of 40 noisy curvatures, 5 % each


def test_wavelength_is_speed_times_period() -> None:
    summary = track_summary(track(circle(15.0, 8.0)))
    assert half_wavelength(summary) == pytest.approx(8.0 * summary.motion.smoothed.resolution.half_period, rel=2e-3)


def test_track_at_rest_has_nothing_but_nulls_and_zeros() -> None:
    values = checked(track_summary(track(np.zeros((60, 2)))))
    assert values["runs"] == values["turns"] == []
    assert values["distance_m"] == pytest.approx(0.0, abs=1e-6)
    assert values["smoothing"]["half_amplitude_wavelength_m"] is None


def test_gap_is_said() -> None:
    made = track(circle(15.0, 8.0))
    made.time[40:] += 20.0
    summary = track_summary(made)
    assert any(remark.startswith("1 gap") for remark in summary.remarks)
    assert np.isfinite(summary.motion.curvature).all()


@pytest.mark.slow
def test_million_points_fit() -> None:
    """Seconds and some hundred MB; nothing is timed here, but a loop over points or a full matrix would not end."""
    made = track(circle(15.0, 8.0, duration=20_000.0, interval=0.1), noise=NOISE)
    assert len(made) == 200_001
    values = checked(track_summary(made))
    assert values["distance_m"] == pytest.approx(160_000.0, rel=3e-3)


@pytest.mark.parametrize("points", [0, 1, 5])
def test_too_few_points(points: int) -> None:
    made: Track = track(circle(15.0, 8.0))
    keep = slice(0, points)
    few = replace(made, time=made.time[keep], place=made.place[keep], speed=made.speed[keep])
    with raises(ParameterError, "too_few_points", name="made", count=points):
        track_summary(few)


def test_window_without_points() -> None:
    with raises(ParameterError, "too_few_points", window=0.2):
        track_summary(track(circle(15.0, 8.0)), window=0.2)
