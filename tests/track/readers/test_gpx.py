"""GPX files and other text."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.track.readers.text import moment, spread_times
from skisnow.track.summary import track_summary

from .. import metres_per_degree
from .test_table import read, refused

HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n<gpx version="1.1" creator="a watch" xmlns="http://www.topografix.com/GPX/1/1"'
EXTENSIONS = ' xmlns:gpxtpx="http://www.garmin.com/xmlschemas/TrackPointExtension/v2">'


def point(lat: float, second: str, inside: str = "<ele>1500.5</ele>") -> str:
    return f'<trkpt lat="{lat}" lon="11.0">{inside}<time>2022-12-27T15:51:{second}</time></trkpt>'


def gpx(*segments: str, head: str = HEAD + EXTENSIONS) -> str:
    return f"{head}<trk>{''.join(f'<trkseg>{segment}</trkseg>' for segment in segments)}</trk></gpx>"


def test_places_times_heights(tmp_path: Path) -> None:
    content = gpx(point(47.0, "14Z") + point(47.0001, "14.500Z", ""), point(47.0, "30+00:00"))
    for name in ("a.gpx", "export.txt"):
        track = read(tmp_path, content, name)
        assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
        assert track.time_scale == "UTC"
        np.testing.assert_array_equal(track.time, [0.0, 0.5, 16.0])
        stretched = 1e-4 * metres_per_degree.north(47.0) * (1 + 1500.5 / 6.37e6)
        np.testing.assert_allclose(track.place[1, :2], [0.0, stretched], atol=2e-5)
        assert track.flagged == {"missing_height": 1, "new_segment": 1}
        assert np.isnan(track.speed).all()
        assert "mean sea level" in track.frame


@pytest.mark.parametrize(
    "extension",
    [
        "<gpxtpx:TrackPointExtension><gpxtpx:hr>120</gpxtpx:hr><gpxtpx:speed>7.25</gpxtpx:speed>"
        "</gpxtpx:TrackPointExtension>",
        "<speed>7.25</speed>",
    ],
)
def test_speed_of_extensions(tmp_path: Path, extension: str) -> None:
    content = gpx(
        f'<trkpt lat="47" lon="11"><time>2022-12-27T15:51:14Z</time><extensions>{extension}</extensions></trkpt>'
    )
    assert read(tmp_path, content, "a.gpx").speed.tolist() == [7.25]


def test_speed_of_version_1_0(tmp_path: Path) -> None:
    head = '<gpx version="1.0" creator="a logger" xmlns="http://www.topografix.com/GPX/1/0">'
    content = gpx(point(47.0, "14Z", "<speed>6.5</speed>"), head=head)
    assert read(tmp_path, content, "a.gpx").speed.tolist() == [6.5]


def test_time_zones(tmp_path: Path) -> None:
    track = read(tmp_path, gpx(point(47.0, "14+01:00") + point(47.0, "15z") + point(47.0, "16-00:30")), "a.gpx")
    assert track.start == datetime(2022, 12, 27, 14, 51, 14, tzinfo=UTC)
    np.testing.assert_array_equal(track.time, [0.0, 3601.0, 5402.0])


def test_no_fix(tmp_path: Path) -> None:
    points = point(47.0, "14Z") + point(47.0, "15Z", "<fix>none</fix>") + point(47.0, "16Z")
    track = read(tmp_path, gpx(points), "a.gpx")
    assert track.flagged["no_fix"] == 1
    assert track.usable.tolist() == [True, False, True]


TCX = """<?xml version="1.0" encoding="UTF-8"?>
<TrainingCenterDatabase xmlns="http://www.garmin.com/xmlschemas/TrainingCenterDatabase/v2">
<Activities><Activity Sport="Other"><Id>2022-12-27T15:51:14Z</Id>
<Lap StartTime="2022-12-27T15:51:14Z"><DistanceMeters>99</DistanceMeters><Track>
<Trackpoint><Time>2022-12-27T15:51:14.000Z</Time><Position><LatitudeDegrees>47.0</LatitudeDegrees>
<LongitudeDegrees>11.0</LongitudeDegrees></Position><AltitudeMeters>1500.5</AltitudeMeters>
<DistanceMeters>3.0</DistanceMeters><HeartRateBpm><Value>120</Value></HeartRateBpm>
<Extensions><ns3:TPX xmlns:ns3="http://www.garmin.com/xmlschemas/ActivityExtension/v2"><ns3:Speed>7.25</ns3:Speed>
</ns3:TPX></Extensions></Trackpoint>
<Trackpoint><Time>2022-12-27T15:51:14.500Z</Time></Trackpoint></Track></Lap>
<Lap StartTime="2022-12-27T15:51:15Z"><Track>
<Trackpoint><Time>2022-12-27T15:51:15Z</Time><Position><LatitudeDegrees>47.0001</LatitudeDegrees>
<LongitudeDegrees>11.0</LongitudeDegrees></Position><AltitudeMeters>1500.5</AltitudeMeters>
<DistanceMeters>14.0</DistanceMeters></Trackpoint></Track></Lap></Activity></Activities></TrainingCenterDatabase>
"""


@pytest.mark.parametrize("name", ["a.tcx", "export.txt"])
def test_tcx(tmp_path: Path, name: str) -> None:
    track = read(tmp_path, TCX, name)
    assert (track.start, track.time_scale) == (datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC), "UTC")
    np.testing.assert_array_equal(track.time, [0.0, 0.5, 1.0])
    stretched = 1e-4 * metres_per_degree.north(47.0) * (1 + 1500.5 / 6.37e6)
    np.testing.assert_allclose(track.place[[0, 2], :2], [[0.0, 0.0], [0.0, stretched]], atol=2e-5)
    np.testing.assert_array_equal(track.speed, [7.25, np.nan, np.nan])
    np.testing.assert_array_equal(track.odometer, [3.0, np.nan, 14.0])
    assert track.usable.tolist() == [True, False, True]
    assert "not_finite" not in track.flagged


def test_damaged_tcx(tmp_path: Path) -> None:
    assert "unreadable_file" in refused(tmp_path, TCX[:-40], "a.tcx")
    assert "point 1, column lat" in refused(tmp_path, TCX.replace(">47.0<", ">north<"), "a.tcx")
    assert "'3 Trackpoint'" in refused(
        tmp_path, TCX.replace("Activity", "Course").replace("Activities", "Courses"), "a.tcx"
    )
    assert "not_a_time" in refused(tmp_path, TCX.replace("<Time>2022-12-27T15:51:15Z</Time>", ""), "a.tcx")


def test_other_encoding(tmp_path: Path) -> None:
    content = gpx(point(47.0, "14Z")).replace("UTF-8", "UTF-16").replace("a watch", "eine Uhr für Schi")
    assert len(read(tmp_path, content.encode("utf-16"), "a.gpx")) == 1


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (gpx(point(47.0, "14Z") + '<trkpt lat="47" lon="11"/>'), ["not_a_time", "point 2, column time"]),
        (gpx(point(47.0, "99Z")), ["not_a_time", "point 1, column time"]),
        (gpx(point(400.0, "14Z")), ["out_of_range", "point 1, column latitude", "'400'"]),
        (gpx(point(47.0, "14Z") + point(47.0, "13Z")), ["time_backwards", "point 2", "15:51:13"]),
        (gpx(point(47.0, "14Z", "<ele>high</ele>")), ["not_a_number", "point 1, column ele", "'high'"]),
        (gpx(""), ["empty_file"]),
        (gpx(point(47.0, "14Z")).replace("trkpt", "rtept"), ["'1 rtept'", "trkpt"]),
        (gpx().replace("gpx", "kml"), ["'<kml>'", "trkpt"]),
        (gpx(point(47.0, "14Z").replace("2022-12-27T", "27.12.2022 ")), ["not_a_time", "'27.12.2022 15:51:14Z'"]),
        (gpx(point(47.0, "14Z"))[:-30], ["unreadable_file", "export it again"]),
        (
            gpx(point(47.0, "14Z", "<extensions><speed>7,5</speed></extensions>")),
            ["not_a_number", "point 1, column speed", "'7,5'"],
        ),
    ],
)
def test_refused(tmp_path: Path, content: str, told: list[str]) -> None:
    message = refused(tmp_path, content, "a.gpx")
    for words in told:
        assert words in message


def test_deep_nesting_is_rejected_and_as_deep_as_allowed(tmp_path: Path) -> None:
    deep = gpx(point(47.0, "14Z", "<extensions>" + "<a>" * 200_000 + "</a>" * 200_000 + "</extensions>"))
    message = refused(tmp_path, deep, "a.gpx")
    assert "101 " in message and "100" in message
    inside = "<a>" * 94 + "<speed>3</speed>" + "</a>" * 94
    assert read(tmp_path, gpx(point(47.0, "14Z", f"<extensions>{inside}</extensions>")), "a.gpx").speed.tolist() == [3]


def test_too_many_elements_are_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.track.readers.gpx.MOST_ELEMENTS", 9)
    assert len(read(tmp_path, gpx(point(47.0, "14Z") + point(47.0, "15Z")), "a.gpx")) == 2  # nine
    assert "more than 9 elements" in refused(tmp_path, gpx(point(47.0, "14Z", "<ele>1</ele><a/>") * 2), "a.gpx")


@pytest.mark.parametrize("declared", ["a 'aaaa'", "a SYSTEM 'file:///etc/passwd'", "% a 'b'"])
def test_entities_are_rejected(tmp_path: Path, declared: str) -> None:
    declaration = f"<!DOCTYPE gpx [<!ENTITY {declared}>]>"
    content = declaration + gpx(point(47.0, "14Z", "<ele>&a;</ele>")).split("\n", 1)[1]
    assert "an entity, a" in refused(tmp_path, content, "a.gpx")


def test_the_place_is_a_points_own(tmp_path: Path) -> None:
    waypoint = '<wpt lat="1" lon="1"><ele>7</ele><time>2022-12-27T15:51:14Z</time></wpt>'
    inside = "<extensions><ele>9</ele><time>1999-01-01T00:00:00Z</time></extensions><ele> 1500 <!-- m --></ele>"
    content = gpx(point(47.0, "14Z", inside)).replace("<trk>", f"{waypoint}<trk>")
    track = read(tmp_path, content, "a.gpx")
    assert len(track) == 1
    assert track.origin is not None
    assert track.origin.height == 1500.0
    assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)


@pytest.mark.parametrize("height", ["<ele></ele>", "<ele>NaN</ele>", "<ele>-inf</ele>", ""])
def test_a_height_may_be_missing(tmp_path: Path, height: str) -> None:
    flagged = read(tmp_path, gpx(point(47.0, "14Z", height)), "a.gpx").flagged
    assert flagged == {"missing_height": 1} | ({"not_finite": 1} if "n<" in height.lower() or "inf" in height else {})


@pytest.mark.parametrize("place", ['lat="47"', 'lat="x" lon="11"', 'lat="1e999" lon="11"'])
def test_a_point_needs_a_place(tmp_path: Path, place: str) -> None:
    content = gpx(f"<trkpt {place}><time>2022-12-27T15:51:14Z</time></trkpt>")
    assert "a.gpx, point 1" in refused(tmp_path, content, "a.gpx")


def test_segment_for_each_lap_continues_the_one_before(tmp_path: Path) -> None:
    laps = ["".join(point(47.0 + 1e-4 * (3 * lap + n), f"{10 + 3 * lap + n}Z") for n in range(3)) for lap in range(3)]
    track = read(tmp_path, gpx(*laps), "a.gpx")
    assert (len(track), track.flagged) == (9, {})


@pytest.mark.parametrize(
    ("apart", "second", "lat"),
    [("track", "30", 47.0003), ("segment", "30", 47.0003), ("segment", "13", 47.1), ("segment", "13.01", 47.0003)],
)
def test_parts_of_a_file_are_not_joined(tmp_path: Path, apart: str, second: str, lat: float) -> None:
    """Later, elsewhere, or both: nothing between two parts counts as path."""
    begin, middle = gpx(*["".join(point(47.0 + 1e-4 * n, f"{10 + n}Z") for n in range(3))]).split("</trkseg>")
    joint = "</trkseg></trk><trk><trkseg>" if apart == "track" else "</trkseg><trkseg>"
    more = "".join(point(lat + 1e-4 * n, f"{float(second) + n:.2f}Z") for n in range(7))
    track = read(tmp_path, begin + joint + more + "</trkseg>" + middle, "a.gpx")
    expected = [3] if second != "13.01" else []
    assert np.flatnonzero(track.flags["new_segment"]).tolist() == expected
    length = track_summary(track).distances["places"]
    steps = 8 if expected else 9
    assert length == pytest.approx(steps * 1e-4 * metres_per_degree.north(47.0), rel=2e-3)


def test_only_points_with_a_fix_count(tmp_path: Path) -> None:
    nowhere = '<trkpt lat="0" lon="0"><time>1980-01-06T00:00:0{}Z</time></trkpt>'
    content = gpx("".join(nowhere.format(n) for n in range(3)) + point(47.0, "14Z") + point(47.0001, "15Z"))
    track = read(tmp_path, content, "a.gpx")
    assert track.start == datetime(2022, 12, 27, 15, 51, 14, tzinfo=UTC)
    assert (len(track), list(track.left_out.values())) == (2, [3])


@pytest.mark.parametrize("rate", [2, 10])
def test_whole_seconds_at_higher_rates(tmp_path: Path, rate: int) -> None:
    points = "".join(point(47.0 + 1e-4 * n / rate, f"{10 + n // rate}Z") for n in range(9 * rate))
    track = read(tmp_path, gpx(points), "a.gpx")
    np.testing.assert_allclose(np.diff(track.time), 1.0 / rate, atol=1e-9)
    assert track.usable.all()
    assert track_summary(track).max_speed == pytest.approx(1e-4 * metres_per_degree.north(47.0), rel=0.01)


@pytest.mark.parametrize("cell", ["", "12:30:00", "2022-12-27", "20221227", "2022-12-27T15", "٢٠٢٢-١٢-٢٧T١٥:٥١"])
def test_a_moment_needs_a_date_and_minutes_in_plain_figures(cell: str) -> None:
    assert moment(cell) is None


def test_a_moment_without_a_zone_keeps_its_clock() -> None:
    assert moment("2022-12-27T15:51") == datetime(2022, 12, 27, 15, 51)
    # of an offset with seconds 60 is no leap second
    assert moment("2016-12-31T23:59:60+01:00:60") == datetime(2016, 12, 31, 22, 59, tzinfo=UTC)


def straight(time: FloatArray) -> FloatArray:
    """10 m/s to the north."""
    return np.column_stack([np.zeros(len(time)), 10.0 * time])


@pytest.mark.parametrize("rate", [2.0, 3.0, 5.0, 10.0, 12.5, 18.18, 25.0, 100.0])
@pytest.mark.parametrize("begin", [0.0, 0.37, 0.9])
@pytest.mark.parametrize("unit", [1.0, 0.1])
def test_even_rates(rate: float, begin: float, unit: float) -> None:
    rate = rate if unit == 1.0 else 10.0 * rate
    true = begin * unit + np.arange(round(12.0 * unit * rate)) / rate
    found, moved = spread_times(unit * np.floor(true / unit + 1e-9), straight(true))
    assert moved.any()
    np.testing.assert_allclose(np.diff(found), 1.0 / rate, rtol=0.02)
    assert np.max(np.abs(found - true)) <= 1.01 / rate  # the phase within a stamp is not recorded


def test_lost_points_and_a_pause() -> None:
    """Each stamp keeps its points: the speed over whole seconds is right."""
    true = np.arange(0.0, 20.0, 0.1)
    true = np.delete(true, [33, 34, 35, 77, 150])
    true = true[(true < 8.0) | (true >= 12.0)]
    found, _ = spread_times(np.floor(true + 1e-9), straight(true))
    assert (np.diff(found) > 0.0).all()
    assert np.max(np.abs(found - true)) < 0.5
    assert np.max(np.diff(found)) == pytest.approx(4.1, abs=0.1)


def test_stamps_that_are_not_rounded_stay() -> None:
    time = np.arange(100.0)
    for stamps in (time, np.delete(np.sort(np.r_[time, 7.0, 8.0, 50.0]), 3), time[:1], time[:0]):
        found, moved = spread_times(stamps, straight(stamps))
        np.testing.assert_array_equal(found, stamps)
        assert not moved.any()


def test_points_recorded_twice_stay_and_standing_still_stays() -> None:
    time = np.repeat(np.arange(50.0), 2)
    found, moved = spread_times(time, straight(time))
    np.testing.assert_array_equal(found, time)
    assert not moved.any()
    nearby = straight(time) + np.tile([[0.0, 0.0], [1.0, 0.0]], (50, 1))  # two receivers 1 m apart
    assert not spread_times(time, nearby)[1].any()
    time = np.repeat(np.arange(10.0), 5)
    assert not spread_times(time, np.zeros((50, 2)))[1].any()


@pytest.mark.filterwarnings("error")
def test_places_known_only_between_stamps_say_nothing() -> None:
    time, place = np.repeat(np.arange(6.0), 4), np.full((24, 2), np.nan)
    place[[3, 4]] = [[0.0, 0.0], [1.0, 0.0]]  # the only step that is known begins a stamp
    assert not spread_times(time, place)[1].any()
