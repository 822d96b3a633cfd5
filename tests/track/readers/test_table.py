"""Tracks from CSV: cells, how spreadsheets write them, and refusals."""

import csv
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow.track.projection import GeodeticPoint
from skisnow.track.read import read_track
from skisnow.track.track import Track
from tests.present import present

from .. import metres_per_degree

LOCAL = "time_s,x_m,y_m,z_m,speed_m_per_s\n0.5,0,0,10,7\n0.6,0.7,0.1,9.9,7.25\n0.7,1.5,-.2,,\n"
DAY = Path(__file__).resolve().parents[4] / "shared" / "data" / "ski-track" / "morin_heights_2022-12-27.csv"


def read(tmp_path: Path, content: str | bytes, name: str = "run.csv", **named: object) -> Track:
    path = tmp_path / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return read_track(path, **named)  # type: ignore[arg-type] # the tests give wrong ones on purpose


def refused(tmp_path: Path, content: str | bytes, name: str = "run.csv", **named: object) -> str:
    with pytest.raises(FieldDataError) as caught:
        read(tmp_path, content, name, **named)
    message, problems = str(caught.value), cast("tuple[Any, ...]", caught.value.problems)
    assert {Path(each.file).name for each in problems} == {name}
    assert "allowed" in message
    return message


@pytest.mark.parametrize(
    "content",
    [
        '<?xml version="1.0"?>\n<kml/>',
        b"\xef\xbb\xbf<kml></kml>",
        '{"type": "FeatureCollection"}',
        "AXYZ123\r\nHFDTE050126\r\n",
        b"PK\x03\x04doc.kml",
        b"\x1f\x8b\x08",
    ],
)
def test_other_formats_are_named_as_such(tmp_path: Path, content: str | bytes) -> None:
    """Not as tables without the right headings."""
    assert "unreadable_file" in refused(tmp_path, content, "run.track")
    assert "unreadable_file" in refused(tmp_path, content, "run.gpx")


def test_local_metres(tmp_path: Path) -> None:
    track = read(tmp_path, LOCAL)
    np.testing.assert_allclose(track.time, [0.0, 0.1, 0.2], atol=1e-15)
    assert track.first_time == 0.5
    np.testing.assert_array_equal(track.place, [[0, 0, 10], [0.7, 0.1, 9.9], [1.5, -0.2, np.nan]])
    np.testing.assert_array_equal(track.speed, [7.0, 7.25, np.nan])
    assert track.flagged == {"missing_height": 1}
    assert (track.time_scale, track.start, track.axes, track.origin) == ("local", None, "file", None)
    assert track.name == "run.csv"


def test_track_of_a_simulated_run(tmp_path: Path) -> None:
    """The header that a run writes; what is not read is named, not complained of."""
    head = (
        "time_s,x_m,y_m,z_m,speed_m_per_s,heading_deg,turn_radius_m,left_x_m,left_y_m,left_depth_mm,right_x_m,"
        "right_y_m,right_depth_mm\n"
    )
    track = read(tmp_path, head + "0.0,0,0,0.2,7,-30,,0,0.25,1.5,0,-0.25,1\n0.01,0.06,-0.03,0.2,7,-30,25,0,0,2,0,0,2\n")
    np.testing.assert_array_equal(track.place[1], [0.06, -0.03, 0.2])
    assert track.further_columns[:2] == ("heading_deg", "turn_radius_m")
    assert len(track.further_columns) == 8


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("ends", ["\n", "\r\n", "\r"])
def test_as_a_german_spreadsheet_writes_it(tmp_path: Path, encoding: str, ends: str) -> None:
    plain = read(tmp_path, LOCAL)
    lines = LOCAL.replace(",", ";").replace(".", ",").splitlines()
    text = ends.join(["Wärme;" + lines[0], *("ä;" + line for line in lines[1:]), ";;;;;"]) + ends
    german = read(tmp_path, text.encode(encoding))
    np.testing.assert_array_equal(german.place, plain.place)
    np.testing.assert_array_equal(german.time, plain.time)
    assert german.further_columns == ("Wärme",)


def test_separator_line_and_tabs(tmp_path: Path) -> None:
    plain = read(tmp_path, LOCAL)
    np.testing.assert_array_equal(read(tmp_path, "sep=;\r\n" + LOCAL.replace(",", ";")).place, plain.place)
    np.testing.assert_array_equal(read(tmp_path, LOCAL.replace(",", "\t")).place, plain.place)


def test_latitude_and_longitude(tmp_path: Path) -> None:
    step = 1e-4
    rows = f"2022-12-27T15:51:14Z,46.0,7.0,0.0,3.5\n2022-12-27T16:51:16.250+01:00,{46 + step},{7 - step},5,-1\n"
    track = read(tmp_path, "time,lat,lon,alt_m,speed_mps\n" + rows)
    assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
    assert track.time_scale == "UTC"
    np.testing.assert_array_equal(track.time, [0.0, 2.25])
    # 1e-4 degrees are some 10 m: series and plane differ by less than 1e-5 m there
    expected = [-step * metres_per_degree.east(46.0), step * metres_per_degree.north(46.0), 5.0]
    np.testing.assert_allclose(track.place[0], np.zeros(3), atol=1e-9)
    np.testing.assert_allclose(track.place[1], expected, atol=2e-5)
    np.testing.assert_array_equal(track.speed, [3.5, np.nan])
    assert track.flagged == {"negative_speed": 1}
    assert "latitude 46°, longitude 7°, height 0 m" in track.frame
    assert track.axes == "east_north_up"


def test_given_origin(tmp_path: Path) -> None:
    text = "time,lat,lon,alt_m\n0,46.0,7.0,100\n1,46.0,7.0,101\n"
    track = read(tmp_path, text, origin=GeodeticPoint(46.0, 6.999, height=90.0))
    assert track.place[0, 0] == pytest.approx(1e-3 * metres_per_degree.east(46.0) * (1 + 90 / 6.39e6), abs=2e-3)
    np.testing.assert_allclose(np.diff(track.place, axis=0), [[0, 0, 1.0]], atol=2e-5)


def test_sixty_kilometres_from_the_origin_up_is_down(tmp_path: Path) -> None:
    """The ellipsoid falls away below the plane: d²/2R."""
    text = "time,lat,lon,alt_m\n0,46.0,7.0,0\n"
    track = read(tmp_path, text, origin=GeodeticPoint(46.5, 7.0))
    distance = 0.5 * metres_per_degree.north(46.25)
    assert track.place[0, 1] == pytest.approx(-distance, rel=1e-4)
    assert track.place[0, 2] == pytest.approx(-(distance**2) / (2 * 6.367e6), rel=1e-2)


def test_points_without_a_place_stay_between_others(tmp_path: Path) -> None:
    track = read(tmp_path, "time,lat,lon\n0,,\n1,46,7\n2,,7\n3,46,7\n")
    assert len(track) == 3
    assert list(track.left_out.values()) == [1]
    assert track.flagged == {"no_fix": 1, "missing_height": 2}
    np.testing.assert_array_equal(track.usable, [True, False, True])
    np.testing.assert_array_equal(track.time, [0.0, 1.0, 2.0])
    assert track.first_time == 1.0


def test_latitude_and_longitude_zero_are_no_place(tmp_path: Path) -> None:
    track = read(tmp_path, "time,lat,lon,alt_m\n0,0,0.0,0\n1,0,7,5\n2,0,7,5\n")  # on the equator there is a place
    assert list(track.left_out.values()) == [1]
    assert track.origin == GeodeticPoint(0.0, 7.0, height=5.0)


def test_seconds_and_dates_without_zone(tmp_path: Path) -> None:
    seconds = read(tmp_path, "time,lat,lon\n1672156274.5,46,7\n1672156275.75,46,7\n")
    np.testing.assert_array_equal(seconds.time, [0.0, 1.25])
    assert (seconds.time_scale, seconds.first_time) == ("local", 1672156274.5)
    dated = read(tmp_path, "time,x_m,y_m\n2022-12-27 15:51:14,1,2\n2022-12-27 15:51:15,1,2\n")
    assert dated.time_scale == "local"
    assert present(dated.start).tzinfo is None


def test_uncertainties_and_odometer(tmp_path: Path) -> None:
    head = "time_s,x_m,y_m,x_sd_m,y_sd_m,speed_sd_m_per_s,dist_m"
    track = read(tmp_path, f"{head}\n0,0,0,0.02,0.03,0.1,4\n1,1,0,0.02,,0.1,5\n")
    np.testing.assert_array_equal(present(track.place_sd), [[0.02, 0.03, np.nan], [0.02, np.nan, np.nan]])
    np.testing.assert_array_equal(track.speed_sd, [0.1, 0.1])
    np.testing.assert_array_equal(track.odometer, [4.0, 5.0])
    assert "out_of_range" in refused(tmp_path, f"{head}\n0,0,0,-0.02,0.03,0.1,4\n")


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", ["empty_file"]),
        (" \n\n", ["empty_file"]),
        ("time_s,x_m,y_m\n", ["empty_file", "no point"]),
        ("My run;;\ntime_s;x_m;why\n0;1;2\n", ["missing_column", "row 1:", "'My run'", "semicolon"]),
        (
            "Source;Mini\nZeit [ms];x;y\n0;1;2\nspät;1;2\n",
            ["not_a_number", "row 4, column Zeit [ms]", "in ms in every"],
        ),
        ("time_s|x_m|y_m\n0|1|2\n", ["missing_column", "row 1:", "'time_s|x_m|y_m'", "semicolon"]),
        ("time_s,x_m\n0,1\n", ["missing_column", "column y_m", "time_s, x_m"]),
        ("time_s,x_m,why\n0,1,2\n", ["missing_column", "column y_m"]),
        ("time,latt,lon\n0,46,7\n", ["missing_column", "column lat", "time, latt, lon"]),
        ("x_m,y_m\n0,1\n", ["missing_column", "column time_s"]),
        (
            "time,lat,lon,Altitude [fathoms]\n0,46,7,900\n",
            ["unknown_unit", "column alt_m", "'Altitude [fathoms]'", "ft"],
        ),
        ("time_s,x_m,y_m,Speed\n0,1,2,3\n", ["unknown_unit", "column speed_m_per_s", "'Speed'"]),
        ("time_s,x_m,y_m,Ground_Speed\n0,1,2,3\n", ["unknown_unit", "column speed_m_per_s", "'Ground_Speed'"]),
        ("time_s,x_m,y_m,speed_warp\n0,1,2,3\n", ["unknown_unit", "column speed_m_per_s", "'speed_warp'", "km/h"]),
        ("Zeit [Tage];x;y\n0;1,5;2\n", ["unknown_unit", "column time_s", "'Zeit [Tage]'", "ms"]),
        ("time,lat,lon,alt_m,Höhe [ft]\n0,46,7,9,9\n", ["column_twice", "column alt_m", "'alt_m, Höhe [ft]'"]),
        ("t (s);t (ms);x;y\n0;1;2;3\n", ["column_twice", "column time_s", "'t (s), t (ms)'"]),
        ("Zeit,x,y,Breite,Länge\n0,1,2,46,7\n", ["two_places"]),
        ("time,lat,lon,Höhe [ft]\n0,46,7,9\n1,46,7,x\n", ["not_a_number", "row 3, column Höhe [ft]"]),
        ("time_s,x_m,y_m\n0,1,2\n1,one,2\n", ["not_a_number", "row 3, column x_m", "'one'", "decimal point"]),
        ("time_s,x_m,y_m\n0,1,2\n\n1,4OO,2\n", ["not_a_number", "row 4, column x_m", "'4OO'"]),
        ("time_s;x_m;y_m\n0;1,5;2,5\n1;1.5;2,5\n", ["not_a_number", "row 3, column x_m", "'1.5'", "decimal comma"]),
        ("time_s,x_m,y_m\n0,1,5,2,5\n", ["too_many_cells", "row 2", "3 cells", "decimal comma"]),
        ("time_s,x_m,y_m\n,1,2\n", ["not_a_number", "row 2, column time_s"]),
        ("time,lat,lon\n27.12.2022 15:51:14,46,7\n", ["not_a_time", "row 2, column time", "27.12.2022"]),
        ("time,lat,lon\n2022-12-27T15:51:14Z,46,7\n2022-12-27T15:51:15,46,7\n", ["not_a_time", "row 3", "zone"]),
        ("time,lat,lon\n0,46,7\n1,400,7\n", ["out_of_range", "row 3, column lat", "'400'", "from −90 to 90"]),
        ("time,lat,lon\n0,46,181\n", ["out_of_range", "row 2, column lon"]),
        ("time_s,x_m,y_m\n0,1e300,2\n", ["out_of_range", "row 2, column x_m"]),
        ("time_s,x_m,y_m,speed_mps\n0,1,2,36000\n", ["out_of_range", "row 2, column speed"]),
        ("time_s,x_m,y_m\n0,1,2\n5.5,1,2\n5.25,1,2\n", ["time_backwards", "row 4, column time", "5.25 s", "5.5 s"]),
        ("time_s,x_m,y_m,x_m\n0,1,2,3\n", ["column_twice", "row 1, column x_m"]),
        ("time_s,x_m,y_m,lat,lon\n0,1,2,46,7\n", ["two_places"]),
        ("time,lat,lon\n0,,\n1,,\n", ["no_place", "None of the 2 points"]),
        ('time_s,x_m,y_m\n0,"1,2\n1,1,2\n', ["unreadable_file", "row 2"]),
        (b"time_s,x_m,y_m\n0,1\x00,2\n", ["unreadable_file", "NUL"]),
    ],
)
def test_refused(tmp_path: Path, content: str | bytes, told: list[str]) -> None:
    message = refused(tmp_path, content)
    for words in told:
        assert words in message


@pytest.mark.parametrize(
    ("header", "first", "second"),
    [
        ("timestamp,latitude,longitude,elevation,speed_mps", "0,46,7,100,10", "0.5,46.5,7.5,101,20"),
        ("Time (s),Latitude (°),Longitude (°),Height (m),Velocity (m/s)", "0,46,7,100,10", "0.5,46.5,7.5,101,20"),
        ("t (ms),lat,lng,Altitude_m,Speed [km/h]", "0,46,7,100,36", "500,46.5,7.5,101,72"),
        (
            "time_s,GPS Latitude,GPS_Longitude,GPS Altitude (m),Ground Speed (km/h)",
            "0,46,7,100,36",
            "0.5,46.5,7.5,101,72",
        ),
        ("Zeit [s];Breite;Länge;Höhe;Geschwindigkeit [km/h]", "0;46;7;100;36", "0,5;46,5;7,5;101;72"),
        ("ZEIT_ms\tBreitengrad\tLängengrad\tHöhe/m\tv (m/s)", "0\t46\t7\t100\t10", "500\t46,5\t7,5\t101\t20"),
        (
            "Zeitstempel;Breite [°];La\u0308nge [°];Ho\u0308he (cm);speed_kmh",
            "2024-01-20T10:00:00Z;46;7;10000;36",
            "2024-01-20T10:00:00.5Z;46,5;7,5;10100;72",
        ),
        (
            "timestamp_ms,Lat,Lon,ele (ft),speed (kn)",
            f"1705744800000,46,7,{100 / 0.3048},{10 * 3600 / 1852}",
            f"1705744800500,46.5,7.5,{101 / 0.3048},{20 * 3600 / 1852}",
        ),
    ],
)
def test_headings_of_other_programs(tmp_path: Path, header: str, first: str, second: str) -> None:
    """All are the same two points, which the columns' own names give."""
    named = read(tmp_path, "time,lat,lon,alt_m,speed_mps\n0,46,7,100,10\n0.5,46.5,7.5,101,20\n")
    track = read(tmp_path, f"{header}\n{first}\n{second}\n", "b.csv")
    np.testing.assert_allclose(track.time, [0.0, 0.5], atol=1e-6)
    np.testing.assert_allclose(track.place, named.place, rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(track.speed, [10.0, 20.0], rtol=1e-12)
    assert track.further_columns == ()


def test_local_metres_under_other_headings(tmp_path: Path) -> None:
    track = read(tmp_path, "t (ms);x [cm];Nord;Höhe [m];v [km/h]\n500;100;2;3;3,6\n600;150;2,5;2;7,2\n")
    np.testing.assert_allclose(track.place, [[1.0, 2.0, 3.0], [1.5, 2.5, 2.0]], rtol=1e-12)
    np.testing.assert_allclose(track.speed, [1.0, 2.0], rtol=1e-12)
    assert (track.first_time, track.time[1]) == pytest.approx((0.5, 0.1))


@pytest.mark.parametrize(
    "further",
    ["T", "t [°C]", "x [g]", "Easting", "time_zone", "speed_accuracy", "v_dop", "Ground Speed", "GPS Speed (kn)"],
)
def test_further_columns_beside_those_that_are_read(tmp_path: Path, further: str) -> None:
    """A letter that may mean another quantity, another form's place, and a remark about a column that is there."""
    track = read(tmp_path, f"time,lat,lon,speed_mps,{further}\n0,46,7,3,9\n1,46,7,3,9\n")
    assert track.further_columns == (further,)
    np.testing.assert_array_equal(track.speed, [3.0, 3.0])


@pytest.mark.parametrize("above", ["Format,CSV\nSource,Mini,3221\n\n", "My run\n"])
def test_rows_above_the_headings_are_passed(tmp_path: Path, above: str) -> None:
    text = "Record,Time,Latitude,Longitude,Speed (km/h)\n1,0,46,7,36\n2,1,46.5,7,72\n"
    track = read(tmp_path, above + text)
    np.testing.assert_array_equal(track.place, read(tmp_path, text, "b.csv").place)
    np.testing.assert_allclose(track.speed, [10.0, 20.0])
    assert track.further_columns == ("Record",)


def test_dates_that_run_backwards_are_reported_as_dates(tmp_path: Path) -> None:
    message = refused(tmp_path, "time,lat,lon\n2022-12-27T15:51:14Z,46,7\n2022-12-27T15:51:13.5Z,46,7\n")
    assert "row 3" in message
    assert "2022-12-27 15:51:13.5" in message


def test_letters_of_hemispheres(tmp_path: Path) -> None:
    track = read(tmp_path, "time,Latitude,N/S,Longitude,E/W,State\n0,46,S,70.5,W,N\n1,46,N,70.5,e,S\n")
    assert (present(track.origin).latitude_deg, present(track.origin).longitude_deg) == (-46.0, -70.5)
    east = 6.389e6 * np.cos(np.radians(46.0)) * np.sin(np.radians(2 * 70.5))
    assert track.place[1, 0] == pytest.approx(east, rel=1e-3)
    assert track.further_columns == ("State",)


@pytest.mark.parametrize(("unit", "ratio"), [("km/h", 3.6), ("mph", 1 / 0.44704)])
def test_speeds_in_another_unit_than_the_heading(tmp_path: Path, unit: str, ratio: float) -> None:
    """Along a slalom of 10 m/s, with the receiver at rest at first."""
    rows = [f"{t},0,0,0.01" for t in range(10)]
    rows += [f"{t + 10},{9 * t},{3 * np.sin(2 * t)},{10 * ratio}" for t in range(20)]
    message = refused(tmp_path, "time_s,x_m,y_m,speed_mps\n" + "\n".join(rows))
    assert "unknown_unit" in message
    assert unit in message
    as_stated = "\n".join(rows).replace(str(10 * ratio), "10")
    assert read(tmp_path, f"time_s,x_m,y_m,speed_mps\n{as_stated}").notes == ()


def test_zeros_of_a_device_without_speeds(tmp_path: Path) -> None:
    rows = "\n".join(f"{t},{9 * t},0,0" for t in range(8))
    track = read(tmp_path, f"time_s,x_m,y_m,speed_mps\n{rows}\n")
    assert np.isnan(track.speed).all()
    assert "All recorded speeds are 0" in track.notes[0]
    at_rest = read(tmp_path, "time_s,x_m,y_m,speed_mps\n" + "\n".join(f"{t},1,2,0" for t in range(8)))
    np.testing.assert_array_equal(at_rest.speed, np.zeros(8))


def test_origin_on_earth_needs_places_on_earth(tmp_path: Path) -> None:
    assert "local metres only" in refused(tmp_path, LOCAL, origin=GeodeticPoint(46.0, 7.0))


def test_no_such_file_and_a_folder(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.csv", tmp_path):
        with pytest.raises(FieldDataError, match="Check the path"):
            read_track(path)


def test_a_real_day() -> None:
    """Numbers of the data's page, and those that a plain reader of CSV finds."""
    if not DAY.exists():
        pytest.skip("the shared day of skiing is not beside this repository")
    track = read_track(DAY)
    with DAY.open() as stream:
        rows = list(csv.DictReader(stream))
    assert len(track) == len(rows) == 5898
    assert track.flagged == {"repeated_time": 13}
    assert track.further_columns == ("lap",)
    np.testing.assert_array_equal(track.speed, [float(row["speed_mps"]) for row in rows])
    assert present(track.odometer)[-1] == float(rows[-1]["dist_m"])
    # the sum of steps by the lengths of a degree at the resort; 1e-3 of some 14 km for the latitude's change
    steps = np.diff([[float(row["lon"]), float(row["lat"])] for row in rows], axis=0)
    lengths = np.hypot(steps[:, 0] * metres_per_degree.east(45.9), steps[:, 1] * metres_per_degree.north(45.9))
    own = np.hypot(*np.diff(track.place[:, :2], axis=0).T)
    assert own.sum() == pytest.approx(lengths.sum(), rel=1e-3)


def test_tables_of_no_measurement_are_rejected(tmp_path: Path) -> None:
    assert "at most 1000 columns" in refused(tmp_path, "x," * 100_000 + "\n1\n")
    assert "row 2" in refused(tmp_path, f"time_s,x_m,y_m\n1,2,{'9' * 40_000}\n")
    assert "not_a_number" in refused(tmp_path, f"time_s,x_m,y_m\n1,2,{'9' * 30_000}\n")


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\r\r\n", "\u0085", "\u2028", "\u2029", "\x0b", "\x0c"])
@pytest.mark.parametrize("begin", ["", "\ufeff", "\n\n", "\ufeff\n\ufeff"])
def test_any_line_end(tmp_path: Path, end: str, begin: str) -> None:
    plain = read(tmp_path, LOCAL)
    track = read(tmp_path, begin + LOCAL.replace("\n", end), "b.csv")
    np.testing.assert_array_equal(track.place, plain.place)
    np.testing.assert_array_equal(track.time, plain.time)


@pytest.mark.parametrize(
    "header",
    ["TIME_S,X_M,Y_M,Z_M,SPEED_M_PER_S", " Time s , X m,Y  m,z_M,Speed m per s", "Time_s,X_m,Y_m,Z_m,Speed_mps"],
)
def test_headings_in_capitals_and_with_spaces(tmp_path: Path, header: str) -> None:
    plain = read(tmp_path, LOCAL)
    track = read(tmp_path, LOCAL.replace(LOCAL.split("\n", maxsplit=1)[0], header), "b.csv")
    np.testing.assert_array_equal(track.place, plain.place)
    np.testing.assert_array_equal(track.speed, plain.speed)
    assert track.further_columns == ()
    assert "column_twice" in refused(tmp_path, LOCAL.replace("z_m", "X_M"))


@pytest.mark.parametrize("word", ["nan", "NaN", "-nan(ind)", "inf", "-Infinity", "1.#INF", "-1.#IND00", "NaN(0x1)"])
def test_cells_that_are_not_finite(tmp_path: Path, word: str) -> None:
    """In a column that is not read they do not matter; in one that is read they are blank and flagged."""
    table = f"time,lat,lon,alt_m,hdop\n0,46,7,5,1\n1,46,7,5,{word}\n2,46,7,{word},1\n3,{word},7,5,1\n4,46,7,5,1\n"
    track = read(tmp_path, table)
    assert track.flagged == {"no_fix": 1, "missing_height": 1, "not_finite": 2}
    assert track.flags["not_finite"].tolist() == [False, False, True, True, False]
    assert "not_a_time" in refused(tmp_path, f"time,lat,lon\n0,46,7\n{word},46,7\n")


def serial(days: str, *, rows: int = 30, rate: float = 1.0, header: str = "time,lat,lon") -> str:
    """Rows from a day and fraction on, in the digits that a spreadsheet writes."""
    begin = float(days)
    return f"{header}\n" + "".join(
        f"{begin + n / rate / 86400.0:.10f},{46.0 + 1e-4 * n / rate:.7f},7\n" for n in range(rows)
    )


@pytest.mark.parametrize("rate", [0.2, 1.0, 10.0, 25.0])
@pytest.mark.parametrize(
    ("days", "start"),
    [
        ("45332.4166666667", datetime(2024, 2, 10, 10)),
        ("43870.4166666667", datetime(2020, 2, 9, 10)),  # 2024-02-10 in the date system 1904, which no number shows
        ("44927", datetime(2023, 1, 1)),
    ],
)
def test_serial_dates_of_a_spreadsheet(tmp_path: Path, days: str, start: datetime, rate: float) -> None:
    for text in (serial(days, rate=rate), serial(days, rate=rate).replace(",", ";").replace(".", ",")):
        track = read(tmp_path, text)
        np.testing.assert_allclose(np.diff(track.time), 1.0 / rate, atol=2.1e-3)
        assert track.start == start
        assert len(track.notes) == 1
        assert "1462" in track.notes[0]


def test_fractions_of_a_day(tmp_path: Path) -> None:
    track = read(tmp_path, serial("0.999826388888889", rows=40))
    np.testing.assert_allclose(track.time, np.arange(40.0), atol=2e-3)
    assert track.start is None
    assert len(track.notes) == 1


@pytest.mark.parametrize("begin", [0.0, 0.25, 45332.0, 1_707_559_200.0])
@pytest.mark.parametrize("rate", [1.0, 10.0, 100.0])
def test_seconds_are_not_days(tmp_path: Path, begin: float, rate: float) -> None:
    for name in ("time", "time_s"):
        rows = "".join(f"{begin + n / rate:.3f},46,7\n" for n in range(20))
        track = read(tmp_path, f"{name},lat,lon\n{rows}")
        np.testing.assert_allclose(track.time, np.arange(20.0) / rate, atol=1e-6)
        assert (track.start, track.notes) == (None, ())
    in_days = read(tmp_path, serial("45332.4166666667", header="time_s,lat,lon"), "b.csv")
    assert in_days.start is None  # the heading says seconds
