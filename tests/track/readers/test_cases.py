"""One path in every format, and damaged files."""

from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from skisnow._support.errors import FieldDataError
from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, track_summary
from skisnow.track.track import FLAGS, Track

from .receivers import fit_checksum, fit_file, nav_pvt, sentence, ubx_frame
from .test_gpx import gpx, point
from .test_nmea import gga, rmc
from .test_rtklib import BASELINE, EARTH, LLH
from .test_table import LOCAL
from .test_ubx import RECORDS

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "track"
BEGIN = datetime(2024, 2, 10, 10, tzinfo=UTC)


def case(name: str) -> Track:
    if not (CASES / name).exists():
        pytest.skip("the recorded files are not next to the repository")
    return read_track(CASES / name)


def summary(name: str) -> TrackSummary:
    return track_summary(case(name))


def test_speeds_at_every_tenth_point() -> None:
    found = summary("gga-10hz-rmc-1hz.nmea")
    assert found.distances["recorded speed"] == pytest.approx(299.0, abs=0.1)
    assert found.max_speed == pytest.approx(10.0, abs=0.05)


@pytest.mark.parametrize("name", ["gns.nmea", "no-checksums.nmea", "rawx_first.ubx", "date-2005-before-fix.nmea"])
def test_same_path_however_it_is_written(name: str) -> None:
    """All have a point each second; the path is that of the two sentences in half seconds, at half the speed."""
    track, twice_as_fast = case(name), case("joined-lines.nmea")
    assert (len(track), track.start) == (100, BEGIN)
    np.testing.assert_allclose(track.time, np.arange(100.0), atol=1e-6)
    np.testing.assert_allclose(track.place[:, :2], twice_as_fast.place[:, :2], atol=1e-3)
    assert np.isfinite(track.speed).all()


@pytest.mark.parametrize("name", ["joined-lines.nmea", "cr-only.nmea"])
def test_every_sentence_is_read(name: str) -> None:
    track = case(name)
    assert (len(track), track.start, track.left_out) == (100, BEGIN, {})
    assert np.isfinite(track.speed).all()


def test_only_points_with_a_fix_count() -> None:
    found = summary("no-fix-start.nmea")
    assert (len(found.track), float(found.track.time[-1]), found.track.start) == (60, 59.0, BEGIN)
    assert found.distances["recorded speed"] == pytest.approx(590.0, abs=0.1)
    assert sum(found.track.left_out.values()) == 60


@pytest.mark.parametrize(("name", "begins"), [("segments.gpx", 3600.0), ("segments_short.gpx", 125.0)])
def test_segments_are_not_joined(name: str, begins: float) -> None:
    found = summary(name)
    assert [(run.start, run.end) for run in found.day.runs] == [(0.0, 120.0), (begins, begins + 120.0)]
    assert [run.last - run.first + 1 for run in found.day.runs] == [121, 121]
    assert [run.distance for run in found.day.runs] == pytest.approx([1236.0, 1236.0], rel=3e-3)
    assert found.distances["places"] == pytest.approx(2 * 1236.0, rel=3e-3)
    assert found.day.lifts == ()


def test_bytes_after_the_end_of_a_fit_file() -> None:
    track = case("trailing_ff.fit")
    assert len(track) == 22
    assert len(track.notes) == 1


def test_serial_numbers_of_a_spreadsheet() -> None:
    track = case("excel_serial.csv")
    assert track.start == BEGIN.replace(tzinfo=None)
    np.testing.assert_allclose(np.diff(track.time), 1.0, atol=2e-3)
    assert len(track.notes) == 1


def test_headings_in_capitals() -> None:
    capitals = case("Caps.csv")
    assert (len(capitals), capitals.start) == (120, BEGIN)
    np.testing.assert_allclose(capitals.place[:, 2] - capitals.place[0, 2], -2.5 * np.arange(120.0), atol=0.2)


def test_whole_seconds_at_25_points_a_second() -> None:
    found = summary("dup25.gpx")
    np.testing.assert_allclose(np.diff(found.track.time), 0.04, atol=1e-9)
    assert found.max_speed == pytest.approx(10.0, abs=0.1)


@pytest.mark.parametrize("name", ["turns_T10_1hz.gpx", "turns_T4_1hz.gpx"])
def test_highest_speed_and_length_of_linked_turns(name: str) -> None:
    found = summary(name)
    assert found.max_speed == pytest.approx(12.0, rel=0.03)
    assert found.max_speed is not None
    assert found.max_speed_interval is not None
    assert found.max_speed_interval[0] < found.max_speed < found.max_speed_interval[1]
    assert found.horizontal_distance is not None
    steps = np.diff(found.track.place, axis=0)
    assert found.distances["places"] >= float(np.sum(np.linalg.norm(steps, axis=1)))
    assert found.horizontal_distance.value >= float(np.sum(np.hypot(steps[:, 0], steps[:, 1])))
    assert found.horizontal_distance.value == pytest.approx(12.0 * 119.0, rel=3e-3)


@pytest.mark.parametrize("name", ["nan_ind.pos", "inf_ratio.pos"])
def test_columns_that_are_not_used_may_be_not_finite(name: str) -> None:
    track = case(name)
    assert (len(track), track.flagged) == (200, {"not_finite": 1})
    assert track.usable.all()


TAIL = "1 12 0.01 0.02 0.03 0.0 0.0 0.0 0.0 99.9 1.5 -0.5 2.5 .1 .1 .1 0 0 0"
FILES = {
    "local.csv": LOCAL.encode(),
    "semicolons.csv": LOCAL.replace(",", ";").replace(".", ",").encode("utf-16"),
    "earth.csv": b"time,lat,lon,alt_m,speed_mps\n2022-12-27T15:51:14Z,46,7,0,3.5\n2022-12-27T15:51:15Z,46,7,1,4\n",
    "watch.gpx": gpx(point(47.0, "14Z") + point(47.0001, "14.5Z"), point(47.0, "30Z")).encode(),
    "watch.fit": fit_file(RECORDS),
    "receiver.nmea": rmc() + gga() + rmc("155114.20") + gga("155114.20"),
    "receiver.ubx": nav_pvt(second=1) + nav_pvt(second=2) + nav_pvt(second=3),
    "llh.pos": LLH.encode(),
    "earth.pos": f"{EARTH}2022/12/27 15:51:14.000 4.2e6 1.7e5 4.78e6 {TAIL}\n".encode(),
    "base.pos": b"% ref pos : 47.0 11.0 1500.0\n" + BASELINE.encode(),
}
BYTES = st.one_of(
    st.binary(max_size=6), st.sampled_from([b",", b"9", b"-", b"e99", b"\n", b"nan", b"\xff", b"\x00", b"<"])
)
Damage = Callable[[bytes], bytes]


@st.composite
def damages(draw: st.DrawFn) -> Damage:
    """Cut out a piece somewhere and put other bytes there, once or a few times."""
    places = draw(st.lists(st.tuples(st.floats(0, 1), st.integers(0, 12), BYTES), min_size=1, max_size=4))
    end = draw(st.one_of(st.none(), st.floats(0, 1)))

    def damage(data: bytes) -> bytes:
        for share, length, new in places:
            begin = int(share * len(data))
            data = data[:begin] + new + data[begin + length :]
        return data if end is None else data[: int(end * len(data))]

    return damage


def require_track_or_our_error(path: Path, kind: str | None = None) -> bool:
    """Whether a track was read."""
    try:
        track = read_track(path, kind=kind)  # type: ignore[arg-type]
    except FieldDataError as error:
        message = str(error)
        assert path.name in message
        assert "allowed: " in message
        return False
    n = len(track)
    assert n > 0
    assert track.place.shape == (n, 3)
    assert track.speed.shape == (n,)
    assert (np.diff(track.time) >= 0.0).all()
    assert np.isfinite(track.time).all()
    assert not np.isinf(track.place).any()
    assert set(track.flags) == set(FLAGS)
    assert np.isfinite(track.place[track.usable, :2]).all()
    assert track.flags["no_fix"][np.isnan(track.place[:, 0])].all()
    return True


@pytest.mark.parametrize("name", FILES)
def test_whole_files_read(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(FILES[name])
    assert len(read_track(path)) == {"local.csv": 3, "semicolons.csv": 3, "watch.gpx": 3, "watch.fit": 3}.get(
        name, {"receiver.ubx": 3, "earth.pos": 1, "base.pos": 1}.get(name, 2)
    )


@pytest.mark.parametrize("name", FILES)
@settings(max_examples=50, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(damage=damages())
def test_damaged_files(tmp_path: Path, name: str, damage: Damage) -> None:
    path = tmp_path / name
    path.write_bytes(damage(FILES[name]))
    require_track_or_our_error(path)


@pytest.mark.parametrize("kind", ["csv", "gpx", "fit", "nmea", "ubx", "rtklib"])
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.one_of(st.binary(max_size=300), st.text(max_size=200).map(str.encode)))
@example(data=b"\xff\xfe\x00")
@example(data=b"\x81")
@example(data="\x85\u2028".encode())
def test_anything_at_all(tmp_path: Path, kind: str, data: bytes) -> None:
    path = tmp_path / "anything"
    path.write_bytes(data)
    require_track_or_our_error(path, kind)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    cells=st.lists(
        st.tuples(*[st.one_of(st.floats(), st.sampled_from(["", "-1", "1e8", "-0", "46"])) for _ in range(5)]),
        min_size=1,
        max_size=6,
    ),
    header=st.sampled_from(
        ["time_s,x_m,y_m,z_m,speed_m_per_s", "time,lat,lon,alt_m,speed_mps", "time_s,x_m,y_m,x_sd_m,dist_m"]
    ),
)
def test_any_numbers(tmp_path: Path, cells: list[tuple[float | str, ...]], header: str) -> None:
    path = tmp_path / "numbers.csv"
    path.write_text("\n".join([header, *(",".join(map(str, row)) for row in cells)]))
    require_track_or_our_error(path)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(payload=st.binary(max_size=110), whole=st.integers(0, 3))
@example(payload=b"", whole=1)
def test_messages_sealed_with_a_right_checksum(tmp_path: Path, payload: bytes, whole: int) -> None:
    path = tmp_path / "a.ubx"
    size = {0: len(payload), 1: 92, 2: 84, 3: 10}[whole]
    path.write_bytes(nav_pvt() + ubx_frame(b"\x01\x07", payload.ljust(size, b"\x07")[:size]))
    require_track_or_our_error(path)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    kind=st.sampled_from(["GGA", "GNS", "RMC", "VTG", "GST", "ZDA", "GSV", "ABC"]),
    cells=st.lists(
        st.one_of(
            st.sampled_from(
                ["", "155114.20", "4714.07", "N", "E", "A", "1", "-1", "nan", "1e999", "271222", "S", "99"]
            ),
            st.text(st.characters(min_codepoint=33, max_codepoint=126, exclude_characters="*,$"), max_size=8),
        ),
        max_size=16,
    ),
)
@example(kind="GNS", cells=["155114.20"])
@example(kind="ZDA", cells=["155114.20", "99", "99", "1"])
def test_sentences_sealed_with_a_right_checksum(tmp_path: Path, kind: str, cells: list[str]) -> None:
    path = tmp_path / "a.nmea"
    path.write_bytes(gga() + sentence(",".join([f"GN{kind}", *cells])) + gga("155115.00"))
    require_track_or_our_error(path)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(damage=damages())
def test_fit_files_sealed_with_right_checksums(tmp_path: Path, damage: Damage) -> None:
    path = tmp_path / "a.fit"
    body = damage(FILES["watch.fit"][14:-2])
    head = FILES["watch.fit"][:4] + len(body).to_bytes(4, "little") + b".FIT"
    sealed = head + fit_checksum(head).to_bytes(2, "little") + body
    path.write_bytes(sealed + fit_checksum(sealed).to_bytes(2, "little"))
    require_track_or_our_error(path)


@pytest.mark.parametrize("values", [(2**31 - 2, -(2**31)), (0, 0), (2**30, 2**30)])
def test_numbers_that_a_receiver_may_send(tmp_path: Path, values: tuple[int, int]) -> None:
    path = tmp_path / "a.ubx"
    path.write_bytes(nav_pvt(lat=values[0], lon=values[1]))
    require_track_or_our_error(path)
    path = tmp_path / "a.fit"
    path.write_bytes(fit_file([RECORDS[0] | {"position_lat": values[0], "position_long": values[1]}]))
    require_track_or_our_error(path)
