"""SMET: units, gaps, time zones, and what does not fit."""

import math
import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError, ParameterError
from skisnow.campaign import Problem
from skisnow.campaign.smet import CampaignWeather, WeatherSettings, read_smet

from .conftest import require_sentences

CASES = Path(__file__).parents[2].parent / "shared" / "cases" / "weather"

HEAD = """SMET 1.1 ASCII
[HEADER]
station_id       = WFJ2
station_name     = Weissfluhjoch: snow
latitude         = 46.829
longitude        = 9.809
altitude         = 2540
nodata           = -999
tz               = 1
units_offset     = 0 273.15 0 0
units_multiplier = 1 1 0.01 1
fields           = timestamp TA RH VW
[DATA]
"""
ROWS = """2026-02-03T08:00  -4.0  80   3.5
2026-02-03T09:00  -2.0  -999 4.5   # remark

2026-02-03T14:00  +1.5  60   5.5
"""


def moment(hour: int, minute: int = 0) -> float:
    return datetime(2026, 2, 3, hour, minute, tzinfo=UTC).timestamp()


def refusal(path: Path) -> Problem:
    with pytest.raises(FieldDataError) as refused:
        read_smet(path)
    (problem,) = refused.value.problems
    assert isinstance(problem, Problem)
    assert (problem.code, problem.file, problem.severity) == ("unreadable_file", path.name, "error")
    return require_sentences([problem])[0]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "station.smet"


def test_values_are_si_and_times_utc_and_capitals_do_not_matter_and_a_byte_order_mark_of_utf_16(path: Path) -> None:
    path.write_text(HEAD + ROWS)
    series = read_smet(path)
    assert (series.station, series.altitude, series.utc_offset) == ("Weissfluhjoch: snow", 2540.0, 1.0)
    assert (series.latitude_deg, series.longitude_deg) == (46.829, 9.809)
    assert series.time.tolist() == [moment(7), moment(8), moment(13)]
    np.testing.assert_allclose(series.fields["TA"], [269.15, 271.15, 274.65])
    np.testing.assert_allclose(series.fields["RH"], [0.8, math.nan, 0.6])
    assert "3 rows, 2026-02-03 07:00 to 2026-02-03 13:00 UTC" in repr(series)
    path.write_text(HEAD.replace("timestamp TA RH VW", "Timestamp ta Rh vw") + ROWS)
    assert list(read_smet(path).fields) == ["TA", "RH", "VW"]
    path.write_text(HEAD + ROWS, encoding="utf-16")
    assert list(read_smet(path).fields) == ["TA", "RH", "VW"]


@pytest.mark.parametrize("gap", ["-9999", "-99999.0"])
def test_gaps_of_another_number_than_nodata(path: Path, gap: str) -> None:
    """Single ones pass the check by the median; below 0 is possible for other columns."""
    for row, column in (
        (ROWS.replace("4.5", gap), "VW"),
        (ROWS.replace("+1.5", gap), "TA"),
        (ROWS.replace("60", gap), "RH"),
    ):
        path.write_text(HEAD + row)
        problem = refusal(path)
        assert (problem.row, problem.column) == (8, column)
    path.write_text(HEAD.replace("-999\n", f"{gap}\n").replace("RH", "X") + ROWS.replace("4.5", gap))
    series = read_smet(path)
    assert math.isnan(series.fields["VW"][1])
    assert series.fields["X"][1] == pytest.approx(-9.99)


def test_interpolation_is_linear_and_leaves_gaps_open(path: Path) -> None:
    """Between 8 and 9 o'clock; the five hours after are a gap for three, none for six; nothing outside."""
    path.write_text(HEAD + ROWS)
    series = read_smet(path)
    asked = np.array([moment(7, 15), moment(8), moment(10), moment(13), moment(6), moment(14)])
    nan = math.nan
    np.testing.assert_allclose(series.at(asked, "TA", longest_gap=3 * 3600.0), [269.65, 271.15, nan, 274.65, nan, nan])
    np.testing.assert_allclose(series.at(asked, "TA", longest_gap=6 * 3600.0)[2], 271.15 + 3.5 * 2 / 5)
    assert math.isnan(series.at(asked, "RH", longest_gap=3 * 3600.0)[1])
    assert np.isnan(series.at(asked, "TSS", longest_gap=1e9)).all()


ROW = "2026-02-03T08:00 1 2 3\n"
LONG = "x" * 81


@pytest.mark.parametrize(
    ("text", "row", "column", "value"),
    [
        ("", 1, None, "nothing"),
        ("SMET 1.1", 1, None, "SMET 1.1"),
        (f"SMUT 1.1 ASCII {LONG}", 1, None, f"SMUT 1.1 ASCII {LONG[:65]}"),
        ("SMET 1.1 BINARY\n", 1, None, "SMET 1.1 BINARY"),
        (HEAD.replace("[DATA]", ""), 13, None, "no [DATA]"),
        (HEAD, 13, None, "no row"),
        (HEAD.replace("nodata ", "nodat ") + ROWS, 13, "nodata", "nothing"),
        (HEAD.replace("timestamp TA RH VW", LONG) + ROWS, 12, "fields", LONG[:80]),
        (HEAD.replace("0 273.15 0 0", "0 273.15 0") + ROWS, 10, "units_offset", "3 numbers"),
        (HEAD.replace("46.829", "468.29") + ROWS, 5, "latitude", "468.29"),
        (HEAD.replace("tz  ", "tz = 2\ntz  ") + ROWS, 10, "tz", "1"),
        (HEAD.replace("= 1\n", f"= {99:>0100}\n") + ROWS, 9, "tz", "0" * 80),
        (HEAD + "2026-02-03T08:00 -4.0 80\n", 14, None, "3 cells"),
        (HEAD + f"2026-02-03T08:00 -4.0 {LONG} 3\n", 14, "RH", LONG[:80]),
        (HEAD + f"{LONG} -4.0 80 3\n", 14, "timestamp", LONG[:80]),
        (HEAD + f"{ROW}{ROW}", 15, "timestamp", "2026-02-03T08:00"),
        (HEAD.replace("SMET 1.1", "SMET 2.0") + ROWS, 1, None, "2.0"),
        (HEAD + "0001-01-01T12:00 1 2 3\n", 14, "timestamp", "0001-01-01T12:00"),
        (HEAD + "0001-01-01T00:00 1 2 3\n", 14, "timestamp", "0001-01-01T00:00"),
        (HEAD + "9999-12-31T12:00+01:00 1 2 3\n", 14, "timestamp", "9999-12-31T12:00+01:00"),
        (HEAD + "2026-02-03T08:00 1 -1e308 3\n", 12, "RH", "a larger number"),
        (HEAD.replace("1 1 0.01 1", "1 1e300 1 1") + "2026-02-03T08:00 1e300 2 3\n", 12, "TA", "a larger number"),
    ],
)
def test_what_does_not_fit_is_reported_with_its_line(
    path: Path, text: str, row: int, column: str | None, value: str
) -> None:
    path.write_text(text)
    problem = refusal(path)
    assert (problem.row, problem.column, problem.value) == (row, column, value)


def test_years_at_the_limits_umlauts_and_the_offset_of_a_campaign(path: Path) -> None:
    path.write_bytes(HEAD.replace("Weissfluhjoch", "Fügen").encode("latin-1") + b"0002-01-01T12:00 1 2 3\n")
    series = read_smet(path)
    assert (series.station, series.time[0]) == ("Fügen: snow", datetime(2, 1, 1, 11, tzinfo=UTC).timestamp())
    path.write_text(HEAD + "9998-12-31T12:00 1 2 3\n")
    assert read_smet(path).time.size == 1
    weather = CampaignWeather(series, WeatherSettings())
    assert (weather.utc_offset, replace(weather, settings=WeatherSettings(utc_offset_h=-3.0)).utc_offset) == (1.0, -3.0)
    assert (weather.settings.file, weather.settings.longest_gap_h) == (None, 3.0)
    assert repr(weather) == repr(series).replace("StationSeries", "CampaignWeather")
    assert [WeatherSettings(utc_offset_h=hours, longest_gap_h=0.0).utc_offset_h for hours in (-14, 14)] == [-14, 14]
    for hours, gap in ((-14.1, 0.0), (14.1, 0.0), (0.0, -0.1)):
        with pytest.raises(ParameterError):
            WeatherSettings(utc_offset_h=hours, longest_gap_h=gap)


@pytest.mark.parametrize(
    ("units", "column"), [("", "TA"), ("units_offset = 0 273.15 0 0", "RH"), ("units_multiplier = 1 1 0.01 1", "TA")]
)
def test_celsius_and_percent_without_units_are_rejected(path: Path, units: str, column: str) -> None:
    path.write_text(re.sub(r"units_offset.*\nunits_multiplier.*\n", f"{units}\n", HEAD) + ROWS)
    assert refusal(path).column == column


def test_a_faulty_value_of_a_station_is_kept(path: Path) -> None:
    path.write_text(HEAD + ROWS + "2026-02-03T15:00 -273.15 60 1\n")
    assert read_smet(path).fields["TA"][-1] == 0.0


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    assert refusal(tmp_path / "gone.smet").row is None


@pytest.mark.parametrize(
    ("version", "kelvin"),
    [("0.9", 273.15), ("0.95", 273.15), ("0.99", 273.15), ("1.0", 273.15), ("1.1", 477.4478), ("1.2", 477.4478)],
)
def test_the_version_decides_whether_the_offset_comes_first(path: Path, version: str, kelvin: float) -> None:
    """32 °F: (32 + 459.67) × 5/9 = 273.15; with the multiplier first 32 × 5/9 + 459.67 = 477.4478."""
    units = "units_offset = 0 459.67\nunits_multiplier = 1 0.555555555556"
    head = f"SMET {version} ASCII\n[HEADER]\nstation_id = a\nnodata = -999\nfields = timestamp TA\n{units}\n[DATA]\n"
    path.write_text(head + "2010-06-22T12:00 32.0\n2010-06-22T13:00 -999\n")
    assert read_smet(path).fields["TA"] == pytest.approx([kelvin, math.nan], abs=1e-4, nan_ok=True)


@pytest.mark.parametrize("mark", ["#", ";"])
def test_remarks_begin_with_two_characters(path: Path, mark: str) -> None:
    head = HEAD.replace("[DATA]", f"{mark} a line\ncomment = x {mark} nodata = 5\n[DATA] {mark} rows")
    path.write_text(f"{head}{mark} another\n2026-02-03T08:00 -4.0 80 3.5 {mark} cleaned\n")
    assert read_smet(path).fields["VW"].tolist() == [3.5]


@pytest.mark.parametrize(("zone", "utc"), [("-14", 22), ("5.75", 2.25), ("14", -6), ("0", 8)])
def test_zones_in_range_are_subtracted(path: Path, zone: str, utc: float) -> None:
    path.write_text(HEAD.replace("tz               = 1", f"tz = {zone}") + ROWS)
    series = read_smet(path)
    assert series.time[0] == moment(0) + utc * 3600.0
    assert series.utc_offset == float(zone)


@pytest.mark.parametrize("zone", ["14.1", "-24", "24", "99999", "1e300", "nan", "UTC"])
def test_zones_out_of_range_are_rejected_with_their_line(path: Path, zone: str) -> None:
    path.write_text(HEAD.replace("tz               = 1", f"tz = {zone}") + ROWS)
    problem = refusal(path)
    assert (problem.row, problem.column, problem.value) == (9, "tz", zone)


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
def test_shared_cases() -> None:
    assert read_smet(CASES / "v10_fahrenheit.smet").fields["TA"] == pytest.approx([273.15, 283.15], abs=1e-6)
    assert read_smet(CASES / "semicolon_comment.smet").fields["ISWR"].tolist() == [320.0, 340.0]
    assert refusal(*CASES.glob("tz-out*.smet")).row == 9


@pytest.mark.parametrize(
    ("name", "units", "allowed", "refused"),
    [
        ("TA", "273.15 1", "-93.1", "-93.2"),
        ("TSS", "0 1", "180", "179.9"),
        ("RH", "0 1", "1.2", "1.21"),
        ("RH", "0 1", "-0.05", "-0.06"),
        ("VW", "0 1", "0", "-0.1"),
        ("ISWR", "0 1", "-50", "-50.5"),
    ],
)
def test_limits_of_medians(path: Path, name: str, units: str, allowed: str, refused: str) -> None:
    offset, factor = units.split()
    head = HEAD.replace("TA RH VW", name)
    head = re.sub(r"(units_offset +=).*", rf"\1 0 {offset}", head)
    head = re.sub(r"(units_multiplier +=).*", rf"\1 1 {factor}", head)
    path.write_text(f"{head}2026-02-03T08:00 {allowed}\n")
    assert list(read_smet(path).fields) == [name]
    path.write_text(f"{head}2026-02-03T08:00 {refused}\n")
    problem = refusal(path)
    assert (problem.row, problem.column) == (12, name)
    assert problem.value is not None and problem.value.startswith("median ")


@pytest.mark.parametrize(
    ("key", "text", "value"),
    [
        ("latitude", "90", 90.0),
        ("latitude", "-90.1", None),
        ("longitude", "-180", -180.0),
        ("longitude", "180.1", None),
    ],
)
def test_limits_of_places(path: Path, key: str, text: str, value: float | None) -> None:
    path.write_text(re.sub(rf"{key} +=.*", f"{key} = {text}", HEAD) + ROWS)
    if value is None:
        problem = refusal(path)
        assert (problem.row, problem.column, problem.value) == (5 if key == "latitude" else 6, key, text)
    else:
        assert getattr(read_smet(path), f"{key}_deg") == value


def test_defaults_and_repeated_keys_of_a_header(path: Path) -> None:
    """Without a time zone and a name, with a place of nodata; a key may be repeated with the same value."""
    head = re.sub(r"(tz|station_name) .*\n", "", HEAD).replace("46.829", "-999").replace("9.809", "-999")
    path.write_text(head.replace("nodata ", "nodata = -999\nnodata ") + ROWS)
    series = read_smet(path)
    assert (series.station, series.utc_offset, series.latitude_deg, series.longitude_deg) == ("WFJ2", 0.0, None, None)
    path.write_text(re.sub(r"altitude.*\n", "", HEAD) + ROWS)
    assert read_smet(path).altitude is None
    path.write_text(HEAD.replace("timestamp TA RH VW", "timestamp TA TA VW") + ROWS)
    assert (refusal(path).row, refusal(path).column, refusal(path).value) == (12, "fields", "timestamp TA TA VW")
