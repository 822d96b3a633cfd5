"""The model taken away: a GLB file by the letter of glTF 2.0, with the skis where the replay has them."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from skisnow._support.errors import ParameterError
from skisnow._support.units import DEGREE
from skisnow.replay import Replay, replay_model, replay_of_run, ski_edges
from skisnow.replay.meshes import _strips, linear_light, round_above
from skisnow.replay.page import ARRAY_TYPES
from skisnow.replay.replay import groove_times, nearest_frame, quaternions
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

from ..report.runs import circle_run
from .glb_files import GlbFile

TIME = 2.0
FRAME = 100


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(circle_run(), title="A turn")


class Glb(GlbFile):
    """With a mesh by its name."""

    def mesh(self, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        (mesh,) = [each for each in self.words["meshes"] if each["name"] == name]
        primitive = mesh["primitives"][0]
        at = primitive["attributes"]
        assert primitive["mode"] == 4
        triangles = self.array(primitive["indices"]).reshape(-1, 3)
        vertices, colours = self.array(at["POSITION"]), self.array(at["COLOR_0"])
        assert triangles.max() < len(vertices) == len(colours)
        assert self.words["accessors"][at["POSITION"]]["min"] == vertices.min(axis=0).tolist()
        assert self.words["accessors"][at["POSITION"]]["max"] == vertices.max(axis=0).tolist()
        return vertices, colours, triangles


def test_the_skis_are_where_the_replay_has_them(replay: Replay) -> None:
    glb = Glb(replay_model(replay, TIME, exaggeration=3.0))
    edges = ski_edges(replay, FRAME, exaggeration=3.0)
    for ski, name in enumerate(("left ski", "right ski")):
        vertices, _, triangles = glb.mesh(name)
        corners = vertices.reshape(-1, 8, 3)
        assert corners[:, 3] == pytest.approx(edges[ski, :, 0], abs=2e-6)  # float32 over 30 m
        assert corners[:, 2] == pytest.approx(edges[ski, :, 1], abs=2e-6)
        assert len(triangles) == 60 * 4 * 2
        boot = int(np.argmin(np.abs(replay.skis.station)))
        top = corners[boot, 0] - corners[boot, 3]
        assert np.linalg.norm(top) == pytest.approx(0.018, rel=0.01)
        assert top[2] > 0.0


def test_z_becomes_up_and_the_slope_falls_along_x(replay: Replay) -> None:
    words = Glb(replay_model(replay, TIME)).words
    (root,) = words["scenes"][0]["nodes"]
    turned = Rotation.from_quat(words["nodes"][root]["rotation"])
    # y is up: the snow's normal leans by 10° towards x, the fall line falls by 10°
    assert turned.apply([0.0, 0.0, 1.0]) == pytest.approx(
        [math.sin(10 * DEGREE), math.cos(10 * DEGREE), 0.0], abs=1e-12
    )
    assert turned.apply([1.0, 0.0, 0.0]) == pytest.approx(
        [math.cos(10 * DEGREE), -math.sin(10 * DEGREE), 0.0], abs=1e-12
    )
    assert turned.apply([0.0, 1.0, 0.0]) == pytest.approx([0.0, 0.0, -1.0], abs=1e-12)


def test_the_groove_grows_and_has_its_true_width(replay: Replay) -> None:
    counts = [len(Glb(replay_model(replay, time)).mesh("groove")[2]) for time in (1.0, TIME, 4.0)]
    made = [int((replay.groove.time <= time + 1e-9).sum()) for time in (1.0, TIME, 4.0)]
    assert counts == [2 * number for number in made]
    vertices = Glb(replay_model(replay, 4.0)).mesh("groove")[0].reshape(-1, 4, 3)
    assert np.linalg.norm(vertices[:, 1] - vertices[:, 0], axis=1) == pytest.approx(replay.groove.width, abs=5e-6)
    assert np.linalg.norm(vertices[:, 3] - vertices[:, 0], axis=1) == pytest.approx(0.02, abs=5e-6)


def test_colour_is_that_of_the_force(replay: Replay) -> None:
    colours = Glb(replay_model(replay, TIME)).mesh("right ski")[1].reshape(-1, 8, 3)
    force = replay.skis.force_per_length[FRAME, 1]
    dark = colours[:, 0].sum(axis=1)
    loaded = force > 0.01 * force.max()
    order = np.argsort(force[loaded])
    assert (np.diff(dark[loaded][order]) <= 1e-6).all()  # more force, darker
    assert colours[np.argmin(force), 0] == pytest.approx(linear_light([214, 220, 226]), abs=1e-6)


def test_linear_light_of_srgb() -> None:
    """IEC 61966-2-1: straight up to 0.04045 of full light, a power of 2.4 above."""
    assert linear_light(np.array([0.0, 10.0, 64.0, 128.0, 255.0])) == pytest.approx(
        [0.0, 0.0030353, 0.0512695, 0.2158605, 1.0], abs=1e-6
    )


def test_the_end_of_a_scale_is_a_round_number_above() -> None:
    assert [round_above(value) for value in (1.0, 1.01, 1446.0, 2001.0, 0.0999)] == [1.0, 1.5, 1500.0, 3000.0, 0.1]


def test_the_edges_lie_as_deep_as_the_simulator_says() -> None:
    """On the plane z = 0 the depth of the left edge, down in a left turn, is minus its z."""
    run = simulate(load_scenario("carved-46m", changes={"run.duration_s": 0.2}))
    replay = replay_of_run(run)
    frame = len(run.time) - 1
    depth = -ski_edges(replay, frame)[:, :, 0, 2]
    inside = slice(2, -2)  # the outermost sections of the simulator lie up to a line's spacing inwards of tip and tail
    # depths of sections are interpolated to the stations, over at most 2 cm where the shovel bends up
    assert depth[:, inside] == pytest.approx(run.skis.edge_depth[frame, :, inside], abs=4e-4)
    at_boot = np.abs(run.skis.station) < 0.3
    assert depth[:, at_boot] == pytest.approx(run.skis.edge_depth[frame][:, at_boot], abs=2e-5)
    assert depth.max() > 1e-3


def test_nearest_frame() -> None:
    replay = replay_of_run(circle_run(count=5, duration=4.0))  # each second
    assert [nearest_frame(replay, time) for time in (-1.0, 0.4, 0.6, 9.0)] == [0, 0, 1, 4]


def test_a_strip_between_two_sections_is_two_triangles_that_face_the_same_way() -> None:
    """Corners 0 and 1 of the first section, 2 and 3 of the second: each triangle goes round in the same sense."""
    triangles = _strips(2, 2, [(0, 1)])
    assert triangles.tolist() == [[0, 2, 1], [1, 2, 3]]
    place = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]])
    a, b, c = (place[triangles[:, i]] for i in range(3))
    along, aside = b - a, c - a
    twice_area = along[:, 0] * aside[:, 1] - along[:, 1] * aside[:, 0]
    assert twice_area.tolist() == [1.0, 1.0]


def test_pieces_of_groove_of_a_single_moment_have_its_time() -> None:
    track = np.array([[[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]]])
    when, ski = groove_times(np.array([[0.5, -0.9, 0.0], [0.0, 3.0, 0.0]]), np.array([7.0]), track)
    assert (when.tolist(), ski.tolist()) == ([7.0, 7.0], [1, 0])


def test_every_array_has_a_kind_and_a_unit_that_readers_know() -> None:
    assert {kind for kind, _ in ARRAY_TYPES.values()} == {"float32", "uint16"}
    assert {unit for _, unit in ARRAY_TYPES.values()} == {"1", "m", "m/s", "1/m", "rad", "s", "N/m", "N"}


def test_quaternions_go_on_over_more_than_a_turn() -> None:
    """About z by 0 to 900 degrees in steps of 30: each is (cos, 0, 0, sin) of half the angle, and 30 from the last."""
    angle = np.radians(np.arange(0.0, 901.0, 30.0))
    sine, cosine, none = np.sin(angle), np.cos(angle), np.zeros_like(angle)
    matrices = np.stack([cosine, -sine, none, sine, cosine, none, none, none, none + 1.0], axis=1).reshape(-1, 3, 3)
    found = quaternions(matrices)
    assert found == pytest.approx(np.stack([np.cos(angle / 2.0), none, none, np.sin(angle / 2.0)], axis=1), abs=1e-12)


def test_no_matrices_are_no_quaternions() -> None:
    assert quaternions(np.zeros((0, 3, 3))).shape == (0, 4)


@pytest.mark.parametrize("time", [-0.5, 99.0, math.nan])
def test_a_moment_outside_of_the_run_is_rejected(replay: Replay, time: float) -> None:
    with pytest.raises(ParameterError, match="outside"):
        replay_model(replay, time)
