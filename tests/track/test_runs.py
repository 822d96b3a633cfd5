"""Runs of a track and their summary."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import jsonschema
import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow._support.units import DEGREE
from skisnow.cli.shell import json_schema
from skisnow.track.curvature import track_motion
from skisnow.track.read import read_track
from skisnow.track.runs import Day, split_day, turning_points
from skisnow.track.summary import TrackSummary, half_wavelength, summary_dict, track_summary
from skisnow.track.track import Axes, Track
from skisnow.track.turns import _switch_time, find_turns
from tests.coded import raises

from .paths import NOISE, along, circle, track


class Leg(NamedTuple):
    """So long (s), with such a speed (m/s), climbing so fast (m/s)."""

    duration: int
    speed: float
    climb: float


LIFT, REST, RUN, QUEUE = Leg(300, 2.0, 0.5), Leg(60, 0.0, 0.0), Leg(100, 10.0, -1.5), Leg(80, 0.4, 0.0)


def day(legs: list[Leg], *, height_noise: float = 0.3, recorded: bool = True, axes: Axes = "east_north_up") -> Track:
    """A straight path at 1 Hz; without recorded speeds they change within 4 s, as a skier's do."""
    speed = np.concatenate([[legs[0].speed], *(np.full(leg.duration, leg.speed) for leg in legs)])
    if not recorded:
        speed = np.convolve(np.pad(speed, 2, mode="edge"), np.full(5, 0.2), mode="valid")
    climb = np.concatenate([[0.0], *(np.full(leg.duration, leg.climb) for leg in legs)])
    random = np.random.default_rng(7)
    x = np.cumsum(speed)
    height = np.cumsum(climb) + height_noise * random.standard_normal(len(x))
    place = np.stack([x + 0.05 * random.standard_normal(len(x)), np.zeros(len(x)), height], axis=1)
    unknown: FloatArray = np.full(len(x), np.nan)
    return Track("day", np.arange(float(len(x))), place, speed if recorded else unknown, "UTC", "made up", axes=axes)


def split(track: Track) -> Day:
    return split_day(track, track_motion(track))


@pytest.mark.parametrize(("recorded", "n_runs", "share"), [(True, 3, 1.0), (False, 1, 0.5)])
def test_day_of_runs(recorded: bool, n_runs: int, share: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """A cycle is 540 s or half of that; a run begins at 360 s of it, when the rest at the top ends, and takes 100 s."""
    monkeypatch.setattr("skisnow.track.path_estimate.EXCERPT", 60)  # a quarter of the time
    legs = [each._replace(duration=round(share * each.duration)) for each in (LIFT, REST, RUN, QUEUE)]
    found = split(day(legs * n_runs, recorded=recorded))
    assert found.split_by == "height"
    assert len(found.runs) == len(found.lifts) == n_runs
    for number, (run, lift) in enumerate(zip(found.runs, found.lifts, strict=True)):
        begin = 540.0 * share * number
        assert run.start == pytest.approx(begin + 360.0 * share, abs=1.0 if recorded else 5.0)  # 8 s of smoothing
        assert run.end == pytest.approx(begin + 460.0 * share, abs=2.0 if recorded else 6.0)
        length = share * (1000.0 if recorded else 100.0 * np.hypot(10.0, 1.5))  # recorded speeds are horizontal
        assert run.distance == pytest.approx(length, abs=15.0)
        assert run.descent == pytest.approx(150.0 * share, abs=2.5)
        assert run.max_speed == pytest.approx(10.0, abs=0.01 if recorded else 1.0)  # of noisy places
        assert lift.start == pytest.approx(begin, abs=25.0)  # 2 % of the height and a running mean of 15 s
        assert lift.end == pytest.approx(begin + 300.0 * share, abs=25.0)
        assert lift.descent == pytest.approx(-150.0 * share, abs=12.0)


def test_rest_on_the_slope_does_not_end_a_run_and_hump_that_speed_carries_over_is_no_lift() -> None:
    found = split(day([LIFT, REST, RUN, REST, REST, RUN._replace(duration=50), QUEUE]))
    assert len(found.runs) == 1
    assert found.runs[0].end - found.runs[0].start == pytest.approx(270.0, abs=3.0)
    # At 20 m/s one rolls 20.4 m up.
    fast = Leg(30, 20.0, -3.0)
    hump = Leg(10, 18.0, 1.8)
    found = split(day([LIFT, REST, fast, hump, fast, QUEUE]))
    assert len(found.runs) == len(found.lifts) == 1
    slow = Leg(60, 2.0, 0.3)
    assert len(split(day([LIFT, REST, RUN, slow, REST, RUN, QUEUE])).runs) == 2


def test_short_run_is_one_run_and_single_steep_run_without_a_lift_is_whole() -> None:
    whole = day([Leg(50, 0.8, -0.1)], height_noise=0.01)
    short = replace(whole, time=0.1 * whole.time, speed=10.0 * whole.speed)
    found = split(short)
    assert found.split_by == "motion"
    (run,) = found.runs
    assert (run.start, run.end) == (0.0, 5.0)
    assert run.distance == pytest.approx(40.0, rel=0.01)
    assert run.descent == pytest.approx(5.0, abs=0.1)
    assert found.lifts == ()
    found = split(day([Leg(40, 12.0, -3.0)]))
    (run,) = found.runs
    assert (run.start, run.end) == (0.0, 40.0)


def test_without_heights_stretches_in_motion_are_runs_and_it_is_reported() -> None:
    made = day([RUN, REST, RUN, Leg(10, 0.0, 0.0), RUN])
    made.place[:, 2] = np.nan
    found = split(made)
    assert len(found.runs) == 2
    assert [run.descent for run in found.runs] == [None, None]
    assert "No heights" in found.remarks[0]
    assert found.runs[1].end - found.runs[1].start == pytest.approx(210.0, abs=2.0)


def test_axis_out_of_the_slope_is_no_height() -> None:
    found = split(day([RUN], axes="slope"))
    assert found.runs[0].descent is None
    assert "slope" in found.remarks[0]
    level = split(day([Leg(100, 10.0, 0.0)], height_noise=0.01, axes="file"))
    assert level.runs[0].descent is None
    assert "third axis" in level.remarks[0]
    for heights in (day([RUN], axes="file"), day([Leg(100, 10.0, 0.0)], height_noise=0.01)):
        assert split(heights).runs[0].descent == pytest.approx(heights.place[0, 2] - heights.place[-1, 2], abs=2.0)


@pytest.mark.parametrize(
    ("curvature", "time"),
    [
        ([0.1, 0.07, 0.04, 0.01, -0.02], 10.0 / 3.0),
        ([0.1, np.nan, 0.04, 0.01, -0.02], 10.0 / 3.0),
        ([0.0] * 5, 2.0),  # nowhere and everywhere: the middle
        ([0.1, 0.09, 0.08, 0.07, 0.06], 2.0),  # beyond the end
    ],
)
def test_turns_meet_where_a_line_through_the_curvatures_passes_0(curvature: list[float], time: float) -> None:
    motion: Any = SimpleNamespace(time=10.0 + np.arange(6.0), curvature=np.array([0.2, *curvature]))
    assert _switch_time(motion, 1, 5) - 11.0 == pytest.approx(time, abs=1e-9)


def test_standing_still_has_no_run() -> None:
    assert split(day([REST, REST])).runs == ()


def test_height_that_drifts_while_someone_stands_is_no_run() -> None:
    assert split(day([REST, Leg(600, 0.01, -0.05), REST])).runs == ()


def test_gap_inside_a_run_is_counted() -> None:
    made = day([LIFT, REST, RUN, QUEUE])
    keep = np.r_[0:400, 420 : len(made)]
    cut = Track("cut", made.time[keep], made.place[keep], made.speed[keep], "UTC", "made up", axes="east_north_up")
    found = split(cut)
    assert [run.gaps for run in found.runs] == [1]
    assert found.runs[0].distance == pytest.approx(1000.0, abs=15.0)


def test_heights_at_every_fifth_point_are_enough() -> None:
    made = day([LIFT, REST, RUN, QUEUE])
    made.place[np.arange(len(made)) % 5 != 0, 2] = np.nan
    (run,) = split(made).runs
    assert run.descent == pytest.approx(150.0, abs=2.5)


def test_small_ups_and_downs_do_not_count() -> None:
    height = np.array([100.0, 104.0, 101.0, 180.0, 176.0, 179.0, 90.0, 96.0, 85.0, 130.0, 128.0])
    assert turning_points(height, 10.0) == [0, 3, 8, 9, 10]
    assert turning_points(height, 1.0) == list(range(11))


@pytest.mark.parametrize("values", [[5.0], [5.0, 5.0, 5.0], [0.0, 4.0, 0.0]])
def test_level_has_only_its_ends(values: list[float]) -> None:
    assert turning_points(np.array(values), 10.0) == sorted({0, len(values) - 1})


def test_neighbours_differ_enough() -> None:
    height = np.cumsum(np.random.default_rng(5).standard_normal(2000))
    corners = turning_points(height, 4.0)
    assert len(corners) > 20
    assert np.abs(np.diff(height[corners]))[1:-1].min() >= 4.0
    assert np.all(np.diff(np.sign(np.diff(height[corners])))[1:-1] != 0)


SPEED, STEP = 10.0, 0.01


def sine(turns: int, *, length: float = 15.0, least_radius: float = 12.0) -> FloatArray:
    """Curvature of equal turns, the first to the left, each half a sine over ``length`` (m)."""
    along = STEP * np.arange(round(turns * length / STEP) + 1)
    return np.asarray(np.sin(np.pi * along / length) / least_radius)


@pytest.mark.usefixtures("pathless")
@pytest.mark.parametrize("seed", range(2))
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


@pytest.mark.usefixtures("pathless")
def test_straight_line_has_no_turn_and_wiggle_below_ten_degrees_does_not_part_a_turn() -> None:
    straight = np.stack([np.arange(100.0), np.zeros(100)], axis=1)
    for seed in range(2):
        assert find_turns(track_motion(track(straight, noise=NOISE, seed=seed))) == ()
    # Left 20 m, right 1.5 m by 4°, left 20 m: one turn, and two where 3° make one.
    curvature = np.full(round(41.5 / STEP) + 1, 1.0 / 20.0)
    curvature[round(20.0 / STEP) : round(21.5 / STEP)] = -4.0 * DEGREE / 1.5
    motion = track_motion(track(along(curvature, STEP)[::10], interval=0.01), window=0.06)
    assert [turn.direction for turn in find_turns(motion)] == ["left"]
    parted = find_turns(motion, least_angle=3.0 * DEGREE)
    assert [turn.direction for turn in parted] == ["left", "right", "left"]
    assert [turn.start for turn in parted[1:]] == pytest.approx([2.0, 2.15], abs=0.02)


@pytest.mark.usefixtures("pathless")
def test_long_straight_parts_two_turns_to_one_side() -> None:
    """Between them 30 m, 3 s; each turns 20/20 rad."""
    curvature = np.concatenate([np.full(2000, 1.0 / 20.0), np.zeros(3000), np.full(2001, 1.0 / 20.0)])
    turns = find_turns(track_motion(track(along(curvature, STEP)[::100], noise=0.002, seed=1)))
    assert [turn.direction for turn in turns] == ["left", "left"]
    assert [turns[0].end, turns[1].start] == pytest.approx([2.0, 5.0], abs=0.35)  # the smoothing spreads 0.4 s
    for turn in turns:
        assert turn.turned_angle == pytest.approx(1.0, abs=0.03)


@pytest.mark.usefixtures("pathless")
def test_turn_ends_at_a_gap() -> None:
    place = along(np.full(4001, 1.0 / 20.0), STEP)[::100]
    made = track(place, noise=0.002)
    made.time[20:] += 30.0
    turns = find_turns(track_motion(made))
    assert [turn.direction for turn in turns] == ["left", "left"]
    assert turns[0].end <= made.time[19]
    assert turns[1].start >= made.time[20]


@pytest.mark.usefixtures("pathless")
def test_part_of_a_track() -> None:
    motion = track_motion(track(along(sine(4), STEP)[::100], noise=0.005))
    assert [turn.direction for turn in find_turns(motion, first=16, last=29)] == ["right"]


@pytest.mark.usefixtures("pathless")
def test_wide_bend_is_straight() -> None:
    for radius, turns in ((600.0, 0), (400.0, 1)):
        bend = along(np.full(15_001, 1.0 / radius), STEP)[::200]
        assert len(find_turns(track_motion(track(bend)))) == turns


@pytest.mark.usefixtures("pathless")
def test_share_passed_is_that_of_half_a_sine_as_long_as_the_turn() -> None:
    """A window of 1.6 s leaves 0.81 of turns of 1.5 s; the given radius times the share is the true one, 12 m."""
    motion = track_motion(track(along(sine(4), STEP)[::10], interval=0.01), window=1.6)
    for turn in find_turns(motion)[1:-1]:
        assert turn.least_radius > 14.0
        assert turn.share_passed * turn.least_radius == pytest.approx(12.0, rel=0.02)


SCHEMA = json_schema("track")
DAY = Path(__file__).resolve().parents[3] / "shared" / "data" / "ski-track" / "morin_heights_2022-12-27.csv"
DEVICE_DISTANCE, DEVICE_TOP_SPEED = 13731.42, 15.546


@pytest.fixture(scope="module")
def real_day() -> TrackSummary:
    if not DAY.exists():
        pytest.skip("the recorded day is not beside the repository")
    return track_summary(read_track(DAY))


def checked(summary: TrackSummary) -> dict[str, Any]:
    values = summary_dict(summary)
    text = json.dumps(values, allow_nan=False)
    jsonschema.validate(json.loads(text), SCHEMA)
    return values


def test_recorded_day_has_the_devices_distance_and_top_speed(real_day: TrackSummary) -> None:
    values = checked(real_day)
    assert values["points"] == 5898
    assert values["distance_m"] == pytest.approx(DEVICE_DISTANCE, rel=0.01)
    assert values["max_speed_m_per_s"] == pytest.approx(DEVICE_TOP_SPEED, abs=1e-3)
    assert sum(values["marked"].values()) >= 13  # repeated time stamps


@pytest.mark.usefixtures("pathless")
def test_points_by_carrier_phase_are_counted() -> None:
    one = track(circle(12.0, 9.0, duration=2.0))
    assert checked(track_summary(one))["solutions"] is None
    mixed = np.where(np.arange(len(one)) < 3, "float", "fixed")
    assert checked(track_summary(replace(one, solution=mixed)))["solutions"] == {"fixed": len(one) - 3, "float": 3}
    assert checked(track_summary(replace(one, solution=np.full(len(one), "code"))))["solutions"] is None


def test_recorded_day_has_nine_lifts_and_nine_runs(real_day: TrackSummary) -> None:
    """The heights show nine ascents from 306 to 436 m and as many descents; the last ends on the way, at 317 m."""
    values = checked(real_day)
    assert len(values["runs"]) == len(values["lifts"]) == 9
    for lift, run in zip(values["lifts"], values["runs"], strict=True):
        assert lift["end_s"] <= run["start_s"] < run["end_s"]
        assert 110.0 < run["descent_m"] < 135.0
        assert 600.0 < run["distance_m"] < 1100.0
        assert 8.0 < run["max_speed_m_per_s"] <= 15.546
        assert lift["max_speed_m_per_s"] < 3.0
    assert max(run["max_speed_m_per_s"] for run in values["runs"]) == values["max_speed_m_per_s"]
    for turn in values["turns"]:
        assert any(run["start_s"] <= turn["start_s"] < turn["end_s"] <= run["end_s"] for run in values["runs"])


def test_places_tell_the_days_distance_too(real_day: TrackSummary) -> None:
    """An independent way; 1 Hz is too coarse for much better, and places wander in queues."""
    assert real_day.distances["places"] == pytest.approx(DEVICE_DISTANCE, rel=0.03)
    assert any("recorded speed" in remark for remark in real_day.remarks)  # 10 % less: it lags


def test_short_local_track() -> None:
    made = track(circle(15.0, 8.0, duration=5.0), noise=NOISE)
    values = checked(track_summary(made))
    (run,) = values["runs"]
    assert (run["start_s"], run["end_s"], run["descent_m"]) == (0.0, 5.0, None)
    assert values["distance_m"] == pytest.approx(40.0, rel=0.01)
    assert values["distance_source"] == "places"
    (turn,) = values["turns"]
    assert turn["direction"] == "left"
    assert (turn["start_s"], turn["end_s"]) == pytest.approx((0.0, 5.0), abs=0.4)  # the ends are the least sure
    angle = np.degrees(8.0 * (turn["end_s"] - turn["start_s"]) / 15.0)
    assert turn["turned_angle_deg"] == pytest.approx(angle, abs=4.0 * turn["turned_angle_sd_deg"])
    assert turn["turned_angle_sd_deg"] < 2.5
    low, high = turn["least_radius_interval_m"]
    assert low < turn["least_radius_m"] < high
    assert turn["least_radius_m"] == pytest.approx(15.0, rel=0.15)  # the largest of 40 noisy curvatures, 5 % each


@pytest.mark.usefixtures("pathless")
def test_wavelength_is_speed_times_period() -> None:
    summary = track_summary(track(circle(15.0, 8.0)))
    assert half_wavelength(summary) == pytest.approx(8.0 * summary.motion.smoothed.resolution.half_period, rel=2e-3)


def test_track_at_rest_has_nothing_but_nulls_and_zeros() -> None:
    values = checked(track_summary(track(np.zeros((60, 2)))))
    assert values["runs"] == values["turns"] == []
    assert values["distance_m"] == pytest.approx(0.0, abs=1e-6)
    assert values["smoothing"]["half_amplitude_wavelength_m"] is None


@pytest.mark.usefixtures("pathless")
def test_a_gap_is_reported() -> None:
    made = track(circle(15.0, 8.0))
    made.time[40:] += 20.0
    summary = track_summary(made)
    assert any(remark.startswith("1 gap") for remark in summary.remarks)
    assert np.isfinite(summary.motion.curvature).all()


@pytest.mark.slow
def test_million_points_fit() -> None:
    """Seconds and some hundred MB; nothing is timed here, but a loop over points or a full matrix would not end."""
    made = track(circle(15.0, 8.0, duration=20_000.0, interval=0.1), noise=NOISE)
    assert len(made) == 200_001
    values = checked(track_summary(made))
    assert values["distance_m"] == pytest.approx(160_000.0, rel=3e-3)


@pytest.mark.parametrize("points", [0, 1, 5])
def test_too_few_points(points: int) -> None:
    made: Track = track(circle(15.0, 8.0))
    keep = slice(0, points)
    few = replace(made, time=made.time[keep], place=made.place[keep], speed=made.speed[keep])
    with raises(ParameterError, "too_few_points", name="made", count=points):
        track_summary(few)


def test_window_without_points() -> None:
    with raises(ParameterError, "too_few_points", window=0.2):
        track_summary(track(circle(15.0, 8.0)), window=0.2)
