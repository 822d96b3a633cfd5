"""MuJoCo models and motion in other units."""

import random
import struct
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skisnow import read_ski
from skisnow._support.errors import ParameterError
from skisnow.cli import main
from skisnow.interop.mujoco import rigid_ski_geoms, ski_mjcf
from skisnow.interop.opensim import Markers, read_c3d, read_motion, read_trc
from skisnow.scenario.boots import read_boots
from tests.coded import Coded, coded, raises

from .c3d_files import BLOCK, DEC, INTEL, MIPS, c3d_bytes

CASES = Path(__file__).parents[2].parent / "shared" / "cases" / "motion"
shared = pytest.mark.skipif(not CASES.is_dir(), reason="no ../shared")
TABLE = "endheader\ntime\tknee_angle_r\n0.0\t0.5\n0.1\t0.7\n"


def degrees(folder: Path, head: str, name: str = "a.sto") -> bool:
    (folder / name).write_text(head + TABLE, encoding="utf-8")
    return read_motion(folder / name).in_degrees


def converted(folder: Path, source: Path, name: str) -> str:
    assert main(["convert", str(source), str(folder / name)]) == 0
    return (folder / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("first", ["Coordinates", "DataType=double"])
def test_a_head_that_says_nothing_is_in_radians(tmp_path: Path, first: str) -> None:
    assert not degrees(tmp_path, f"{first}\nversion=3\nOpenSimVersion=4.4\n")
    assert not degrees(tmp_path, f"{first}\nversion=3\n", "a.mot")
    assert not degrees(tmp_path, f"{first}\n")
    assert "inDegrees=yes" not in converted(tmp_path, tmp_path / "a.sto", "b.mot")


@pytest.mark.parametrize(("word", "answer"), [("yes", True), ("Y", True), ("YES", True), ("no", False), ("N", False)])
def test_a_head_is_believed(tmp_path: Path, word: str, answer: bool) -> None:
    for head in (f"a\nversion=1\ninDegrees={word}\n", f"inDegrees = {word}\nversion=1\n", f"a\ninDegrees={word}\n"):
        assert degrees(tmp_path, head) is answer
        assert degrees(tmp_path, head, "a.mot") is answer


@pytest.mark.parametrize(
    "head", ["a\n", "a\nnRows=2\n", "a\nversion=1\ninDegrees=maybe\n", "a\nversion=1\ninDegrees=\n"]
)
def test_a_head_that_leaves_it_open_is_rejected(tmp_path: Path, head: str) -> None:
    with pytest.raises(ParameterError, match="inDegrees"):
        degrees(tmp_path, head, "a.mot")


def capture(path: Path, texts: dict[str, list[str]], *, rate: float = 50.0) -> None:
    """A .c3d file whose point i of frame t is at (i, 10 t, 1) in its unit."""
    total = sum(len(values) for key, values in texts.items() if key.startswith("LABELS"))
    points = np.ones((2, total, 3))
    points[:, :, 0], points[:, :, 1] = np.arange(total), [[0.0], [10.0]]
    path.write_bytes(c3d_bytes(points, texts, rate=rate))


@pytest.mark.parametrize("kind", ["Quaternion", "Vec3", "SpatialVec"])
def test_cells_of_several_numbers_are_rejected(tmp_path: Path, kind: str) -> None:
    """Orientations of OpenSense, and vectors, as OpenSim writes them."""
    head = f"DataRate=100.0\nDataType={kind}\nversion=3\nOpenSimVersion=4.4\nendheader\n"
    text = head + "time\tpelvis_imu\n0.0\t0.99,0.01,-0.02,0.1\n"
    for read in (read_motion, read_boots):
        (tmp_path / "a.sto").write_text(text, encoding="utf-8")
        with pytest.raises(ParameterError, match=rf"a\.sto.*DataType={kind}.*DataType=double"):
            read(tmp_path / "a.sto")


def test_names_go_on_in_further_blocks(tmp_path: Path) -> None:
    names = [f"m{i}" for i in range(600)]
    blocks = {"LABELS": names[:255], "LABELS2": names[255:510], "LABELS3": names[510:], "UNITS": ["mm"]}
    capture(tmp_path / "a.c3d", blocks)
    found = read_c3d(tmp_path / "a.c3d")
    assert list(found.names) == names
    assert found.of("m599")[1].tolist() == pytest.approx([0.599, 0.01, 0.001])


@pytest.mark.parametrize(
    "name",
    ["LAnkleAngles", "Subject:RKneeAngles", "L_HIP_ANGLE", "RAbsAnkleAngle", "LGroundReactionForce", "LNormalisedGRF",
     "RHipMoment", "LKneePower", "Torque1", "com_velocity", "HeadAcceleration",
     "HipMoment_R", "RKneeForce.X", "Force.Fx1"],
)  # fmt: skip
def test_quantities_among_the_points_are_omitted(tmp_path: Path, name: str) -> None:
    capture(tmp_path / "a.c3d", {"LABELS": ["LHEE", name, "LTOE"], "UNITS": ["mm"]})
    found = read_c3d(tmp_path / "a.c3d")
    assert (found.names, found.omitted) == (("LHEE", "LTOE"), (name,))
    assert found.of("LTOE")[0].tolist() == [0.002, 0.0, 0.001]


@pytest.mark.parametrize("group", ["ANGLES", "FORCES", "MOMENTS", "POWERS", "REACTIONS", "SCALARS"])
def test_quantities_of_its_lists_are_omitted(tmp_path: Path, capsys: pytest.CaptureFixture[str], group: str) -> None:
    capture(tmp_path / "a.c3d", {"LABELS": ["LHEE", "x1"], "UNITS": ["mm"], group: ["x1 "]})
    assert main(["convert", str(tmp_path / "a.c3d"), str(tmp_path / "a.trc")]) == 0
    assert "x1" in capsys.readouterr().err
    assert read_trc(tmp_path / "a.trc").names == ("LHEE",)
    capture(tmp_path / "a.c3d", {"LABELS": ["x1"], "UNITS": ["mm"], group: ["x1"]})
    with raises(ParameterError, "out_of_range"):
        read_c3d(tmp_path / "a.c3d")


@pytest.mark.parametrize("name", ["LHEE", "MandibleAngle", "ForceShoe", "PowerPack", "*17", "CentreOfMass", "Momentum"])
def test_markers_with_similar_names_stay(tmp_path: Path, name: str) -> None:
    capture(tmp_path / "a.c3d", {"LABELS": [name], "UNITS": ["mm"]})
    assert read_c3d(tmp_path / "a.c3d").names == (name,)


def test_points_without_a_name_are_omitted_by_their_number(tmp_path: Path) -> None:
    labels = ["a", "LHipMoment", "", "b"]
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(np.ones((2, 5, 3)), {"LABELS": labels, "UNITS": ["mm"]}))
    found = read_c3d(tmp_path / "a.c3d")
    assert (found.names, found.omitted) == (("a", "b"), ("LHipMoment", "point 3", "point 5"))


def test_each_block_and_each_point_may_have_its_unit(tmp_path: Path) -> None:
    blocks = {"LABELS": ["a", "b"], "UNITS": ["mm", "m"], "LABELS2": ["c"], "UNITS2": ["CM "]}
    capture(tmp_path / "a.c3d", blocks)
    assert [read_c3d(tmp_path / "a.c3d").of(name)[1, 1] for name in "abc"] == pytest.approx([0.01, 10.0, 0.1])
    capture(tmp_path / "a.c3d", blocks | {"UNITS2": ["deg"]})
    with raises(ParameterError, "out_of_range", name="c"):
        read_c3d(tmp_path / "a.c3d")


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan])
def test_a_rate_that_is_none_is_rejected(tmp_path: Path, rate: float) -> None:
    capture(tmp_path / "a.c3d", {"LABELS": ["a"], "UNITS": ["mm"]}, rate=rate)
    with raises(ParameterError, "out_of_range"):
        read_c3d(tmp_path / "a.c3d")


def test_ezc3d_gives_blocks_as_they_are_read_here(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed")
    names = [*(f"m{i}" for i in range(299)), "LKneeAngles"]
    made = ezc3d.c3d()
    made["parameters"]["POINT"]["RATE"]["value"], made["parameters"]["POINT"]["UNITS"]["value"] = [100.0], ["mm"]
    made["parameters"]["POINT"]["LABELS"]["value"] = names
    made["data"]["points"] = np.ones((4, 300, 2)) * np.arange(300)[:, None]
    made.write(str(tmp_path / "a.c3d"))
    found = read_c3d(tmp_path / "a.c3d")
    assert (list(found.names), found.omitted) == (names[:-1], ("LKneeAngles",))
    assert found.of("m298")[0] == pytest.approx([0.298] * 3)


def test_names_that_are_there_twice_are_rejected(tmp_path: Path) -> None:
    capture(tmp_path / "a.c3d", {"LABELS": ["a", "b", "a"], "UNITS": ["mm"]})
    with raises(ParameterError, "damaged"):
        read_c3d(tmp_path / "a.c3d")


@shared
def test_shared_cases(tmp_path: Path) -> None:
    assert not read_motion(CASES / "stofileadapter.sto").in_degrees
    assert "inDegrees=yes" not in converted(tmp_path, CASES / "stofileadapter.sto", "a.mot")
    many: Markers = read_c3d(CASES / "many300.c3d")
    assert many.names == tuple(f"M{i}" for i in range(300))
    assert many.of("M299")[0].tolist() == pytest.approx([2.99, 0.5, 0.1])
    assert read_c3d(CASES / "angles.c3d").names == ("LHEE", "LTOE")


POINTS = np.arange(18.0).reshape(2, 3, 3) - 4.0
TEXTS = {"LABELS": ("heel", "toe"), "UNITS": ("cm",)}


def read(folder: Path, content: bytes) -> object:
    (folder / "a.c3d").write_bytes(content)
    return read_c3d(folder / "a.c3d")


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("scale", [-1.0, 0.5])
def test_places_are_metres_and_frames_seconds(tmp_path: Path, processor: int, scale: float) -> None:
    """Frames count from the first one's number; points beyond the names are not markers."""
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(POINTS, TEXTS, first=6, processor=processor, scale=scale))
    found = read_c3d(tmp_path / "a.c3d")
    assert (found.names, found.rate, found.time.tolist()) == (("heel", "toe"), 50.0, [0.1, 0.12])
    assert found.place == pytest.approx(1e-2 * POINTS[:, :2])


def test_a_marker_that_was_not_seen_has_no_place(tmp_path: Path) -> None:
    residual = np.array([[0.0, -1.0, 0.0], [0.1, 0.2, 0.0]])
    (tmp_path / "a.c3d").write_bytes(c3d_bytes(POINTS, TEXTS, residual=residual))
    seen = np.isfinite(read_c3d(tmp_path / "a.c3d").place).all(axis=2)
    assert seen.tolist() == [[True, False], [True, True]]


@pytest.mark.parametrize(
    ("texts", "named"),
    [
        ({"LABELS": (), "UNITS": ("mm",)}, "out_of_range"),
        ({"LABELS": ("a",), "UNITS": ("inch",)}, coded("out_of_range", unit="inch")),
    ],
)
def test_no_markers_or_an_unknown_unit(tmp_path: Path, texts: dict[str, tuple[str, ...]], named: str | Coded) -> None:
    with raises(ParameterError, named):
        read(tmp_path, c3d_bytes(POINTS, texts))


def put(offset: int, content: bytes) -> bytes:
    sound = c3d_bytes(POINTS, TEXTS)
    return sound[:offset] + content + sound[offset + len(content) :]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x02",
        put(1, b"\x51"),
        put(0, b"\x00"),
        put(0, b"\xff"),
        put(2, struct.pack("<H", 65535)),  # points
        put(4, struct.pack("<H", 65535)),  # analogue values
        put(8, struct.pack("<H", 65534)),  # last frame
        put(6, struct.pack("<H", 9)),  # first frame behind the last
        put(16, struct.pack("<H", 0)),  # place of the frames
        put(16, struct.pack("<H", 65535)),
        put(BLOCK + 3, b"\x00"),  # processor
        put(BLOCK + 4 + 7, struct.pack("<h", -5)),  # distance to the next parameter
        put(BLOCK + 4 + 7, struct.pack("<h", 30000)),
        c3d_bytes(POINTS, TEXTS)[:-1],
    ],
)
def test_a_damaged_file_names_itself(tmp_path: Path, content: bytes) -> None:
    with raises(ParameterError, "cannot_read"):
        read(tmp_path, content)


def test_no_byte_of_the_head_does_more_than_spoil_the_file(tmp_path: Path) -> None:
    """Each byte in turn becomes 0, 255, 128 and a random one."""
    sound, rng = c3d_bytes(POINTS, TEXTS), random.Random(1)
    for at in (*range(24), *range(BLOCK, BLOCK + 70)):
        for value in (0, 255, 128, rng.randrange(256)):
            try:
                read(tmp_path, sound[:at] + bytes([value]) + sound[at + 1 :])
            except ParameterError as error:
                assert "a.c3d" in str(error)


def test_compliances_and_masses_of_the_hinges_add_up(tmp_path: Path) -> None:
    ski, path = read_ski("carver"), tmp_path / "ski.xml"
    assert main(["export", "mjcf", "carver", "--out", str(path)]) == 0
    root = ET.fromstring(path.read_text(encoding="utf-8"))
    along = np.linspace(ski.station[-1], ski.station[0], 20_001)
    at = ski.at(along)
    mass = sum(float(each.attrib["mass"]) for each in root.iter("inertial"))
    assert mass == pytest.approx(np.trapezoid(at.mass_per_length, along), rel=1e-6)
    bend = [1.0 / float(each.attrib["stiffness"]) for each in root.iter("joint") if "front" in each.attrib["name"]
            and "bend" in each.attrib["name"]]  # fmt: skip
    front = along > 0.15
    # from the binding to the middle of the last segment
    whole = np.trapezoid(1.0 / at.bending_stiffness[front], along[front])
    last = (along > along[-1] - 0.5 * (along[-1] - 0.15) / len(bend)) & front
    assert sum(bend) == pytest.approx(whole - np.trapezoid(1.0 / at.bending_stiffness[last], along[last]), rel=1e-3)
    assert [each.attrib["name"] for each in root.iter("site")] == ["boot"]


def test_a_name_with_signs_of_xml_comes_back() -> None:
    name = 'a & b <c> "d" &amp;'
    assert ET.fromstring(ski_mjcf(replace(read_ski("carver"), name=name))).attrib["model"] == name


def test_impossible_input_is_rejected(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ski = read_ski("carver")
    with raises(ParameterError, "out_of_range", name="segments"):
        ski_mjcf(ski, segments=2)
    assert main(["export", "mjcf", "carver", "--out", str(tmp_path / "ski.txt")]) == 1
    assert ".xml" in capsys.readouterr().err


def test_a_rigid_ski_is_boxes_that_touch_nothing() -> None:
    boxes = ET.fromstring(f"<ski>{rigid_ski_geoms(read_ski('slalom'), segments=10)}</ski>")
    assert len(boxes) == 10
    assert {box.attrib["contype"] for box in boxes} == {"0"}
    assert {box.attrib["mass"] for box in boxes} == {"0"}


def test_the_boxes_of_a_rigid_ski_lie_on_its_base() -> None:
    """Axes x ahead, y left, z up: a turn about y by a positive angle takes the front end down."""
    ski = read_ski("slalom")
    for box in ET.fromstring(f"<ski>{rigid_ski_geoms(ski, segments=10)}</ski>"):
        x, y, z = map(float, box.attrib["pos"].split())
        roll, pitch, yaw = map(float, box.attrib["euler"].split())
        half, wide, thick = map(float, box.attrib["size"].split())
        assert (y, roll, yaw) == (0.0, 0.0, 0.0)
        ends = ski.at(np.array([x - half, x, x + half]))
        assert wide == pytest.approx(ends.width[1] / 2.0)
        under = z - thick + np.array([1.0, -1.0]) * half * np.tan(pitch)
        assert under == pytest.approx(ends.base_height[[0, 2]], abs=1e-9)
