"""Geometry of a replay: edges on the snow, times of the groove, quaternions, and the kinds of its arrays."""

import numpy as np
import pytest

from skisnow.replay import replay_of_run
from skisnow.replay.page import ARRAY_TYPES
from skisnow.replay.replay import groove_times, quaternions
from skisnow.replay.skier import linear_light
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

from .held import ski_edges


def test_linear_light_of_srgb() -> None:
    """IEC 61966-2-1: straight up to 0.04045 of full light, a power of 2.4 above."""
    assert linear_light(np.array([0.0, 10.0, 64.0, 128.0, 255.0])) == pytest.approx(
        [0.0, 0.0030353, 0.0512695, 0.2158605, 1.0], abs=1e-6
    )


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
