"""Gates of a course: tables and passages."""

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.report.race.figures import gap_drawings, last_words
from skisnow.report.race.folder import gaps_text
from skisnow.report.track.page import page_of_folders
from skisnow.track.course import Course, CourseResult, Gate, MovingPoint, passages
from skisnow.track.course.course import Point, Side
from skisnow.track.course.gates_table import COLUMNS, gaps_csv, gates_csv, gates_dict, read_gate_gaps, time_warnings
from skisnow.track.course.passages import BEYOND, STRADDLED, STRADDLED_OUTER, TO_THE_RIGHT, track_point
from skisnow.track.track import Axes, Track
from tests.coded import raises
from tests.present import present


def course(*gates: tuple[Point, Side] | tuple[Point, Side, Point]) -> Course:
    made = (
        Gate(name=str(i), turning=gate[0], side=gate[1], outer=gate[2] if len(gate) == 3 else None)
        for i, gate in enumerate(gates, start=1)
    )
    return Course(gates=tuple(made))


def along_x(*, y: float = 0.0, speed: float = 10.0, start: float = -5.0, seconds: float = 5.0) -> MovingPoint:
    time = np.arange(0.0, seconds, 0.07)
    return MovingPoint(time, np.column_stack([start + speed * time, np.full(len(time), y)]))


def outcomes(result: CourseResult) -> list[str]:
    return [each.outcome for each in result.passages]


ZIGZAG = course(((10.0, -1.0), "left"), ((20.0, 1.0), "right"), ((30.0, -1.0), "left"))
WIDE = course(
    ((10.0, -1.0), "left", (10.0, 4.0)), ((20.0, 1.0), "right", (20.0, -4.0)), ((30.0, -1.0), "left", (30.0, 4.0))
)


def test_times_on_a_straight_line_at_constant_speed() -> None:
    """Between the poles at x = 10, 20, 30 from x = -5 at 10 m/s: 1.5, 2.5, 3.5 s. Both poles a metre or three away."""
    result = passages(WIDE, along_x(), {})
    assert outcomes(result) == ["passed"] * 3
    assert result.times == pytest.approx((1.5, 2.5, 3.5), abs=1e-12)
    assert [each.clearance for each in result.passages] == pytest.approx([1.0, 1.0, 1.0])
    assert [each.speed for each in result.passages] == pytest.approx([10.0] * 3)
    assert (result.passed, result.missed, result.fault) == (3, (), None)


def test_time_through_the_course_is_reported_where_both_ends_were_reached() -> None:
    assert "last gate  2 s" in repr(passages(WIDE, along_x(), {}))
    missed = passages(WIDE, along_x(seconds=3.0), {})
    assert "last gate" not in repr(missed)
    assert present(missed.fault).words in [value for _, value in missed._repr_facts().rows]


def test_a_side_is_left_or_right() -> None:
    with raises(ParameterError, "unknown_choice", name="gate 1: side", value="up"):
        course(((10.0, -1.0), "up"))  # type: ignore[arg-type]


def test_two_points_are_enough() -> None:
    """A way of 60 m in 6 s."""
    result = passages(WIDE, MovingPoint(np.array([0.0, 6.0]), np.array([(-5.0, 0.0), (55.0, 0.0)])), {})
    assert result.times == pytest.approx((1.5, 2.5, 3.5), abs=1e-12)
    with pytest.raises(ParameterError):
        MovingPoint(np.array([0.0]), np.array([(-5.0, 0.0)]))


def test_without_outer_poles_the_line_is_square_to_the_course() -> None:
    """At the ends the course goes from pole to pole, (10, ±2): 10 (x - 10) + 2 (0 + 1) = 0 at x = 9.8, and x = 30.2."""
    result = passages(ZIGZAG, along_x(), {})
    assert outcomes(result) == ["passed"] * 3
    assert result.times == pytest.approx((1.48, 2.5, 3.52), abs=1e-12)
    # from the pole along the line: 1 m over the cosine of atan(2/10)
    assert result.passages[0].clearance == pytest.approx(math.hypot(10.0, 2.0) / 10.0)


def test_times_under_constant_acceleration_have_all_their_digits() -> None:
    """x = 2 t + 3 t²/2 is 10 m after 2 s, 22 m after 3.2749 s; points come at uneven times."""
    time = np.array([0.0, 0.4, 0.9, 1.3, 1.9, 2.2, 2.8, 3.1, 3.7])
    place = np.column_stack([2.0 * time + 1.5 * time**2, np.zeros(len(time))])
    result = passages(
        course(((10.0, -1.0), "left", (10.0, 3.0)), ((22.0, 1.0), "right", (22.0, -3.0))), MovingPoint(time, place), {}
    )
    assert result.times == pytest.approx((2.0, (-2.0 + math.sqrt(4.0 + 6.0 * 22.0)) / 3.0), abs=1e-12)
    assert [each.speed for each in result.passages] == pytest.approx([8.0, math.sqrt(136.0)], rel=1e-12)
    # between 1.9 and 2.2 s a straight way is 3/2 · 0.1 · 0.2 m = 30 mm behind, and the mean speed is 8.15 m/s
    assert result.passages[0].doubt == pytest.approx(0.03 / 8.15, rel=1e-9)


@pytest.mark.parametrize("turned", np.linspace(0.0, 2.0 * math.pi, 7, endpoint=False).tolist())
def test_no_direction_of_the_plane_is_another(turned: float) -> None:
    """The same course and track in each direction; times stay, sides stay, what is missed is missed."""
    matrix = np.array([[math.cos(turned), -math.sin(turned)], [math.sin(turned), math.cos(turned)]])

    def moved(point: Point) -> Point:
        x, y = matrix @ np.array(point) + [300.0, -70.0]
        return float(x), float(y)

    gates = [(moved(gate.turning), gate.side, moved(gate.outer)) for gate in WIDE.gates if gate.outer is not None]
    for y, expected in ((0.0, ["passed"] * 3), (2.0, ["passed", "missed", "passed"])):
        track = along_x(y=y)
        result = passages(course(*gates), MovingPoint(track.time, track.place @ matrix.T + [300.0, -70.0]), {})
        assert outcomes(result) == expected
        assert result.times == pytest.approx((1.5, 2.5, 3.5), abs=1e-9)


def test_a_mirrored_course_is_passed_on_the_other_sides() -> None:
    other: dict[Side, Side] = {"left": "right", "right": "left"}
    mirrored = course(*(((gate.turning[0], -gate.turning[1]), other[gate.side]) for gate in ZIGZAG.gates))
    assert passages(mirrored, along_x(), {}).times == pytest.approx((1.48, 2.5, 3.52), abs=1e-12)
    wrong = course(*((gate.turning, other[gate.side]) for gate in ZIGZAG.gates))
    assert outcomes(passages(wrong, along_x(), {})) == ["missed"] * 3


def test_what_is_missed_says_by_how_much_and_where() -> None:
    result = passages(WIDE, along_x(y=1.25), {})
    assert outcomes(result) == ["passed", "missed", "passed"]
    assert result.missed == ("2",)
    fault = present(result.fault)
    assert "0.25 m to the left" in fault.words
    assert fault.clearance == pytest.approx(-0.25)
    assert fault.time == pytest.approx(2.5)  # its line was crossed all the same
    beyond = passages(WIDE, along_x(y=4.5), {}).passages[0]
    assert "0.50 m" in beyond.words and "outer" in beyond.words
    assert beyond.clearance == pytest.approx(-0.5)


def test_a_course_that_is_gone_up_is_not_passed() -> None:
    up = along_x(start=40.0, speed=-10.0)
    result = passages(WIDE, up, {})
    assert outcomes(result) == ["backwards"] * 3
    assert result.times == (None, None, None)
    assert outcomes(passages(WIDE, along_x(y=-3.0, start=40.0, speed=-10.0), {}))[0] == "not_reached"


@pytest.mark.parametrize(("y", "words"), [(-1.0, TO_THE_RIGHT), (4.0, BEYOND)])
def test_over_a_pole_is_not_between_the_poles(y: float, words: str) -> None:
    """A point of the track is on the pole itself: nothing is rounded."""
    time, down = np.array([0.0, 1.0, 2.0]), np.array([(9.0, y), (10.0, y), (11.0, y)])
    found = passages(WIDE, MovingPoint(time, down), {}).passages[0]
    assert (found.outcome, found.clearance) == ("missed", 0.0)
    assert (found.words.template, found.words.fields["distance"]) == (words, 0.0)
    assert passages(WIDE, MovingPoint(time, down[::-1]), {}).passages[0].outcome == "not_reached"


def test_a_track_that_ends_leaves_gates_not_reached() -> None:
    result = passages(WIDE, along_x(seconds=2.0), {})
    assert outcomes(result) == ["passed", "not_reached", "not_reached"]
    assert result.missed == ("2", "3")


def climbing(pause: float) -> MovingPoint:
    """Past gate 1 at y = -2 to x = 12, back up to x = 8, over to y = 1, and down again through all three."""
    corners = np.array([(-5.0, -2.0), (12.0, -2.0), (8.0, -2.0), (8.0, 1.0), (40.0, 0.5)])
    times = np.cumsum([0.0, 1.7, pause, 3.0, 3.2])
    return MovingPoint(times, corners, velocity=np.zeros((5, 2)))


def test_a_gate_passed_after_climbing_back_counts_later_and_gates_are_passed_in_their_order() -> None:
    result = passages(WIDE, climbing(6.0), {})
    assert result.passages[0].outcome == "passed"
    assert present(result.passages[0].time) > 1.7 + 6.0 + 3.0
    assert passages(WIDE, climbing(130.0), {}).passages[0].outcome == "missed"
    # Who goes through gate 3 first and then back to the start, far beside the course, has not passed it yet.
    corners = [(25.0, 0.0), (32.0, 0.0), (32.0, -90.0), (-5.0, -90.0), (-5.0, 0.0), (45.0, 0.0)]
    track = MovingPoint(np.array([0.0, 1.0, 10.0, 15.0, 24.0, 29.0]), np.array(corners), np.zeros((6, 2)))
    result = passages(WIDE, track, {})
    assert outcomes(result) == ["passed"] * 3
    assert all(time is not None and time > 24.0 for time in result.times)


def parts(*tracks: tuple[float, float]) -> dict[str, MovingPoint]:
    """Feet and tips at places ahead of and beside the middle."""
    return {f"part {i}": along_x(y=y, start=-5.0 + ahead) for i, (ahead, y) in enumerate(tracks)}


@pytest.mark.parametrize(
    ("places", "outcome", "clearance"),
    [
        ([(0.0, 0.2), (0.0, -0.2), (0.9, 0.2), (0.9, -0.2)], "passed", 0.8),
        ([(0.0, -0.8), (0.0, -1.2), (0.9, -0.8), (0.9, -1.2)], "straddled", -0.2),
        ([(0.0, -0.8), (0.0, -0.9), (0.9, -0.8), (0.9, -1.2)], "straddled", -0.2),  # one tip hooks
        ([(0.0, -1.2), (0.0, -1.6), (0.9, -1.2), (0.9, -1.6)], "missed", -0.2),
        ([(0.0, 4.2), (0.0, 3.8), (0.9, 4.2), (0.9, 3.8)], "straddled", -0.2),  # the outer pole
        ([(0.0, 4.2), (0.0, 4.6), (0.9, 4.2), (0.9, 4.6)], "missed", -0.2),
    ],
)
def test_a_straddle_by_feet_and_by_tips(places: list[tuple[float, float]], outcome: str, clearance: float) -> None:
    """The turning pole is at y = -1, the outer one at y = 4. The time is that of the middle."""
    middle = along_x(y=sum(y for _, y in places) / len(places))
    found = passages(WIDE, middle, parts(*places)).passages[0]
    assert found.outcome == outcome
    assert found.clearance == pytest.approx(clearance)
    assert found.time == pytest.approx(1.5, abs=1e-12)
    if outcome == "straddled":
        pole = "outer" if places[0][1] > 0.0 else "turning"
        assert found.words.template == (STRADDLED_OUTER if pole == "outer" else STRADDLED)


def test_a_vertical_gate_has_its_own_direction() -> None:
    """Both poles down the fall line: it is passed from left to right, below its upper pole."""
    vertical = course(
        ((10.0, -3.0), "left", (10.0, 2.0)), ((20.0, 0.0), "left", (25.0, 0.0)), ((30.0, 3.0), "right", (30.0, -2.0))
    )
    line = vertical.lines[1]
    np.testing.assert_allclose(line.across, [1.0, 0.0])
    np.testing.assert_allclose(line.along, [0.0, -1.0])  # with x ahead, left is y: what has x to its left goes to -y
    time = np.linspace(0.0, 4.0, 81)
    track = MovingPoint(time, np.column_stack([5.0 + 6.0 * time, 2.0 - time]))
    found = passages(vertical, track, {}).passages[1]
    # y = 2 - t is 0 after 2 s, at x = 17: before the gate, whose poles are at 20 and 25
    assert found.outcome == "missed"
    assert found.time == pytest.approx(2.0, abs=1e-12)


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


def test_times_that_hang_on_the_way_between_points_are_reported_beside_a_gate_without_any() -> None:
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
    track = [f"{0.1 * i:.1f},{1.0 * i},{beside + 0.2 * (i % 3)}" for i in range(30)]
    (place / "track.csv").write_text("\n".join(["time_s,x_m,y_m", *track, ""]), encoding="utf-8")
    (place / "gates.csv").write_text("\n".join([HEAD, *rows, ""]), encoding="utf-8")
    return place


@pytest.fixture
def pair(tmp_path: Path) -> tuple[Path, Path]:
    """The first one loses 0.2 s up to gate 1, wins 0.3 s up to gate 3; at gate 2 the other has no time."""
    return folder_of(tmp_path / "mine", [1.2, 2.0, 2.9, None]), folder_of(tmp_path / "theirs", [1.0, None, 3.0, 4.0])


def test_gap_and_loss_at_each_gate(pair: tuple[Path, Path]) -> None:
    gaps = present(read_gate_gaps(*pair))
    assert [each.gate for each in gaps] == ["1", "2", "3", "4"]
    assert [each.gap_s for each in gaps] == [pytest.approx(0.2), None, pytest.approx(-0.1), None]
    assert [each.lost_s for each in gaps] == [pytest.approx(0.2), None, pytest.approx(-0.3), None]
    assert [each.other_outcome for each in gaps] == ["passed", "not_reached", "passed", "passed"]
    rows = gaps_csv(gaps).splitlines()
    assert rows[0].split(",")[::5] == ["gate", "gap_s"]
    assert rows[2] == "2,passed,2.0,not_reached,,,"
    assert "0.10 s ahead" in last_words(gaps, ("mine", "theirs"))


@pytest.mark.usefixtures("undrawn")
def test_terminal_and_page_tell_the_same(pair: tuple[Path, Path]) -> None:
    gaps = present(read_gate_gaps(*pair))
    lines = gaps_text(gaps, ("mine", "theirs")).splitlines()
    assert lines[2].split() == ["1", "1.20", "1.00", "+0.20", "+0.20"]
    assert lines[3].split() == ["2", "2.00", "-", "-", "-"]
    assert lines[4].split() == ["3", "2.90", "3.00", "-0.10", "-0.30"]
    page = page_of_folders(*pair)
    assert "2 of 4 gates" in page and "0.10 s ahead" in page


def test_the_figure_has_a_point_for_each_gate_that_both_crossed(pair: tuple[Path, Path]) -> None:
    gaps = present(read_gate_gaps(*pair))
    (drawing,) = gap_drawings(gaps, ("mine", "theirs"))
    above, below = drawing.figure.axes
    drawn = max((line.get_xydata().tolist() for line in above.lines), key=lambda points: points[-1][0])  # type: ignore[union-attr]
    assert drawn == [[0.0, pytest.approx(0.2)], [2.0, pytest.approx(-0.1)]]
    assert [bar.get_height() for bar in below.patches] == [pytest.approx(0.2), pytest.approx(-0.3)]  # type: ignore[attr-defined]
    assert "0.10 s ahead" in drawing.alt


@pytest.mark.usefixtures("undrawn")
def test_other_courses_are_not_compared_and_damage_is_named(pair: tuple[Path, Path], tmp_path: Path) -> None:
    assert read_gate_gaps(pair[0], folder_of(tmp_path / "shifted", [1.0, 2.0, 3.0, 4.0], beside=0.5)) is None
    assert read_gate_gaps(pair[0], folder_of(tmp_path / "short", [1.0])) is None
    assert read_gate_gaps(pair[0], tmp_path) is None
    assert 'id="tracks"' in page_of_folders(pair[0], tmp_path / "shifted")
    (pair[1] / "gates.csv").write_text(f"{HEAD}\n1,left,passed,soon,,,,1,2\n", encoding="utf-8")
    with raises(ParameterError, "not_a_number", value="soon"):
        read_gate_gaps(*pair)


@pytest.mark.parametrize(("beside", "same"), [(0.4, True), (-0.6, False)])
def test_a_course_beside_the_fall_line_is_equal_where_its_gates_are(tmp_path: Path, beside: float, same: bool) -> None:
    """All gates 0.4 m to the left in both; -0.6 m is 1 m away and another course, as it is from either side."""
    pair = (folder_of(tmp_path / "a", [1.0, 2.0], beside=0.4), folder_of(tmp_path / "b", [1.1, 2.3], beside=beside))
    for one, other in (pair, pair[::-1]):
        assert (read_gate_gaps(one, other) is not None) is same
