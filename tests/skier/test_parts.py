"""Parts of the skier: its plan, its line through gates, edges, legs, body, and what a scenario may say of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from skisnow import load_scenario
from skisnow._support.errors import ParameterError
from skisnow.scenario import Skier, scenario_values
from skisnow.skier import body_of, segments
from skisnow.skier.carve import CarvesOverTime, Pursuit, Underway
from skisnow.skier.edges import Edges
from skisnow.skier.plan import TurnsOverTime, half_waves

STEEP = 9.81


def test_plan() -> None:
    """A half turn, then whole ones to the other side."""
    plan = TurnsOverTime(Skier(first_turn=1.0))
    assert [plan.sense(time) for time in (0.9, 1.1, 1.9, 2.1, 3.9, 4.1, 9.9, 10.1)] == [0, 1, 1, -1, -1, 1, 1, 0]
    assert TurnsOverTime(Skier(first_turn=1.0, first_to_left=False)).sense(1.5) == -1.0
    assert CarvesOverTime(plan).acceleration(Underway(1.5, 0.0, 0.0, 0.0, 7.0, 0.0), 4.0) == 4.0


APEXES = [(0.0, 0.0), (10.0, 3.0), (20.0, -3.0), (30.0, 3.0)]


class Waves:
    """A line from apex to apex."""

    def at(self, x: float) -> tuple[float, float, float]:
        return half_waves(APEXES, x)


def test_half_waves_go_from_apex_to_apex() -> None:
    found = Waves()
    assert [found.at(x)[0] for x in (0.0, 10.0, 20.0, 30.0, 50.0)] == pytest.approx([0.0, 3.0, -3.0, 3.0, 3.0])
    step = 1e-4
    for x in (4.0, 13.0, 27.0):  # slope and second derivative are those of the line
        below, here, above = (found.at(x + d)[0] for d in (-step, 0.0, step))
        assert found.at(x)[1] == pytest.approx((above - below) / (2 * step), rel=1e-6)
        assert found.at(x)[2] == pytest.approx((above - 2 * here + below) / step**2, rel=1e-3)


def test_who_is_on_the_line_turns_as_it_does_and_who_is_beside_it_goes_back() -> None:
    found = Pursuit(Waves(), rate=2.0, sight=0.2)
    aside, slope, bend = found.line.at(10.0)  # at the apex, where it looks to
    on = Underway(0.0, 10.0 - 0.2 * 6.0, aside, math.atan(slope), 6.0, 0.0)
    assert found.acceleration(on, 1.0) == pytest.approx(36.0 * bend, abs=0.2)
    on.y += 0.5
    assert found.acceleration(on, 1.0) < 36.0 * bend - 1.0


def edges() -> Edges:
    return Edges.of(load_scenario("skier-10deg"), STEEP, Skier())


def test_more_acceleration_takes_more_edge_and_left_is_as_right() -> None:
    found = edges()
    for speed in (3.0, 7.0, 11.0):
        asked = np.linspace(0.0, 1.2 * found.carving_acceleration(speed), 60)
        angles = [found.angle(each, each / STEEP, speed, 730.0) for each in asked]
        assert (np.diff(angles) > -1e-12).all()
        assert angles[0] == 0.0
        assert angles[-1] <= found.greatest
        assert found.angle(-asked[30], -asked[30] / STEEP, speed, 730.0) == pytest.approx(-angles[30])


def test_a_wedge_holds_the_root_of_its_angle() -> None:
    """Four times the tangent holds twice as much, at a load of 365 N on each ski: 0.44 of it at 1°."""
    found = edges()
    assert math.tan(found.skidding(0.8, 730.0)) == pytest.approx(4.0 * math.tan(found.skidding(0.4, 730.0)))
    assert math.degrees(found.skidding(0.44, 730.0)) == pytest.approx(1.0, rel=0.15)


def test_a_carve_in_balance_leans_as_it_must() -> None:
    """tan ϑ = a/g, sin ϑ = v²/(R_sc g)."""
    found, speed = edges(), 8.0
    lean = math.asin(speed**2 / (found.radius * STEEP))
    assert found.carving_acceleration(speed) == pytest.approx(STEEP * math.tan(lean))


def test_a_race_piste_holds_whatever_is_asked() -> None:
    found = edges()
    assert found.held(11.0, 2.0, 736.0) == 11.0
    assert found.holding(736.0) > 4.0


def test_a_body_scales() -> None:
    one, other = body_of(75.0, 1.76), body_of(150.0, 1.76)
    assert other.inertia == pytest.approx([2.0 * each for each in one.inertia])
    assert 0.54 < one.standing_height / 1.76 < 0.58
    assert load_scenario("skier-10deg").sledge.inertia == pytest.approx(one.inertia, abs=0.06)
    with pytest.raises(ParameterError, match="from 20 to 200"):
        body_of(7.0, 1.76)


def test_a_body_is_the_mean_of_three_men() -> None:
    """Weights (lb), heights and centres of mass (in), moments (lb in s²) standing and crouched, of the report."""
    men = (
        (173.5, 72.2, 32.2, (132.0 + 41.4, 119.0 + 37.3, 13.1 + 29.9)),
        (147.3, 67.4, 29.8, (95.6 + 32.9, 81.9 + 30.4, 10.3 + 21.5)),
        (203.0, 73.3, 31.8, (144.0 + 48.9, 129.0 + 41.9, 14.2 + 36.7)),
    )
    found = body_of(80.0, 1.7)
    for i in range(3):
        means = [0.5 * both[i] * 386.0886 / (weight * tall**2) for weight, tall, _, both in men]  # in/s² of gravity
        assert found.inertia[i] == pytest.approx(80.0 * 1.7**2 * sum(means) / 3.0, rel=1e-5)
    assert found.standing_height == pytest.approx(1.7 * sum(1.0 - below / tall for _, tall, below, _ in men) / 3.0)


def test_segments_make_a_whole_body() -> None:
    """Winter's figure: hips at 0.530, shoulders at 0.818 of the height; a leg 0.161, an arm 0.050 of the mass."""
    legs = (segments.FOOT, segments.SHANK, segments.THIGH)
    arms = (segments.UPPER_ARM, segments.FOREARM)
    assert sum(each.length for each in legs) == pytest.approx(0.530)
    assert sum(each.length for each in (*legs, segments.TRUNK)) == pytest.approx(0.818)
    assert [each.length for each in arms] == [0.186, 0.146]
    assert sum(each.mass for each in legs) == pytest.approx(0.161)
    assert sum(each.mass for each in arms) == pytest.approx(0.050)
    assert 2.0 * (0.161 + 0.050) + segments.TRUNK.mass == pytest.approx(1.0)
    assert [each.centre for each in (*legs, *arms)] == [0.5, 0.433, 0.433, 0.436, 0.682]
    assert segments.TRUNK.centre == 0.66
    assert (segments.SHOULDER_WIDTH, segments.HIP_WIDTH) == (0.259, 0.191)


def test_heights_by_roll_inertia_are_kept_within_people() -> None:
    roll = body_of(75.0, 1.8).inertia[0]
    assert segments.height_of(150.0, 2.0 * roll) == pytest.approx(1.8)
    assert (segments.height_of(75.0, 1e-3), segments.height_of(75.0, 1e3)) == (1.0, 2.3)


def test_keys_of_a_skier() -> None:
    found = load_scenario("skier-10deg", changes={"skier.turn_time_s": 1.5})
    assert found.skier is not None
    assert found.skier.turn_time == 1.5
    assert scenario_values(found)["skier.steers"] == "turns"
    assert load_scenario("carved-46m").skier is None
    assert scenario_values(load_scenario("carved-46m"))["skier.steers"] is None


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sledge.edge_angle_deg": 5.0}, "write 0"),
        ({"skier.steers": "gates"}, "without a course"),
        ({"skier.longest_leg_m": 0.5}, "longer than that"),
        ({"skier.turn_time_s": 0.0}, "above 0"),
        ({"skier.turn_times_s": 2.0}, "turn_time_s"),
    ],
)
def test_what_a_skier_cannot_do_is_refused(changes: dict[str, object], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        load_scenario("skier-10deg", changes=changes)
