"""The table of gates as a file, the doubt of its times in words, and a track as the point that moves through it."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.report.race.figures import gate_gaps_drawing, last_words
from skisnow.report.race.folder import gaps_of_folders, gaps_text
from skisnow.track.course import MovingPoint, passages
from skisnow.track.course.gates_table import COLUMNS, gaps_csv, gates_csv, gates_dict, read_gate_gaps, time_warnings
from skisnow.track.course.passages import track_point
from skisnow.track.track import Axes, Track
from tests.coded import raises

from .test_passages import WIDE, along_x, course


def track(axes: Axes = "file") -> Track:
    time = np.array([0.0, 1.0, 1.0, 0.5, 2.0, 3.0])
    place = np.column_stack([10.0 * time, 0.0 * time, 0.0 * time])
    place[4] = np.nan
    return Track("t", time, place, np.full(6, np.nan), "local", "metres", axes=axes)


def test_the_file_has_its_columns_and_all_gates() -> None:
    """From x = -5 at 10 m/s past gates at 10, 20 and 30: 1.5, 2.5, 3.5 s, each a second after the one before."""
    result = passages(WIDE, along_x(), {})
    rows = list(csv.DictReader(io.StringIO(gates_csv(result))))
    assert list(rows[0]) == list(COLUMNS)
    assert [float(row["time_s"]) for row in rows] == pytest.approx([1.5, 2.5, 3.5])
    assert [float(row["split_s"]) for row in rows] == pytest.approx([1.5, 1.0, 1.0])
    assert gates_dict(result)["gate_times_s"] == pytest.approx([1.5, 2.5, 3.5])


def test_times_that_hang_on_the_way_between_points_are_told_beside_a_gate_without_any() -> None:
    time = np.arange(0.0, 3.0, 0.5)
    bent = MovingPoint(time, np.column_stack([9.0 * time + 2.0 * np.sin(3.0 * time), 0.0 * time]))
    result = passages(WIDE, bent, {})
    assert [each.outcome for each in result.passages] == ["passed", "passed", "not_reached"]
    assert result.passages[2].doubt is None
    (warning,) = time_warnings(result)
    assert "0." in warning
    assert time_warnings(passages(WIDE, along_x(), {})) == ()


def test_beyond_a_narrow_gate_is_beyond_its_outer_pole() -> None:
    """Poles at y = 0 and 0.4, gone through at 0.9."""
    narrow = course(((10.0, 0.0), "left", (10.0, 0.4)), ((20.0, -3.0), "left", (20.0, 3.0)))
    first = passages(narrow, along_x(y=0.9), {}).passages[0]
    assert "0.50 m" in first.words and "outer" in first.words
    assert first.clearance == pytest.approx(-0.5)


def test_a_track_is_the_point_at_its_usable_places_and_rising_times() -> None:
    point = track_point(track(), WIDE)
    np.testing.assert_array_equal(point.time, [0.0, 1.0, 3.0])
    with raises(ParameterError, "different_units", name="t"):
        track_point(track("east_north_up"), WIDE)


HEAD = "gate,side,outcome,time_s,split_s,speed_m_per_s,clearance_m,x_m,y_m"


def folder_of(place: Path, times: list[float | None], *, beside: float = 0.0) -> Path:
    place.mkdir()
    rows = [
        f"{i},left,{'not_reached' if time is None else 'passed'},{'' if time is None else time},,,,{10.0 * i},{beside}"
        for i, time in enumerate(times, start=1)
    ]
    (place / "gates.csv").write_text("\n".join([HEAD, *rows, ""]), encoding="utf-8")
    return place


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    """The first one loses 0.2 s up to gate 1, wins 0.3 s up to gate 3; at gate 2 the other has no time."""
    return folder_of(tmp_path / "mine", [1.2, 2.0, 2.9, None]), folder_of(tmp_path / "theirs", [1.0, None, 3.0, 4.0])


def test_gap_and_loss_at_each_gate(pair: tuple[Path, Path]) -> None:
    gaps = read_gate_gaps(*pair)
    assert gaps is not None
    assert [each.gate for each in gaps] == ["1", "2", "3", "4"]
    assert [each.gap for each in gaps] == [pytest.approx(0.2), None, pytest.approx(-0.1), None]
    assert [each.lost for each in gaps] == [pytest.approx(0.2), None, pytest.approx(-0.3), None]
    assert [each.other_outcome for each in gaps] == ["passed", "not_reached", "passed", "passed"]
    rows = gaps_csv(gaps).splitlines()
    assert rows[0].split(",")[::5] == ["gate", "gap_s"]
    assert rows[2] == "2,passed,2.0,not_reached,,,"
    assert "0.10 s ahead" in last_words(gaps, ("mine", "theirs"))


def test_terminal_and_page_tell_the_same(pair: tuple[Path, Path]) -> None:
    gaps = read_gate_gaps(*pair)
    assert gaps is not None
    lines = gaps_text(gaps, ("mine", "theirs")).splitlines()
    assert lines[2].split() == ["1", "1.20", "1.00", "+0.20", "+0.20"]
    assert lines[3].split() == ["2", "2.00", "-", "-", "-"]
    assert lines[4].split() == ["3", "2.90", "3.00", "-0.10", "-0.30"]
    page = gaps_of_folders(*pair)
    assert "0.10 s ahead" in page
    assert "2 of 4 gates" in page and "0.10 s ahead" in page


def test_the_figure_has_a_point_for_each_gate_that_both_crossed(pair: tuple[Path, Path]) -> None:
    gaps = read_gate_gaps(*pair)
    assert gaps is not None
    drawing = gate_gaps_drawing(gaps, ("mine", "theirs"))
    above, below = drawing.figure.axes
    drawn = max((line.get_xydata().tolist() for line in above.lines), key=lambda points: points[-1][0])  # type: ignore[union-attr]
    assert drawn == [[0.0, pytest.approx(0.2)], [2.0, pytest.approx(-0.1)]]
    assert [bar.get_height() for bar in below.patches] == [pytest.approx(0.2), pytest.approx(-0.3)]  # type: ignore[attr-defined]
    assert "0.10 s ahead" in drawing.alt


def test_other_courses_are_not_compared_and_damage_is_named(pair: tuple[Path, Path], tmp_path: Path) -> None:
    assert read_gate_gaps(pair[0], folder_of(tmp_path / "shifted", [1.0, 2.0, 3.0, 4.0], beside=0.5)) is None
    assert read_gate_gaps(pair[0], folder_of(tmp_path / "short", [1.0])) is None
    assert read_gate_gaps(pair[0], tmp_path) is None
    with raises(ParameterError, "different_courses"):
        gaps_of_folders(pair[0], tmp_path)
    (pair[1] / "gates.csv").write_text(f"{HEAD}\n1,left,passed,soon,,,,1,2\n", encoding="utf-8")
    with raises(ParameterError, "not_a_number", value="soon"):
        read_gate_gaps(*pair)


@pytest.mark.parametrize(("beside", "same"), [(0.4, True), (-0.6, False)])
def test_a_course_beside_the_fall_line_is_the_same_where_its_gates_are(
    tmp_path: Path, beside: float, same: bool
) -> None:
    """All gates 0.4 m to the left in both; -0.6 m is 1 m away and another course, as it is from either side."""
    pair = (folder_of(tmp_path / "a", [1.0, 2.0], beside=0.4), folder_of(tmp_path / "b", [1.1, 2.3], beside=beside))
    for one, other in (pair, pair[::-1]):
        assert (read_gate_gaps(one, other) is not None) is same
