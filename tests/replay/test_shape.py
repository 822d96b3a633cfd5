"""Edges in space: a straight rigid ski by hand, known bending and twist, and against what the simulator says."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from skisnow._support.units import DEGREE
from skisnow.replay import Replay, replay_of_run, ski_edges
from skisnow.replay.replay import nearest_frame
from skisnow.scenario import load_scenario
from skisnow.simulation.simulated_run import simulate

from ..report.runs import circle_run

HALF = 0.04
HEADING = 30.0 * DEGREE
PLACE = np.array([3.0, -2.0, 0.5])


def rigid(*, edge_angle: float, bending: float = 0.0, twist: float = 0.0) -> Replay:
    """Two straight skis of 8 cm width, three stations, heading 30° to the left at a known place."""
    replay = replay_of_run(circle_run(count=3))
    station = np.array([1.0, 0.0, -1.0])
    shape = np.array([1.0, 0.0, 1.0])
    skis = replace(
        replay.skis,
        station=station,
        half_width=np.full(3, HALF),
        base_height=np.zeros(3),
        middle=np.array([[0.0, 0.25, 0.0], [0.0, -0.25, 0.0]]),
        edge_angle=edge_angle,
        bending=np.broadcast_to(bending * shape, (3, 2, 3)),
        twist=np.broadcast_to(twist * shape, (3, 2, 3)),
    )
    attitude = np.tile([math.cos(HEADING / 2.0), 0.0, 0.0, math.sin(HEADING / 2.0)], (3, 1))
    return replace(replay, place=np.tile(PLACE, (3, 1)), attitude=attitude, skis=skis)


def in_space(forward: float, left: float, up: float) -> np.ndarray:
    """By hand: turned 30° to the left about z, then moved."""
    c, s = math.cos(HEADING), math.sin(HEADING)
    return PLACE + np.array([c * forward - s * left, s * forward + c * left, up])


def test_flat_rigid_ski_has_its_corners_where_they_are_by_hand() -> None:
    edges = ski_edges(rigid(edge_angle=0.0), 0)
    assert edges.shape == (2, 3, 2, 3)
    for ski, side in ((0, 0.25), (1, -0.25)):
        for at, station in ((0, 1.0), (1, 0.0), (2, -1.0)):
            assert edges[ski, at, 0] == pytest.approx(in_space(station, side + HALF, 0.0), abs=1e-12)
            assert edges[ski, at, 1] == pytest.approx(in_space(station, side - HALF, 0.0), abs=1e-12)


def test_positive_edge_angle_puts_the_left_edge_down() -> None:
    edges = ski_edges(rigid(edge_angle=40.0 * DEGREE), 0)
    c, s = math.cos(40.0 * DEGREE), math.sin(40.0 * DEGREE)
    assert edges[0, 1, 0] == pytest.approx(in_space(0.0, 0.25 + HALF * c, -HALF * s), abs=1e-12)
    assert edges[0, 1, 1] == pytest.approx(in_space(0.0, 0.25 - HALF * c, HALF * s), abs=1e-12)


def test_bending_lifts_both_edges_along_the_normal_of_the_base() -> None:
    straight = ski_edges(rigid(edge_angle=40.0 * DEGREE), 0)
    bent = ski_edges(rigid(edge_angle=40.0 * DEGREE, bending=0.03), 0, exaggeration=2.0)
    moved = bent - straight
    # 2 × 30 mm away from the snow: to the left by the sine of the edge angle and up by its cosine
    sideways, up = 0.06 * math.sin(40.0 * DEGREE), 0.06 * math.cos(40.0 * DEGREE)
    expected = in_space(0.0, sideways, up) - PLACE
    assert moved[:, [0, 2]] == pytest.approx(np.broadcast_to(expected, (2, 2, 2, 3)), abs=1e-12)
    assert moved[:, 1] == pytest.approx(np.zeros((2, 2, 3)), abs=1e-12)  # the boot stays


def test_twist_adds_to_the_edge_angle() -> None:
    twisted = ski_edges(rigid(edge_angle=30.0 * DEGREE, twist=5.0 * DEGREE), 0)
    edged = ski_edges(rigid(edge_angle=35.0 * DEGREE), 0)
    assert twisted[:, [0, 2]] == pytest.approx(edged[:, [0, 2]], abs=1e-12)
    assert abs(twisted[:, 1] - edged[:, 1]).max() > 1e-3


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
