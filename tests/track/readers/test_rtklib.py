"""Tracks from RTKLIB's solution files."""

import math
from datetime import datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest

from tests.present import present

from .. import metres_per_degree
from .test_table import read, refused

PREAMBLE = "% program   : RTKPOST ver.2.4.3 b34\n% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,5:single)\n"
COLUMNS = (
    "latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m)"
    " age(s)  ratio"
)
TAIL = "1  12   0.0080   0.0060   0.0150   0.0010  -0.0020   0.0030   0.00   99.9"
LLH = (
    f"{PREAMBLE}%  GPST                  {COLUMNS}\n"
    f"2022/12/27 15:51:14.000   47.000000000   11.000000000  1500.0000   {TAIL}\n"
    f"2022/12/27 15:51:14.200   47.000010000   11.000000000  1499.5000   {TAIL}\n"
)


def test_latitude_longitude_height(tmp_path: Path) -> None:
    for name in ("a.pos", "solution.txt"):
        track = read(tmp_path, LLH, name)
        assert (track.time_scale, track.start) == ("GPS", datetime(2022, 12, 27, 15, 51, 14))
        np.testing.assert_allclose(track.time, [0.0, 0.2], atol=1e-9)
        north = 1e-5 * metres_per_degree.north(47.0) * (1 + 1500 / 6.37e6)
        np.testing.assert_allclose(track.place, np.array([[0.0, 0.0, 0.0], [0.0, north, -0.5]]), atol=1e-5)
        np.testing.assert_array_equal(track.place_sd, [[0.006, 0.008, 0.015]] * 2)
        assert track.velocity is None
        assert np.isnan(track.speed).all()
        assert "above the ellipsoid" in track.frame


def test_carrier_phase(tmp_path: Path) -> None:
    """Q: 1 fix, 2 float, 3 SBAS, 4 DGPS, 5 single, 6 PPP."""
    rows = [f"2022/12/27 15:51:1{q}.000 47.0 11.0 1500.0 {q}{TAIL[1:]}" for q in range(1, 7)]
    track = read(tmp_path, "\n".join([*LLH.splitlines()[:3], *rows]), "a.pos")
    assert present(track.solution).tolist() == ["fixed", "float", "code", "code", "code", "float"]
    assert track.flagged == {"float_solution": 2, "code_solution": 3}


def test_standard_deviation_of_the_speed_and_velocities(tmp_path: Path) -> None:
    """Along a slow velocity (0.6 north, -0.8 east), with the covariance as RTKLIB writes it: its root with its sign."""
    names = "    vn(m/s)    ve(m/s)    vu(m/s)      sdvn     sdve     sdvu    sdvne    sdveu    sdvun"
    lines = LLH.splitlines()
    rows = [f"{lines[3]} .3 -.4 0 .03 .04 .5 .02 .1 .1", f"{lines[4]} 0 0 0 .03 .04 .5 -.02 0 0"]
    track = read(tmp_path, "\n".join([*lines[:2], lines[2] + names, *rows]), "a.pos")
    wanted = math.sqrt((0.6 * 0.03) ** 2 + (0.8 * 0.04) ** 2 - 2.0 * 0.48 * 0.02**2)
    np.testing.assert_allclose(present(track.speed_sd), [wanted, 0.5], rtol=1e-9)
    unknown = read(tmp_path, "\n".join([*lines[:2], lines[2] + names, f"{lines[3]} 3 -4 0 9e9 9e9 9e9 0 0 0"]), "b.pos")
    assert np.isnan(present(unknown.speed_sd)).all()
    lines = LLH.splitlines()
    text = "\n".join([*lines[:2], lines[2] + names, *(f"{line} 3 -4 -1.2 .1 .1 .1 0 0 0" for line in lines[3:])])
    track = read(tmp_path, text, "a.pos")
    np.testing.assert_allclose(present(track.velocity), [[-4.0, 3.0, -1.2]] * 2, atol=1e-6)
    np.testing.assert_allclose(track.speed, math.sqrt(25 + 1.44), rtol=1e-12)


def test_commas_and_week_with_seconds(tmp_path: Path) -> None:
    """Week 2242 began on 2022-12-25; 15:51:14 of the Tuesday is 2 × 86400 + 57074 = 229874 s of it."""
    head = ",".join(["%  GPST", *COLUMNS.split()])
    row = ",".join(["2242", "229874.000", "47.0", "11.0", "1500.0", *TAIL.split()])
    track = read(tmp_path, f"{head}\n{row}\n", "a.pos")
    assert track.start == datetime(2022, 12, 27, 15, 51, 14)
    np.testing.assert_array_equal(track.place_sd, [[0.006, 0.008, 0.015]])


@pytest.mark.parametrize("when", ["10001 10.000", "-1 10.000", "2242 604801.000", "2242 -1.000"])
def test_a_week_has_604800_seconds_and_there_are_10000_weeks(tmp_path: Path, when: str) -> None:
    message = refused(tmp_path, f"%  GPST  {COLUMNS}\n{when}   47.0  11.0  1500.0  {TAIL}\n", "a.pos")
    assert "week and seconds" in message


@pytest.mark.parametrize(
    "head", [COLUMNS.replace("(deg)", "(d'\")"), "x-ecef(m) y-ecef(m) z-ecef(m) Q", "e-baseline(m) n-baseline(m) Q"]
)
def test_other_forms_of_places_are_rejected(tmp_path: Path, head: str) -> None:
    message = refused(tmp_path, f"%  GPST  {head}\n2022/12/27 15:51:14.000 1 2 3 4 5 6 1\n", "a.pos")
    assert "missing_column" in message and "decimal degrees" in message


def test_times_of_japan(tmp_path: Path) -> None:
    track = read(tmp_path, f"%  JST  {COLUMNS}\n2022/12/27 15:51:14.000 47.0 11.0 1500.0 {TAIL}\n", "a.pos")
    assert (track.start, track.time_scale) == (
        datetime(2022, 12, 27, 15, 51, 14, tzinfo=timezone(timedelta(hours=9))),
        "JST",
    )


def test_no_solution_is_marked(tmp_path: Path) -> None:
    track = read(tmp_path, LLH.replace("1499.5000   1", "1499.5000   0"), "a.pos")
    assert (len(track), list(track.left_out.values())) == (1, [1])


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("latitude(deg)", "", ["missing_column", "header line"]),
        ("longitude(deg)", "", ["missing_column", "longitude"]),
        ("latitude(deg)", "\nlatitude(deg)", ["missing_column", "header line"]),
        ("47.000010000", "4x", ["not_a_number", "row 5", "'4x'"]),
        ("47.000010000", "470.0", ["out_of_range", "row 5, column latitude", "'470'"]),
        ("15:51:14.200", "15:99:14.200", ["not_a_time", "row 5", "column GPS"]),
        ("15:51:14.200", "15:51:13.200", ["time_backwards", "row 5"]),
        ("1499.5000   " + TAIL, "1499", ["too_few_cells", "row 5", "13 numbers"]),
    ],
)
def test_refused(tmp_path: Path, old: str, new: str, told: list[str]) -> None:
    assert old in LLH
    message = refused(tmp_path, LLH.replace(old, new), "a.pos")
    for words in told:
        assert words in message


def test_header_only(tmp_path: Path) -> None:
    assert "empty_file" in refused(tmp_path, "".join(LLH.splitlines(keepends=True)[:3]), "a.pos")


def test_a_long_line_of_blanks_is_no_header(tmp_path: Path) -> None:
    content = "% " + "\t" * 300_000 + "\n" + LLH  # with backtracking this would take minutes
    assert len(read(tmp_path, content, "a.pos")) == 2


@pytest.mark.parametrize("value", ["1e308", "-1e308", "1.1e12"])
def test_numbers_beyond_all_solutions(tmp_path: Path, value: str) -> None:
    message = refused(tmp_path, LLH.replace("0.0060", value, 1), "a.pos")
    assert "not_a_number" in message
    assert value in message


@pytest.mark.parametrize(
    ("row", "why"),
    [
        ("2022/12/27 15:51:14.400", "too_few_cells"),
        ("2022/12/27 15:51:14.400 47.0", "too_few_cells"),
        ("2022/12/27", "not_a_time"),
        ("2022/12/27 noon 47.0 11.0 1500.0", "not_a_time"),
    ],
)
def test_a_row_that_is_cut_short_is_reported_by_what_is_missing(tmp_path: Path, row: str, why: str) -> None:
    message = refused(tmp_path, f"{LLH}{row}\n", "a.pos")
    assert f"error {why}: " in message
    assert f"row {len(LLH.splitlines()) + 1}" in message


@pytest.mark.parametrize("word", ["-nan(ind)", "nan", "inf", "-inf", "1.#QNAN", "*****", "1e300", "9" * 400])
@pytest.mark.parametrize("cell", [3, 13, 14])
def test_unreadable_cell_of_a_column_that_is_not_used(tmp_path: Path, word: str, cell: int) -> None:
    """The number of satellites, the age and the ratio are not used: the row is flagged and read."""
    lines = LLH.splitlines()
    number = next(place for place, line in enumerate(lines) if not line.startswith("%"))
    cells = lines[number].split()
    cells[{3: 6, 13: 13, 14: 14}[cell]] = word
    changed = "\n".join([*lines[:number], " ".join(cells), *lines[number + 1 :]])
    track, plain = read(tmp_path, changed, "a.pos"), read(tmp_path, LLH, "b.pos")
    assert track.flagged == {**plain.flagged, "not_finite": 1}
    np.testing.assert_array_equal(track.place, plain.place)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\u0085", "\u2028"])
def test_any_line_end_and_case(tmp_path: Path, end: str) -> None:
    plain = read(tmp_path, LLH, "b.pos")
    for text in (LLH, "\ufeff" + LLH.upper()):
        track = read(tmp_path, text.replace("\n", end), "a.pos")
        np.testing.assert_array_equal(track.place, plain.place)
        assert track.time_scale == plain.time_scale
