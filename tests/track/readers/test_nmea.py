"""Tracks from NMEA sentences."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from .. import metres_per_degree
from .receivers import sentence
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
        assert track.velocity is not None
        half, most = 0.5 * track.speed[0], np.sqrt(0.75) * track.speed[0]
        np.testing.assert_allclose(track.velocity[:, :2], [[half, most], [most, -half]], atol=1e-5)
        assert np.isnan(track.velocity[:, 2]).all()
        assert track.place_sd is not None
        np.testing.assert_array_equal(track.place_sd, [[0.022, 0.011, 0.033], [np.nan] * 3])


def test_speed_of_vtg_in_km_per_h(tmp_path: Path) -> None:
    track = read(tmp_path, gga() + sentence("GNVTG,90.0,T,,M,,N,36.0,K,A"), "a.nmea")
    assert track.speed[0] == pytest.approx(10.0)
    assert track.velocity is not None
    np.testing.assert_allclose(track.velocity[0, :2], [10.0, 0.0], atol=1e-12)


def test_south_and_west(tmp_path: Path) -> None:
    track = read(tmp_path, sentence("GPGGA,120000,3330.0,S,07030.0,W,1,8,1.0,100.0,M,,M,,"), "a.nmea")
    assert track.origin is not None
    assert (track.origin.latitude_deg, track.origin.longitude_deg) == (-33.5, -70.5)
    assert "mean sea level" in track.frame


def test_over_midnight(tmp_path: Path) -> None:
    data = rmc("235959.50", date="311222") + gga("000000.25") + rmc("000001.00", date="010123")
    track = read(tmp_path, data, "a.nmea")
    np.testing.assert_allclose(track.time, [0.0, 0.75, 1.5], atol=1e-9)
    assert track.start == datetime(2022, 12, 31, 23, 59, 59, 500000, tzinfo=UTC)


def test_date_of_zda_comes_later(tmp_path: Path) -> None:
    data = gga("235959.00") + gga("000000.00") + sentence("GNZDA,000000.00,01,01,2023,00,00")
    assert read(tmp_path, data, "a.nmea").start == datetime(2022, 12, 31, 23, 59, 59, tzinfo=UTC)


def test_carrier_phase_of_gga(tmp_path: Path) -> None:
    """Quality 4 is RTK with whole cycles, 5 float, 1 and 2 by the code, 6 dead reckoning."""
    track = read(tmp_path, b"".join(gga(f"15511{i}.00", quality=i) for i in (1, 2, 4, 5, 6)), "a.nmea")
    assert track.solution is not None
    assert track.solution.tolist() == ["code", "code", "fixed", "float", ""]
    assert track.flagged == {"float_solution": 1, "code_solution": 2}
    assert read(tmp_path, gga(quality=1), "b.nmea").flagged == {}


def test_carrier_phase_of_gns(tmp_path: Path) -> None:
    """A letter for each system; of several the least exact."""
    lines = [
        sentence(f"GNGNS,15511{i}.00,4714.0,N,01107.4,E,{modes},12,0.6,1452.3,47.9,,")
        for i, modes in enumerate(("RR", "RF", "RA", "AN", "NN", "DD"))
    ]
    track = read(tmp_path, b"".join(lines), "a.nmea")
    assert track.solution is not None
    assert track.solution.tolist() == ["fixed", "float", "code", "code", "", "code"]


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
