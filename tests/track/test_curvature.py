"""Curvature of a track and its flags."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow.track.curvature import INTERVAL_FACTOR, _curvature, running_mean, track_motion
from skisnow.track.smoothing import smooth_track
from skisnow.track.track import FLAGS, Track, point_flags

from .paths import NOISE, along, circle, track

RADIUS, SPEED = 15.0, 8.0


@pytest.mark.parametrize("radius", [RADIUS, -RADIUS])
def test_circle_without_noise(radius: float) -> None:
    """A window of 0.8 s sees ±0.21 rad of the circle: 1/14 of its square less acceleration, 0.3 %."""
    motion = track_motion(track(circle(radius, SPEED)), window=0.8)
    assert motion.curvature[5:-5] == pytest.approx(np.full(71, 1.0 / radius), rel=5e-3)
    assert motion.turn_radius[5:-5] == pytest.approx(np.full(71, radius), rel=5e-3)
    assert motion.heading == pytest.approx(SPEED * motion.time / radius, abs=2e-3)
    assert motion.speed == pytest.approx(np.full(81, SPEED), rel=2e-3)
    assert motion.arc_length[-1] == pytest.approx(
        SPEED * 8.0, rel=2e-3
    )  # chords of 0.8 m are 1/8000 short, then smoothing
    assert np.all(np.diff(motion.heading) * radius > 0.0)  # more than a whole turn, without a jump


@pytest.mark.slow
def test_intervals_on_a_noisy_circle_cover_as_often_as_they_say() -> None:
    """One point of each of 400 tracks, 0.95 ± 0.0109 by chance: three of these either way."""
    covered = {"heading": 0, "curvature": 0}
    for seed in range(400):
        motion = track_motion(track(circle(RADIUS, SPEED, duration=6.0), noise=NOISE, seed=seed))
        point = 15 + seed % 30
        bent = motion.curvature[point] - 1.0 / RADIUS
        apart = motion.heading[point] - SPEED * motion.time[point] / RADIUS
        covered["heading"] += abs(apart) < 1.96 * motion.heading_sd[point]
        covered["curvature"] += abs(bent) < INTERVAL_FACTOR * motion.curvature_sd[point]
    for share in (count / 400.0 for count in covered.values()):
        assert share == pytest.approx(0.95, abs=0.033)


@pytest.mark.slow
def test_standard_errors_are_those_of_repeated_tracks() -> None:
    """At the end of a track, where they are largest, and inside; 300 tracks tell a standard deviation within 4 %."""
    found = [
        track_motion(track(circle(RADIUS, SPEED), noise=NOISE, seed=seed), place_noise=NOISE) for seed in range(300)
    ]
    for point in (0, 2, 40):
        curvature = np.array([motion.curvature[point] for motion in found])
        heading = np.array([motion.heading[point] for motion in found])
        assert np.std(curvature) == pytest.approx(np.median([m.curvature_sd[point] for m in found]), rel=0.15)
        assert np.std(heading) == pytest.approx(np.median([m.heading_sd[point] for m in found]), rel=0.15)


def test_standard_error_inside_is_that_of_the_textbook() -> None:
    """720 σ²/(N T⁴) for many points; for nine at 0.1 s Σ over the second orthogonal polynomial gives 4/308 σ²/Δt⁴."""
    speed = 10.0
    straight = np.stack([speed * 0.1 * np.arange(80), np.zeros(80)], axis=1)
    motion = track_motion(track(straight), window=0.8, place_noise=NOISE)
    weights = np.array([28.0, 7.0, -8.0, -17.0, -20.0, -17.0, -8.0, 7.0, 28.0]) / 462.0  # Savitzky and Golay, Table
    assert motion.curvature_sd[40] == pytest.approx(NOISE * np.linalg.norm(weights) / 0.1**2 / speed**2, rel=1e-6)
    slopes = np.array([86.0, -142.0, -193.0, -126.0, 0.0, 126.0, 193.0, 142.0, -86.0]) / 1188.0  # their cubic ones
    assert motion.heading_sd[40] == pytest.approx(NOISE * np.linalg.norm(slopes) / 0.1 / speed, rel=1e-6)


@pytest.mark.usefixtures("pathless")
def test_straight_line_may_be_straight() -> None:
    """Its curvature is 0 within the interval at 95 % of points; 5 % over some 30 independent windows may not be."""
    straight = np.stack([10.0 * 0.1 * np.arange(300), np.zeros(300)], axis=1)
    motion = track_motion(track(straight, noise=NOISE, seed=3))
    size, half = np.abs(motion.curvature), INTERVAL_FACTOR * motion.curvature_sd
    assert np.mean(size <= half) > 0.85
    assert np.median(size + half) < 0.01


def test_clothoid_has_a_curvature_that_grows_with_the_way() -> None:
    step, growth = 0.005, 0.002
    arc_length: FloatArray = step * np.arange(12_001.0)
    fine = along(growth * arc_length, step)
    made = track(fine[::200])  # 1 m each 0.1 s
    motion = track_motion(made, window=0.8)
    inside = slice(4, -4)
    assert motion.curvature[inside] == pytest.approx(growth * arc_length[::200][inside], rel=0.02, abs=1e-4)
    assert motion.heading[inside] == pytest.approx(growth * arc_length[::200][inside] ** 2 / 2.0, abs=3e-3)


def test_recorded_speed_comes_before_the_places() -> None:
    place = circle(RADIUS, SPEED)
    motion = track_motion(track(place, speed=np.full(len(place), 9.0)))
    assert motion.speed.tolist() == [9.0] * len(place)
    assert (motion.speed_source, motion.arc_length_source) == ("recorded", "recorded speed")
    assert motion.arc_length[-1] == pytest.approx(9.0 * 8.0)
    assert motion.curvature[40] == pytest.approx(1.0 / RADIUS, rel=5e-3)  # a path's shape knows no clock


def test_odometer_comes_first() -> None:
    made = track(circle(RADIUS, SPEED), speed=np.full(81, 9.0))
    odometer = 100.0 + np.linspace(0.0, 50.0, 81)
    odometer[30] = np.nan
    motion = track_motion(replace(made, odometer=odometer))
    assert motion.arc_length_source == "odometer"
    assert motion.arc_length[-1] - motion.arc_length[0] == pytest.approx(50.0)
    assert motion.arc_length[30] == pytest.approx(100.0 + 50.0 * 30 / 80)


def test_recorded_velocity_gives_speed_and_way() -> None:
    made = track(circle(RADIUS, SPEED))
    angle = SPEED * made.time / RADIUS
    velocity = SPEED * np.stack([np.cos(angle), np.sin(angle), np.full_like(angle, 0.75)], axis=1)
    motion = track_motion(replace(made, velocity=velocity))
    assert motion.speed == pytest.approx(np.full(81, 1.25 * SPEED))
    assert motion.arc_length[-1] == pytest.approx(1.25 * SPEED * 8.0)


def test_way_over_a_gap_is_straight() -> None:
    straight = np.stack([np.arange(60.0), np.zeros(60)], axis=1)
    straight[30:, 0] += 100.0
    made = track(straight, speed=np.full(60, 10.0))
    motion = track_motion(replace(made, time=made.time + np.where(np.arange(60) >= 30, 100.0, 0.0)))
    assert motion.arc_length[-1] == pytest.approx(159.0)  # not 10 m/s over 100 s


def test_points_without_a_fix_in_a_gap_count_once() -> None:
    """1 s of 100 points at 10 m/s has no fix: its way is straight, and no recorded speed is added to it."""
    made = track(np.stack([np.arange(100.0), np.zeros(100)], axis=1), speed=np.full(100, 10.0))
    made.place[45:56] = np.nan
    found = track_motion(made)
    assert found.speed_source == "recorded"
    assert found.arc_length[[44, 56, 99]] == pytest.approx([44.0, 56.0, 99.0], abs=1e-9)


@pytest.mark.usefixtures("pathless")
def test_at_rest_there_is_no_heading() -> None:
    motion = track_motion(track(np.zeros((20, 2)), noise=NOISE))
    assert np.isnan(motion.heading).all()
    assert np.isnan(motion.curvature).all()


def test_running_mean_knows_only_what_is_known() -> None:
    time, values = np.arange(5.0), np.array([1.0, np.nan, 3.0, 5.0, 10.0])
    one = np.zeros(len(time), dtype=np.int64)
    assert running_mean(time, values, 2.0, one).tolist() == pytest.approx([1.0, np.nan, 4.0, 6.0, 7.5], nan_ok=True)


def test_error_of_the_curvature_is_that_of_drawn_velocities_and_accelerations() -> None:
    """Fast turning, with errors of the velocity that count: 40,000 draws tell a standard deviation within 0.4 %."""
    of_one = np.array([[1e-4, 0.0, 0.0], [0.0, 0.04, 0.03], [0.0, 0.03, 0.25]])
    smoothed = replace(
        smooth_track(track(circle(RADIUS, SPEED))),
        velocity=np.array([[3.0, 5.0]]), acceleration=np.array([[-14.0, 6.0]]), covariance=of_one[None],
    )  # fmt: skip
    curvature, error = _curvature(smoothed, np.array([math.sqrt(34.0)]))
    assert curvature[0] == pytest.approx((3.0 * 6.0 + 5.0 * 14.0) / 34.0**1.5)
    # a linear law needs small errors: a tenth of them, ten times
    noise = np.random.default_rng(7).multivariate_normal([0.0, 0.0], of_one[1:, 1:] / 100.0, size=(40_000, 2))
    (vx, vy), (ax, ay) = (noise[:, :, 0] + [3.0, 5.0]).T, (noise[:, :, 1] + [-14.0, 6.0]).T
    drawn = (vx * ay - vy * ax) / np.hypot(vx, vy) ** 3
    assert error[0] == pytest.approx(10.0 * np.std(drawn), rel=0.02)


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


def test_a_clean_run_has_no_flags() -> None:
    assert flagged(*run()) == {}


@pytest.mark.parametrize(
    ("aside", "flags"),
    [
        ({(17, 18): 20.0}, {"jump": [17]}),  # 200 m/s out and back
        ({(17, 18): 500.0, (19, 20): 500.0}, {"jump": [17, 19]}),  # at the same place; the point between is good
        ({(0, 1): 500.0}, {"jump": [0]}),
        ({(N - 1, N): 500.0}, {"jump": [N - 1]}),
        ({(17, N): 500.0}, {"impossible_step": [17]}),
        # 140 m/s once; the way past the point is hardly shorter than the one over it
        ({(17, N): 14.0}, {"impossible_step": [17]}),
        # a point far off where the track steps aside explains nothing
        ({(17, 18): 5000.0, (18, N): 500.0}, {"impossible_step": [17, 18]}),
        ({(17, 19): 500.0}, {"impossible_step": [17, 19]}),
    ],
)
def test_points_aside(aside: dict[tuple[int, int], float], flags: dict[str, list[int]]) -> None:
    """From one point up to another, by so many metres: what comes back at once is a jump, all else a step."""
    time, place = run()
    for (first, last), metres in aside.items():
        place[first:last, 0] += metres
    assert flagged(time, place) == flags


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


def test_a_gap_is_marked_behind_it() -> None:
    time, place = run()
    time[20:] += 0.41
    assert flagged(time, place) == {"gap": [20]}


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
