"""Tracks from UBX, of messages packed by hand."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.track.projection import GeodeticPoint

from . import metres_per_degree
from .receivers import nav_pvt, sentence, ubx_frame
from .test_read_table import read, refused


def test_messages(tmp_path: Path) -> None:
    """Numbers as packed: 1e-7 degrees, mm, mm/s; velocity north, east, down."""
    other = ubx_frame(b"\x01\x35", bytes(20))
    data = nav_pvt() + other + nav_pvt(nano=100_000_123, lat=472345678 + 100)
    for name in ("a.ubx", "a.log"):
        track = read(tmp_path, data, name)
        assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
        assert track.time_scale == "UTC"
        np.testing.assert_allclose(track.time, [0.0, 0.1], atol=1e-6)
        np.testing.assert_allclose(track.speed, [5.0, 5.0], rtol=1e-12)
        assert track.velocity is not None
        np.testing.assert_allclose(track.velocity, [[-4.0, 3.0, -1.2]] * 2, atol=2e-5)
        assert track.origin is not None
        assert track.origin.latitude_deg == pytest.approx(47.2345678, abs=1e-12)
        assert track.origin.longitude_deg == pytest.approx(11.1234567, abs=1e-12)
        assert track.origin.height == 1500.123
        north = 1e-5 * metres_per_degree.north(47.2345678) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place[1], [0.0, north, 0.0], atol=2e-5)
        assert track.marked == {}
        assert track.left_out == {}


def test_velocity_about_an_origin_far_away(tmp_path: Path) -> None:
    """Meridians converge by Δλ sin φ: seen from 1° further west, north at the point leans 0.734° to the west."""
    origin = GeodeticPoint(47.2345678, 10.1234567, height=1500.0)
    track = read(tmp_path, nav_pvt(velocity=(5000, 0, 0)), "a.ubx", origin=origin)
    assert track.velocity is not None
    lean = math.degrees(math.atan2(-track.velocity[0, 0], track.velocity[0, 1]))
    assert lean == pytest.approx(math.sin(math.radians(47.2345678)), abs=1e-3)


def test_accuracies(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(accuracies=(50, 80, 30)), "a.ubx")
    assert track.place_sd is not None
    east, north, up = track.place_sd[0]
    assert math.hypot(east, north) == pytest.approx(0.050)
    assert east == north
    assert up == pytest.approx(0.080)
    assert track.speed_sd is not None
    np.testing.assert_allclose(track.speed_sd, [0.030])


def test_negative_fraction_of_a_second(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(second=13, nano=900_000_000) + nav_pvt(second=14, nano=-2000), "a.ubx")
    assert track.time[1] == pytest.approx(0.099998, abs=1e-6)


def test_no_fix(tmp_path: Path) -> None:
    data = nav_pvt(second=1) + nav_pvt(second=2, fix=0) + nav_pvt(second=3, fix_ok=0) + nav_pvt(second=4, fix=5)
    track = read(tmp_path, data, "a.ubx")
    assert track.usable.tolist() == [True, False, False, False]
    assert track.marked == {"no_fix": 3}


def test_time_that_is_not_valid_yet(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(second=50, valid=0b001) + nav_pvt(second=1), "a.ubx")
    assert len(track) == 1
    assert track.left_out == {"messages without a valid time": 1}


@pytest.mark.parametrize("byte", [3, 4, 5, 30, 98])
def test_a_damaged_message_costs_itself_alone(tmp_path: Path, byte: int) -> None:
    """Also where the damage is in the length: the next message is found all the same."""
    middle = bytearray(nav_pvt(second=2))
    middle[byte] ^= 0xFF
    data = nav_pvt(second=1) + bytes(middle) + nav_pvt(second=3) + nav_pvt(second=4)[:50]
    track = read(tmp_path, data, "a.ubx")
    np.testing.assert_array_equal(track.time, [0.0, 2.0])
    assert track.left_out == {"messages with a wrong checksum or cut short": 2}


def test_noise_and_sentences_between(tmp_path: Path) -> None:
    data = b"\xb5noise" + nav_pvt(second=1) + sentence("GNRMC,,V,,,,,,,,,,N") + nav_pvt(second=2)
    assert len(read(tmp_path, data, "a.ubx")) == 2


def test_refused(tmp_path: Path) -> None:
    damaged = bytearray(nav_pvt())
    damaged[-1] ^= 1
    assert "1 messages with a wrong checksum" in refused(tmp_path, bytes(damaged), "a.ubx")
    assert "NAV-PVT" in refused(tmp_path, ubx_frame(b"\x01\x35", bytes(20)), "a.ubx")
    assert "time_backwards: a.ubx, byte 101" in refused(tmp_path, nav_pvt(second=2) + nav_pvt(second=1), "a.ubx")
    assert "no_place" in refused(tmp_path, nav_pvt(fix=0), "a.ubx")
    assert "out_of_range" in refused(tmp_path, nav_pvt(lat=1_000_000_000), "a.ubx")
