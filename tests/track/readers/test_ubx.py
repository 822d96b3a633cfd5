"""FIT and UBX files."""

import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.track.projection import GeodeticPoint
from skisnow.track.readers.binary import SYNC
from tests.present import present

from .. import metres_per_degree
from .receivers import FIT_EPOCH, TIMER_START, TIMER_STOP, fit_file, nav_cov, nav_hpposllh, nav_pvt, sentence, ubx_frame
from .test_table import read, refused


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
        np.testing.assert_allclose(present(track.velocity), [[-4.0, 3.0, -1.2]] * 2, atol=2e-5)
        assert track.origin is not None
        assert track.origin.latitude_deg == pytest.approx(47.2345678, abs=1e-12)
        assert track.origin.longitude_deg == pytest.approx(11.1234567, abs=1e-12)
        assert track.origin.height == 1500.123
        north = 1e-5 * metres_per_degree.north(47.2345678) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place[1], [0.0, north, 0.0], atol=2e-5)
        assert track.flagged == {}
        assert track.left_out == {}


def test_velocity_about_an_origin_far_away(tmp_path: Path) -> None:
    """Meridians converge by Δλ sin φ: seen from 1° further west, north at the point leans 0.734° to the west."""
    origin = GeodeticPoint(47.2345678, 10.1234567, height=1500.0)
    track = read(tmp_path, nav_pvt(velocity=(5000, 0, 0)), "a.ubx", origin=origin)
    lean = math.degrees(math.atan2(-present(track.velocity)[0, 0], present(track.velocity)[0, 1]))
    assert lean == pytest.approx(math.sin(math.radians(47.2345678)), abs=1e-3)


def test_accuracies(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(accuracies=(50, 80, 30)), "a.ubx")
    east, north, up = present(track.place_sd)[0]
    assert math.hypot(east, north) == pytest.approx(0.050)
    assert east == north
    assert up == pytest.approx(0.080)
    np.testing.assert_allclose(present(track.speed_sd), [0.030])


def test_high_precision_places(tmp_path: Path) -> None:
    """1e-9 degrees and 0.1 mm are added with their signs; before or behind the NAV-PVT, with equal time of week."""
    precise = nav_hpposllh(), nav_hpposllh(time_of_week=229_892_100, lat=(472345678, 55))
    points = nav_pvt(), nav_pvt(nano=100_000_000, time_of_week=229_892_100)
    later = nav_pvt(nano=200_000_000, time_of_week=229_892_200)
    for data in (points[0] + precise[0] + points[1] + precise[1], precise[0] + points[0] + precise[1] + points[1]):
        track = read(tmp_path, data + later, "a.ubx")
        assert track.origin is not None
        assert track.origin.latitude_deg == pytest.approx(47.234567845, abs=1e-11)
        assert track.origin.longitude_deg == pytest.approx(11.123456633, abs=1e-11)
        assert track.origin.height == pytest.approx(1500.1226, abs=1e-7)
        north = 1e-8 * metres_per_degree.north(47.2345678) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place[1], [0.0, north, 0.0], atol=2e-6)
        assert track.place_sd is not None
        east_north = 0.0123 / math.sqrt(2.0)
        np.testing.assert_allclose(track.place_sd[:2], [[east_north, east_north, 0.0201]] * 2, rtol=1e-12)
        assert track.place_sd[2, 2] == pytest.approx(0.080)  # of the NAV-PVT that has no other message beside it


def test_a_high_precision_place_that_is_not_valid_does_not_count(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt() + nav_hpposllh(invalid=1), "a.ubx")
    assert present(track.origin).height == 1500.123
    invalid = read(tmp_path, nav_pvt() + nav_pvt(second=15, invalid_place=1), "b.ubx")
    assert list(invalid.left_out.values()) == [1]


def test_covariances(tmp_path: Path) -> None:
    """North and east are not mixed up, and of the velocity counts what lies along it: 0.6 north, -0.8 east, no down."""
    place, velocity = (4e-4, 1e-4, 0.0, 9e-4, 0.0, 25e-4), (4e-4, 1e-4, 7e-4, 1e-4, 7e-4, 1.0)
    data = nav_pvt(velocity=(3000, -4000, 0)) + nav_hpposllh() + nav_cov(place, velocity)
    track = read(tmp_path, data, "a.ubx")
    np.testing.assert_allclose(present(track.place_sd), [[0.03, 0.02, 0.05]], rtol=1e-6)  # of 32 bit
    wanted = math.sqrt(0.36 * 4e-4 + 0.64 * 1e-4 - 2.0 * 0.48 * 1e-4)
    assert present(track.speed_sd)[0] == pytest.approx(wanted, rel=1e-6)
    steep = read(tmp_path, nav_pvt(velocity=(3000, 0, 4000)) + nav_cov(place, velocity), "b.ubx")
    assert present(steep.speed_sd)[0] == pytest.approx(math.sqrt(0.36 * 4e-4 + 0.64 + 2.0 * 0.48 * 7e-4), rel=1e-6)


def test_covariances_that_are_not_valid_do_not_count(tmp_path: Path) -> None:
    wide = (1.0, 0.0, 0.0, 1.0, 0.0, 1.0)
    far = read(tmp_path, nav_pvt() + nav_cov((math.inf,) * 6, (math.nan,) * 6), "b.ubx")
    assert (present(far.place_sd)[0, 2], present(far.speed_sd)[0]) == pytest.approx((0.080, 0.030))
    for valid, place_sd, speed_sd in (((0, 1), 0.080, 1.0), ((1, 0), 1.0, 0.030), ((0, 0), 0.080, 0.030)):
        track = read(tmp_path, nav_pvt() + nav_cov(wide, wide, valid=valid), "a.ubx")
        assert present(track.place_sd)[0, 2] == pytest.approx(place_sd)
        assert present(track.speed_sd)[0] == pytest.approx(speed_sd)


def test_carrier_phase(tmp_path: Path) -> None:
    """Bits 6 and 7 of the flags: 0 none, 1 float, 2 fixed."""
    data = b"".join(nav_pvt(second=10 + i, carrier=carrier) for i, carrier in enumerate((2, 1, 0)))
    track = read(tmp_path, data + nav_pvt(second=13, fix=0, carrier=2) + nav_pvt(second=14, carrier=2), "a.ubx")
    assert present(track.solution).tolist() == ["fixed", "float", "code", "", "fixed"]
    assert track.flagged == {"no_fix": 1, "float_solution": 1, "code_solution": 1}
    assert track.usable.tolist() == [True, True, True, False, True]
    assert read(tmp_path, nav_pvt(), "b.ubx").flagged == {}


def test_negative_fraction_of_a_second(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(second=13, nano=900_000_000) + nav_pvt(second=14, nano=-2000), "a.ubx")
    assert track.time[1] == pytest.approx(0.099998, abs=1e-6)


def test_no_fix(tmp_path: Path) -> None:
    data = nav_pvt(second=1) + nav_pvt(second=2, fix=0) + nav_pvt(second=3, fix_ok=0) + nav_pvt(second=4, fix=5)
    data += nav_pvt(second=5)
    track = read(tmp_path, data, "a.ubx")
    assert track.usable.tolist() == [True, False, False, False, True]
    assert track.flagged == {"no_fix": 3}


def test_time_that_is_not_valid_yet(tmp_path: Path) -> None:
    track = read(tmp_path, nav_pvt(second=50, valid=0b001) + nav_pvt(second=1), "a.ubx")
    assert len(track) == 1
    assert list(track.left_out.values()) == [1]


@pytest.mark.parametrize("byte", [3, 4, 5, 30, 98])
def test_a_damaged_message_costs_itself_alone(tmp_path: Path, byte: int) -> None:
    """Also where the damage is in the length: the next message is found all the same."""
    middle = bytearray(nav_pvt(second=2))
    middle[byte] ^= 0xFF
    data = nav_pvt(second=1) + bytes(middle) + nav_pvt(second=3) + nav_pvt(second=4)[:50]
    track = read(tmp_path, data, "a.ubx")
    np.testing.assert_array_equal(track.time, [0.0, 2.0])
    assert list(track.left_out.values()) == [1 if byte == 3 else 2]  # 3: another kind of message


def test_noise_and_sentences_between(tmp_path: Path) -> None:
    data = b"\xb5noise" + nav_pvt(second=1) + sentence("GNRMC,,V,,,,,,,,,,N") + nav_pvt(second=2)
    assert len(read(tmp_path, data, "a.ubx")) == 2


def test_refused(tmp_path: Path) -> None:
    damaged = bytearray(nav_pvt())
    damaged[-1] ^= 1
    assert "wrong checksum" in refused(tmp_path, bytes(damaged), "a.ubx")
    assert "NAV-PVT" in refused(tmp_path, ubx_frame(b"\x01\x35", bytes(20)), "a.ubx")
    assert "time_backwards: a.ubx, byte 101" in refused(tmp_path, nav_pvt(second=2) + nav_pvt(second=1), "a.ubx")
    assert "no_place" in refused(tmp_path, nav_pvt(fix=0), "a.ubx")
    assert "out_of_range" in refused(tmp_path, nav_pvt(lat=1_000_000_000), "a.ubx")


def test_sync_bytes_by_the_thousand_cost_one_pass(tmp_path: Path) -> None:
    content = nav_pvt() + SYNC * 200_000 + nav_pvt(second=15)  # frame by frame this would take many minutes
    track = read(tmp_path, content, "a.ubx")
    assert len(track) == 2


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
        assert present(track.origin).height == 1500.0
        assert track.flagged == {"no_fix": 1, "missing_height": 1}


@pytest.mark.parametrize("plain", [{}, {"altitude": (1500 + 500) * 5, "speed": 7250}])
def test_enhanced_fields(tmp_path: Path, plain: dict[str, int]) -> None:
    """Plain fields next to the enhanced ones are invalid, or state the same."""
    place = {"timestamp": BEGIN, "position_lat": LAT, "position_long": LON}
    record = place | plain | {"enhanced_altitude": (1500 + 500) * 5, "enhanced_speed": 7250}
    track = read(tmp_path, fit_file([record]), "a.fit")
    assert track.speed.tolist() == [7.25]
    assert present(track.origin).height == 1500.0


def test_negative_latitudes(tmp_path: Path) -> None:
    track = read(tmp_path, fit_file([RECORDS[0] | {"position_lat": -LAT, "position_long": -LON}]), "a.fit")
    assert present(track.origin).latitude_deg == pytest.approx(-47.0, abs=1e-7)
    assert present(track.origin).longitude_deg == pytest.approx(-11.0, abs=1e-7)


def test_records_without_a_date_are_counted(tmp_path: Path) -> None:
    track = read(tmp_path, fit_file([{"speed": 3000}, *RECORDS]), "a.fit")
    assert len(track) == 3
    assert list(track.left_out.values()) == [1]


def test_accuracy_in_whole_metres(tmp_path: Path) -> None:
    """Horizontal, half of the variance to the east and to the north; 0 and invalid values give nothing."""
    records = [RECORDS[0] | {"gps_accuracy": 3}, RECORDS[1] | {"gps_accuracy": 0}, RECORDS[2]]
    track = read(tmp_path, fit_file(records), "a.fit")
    each = 3.0 / np.sqrt(2.0)
    np.testing.assert_allclose(present(track.place_sd), [[each, each, np.nan], [np.nan] * 3, [np.nan] * 3], rtol=1e-12)
    assert read(tmp_path, fit_file(RECORDS), "b.fit").place_sd is None


def test_rejected_fit_files(tmp_path: Path) -> None:
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


def test_fit_records_without_a_date_are_counted(tmp_path: Path) -> None:
    record = {name: value for name, value in RECORDS[0].items() if name != "timestamp"}
    assert "1 records without a date" in refused(tmp_path, fit_file([record]), "a.fit")
