"""Boots of a scenario: rules for tables and arrays of poses, and the defaults of a table."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.geometry.vectors import angles_of, axes_of
from skisnow.scenario import load_scenario, scenario_file
from skisnow.scenario.boots import ANGLES, OF_SLOPE, SIDES, Boots, read_boots
from skisnow.scenario.plausibility import implausible_values
from tests.coded import Coded, coded, raises
from tests.key_names import LEFT_EDGE_ANGLE, WRONG_CELL_COUNT

FLAT: dict[str, Any] = {
    "at": np.arange(4.0), "place": np.zeros((4, 2, 3)), "axes": np.tile(np.eye(3), (4, 2, 1, 1)),
}  # fmt: skip
MIRRORED = np.tile(np.diag([1.0, -1.0, 1.0]), (4, 2, 1, 1))


def test_four_poses_are_enough() -> None:
    for over, unit in (("time", "s"), ("distance", "m")):
        assert f", 0 to 3 {unit}" in repr(Boots(**FLAT, over=over))  # type: ignore[arg-type]


def test_boots_rest_before_and_after_their_table() -> None:
    moving = Boots(**FLAT | {"place": np.arange(4.0)[:, None, None] * np.ones((2, 3))}, over="time")
    for at, place, rate in ((-1.0, 0.0, 0.0), (2.5, 2.5, 1.0), (3.0, 3.0, 1.0), (9.0, 3.0, 0.0)):
        places, _, velocity, _ = moving.poses(at)
        np.testing.assert_allclose(
            (places, velocity), np.array([place, rate])[:, None, None] * np.ones((2, 3)), atol=1e-12
        )


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({name: each[:3] for name, each in FLAT.items()}, coded("wrong_shape", fewest_poses=4)),
        ({"at": np.zeros((4, 1))}, coded("wrong_shape", fewest_poses=4)),
        (
            {"place": np.zeros((4, 2, 2))},
            coded("wrong_shape", fewest_poses=4, shape="(4,)", shape_2="(4, 2, 2)", shape_3="(4, 2, 3, 3)"),
        ),
        (
            {"axes": FLAT["axes"][:3]},
            coded("wrong_shape", fewest_poses=4, shape="(4,)", shape_2="(4, 2, 3)", shape_3="(3, 2, 3, 3)"),
        ),
        ({"place": np.full((4, 2, 3), math.nan)}, coded("not_a_number", name="place")),
        ({"at": np.array([0.0, 1.0, 2.0, math.inf])}, coded("not_a_number", name="at")),
        ({"at": np.array([0.0, 1.0, 1.0, 2.0])}, coded("not_rising", over="time", row=3, after=1.0, before=1.0)),
        (
            {"at": np.array([0.0, 5e-324, 1.0, 2.0])},
            coded("out_of_range", over="time", row=2, after=5e-324, before=0.0),
        ),
        (
            {"at": np.array([0.0, 1.0, 1.0 + 1e-7, 2.0])},
            coded("out_of_range", over="time", row=3, after=1.0000001, before=1.0),
        ),
        ({"at": np.array([0.0, 1.0, 2.0, 1e308])}, coded("out_of_range", name="at")),
        ({"place": np.full((4, 2, 3), -1e308)}, coded("out_of_range", name="place")),
        ({"axes": 1.001 * FLAT["axes"]}, "not_a_rotation"),
        ({"axes": MIRRORED}, coded("not_a_rotation", off=0.0)),
        ({"frame": "slope", "over": "distance"}, "contradiction"),
    ],
)
def test_poses_that_are_none_are_rejected(changes: dict[str, Any], told: str | Coded) -> None:
    with raises(ParameterError, told):
        Boots(**FLAT | changes)


def table(folder: Path, text: str, name: str = "boots.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_what_a_table_does_not_say_is_the_sledges(tmp_path: Path) -> None:
    """Here the left boot's place to the side and the right one's pitch; forces of a run's own boots are passed over."""
    head = "distance_m, left_aside_m ,right_pitch_deg,left_force_x_N,left_moment_x_N_m\n"
    path = table(tmp_path, head + "".join(f"{d},0.3,{10 * d},x,y\n" for d in range(4)))
    found = read_boots(path, edge_angle=0.2, stance_width=0.5)
    assert (found.frame, found.over, found.source) == ("sledge", "distance", str(path))
    assert found.place[2].tolist() == [[0.0, 0.3, 0.0], [0.0, -0.25, 0.0]]
    left, right = angles_of(found.axes)[2]
    assert left == pytest.approx([0.2, 0.0, 0.0], abs=1e-12)
    assert right == pytest.approx([0.2, math.radians(20.0), 0.0], abs=1e-12)
    assert read_boots(path).place[2, 1].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(("separator", "mark"), [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ",")])
@pytest.mark.parametrize("capitals", [False, True])
def test_separators_decimal_marks_and_capitals(tmp_path: Path, separator: str, mark: str, capitals: bool) -> None:
    head = "distance_m,left_edge_angle_deg,right_edge_angle_deg".replace(",", separator)
    rows = "".join(f"{d},{1.5 * d:.1f},-0.5\n".replace(",", separator).replace(".", mark) for d in range(4))
    found = read_boots(table(tmp_path, f"{head.upper() if capitals else head}\n{rows}"))
    assert found.at.tolist() == [0.0, 1.0, 2.0, 3.0]
    left, right = angles_of(found.axes)[3]
    assert (left[0], right[0]) == pytest.approx((math.radians(4.5), math.radians(-0.5)), abs=1e-12)


CASES = Path(__file__).parents[2].parent / "shared" / "cases" / "boots"
EDGES = "time_s,left_edge_angle_deg,left_up_m\n0,0,0\n0.1,1,0\n0.2,2,0\n0.3,3,0\n"


@pytest.mark.parametrize("number", ["1e308", "-1e308", "1e309", "1.1e7"])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_impossible_numbers_are_rejected_with_row_and_column(tmp_path: Path, number: str, column: int) -> None:
    cells = ["0.2", "2", "0"]
    cells[column] = number
    text = EDGES.replace("0.2,2,0", ",".join(cells))
    name = EDGES.splitlines()[0].split(",")[column]
    with pytest.raises(ParameterError, match=rf"boots\.csv, row 4.* {name}"):
        read_boots(table(tmp_path, text))


@pytest.mark.parametrize("number", ["5e-324", "1e-300", "9e-7"])
def test_steps_too_short_for_a_spline_are_rejected(tmp_path: Path, number: str) -> None:
    with raises(ParameterError, "out_of_range", line=3, clock="time_s"):
        read_boots(table(tmp_path, EDGES.replace("0.1,", f"{number},")))


def test_splines_are_finite_or_refused() -> None:
    """Steps of 1 µs to 100 s, coordinates up to 10,000 km, any axes."""
    random = np.random.default_rng(1)
    accepted = 0
    for _ in range(60):
        n = int(random.integers(4, 12))
        at = np.cumsum(10.0 ** random.uniform(-5.9, 2.0, n))
        place = random.uniform(-1.0, 1.0, (n, 2, 3)) * 10.0 ** random.uniform(-10.0, 7.0, (n, 2, 3))
        axes = np.array([[axes_of(*random.uniform(-3.0, 3.0, 3).tolist()) for _ in range(2)] for _ in range(n)])
        try:
            boots = Boots(at, place, axes)
        except ParameterError:
            continue
        accepted += 1
        assert all(np.isfinite(each).all() for when in at for each in boots.poses(float(when)))
    assert accepted > 0


@pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
def test_shared_cases() -> None:
    with raises(ParameterError, "out_of_range", line=4, head="left_x_m"):
        read_boots(CASES / "boots.csv")
    with raises(ParameterError, "out_of_range", line=9, clock="time"):
        read_boots(CASES / "b.mot")


SLOPE = ",".join(["time_s", *(f"{side}_{name}" for side in SIDES for name in (*OF_SLOPE, *ANGLES))])
MOT = "turn\nnRows=4\nEndHeader\n\ntime left_edge_angle_deg\n0 0\n1 10\n2 20\n3 30\n"


@pytest.mark.parametrize(
    ("text", "name", "told"),
    [
        (MOT.replace("2 20", "2 2O"), "a.mot", coded("not_a_number", line=8, head=LEFT_EDGE_ANGLE, value="2O")),
        (MOT.replace("2 20", "2 inf"), "a.sto", coded("not_a_number", value="inf")),
        (MOT.replace("2 20", "2"), "a.mot", coded(WRONG_CELL_COUNT, line=8, n_row=1, n_head=2)),
        (MOT.replace("EndHeader\n", ""), "a.mot", coded("no_data", head_end="endheader")),
        (MOT.replace("2 20\n", ""), "a.mot", coded("head_says", key="nRows", word="4", there=3)),
        (MOT.replace("nRows=4", "nColumns=3"), "a.sto", coded("head_says", key="nColumns", word="3", there=2)),
        (MOT.replace("nRows=4", "inDegrees = No"), "a.mot", "in_degrees"),
        (
            MOT.replace("2 20", "2 -200"),
            "a.mot",
            coded("out_of_range", line=8, head=LEFT_EDGE_ANGLE, value=-200.0, on_its_side=90.0),
        ),
        (MOT.replace("2 20", "2 2,0"), "a.mot", coded("not_a_number", value="2,0")),
        ("time_s,left_up_m,left_up_m\n", "a.csv", coded("repeated", name="left_up_m")),
        ("time_s,time,left_up_m\n", "a.csv", "missing"),
        ("time_s,left_up_m\n0,1\n\n1\n", "a.csv", coded(WRONG_CELL_COUNT, line=4, n_row=1, n_head=2)),
        ("time_s,left_up_m\n0,1\n1,2\n2,3\n", "a.csv", coded("out_of_range", n_rows=3, fewest_poses=4)),
        ("", "a.csv", "unknown_name"),
        ("time_s,left_edge_angel_deg\n0,1\n", "a.csv", coded("missing", name="left_edge_angel_deg")),
        (f"{SLOPE.replace(',left_pitch_deg', '')}\n", "a.csv", coded("missing", name="left_pitch_deg")),
        ("time_s,left_force_x_N\n" + "0,1\n" * 4, "a.csv", "missing"),
        ("left_up_m\n1\n", "a.csv", "missing"),
        (
            "time_s,left_up_m\n0,1\n1,2\n\n1,3\n2,4\n",
            "a.csv",
            coded("not_rising", line=5, clock="time_s", after=1.0, before=1.0),
        ),
        (
            "\n".join([SLOPE.replace("time_s", "distance_m"), *(f"{d}{',0' * 12}" for d in range(4))]),
            "a.csv",
            "contradiction",
        ),
        (MOT, "a.trc", "wrong_ending"),
    ],
)
def test_invalid_tables_are_rejected_with_their_place(tmp_path: Path, text: str, name: str, told: str | Coded) -> None:
    with raises(ParameterError, told):
        read_boots(table(tmp_path, text, name))


def test_a_table_of_opensim_is_read_behind_its_head(tmp_path: Path) -> None:
    found = read_boots(table(tmp_path, MOT, "a.mot"))
    assert found.at.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert found.axes[3, 0] == pytest.approx(axes_of(math.radians(30.0), 0.0, 0.0))
    assert found.axes[3, 1] == pytest.approx(np.eye(3))


def test_a_scenario_with_boots_shows_them(tmp_path: Path) -> None:
    path = table(tmp_path, "time_s,left_up_m\n" + "".join(f"{t},0\n" for t in range(4)))
    assert "4 poses" in repr(load_scenario("carved-46m", changes={"boots.file": str(path)}))
    assert "Boots" not in repr(load_scenario("carved-46m"))


def test_places_alone_have_no_degrees(tmp_path: Path) -> None:
    places = MOT.replace("nRows=4", "inDegrees=no").replace("left_edge_angle_deg", "left_up_m")
    assert read_boots(table(tmp_path, places, "a.sto")).place[3, 0, 2] == 30.0


def test_a_scenario_given_in_python_is_changed_as_a_file() -> None:
    base = load_scenario("carved-46m")
    found = scenario_file(base, changes={"start.speed_m_per_s": 3.0})  # type: ignore[arg-type]
    assert (found.scenario.start.speed, found.values["start.speed_m_per_s"], found.files) == (3.0, 3.0, ())
    assert found.scenario.sledge == base.sledge
    assert scenario_file(base).scenario.start.speed == base.start.speed  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("clock", "rows", "end", "said"),
    [
        ("time_s", (0.0, 1.0, 2.0, 3.0), {"run.duration_s": 3.5}, "0 to 3.5 s"),
        ("time_s", (0.5, 1.0, 2.0, 3.0), {"run.duration_s": 3.0}, "from 0.5 to 3 s"),
        ("time_s", (0.0, 1.0, 2.0, 3.0), {"run.duration_s": 3.0}, ""),
        ("distance_m", (0.0, 1.0, 2.0, 3.0), {"run.length_m": 9.0}, "0 to 9 m"),
        ("distance_m", (-1.0, 1.0, 2.0, 9.5), {"run.length_m": 9.0}, ""),
    ],
)
def test_boots_at_rest_are_reported(
    tmp_path: Path, clock: str, rows: tuple[float, ...], end: dict[str, float], said: str
) -> None:
    path = table(tmp_path, f"{clock},left_up_m\n" + "".join(f"{at},0\n" for at in rows))
    asked = load_scenario("carved-46m", changes={"boots.file": str(path), **end})
    told = [each for each in implausible_values(asked) if "boots" in each]
    assert len(told) == bool(said)
    assert all(said in each and str(path) in each for each in told)
