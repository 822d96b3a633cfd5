"""SMET: units, gaps, time zones, and what does not fit."""

from __future__ import annotations

import math
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow.errors import FieldDataError
from skisnow.field.smet import read_smet

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


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "station.smet"


def test_values_are_si_and_times_utc(path: Path) -> None:
    path.write_text(HEAD + ROWS)
    series = read_smet(path)
    assert (series.station, series.altitude, series.utc_offset) == ("Weissfluhjoch: snow", 2540.0, 1.0)
    assert (series.latitude_deg, series.longitude_deg) == (46.829, 9.809)
    assert series.time.tolist() == [moment(7), moment(8), moment(13)]
    np.testing.assert_allclose(series.fields["TA"], [269.15, 271.15, 274.65])
    np.testing.assert_allclose(series.fields["RH"], [0.8, math.nan, 0.6])
    assert "3 rows, 2026-02-03 07:00 to 2026-02-03 13:00 UTC" in repr(series)


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


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "row 1.*SMET, a version and ASCII"),
        ("SMET 1.1 BINARY\n", "SMET 1.1 BINARY"),
        (HEAD.replace("[DATA]", ""), "cut off"),
        (HEAD, "at least one row"),
        (HEAD.replace("nodata ", "nodat ") + ROWS, "the key nodata"),
        (HEAD.replace("timestamp", "when") + ROWS, "timestamp among them"),
        (HEAD.replace("0 273.15 0 0", "0 273.15 0") + ROWS, "row 10.*3 numbers.*4, one for each"),
        (HEAD + "2026-02-03T08:00 -4.0 80\n", "row 14.*3 cells"),
        (HEAD + "2026-02-03T08:00 -4.0 dry 3\n", "row 14, column RH.*'dry'"),
        (HEAD + "yesterday -4.0 80 3\n", "row 14, column timestamp.*'yesterday'"),
        (HEAD + "2026-02-03T08:00 1 2 3\n2026-02-03T08:00 1 2 3\n", "row 15.*later time"),
    ],
)
def test_what_does_not_fit_is_told_with_its_line(path: Path, text: str, words: str) -> None:
    path.write_text(text)
    with pytest.raises(FieldDataError, match=rf"station\.smet.*{words}"):
        read_smet(path)


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match=r"gone\.smet"):
        read_smet(tmp_path / "gone.smet")
