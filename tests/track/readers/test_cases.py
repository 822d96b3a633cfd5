"""One path in every format, and damaged files."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import FieldDataError
from skisnow.track.read import read_track
from skisnow.track.track import FLAGS, Track

from .receivers import fit_file, nav_pvt, sentence, ubx_frame
from .test_nmea import gga
from .test_ubx import RECORDS

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "track"
BEGIN = datetime(2024, 2, 10, 10, tzinfo=UTC)


def case(name: str) -> Track:
    if not (CASES / name).exists():
        pytest.skip("the recorded files are not next to the repository")
    return read_track(CASES / name)


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


def require_track_or_our_error(path: Path) -> bool:
    """Whether a track was read."""
    try:
        track = read_track(path)
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


@pytest.mark.parametrize("ending", ["csv", "gpx", "fit", "nmea", "ubx", "pos"])
@pytest.mark.parametrize("data", [b"", b"\xff\xfe\x00", b"\x81", "\x85\u2028".encode(), b"\x00" * 300])
def test_anything_at_all(tmp_path: Path, ending: str, data: bytes) -> None:
    path = tmp_path / f"anything.{ending}"
    path.write_bytes(data)
    assert not require_track_or_our_error(path)


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
