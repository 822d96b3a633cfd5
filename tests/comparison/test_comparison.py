"""Distances between tracks whose distances are known by hand."""

import math
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from skisnow._support.arrays import FloatArray
from skisnow._support.errors import ParameterError
from skisnow.comparison import Comparison, Distances, compare_tracks, comparison_dict
from skisnow.comparison.distances import DistanceStatistics, polyline, time_offsets
from skisnow.track.track import Track
from tests.coded import raises
from tests.present import present

from .made_tracks import arc, build_track, slalom, turned

ROUNDING = 1e-9
"""Of numbers that are exact but for the arithmetic, on tracks below 100 m."""


def numbers(found: Distances) -> DistanceStatistics:
    return present(found.numbers)


def every(found: Comparison) -> list[float]:
    return [
        value
        for each in (found.nearest, found.arc_length, found.time)
        for value in (numbers(each).max, numbers(each).mean, numbers(each).rms, numbers(each).compared)
    ]


def test_circles_of_one_centre() -> None:
    """12 and 12.5 m about one centre: 0.5 m by nearest place and at equal time; the chord grows at equal arc length."""
    angle = np.linspace(0.0, 1.0, 4001)
    found = compare_tracks(build_track(arc(12.5, angle)), build_track(arc(12.0, angle)))
    # a chord of 1/4000 rad is 12.5 m · (1/4000)²/8 = 1e-7 m inside its circle
    for each in (found.nearest, found.time):
        assert (numbers(each).max, numbers(each).mean, numbers(each).rms) == pytest.approx((0.5, 0.5, 0.5), abs=2e-7)
    assert numbers(found.nearest).compared == pytest.approx(12.0, abs=1e-6)
    # after 12 m: at angle 1 on the inner circle, 12/12.5 on the outer one
    between = math.sqrt(12.0**2 + 12.5**2 - 2.0 * 12.0 * 12.5 * math.cos(1.0 - 12.0 / 12.5))
    assert numbers(found.arc_length).max == pytest.approx(between, abs=2e-6)
    assert numbers(found.arc_length).max_at == pytest.approx(12.0, abs=1e-6)
    assert found.dimensions == 2


def test_a_straight_line_turned_about_its_start() -> None:
    length, angle = 67.0, 0.02
    straight = build_track([[0.0, 0.0], [length, 0.0]])
    other = build_track([[0.0, 0.0], [length * math.cos(angle), length * math.sin(angle)]])
    found = compare_tracks(other, straight)
    across, chord = length * math.sin(angle), 2.0 * length * math.sin(angle / 2.0)
    for each, end in ((found.nearest, across), (found.arc_length, chord), (found.time, chord)):
        assert numbers(each).max == pytest.approx(end, rel=ROUNDING)
        assert numbers(each).mean == pytest.approx(end / 2.0, rel=ROUNDING)
        assert numbers(each).rms == pytest.approx(end / math.sqrt(3.0), rel=ROUNDING)
        assert numbers(each).max_at == pytest.approx(length, rel=ROUNDING)
    assert found.largest_from_simulated == pytest.approx(across, rel=ROUNDING)


def test_parallel_lines_of_different_lengths_do_not_jump_at_the_ends() -> None:
    """The simulated line begins 3 m late and ends 10 m early: what it is not beside is left out, and that is said."""
    measured = build_track([[0.0, 0.0], [50.0, 0.0]])
    found = compare_tracks(build_track([[3.0, 0.7], [40.0, 0.7]]), measured)
    nearest = numbers(found.nearest)
    assert (nearest.max, nearest.mean, nearest.rms) == pytest.approx((0.7, 0.7, 0.7), rel=1e-4)
    # up to 1 % of 0.7 m ahead of an end still counts as beside it
    assert nearest.compared == pytest.approx(37.0 + 2 * 0.007, rel=1e-6)
    assert numbers(found.arc_length).compared == pytest.approx(37.0)
    assert any("only 37.01 of the 50 m" in text for text in found.warnings)


def test_crossing_lines() -> None:
    """d = |s − 5| sin α on ±5 m: mean 2.5 sin α, rms 5 sin α/√3, from both sides of the crossing."""
    angle = 0.3
    ahead = np.array([math.cos(angle), math.sin(angle)])
    found = compare_tracks(build_track(np.array([-6.0, 6.0])[:, None] * ahead), build_track([[-5.0, 0.0], [5.0, 0.0]]))
    nearest = numbers(found.nearest)
    assert nearest.max == pytest.approx(5.0 * math.sin(angle), rel=ROUNDING)
    # the seam between two places that are asked: 1e-7 of the length at most
    assert nearest.mean == pytest.approx(2.5 * math.sin(angle), abs=1e-6)
    assert nearest.rms == pytest.approx(5.0 * math.sin(angle) / math.sqrt(3.0), abs=1e-6)


def test_around_a_corner() -> None:
    """Measured straight along y = −1 below a corner at (0, 0): nearest is the corner between −45° and 45° of it."""
    corner = build_track([[-10.0, 10.0], [0.0, 0.0], [10.0, 10.0]])
    found = compare_tracks(corner, build_track([[-1.0, -1.0], [1.0, -1.0]]))
    integral = 0.5 * (math.sqrt(2.0) + math.asinh(1.0))  # mean of √(1 + x²) over 0…1
    assert numbers(found.nearest).mean == pytest.approx(integral, rel=1e-6)
    assert numbers(found.nearest).rms == pytest.approx(math.sqrt(4.0 / 3.0), rel=1e-6)
    assert numbers(found.nearest).max == pytest.approx(math.sqrt(2.0), rel=ROUNDING)


def test_the_same_way_later_in_time() -> None:
    """6 m/s, 0.25 s late: nothing by nearest place and arc length, 1.5 m at equal time over all but 1.5 m."""
    time = np.linspace(0.0, 5.0, 51)
    place = np.column_stack([6.0 * time, 0.0 * time, 0.0 * time])
    found = compare_tracks(build_track(place, time), build_track(place, time, first_time=0.25))
    for each in (found.nearest, found.arc_length):
        assert numbers(each).max == pytest.approx(0.0, abs=ROUNDING)
    assert (numbers(found.time).max, numbers(found.time).mean) == pytest.approx((1.5, 1.5), rel=ROUNDING)
    assert numbers(found.time).compared == pytest.approx(30.0 - 1.5)
    assert "in both files" in found.time.definition
    again = compare_tracks(build_track(place, time), build_track(place, time, first_time=0.25), time_from="first_point")
    assert numbers(again.time).max == pytest.approx(0.0, abs=ROUNDING)
    assert "first point" in again.time.definition


def test_another_speed_on_the_same_way() -> None:
    """6 and 5 m/s along one line: 1 m/s · t; over the measured length 25 m the mean is half of the last."""
    time = np.linspace(0.0, 5.0, 11)
    fast, slow = (np.column_stack([speed * time, 0.0 * time]) for speed in (6.0, 5.0))
    found = compare_tracks(build_track(fast, time), build_track(slow, time))
    assert (numbers(found.time).max, numbers(found.time).mean) == pytest.approx((5.0, 2.5), rel=ROUNDING)
    assert numbers(found.time).max_at == pytest.approx(25.0)
    turned_round = compare_tracks(build_track(slow, time), build_track(fast, time))
    assert numbers(turned_round.time).max_at == pytest.approx(30.0)
    assert numbers(turned_round.nearest).compared == pytest.approx(25.0, rel=1e-6)


def test_sampling_the_same_straight_pieces_otherwise_changes_nothing() -> None:
    random = np.random.default_rng(11)
    corners = slalom(np.linspace(0.0, 60.0, 25))
    time = np.linspace(0.0, 6.0, 25)
    other = corners + 0.3 * random.normal(size=corners.shape)
    coarse = compare_tracks(build_track(corners, time), build_track(other, time))

    def resampled(place: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
        moments = np.sort(np.concatenate([time, random.uniform(0.0, 6.0, count)]))
        return np.stack([np.interp(moments, time, column) for column in place.T], axis=1), moments

    for counts in ((0, 3000), (3000, 0), (700, 4000)):
        fine = compare_tracks(build_track(*resampled(corners, counts[0])), build_track(*resampled(other, counts[1])))
        # arc length and time are exact; the nearest place is followed within 1e-7 of the length
        assert every(fine)[4:] == pytest.approx(every(coarse)[4:], rel=1e-8)
        assert every(fine)[:4] == pytest.approx(every(coarse)[:4], rel=1e-5)
        assert fine.largest_from_simulated == pytest.approx(coarse.largest_from_simulated, rel=1e-5)


def test_means_are_over_the_length_and_not_over_the_points() -> None:
    """Half of the points stand still 1 m aside at the start; they do not weigh."""
    still, gone = np.zeros((50, 2)), np.column_stack([np.linspace(0.0, 10.0, 50), np.zeros(50)])
    measured = build_track(np.concatenate([still, gone]))
    simulated = build_track(np.column_stack([np.linspace(0.0, 10.0, 100), np.linspace(1.0, 0.0, 100)]))
    assert numbers(compare_tracks(simulated, measured).arc_length).mean == pytest.approx(0.5, rel=2e-2)


def test_heights_count_in_space_and_not_from_above() -> None:
    place = slalom(np.linspace(0.0, 40.0, 200))
    lifted = place + np.array([0.0, 0.0, 2.0])
    found = compare_tracks(build_track(lifted), build_track(place))
    assert found.dimensions == 3
    assert numbers(found.time).mean == pytest.approx(2.0)
    assert "in space" in found.seen
    above = compare_tracks(build_track(lifted), build_track(place), from_above=True)
    assert above.dimensions == 2
    assert numbers(above.time).max == pytest.approx(0.0, abs=ROUNDING)
    lifted[17, 2] = np.nan
    lacking = compare_tracks(build_track(lifted, name="mine"), build_track(place))
    assert lacking.dimensions == 2
    assert lacking.seen == "from above: 1 of the 200 points of mine have no height"


def test_a_detour_shows_the_other_way_round() -> None:
    measured = build_track([[0.0, 0.0], [20.0, 0.0]])
    found = compare_tracks(build_track([[0.0, 0.0], [10.0, 0.0], [10.0, 4.0], [10.0, 0.0], [20.0, 0.0]]), measured)
    assert numbers(found.nearest).max == pytest.approx(0.0, abs=ROUNDING)
    assert found.largest_from_simulated == pytest.approx(4.0)


def test_dates_are_a_common_clock() -> None:
    time = np.linspace(0.0, 5.0, 51)
    place = np.column_stack([6.0 * time, 0.0 * time])
    noon = datetime(2026, 1, 5, 12, tzinfo=UTC)

    def dated(later_s: float, scale: str = "UTC") -> Comparison:
        later = build_track(place, time, start=noon + timedelta(seconds=later_s), time_scale=scale)
        return compare_tracks(build_track(place, time, start=noon, time_scale="UTC"), later)

    assert numbers(dated(0.5).time).mean == pytest.approx(3.0)
    disjoint = dated(600.0).time
    assert disjoint.numbers is None
    assert "begins 600 s later" in str(disjoint.reason)
    assert "(UTC and GPS)" in str(dated(0.0, "GPS").time.reason)
    mixed = compare_tracks(build_track(place, time), build_track(place, time, start=noon))
    assert "first point" in mixed.time.definition


def test_times_that_are_missing_or_run_backwards_leave_the_rest() -> None:
    place = slalom(np.linspace(0.0, 40.0, 30))
    time = np.linspace(0.0, 3.0, 30)
    for wrong, told in ((np.full(30, np.nan), "not every point"), (time[::-1].copy(), "runs backwards")):
        found = compare_tracks(build_track(place, time), build_track(place, wrong))
        assert told in str(found.time.reason)
        assert numbers(found.nearest).max == pytest.approx(0.0, abs=ROUNDING)


def test_tracks_with_nothing_in_common_are_rejected() -> None:
    place = slalom(np.linspace(0.0, 40.0, 30))
    with raises(ParameterError, "nothing_common"):
        compare_tracks(build_track(place + np.array([0.0, 2100.0, 0.0])), build_track(place))
    with raises(ParameterError, "one_place"):
        compare_tracks(build_track(place), build_track(np.zeros((9, 2)), name="parked"))
    with raises(ParameterError, "unknown_offset", value="scale"):
        compare_tracks(build_track(place), build_track(place), fit=["scale"])


def test_opposite_ways_have_nothing_beside_each_other() -> None:
    found = compare_tracks(build_track([[-1.0, 0.0], [-20.0, 0.0]]), build_track([[0.0, 0.0], [20.0, 0.0]]))
    assert found.nearest.numbers is None
    assert "is beside it" in str(found.nearest.reason)
    assert numbers(found.arc_length).max == pytest.approx(1.0 + 2 * 19.0)  # 1 m apart, then each goes 19 m away


def test_unusable_points_are_left_out_and_counted() -> None:
    place = np.column_stack([np.linspace(0.0, 40.0, 30), np.zeros(30)])
    broken = place.copy()
    broken[12] = np.nan
    found = compare_tracks(build_track(place), build_track(broken, name="mine"))
    assert numbers(found.nearest).max == pytest.approx(0.0, abs=ROUNDING)
    assert any("mine: 1 of 30 points" in text for text in found.warnings)


def test_the_fit_says_by_how_much_and_keeps_what_was_before() -> None:
    time = np.linspace(0.0, 5.0, 400)
    place = slalom(60.0 * time / 5.0)
    measured = build_track(turned(place, -0.2, (1.0, 2.0, -3.0)), time, first_time=1.5)
    found = compare_tracks(build_track(place, time), measured, fit=["time", "heading", "start"])
    assert found.fitted is not None
    assert found.fitted.what == ("start", "heading", "time")
    assert found.fitted.moved == pytest.approx((1.0, 2.0, -3.0), abs=1e-7)
    assert (found.fitted.turned, found.fitted.later) == pytest.approx((-0.2, -1.5), abs=1e-7)
    assert max(every(found)[:3] + every(found)[4:7] + every(found)[8:11]) < 1e-6
    assert found.time.definition.partition("the fitted offset")[1]
    plain = compare_tracks(build_track(place, time), measured)
    assert plain.fitted is None
    assert "the fitted offset" not in plain.time.definition
    turned_alone = compare_tracks(build_track(place, time), measured, fit=["heading"])
    assert "the fitted offset" not in turned_alone.time.definition
    assert every(found.fitted.before) == pytest.approx(every(plain))
    assert numbers(plain.nearest).max > 2.0


def test_points_that_are_float_among_fixed_ones_are_reported() -> None:
    one = Track(
        "a", np.arange(4.0), np.arange(12.0).reshape(4, 3), np.full(4, np.nan), "local", "made",
        solution=np.array(["fixed", "float", "code", "fixed"]),
    )  # fmt: skip
    told = "a: of 4 points 1 float (decimetres off) and 1 by the code alone (metres off); the others are fixed"
    assert told in compare_tracks(one, one).warnings
    assert not compare_tracks(*[replace(one, solution=np.full(4, "float"))] * 2).warnings


def test_json_says_how_much_was_compared() -> None:
    """Beside 40 m of measured track a simulated one of 30 m: three quarters; nothing and a reason the other way."""
    short, long_ = build_track([[0.0, 0.0], [30.0, 0.0]]), build_track([[0.0, 0.0], [40.0, 0.0]])
    nearest = comparison_dict(compare_tracks(short, long_))["nearest"]
    assert (nearest["compared_m"], nearest["compared_share"]) == pytest.approx((30.0, 0.75))
    away = comparison_dict(compare_tracks(build_track([[-1.0, 0.0], [-20.0, 0.0]]), long_))["nearest"]
    assert (away["compared_m"], away["compared_share"], away["max_m"], away["max_share"]) == (0.0, 0.0, None, None)
    assert "is beside it" in away["reason"]


def test_tracks_that_have_one_moment_in_common_are_compared_there() -> None:
    """One ends at 10 s, where the other begins: 3 m to its side at that moment. A moment later there is nothing."""
    early = polyline(np.array([[0.0, 0.0], [5.0, 0.0]]), np.array([0.0, 10.0]))
    late = polyline(np.array([[5.0, 3.0], [9.0, 3.0]]), np.array([10.0, 20.0]))
    met = present(time_offsets(late, early))
    assert set(met.distance.tolist()) == {3.0}
    assert set(met.arc_length.tolist()) == {5.0}
    assert time_offsets(late, early, later=-0.001) is None


def test_an_arc_of_one_radius_has_an_uncertain_heading(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skisnow.comparison.alignment.PLACES", 256)
    angle = np.linspace(0.0, 0.8, 100)
    run = build_track(arc(20.0, angle), angle)
    noise = 0.05 * np.random.default_rng(2).normal(size=(100, 2))
    measured = build_track(run.place[:, :2] + noise, angle)
    found = compare_tracks(run, measured, fit=("start", "heading"))
    assert present(present(found.fitted).turned_error) > math.radians(2.0)
    assert any("uncertain" in each for each in found.warnings)
