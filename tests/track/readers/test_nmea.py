"""Tracks from NMEA sentences."""

from datetime import UTC, date, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.track.summary import track_summary
from tests.present import present

from .. import metres_per_degree
from .receivers import nav_pvt, sentence, ubx_frame
from .test_table import read, refused


def gga(time: str = "155114.00", lat: str = "4714.0740680", quality: int = 4, height: str = "1452.3,M,47.9,M") -> bytes:
    return sentence(f"GNGGA,{time},{lat},N,01107.4074020,E,{quality},12,0.6,{height},,")


def rmc(
    time: str = "155114.00", speed: str = "10.0", course: str = "30.0", date: str = "271222", ok: str = "A"
) -> bytes:
    return sentence(f"GNRMC,{time},{ok},4714.0740680,N,01107.4074020,E,{speed},{course},{date},,,A")


def test_the_classic_sentence(tmp_path: Path) -> None:
    """The example found in every description of NMEA, with its own checksum 47: 48°07.038' N, 11°31.000' E."""
    track = read(tmp_path, b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n", "a.nmea")
    assert track.origin is not None
    assert track.origin.latitude_deg == pytest.approx(48 + 7.038 / 60, abs=1e-9)
    assert track.origin.longitude_deg == pytest.approx(11 + 31 / 60, abs=1e-9)
    assert track.origin.height == pytest.approx(545.4 + 46.9)
    assert track.start is None
    assert track.time_scale == "UTC"


def test_one_point_of_all_sentences_of_a_time(tmp_path: Path) -> None:
    data = (
        rmc()
        + sentence("GNVTG,30.0,T,,M,10.0,N,18.52,K,A")
        + gga()
        + sentence("GNGST,155114.00,5.0,0.04,0.02,45.0,0.011,0.022,0.033")
        + rmc("155114.20", "10.0", "120.0")
        + gga("155114.20", lat="4714.0800680")
    )
    for name in ("a.nmea", "teraterm.log"):
        track = read(tmp_path, data, name)
        assert len(track) == 2
        assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
        np.testing.assert_allclose(track.time, [0.0, 0.2], atol=1e-9)
        north = 0.006 / 60 * metres_per_degree.north(47.23) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place[1], [0.0, north, 0.0], atol=5e-5)
        np.testing.assert_allclose(track.speed, [10 * 1852 / 3600] * 2, rtol=1e-12)
        half, most = 0.5 * track.speed[0], np.sqrt(0.75) * track.speed[0]
        np.testing.assert_allclose(present(track.velocity)[:, :2], [[half, most], [most, -half]], atol=1e-5)
        assert np.isnan(present(track.velocity)[:, 2]).all()
        np.testing.assert_array_equal(present(track.place_sd), [[0.022, 0.011, 0.033], [np.nan] * 3])


def test_speed_of_vtg_in_km_per_h(tmp_path: Path) -> None:
    track = read(tmp_path, gga() + sentence("GNVTG,90.0,T,,M,,N,36.0,K,A"), "a.nmea")
    assert track.speed[0] == pytest.approx(10.0)
    np.testing.assert_allclose(present(track.velocity)[0, :2], [10.0, 0.0], atol=1e-12)


def test_south_and_west(tmp_path: Path) -> None:
    track = read(tmp_path, sentence("GPGGA,120000,3330.0,S,07030.0,W,1,8,1.0,100.0,M,,M,,"), "a.nmea")
    assert (present(track.origin).latitude_deg, present(track.origin).longitude_deg) == (-33.5, -70.5)
    assert "mean sea level" in track.frame


def test_over_midnight(tmp_path: Path) -> None:
    data = rmc("235959.50", date="311222") + gga("000000.25") + rmc("000001.00", date="010123")
    track = read(tmp_path, data, "a.nmea")
    np.testing.assert_allclose(track.time, [0.0, 0.75, 1.5], atol=1e-9)
    assert track.start == datetime(2022, 12, 31, 23, 59, 59, 500000, tzinfo=UTC)


def test_a_leap_second_breaks_no_track(tmp_path: Path) -> None:
    """A sentence of it is left out; other formats give it the time of the second that follows."""
    data = b"".join(gga(time) for time in ("235959.00", "235960.00", "000000.00"))
    assert read(tmp_path, data, "a.nmea").time.tolist() == [0.0, 1.0]
    times = "2016-12-31T23:59:59.5Z", "2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z"
    table = "".join(f"{time},46,7\n" for time in times)
    points = "".join(f'<trkpt lat="46" lon="7"><time>{time}</time></trkpt>' for time in times)
    for content in (f"time,lat,lon\n{table}", f"<gpx><trk><trkseg>{points}</trkseg></trk></gpx>"):
        assert read(tmp_path, content, "a.track").time.tolist() == [0.0, 0.5, 0.5]


def test_date_of_zda_comes_later(tmp_path: Path) -> None:
    data = gga("235959.00") + gga("000000.00") + sentence("GNZDA,000000.00,01,01,2023,00,00")
    assert read(tmp_path, data, "a.nmea").start == datetime(2022, 12, 31, 23, 59, 59, tzinfo=UTC)


def test_quality_of_gga_is_the_solution(tmp_path: Path) -> None:
    """Quality 4 is RTK with whole cycles, 5 float, 1 and 2 by the code, 6 dead reckoning."""
    track = read(tmp_path, b"".join(gga(f"15511{i}.00", quality=i) for i in (1, 2, 4, 5, 6)), "a.nmea")
    assert present(track.solution).tolist() == ["code", "code", "fixed", "float", ""]
    assert track.flagged == {"float_solution": 1, "code_solution": 2}
    assert read(tmp_path, gga(quality=1), "b.nmea").flagged == {}


def test_carrier_phase_of_gns(tmp_path: Path) -> None:
    """A letter for each system; of several the least exact."""
    lines = [
        sentence(f"GNGNS,15511{i}.00,4714.0,N,01107.4,E,{modes},12,0.6,1452.3,47.9,,")
        for i, modes in enumerate(("RR", "RF", "RA", "AN", "NN", "DD"))
    ]
    track = read(tmp_path, b"".join(lines), "a.nmea")
    assert present(track.solution).tolist() == ["fixed", "float", "code", "code", "", "code"]


def test_no_fix(tmp_path: Path) -> None:
    empty = sentence("GNGGA,155113.00,,,,,0,00,99.99,,,,,,")
    before = empty + rmc("155113.00", "", "", ok="V")
    track = read(tmp_path, before + gga() + rmc("155115.00", ok="V") + gga("155116.00"), "a.nmea")
    assert track.usable.tolist() == [True, False, True]
    assert track.flagged == {"no_fix": 1}
    assert list(track.left_out.values()) == [1]


def test_the_same_time_twice(tmp_path: Path) -> None:
    track = read(tmp_path, gga() + rmc() + gga() + rmc() + gga("155115.00"), "a.nmea")
    assert len(track) == 3
    assert track.flagged == {"repeated_time": 1}


def test_damaged_sentences_are_counted(tmp_path: Path) -> None:
    wrong = gga("155115.00").replace(b"1452.3", b"9452.3")
    silent = sentence("GNGGA,,,,,,0,00,99.99,,,,,,")
    track = read(tmp_path, gga() + wrong + silent + b"$GNGGA,155116.00,47\r\nlogger says hello\r\n", "a.nmea")
    assert len(track) == 1
    assert list(track.left_out.values()) == [1, 1, 1]


def test_refused(tmp_path: Path) -> None:
    assert "wrong checksum" in refused(tmp_path, gga().replace(b"47.9", b"47.8"), "a.nmea")
    message = refused(tmp_path, gga() + gga("155113.80"), "a.nmea")
    assert "time_backwards" in message and "row 2" in message
    assert "no_place" in refused(tmp_path, sentence("GNGGA,155113.00,,,,,0,00,99.99,,,,,,"), "a.nmea")
    assert "out_of_range" in refused(tmp_path, gga(lat="9914.0740680"), "a.nmea")


@pytest.mark.parametrize("digits", ["9" * 400, "9" * 5000, "1e400"])
@pytest.mark.parametrize("place", [6, 7, 8, 9, 11])
def test_numbers_beyond_all_numbers(tmp_path: Path, digits: str, place: int) -> None:
    cells = gga().decode().split("*")[0][1:].split(",")
    cells[place] = digits
    content = gga() + sentence(",".join(cells)) + gga("155115.00")
    assert len(read(tmp_path, content, "a.nmea")) in (2, 3)


@pytest.mark.parametrize("year", ["0001", "9999", "9" * 400])
def test_dates_beyond_the_calendar(tmp_path: Path, year: str) -> None:
    content = gga("235959.00") + gga("000001.00") + sentence(f"GPZDA,000001.00,01,01,{year},00,00")
    track = read(tmp_path, content, "a.nmea")
    assert track.start is None
    assert track.time.tolist() == [0.0, 2.0]


SECONDS = [f"15511{second}.00" for second in range(8)]


def both(times: list[str]) -> list[bytes]:
    """GGA and RMC of each time."""
    return [one for at in times for one in (gga(at), rmc(at))]


def gns(at: str, talker: str = "GN", place: str = "4714.0740680,N,01107.4074020,E,AA") -> bytes:
    return sentence(f"{talker}GNS,{at},{place},12,0.6,1452.3,47.9,,")


def gll(at: str, status: str = "A") -> bytes:
    return sentence(f"GNGLL,4714.0740680,N,01107.4074020,E,{at},{status},A")


@pytest.mark.parametrize("end", [b"\r\n", b"\n", b"\r", b"", b" ", b"\r\r\n", b"\n\n", b"\x85", b"\x00\xff"])
@pytest.mark.parametrize("begin", [b"", b"\xef\xbb\xbf", b"12:00:01.5 > "])
def test_any_line_end(tmp_path: Path, end: bytes, begin: bytes) -> None:
    lines = [begin + line.rstrip() for line in both(SECONDS)]
    track = read(tmp_path, end.join(lines) + end, "a.nmea")
    assert (len(track), track.left_out) == (8, {})
    assert np.isfinite(track.speed).all()


def test_utf_16_as_a_shell_writes_it(tmp_path: Path) -> None:
    text = b"".join(both(SECONDS)).decode("ascii")
    assert len(read(tmp_path, text.encode("utf-16"), "a.log")) == 8


def test_row_of_a_message_with_carriage_returns(tmp_path: Path) -> None:
    lines = [line.rstrip() for line in (gga("155114.00"), gga("155115.00"), gga("155113.00"))]
    assert "a.nmea, row 3" in refused(tmp_path, b"\r".join(lines), "a.nmea")


def test_without_checksums_and_checksum_that_others_have_is_required(tmp_path: Path) -> None:
    bare = [line.split(b"*")[0] + b"\r\n" for line in both(SECONDS)]
    track = read(tmp_path, b"".join(bare), "a.nmea")
    assert (len(track), track.left_out) == (8, {})
    assert track.place[0].tolist() == pytest.approx([0.0, 0.0, 0.0])
    # A sentence without one may be cut: of 1452.3 m a cut leaves 1 m.
    cut = gga("155115.00").split(b"1452.3")[0] + b"1\r\n"
    track = read(tmp_path, gga() + cut + gga("155116.00"), "a.nmea")
    assert len(track) == 2
    assert list(track.left_out.values()) == [1]


@pytest.mark.parametrize("talker", ["GP", "GL", "GA", "GB", "BD", "QZ", "GQ", "IN", "II", "GI"])
def test_any_talker(tmp_path: Path, talker: str) -> None:
    plain = read(tmp_path, b"".join(both(SECONDS)), "a.nmea")
    content = [sentence(talker + line.decode().split("*")[0][3:]) for line in both(SECONDS)]
    track = read(tmp_path, b"".join(content), "b.nmea")
    np.testing.assert_array_equal(track.place, plain.place)
    np.testing.assert_array_equal(track.speed, plain.speed)


@pytest.mark.parametrize("first", ["GPGNS", "GNGNS"])
def test_talkers_of_one_time_make_one_point(tmp_path: Path, first: str) -> None:
    lines = []
    for at in SECONDS:
        group = [gns(at), gns(at, "GP", ",,,,"), gns(at, "GL", ",,,,"), rmc(at)]
        lines += group if first == "GNGNS" else [group[1], group[0], *group[2:]]
    track = read(tmp_path, b"".join(lines), "a.nmea")
    assert (len(track), track.flagged, track.left_out) == (8, {}, {})
    assert track_summary(track).max_speed == pytest.approx(10.0 * 1852.0 / 3600.0)


def test_second_place_of_a_time_is_counted(tmp_path: Path) -> None:
    other = [sentence("GL" + gga(at).decode().split("*")[0][3:]) for at in SECONDS]
    data = b"".join(one + two for one, two in zip([gga(at) for at in SECONDS], other, strict=True))
    track = read(tmp_path, data, "a.nmea")
    assert (len(track), list(track.left_out.values())) == (8, [8])


def test_position_alone(tmp_path: Path) -> None:
    track = read(tmp_path, b"".join(gll(at) for at in SECONDS) + gll("155118.00", "V") + gll("155119.00"), "a.nmea")
    assert len(track) == 10
    assert track.flagged == {"no_fix": 1, "missing_height": 9}


def test_place_of_gga_comes_before_that_of_gll(tmp_path: Path) -> None:
    data = b"".join(gll(at) + gga(at, lat="4714.1000000") for at in SECONDS)
    other = read(tmp_path, b"".join(gga(at, lat="4714.1000000") for at in SECONDS), "b.nmea")
    track = read(tmp_path, data, "a.nmea")
    assert track.origin == other.origin
    assert track.flagged == {}


@pytest.mark.parametrize("every", [2, 5, 10])
def test_speeds_less_often_than_places(tmp_path: Path, every: int) -> None:
    """10 places a second; speeds every second are interpolated, the distance is theirs."""
    times = [f"1551{10 + k // 10}.{k % 10}0" for k in range(101)]
    lines = [gga(at) + (rmc(at, speed=f"{0.02 * k:.3f}") if k % every == 0 else b"") for k, at in enumerate(times)]
    found = track_summary(read(tmp_path, b"".join(lines), "a.nmea"))
    knot = 1852.0 / 3600.0
    assert found.max_speed == pytest.approx(2.0 * knot)
    assert found.distances["recorded speed"] == pytest.approx(0.5 * 2.0 * knot * 10.0, rel=1e-6)


def test_course_over_ground_at_its_own_rate(tmp_path: Path) -> None:
    vtg = sentence("GNVTG,90.0,T,,M,,N,36.0,K,A")
    track = read(tmp_path, vtg + b"".join(gga(at) + (vtg if n % 2 == 0 else b"") for n, at in enumerate(SECONDS)), "a")
    assert np.isfinite(track.speed).tolist() == [True, False] * 4
    assert list(track.left_out.values()) == [1]


def test_late_accuracy_belongs_to_its_time(tmp_path: Path) -> None:
    gst = [sentence(f"GNGST,{at},5.0,0.04,0.02,45.0,0.011,0.022,0.033") for at in SECONDS]
    data = gga(SECONDS[0]) + b"".join(gga(SECONDS[n + 1]) + gst[n] for n in range(7))
    track = read(tmp_path, data, "a.nmea")
    assert (len(track), track.flagged) == (8, {})
    assert np.isfinite(present(track.place_sd)[:, 0]).tolist() == [True] * 7 + [False]


@pytest.mark.parametrize("wrong", ["050505", "010180", "060180", "311299"])
@pytest.mark.parametrize("place", ["4714.0,N,01107.0,E", "0.000,N,0.000,E", ",,,"])
def test_clock_before_the_first_fix_does_not_count(tmp_path: Path, wrong: str, place: str) -> None:
    """Receivers start with the day of their clock or of their maker, before or after the true one."""
    status = "V" if "4714" in place or place == ",,," else "A"
    early = b"".join(sentence(f"GPRMC,23595{n}.00,{status},{place},0.0,0.0,{wrong},,,") for n in range(5))
    track = read(tmp_path, early + b"".join(both(SECONDS)), "a.nmea")
    assert (len(track), float(track.time[-1])) == (8, 7.0)
    assert track.start == datetime(2022, 12, 27, 15, 51, 10, tzinfo=UTC)
    assert list(track.left_out.values()) == [5]


def test_clock_that_jumps_without_a_fix(tmp_path: Path) -> None:
    lost = sentence("GNRMC,000001.00,V,,,,,,,060180,,,N") + sentence("GNRMC,155113.50,V,,,,,,,271222,,,N")
    lines = both(SECONDS)
    track = read(tmp_path, b"".join([*lines[:8], lost, *lines[8:]]), "a.nmea")
    assert (len(track), track.flagged) == (9, {"no_fix": 1})
    assert list(track.left_out.values()) == [1]
    assert present(track.start).date() == date(2022, 12, 27)


@pytest.mark.parametrize("word", ["nan", "-nan(ind)", "inf", "1.#QNAN", "-1.#IND00"])
def test_cell_that_is_not_finite(tmp_path: Path, word: str) -> None:
    cells = gga("155111.00").decode().split("*")[0][1:].split(",")
    cells[8] = word  # the dilution of precision
    track = read(tmp_path, gga("155110.00") + sentence(",".join(cells)) + gga("155112.00"), "a.nmea")
    assert (len(track), track.flagged, track.left_out) == (3, {"not_finite": 1}, {})
    assert track.usable.all()


def test_sentences_between_frames_without_places_and_frames_with_places_come_before_sentences(tmp_path: Path) -> None:
    """RXM-RAWX, with bytes that are `$` and the mark of NAV-PVT."""
    raw = ubx_frame(b"\x02\x15", b"\xb5\x62\x01\x07" + bytes(range(36, 60)))
    track = read(tmp_path, b"".join(raw + line for line in both(SECONDS)), "a.ubx")
    assert (len(track), track.left_out) == (8, {})
    track = read(tmp_path, nav_pvt(second=1) + b"".join(both(SECONDS)) + nav_pvt(second=2), "a.ubx")
    assert (len(track), list(track.left_out.values())) == (2, [16])
