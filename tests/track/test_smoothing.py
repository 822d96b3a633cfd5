"""Smoothing of a track and the estimate of its path."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.track_intervals import KINDS, Kind, estimates, row, simulated_track
from scipy.signal import savgol_filter
from scipy.special import spherical_jn

from skisnow import read_track
from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.track.curvature import track_motion
from skisnow.track.path_estimate import PathEstimate, _vertical_speed, estimate_path
from skisnow.track.smoothing import (
    MOST_IN_WINDOW,
    Resolution,
    _weighted_velocities,
    parts,
    smooth_track,
    window_bounds,
)
from skisnow.track.summary import summary_dict, track_summary
from skisnow.track.track import Track
from tests.coded import Coded, coded, raises
from tests.present import present

from .paths import NOISE, circle, track


def test_cubic_at_uneven_times_comes_back_exactly_and_even_times_give_the_filter_of_savitzky_and_golay() -> None:
    time = np.sort(np.random.default_rng(1).uniform(0.0, 5.0, 120))
    time -= time[0]
    place = np.stack([1.0 - 2.0 * time + 0.5 * time**3, 3.0 * time**2], axis=1)
    made = replace(track(place), time=time)
    found = smooth_track(made, window=1.2)
    assert found.velocity[:, 0] == pytest.approx(-2.0 + 1.5 * time**2, abs=1e-7)
    assert found.velocity[:, 1] == pytest.approx(6.0 * time, abs=1e-7)
    assert found.acceleration[:, 0] == pytest.approx(3.0 * time, abs=1e-5)  # a ridge of 1e-13 and rounding, over h²
    assert found.acceleration[:, 1] == pytest.approx(np.full_like(time, 6.0), abs=1e-5)
    made = track(circle(15.0, 8.0), noise=NOISE)
    found = smooth_track(made, window=1.0)
    for derivative, values in ((0, found.place), (1, found.velocity), (2, found.acceleration)):
        filtered = savgol_filter(made.place[:, :2], 11, 3, deriv=derivative, delta=0.1, axis=0, mode="interp")
        assert values == pytest.approx(filtered, abs=1e-7)  # the ends too: windows keep their length


def test_noise_is_estimated_from_the_scatter() -> None:
    """Its relative standard error is about 1/√(2 · degrees of freedom): 3 % with 8 s at 10 Hz, 1 % over 20 of them."""
    noises = [smooth_track(track(circle(15.0, 8.0), noise=NOISE, seed=seed)).place_noise for seed in range(20)]
    assert np.mean(noises) == pytest.approx(NOISE, rel=0.04)


def test_jump_without_a_mark_does_not_raise_the_noise_but_its_own_errors_and_marked_points_take_no_part() -> None:
    made = track(circle(15.0, 8.0, duration=30.0), noise=NOISE)
    before = smooth_track(made)
    made.place[150, 0] += 5.0
    after = smooth_track(made)
    assert after.place_noise == pytest.approx(before.place_noise, rel=0.05)
    assert after.covariance[150, 2, 2] > 1e3 * before.covariance[150, 2, 2]
    assert after.covariance[100, 2, 2] == pytest.approx(before.covariance[100, 2, 2], rel=0.2)
    made = track(circle(15.0, 8.0), noise=NOISE)
    jump = np.zeros(len(made), dtype=bool)
    jump[40] = True
    without = smooth_track(replace(made, flags={"jump": jump}))
    made.place[40] += 30.0
    assert smooth_track(replace(made, flags={"jump": jump})).velocity == pytest.approx(without.velocity, abs=1e-9)


def test_recorded_velocities_make_the_acceleration_surer_and_right() -> None:
    """Velocities with 5 cm/s beside places with 2 cm: (12·0.05²/0.8²)/(720·0.02²/0.8⁴) is less than a tenth."""
    place = circle(15.0, 8.0)
    made = track(place, noise=NOISE)
    angle = 8.0 * made.time / 15.0
    velocity = np.stack([8.0 * np.cos(angle), 8.0 * np.sin(angle), np.full_like(angle, np.nan)], axis=1)
    velocity[:, :2] += 0.05 * np.random.default_rng(5).standard_normal((len(angle), 2))
    plain, better = smooth_track(made), smooth_track(replace(made, velocity=velocity))
    assert better.speed_noise == pytest.approx(0.05, rel=0.2)
    middle = len(made) // 2
    assert better.covariance[middle, 2, 2] < 0.15 * plain.covariance[middle, 2, 2]
    apart = better.acceleration[:, 0] + 64.0 / 15.0 * np.sin(angle)
    share = np.mean(np.abs(apart) < 3.0 * np.sqrt(better.covariance[:, 2, 2]))
    assert share > 0.95


@pytest.mark.parametrize("every", [1, 2, 5, 10])
@pytest.mark.parametrize("noise", [0.0, NOISE])
def test_few_exact_velocities_do_not_hide_the_places(every: int, noise: float) -> None:
    place = circle(15.0, 8.0)
    made = track(place, noise=noise)
    velocity = np.full((len(made), 3), np.nan)
    velocity[::every, :2] = np.gradient(place, 0.1, axis=0)[::every]
    found = smooth_track(replace(made, velocity=velocity))
    assert found.place == pytest.approx(place, abs=0.02 + 4.0 * noise)


def test_windows_end_at_gaps() -> None:
    straight = np.stack([np.arange(60.0), np.zeros(60)], axis=1)
    made = track(straight)
    time = made.time + np.where(np.arange(60) >= 30, 20.0, 0.0)
    found = smooth_track(replace(made, time=time))
    assert found.part.tolist() == [0] * 30 + [1] * 30
    assert found.velocity[:, 0] == pytest.approx(np.full(60, 10.0), abs=1e-7)  # 1 m each 0.1 s, never 1 m in 20 s
    flagged = np.zeros(60, dtype=bool)
    flagged[10] = True
    assert parts(replace(made, flags={"gap": flagged}), np.ones(60, dtype=bool))[[9, 10]].tolist() == [0, 1]


def test_windows_keep_their_length_at_the_ends() -> None:
    first, last = window_bounds(np.arange(10.0), np.zeros(10, dtype=np.int64), 4.0)
    assert first.tolist() == [0, 0, 0, 1, 2, 3, 4, 5, 5, 5]
    assert last.tolist() == [5, 5, 5, 6, 7, 8, 9, 10, 10, 10]


def test_repeated_times_and_missing_places_are_left_out() -> None:
    made = track(np.stack([np.arange(40.0), np.zeros(40)], axis=1))
    made.time[20] = made.time[19]
    made.place[30] = np.nan
    found = smooth_track(made)
    assert not found.usable[[20, 30]].any()
    assert found.velocity[:, 0] == pytest.approx(np.full(40, 10.0), abs=1e-7)


def test_stated_accuracies_are_weights() -> None:
    """Half of the points are ten times worse and say so: the error is near that of the good half only."""
    made = track(circle(15.0, 8.0, duration=20.0), noise=NOISE)
    bad = np.arange(len(made)) % 2 == 1
    made.place[bad, :2] += 10.0 * NOISE * np.random.default_rng(9).standard_normal((int(bad.sum()), 2))
    stated = np.where(bad, 10.0, 1.0)[:, None] * np.full(3, NOISE)
    told = smooth_track(replace(made, place_sd=stated), window=2.0)
    untold = smooth_track(made, window=2.0)
    angle = 8.0 * made.time / 15.0
    errors = [np.std(found.velocity[:, 0] - 8.0 * np.cos(angle)) for found in (told, untold)]
    assert errors[0] < 0.4 * errors[1]


def test_dense_points_share_fits_and_know_it() -> None:
    """1 kHz, 801 points in a window: fits 20 points apart are the filter's own there, and differ little between."""
    made = track(circle(15.0, 8.0, duration=3.0, interval=0.001), interval=0.001, noise=0.002)
    found = smooth_track(made, window=0.8)
    for derivative, values, error in ((0, found.place, 0), (1, found.velocity, 1), (2, found.acceleration, 2)):
        filtered = savgol_filter(made.place[:, :2], 801, 3, deriv=derivative, delta=0.001, axis=0, mode="interp")
        typical = float(np.median(np.sqrt(found.covariance[:, error, error])))
        apart = (values - filtered)[400:-400]
        assert np.sqrt(np.mean(apart**2)) < 0.3 * typical  # windows a fortieth of their length aside share the noise
        assert np.abs(apart).max() < 1.5 * typical
    assert np.abs(np.diff(found.place, axis=0)).max() < 0.012  # 8 mm a point, no steps where fits change


@pytest.mark.parametrize(
    ("points", "options", "words"),
    [
        (5, {}, coded("too_few_points", count=5)),
        (40, {"window": 0.0}, coded("out_of_range", name="window", value=0.0, unit="s")),
        (40, {"window": float("nan")}, coded("out_of_range", name="window", unit="s")),
        (40, {"place_noise": -1.0}, coded("out_of_range", name="place_noise", value=-1.0, unit="m")),
    ],
)
def test_input_that_cannot_be_smoothed_is_rejected(points: int, options: dict[str, float], words: str | Coded) -> None:
    made: Track = track(np.stack([np.arange(float(points)), np.zeros(points)], axis=1))
    with raises(ParameterError, words):
        smooth_track(made, **options)


def test_points_that_are_closer_than_those_of_a_receiver(tmp_path: Path) -> None:
    path = tmp_path / "dense.csv"
    path.write_text(
        "\n".join(["time_s,x_m,y_m,z_m", *(f"{time}e-300,{time},0,0" for time in range(20)), "1e-9,20,0,0"])
    )
    with raises(ParameterError, "too_many_points", name="dense.csv", least=1e-6):
        track_summary(read_track(path))


def test_more_points_at_one_time_than_a_window_holds(tmp_path: Path) -> None:
    path = tmp_path / "crowded.csv"
    rows = [f"{time},{10 * time},0,0" for time in (0, 1, 2, *[3] * (MOST_IN_WINDOW + 5), 4, 5, 6)]
    path.write_text("\n".join(["time_s,x_m,y_m,z_m", *rows]))
    track = read_track(path)
    with raises(ParameterError, "too_many_points", name="crowded.csv"):
        track_summary(track)


@pytest.mark.parametrize("period", [0.5, 0.8, 1.2, 3.0])
def test_dense_points_pass_what_the_projection_on_a_parabola_passes(period: float) -> None:
    """The second derivative of the projection of exp(iωt) on P₂ is 15 j₂(z)/z² of its own, z = ω · half a window."""
    z = 2.0 * np.pi / period * 0.5
    found = Resolution.of_window(1.0, 0.0005, 0.02, None).share_passed(period)
    assert found == pytest.approx(15.0 * spherical_jn(2, z) / z**2, abs=3e-3)  # 401 points instead of an integral


@pytest.mark.usefixtures("pathless")
@pytest.mark.parametrize("share", [0.5, 0.9])
def test_wave_of_the_stated_period_keeps_the_stated_share(share: float) -> None:
    """A path y = a sin(2πt/T), x = vt with a slope of at most 0.01: its curvature is y''/v² within 0.02 %."""
    speed, interval, window = 10.0, 0.02, 1.0
    period = Resolution.of_window(window, interval, 1.0, None).period_passed(share)
    time = interval * np.arange(round(4.0 * period / interval))
    angular = 2.0 * np.pi / period
    amplitude = 0.01 * speed / angular
    place = np.stack([speed * time, amplitude * np.sin(angular * time)], axis=1)
    curvature = track_motion(track(place, interval=interval), window=window).curvature
    inner = slice(60, -60)
    true = -amplitude * angular**2 * np.sin(angular * time[inner]) / speed**2
    assert curvature[inner] @ true / (true @ true) == pytest.approx(share, rel=2e-3)


@pytest.mark.parametrize("period", [0.8, 1.2, 3.0])
def test_good_velocities_pass_what_the_projection_on_a_line_passes(period: float) -> None:
    """Their slope is that of the projection on P₁: 3 j₁(z)/z of a wave's own; surer than by places, not finer."""
    z = 2.0 * np.pi / period * 0.5
    found = Resolution.of_window(1.0, 0.0005, 1e6, 0.02).share_passed(period)
    assert found == pytest.approx(3.0 * spherical_jn(1, z) / z, abs=3e-3)


def test_resolution_scales_with_the_window() -> None:
    short, long = (Resolution.of_window(window, 0.001, 0.02, None).half_period for window in (1.0, 3.0))
    assert long == pytest.approx(3.0 * short, rel=2e-3)


SLOPE = 0.25


def linked_turns(period: float, *, speed: float = 12.0, count: int = 60, rate: float = 1.0) -> FloatArray:
    """Places (n, 3) of turns at constant speed, the heading swinging by 60 degrees, on a slope; without noise."""
    kind = Kind(noise=0.0, rate=rate, duration=(count - 1) / rate)
    fine = np.arange(0.0, kind.duration + 1e-9, 1e-3)
    heading = np.radians(60.0) * np.cos(2.0 * np.pi * fine / period)
    steps = 1e-3 * speed * np.stack([np.sin(heading), np.cos(heading)], axis=1)
    path = np.concatenate([[[0.0, 0.0]], np.cumsum((steps[1:] + steps[:-1]) / 2.0, axis=0)])
    place = path[:: round(1e3 / rate)]
    return np.column_stack([place, -SLOPE * place[:, 1]])


def estimate(place: FloatArray, *, rate: float = 1.0) -> PathEstimate:
    one = np.zeros(len(place), dtype=np.int64)
    return present(estimate_path(np.arange(float(len(place))) / rate, place, one, one))


@pytest.mark.parametrize(("period", "rate", "count"), [(4.0, 1.0, 40), (17.0, 2.0, 70), (4.0, 10.0, 80)])
def test_linked_turns_at_constant_speed(period: float, rate: float, count: int) -> None:
    """No maximum at an end, and no length below the polyline's."""
    place = linked_turns(period, rate=rate, count=count)
    found = estimate(place, rate=rate)
    speed = present(found.max_speed())
    assert speed.value == pytest.approx(12.0, rel=0.03)
    duration = (len(place) - 1) / rate
    assert found.length(with_heights=False).value == pytest.approx(12.0 * duration, rel=5e-3)
    steps = np.diff(place, axis=0)
    assert found.length().value >= float(np.sum(np.linalg.norm(steps, axis=1))) * (1.0 - 1e-6)
    assert found.length().value > found.length(with_heights=False).value


@pytest.mark.parametrize(
    "name", ["varied speed, noise 0.5 m", pytest.param("constant speed, noise 0.5 m", marks=pytest.mark.slow)]
)
def test_intervals_contain_the_truth(name: str) -> None:
    """A short form of the benchmark: of 3 tracks chance leaves out at most 1 in 993 of 1000 cases."""
    found = estimates(replace(KINDS[name], duration=6.0), range(3))
    assert len(found) == 3
    for truths, intervals in (
        ([each.track.max_speed for each in found], [each.max_speed for each in found]),
        ([each.track.length for each in found], [each.length for each in found]),
    ):
        inside = [low <= truth <= high for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert sum(inside) >= 2
        widths = [(high - low) / truth for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert 0.0 < float(np.median(widths)) < 0.15


@pytest.mark.slow
@pytest.mark.parametrize("name", list(KINDS))
def test_coverage_of_200_tracks(name: str) -> None:
    """Seeds that were not used to design the intervals; at least 90 %, less two binomial standard errors."""
    least = 0.90 - 2.0 * float(np.sqrt(0.90 * 0.10 / 200.0))
    found = estimates(KINDS[name], range(5000, 5200))
    for truths, intervals in (
        ([each.track.max_speed for each in found], [each.max_speed for each in found]),
        ([each.track.length for each in found], [each.length for each in found]),
    ):
        inside = [low <= truth <= high for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        assert sum(inside) / 200 >= least, row(name, found)
        half = [(high - low) / (2.0 * truth) for truth, (_, low, high) in zip(truths, intervals, strict=True)]
        errors = [value / truth - 1.0 for truth, (value, _, _) in zip(truths, intervals, strict=True)]
        assert float(np.median(half)) < 4.0 * float(np.sqrt(np.mean(np.square(errors)))), row(name, found)


def test_more_noise_is_a_wider_interval() -> None:
    """And the same track gives the same numbers."""
    places = [simulated_track(Kind(noise=noise, duration=4.0), 3).place for noise in (0.05, 2.0)]
    lengths = [estimate(place).length() for place in (*places, places[0])]
    widths = [length.high - length.low for length in lengths]
    assert widths[0] < widths[1]
    assert lengths[0] == lengths[2]


def test_gap_is_straight_and_a_pause_is_nothing() -> None:
    time = np.arange(40.0)
    place = np.column_stack([10.0 * time, np.zeros(40), np.full(40, np.nan)])
    time[20:] += 60.0
    place[20:, 0] += 600.0
    part = np.repeat([0, 1], 20)
    for segment, expected in ((np.zeros(40, dtype=np.int64), 990.0), (part, 380.0)):
        found = present(estimate_path(time, place, part.astype(np.int64), segment.astype(np.int64)))
        assert found.length().value == pytest.approx(expected, rel=1e-3)
        assert found.length(0.0, 19.0).value == pytest.approx(190.0, rel=1e-3)
        assert found.arc_length_at(np.array([99.0]))[0] == pytest.approx(expected, rel=1e-3)


def test_standing_still_is_hardly_a_path() -> None:
    """15 s of noise; its polyline would have more than 12 m."""
    place = np.column_stack([0.7 * np.random.default_rng(5).standard_normal((16, 2)), np.full(16, np.nan)])
    assert float(np.sum(np.hypot(*np.diff(place[:, :2], axis=0).T))) > 12.0
    assert estimate(place).length().value < 2.5


@pytest.mark.parametrize("points", [0, 1, 2, 3, 6])
def test_few_points(points: int) -> None:
    place = np.column_stack([10.0 * np.arange(float(points)), np.zeros(points), np.zeros(points)])
    one = np.zeros(points, dtype=np.int64)
    found = estimate_path(np.arange(float(points)), place, one, one)
    assert (found is None) == (points < 2)


@pytest.mark.parametrize(("interval", "count"), [(0.001, 250), (30.0, 20)])
def test_any_interval_between_points(interval: float, count: int) -> None:
    made: Track = track(circle(15.0, 8.0, duration=count * interval, interval=interval), interval=interval)
    summary = track_summary(made)
    if interval < 1.0:
        assert summary.max_speed == pytest.approx(8.0, rel=0.01)
        assert summary.distances["places"] == pytest.approx(8.0 * count * interval, rel=0.01)


def test_recorded_speeds_have_no_interval() -> None:
    made = track(circle(15.0, 8.0), speed=np.full(81, 8.0))
    values = summary_dict(track_summary(made))
    assert values["max_speed_m_per_s"] == 8.0
    assert [key for key, value in values.items() if "interval" in key and value is not None] == []
    places = summary_dict(track_summary(track(circle(15.0, 8.0), noise=0.02)))
    low, high = places["max_speed_interval_m_per_s"]
    assert low < places["max_speed_m_per_s"] < high
    assert places["runs"][0]["max_speed_interval_m_per_s"] is not None


def test_the_acceleration_of_a_cubic_is_exact_where_points_of_a_dense_window_are_left_out() -> None:
    found = Resolution.of_window(window=1.202, interval=1e-3, place_noise=1.0, rate_noise=None)
    assert sum(found.offsets) != 0.0  # every third of 1,203 points
    moments = [np.array(found.place_weights) @ np.array(found.offsets) ** power for power in range(4)]
    assert moments == pytest.approx([0.0, 0.0, 2.0, 0.0], abs=1e-8)


def test_velocities_weigh_by_the_square_of_their_stated_accuracy() -> None:
    made = track(circle(15.0, 8.0))
    made = replace(made, velocity=np.ones((len(made), 3)), speed_sd=np.resize([0.1, 0.2, np.nan], len(made)))
    weight = present(_weighted_velocities(made, np.ones(len(made), bool))).weight
    assert (weight[0] / weight[1], weight[2]) == (pytest.approx(4.0), 1.0)


def test_a_vertical_speed_is_the_mean_over_two_intervals_if_heights_curve_without_noise() -> None:
    """At the start it is the mean over the first interval; noise is what third differences leave."""
    time = 0.1 * np.arange(40.0)
    speed = present(_vertical_speed(time, 15.0 * time**2, np.zeros(40, np.int64), time))
    assert speed[0] == pytest.approx(15.0 * 0.1)
    noise = np.tile([1.0, -1.0], 20)  # 37 third differences of ±8, with a 0 behind them
    window = 8.0 / np.sqrt(20.0) * np.sqrt(37.0 / 38.0) / 0.3
    speed = present(_vertical_speed(time, noise, np.zeros(40, np.int64), time))
    later = np.interp(window / 2.0, time, noise)
    assert speed[0] == pytest.approx((later - 1.0) / (window / 2.0))
