"""Recordings of the SnowMicroPen."""

import csv
import math
import struct
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from tests.present import present

from skisnow._support.errors import FieldDataError
from skisnow.campaign.snow_micro_pen import read_snow_micro_pen, snow_surface

from .recordings import LONG, SHORT, built, recording

PITS = {LONG: "DB_SSA_2S16.csv", SHORT: "DB_SSA_1S17.csv"}


def test_a_recording_built_by_hand(tmp_path: Path) -> None:
    path = tmp_path / "S31M0067_20191224.pnt"
    path.write_bytes(built([0, 40, -4, 32767]))
    profile = read_snow_micro_pen(path)
    # 0.004 mm a sample, 0.0025 N a count; both stored in single precision, 6e-8
    np.testing.assert_allclose(profile.depth, [0.0, 4e-6, 8e-6, 12e-6], rtol=1e-7)
    np.testing.assert_allclose(profile.force, [0.0, 0.1, -0.01, 81.9175], rtol=1e-7)
    assert (profile.latitude_deg, profile.longitude_deg, profile.height) == (-45.5, 170.25, 2120.0)
    assert (profile.name, profile.comment) == ("S31M0067", "near hut!")
    assert profile.tip_diameter == pytest.approx(0.005)
    assert profile.recorded_on == date(2019, 12, 24)  # not that of the clock


@pytest.mark.parametrize(
    ("flags", "position"),
    [
        (b"NE", (45.5, 170.25)),
        (b"NW", (45.5, -170.25)),
        (b"SW", (-45.5, -170.25)),
        (b"sw", (-45.5, -170.25)),
        (b"__", (None, None)),
        (b"EN", (None, None)),
    ],
)
def test_flags_sign_the_position(tmp_path: Path, flags: bytes, position: tuple[float | None, float | None]) -> None:
    path = tmp_path / "a.pnt"
    path.write_bytes(built([1], north_east=flags))
    profile = read_snow_micro_pen(path)
    assert (profile.latitude_deg, profile.longitude_deg) == position


def test_no_date_anywhere_is_none(tmp_path: Path) -> None:
    path = tmp_path / "S31M0067_20199999.pnt"
    path.write_bytes(built([1], clock=(0, 0, 0, 0, 0, 0)))
    assert read_snow_micro_pen(path).recorded_on is None


def test_without_a_date_in_the_name_the_clock_counts(tmp_path: Path) -> None:
    path = tmp_path / "S31M0067.pnt"
    path.write_bytes(built([1]))
    assert read_snow_micro_pen(path).recorded_on == date(2019, 3, 2)


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_real_recording_against_its_bytes(name: str) -> None:
    path = recording(name)
    raw = path.read_bytes()
    profile = read_snow_micro_pen(path)
    count = int.from_bytes(raw[358:362], "big", signed=True)
    assert len(profile.force) == len(profile.depth) == count
    # padded to the next whole block of 512 bytes
    assert len(raw) == 512 * math.ceil((512 + 2 * count) / 512)
    step_mm, newton = struct.unpack(">ff", raw[6:14])
    for index in (0, 1, count // 2, count - 1):
        counts = int.from_bytes(raw[512 + 2 * index : 514 + 2 * index], "big", signed=True)
        assert profile.force[index] == pytest.approx(counts * newton, rel=1e-12)
        assert profile.depth[index] == pytest.approx(index * step_mm * 1e-3, rel=1e-12)
    assert profile.name == name.split("_")[2]


def test_lengths_of_the_real_recordings() -> None:
    # 242 samples a millimetre; the first went its full metre, the second stopped at 0.31 m
    assert read_snow_micro_pen(recording(LONG)).depth[-1] == pytest.approx(1.000, abs=1e-4)
    assert read_snow_micro_pen(recording(SHORT)).depth[-1] == pytest.approx(0.311, abs=1e-3)
    assert len(read_snow_micro_pen(recording(LONG)).force) == 242_000


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_real_recordings_have_the_day_of_the_file_name(name: str) -> None:
    """Their clocks are 1024 weeks behind."""
    assert read_snow_micro_pen(recording(name)).recorded_on == date(2020, 2, 8)


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_real_position_is_at_its_snow_pit(name: str) -> None:
    """The pit's own coordinates were surveyed apart from the instrument; they are metres away, in the west."""
    profile = read_snow_micro_pen(recording(name))
    with recording(PITS[name]).open(newline="") as stream:
        pit = next(csv.DictReader(stream))
    north = (present(profile.latitude_deg) - float(pit["latitude"])) * 111_000.0
    east = (present(profile.longitude_deg) - float(pit["longitude"])) * 111_000.0 * math.cos(math.radians(39.0))
    assert math.hypot(north, east) < 30.0
    assert profile.height is None


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_real_forces_are_those_of_snow(name: str) -> None:
    profile = read_snow_micro_pen(recording(name))
    assert abs(float(np.median(profile.force[:2000]))) < 0.1  # the first 8 mm are air
    assert 1.0 < profile.force.max() < 50.0
    assert profile.force.min() > -0.05


def test_a_recording_cut_off_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "cut.pnt"
    path.write_bytes(built([1] * 300)[: 512 + 2 * 200])
    with pytest.raises(FieldDataError, match=r"cut\.pnt.*912.*1112"):
        read_snow_micro_pen(path)


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"", "empty_file"),
        (b"short", "unreadable_file"),
        (b"time_s,force_N\n" + b"0.1,0.2\n" * 200, "unreadable_file"),
        (bytes(4096), "unreadable_file"),
        (b"\xff" * 4096, "unreadable_file"),
        (built([]), "unreadable_file"),
    ],
)
def test_foreign_files_are_rejected(tmp_path: Path, content: bytes, code: str) -> None:
    path = tmp_path / "foreign.PNT"
    path.write_bytes(content)
    with pytest.raises(FieldDataError, match=r"foreign\.PNT") as caught:
        read_snow_micro_pen(path)
    assert [problem.code for problem in caught.value.problems] == [code]  # type: ignore[attr-defined]


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match=r"gone\.pnt"):
        read_snow_micro_pen(tmp_path / "gone.pnt")


@pytest.mark.parametrize(
    ("form", "offset", "value", "name"),
    [
        (">f", 64, math.nan, "speed_mm_per_s"),
        (">f", 64, -20.0, "speed_mm_per_s"),
        (">f", 64, math.inf, "speed_mm_per_s"),
        (">f", 64, 2e4, "speed_mm_per_s"),
        (">i", 376, -5000, "tip_diameter_um"),
        (">i", 376, 2**31 - 1, "tip_diameter_um"),
        (">i", 376, 100_001, "tip_diameter_um"),
        (">h", 386, -1, "instrument_length_mm"),
        (">h", 386, 10_001, "instrument_length_mm"),
        (">f", 6, math.nan, "sample_distance_mm"),
        (">f", 6, 0.9e-4, "sample_distance_mm"),
        (">f", 6, 1.1, "sample_distance_mm"),
        (">f", 10, math.inf, "force_per_count"),
        (">f", 10, 0.9e-6, "force_per_count"),
        (">f", 10, 1.1, "force_per_count"),
    ],
)
def test_numbers_that_no_instrument_has(tmp_path: Path, form: str, offset: int, value: float, name: str) -> None:
    data = bytearray(built([100, 200, 300]))
    struct.pack_into(form, data, offset, value)
    path = tmp_path / "a.pnt"
    path.write_bytes(data)
    with pytest.raises(FieldDataError, match=f"found '{name} "):
        read_snow_micro_pen(path)


@pytest.mark.parametrize(
    ("form", "offset", "limits"),
    [
        (">f", 6, (1.001e-4, 1.0)),
        (">f", 10, (1.001e-6, 1.0)),
        (">f", 64, (0.0, 1000.0)),
        (">i", 376, (0, 100_000)),
        (">h", 386, (0, 10_000)),
    ],
)
def test_numbers_up_to_the_limits_are_read(tmp_path: Path, form: str, offset: int, limits: tuple[float, float]) -> None:
    for value in limits:
        data = bytearray(built([100, 200, 300]))
        struct.pack_into(form, data, offset, value)
        (tmp_path / "a.pnt").write_bytes(data)
        assert len(read_snow_micro_pen(tmp_path / "a.pnt").force) == 3


def test_a_comment_ends_at_its_length_and_the_height_may_be_unknown(tmp_path: Path) -> None:
    for length, comment in ((4, "near"), (-1, ""), (102, "near hut!and filling")):
        data = bytearray(built([1]))
        struct.pack_into(">h", data, 152, length)
        for height, metres in ((99_999.0, None), (math.nan, None), (0.0, 0.0), (99_998.0, pytest.approx(999.98))):
            struct.pack_into(">f", data, 272, height)
            (tmp_path / "a.pnt").write_bytes(data)
            profile = read_snow_micro_pen(tmp_path / "a.pnt")
            assert (profile.comment, profile.height) == (comment, metres)


@pytest.mark.parametrize(
    ("latitude", "longitude", "position"),
    [
        (90.0, 180.0, (-90.0, 180.0)),
        (-45.0, -10.0, (-45.0, 10.0)),
        (90.5, 10.0, (None, None)),
        (45.0, 180.5, (None, None)),
        (0.0, 0.0, (None, None)),
        (0.0, 10.0, (0.0, 10.0)),
        (10.0, 0.0, (-10.0, 0.0)),
    ],
)
def test_limits_of_positions(
    tmp_path: Path, latitude: float, longitude: float, position: tuple[float | None, float | None]
) -> None:
    data = bytearray(built([1]))
    struct.pack_into(">2f", data, 264, latitude, longitude)
    (tmp_path / "a.pnt").write_bytes(data)
    profile = read_snow_micro_pen(tmp_path / "a.pnt")
    assert (profile.latitude_deg, profile.longitude_deg) == position


@pytest.mark.parametrize(
    ("name", "day"),
    [
        ("S_20200208_20210101.pnt", date(2020, 2, 8)),
        ("S_20209908_20210131.pnt", date(2021, 1, 31)),
        ("S_202002081.pnt", date(2019, 3, 2)),
        ("S_2020020.pnt", date(2019, 3, 2)),
    ],
)
def test_days_in_names(tmp_path: Path, name: str, day: date) -> None:
    (tmp_path / name).write_bytes(built([1]))
    assert read_snow_micro_pen(tmp_path / name).recorded_on == day


@pytest.mark.parametrize(
    ("air_mm", "snow_mm", "surface"),
    [(5.0, 10.0, 5.0), (4.5, 10.0, 5.0), (2.0, 10.0, None), (30.0, 5.5, 30.0), (30.0, 5.0, None), (30.0, 0.0, None)],
)
def test_least_lengths_of_air_and_snow(air_mm: float, snow_mm: float, surface: float | None) -> None:
    """Blocks of 0.5 mm: the median of 5 mm is air, and a block more than the hold of 5 mm is snow."""
    force = np.concatenate([np.full(round(10 * air_mm), 0.05), np.full(round(10 * snow_mm), 0.0601)])
    found = snow_surface(force, 1e-4, rise=0.01, hold=5e-3)
    depth = None if found is None else (found.depth * 1e3, found.air_force)
    assert depth == (None if surface is None else pytest.approx((surface, 0.05)))


def test_air_is_the_median_of_the_20_mm_before() -> None:
    """Earlier air at 0.5 N does not count, and half of the 20 mm decides."""
    force = np.concatenate([np.full(300, 0.5), np.full(195, 0.05), np.full(100, 0.3)])
    found = snow_surface(force, 1e-4, rise=0.01, hold=5e-3)
    assert found is not None
    assert (found.depth, found.air_force) == pytest.approx((0.0495, 0.05))
