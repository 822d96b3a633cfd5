"""Tracks from FIT, of files packed by hand."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from .. import metres_per_degree
from .receivers import FIT_EPOCH, fit_file
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
    assert track.left_out == {"records without a date": 1}


def test_accuracy_in_whole_metres(tmp_path: Path) -> None:
    """Horizontal, half of the variance to the east and to the north; 0 and what is invalid say nothing."""
    records = [RECORDS[0] | {"gps_accuracy": 3}, RECORDS[1] | {"gps_accuracy": 0}, RECORDS[2]]
    track = read(tmp_path, fit_file(records), "a.fit")
    each = 3.0 / np.sqrt(2.0)
    assert track.place_sd is not None
    np.testing.assert_allclose(track.place_sd, [[each, each, np.nan], [np.nan] * 3, [np.nan] * 3], rtol=1e-12)
    assert read(tmp_path, fit_file(RECORDS), "b.fit").place_sd is None


def test_refused(tmp_path: Path) -> None:
    whole = fit_file(RECORDS)
    assert "ends too early, after 2 records" in refused(tmp_path, whole[:-10], "a.fit")
    assert "unreadable_file" in refused(tmp_path, whole[:9], "a.fit")
    assert "CRC" in refused(tmp_path, whole[:-30] + b"\x01" + whole[-29:], "a.fit")
    assert "empty_file" in refused(tmp_path, fit_file([]), "a.fit")
    assert "time_backwards: a.fit, record 2" in refused(tmp_path, fit_file(RECORDS[::-1]), "a.fit")
    assert "no_place" in refused(tmp_path, fit_file(RECORDS[1:2]), "a.fit")
