"""Recordings of the SnowMicroPen and density records of a campaign."""

import csv
import math
import struct
from collections import Counter
from datetime import UTC, date, datetime
from pathlib import Path

import numpy as np
import pytest
from tests.present import present

from skisnow._support.errors import FieldDataError
from skisnow.campaign.snow_micro_pen import read_snow_micro_pen
from skisnow.campaign.snow_pit import read_density_layers

from .recordings import LONG, SHORT, built, recording

PITS = {LONG: "DB_SSA_2S16.csv", SHORT: "DB_SSA_1S17.csv"}


def test_a_recording_built_by_hand(tmp_path: Path) -> None:
    path = tmp_path / "S31M0067_20190302.pnt"
    path.write_bytes(built([0, 40, -4, 32767]))
    profile = read_snow_micro_pen(path)
    # 0.004 mm a sample, 0.0025 N a count; both stored in single precision, 6e-8
    np.testing.assert_allclose(profile.depth, [0.0, 4e-6, 8e-6, 12e-6], rtol=1e-7)
    np.testing.assert_allclose(profile.force, [0.0, 0.1, -0.01, 81.9175], rtol=1e-7)
    assert (profile.firmware, profile.announced_samples, profile.force_offset) == (301, 9, 7)
    assert (profile.latitude_deg, profile.longitude_deg, profile.height) == (-45.5, 170.25, 2120.0)
    assert (profile.dilution_of_precision, profile.satellites, profile.fix_mode) == (1.5, 8, 3)
    assert (profile.name, profile.comment) == ("S31M0067", "near hut!")
    assert (profile.sensor_serial, profile.amplifier_serial) == ("1234 SN5", "AMP 6")
    assert (profile.instrument_serial, profile.overload_N) == (31, 40)
    assert profile.tip_diameter == pytest.approx(0.005)
    assert profile.instrument_length == pytest.approx(1.236)
    assert profile.speed == pytest.approx(0.020)
    assert profile.clock == datetime(2019, 3, 2, 11, 30, 59, tzinfo=UTC)
    assert profile.date_in_file_name == date(2019, 3, 2)


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
    profile = read_snow_micro_pen(path)
    assert profile.clock is None
    assert profile.date_in_file_name is None
    assert profile.recorded_on is None


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
    assert profile.name.startswith(f"S{profile.instrument_serial}M")
    assert profile.announced_samples > count


def test_lengths_of_the_real_recordings() -> None:
    # 242 samples a millimetre; the first went its full metre, the second stopped at 0.31 m
    assert read_snow_micro_pen(recording(LONG)).depth[-1] == pytest.approx(1.000, abs=1e-4)
    assert read_snow_micro_pen(recording(SHORT)).depth[-1] == pytest.approx(0.311, abs=1e-3)
    assert len(read_snow_micro_pen(recording(LONG)).force) == 242_000


@pytest.mark.parametrize("name", [LONG, SHORT])
def test_real_clock_is_1024_weeks_behind_the_file_name(name: str) -> None:
    profile = read_snow_micro_pen(recording(name))
    assert present(profile.clock).date() == date(2000, 6, 24)
    assert profile.date_in_file_name == profile.recorded_on == date(2020, 2, 8)


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
    assert 1.0 < profile.force.max() < profile.overload_N
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
        (">h", 386, -1, "instrument_length_mm"),
        (">f", 6, math.nan, "sample_distance_mm"),
        (">f", 10, math.inf, "force_per_count"),
    ],
)
def test_numbers_that_no_instrument_has(tmp_path: Path, form: str, offset: int, value: float, name: str) -> None:
    data = bytearray(built([100, 200, 300]))
    struct.pack_into(form, data, offset, value)
    path = tmp_path / "a.pnt"
    path.write_bytes(data)
    with pytest.raises(FieldDataError, match=f"found '{name} "):
        read_snow_micro_pen(path)


REAL = Path(__file__).resolve().parents[3] / "shared" / "data" / "pit-density" / "pit_density.csv"
HEADER = "ID,TOP,BOTTOM,RHO,NOTES,TYPE\n"


def written(folder: Path, text: str) -> Path:
    path = folder / "pits.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_small_file(tmp_path: Path) -> None:
    text = HEADER + "1,52,49,416,-9999,R\n1,11.5,5,381.5,Ice in sample,I\n"
    layers = read_density_layers(written(tmp_path, text))
    assert layers.pit == ("1", "1")
    np.testing.assert_allclose(layers.top, [0.52, 0.115], rtol=1e-15)
    np.testing.assert_allclose(layers.bottom, [0.49, 0.05], rtol=1e-15)
    np.testing.assert_allclose(layers.thickness, [0.03, 0.065], rtol=1e-13)
    assert layers.snow_density.tolist() == [416.0, 381.5]
    assert layers.note == ("", "Ice in sample")
    assert layers.kind == ("R", "I")
    assert layers.row.tolist() == [2, 3]


def test_the_real_file() -> None:
    if not REAL.exists():
        pytest.skip("the shared pit densities are not beside this repository")
    layers = read_density_layers(REAL)
    assert len(layers) == 219
    assert len(set(layers.pit)) == 26
    with REAL.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert sum(layers.snow_density) == pytest.approx(sum(float(row["RHO"]) for row in rows), rel=1e-12)
    assert (layers.snow_density.min(), layers.snow_density.max()) == (120.0, 494.0)
    assert Counter(layers.kind) == {"F": 88, "H": 86, "R": 36, "I": 6, "N": 3}
    assert Counter(layers.note) == {"": 213, "Ice in sample": 6}
    assert layers.row[-1] == 220
    assert np.all(layers.thickness > 0)
    assert layers.top.max() < 1.0  # metres, no centimetres


@pytest.mark.parametrize(
    ("cells", "code", "column"),
    [
        ("1,49,52,416,-9999,R", "out_of_range", "TOP"),
        ("1,49,49,416,-9999,R", "out_of_range", "TOP"),
        ("1,52,-1,416,-9999,R", "out_of_range", "BOTTOM"),
        ("1,52,49,918,-9999,R", "out_of_range", "RHO"),
        ("1,52,49,0,-9999,R", "out_of_range", "RHO"),
        ("1,52,49,heavy,-9999,R", "not_a_number", "RHO"),
        ("1,52,,416,-9999,R", "not_a_number", "BOTTOM"),
        (",52,49,416,-9999,R", "out_of_range", "ID"),
    ],
)
def test_wrong_cells_are_named(tmp_path: Path, cells: str, code: str, column: str) -> None:
    path = written(tmp_path, HEADER + "1,52,49,416,-9999,R\n" + cells + "\n")
    with pytest.raises(FieldDataError) as caught:
        read_density_layers(path)
    (problem,) = caught.value.problems
    found = (problem.code, problem.file, problem.row, problem.column)  # type: ignore[attr-defined]
    assert found == (code, "pits.csv", 3, column)


def test_a_missing_column_is_named(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match=r"missing_column.*RHO"):
        read_density_layers(written(tmp_path, "ID,TOP,BOTTOM\n1,52,49\n"))


def test_empty_missing_and_binary_files_are_rejected(tmp_path: Path) -> None:
    with pytest.raises(FieldDataError, match="empty_file"):
        read_density_layers(written(tmp_path, ""))
    with pytest.raises(FieldDataError, match=r"gone\.csv"):
        read_density_layers(tmp_path / "gone.csv")
    (tmp_path / "pits.csv").write_bytes(bytes(100))
    with pytest.raises(FieldDataError, match="unreadable_file"):
        read_density_layers(tmp_path / "pits.csv")
