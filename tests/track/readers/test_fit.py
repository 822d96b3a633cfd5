"""Tracks from FIT, of files packed by hand."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from .. import metres_per_degree
from .receivers import FIT_EPOCH, TIMER_START, TIMER_STOP, fit_file
from .test_table import read, refused

BEGIN = int(datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC).timestamp()) - FIT_EPOCH
LAT, LON = round(47.0 / 180 * 2**31), round(11.0 / 180 * 2**31)
RECORDS = [
    {"timestamp": BEGIN, "position_lat": LAT, "position_long": LON, "altitude": (1500 + 500) * 5, "speed": 7250},
    {"timestamp": BEGIN + 1, "speed": 0, "distance": 725},
    {"timestamp": BEGIN + 3, "position_lat": LAT + 1000, "position_long": LON, "distance": 2175},
]


def test_records(tmp_path: Path) -> None:
    """Semicircles of 180/2³¹ degrees, heights (h + 500) × 5, speeds in mm/s, distances in cm."""
    for name in ("a.fit", "a.FIT", "download"):
        track = read(tmp_path, fit_file(RECORDS), name)
        assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
        np.testing.assert_array_equal(track.time, [0.0, 1.0, 3.0])
        np.testing.assert_array_equal(track.speed, [7.25, 0.0, np.nan])
        np.testing.assert_array_equal(track.odometer, [np.nan, 7.25, 21.75])
        north = 1000 * 180 / 2**31 * metres_per_degree.north(47.0) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place[2, :2], [0.0, north], atol=1e-5)
        assert track.origin is not None
        assert track.origin.height == 1500.0
        assert track.flagged == {"no_fix": 1, "missing_height": 1}


def test_negative_latitudes(tmp_path: Path) -> None:
    track = read(tmp_path, fit_file([RECORDS[0] | {"position_lat": -LAT, "position_long": -LON}]), "a.fit")
    assert track.origin is not None
    assert track.origin.latitude_deg == pytest.approx(-47.0, abs=1e-7)
    assert track.origin.longitude_deg == pytest.approx(-11.0, abs=1e-7)


def test_records_without_a_date_are_counted(tmp_path: Path) -> None:
    track = read(tmp_path, fit_file([{"speed": 3000}, *RECORDS]), "a.fit")
    assert len(track) == 3
    assert list(track.left_out.values()) == [1]


def test_accuracy_in_whole_metres(tmp_path: Path) -> None:
    """Horizontal, half of the variance to the east and to the north; 0 and invalid values give nothing."""
    records = [RECORDS[0] | {"gps_accuracy": 3}, RECORDS[1] | {"gps_accuracy": 0}, RECORDS[2]]
    track = read(tmp_path, fit_file(records), "a.fit")
    each = 3.0 / np.sqrt(2.0)
    assert track.place_sd is not None
    np.testing.assert_allclose(track.place_sd, [[each, each, np.nan], [np.nan] * 3, [np.nan] * 3], rtol=1e-12)
    assert read(tmp_path, fit_file(RECORDS), "b.fit").place_sd is None


def test_refused(tmp_path: Path) -> None:
    whole = fit_file(RECORDS)
    assert "2 records" in refused(tmp_path, whole[:-10], "a.fit")
    assert "unreadable_file" in refused(tmp_path, whole[:9], "a.fit")
    assert "CRC" in refused(tmp_path, whole[:-30] + b"\x01" + whole[-29:], "a.fit")
    assert "empty_file" in refused(tmp_path, fit_file([]), "a.fit")
    assert "time_backwards" in refused(tmp_path, fit_file(RECORDS[::-1]), "a.fit")
    assert "no_place" in refused(tmp_path, fit_file(RECORDS[1:2]), "a.fit")


def shifted(seconds: int) -> list[dict[str, int]]:
    return [record | {"timestamp": record["timestamp"] + seconds} for record in RECORDS]


@pytest.mark.parametrize("extra", [b"\xff" * 64, b"\x00" * 7, b"\x0e.FIT", b"\r\n", b"a note .FIT of the device"])
def test_bytes_after_the_end(tmp_path: Path, extra: bytes) -> None:
    track = read(tmp_path, fit_file(RECORDS) + extra, "a.fit")
    assert len(track) == 3
    assert len(track.notes) == 1
    assert str(len(extra)) in track.notes[0]
    assert read(tmp_path, fit_file(RECORDS), "b.fit").notes == ()


@pytest.mark.parametrize("between", [b"", b"\xff" * 16])
def test_two_files_one_after_the_other(tmp_path: Path, between: bytes) -> None:
    track = read(tmp_path, fit_file(RECORDS) + between + fit_file(shifted(100)) + between, "a.fit")
    np.testing.assert_array_equal(track.time, [0.0, 1.0, 3.0, 100.0, 101.0, 103.0])
    assert track.flags["new_segment"].tolist() == [False, False, False, True, False, False]


def test_second_file_that_is_damaged(tmp_path: Path) -> None:
    whole = fit_file(RECORDS)
    assert "unreadable_file" in refused(tmp_path, whole + whole[:-10], "a.fit")


def test_pause_of_the_device_begins_a_segment(tmp_path: Path) -> None:
    track = read(tmp_path, fit_file(RECORDS, then=[TIMER_STOP, TIMER_START], more=shifted(60)), "a.fit")
    assert track.flags["new_segment"].tolist() == [False, False, False, True, False, False]
    lap = read(tmp_path, fit_file(RECORDS, then=[TIMER_START], more=shifted(60)), "b.fit")
    assert not lap.flags["new_segment"].any()


def test_points_without_a_place_at_the_ends(tmp_path: Path) -> None:
    nowhere = [{"timestamp": BEGIN - 60 + second} for second in range(60)]
    track = read(tmp_path, fit_file([*nowhere, *RECORDS, {"timestamp": BEGIN + 9}]), "a.fit")
    assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
    assert list(track.left_out.values()) == [60, 1]
    np.testing.assert_array_equal(track.time, [0.0, 1.0, 3.0])
