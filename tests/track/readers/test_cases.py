"""Recorded files that failed in the past, with the right answer of each; they are not part of the repository."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, track_summary
from skisnow.track.track import Track

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "track"
BEGIN = datetime(2024, 2, 10, 10, tzinfo=UTC)


def case(name: str) -> Track:
    if not (CASES / name).exists():
        pytest.skip("the recorded files are not next to the repository")
    return read_track(CASES / name)


def summary(name: str) -> TrackSummary:
    return track_summary(case(name))


def test_speeds_at_every_tenth_point() -> None:
    found = summary("gga-10hz-rmc-1hz.nmea")
    assert found.distances["recorded speed"] == pytest.approx(299.0, abs=0.1)
    assert found.max_speed == pytest.approx(10.0, abs=0.05)


@pytest.mark.parametrize("name", ["gns.nmea", "no-checksums.nmea", "rawx_first.ubx", "date-2005-before-fix.nmea"])
def test_same_path_however_it_is_written(name: str) -> None:
    """All have a point each second; the path is that of the two sentences in half seconds, at half the speed."""
    track, twice_as_fast = case(name), case("joined-lines.nmea")
    assert (len(track), track.start) == (100, BEGIN)
    np.testing.assert_allclose(track.time, np.arange(100.0), atol=1e-6)
    np.testing.assert_allclose(track.place[:, :2], twice_as_fast.place[:, :2], atol=1e-3)
    assert np.isfinite(track.speed).all()


@pytest.mark.parametrize("name", ["joined-lines.nmea", "cr-only.nmea"])
def test_every_sentence_is_read(name: str) -> None:
    track = case(name)
    assert (len(track), track.start, track.left_out) == (100, BEGIN, {})
    assert np.isfinite(track.speed).all()


def test_only_points_with_a_fix_count() -> None:
    found = summary("no-fix-start.nmea")
    assert (len(found.track), float(found.track.time[-1]), found.track.start) == (60, 59.0, BEGIN)
    assert found.distances["recorded speed"] == pytest.approx(590.0, abs=0.1)
    assert sum(found.track.left_out.values()) == 60


@pytest.mark.parametrize(("name", "begins"), [("segments.gpx", 3600.0), ("segments_short.gpx", 125.0)])
def test_segments_are_not_joined(name: str, begins: float) -> None:
    found = summary(name)
    assert [(run.start, run.end) for run in found.day.runs] == [(0.0, 120.0), (begins, begins + 120.0)]
    assert [run.last - run.first + 1 for run in found.day.runs] == [121, 121]
    assert [run.distance for run in found.day.runs] == pytest.approx([1236.0, 1236.0], rel=3e-3)
    assert found.distances["places"] == pytest.approx(2 * 1236.0, rel=3e-3)
    assert found.day.lifts == ()


def test_bytes_after_the_end_of_a_fit_file() -> None:
    track = case("trailing_ff.fit")
    assert len(track) == 22
    assert len(track.notes) == 1


def test_serial_numbers_of_a_spreadsheet() -> None:
    track = case("excel_serial.csv")
    assert track.start == BEGIN.replace(tzinfo=None)
    np.testing.assert_allclose(np.diff(track.time), 1.0, atol=2e-3)
    assert len(track.notes) == 1


def test_headings_in_capitals() -> None:
    capitals = case("Caps.csv")
    assert (len(capitals), capitals.start) == (120, BEGIN)
    np.testing.assert_allclose(capitals.place[:, 2] - capitals.place[0, 2], -2.5 * np.arange(120.0), atol=0.2)


def test_whole_seconds_at_25_points_a_second() -> None:
    found = summary("dup25.gpx")
    np.testing.assert_allclose(np.diff(found.track.time), 0.04, atol=1e-9)
    assert found.max_speed == pytest.approx(10.0, abs=0.1)


@pytest.mark.parametrize("name", ["turns_T10_1hz.gpx", "turns_T4_1hz.gpx"])
def test_highest_speed_and_length_of_linked_turns(name: str) -> None:
    found = summary(name)
    assert found.max_speed == pytest.approx(12.0, rel=0.03)
    assert found.max_speed is not None
    assert found.max_speed_interval is not None
    assert found.max_speed_interval[0] < found.max_speed < found.max_speed_interval[1]
    assert found.horizontal_distance is not None
    steps = np.diff(found.track.place, axis=0)
    assert found.distances["places"] >= float(np.sum(np.linalg.norm(steps, axis=1)))
    assert found.horizontal_distance.value >= float(np.sum(np.hypot(steps[:, 0], steps[:, 1])))
    assert found.horizontal_distance.value == pytest.approx(12.0 * 119.0, rel=3e-3)


@pytest.mark.parametrize("name", ["nan_ind.pos", "inf_ratio.pos"])
def test_columns_that_are_not_used_may_be_not_finite(name: str) -> None:
    track = case(name)
    assert (len(track), track.flagged) == (200, {"not_finite": 1})
    assert track.usable.all()
