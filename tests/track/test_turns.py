"""Turns on paths whose switch points are known."""

import numpy as np
import pytest

from skisnow._support.units import DEGREE
from skisnow.track.curvature import track_motion
from skisnow.track.turns import find_turns

from .paths import NOISE, FloatArray, along, track

SPEED, STEP = 10.0, 0.01


def sine(turns: int, *, length: float = 15.0, least_radius: float = 12.0) -> FloatArray:
    """Curvature of equal turns, the first to the left, each half a sine over ``length`` (m)."""
    along = STEP * np.arange(round(turns * length / STEP) + 1)
    return np.asarray(np.sin(np.pi * along / length) / least_radius)


@pytest.mark.parametrize("seed", range(5))
def test_sine_has_its_turns_switch_points_angles_and_radii(seed: int) -> None:
    """Each turn: ∫ sin(πs/15)/12 ds = 2·15/(12π) = 45.6°; switch points at 1.5, 3, 4.5 s.

    The noise of the curvature, 0.008 1/m at 0.8 s, over its slope π/(15·12), 0.017 1/m², moves a switch point by 0.5 m
    at one point; a line through several does better: 0.05 s.
    """
    motion = track_motion(track(along(sine(4), STEP)[::100], noise=NOISE, seed=seed))
    turns = find_turns(motion)
    assert [turn.direction for turn in turns] == ["left", "right", "left", "right"]
    assert [turn.end for turn in turns[:-1]] == pytest.approx([1.5, 3.0, 4.5], abs=0.06)
    assert [turn.start for turn in turns[1:]] == [turn.end for turn in turns[:-1]]
    for turn, sign in zip(turns[1:-1], (-1.0, 1.0), strict=True):
        assert turn.turned_angle == pytest.approx(sign * 2.0 * 15.0 / (12.0 * np.pi), abs=0.03)
        assert abs(abs(turn.turned_angle) - 0.7958) < 4.0 * turn.turned_angle_sd + 0.012  # and 1.5 % of smoothing
        assert turn.length == pytest.approx(15.0, rel=0.04)
        assert turn.share_passed * turn.least_radius == pytest.approx(12.0, rel=0.08)
        assert turn.least_radius_interval[0] < turn.least_radius < turn.least_radius_interval[1]
        assert turn.mean_radius == pytest.approx(15.0 / 0.7958, rel=0.05)


def test_straight_line_has_no_turn() -> None:
    straight = np.stack([np.arange(200.0), np.zeros(200)], axis=1)
    for seed in range(5):
        assert find_turns(track_motion(track(straight, noise=NOISE, seed=seed))) == ()


def test_wiggle_below_ten_degrees_does_not_part_a_turn() -> None:
    """Left 20 m, right 1.5 m by 4°, left 20 m: one turn, and two where 3° make one."""
    curvature = np.full(round(41.5 / STEP) + 1, 1.0 / 20.0)
    curvature[round(20.0 / STEP) : round(21.5 / STEP)] = -4.0 * DEGREE / 1.5
    motion = track_motion(track(along(curvature, STEP)[::10], interval=0.01), window=0.06)
    assert [turn.direction for turn in find_turns(motion)] == ["left"]
    parted = find_turns(motion, least_angle=3.0 * DEGREE)
    assert [turn.direction for turn in parted] == ["left", "right", "left"]
    assert [turn.start for turn in parted[1:]] == pytest.approx([2.0, 2.15], abs=0.02)


def test_long_straight_parts_two_turns_to_one_side() -> None:
    """Between them 30 m, 3 s; each turns 20/20 rad."""
    curvature = np.concatenate([np.full(2000, 1.0 / 20.0), np.zeros(3000), np.full(2001, 1.0 / 20.0)])
    turns = find_turns(track_motion(track(along(curvature, STEP)[::100], noise=0.002, seed=1)))
    assert [turn.direction for turn in turns] == ["left", "left"]
    assert [turns[0].end, turns[1].start] == pytest.approx([2.0, 5.0], abs=0.35)  # the smoothing spreads 0.4 s
    for turn in turns:
        assert turn.turned_angle == pytest.approx(1.0, abs=0.03)


def test_turn_ends_at_a_gap() -> None:
    place = along(np.full(4001, 1.0 / 20.0), STEP)[::100]
    made = track(place, noise=0.002)
    made.time[20:] += 30.0
    turns = find_turns(track_motion(made))
    assert [turn.direction for turn in turns] == ["left", "left"]
    assert turns[0].end <= made.time[19]
    assert turns[1].start >= made.time[20]


def test_part_of_a_track() -> None:
    motion = track_motion(track(along(sine(4), STEP)[::100], noise=0.005))
    assert [turn.direction for turn in find_turns(motion, first=16, last=29)] == ["right"]


def test_wide_bend_is_straight() -> None:
    motion = track_motion(track(along(np.full(100_001, 1.0 / 600.0), STEP)[::100]))
    assert find_turns(motion) == ()
    motion = track_motion(track(along(np.full(100_001, 1.0 / 400.0), STEP)[::100]))
    assert len(find_turns(motion)) == 1


def test_share_passed_is_that_of_half_a_sine_as_long_as_the_turn() -> None:
    """A window of 1.6 s leaves 0.81 of turns of 1.5 s; the given radius times the share is the true one, 12 m."""
    motion = track_motion(track(along(sine(4), STEP)[::10], interval=0.01), window=1.6)
    for turn in find_turns(motion)[1:-1]:
        assert turn.least_radius > 14.0
        assert turn.share_passed * turn.least_radius == pytest.approx(12.0, rel=0.02)
