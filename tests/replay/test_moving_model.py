"""The model that moves: valid by the letter of glTF 2.0, and at any time where the run has its skis."""

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.units import DEGREE
from skisnow.replay import Replay, moving_replay_model, replay_of_run, ski_edges
from skisnow.replay.page import select_moments
from skisnow.scenario import Profile, load_scenario
from skisnow.simulation.run import Run
from skisnow.simulation.simulated_run import simulate

from ..report.runs import RADIUS, SPEED, STANCE, circle_run
from .glb_files import INDICES, VERTICES, GlbFile, Playing

SKIS = ("left ski", "right ski")


@pytest.fixture(scope="module")
def replay() -> Replay:
    return replay_of_run(circle_run(count=401), title="A turn")


@pytest.fixture(scope="module")
def model(replay: Replay) -> GlbFile:
    return GlbFile(moving_replay_model(replay))


@pytest.fixture(scope="module")
def simulated() -> Run:
    """Half a second told every 2 ms, five times as fine as a model's keys."""
    return simulate(load_scenario("carved-46m", changes={"run.duration_s": 0.5, "run.output_ms": 2.0}))


def to_run(world: np.ndarray, tilt: float) -> np.ndarray:
    """From glTF's axes (y up, z towards the viewer) back to those of the run, by hand."""
    level = np.stack([world[..., 0], -world[..., 2], world[..., 1]], axis=-1)
    c, s = math.cos(tilt), math.sin(tilt)  # x down the slope by the tilt
    return np.stack([c * level[..., 0] - s * level[..., 2], level[..., 1], s * level[..., 0] + c * level[..., 2]], -1)


def edges_in(model: GlbFile, time: float, tilt: float) -> np.ndarray:
    """Both edges of both bases as the model has them: (ski, station, edge, 3), in the run's axes."""
    playing = Playing(model, time)
    corners = np.stack([playing.vertices(name).reshape(-1, 8, 3) for name in SKIS])
    return to_run(corners[:, :, [3, 2]], tilt)


def under_the_boot(station: np.ndarray, line: np.ndarray) -> tuple[float, float, float]:
    """Where a line (station, 3) is at the boot; stations go from tip to tail."""
    x, y, z = (float(np.interp(0.0, station[::-1], axis[::-1])) for axis in line.T)
    return x, y, z


def by_hand(time: float, exaggeration: float = 1.0) -> np.ndarray:
    """Edges of the run on a circle at any time, in closed form: (ski, station, edge, 3)."""
    skis = replay_of_run(circle_run(count=3)).skis
    s = skis.station
    heading = SPEED / RADIUS * (time - 2.0)
    place = RADIUS * np.array([math.sin(heading) - math.sin(-SPEED / RADIUS * 2.0), 1.0 - math.cos(heading), 0.0])
    ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
    left, up = np.array([-ahead[1], ahead[0], 0.0]), np.array([0.0, 0.0, 1.0])
    angle = 30.0 * DEGREE - exaggeration * 0.5 * DEGREE * s**2
    lift = skis.base_height + exaggeration * 0.02 * s**2
    normal = math.sin(30.0 * DEGREE) * left + math.cos(30.0 * DEGREE) * up
    middle = s[:, None] * ahead + lift[:, None] * normal
    beside = skis.half_width[:, None] * (np.cos(angle)[:, None] * left - np.sin(angle)[:, None] * up)
    one = np.stack([middle + beside, middle - beside], axis=1)
    return place + np.stack([one + 0.5 * STANCE * left, one - 0.5 * STANCE * left])


@pytest.mark.parametrize("time", [0.0, 1.2345, 3.9961])
def test_skis_are_where_the_circle_has_them_at_any_time(model: GlbFile, time: float) -> None:
    found = edges_in(model, time, 10.0 * DEGREE)
    # between keys 10 ms apart a straight line cuts the circle by v² t² / 8 R = 0.067 mm; the skis turn with it
    assert found == pytest.approx(by_hand(time), abs=1e-4)


def test_exaggeration_takes_bending_and_twist_alone(replay: Replay) -> None:
    found = edges_in(GlbFile(moving_replay_model(replay, exaggeration=6.0)), 1.2345, 10.0 * DEGREE)
    assert found == pytest.approx(by_hand(1.2345, 6.0), abs=1e-4)
    assert np.abs(by_hand(1.2345, 6.0) - by_hand(1.2345)).max() > 0.05
    for exaggeration in (1.0, 6.0):
        frame = ski_edges(replay, 123, exaggeration=exaggeration)
        assert frame == pytest.approx(by_hand(float(replay.time[123]), exaggeration), abs=1e-9)


@pytest.mark.slow
def test_a_simulated_run_is_met_at_moments_that_are_no_keys(simulated: Run) -> None:
    fine = replay_of_run(simulated)
    model = GlbFile(moving_replay_model(fine))
    keys = model.array(model.words["animations"][0]["samplers"][0]["input"])[:, 0]
    assert 45 <= len(keys) <= 55  # 100 a second
    for frame in range(1, len(fine.time), 7):
        found = edges_in(model, float(fine.time[frame]), fine.tilt)
        off = float(np.abs(found - ski_edges(fine, frame)).max())
        # keys 10 ms apart: in the first tenth of a second the ends shake faster than that; measured 0.96 and 0.26 mm
        assert off < (2e-3 if fine.time[frame] < 0.1 else 5e-4)
        for ski in range(2):  # the run's own words of where the lower edge is under the boot, without the replay
            x, y, z = under_the_boot(fine.skis.station, found[ski, :, 0])
            assert (x, y) == pytest.approx(simulated.skis.track[frame, ski, :2].tolist(), abs=1e-3)
            assert -z == pytest.approx(simulated.skis.depth[frame, ski], abs=1e-3)
    at_key = edges_in(model, float(keys[-1]), fine.tilt)
    assert at_key == pytest.approx(ski_edges(fine, len(fine.time) - 1), abs=5e-6)  # float32 over some metres


def test_every_number_is_stored_by_the_letter_of_the_specification(model: GlbFile) -> None:
    words = model.words
    assert words["asset"]["version"] == "2.0"
    for number in range(len(words["accessors"])):
        model.array(number)  # alignment, length, exact bounds
    ends = [view["byteOffset"] + view["byteLength"] for view in words["bufferViews"]]
    starts = [view["byteOffset"] for view in words["bufferViews"]]
    assert all(0 <= start - end <= 3 for start, end in zip(starts[1:], ends[:-1], strict=True))  # nothing overlaps
    for mesh in words["meshes"]:
        (primitive,) = mesh["primitives"]
        at = primitive["attributes"]
        counts = {words["accessors"][number]["count"] for number in at.values()}
        assert len(counts) == 1
        assert {"min", "max"} <= set(words["accessors"][at["POSITION"]])  # 3.7.2.1
        assert int(model.array(primitive["indices"]).max()) < counts.pop()
        views = [words["accessors"][number]["bufferView"] for number in at.values()]
        assert {words["bufferViews"][view]["target"] for view in views} == {VERTICES}
        assert words["bufferViews"][words["accessors"][primitive["indices"]]["bufferView"]]["target"] == INDICES
        assert 0.0 <= model.array(at["COLOR_0"]).min() <= model.array(at["COLOR_0"]).max() <= 1.0


def test_one_animation_with_keys_that_rise_and_unit_quaternions(model: GlbFile) -> None:
    (animation,) = model.words["animations"]
    moved = [(each["target"]["node"], each["target"]["path"]) for each in animation["channels"]]
    assert len(set(moved)) == len(moved)  # 3.11: no property twice
    longest = 0.0
    for channel in animation["channels"]:
        sampler, path = animation["samplers"][channel["sampler"]], channel["target"]["path"]
        assert {"min", "max"} <= set(model.words["accessors"][sampler["input"]])
        keys, values = model.array(sampler["input"])[:, 0], model.array(sampler["output"])
        assert keys[0] >= 0.0
        assert (np.diff(keys) > 0.0).all()
        assert values.shape == (len(keys), 4 if path == "rotation" else 3)
        assert "matrix" not in model.words["nodes"][channel["target"]["node"]]
        longest = max(longest, float(keys[-1]))
        if path == "rotation":
            assert np.linalg.norm(values, axis=1) == pytest.approx(np.ones(len(keys)), abs=1e-6)
            assert (np.sum(values[1:] * values[:-1], axis=1) > 0.0).all()  # no reader needs to turn one around
    assert longest == pytest.approx(4.0, abs=1e-6)  # s, the run's own


def test_skins_have_a_joint_for_each_station(model: GlbFile, replay: Replay) -> None:
    words = model.words
    names = [node["name"] for node in words["nodes"]]
    assert len(set(names)) == len(names)
    assert [skin["name"] for skin in words["skins"]] == list(SKIS)
    for skin in words["skins"]:
        assert len(skin["joints"]) == len(replay.skis.station)
        assert words["accessors"][skin["inverseBindMatrices"]]["count"] == len(skin["joints"])
        matrices = model.array(skin["inverseBindMatrices"])
        assert matrices[:, [3, 7, 11, 15]].tolist() == [[0.0, 0.0, 0.0, 1.0]] * len(matrices)  # the fourth row, 3.7.3.1
        assert words["nodes"][skin["skeleton"]]["children"] == skin["joints"]
    for name in SKIS:
        (primitive,) = words["meshes"][words["nodes"][model.node(name)]["mesh"]]["primitives"]
        weights = model.array(primitive["attributes"]["WEIGHTS_0"])
        assert weights.sum(axis=1).tolist() == [1.0] * len(weights)
        joints = model.array(primitive["attributes"]["JOINTS_0"])
        assert joints.max() == len(replay.skis.station) - 1
        assert joints[weights == 0.0].max() == 0  # 3.7.3.3


def test_the_first_moment_stands_where_nothing_plays(model: GlbFile) -> None:
    """A reader that knows no animation shows the first moment with the whole groove."""
    playing = Playing(model, 0.0)
    still = model.words["nodes"]
    for number, node in enumerate(playing.nodes):
        if "groove" in node["name"]:
            assert "scale" not in still[number]
            continue
        for path in ("translation", "rotation"):
            if path in node:
                assert np.asarray(node[path]) == pytest.approx(np.asarray(still[number][path]), abs=2e-6)  # float32


def test_groove_is_there_at_most_a_step_after_the_boot_and_never_before(model: GlbFile, replay: Replay) -> None:
    whole = 0
    for time in (0.0, 0.512, 1.99, 4.0):
        playing = Playing(model, time)
        parts = [node["name"] for node in playing.nodes if "groove" in node["name"]]
        seen = [playing.vertices(name).reshape(-1, 4, 3) for name in parts]
        sizes = [float(np.ptp(each, axis=0).max()) for each in seen]
        pieces = sum(len(each) for each, size in zip(seen, sizes, strict=True) if size > 0.0)
        made = int((replay.groove.time <= time + 1e-6).sum())
        earlier = int((replay.groove.time <= time - 0.05 - 1e-6).sum())
        assert earlier <= pieces <= made
        whole = pieces
        middles = [to_run(each.mean(axis=1), 10.0 * DEGREE) for each, size in zip(seen, sizes, strict=True) if size]
        for middle in np.concatenate(middles):
            assert np.abs(replay.groove.middle + np.array([0.0, 0.0, 5e-4]) - middle).max(axis=1).min() < 5e-6
    assert whole == len(replay.groove.time)


def test_snow_and_grid_lie_on_the_slope(model: GlbFile) -> None:
    playing = Playing(model, 1.0)
    for name, height in (("snow", 0.0), ("grid", 5e-4)):
        place = to_run(playing.vertices(name), 10.0 * DEGREE)
        assert place[:, 2] == pytest.approx(np.full(len(place), height), abs=5e-6)
    world = playing.vertices("snow")
    fall = (world[:, 1].max() - world[:, 1].min()) / (world[:, 0].max() - world[:, 0].min())
    assert fall == pytest.approx(math.tan(10.0 * DEGREE), rel=1e-5)
    grid = to_run(playing.vertices("grid"), 10.0 * DEGREE).reshape(-1, 2, 3)
    step = np.abs(grid[:, 1] - grid[:, 0])
    assert np.abs(grid - np.round(grid))[..., :2].max() < 1e-5  # from metre to metre
    assert (step[:, :2].min(axis=1) < 1e-5).all()  # each line along x or y
    assert step.max() < 1.0 + 1e-5
    (primitive,) = model.words["meshes"][model.words["nodes"][model.node("grid")]["mesh"]]["primitives"]
    assert primitive["mode"] == 1  # lines
    bright = model.array(primitive["attributes"]["COLOR_0"]).sum(axis=1).reshape(-1, 2)[:, 0]
    constant = np.where(step[:, 0] < 1e-5, grid[:, 0, 0], grid[:, 0, 1])
    fifth = np.abs(constant / 5.0 - np.round(constant / 5.0)) < 1e-5
    assert bright[fifth].max() < bright[~fifth].min()
    assert fifth.any()


@pytest.fixture(scope="module")
def steep() -> GlbFile:
    """Down 60 % and ever less, 2 mm less each metre; the run's axes are horizontal and vertical there."""
    x = np.linspace(-30.0, 60.0, 901)
    run = circle_run(count=41)
    scenario = replace(run.scenario, slope=Profile(x, falls(x)))
    place = np.column_stack([run.place[:, :2], falls(run.place[:, 0])])
    return GlbFile(moving_replay_model(replay_of_run(replace(run, scenario=scenario, place=place))))


def falls(x: np.ndarray) -> np.ndarray:
    """Height (m) at x (m)."""
    return -0.6 * x + 0.001 * x**2


def test_grid_on_a_measured_slope_follows_it(steep: GlbFile) -> None:
    for name in ("grid", "snow"):
        world = Playing(steep, 0.0).vertices(name)
        # m; the grid is lifted by half a millimetre, which is 0.6 mm up there; chords of 0.25 m are 0.01 mm off
        assert world[:, 1] == pytest.approx(falls(world[:, 0]), abs=7e-4)
    depth = Playing(steep, 0.0).vertices("grid")
    assert np.ptp(depth[:, 0]) > 5.0
    assert np.ptp(depth[:, 1]) > 3.0


def test_the_camera_stays_over_a_steep_slope(steep: GlbFile) -> None:
    for time in (0.0, 1.3, 4.0):
        playing = Playing(steep, time)
        x, y, _ = playing.matrix(steep.node("camera"))[:3, 3]
        above = float(y - falls(x)) * math.cos(math.atan(0.6))
        assert above == pytest.approx(2.0, abs=0.1)  # m, across the slope, as on a plane
        seen_from = np.linalg.inv(playing.matrix(steep.node("camera")))
        sledge = playing.matrix(steep.node("sledge"))[:, 3]
        right, up, back = (seen_from @ sledge)[:3]
        assert back < 0.0
        assert max(abs(right), abs(up)) < 0.1 * abs(back)  # in the middle of the picture


def test_the_camera_follows_and_looks_at_the_skis(model: GlbFile) -> None:
    (camera,) = model.words["cameras"]
    for time in (0.0, 2.0, 4.0):
        playing = Playing(model, time)
        seen_from = np.linalg.inv(playing.matrix(model.node("camera")))
        skis = np.concatenate([playing.vertices(name) for name in SKIS])
        x, y, z = (np.column_stack([skis, np.ones(len(skis))]) @ seen_from.T)[:, :3].T
        assert (z < -camera["perspective"]["znear"]).all()  # before it: it looks along -z, 3.10
        assert np.abs(np.stack([x, y]) / -z).max() < math.tan(camera["perspective"]["yfov"] / 2.0)
        up = playing.matrix(model.node("camera"))[:3, :3] @ [0.0, 1.0, 0.0]
        assert up[1] > 0.5


def test_one_moment_late_times_and_nearly_equal_ones() -> None:
    late = replay_of_run(circle_run(count=3))
    times = np.array([1000.0, 1001.0 - 1e-10, 1001.0])  # the difference is lost in float32
    moved = replace(late, time=times, groove=replace(late.groove, time=times[[0, 2]].repeat(2)))
    model = GlbFile(moving_replay_model(moved))
    (animation,) = model.words["animations"]
    assert model.array(animation["samplers"][0]["input"])[:, 0].tolist() == pytest.approx([0.0, 1.0], abs=0.0)
    assert edges_in(model, 1.0, 10.0 * DEGREE) == pytest.approx(ski_edges(late, 2), abs=5e-6)
    one = select_moments(moved, np.array([1]))
    assert edges_in(GlbFile(moving_replay_model(one)), 0.0, 10.0 * DEGREE) == pytest.approx(
        ski_edges(late, 1), abs=5e-6
    )


def test_five_seconds_are_some_megabytes() -> None:
    """A run of 5 s with 61 stations, more than the catalogue's skis have in a simulation."""
    assert len(moving_replay_model(replay_of_run(circle_run(count=501, duration=5.0)))) < 2_600_000


def test_it_tells_what_it_exaggerates(replay: Replay) -> None:
    model = GlbFile(moving_replay_model(replay, exaggeration=6.0))
    told = model.words["nodes"][model.node("run")]["extras"]
    assert 6.0 in told.values()
    assert "mean" in told["colour_of_skis"]
