"""Marks of points: each found where it was put, and nowhere else."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from skisnow.track.track import FLAGS, Track, point_flags

FloatArray = npt.NDArray[np.float64]
N = 40


def run() -> tuple[FloatArray, FloatArray]:
    """15 m/s to the north at 10 Hz."""
    time = np.arange(N) / 10.0
    return time, np.column_stack([np.zeros(N), 15.0 * time, -3.0 * time])


def flagged(time: FloatArray, place: FloatArray, **named: Any) -> dict[str, list[int]]:
    fix, negative = np.ones(len(time), bool), np.zeros(len(time), bool)
    flags = point_flags(time, place, fix, negative, **named)
    assert set(flags) == set(FLAGS)
    return {code: np.flatnonzero(where).tolist() for code, where in flags.items() if where.any()}


def test_a_clean_run_has_none() -> None:
    assert flagged(*run()) == {}


def test_a_single_point_far_off_is_a_jump() -> None:
    time, place = run()
    place[17, 0] += 20.0  # 200 m/s out and back
    assert flagged(time, place) == {"jump": [17]}
    assert flagged(time, place, fastest=210.0) == {}


def test_limit_is_a_speed() -> None:
    time, place = run()
    place[:, 1] = 0.0
    place[17, 0] = 7.4
    assert flagged(time, place) == {}
    place[17, 0] = 7.6  # over 75 m/s in 0.1 s
    assert flagged(time, place) == {"jump": [17]}


@pytest.mark.parametrize("ahead", [7.0, -7.0])
def test_out_and_back_count_together(ahead: float) -> None:
    """Along the run one way is 1.5 m longer than the other: 85 m/s and 55 m/s are 70 m/s, 95 and 65 are 80."""
    time, place = run()
    place[17, 1] += ahead
    assert flagged(time, place) == {"impossible_step": [17 if ahead > 0.0 else 18]}
    place[17, 1] += ahead / 7.0
    assert flagged(time, place) == {"jump": [17]}


def test_jumps_side_by_side_at_the_same_place_leave_the_good_point_between() -> None:
    time, place = run()
    place[17, 0] += 500.0
    place[19, 0] += 500.0
    assert flagged(time, place) == {"jump": [17, 19]}


@pytest.mark.parametrize("point", [0, N - 1])
def test_an_end_far_from_all_others_is_a_jump(point: int) -> None:
    time, place = run()
    place[point, 0] += 500.0
    assert flagged(time, place) == {"jump": [point]}


def test_a_place_that_does_not_come_back_is_a_step() -> None:
    time, place = run()
    place[17:, 0] += 500.0
    assert flagged(time, place) == {"impossible_step": [17]}


def test_a_step_aside_is_no_jump() -> None:
    """14 m aside for good: 140 m/s once; the way past the point is hardly shorter than the one over it."""
    time, place = run()
    place[17:, 0] += 14.0
    assert flagged(time, place) == {"impossible_step": [17]}


def test_a_point_far_off_where_the_track_steps_aside_explains_nothing() -> None:
    time, place = run()
    place[17, 0] += 5000.0
    place[18:, 0] += 500.0
    assert flagged(time, place) == {"impossible_step": [17, 18]}


def test_two_points_off_are_steps_there_and_back() -> None:
    time, place = run()
    place[17:19, 0] += 500.0
    assert flagged(time, place) == {"impossible_step": [17, 19]}


def test_a_gap_is_marked_behind_it() -> None:
    time, place = run()
    time[20:] += 0.41
    assert flagged(time, place) == {"gap": [20]}
    assert flagged(time, place, gap_factor=5.2) == {}


def test_a_repeated_time_marks_the_second_point() -> None:
    time, place = run()
    time[5] = time[4]
    time[6] = time[4]
    assert flagged(time, place) == {"repeated_time": [5, 6]}


def test_points_without_fix_or_height() -> None:
    time, place = run()
    place[3, 2] = np.nan
    place[4] = np.nan
    fix = np.ones(N, bool)
    fix[8] = False
    flags = point_flags(time, place, fix, np.zeros(N, bool))
    assert np.flatnonzero(flags["no_fix"]).tolist() == [4, 8]
    assert np.flatnonzero(flags["missing_height"]).tolist() == [3]
    assert not flags["jump"].any()


def test_usable_points() -> None:
    time, place = run()
    place[3, 2] = np.nan
    place[17, 0] += 500.0
    time[5] = time[4]
    flags = point_flags(time, place, np.ones(N, bool), np.zeros(N, bool))
    track = Track("a run", time, place, np.full(N, np.nan), "local", "x, y, z", flags=flags)
    assert np.flatnonzero(~track.usable).tolist() == [5, 17]
    assert track.flagged == {"missing_height": 1, "repeated_time": 1, "jump": 1}


@pytest.mark.parametrize("length", [1, 2])
def test_too_short_to_tell_a_jump(length: int) -> None:
    time, place = run()
    place[1, 0] = 500.0
    found = flagged(time[:length], place[:length])
    assert found == ({} if length == 1 else {"impossible_step": [1]})
