"""Parts of the skier: its plan, its line through gates, edges, legs, body, and what a scenario may say of it."""

import importlib
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from markupsafe import Markup

from skisnow import load_scenario, simulate, time_gates
from skisnow._support.errors import ParameterError
from skisnow.report.figures.drawing import Picture
from skisnow.report.run.drawings import run_drawings
from skisnow.report.run.page import FIGURES, FURTHER, run_page
from skisnow.scenario import Skier, scenario_values
from skisnow.simulation.run_summary import summary_dict
from skisnow.skier import anthropometry, body_of
from skisnow.skier.carve import CarvesOverTime, Pursuit, Underway
from skisnow.skier.edges import Edges
from skisnow.skier.plan import HalfWaves, TurnsOverTime
from tests.coded import Coded, coded, raises
from tests.present import present

STEEP = 9.81


def test_plan() -> None:
    """A half turn, then whole ones to the other side."""
    plan = TurnsOverTime(Skier(first_turn=1.0))
    assert [plan.sense(time) for time in (0.9, 1.1, 1.9, 2.1, 3.9, 4.1, 9.9, 10.1)] == [0, 1, 1, -1, -1, 1, 1, 0]
    assert TurnsOverTime(Skier(first_turn=1.0, first_to_left=False)).sense(1.5) == -1.0
    assert CarvesOverTime(plan).acceleration(Underway(1.5, 0.0, 0.0, 0.0, 7.0, 0.0), 4.0) == 4.0


APEXES = [(0.0, 0.0), (10.0, 3.0), (20.0, -3.0), (30.0, 3.0)]


def test_half_waves_go_from_apex_to_apex() -> None:
    found = HalfWaves(APEXES)
    assert [found.at(x)[0] for x in (0.0, 10.0, 20.0, 30.0, 50.0)] == pytest.approx([0.0, 3.0, -3.0, 3.0, 3.0])
    step = 1e-4
    for x in (4.0, 13.0, 27.0):  # slope and second derivative are those of the line
        below, here, above = (found.at(x + d)[0] for d in (-step, 0.0, step))
        assert found.at(x)[1] == pytest.approx((above - below) / (2 * step), rel=1e-6)
        assert found.at(x)[2] == pytest.approx((above - 2 * here + below) / step**2, rel=1e-3)


def test_who_is_on_the_line_turns_as_it_does_and_who_is_beside_it_goes_back() -> None:
    found = Pursuit(HalfWaves(APEXES), rate=2.0, sight=0.2)
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
        assert angles[-1] <= found.steepest(speed)
        assert found.angle(-asked[30], -asked[30] / STEEP, speed, 730.0) == pytest.approx(-angles[30])


def test_a_slow_carve_is_edged_by_60_degrees_at_most_and_a_fast_one_by_35_more_than_its_lean() -> None:
    found = edges()
    speeds = np.sqrt(found.radius * STEEP * np.sin(np.radians([10.0, 28.0, 60.0])))  # of these leans in balance
    assert [math.degrees(found.steepest(each)) for each in speeds] == pytest.approx([60.0, 63.0, 66.0])
    assert math.degrees(found.angle(20.0, 0.1, speeds[0], 730.0)) == pytest.approx(60.0)


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


def test_a_body_scales_and_a_body_is_the_mean_of_three_men() -> None:
    one, other = body_of(75.0, 1.76), body_of(150.0, 1.76)
    assert other.inertia == pytest.approx([2.0 * each for each in one.inertia])
    assert 0.54 < one.standing_height / 1.76 < 0.58
    assert load_scenario("skier-10deg").sledge.inertia == pytest.approx(one.inertia, abs=0.06)
    with pytest.raises(ParameterError, match="from 20 to 200"):
        body_of(7.0, 1.76)
    # Weights (lb), heights and centres of mass (in), moments (lb in s²) standing and crouched, of the report.
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
    legs = (anthropometry.FOOT, anthropometry.SHANK, anthropometry.THIGH)
    arms = (anthropometry.UPPER_ARM, anthropometry.FOREARM)
    assert sum(each.length for each in legs) == pytest.approx(0.530)
    assert sum(each.length for each in (*legs, anthropometry.TRUNK)) == pytest.approx(0.818)
    assert [each.length for each in arms] == [0.186, 0.146]
    assert sum(each.mass for each in legs) == pytest.approx(0.161)
    assert sum(each.mass for each in arms) == pytest.approx(0.050)
    assert 2.0 * (0.161 + 0.050) + anthropometry.TRUNK.mass == pytest.approx(1.0)
    assert [each.centre for each in (*legs, *arms)] == [0.5, 0.433, 0.433, 0.436, 0.682]
    assert anthropometry.TRUNK.centre == 0.66
    assert (anthropometry.SHOULDER_WIDTH, anthropometry.HIP_WIDTH) == (0.259, 0.191)


def test_heights_by_roll_inertia_are_kept_within_people() -> None:
    roll = body_of(75.0, 1.8).inertia[0]
    assert anthropometry.height_of(150.0, 2.0 * roll) == pytest.approx(1.8)
    assert (anthropometry.height_of(75.0, 1e-3), anthropometry.height_of(75.0, 1e3)) == (1.0, 2.3)


def test_keys_of_a_skier() -> None:
    found = load_scenario("skier-10deg", changes={"skier.turn_time_s": 1.5})
    assert present(found.skier).turn_time == 1.5
    assert scenario_values(found)["skier.steers"] == "turns"
    assert load_scenario("carved-46m").skier is None
    assert scenario_values(load_scenario("carved-46m"))["skier.steers"] is None


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"sledge.edge_angle_deg": 5.0}, coded("contradiction", degrees=5.0)),
        ({"skier.steers": "gates"}, "contradiction"),
        ({"skier.longest_leg_m": 0.5}, coded("out_of_range", longest_leg=0.5, centre_of_mass=0.6)),
        ({"skier.turn_time_s": 0.0}, coded("out_of_range", name="skier.turn_time_s")),
        ({"skier.turn_times_s": 2.0}, "unknown_name"),
    ],
)
def test_what_a_skier_cannot_do_is_refused(changes: dict[str, object], told: str | Coded) -> None:
    with raises(ParameterError, told):
        load_scenario("skier-10deg", changes=changes)


def test_the_page_has_every_figure_of_a_skier_and_calls_nobody_a_sledge() -> None:
    run = simulate(load_scenario("skier-10deg").with_(duration_s=0.05, method="fast"))
    pictures = [
        Picture(each.name, Markup(""), f"the figure {each.name}", True, "<svg/>", b"") for each in run_drawings(run)
    ]
    assert {each.name for each in pictures} == {*FIGURES, *FURTHER} - {"course", "boots"}
    page = run_page(run, summary_dict(run), pictures)
    assert [name for name in (*FIGURES, "balance") if f"the figure {name}" not in page] == []
    assert "A simulated run of a skier on two flexible skis" in page
    assert "edged by the skier" in page


watched_slope: Any = importlib.import_module("watched_slope")


def test_a_profile_is_that_of_the_way(tmp_path: Path) -> None:
    """One that falls by a tenth from 100 m on, and not before."""
    day, profile = tmp_path / "day.csv", tmp_path / "profile.csv"
    lines = (f"1,{way},{50.0 - 0.1 * max(0.0, way - 100.0)}" for way in range(0, 400, 4))
    day.write_text("\n".join(["lap,dist_m,alt_m", *lines, "1,,5"]), encoding="utf-8")
    angles = watched_slope.write_profile(profile, 80.0, 200.0, day)
    assert angles[60:] == pytest.approx(np.degrees(np.arctan(0.1)), abs=0.01)
    assert 0.0 < angles[0] < 0.5
    x, y = np.loadtxt(profile, delimiter=",", skiprows=1).T
    assert (x[0], x[-1]) == (-20.0, 229.0)
    assert y[0] - y[-1] == pytest.approx(0.1 * 209.0, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "begins", "length"),
    [
        ("slalom-20-gates", 4420.0, 203.0),
        ("slalom-20-gates", 11710.0, 203.0),
        pytest.param(
            "giant-slalom-20-gates",
            11600.0,
            477.0,
            marks=pytest.mark.xfail(reason="the skier straddles a gate of the giant slalom on 12 degrees", strict=True),
        ),
    ],
)
def test_twenty_gates_on_a_measured_profile(tmp_path: Path, name: str, begins: float, length: float) -> None:
    if not watched_slope.DAY.exists():
        pytest.skip("the shared tracks are not beside this repository")
    profile = tmp_path / "profile.csv"
    watched_slope.write_profile(profile, begins, length)
    changes = {"slope.kind": "profile", "slope.profile": str(profile), "solver.method": "fast"}
    run = simulate(load_scenario(name, changes=changes))
    assert run.outcome == "finished"
    course = present(run.scenario.course)
    assert [each.outcome for each in time_gates(course, run).passages] == 20 * ["passed"]
    assert run.energy_balance_error == pytest.approx(0.0, abs=1e-3)
