"""Courses from their files: columns, sides, degrees against metres, and everything that is refused with its place."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.scenario import load_scenario
from skisnow.simulation.run_summary import time_gates
from skisnow.track.course import Course, Gate, MovingPoint, on_slope, passages, read_course
from skisnow.track.projection import GeodeticPoint
from skisnow.track.read import read_track
from tests.coded import Coded, coded, raises

HEAD = "gate,x_m,y_m,side,outer_x_m,outer_y_m\n"
ROWS = "1,10,-1,left,10,4\n2,20,1,right,20,-4\n3,30,-1,Left,,\n"
LATITUDE, LONGITUDE = 47.0, 11.0


def written(folder: Path, text: str, name: str = "course.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def gpx(points: list[tuple[float, float, str]]) -> str:
    """Waypoints at metres east and north of 47° N, 11° E, by the radii of curvature of WGS84 (Torge, Geodesy, 4.1)."""
    a, e2, sine = 6378137.0, 0.00669437999014, math.sin(math.radians(LATITUDE))
    w = math.sqrt(1.0 - e2 * sine**2)
    meridian, normal = a * (1.0 - e2) / w**3, a / w
    rows = "".join(
        f'<wpt lat="{LATITUDE + math.degrees(north / meridian):.12f}" '
        f'lon="{LONGITUDE + math.degrees(east / (normal * math.cos(math.radians(LATITUDE)))):.12f}">{rest}</wpt>'
        for east, north, rest in points
    )
    return f'<?xml version="1.0"?><gpx version="1.1" xmlns="http://www.topografix.com/GPX/1/1">{rows}</gpx>'


def test_table_is_read_as_it_stands(tmp_path: Path) -> None:
    found = read_course(written(tmp_path, HEAD + ROWS))
    assert [gate.name for gate in found.gates] == ["1", "2", "3"]
    assert [gate.turning for gate in found.gates] == [(10.0, -1.0), (20.0, 1.0), (30.0, -1.0)]
    assert [gate.side for gate in found.gates] == ["left", "right", "left"]
    assert [gate.outer for gate in found.gates] == [(10.0, 4.0), (20.0, -4.0), None]
    assert [gate.width for gate in found.gates] == [5.0, 5.0, math.inf]
    assert found.length == pytest.approx(2.0 * math.hypot(10.0, 2.0))
    assert found.axes == "metres"
    assert "3 gates" in repr(found) and "20.4 m" in repr(found)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("gate,x_m,y_m\n", coded("missing_column", column="side")),
        (HEAD + ROWS.replace("left,10", "up,10"), coded("unknown_choice", row=2, column="side", value="up")),
        (HEAD + ROWS.replace("2,20,1", "2,2o,1"), coded("not_a_number", row=3, column="x_m", value="2o")),
        (HEAD + ROWS.replace("2,20,1", ",20,1"), coded("missing_name", row=3, column="gate")),
        (HEAD + ROWS.replace("20,-4", "20,"), coded("missing_column", row=3, column="outer_x_m", value="20")),
        (HEAD + ROWS.replace("2,20,1", "1,20,1"), coded("repeated_name", name="1")),
        (HEAD + "1,10,-1,left,10,4\n", coded("too_few_gates", fewest=2, count=1)),
        (HEAD + ROWS.replace("2,20,1,right,20,-4", "2,10,-1,right,,"), coded("same_place", first="1", second="2")),
        (HEAD + ROWS.replace("10,4", "10,-1"), coded("same_place", name="1")),
        (HEAD + ROWS.replace("right", "left"), coded("wrong_side", name="2")),
    ],
)
def test_a_fault_is_reported_with_its_place(tmp_path: Path, text: str, said: str | Coded) -> None:
    path = written(tmp_path, text)
    with raises(ParameterError, said) as error:
        read_course(path)
    assert str(error.value).startswith(str(path))


POINTS = [(0.0, 0.0, "left"), (4.0, -12.0, "right"), (0.0, -24.0, "left"), (4.0, -36.0, "right")]
"""East and north, m: down to the south. Passed on the left, the east, of a pole on the right... see the test."""


def test_degrees_are_the_same_metres(tmp_path: Path) -> None:
    """South is x, so east is y, to the left: on a plane of 20 degrees x goes down the incline."""
    named = [(east, north, f"<name>{i}</name><type>gate {side}</type>") for i, (east, north, side) in enumerate(POINTS)]
    found = read_course(
        written(tmp_path, gpx(named), "course.gpx"),
        latitude_deg=LATITUDE, longitude_deg=LONGITUDE, fall_line_azimuth_deg=180.0,
    )  # fmt: skip
    assert found.axes == "east_north_up"
    np.testing.assert_allclose([gate.turning for gate in found.gates], [each[:2] for each in POINTS], atol=1e-3)
    level = on_slope(found, slope_angle=None)
    assert [gate.side for gate in level.gates] == ["left", "right", "left", "right"]
    np.testing.assert_allclose([gate.turning for gate in level.gates], [(-n, e) for e, n, _ in POINTS], atol=1e-3)
    inclined = on_slope(found, slope_angle=math.radians(20.0))
    stretched = [(-n / math.cos(math.radians(20.0)), e) for e, n, _ in POINTS]
    np.testing.assert_allclose([gate.turning for gate in inclined.gates], stretched, atol=1e-3)
    assert on_slope(inclined, slope_angle=0.3) is inclined


def test_the_same_track_passes_both_at_the_same_times(tmp_path: Path) -> None:
    rows = "".join(f"{i},{e},{n},{side}\n" for i, (e, n, side) in enumerate(POINTS))
    metres = read_course(written(tmp_path, "gate,x_m,y_m,side\n" + rows))
    named = [(east, north, f"<desc>{side}</desc>") for east, north, side in POINTS]
    degrees = read_course(written(tmp_path, gpx(named), "course.gpx"), latitude_deg=LATITUDE, longitude_deg=LONGITUDE)
    time = np.arange(0.0, 6.0, 0.1)
    track = MovingPoint(time, np.column_stack([np.full(len(time), 2.0), 5.0 - 9.0 * time]))
    one, other = (passages(each, track, {}) for each in (metres, degrees))
    assert [each.outcome for each in one.passages] == [each.outcome for each in other.passages] == ["passed"] * 4
    known = [each for each in other.times if each is not None]
    assert one.times == pytest.approx(known, abs=1e-4)
    assert one.times[1] == pytest.approx(17.0 / 9.0)  # the chord from pole 1 to pole 3 is square to its line


def test_a_waypoint_without_a_side_is_rejected(tmp_path: Path) -> None:
    points = gpx([(e, n, f"<name>g{n:.0f}</name>") for e, n, _ in POINTS])
    with raises(ParameterError, "no_side", row=1, name="g0"):
        read_course(written(tmp_path, points, "course.gpx"))


@pytest.mark.parametrize("type_", ["<type>left</type>", ""])
def test_one_waypoint_is_rejected(type_: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError):
        read_course(written(tmp_path, gpx([(0.0, 0.0, type_)]), "course.gpx"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<gpx></gpx>", "no_waypoint"),
        (
            "<gpx><wpt lat='95' lon='11'/></gpx>",
            coded("not_a_number", row=1, what="lat", text="95", lowest=-90.0, limit=90.0),
        ),
        (
            "<gpx><wpt lat='nan' lon='11'/></gpx>",
            coded("not_a_number", row=1, what="lat", text="nan", lowest=-90.0, limit=90.0),
        ),
        (
            "<gpx><wpt lat='47' lon='11'><ele>1e6</ele></wpt></gpx>",
            coded("not_a_number", row=1, what="ele", text="1e6", lowest=-100000.0, limit=100000.0),
        ),
        ("<gpx><wpt lat='47'/></gpx>", coded("not_a_number", row=1, what="lon", lowest=-180.0, limit=180.0)),
        ("<gpx><wpt lat='47' lon='11'>", "not_gpx"),
        ('<!DOCTYPE gpx [<!ENTITY a "b">]><gpx/>', "not_gpx"),
    ],
)
def test_an_invalid_gpx_course_is_rejected(tmp_path: Path, text: str, said: str | Coded) -> None:
    path = written(tmp_path, text, "course.gpx")
    with raises(ParameterError, said) as error:
        read_course(path)
    assert str(error.value).startswith(str(path))


def test_16_mib_of_gpx_are_read(tmp_path: Path) -> None:
    """A file of zeros, which is not GPX, but not too large before it has a byte more."""
    path = tmp_path / "course.gpx"
    for size, code in ((2**24, "not_gpx"), (2**24 + 1, "too_large")):
        with path.open("wb") as stream:
            stream.truncate(size)
        with raises(ParameterError, code):
            read_course(path)


def test_degrees_need_to_know_where_x_points(tmp_path: Path) -> None:
    named = [(east, north, f"<desc>{side}</desc>") for east, north, side in POINTS]
    path = written(tmp_path, gpx(named), "course.gpx")
    with raises(ParameterError, "no_azimuth"):
        on_slope(read_course(path), slope_angle=None)
    with raises(ParameterError, "half_place"):
        read_course(path, latitude_deg=47.0)


def test_a_scenario_lays_degrees_on_its_slope(tmp_path: Path) -> None:
    """Down a plane the incline is longer than the map; over a profile x stays horizontal."""
    named = [(east, north, f"<name>{i}</name><type>gate {side}</type>") for i, (east, north, side) in enumerate(POINTS)]
    file = str(written(tmp_path, gpx(named), "course.gpx"))
    heights = "".join(f"{x},{-x / 5}\n" for x in range(0, 101, 5))
    (tmp_path / "profile.csv").write_text(f"x,y\n{heights}", encoding="utf-8")
    place = {"latitude_deg": LATITUDE, "longitude_deg": LONGITUDE, "fall_line_azimuth_deg": 180.0}
    changes = {"course.file": file} | {f"course.{name}": value for name, value in place.items()}
    incline = load_scenario("carved-46m", changes={"slope.angle_deg": 20.0})
    plane = load_scenario("carved-46m", changes={**changes, "slope.angle_deg": 20.0}).course
    degrees = read_course(file, **place)
    bent = {"slope.kind": "profile", "slope.profile": str(tmp_path / "profile.csv")}
    profile = load_scenario("carved-46m", changes={**changes, **bent}).course
    stretch = 1.0 / math.cos(math.radians(20.0))
    for found, stretched in ((plane, stretch), (incline.with_(course=degrees).course, stretch), (profile, 1.0)):
        assert found is not None
        np.testing.assert_allclose(
            [gate.turning for gate in found.gates], [(-n * stretched, e) for e, n, _ in POINTS], atol=1e-3
        )
    with raises(ParameterError, "no_azimuth"):
        incline.with_(course=replace(degrees, fall_line_azimuth_deg=None))


def test_a_track_and_a_course_in_degrees_with_their_own_origins_are_brought_together(tmp_path: Path) -> None:
    """The track begins 20 m before the first gate: its own origin is its first point, the course's its first gate."""
    file = written(tmp_path, gpx([(e, n, f"<desc>{side}</desc>") for e, n, side in POINTS]), "course.gpx")
    north = 25.0 - 9.0 * np.arange(0.0, 8.0, 0.1)
    way = gpx([(2.0, float(n), f"{i / 10.0!r}") for i, n in enumerate(north)])
    rows = [f"{time},{lat},{lon}" for lat, lon, time in re.findall(r'lat="([^"]+)" lon="([^"]+)">([^<]+)<', way)]
    track = read_track(written(tmp_path, "\n".join(["time,lat,lon", *rows]), "track.csv"))
    course = read_course(file)
    result = time_gates(course, track)
    assert [each.outcome for each in result.passages] == ["passed"] * 4
    shared = read_track(tmp_path / "track.csv", origin=GeodeticPoint(course.latitude_deg, course.longitude_deg))  # type: ignore[arg-type]
    assert result.times == pytest.approx(list(time_gates(course, shared).times), abs=1e-6)
    assert result.times[1] == pytest.approx(37.0 / 9.0, abs=1e-3)
    with raises(ParameterError, "no_origin"):
        time_gates(course, replace(track, origin=None))


def test_gates_that_lead_back_to_one_place_have_no_direction() -> None:
    places = (("a", (0.0, 0.0)), ("b", (10.0, 0.0)), ("c", (0.0, 0.0)))
    gates = tuple(Gate(name=name, turning=place, side="left") for name, place in places)
    with raises(ParameterError, "same_place", name="b"):
        Course(gates=gates)


def test_gates_without_a_height_lie_on_the_ellipsoid(tmp_path: Path) -> None:
    """East of 47° N, 11° E by 0.001°: N cos φ sin Δλ, N = a/√(1 - e² sin² φ)."""
    points = "".join(f'<wpt lat="47" lon="{lon}"><desc>left</desc></wpt>' for lon in ("11", "11.001"))
    found = read_course(written(tmp_path, f"<gpx>{points}</gpx>", "course.gpx"))
    normal = 6378137.0 / math.sqrt(1.0 - 0.00669437999014 * math.sin(math.radians(47.0)) ** 2)
    east = normal * math.cos(math.radians(47.0)) * math.sin(math.radians(0.001))
    assert found.gates[1].turning[0] == pytest.approx(east, rel=1e-8)
