"""OpenSim's files: read as written, refused where they are wrong; boots from the markers on them."""

import math
from pathlib import Path

import numpy as np
import pytest

from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.geometry.vectors import axes_of
from skisnow.interop.opensim import (
    BootMarkers,
    Markers,
    MotionTable,
    boots_of_markers,
    boots_text,
    read_c3d,
    read_motion,
    read_trc,
    write_motion,
    write_trc,
)
from skisnow.scenario.boots import read_boots
from tests.coded import Coded, coded, raises

TIME = np.array([0.0, 0.01, 0.02, 0.03])
TRC = """PathFileType\t4\t(X/Y/Z)\ttwo.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
100\t100\t2\t2\tmm\t100\t1\t2
Frame#\tTime\theel\t\t\ttoe\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t1000\t200\t-30\t\t\t
2\t0.01\t1010\t200\t-30\t1300\t200\t-30
"""
MOT = """Coordinates
version=1
nRows=2
nColumns=3
inDegrees=no

Units are S.I.
endheader
time\tknee_angle_r\tpelvis_tx
0.0\t0.5\t1e-3
0.01\t0.75\t-2
"""


def test_a_table_is_read_as_it_was_written_and_a_table_of_another_program(tmp_path: Path) -> None:
    columns = {"knee_angle_r": np.array([1 / 3, -1e-17, 2e300, 0.1]), "force_vx": np.zeros(4)}
    for ending, degrees in ((".mot", True), (".sto", False)):
        table = MotionTable(TIME, columns, degrees, "one run", {"DataType": "double"})
        write_motion(table, tmp_path / f"a{ending}")
        found = read_motion(tmp_path / f"a{ending}")
        assert (found.name, found.in_degrees, dict(found.head)) == ("one run", degrees, {"DataType": "double"})
        assert np.array_equal(found.time, TIME)
        assert list(found.columns) == list(columns)
        assert all(np.array_equal(found.columns[name], columns[name]) for name in columns)
    (tmp_path / "a.mot").write_text(MOT, encoding="utf-8")
    found = read_motion(tmp_path / "a.mot")
    assert (found.name, found.in_degrees) == ("Coordinates", False)
    assert found.columns["pelvis_tx"].tolist() == [1e-3, -2.0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (MOT.replace("endheader\n", ""), "endheader"),
        (MOT.replace("nRows=2", "nRows=5"), "nRows=5"),
        (MOT.replace("nRows=2", f"nRows={'9' * 5000}"), "nRows=9999"),
        (MOT.replace("nColumns=3", "nColumns=4"), "nColumns=4"),
        (MOT.replace("0.75", "O.75"), "line 11"),
        (MOT.replace("0.75\t", ""), "line 11: 2"),
        (MOT.replace("0.01\t", "0.00\t"), "row 2 is 0 s"),
        (MOT.replace("time\t", "t\t"), "line 9"),
    ],
)
def test_a_wrong_table_is_rejected(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "a.mot").write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError) as refused:
        read_motion(tmp_path / "a.mot")
    assert words in str(refused.value)


def test_markers_are_read_as_they_were_written_and_in_metres(tmp_path: Path) -> None:
    (tmp_path / "two.trc").write_text(TRC, encoding="utf-8")
    found = read_trc(tmp_path / "two.trc")
    assert found.names == ("heel", "toe")
    assert found.of("heel").tolist() == [[1.0, 0.2, -0.03], [1.01, 0.2, -0.03]]
    assert np.isnan(found.of("toe")[0]).all()
    write_trc(found, tmp_path / "again.trc")
    again = read_trc(tmp_path / "again.trc")
    assert np.array_equal(again.place, found.place, equal_nan=True)
    assert (again.names, again.rate, again.time.tolist()) == (found.names, 100.0, [0.0, 0.01])
    with raises(ParameterError, "unknown_name", name="knee"):
        found.of("knee")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (TRC.replace("PathFileType", "Path"), "PathFileType"),
        (TRC.replace("\tmm\t", "\tinch\t"), "'inch'"),
        (TRC.replace("1300", "13oo"), "line 8, toe X"),
        (TRC.replace("1300", "1300\t1\t2\t3"), "line 8: more"),
        (TRC.replace("toe", "heel"), "heel is there twice"),
        ("".join(TRC.splitlines(keepends=True)[:4]), "PathFileType"),
        ("".join(TRC.splitlines(keepends=True)[:5]), "NumFrames=2"),
        (TRC.replace("100\t2\t2", "100\t9\t2"), "NumFrames=9, but the file has 2"),
        (TRC.replace("100\t2\t2", "100\t2\t3"), "NumMarkers=3, but the file has 2"),
    ],
)
def test_wrong_markers_are_rejected(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "two.trc").write_text(text, encoding="utf-8")
    with pytest.raises(ParameterError) as refused:
        read_trc(tmp_path / "two.trc")
    assert words in str(refused.value)


def captured(slope: float) -> tuple[Markers, list[np.ndarray[tuple[int, ...], np.dtype[np.float64]]]]:
    """Markers of two edged boots in OpenSim's axes (y up), and the boots' axes in those of the slope."""
    down = np.array([[math.cos(slope), 0, math.sin(slope)], [0, 1, 0], [-math.sin(slope), 0, math.cos(slope)]])
    axes = [axes_of(0.5, 0.1, 0.2), axes_of(-0.3, 0.0, -0.1)]
    local = {"heel": (-0.15, 0.0, 0.05), "toe": (0.15, 0.0, 0.05), "left": (0.02, 0.06, 0.05)}
    names, places = [], []
    for k, side in enumerate(("L", "R")):
        for name, at in local.items():
            in_slope = np.array([[2.0 * t, 0.25 - 0.5 * k, 0.01] for t in TIME]) + np.array(at) @ axes[k]
            x, y, z = (in_slope @ down.T).T
            names.append(side + name)
            places.append(np.stack([x, z, -y], axis=1))
    return Markers(TIME, tuple(names), np.stack(places, axis=1), 100.0), axes


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_boots_are_where_their_markers_say(tmp_path: Path, slope: float) -> None:
    markers, axes = captured(slope)
    left, right = (BootMarkers(f"{s}heel", f"{s}toe", f"{s}left", (0.15, 0.0, -0.05)) for s in "LR")
    boots = boots_of_markers(markers, left, right, slope_angle=slope)
    for k in range(2):
        assert boots.axes[:, k] == pytest.approx(np.broadcast_to(axes[k], (4, 3, 3)), abs=1e-14)
        assert boots.place[:, k] == pytest.approx(np.array([[2.0 * t, 0.25 - 0.5 * k, 0.01] for t in TIME]), abs=1e-14)
    (tmp_path / "boots.csv").write_text(boots_text(boots), encoding="utf-8")
    assert read_boots(tmp_path / "boots.csv").axes == pytest.approx(boots.axes, abs=1e-14)
    (tmp_path / "edges.csv").write_text(boots_text(boots, edge_angles_only=True), encoding="utf-8")
    alone = read_boots(tmp_path / "edges.csv")
    assert alone.frame == "sledge"
    assert alone.axes[0, 1] == pytest.approx(axes_of(-0.3, 0.0, 0.0), abs=1e-14)


def test_markers_that_tell_no_pose_are_rejected() -> None:
    markers, _ = captured(0.0)
    one = BootMarkers("Lheel", "Ltoe", "Lleft")
    with raises(ParameterError, "out_of_range"):
        boots_of_markers(markers, one, BootMarkers("Rheel", "Rtoe", "Rtoe"))
    with raises(ParameterError, "unknown_name", name="knee"):
        boots_of_markers(markers, one, BootMarkers("Rheel", "Rtoe", "knee"))
    unseen = markers.place.copy()
    unseen[2:, 1] = np.nan
    with raises(ParameterError, "gap", name="Ltoe", count=2, first=0.02):
        boots_of_markers(Markers(TIME, markers.names, unseen, 100.0), one, one)
    unseen[2:, 1] = -1e308
    with raises(ParameterError, "out_of_range", name="Ltoe", first=0.02):
        boots_of_markers(Markers(TIME, markers.names, unseen, 100.0), one, one)


def test_axes_with_z_up_need_no_turn() -> None:
    """The same boots in axes whose y points to the left and whose z points up."""
    markers, _ = captured(0.3)
    x, y, z = np.moveaxis(markers.place, 2, 0)
    upright = Markers(TIME, markers.names, np.stack([x, -z, y], axis=2), 100.0)
    given = [BootMarkers(f"{s}heel", f"{s}toe", f"{s}left", (0.1, 0.02, -0.05)) for s in "LR"]
    one = boots_of_markers(markers, given[0], given[1], slope_angle=0.3)
    other = boots_of_markers(upright, given[0], given[1], up="z", slope_angle=0.3)
    assert other.place == pytest.approx(one.place, abs=1e-15)
    assert other.axes == pytest.approx(one.axes, abs=1e-15)
    assert (one.frame, one.source) == ("slope", "markers")
    with raises(ParameterError, "unknown_choice", name="up"):
        boots_of_markers(markers, given[0], given[1], up="x")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"time": np.zeros(0), "place": np.zeros((0, 2, 3))}, coded("wrong_shape", field="markers", shape="(0,)")),
        ({"time": np.zeros((2, 1))}, coded("wrong_shape", field="markers", shape="(2, 1)")),
        ({"time": np.array([0.0, np.nan])}, coded("not_a_number", field="markers", row=2)),
        ({"time": np.array([0.1, 0.1])}, coded("not_a_number", field="markers", row=2, time=0.1)),
        ({"place": np.zeros((2, 3, 3))}, coded("wrong_shape", shape="(2, 3, 3)", needed="(2, 2, 3)")),
        ({"names": ("a", "a")}, "repeated"),
        ({"rate": 0.0}, coded("out_of_range", name="rate", value=0.0)),
        ({"rate": np.inf}, "out_of_range"),
    ],
)
def test_markers_that_do_not_fit_are_rejected(changes: dict[str, object], words: str | Coded) -> None:
    sound = {"time": np.array([0.0, 0.1]), "names": ("a", "b"), "place": np.zeros((2, 2, 3)), "rate": 10.0}
    assert repr(Markers(**sound)).endswith("2 frames at 10 Hz>")  # type: ignore[arg-type]
    with raises(ParameterError, words):
        Markers(**sound | changes)  # type: ignore[arg-type]


def test_tables_that_do_not_fit_are_rejected(tmp_path: Path) -> None:
    with raises(ParameterError, "wrong_shape", name="a", shape="(3,)", shape_2="(4,)"):
        MotionTable(TIME, {"b": np.zeros(4), "a": np.zeros(3)})
    table = MotionTable(TIME, {"b": np.zeros(4)})
    assert repr(table).endswith("1 columns, 4 rows to 0.03 s>")
    with raises(ParameterError, "wrong_ending"):
        write_motion(table, tmp_path / "a.txt")
    with raises(ParameterError, "wrong_ending"):
        write_trc(captured(0.0)[0], tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []


def test_heads_are_read_and_written_as_other_programs_have_them(tmp_path: Path) -> None:
    """A missing name is that of the file; rows are counted only where the head counts them."""
    (tmp_path / "own.mot").write_text("\nunits=N\ninDegrees=yes\nendheader\ntime\ta\n0\t1\n\n", encoding="utf-8")
    found = read_motion(tmp_path / "own.mot")
    assert (found.name, found.in_degrees, dict(found.head)) == ("own", True, {"units": "N"})
    write_motion(found, tmp_path / "again.mot")
    assert (tmp_path / "again.mot").read_text(encoding="utf-8").splitlines() == [
        "own", "version=1", "nRows=1", "nColumns=2", "units=N", "inDegrees=yes", "endheader", "time\ta", "0.0\t1.0",
    ]  # fmt: skip
    for text, words in (
        ("a\nendheader\n", "has no line endheader with a table behind it"),
        ("a\nendheader\n\n", "line 3: the columns must begin with time"),
        ("a\nendheader\ntime\tb\tb\n0\t1\t1\n", "line 3: the columns must begin with time, each name once"),
    ):
        (tmp_path / "own.mot").write_text(text, encoding="utf-8")
        with pytest.raises(ParameterError, match=words):
            read_motion(tmp_path / "own.mot")
    (tmp_path / "two.trc").write_text("\n".join(TRC.splitlines()[:4]), encoding="utf-8")
    with raises(ParameterError, "wrong_kind"):
        read_trc(tmp_path / "two.trc")
    markers = captured(0.0)[0]
    write_trc(markers, tmp_path / "six.trc")
    head = (tmp_path / "six.trc").read_text(encoding="utf-8").splitlines()
    assert head[2].split("\t") == ["100.0", "100.0", "4", "6", "m", "100.0", "1", "4"]
    assert head[4].split("\t")[2:6] == ["X1", "Y1", "Z1", "X2"]
    assert [row.split("\t")[0] for row in head[6:]] == ["1", "2", "3", "4"]


def test_files_are_converted_by_their_endings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.mot").write_text(MOT, encoding="utf-8")
    (tmp_path / "two.trc").write_text(TRC, encoding="utf-8")
    assert main(["convert", str(tmp_path / "a.mot"), str(tmp_path / "a.sto")]) == 0
    assert read_motion(tmp_path / "a.sto").columns["pelvis_tx"].tolist() == [1e-3, -2.0]
    assert main(["convert", str(tmp_path / "two.trc"), str(tmp_path / "metres.trc")]) == 0
    assert "\tm\t" in (tmp_path / "metres.trc").read_text(encoding="utf-8")
    capsys.readouterr()
    for given, out, words in (
        ("a.mot", "a.trc", "OpenSim table to TRC markers is not known"),
        ("a.doc", "a.trc", "states no format"),
        ("none.trc", "b.trc", "none.trc cannot be read"),
    ):
        assert main(["convert", str(tmp_path / given), str(tmp_path / out)]) == 1
        assert words in capsys.readouterr().err
        assert not (tmp_path / out).exists()


def test_markers_of_c3d(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    markers, _ = captured(0.0)
    made = ezc3d.c3d()
    made["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    made["parameters"]["POINT"]["LABELS"]["value"] = list(markers.names)
    made["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
    points = np.ones((4, len(markers.names), 4))
    points[:3] = 1e3 * np.moveaxis(markers.place, (0, 1, 2), (2, 1, 0))
    made["data"]["points"] = points
    made.write(str(tmp_path / "a.c3d"))
    found = read_c3d(tmp_path / "a.c3d")
    assert (found.names, found.rate) == (markers.names, 100.0)
    assert found.place == pytest.approx(markers.place, abs=1e-6)  # c3d has single precision
    first = made["header"]["points"]["first_frame"]
    assert found.time == pytest.approx((first + np.arange(4)) / 100.0)
    (tmp_path / "b.c3d").write_bytes(b"no markers")
    with pytest.raises(ParameterError, match=r"\.c3d"):
        read_c3d(tmp_path / "b.c3d")
