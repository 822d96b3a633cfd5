"""Files of every format, damaged at random: they are refused in our own words or read with marks, nothing else."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from skisnow._support.errors import FieldDataError
from skisnow.track.read import read_track
from skisnow.track.track import FLAGS

from .receivers import fit_checksum, fit_file, nav_pvt, sentence, ubx_frame
from .test_fit import RECORDS
from .test_gpx import gpx, point
from .test_nmea import gga, rmc
from .test_rtklib import BASELINE, EARTH, LLH
from .test_table import LOCAL

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
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
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


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
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
