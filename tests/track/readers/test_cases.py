"""One path in every format, and damaged files."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow.track.read import read_track
from skisnow.track.summary import TrackSummary, track_summary
from skisnow.track.track import FLAGS, Track
from tests.fuzzing.registry import BY_NAME
from tests.fuzzing.track_files import FILES

from .receivers import fit_file, nav_pvt, sentence, ubx_frame
from .test_nmea import gga
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
def test_mutated_files(tmp_path: Path, name: str) -> None:
    """Cases beyond those of tests/fuzzing; half of the binary ones have right checksums."""
    (tmp_path / name).write_bytes(FILES[name])
    assert require_track_or_our_error(tmp_path / name)
    for number in range(1000, 1050):
        (tmp_path / name).write_bytes(BY_NAME[f"track {name}"].mutated(number))
        require_track_or_our_error(tmp_path / name)


@pytest.mark.parametrize("kind", ["csv", "gpx", "fit", "nmea", "ubx", "rtklib"])
@pytest.mark.parametrize("data", [b"", b"\xff\xfe\x00", b"\x81", "\x85\u2028".encode(), b"\x00" * 300])
def test_anything_at_all(tmp_path: Path, kind: str, data: bytes) -> None:
    (tmp_path / "anything").write_bytes(data)
    assert not require_track_or_our_error(tmp_path / "anything", kind)


@pytest.mark.parametrize("size", [0, 10, 84, 92])
def test_messages_of_any_size_sealed_with_a_right_checksum(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.ubx"
    path.write_bytes(nav_pvt() + ubx_frame(b"\x01\x07", b"\x07" * size))
    assert require_track_or_our_error(path)


@pytest.mark.parametrize("cells", ["GNGNS,155114.20", "GNZDA,155114.20,99,99,1", "GNRMC", "GNGST,nan,1e999,-1"])
def test_short_sentences_sealed_with_a_right_checksum(tmp_path: Path, cells: str) -> None:
    path = tmp_path / "a.nmea"
    path.write_bytes(gga() + sentence(cells) + gga("155115.00"))
    assert require_track_or_our_error(path)


@pytest.mark.parametrize("values", [(2**31 - 2, -(2**31)), (0, 0), (2**30, 2**30)])
def test_numbers_that_a_receiver_may_send(tmp_path: Path, values: tuple[int, int]) -> None:
    path = tmp_path / "a.ubx"
    path.write_bytes(nav_pvt(lat=values[0], lon=values[1]))
    require_track_or_our_error(path)
    path = tmp_path / "a.fit"
    path.write_bytes(fit_file([RECORDS[0] | {"position_lat": values[0], "position_long": values[1]}]))
    require_track_or_our_error(path)
