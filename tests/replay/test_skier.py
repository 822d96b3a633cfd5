"""A skier as it is drawn: bones keep their lengths, the masses their centre, boots and lean are the run's."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow._support.units import DEGREE
from skisnow.cli.simulate import _write_joints
from skisnow.geometry.vectors import axes_of
from skisnow.interop.opensim import read_motion
from skisnow.replay import (
    Replay,
    replay_bytes,
    replay_of_file,
    replay_of_run,
)
from skisnow.replay.skier import (
    ANKLE_BEHIND,
    AROUND,
    JOINTS,
    STAND_HEIGHT,
    _round,
    centre_of_mass,
    skier_parts,
    two_bones,
)
from skisnow.scenario.skier import Skier
from skisnow.simulation.moving_boots import BootHistory
from skisnow.simulation.run import Run
from skisnow.simulation.run_summary import run_gates
from skisnow.skier import body_of
from skisnow.skier.anthropometry import FOOT, FOREARM, SHANK, THIGH, TRUNK, UPPER_ARM
from skisnow.track.course import Course, Gate
from tests.present import present

from ..report.runs import circle_run
from .held import unpacked
from .test_of_run import written

HEIGHT = 1.76
LEANS = np.linspace(-48.0, 48.0, 9) * DEGREE


def run_of_skier() -> Run:
    """A body that leans from right to left over skis on the snow, 0.6 m high; edge angles 4° beyond the lean."""
    run = circle_run(count=len(LEANS))
    body = body_of(75.0, HEIGHT)
    sledge = replace(run.scenario.sledge, mass=75.0, inertia=body.inertia, centre_of_mass=(0.0, 0.6), edge_angle=0.0)
    attitude = (
        run.attitude @ Rotation.from_rotvec(-LEANS[:, None] * np.array([1.0, 0.0, 0.0])).as_matrix()
    )  # to the left is about -x
    ahead, left = run.attitude[:, :, 0], run.attitude[:, :, 1]
    place = run.place[:, None] + np.stack([0.22 * left, -0.22 * left], axis=1)
    heading = np.arctan2(ahead[:, 1], ahead[:, 0])
    axes = np.array([[axes_of(lean * 1.08, 0.0, turn)] * 2 for lean, turn in zip(LEANS, heading, strict=True)])
    centre = run.place + 0.6 * np.array([0.0, 0.0, 1.0]) + (0.6 * np.tan(LEANS))[:, None] * left
    zeros = np.zeros((len(LEANS), 2, 3))
    boots = BootHistory(place=place, axes=axes, own_force=zeros, own_moment=zeros, centre_of_mass=centre)
    gates = tuple(
        Gate(name=str(i), turning=tuple((run.place[at, :2] - left[at, :2]).tolist()), side="left")
        for i, at in ((1, 2), (2, 6))
    )
    scenario = replace(run.scenario, skier=Skier(), sledge=sledge, course=Course(gates=gates, source="of the test"))
    return replace(run, scenario=scenario, attitude=attitude, boots=boots, boots_by="moved by a skier")


@pytest.fixture(scope="module")
def run() -> Run:
    return run_of_skier()


@pytest.fixture(scope="module")
def replay(run: Run) -> Replay:
    return replay_of_run(run, title="skier")


def joints_of(replay: Replay) -> dict[str, np.ndarray]:
    """In space."""
    turn = Rotation.from_quat(replay.attitude, scalar_first=True).as_matrix()
    places = replay.place[:, None] + np.einsum("nab,nkb->nka", turn, present(replay.skier).joints)
    return {name: places[:, i] for i, name in enumerate(JOINTS)}


def test_bones_have_the_lengths_of_a_body_so_tall(replay: Replay) -> None:
    joints = joints_of(replay)
    bones = [("pelvis", "neck", TRUNK.length)]
    for side in ("left ", "right "):
        bones += [(side + "hip", side + "knee", THIGH.length), (side + "knee", side + "ankle", SHANK.length)]
        bones += [
            (side + "shoulder", side + "elbow", UPPER_ARM.length),
            (side + "elbow", side + "hand", FOREARM.length),
        ]
    for one, other, share in bones:
        length = np.linalg.norm(joints[one] - joints[other], axis=1)
        assert length == pytest.approx(np.full(len(LEANS), share * HEIGHT), abs=1e-6), (one, other)


def test_the_masses_have_their_centre_where_the_run_has_it(run: Run, replay: Replay) -> None:
    assert centre_of_mass(joints_of(replay)) == pytest.approx(present(run.boots).centre_of_mass, abs=2e-3)


def test_each_segment_has_its_centre_from_its_upper_end() -> None:
    """A body whose one joint lies 1 m aside: what of each segment's mass counts there."""
    shares = {
        "pelvis": TRUNK.mass * (1.0 - TRUNK.centre),
        "neck": TRUNK.mass * TRUNK.centre,
        "left hip": THIGH.mass * (1.0 - THIGH.centre),
        "left knee": THIGH.mass * THIGH.centre + SHANK.mass * (1.0 - SHANK.centre),
        "right ankle": SHANK.mass * SHANK.centre + FOOT.mass,
        "left shoulder": UPPER_ARM.mass * (1.0 - UPPER_ARM.centre),
        "right elbow": UPPER_ARM.mass * UPPER_ARM.centre + FOREARM.mass * (1.0 - FOREARM.centre),
        "right hand": FOREARM.mass * FOREARM.centre,
    }
    names = ["pelvis", "neck"]
    names += [f"{side} {each}" for side in ("left", "right") for each in
              ("hip", "knee", "ankle", "shoulder", "elbow", "hand")]  # fmt: skip
    for moved, share in shares.items():
        joints = {name: np.array([[0.0, float(name == moved), 0.0]]) for name in names}
        assert centre_of_mass(joints)[0] == pytest.approx([0.0, share, 0.0]), moved


def test_ankles_are_in_the_boots_and_lower_legs_in_their_planes(run: Run, replay: Replay) -> None:
    joints, boots = joints_of(replay), run.boots
    assert boots is not None
    for ski, side in enumerate(("left", "right")):
        off = (STAND_HEIGHT + FOOT.length * HEIGHT) * boots.axes[:, ski, 2] - ANKLE_BEHIND * boots.axes[:, ski, 0]
        assert joints[f"{side} ankle"] == pytest.approx(boots.place[:, ski] + off, abs=1e-9)
        shank = joints[f"{side} knee"] - joints[f"{side} ankle"]
        aside = np.einsum("na,na->n", shank, boots.axes[:, ski, 1]) / np.linalg.norm(shank, axis=1)
        assert np.degrees(np.abs(np.arcsin(aside))).max() < 20.0
        assert np.einsum("na,na->n", shank, boots.axes[:, ski, 0]).min() > 0.0  # the knee is before the ankle


def test_two_bones_meet_by_hand() -> None:
    """3, 4 and 5: the joint lies 9/5 along and 12/5 beside; ends too far apart are taken as near as bones reach."""
    start, end, aside = np.zeros((1, 3)), np.array([[5.0, 0.0, 0.0]]), np.array([[0.3, 0.0, 1.0]])
    assert two_bones(start, end, 3.0, 4.0, aside)[0] == pytest.approx([1.8, 0.0, 2.4])
    assert two_bones(start, 2.0 * end, 3.0, 4.0, aside)[0] == pytest.approx([3.0, 0.0, 0.0], abs=1e-6)
    assert np.isfinite(two_bones(start, start, 3.0, 4.0, aside)).all()
    folded = two_bones(start, start, 3.0, 3.0, aside)  # bones of one length fold flat
    assert np.linalg.norm(folded) == pytest.approx(3.0)


def test_a_body_that_legs_cannot_reach_is_drawn_all_the_same(run: Run) -> None:
    far = replace(present(run.boots), centre_of_mass=present(run.boots).centre_of_mass + np.array([0.0, 0.0, 2.0]))
    joints = joints_of(replay_of_run(replace(run, boots=far)))
    for side in ("left", "right"):
        length = np.linalg.norm(joints[f"{side} hip"] - joints[f"{side} ankle"], axis=1)
        assert length.max() < (SHANK.length + THIGH.length) * HEIGHT * 1.001
    assert all(np.isfinite(each).all() for each in joints.values())


def test_bytes_and_file_hold_the_skier_and_its_gates(run: Run, replay: Replay, tmp_path: Path) -> None:
    head, back = unpacked(replay_bytes(replay))
    assert replay.skier is not None
    assert back["skier_joints"] == pytest.approx(replay.skier.joints, abs=5e-5)
    result = present(run_gates(run))
    assert replay.gate_times is not None
    assert replay.gate_times.tolist() == [time - run.time[0] for time in result.times if time is not None]
    assert back["gate_time"] == pytest.approx(replay.gate_times, abs=1e-6)
    ended = replay_of_run(replace(run, scenario=replace(run.scenario, course=None)))
    assert ended.gate_times is None
    folder = written(run, tmp_path, **{"course.file": None, "course.name": None})
    of_file = replay_of_file(folder)
    assert of_file.skier is not None
    assert of_file.skier.height == pytest.approx(HEIGHT)
    assert head["skier"]["weight"] == of_file.skier.weight == 75.0 * run.scenario.gravity
    assert of_file.skier.joints == pytest.approx(replay.skier.joints, abs=1e-6)
    assert dict(of_file.facts)["Skis"].startswith("giant-slalom, ")


def test_a_gate_that_was_not_reached_has_no_time(run: Run) -> None:
    """Even with it every number of the page's header is one."""
    gates = (*run.scenario.course.gates, Gate(name="3", turning=(500.0, 0.0), side="left"))  # type: ignore[union-attr]
    late = replay_of_run(replace(run, scenario=replace(run.scenario, course=Course(gates=gates, source="of the test"))))
    assert np.isnan(present(late.gate_times)).tolist() == [False, False, True]
    back = unpacked(replay_bytes(late))[1]["gate_time"]
    assert np.isnan(back).tolist() == [False, False, True]


def test_a_round_shape_is_closed_in_the_middles_of_its_end_rings() -> None:
    mesh = _round([(0.0, 0.2, 0.1, 0.3), (0.5, 0.3, 0.2, -0.1), (1.0, 0.1, 0.1, 0.4)], (0, 0, 0))
    assert mesh.vertices[:AROUND] == pytest.approx(np.tile([0.3, 0.0, 0.0], (AROUND, 1)))
    assert mesh.vertices[-AROUND:] == pytest.approx(np.tile([0.4, 0.0, 1.0], (AROUND, 1)))


@pytest.mark.parametrize(
    ("height", "boxes"),
    [
        (1.75, {
            "trunk": [-13, -19, -11, 13, 19, 54], "head": [-11, -10, -2, 14, 10, 31], "boot": [-20, -6, 1, 20, 6, 17],
            "lower leg": [-8, -7, -6, 8, 7, 47], "thigh": [-10, -9, -5, 10, 9, 47],
            "upper arm": [-7, -6, -7, 7, 6, 36], "forearm": [-5, -5, -4, 5, 5, 33], "pole": [-4, -4, -9, 4, 4, 116],
        }),
        (1.5, {
            "trunk": [-13, -19, -9, 12, 19, 47], "head": [-9, -9, -2, 12, 9, 26], "boot": [-20, -6, 1, 20, 6, 17],
            "lower leg": [-8, -7, -6, 8, 7, 41], "thigh": [-10, -9, -4, 10, 9, 40],
            "upper arm": [-7, -6, -6, 7, 6, 31], "forearm": [-5, -5, -3, 5, 5, 29], "pole": [-4, -4, -9, 4, 4, 99],
        }),
    ],
)  # fmt: skip
def test_parts_are_as_large_as_those_that_were_looked_at(height: float, boxes: dict[str, list[int]]) -> None:
    """Least and greatest place (cm) of each, along its own axes."""
    parts = skier_parts(height)
    assert len(parts) == 2 + 2 * 6
    for part in parts:
        corners = np.concatenate([part.mesh.vertices.min(axis=0), part.mesh.vertices.max(axis=0)])
        assert 100.0 * corners == pytest.approx(boxes[part.name.removeprefix("left ").removeprefix("right ")], abs=0.6)


def test_meshes_are_closed_and_look_outward(replay: Replay) -> None:
    """By the divergence theorem the volume of each part is above 0: that of a body, 70 litres, all together."""
    volumes = []
    for part in skier_parts(present(replay.skier).height):
        a, b, c = (part.mesh.vertices[part.mesh.pieces[:, i]] for i in range(3))
        volumes.append(float(np.einsum("ta,ta->t", a, np.cross(b, c)).sum()) / 6.0)
    assert min(volumes) > 0.0
    assert 0.05 < sum(volumes) < 0.11


def test_joint_angles_for_opensim_lead_to_the_joints_and_boots(tmp_path: Path) -> None:
    """From the pelvis down by OpenSim's order of rotations; x ahead, y up, z to the right."""
    run = run_of_skier()
    _write_joints(run, tmp_path / "turn.sto")
    table = read_motion(tmp_path / "turn_joints.mot")
    assert table.in_degrees
    angles, replay = table.columns, replay_of_run(run)

    def turn(order: str, *names: str, sign: float = 1.0) -> Rotation:
        senses = np.array([1.0, sign, sign])[: len(names)]
        return Rotation.from_euler(order, np.stack([angles[name] for name in names], axis=1) * senses, degrees=True)

    def down(rotation: Rotation, length: float) -> np.ndarray:
        return np.asarray(rotation.apply([0.0, -length * HEIGHT, 0.0]))

    body = Rotation.from_quat(np.roll(replay.attitude, -1, axis=1))
    joints = {
        name: (replay.place + body.apply(present(replay.skier).joints[:, k]))[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
        for k, name in enumerate(JOINTS)
    }
    place = np.stack([angles[f"pelvis_t{axis}"] for axis in "xyz"], axis=1)
    assert np.allclose(place, joints["pelvis"], atol=1e-9)
    pelvis = turn("ZXY", "pelvis_tilt", "pelvis_list", "pelvis_rotation")
    for k, (side, end, sign) in enumerate((("left", "_l", -1.0), ("right", "_r", 1.0))):
        thigh = pelvis * turn("ZXY", f"hip_flexion{end}", f"hip_adduction{end}", f"hip_rotation{end}", sign=sign)
        shank = thigh * turn("Z", f"knee_angle{end}").inv()
        foot = shank * turn("ZX", f"ankle_angle{end}", f"subtalar_angle{end}", sign=sign)
        knee = joints[f"{side} hip"] + down(thigh, THIGH.length)
        assert np.allclose(knee, joints[f"{side} knee"], atol=1e-9)
        assert np.allclose(knee + down(shank, SHANK.length), joints[f"{side} ankle"], atol=1e-9)
        boot = Rotation.from_quat(np.roll(present(replay.skis.boots).attitude[:, k], -1, axis=1))
        sole = boot.apply([0.0, 0.0, 1.0])[:, [0, 2, 1]] * [1.0, 1.0, -1.0]
        assert np.allclose(foot.apply([0.0, 1.0, 0.0]), sole, atol=1e-9)
        assert (angles[f"knee_angle{end}"] > 10.0).all()
        assert (angles[f"hip_flexion{end}"] > 10.0).all()
