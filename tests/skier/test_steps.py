"""The parts of a skier that pivots, by hand: what it sees, its posture, its limits, the plan, the yaw, the grip."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from skisnow import Profile, load_scenario, simulate
from skisnow._support.errors import ParameterError
from skisnow._support.units import name_with_values
from skisnow.scenario import Skier
from skisnow.skier import BalancedSkier, Command, Posture, Seen
from skisnow.skier.edges import ForceMap
from skisnow.skier.hybrid import CarvedLine
from skisnow.skier.plan import AHEAD, STEP, Gravity, HalfWaves, Planned, RecedingLine, with_run_out
from skisnow.skier.posture import AHEAD as FORE
from skisnow.skier.posture import ASIDE, HIP, HIP_DAMPING, LEFT_EDGE, PITCH, RIGHT_TOE, RISE, STANCE
from skisnow.skier.seen import seen_at
from skisnow.skier.yaw import (
    BODY,
    BODY_RATE,
    FACES_DOWN,
    HIPS,
    SHIFT,
    SHIFT_ACCELERATION,
    SLIP,
    TORQUE,
    Body,
    _dynamics,
    yaw_gain,
)
from tests.coded import raises

TURNS = load_scenario("skier-10deg")
HEIGHT, UP = 0.6, np.array([0.0, 0.0, 1.0])
SAW: dict[str, Any] = {
    "time": 0.0, "aside": 0.1, "aside_rate": 0.0, "ahead": 0.0, "ahead_rate": 0.0, "height": HEIGHT, "pressure": 0.0,
    "left": 360.0, "right": 360.0, "across": 0.0, "along": 0.0, "moment": 0.0, "place": (3.0, 1.0), "speed": 6.0,
    "course": 0.25, "feet": (3.0, 1.0), "feet_speed": 6.0, "feet_course": 0.25, "heading": 0.2, "turn_rate": 0.0,
    "slip": -0.05, "body_heading": 0.2, "body_rate": 0.0, "yaw_inertia": 2.1, "edge": (0.0, 0.0), "bears": True,
    "lifted": False,
}  # fmt: skip


def saw(**changes: Any) -> Seen:
    return Seen(**SAW | changes)


def posture(**keys: Any) -> Posture:
    return Posture(Skier(**keys), (0.0, HEIGHT), 0.44, 0.03)


def moment(**changes: Any) -> Any:
    """Upright, yawed by 0.3 from the fall line, two boots 0.44 m apart and 0.1 m ahead of the body's origin."""
    yaw = np.array([[math.cos(0.3), -math.sin(0.3), 0.0], [math.sin(0.3), math.cos(0.3), 0.0], [0.0, 0.0, 1.0]])
    boots = [[[0.1, y, 0.0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.0, 0.05, 0.0], [0.0, 0.0, 0.4]] for y in (0.22, -0.22)]
    usual = {
        "time": 1.0, "until": 1.005, "position": np.array([10.0, 2.0, 0.0]), "rotation": yaw,
        "velocity": np.array([5.0, 0.0, 0.0, 0.2, 0.0, 0.1]), "boots": np.array(boots),
        "wrench": np.array([[0.0, 20.0, 300.0, 6.0, 1.0, 2.0], [0.0, 0.0, 500.0, 0.0, 0.0, 0.0]]),
    }  # fmt: skip
    return SimpleNamespace(**usual | changes)


def test_what_is_seen_upright() -> None:
    """The moments about the middle of the feet, 0.22 · 300 - 0.22 · 500 + 6 N m, over 800 N; rates by hand."""
    found = seen_at(moment(), (0.0, HEIGHT), UP, 900.0, 2.1)
    assert (found.aside, found.ahead, found.height) == pytest.approx((0.0, -0.1, HEIGHT))
    assert found.aside_rate == pytest.approx(-0.1 * 0.1 - 0.2 * HEIGHT - 0.05)
    assert found.pressure == pytest.approx(-38.0 / 800.0)
    assert (found.left, found.right, found.load, found.across) == pytest.approx((300.0, 500.0, 800.0, 20.0))
    assert found.place == pytest.approx((10.0, 2.0))
    assert found.feet == pytest.approx((10.0 + 0.1 * math.cos(0.3), 2.0 + 0.1 * math.sin(0.3)))
    assert (found.feet_speed, found.feet_course) == pytest.approx((math.hypot(5.0, 0.06), 0.3 + math.atan2(0.06, 5.0)))
    assert (found.speed, found.course) == pytest.approx((math.hypot(5.0, 0.12), 0.3 - math.atan2(0.12, 5.0)))
    assert (found.heading, found.body_heading) == pytest.approx((0.3, 0.3))
    assert (found.turn_rate, found.body_rate) == pytest.approx((0.5, 0.1))
    assert found.slip == pytest.approx(-math.atan2(0.06, 5.0))
    assert found.moment == pytest.approx(2.0)  # forces aside act at the middle's own x
    assert (found.bears, found.lifted) == (True, False)
    blind = seen_at(moment(), (0.0, HEIGHT), UP, 4001.0, 2.1)
    assert (blind.pressure, blind.bears, blind.lifted) == (0.0, False, False)


def test_on_a_steeper_place_all_turns_with_the_snow() -> None:
    """By 0.4 rad about the left: the same but for the place."""
    cos, sin = math.cos(0.4), math.sin(0.4)
    tilt = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    flat = seen_at(moment(), (0.0, HEIGHT), UP, 900.0, 2.1)
    steep = seen_at(moment(rotation=tilt @ moment().rotation), (0.0, HEIGHT), tilt @ UP, 900.0, 2.1)
    for name in SAW.keys() - {"place", "feet"}:
        assert getattr(steep, name) == pytest.approx(getattr(flat, name), abs=1e-12), name


def test_the_posture_is_seen_as_it_is_set() -> None:
    """Boots where a posture has them, on level snow: the same lean, shift, hip angle and edges are seen."""
    body = posture()
    body.numbers[[FORE, ASIDE, HIP, LEFT_EDGE, RIGHT_TOE]] = 0.08, 0.3, 0.4, 0.2, 0.1
    body.numbers[LEFT_EDGE + 1], body.numbers[RIGHT_TOE - 1] = 0.2, -0.1
    boots = np.array([[each.place, *each.axes, each.velocity, each.turning] for each in body.poses()])
    found = seen_at(moment(boots=boots), (0.0, HEIGHT), _up_in_space(boots), 900.0, 2.1)
    assert (found.ahead, found.aside) == pytest.approx((0.08, 0.3), abs=1e-3)
    least = math.sin(math.radians(3.0))
    lift = 0.03 * (math.hypot(math.sin(0.2), least) - least)  # of a boot by its edge
    assert found.height == pytest.approx(HEIGHT - lift, abs=1e-4)
    assert found.body_heading - found.heading == pytest.approx(0.4, abs=2e-3)
    assert found.edge == pytest.approx((0.2, 0.2), abs=1e-9)


def _up_in_space(boots: Any) -> Any:
    """Normal of the snow: off the base, turned back by the edge of 0.2 rad about the ski."""
    _, left, off = boots[0, 1:4]
    return moment().rotation @ (math.cos(0.2) * off - math.sin(0.2) * left)


def test_rates_of_poses_are_those_of_the_posture() -> None:
    body, step = posture(), 1e-4
    body.numbers += [0.05, 0.2, 0.3, 0.1, 0.15, -0.1, 0.1, 0.1, -0.04, 0.12]
    body.rates += [0.5, -0.7, 1.0, 2.0, -1.0, 0.3, -0.3, 0.2, 0.1, -0.6]
    now = body.poses()
    body.numbers += step * body.rates
    for pose, later in zip(now, body.poses(), strict=True):
        assert (later.place - pose.place) / step == pytest.approx(pose.velocity, abs=1e-3)
        spin = np.cross(np.broadcast_to(pose.turning, (3, 3)), pose.axes)
        assert (later.axes - pose.axes) / step == pytest.approx(spin, abs=1e-3)


def test_limits_of_range_rate_and_torque_hold() -> None:
    body, dt, shifts = posture(), 0.005, []
    asked = Command((2.0, -2.0), hip_torque=1e4, ahead=1e3, toe=(-0.3, 0.3), stance=0.8)
    for _ in range(200):
        body.step(asked, saw(), dt)
        shifts.append(float(body.rates[FORE]))
        if len(shifts) == 2:
            hips = body.rates[HIP]
    assert body.numbers[LEFT_EDGE : LEFT_EDGE + 2] == pytest.approx(
        [body.skier.greatest_edge, -body.skier.greatest_edge], rel=1e-3
    )
    assert body.numbers[FORE] == pytest.approx(0.15, abs=0.01)
    assert max(shifts) == pytest.approx(1.5)
    assert body.numbers[STANCE] == pytest.approx(0.8, abs=0.01)
    assert hips == pytest.approx(-150.0 * dt / 1.5)  # each call starts from what is seen
    free = posture()
    free.step(Command((0.0, 0.0), aside=2.0), saw(), dt)
    assert free.rates[ASIDE] == pytest.approx(2.0 * dt)
    assert free.rates[HIP] == 0.0


def test_skis_without_torque_keep_their_rate_under_a_leaning_body_but_for_the_damping() -> None:
    """Leaning by 45° the hips turn by √2 times the difference of the rates about the normal."""
    for body_rate, turn_rate in ((0.5, 0.5), (0.1, -0.2)):
        body, dt = posture(), 0.005
        body.numbers[ASIDE], body.rates[HIP] = HEIGHT, math.sqrt(2.0) * (body_rate - turn_rate)
        body.step(Command((0.0, 0.0), hip_torque=0.0), saw(body_rate=body_rate, turn_rate=turn_rate), dt)
        kept = 1.0 - dt * HIP_DAMPING / 4.0 / (1.5 + 6.0 / 2.0)  # the inertia of hips grows by half of 6 kg m²
        assert body.rates[HIP] == pytest.approx(math.sqrt(2.0) * (body_rate - turn_rate) * kept)


def test_legs_give_way_to_a_load_that_is_off_and_put_a_lifted_ski_down() -> None:
    body, dt = posture(leg_yielding=1.0), 0.005
    body.step(Command((0.0, 0.0), pressure=0.02), saw(pressure=0.07), dt)
    assert body.rates[ASIDE] == pytest.approx(0.05)
    assert body.aside_rate == 0.0
    lifted = posture()
    lifted.step(Command((0.0, 0.0)), saw(aside=0.05, lifted=True), dt)
    assert lifted.rates[ASIDE] == pytest.approx(20.0 * 0.05)


@pytest.mark.parametrize(("edge", "share"), [(0.0, 0.0), (2.5, 0.25), (10.0, 1.0)])
def test_each_leg_is_a_damper_of_3000_N_s_per_m_on_an_edged_ski(edge: float, share: float) -> None:
    """90 N too much shorten both by 15 mm/s; 60 N more on the left tilt by 20 mm/s each over 0.44 m, 0.6 m below."""
    body = posture(leg_yielding=0.0)
    body.numbers[LEFT_EDGE : LEFT_EDGE + 2] = math.radians(edge)
    body.step(Command((0.0, 0.0), load=720.0), saw(left=435.0, right=375.0, pressure=60.0 * 0.44 / 720.0), 0.005)
    assert body.rates[RISE] == pytest.approx(-0.015 * share, abs=1e-9)
    assert body.rates[ASIDE] == pytest.approx(2.0 * 0.02 / 0.44 * 0.6 * share, abs=1e-9)
    body.numbers[RISE] = -0.02
    body.step(Command((0.0, 0.0)), saw(), 0.005)  # who asks for no load stands up again
    assert body.rates[RISE] > 0.0


def test_legs_bring_the_skis_to_the_snow_softly_and_brake_evenly_to_a_crouch() -> None:
    """6 - √32 of 5 mm in 5 ms, near the snow 2 g · 5 ms; on 0.4 m they brake by v²/(2 · 0.4 m)."""
    body, dt = posture(), 0.005
    body.numbers[RISE], body.rates[RISE] = 0.12, -3.5
    body.step(Command((0.0, 0.0)), saw(bears=False, clearance=0.005, nearing=4.0, falls_with=4.0, pitch=0.1), dt)
    assert body.rates[RISE] == pytest.approx(-4.0 + 6.0 - math.sqrt(32.0))
    assert body.rates[PITCH] == pytest.approx(-(25.0**2) * 0.1 * dt)  # to lie along the snow
    body.step(Command((0.0, 0.0)), saw(bears=False, clearance=0.0005, nearing=4.0, falls_with=4.0), dt)
    touch = 2.0 * 9.81 * dt - 4.0
    assert body.rates[RISE] == pytest.approx(touch)
    body.numbers[RISE] = 0.12
    body.step(Command((0.0, 0.0)), saw(), dt)
    assert body.rates[RISE] == pytest.approx(touch + dt * touch**2 / 0.8)
    for _ in range(400):
        body.step(Command((0.0, 0.0)), saw(), dt)
    assert body.numbers[RISE] == pytest.approx(0.0, abs=0.02)
    assert body.numbers[PITCH] == pytest.approx(0.0, abs=0.01)


def test_force_and_edge_of_the_map_are_inverse() -> None:
    """F = c S_f √(2 L N tan ϑ/H_V), 449 N measured at 400 N, 10°; the assumed snow counts."""
    snow = ForceMap(0.21e9, 0.52e6, 1.396)
    assert 0.9 * snow.force(math.radians(10.0), 400.0) == pytest.approx(449.0, rel=0.03)
    angle = snow.edge(500.0, (200.0, 600.0), 0.8)
    assert 0.8 * (snow.force(angle, 200.0) + snow.force(angle, 600.0)) == pytest.approx(500.0)
    other = replace(TURNS, skier=Skier(assumed_hardness=3e8, assumed_strength=1e5))
    assert (ForceMap.of(other).hardness, ForceMap.of(other).strength) == (3e8, 1e5)
    assert ForceMap.of(TURNS).hardness == TURNS.contact.snow.snow_hardness


APEXES = [(-6.5, -1.9), (6.5, 1.9), (19.5, -1.9), (32.5, 1.9)]


def followed(line: RecedingLine, place: tuple[float, float], course: float, speed: float = 7.0) -> Any:
    """Path (n, 2) of a point that turns as planned, over 3 s."""
    gravity, path, dt = Gravity(9.5, 2.5), [place], 0.005
    for _ in range(600):
        planned = line.ahead(saw(place=path[-1], speed=speed, course=course), gravity)
        turning = np.interp(0.0, AHEAD, planned.force) - gravity.down * math.sin(course)
        x, y = path[-1]
        path.append((x + dt * speed * math.cos(course), y + dt * speed * math.sin(course)))
        course += dt * turning / speed
    return np.array(path)


def test_who_follows_the_plan_passes_the_apexes_from_beside_the_line_too() -> None:
    """Of 0.3 m half is left at the first apex, where there is too little way for more, and a tenth at the second."""
    course, ends = math.atan(1.9 * math.pi / 13.0), []
    for beside in (0.0, 0.3, -0.3):
        path = followed(RecedingLine(HalfWaves(APEXES), APEXES), (0.0, beside), course)
        ends.append([float(np.interp(x, path[:, 0], path[:, 1]) - y) for x, y in APEXES[1:3]])
    assert ends[0] == pytest.approx([0.0, 0.0], abs=0.08)
    for end in ends[1:]:
        assert np.all(np.abs(np.subtract(end, ends[0])) < [0.15, 0.03])


def test_the_first_path_begins_straight() -> None:
    """As the polynomial with place, course and no curvature of here, and those of the line at its apex."""
    course, way, x = math.atan(1.9 * math.pi / 13.0), 6.5, 0.5 * STEP * 7.0
    plan = RecedingLine(HalfWaves(APEXES), APEXES).ahead(
        saw(place=(0.0, 0.0), speed=7.0, course=course), Gravity(9.5, 0.0)
    )
    rows = np.array(
        [np.polynomial.Polynomial.basis(k).deriv(n)(at) for at in (0.0, way) for n in range(3) for k in range(6)]
    )
    bend = -1.9 * (math.pi / 13.0) ** 2 * math.cos(math.pi / 13.0 * 0.05)  # behind the apex by a step of the table
    path = np.polynomial.Polynomial(np.linalg.solve(rows.reshape(6, 6), [0.0, math.tan(course), 0.0, 1.9, 0.0, bend]))
    x *= math.cos(course)
    assert plan.force[0] == pytest.approx(49.0 * path.deriv(2)(x) / (1.0 + path.deriv()(x) ** 2) ** 1.5, rel=1e-6)
    assert abs(plan.force[0]) < 0.2


@pytest.mark.parametrize(("heading", "faces"), [(31.0, 0.0), (-31.0, 0.0), (60.0, 25.0)])
def test_skidded_turns_begin_with_skis_along_the_path_and_the_body_facing_down_the_slope(
    heading: float, faces: float
) -> None:
    scenario = load_scenario("slalom-15deg", changes={"start.heading_deg": heading, "run.duration_s": 0.01})
    skier = BalancedSkier(scenario.with_(method="fast"))
    simulate(skier.scenario, boots=skier)
    seen = skier.records[0].seen
    assert seen.speed == pytest.approx(5.5, abs=1e-5)
    assert np.degrees([seen.course, seen.heading, seen.body_heading]) == pytest.approx(
        [heading, heading, faces], abs=1e-3
    )


def test_the_line_goes_on_behind_its_last_apex_from_side_to_side() -> None:
    assert with_run_out([(0.0, 1.0), (10.0, -1.0)], turns=2)[2:] == [(20.0, 1.0), (30.0, -1.0)]


def test_the_gain_of_the_yaw_is_that_of_the_least_cost() -> None:
    """The first input of the whole problem solved at once, as one system of normal equations."""
    body, rng = Body(75.0, 7.4, 2.1, HEIGHT), np.random.default_rng(3)
    n = len(AHEAD)
    planned = Planned(3.0 * np.sin(3.0 * AHEAD), 0.8 * np.cos(3.0 * AHEAD))
    heading, slip = planned.course + 0.2, np.full(n, 0.2)
    gain = yaw_gain(planned, heading, slip, body, 9.5, 7.0)
    state = np.append(0.2 * rng.standard_normal(6), 1.0)
    rows, sides = [], []
    power, inputs = np.eye(7), np.zeros((7, 2 * n))
    side = np.gradient(heading, STEP)
    aside = HEIGHT * planned.force / 9.5
    leant = (aside / np.hypot(aside, HEIGHT)) ** 2
    turns = np.clip(-np.gradient(7.4 * side * leant, STEP) - 2.4 * np.tanh(planned.force / 2.0) - 40.0 * aside, -30, 30)
    damping = 0.5 * np.minimum(40.0, 0.245 * np.abs(75.0 * planned.force) / (7.0 * 0.2))
    facing = planned.course - np.clip(planned.course, -FACES_DOWN, FACES_DOWN)
    steps = _dynamics(75.0 * planned.force, turns, damping, 2.1)
    for k in range(n + 1):
        last = k == n
        i = min(k, n - 1)
        eager = math.sqrt(min(1.0, abs(planned.force[i]) / 1.962) + 0.1)
        weight = math.sqrt(5.0) if last else 1.0
        for row, wish, scale in (
            ([1, 0, 0, 0, 0, 0], heading[i], SLIP / eager), ([1, 0, -1, 0, 0, 0], 0.0, HIPS),
            ([0, 0, 1, 0, 0, 0], facing[i], BODY), ([0, 0, 0, 1, 0, 0], 0.0, BODY_RATE),
            ([0, 0, 0, 0, 1, 0], 0.0, SHIFT),
        ):  # fmt: skip
            full = np.append(np.array(row, float), -wish) * weight / scale
            rows.append(full @ inputs)
            sides.append(-full @ power @ state)
        if last:
            break
        for j, scale in enumerate((TORQUE, SHIFT_ACCELERATION)):
            own = np.zeros(2 * n)
            own[2 * k + j] = 1.0 / scale
            rows.append(own)
            sides.append(0.0)
        power, inputs = steps[k, :, :7] @ power, steps[k, :, :7] @ inputs
        inputs[:, 2 * k : 2 * k + 2] += steps[k, :, 7:]
    best = np.linalg.lstsq(np.array(rows), np.array(sides), rcond=None)[0]
    assert -gain @ state == pytest.approx(best[:2], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    ("command", "code", "fields"),
    [
        (None, "wrong_kind", {"kind": "NoneType"}),
        (Command(edge=(math.nan, 0.1)), "not_a_number", {"name": "edge"}),
        (Command(edge=(0.1,)), "not_a_number", {"name": "edge"}),  # type: ignore[arg-type]
        (Command(edge=(0.1, 0.1), load=math.inf), "not_a_number", {"name": "load"}),
        (Command(edge=(0.1, 0.1), aside="left"), "not_a_number", {"name": "aside"}),  # type: ignore[arg-type]
        (Command(edge=(0.1, 0.1), ahead=None), "not_a_number", {"name": "ahead"}),  # type: ignore[arg-type]
    ],
)
def test_a_controller_that_returns_no_numbers_is_told(command: Any, code: str, fields: dict[str, str]) -> None:
    with raises(ParameterError, code, **fields):
        simulate(TURNS.with_(duration_s=0.1, method="fast"), controller=SimpleNamespace(command=lambda *_: command))


def test_a_skier_is_described_by_its_control_without_an_address() -> None:
    slalom = load_scenario("slalom-15deg")
    words = name_with_values(BalancedSkier(slalom))
    assert "control='SkidControl'" in words and " at 0x" not in words


def test_the_grip_is_learnt_where_skis_slide() -> None:
    """1.2 times the formula, from 0.9, within some periods; not from a blade."""
    skier = BalancedSkier(replace(TURNS, skier=Skier(brakes_to=6.0)))
    control: Any = skier.controller
    skier.posture.numbers[LEFT_EDGE : LEFT_EDGE + 2] = 0.1
    expected = 2.0 * control.snow.force(0.1, 360.0)
    for slip, grip in ((0.0, 0.9), (-0.3, 0.9), (0.3, 1.2)):
        for _ in range(100):
            control._learn(saw(slip=slip, across=1.2 * expected, edge=(0.1, 0.1)), skier.posture)
        assert control.grip == pytest.approx(grip, abs=1e-3)


def test_no_more_force_is_planned_than_edges_of_34_degrees_hold_with_the_learnt_grip() -> None:
    skier = BalancedSkier(replace(TURNS, skier=Skier(brakes_to=6.0)))
    control: Any = skier.controller
    loads = control.body.mass * control.gravity.normal * np.array([0.65, 0.35])
    for grip in (0.3, 0.2):
        control.grip = grip
        control._look_ahead(saw(time=1.0, speed=20.0, course=0.5))
        held = grip * sum(control.snow.force(math.radians(34.0), load) for load in loads)
        assert np.abs(control._planned.force).max() == pytest.approx(held / control.body.mass)


@pytest.mark.parametrize("course", [0.0, 0.5])
def test_a_hollow_presses_by_v2_over_its_radius_and_a_crest_takes_as_much(course: float) -> None:
    """Of a radius of 40 m at 6 m/s, 0.9 m/s² down the fall line; across it the cylinder bends by cos² of the course."""
    x, radius = np.linspace(-20.0, 20.0, 801), 40.0
    for sign in (1.0, -1.0):
        skier = BalancedSkier(TURNS.with_(slope=Profile(x, sign * (radius - np.sqrt(radius**2 - x**2)))))
        assert skier._pressed(0.0, 0.0) == 0.0  # nothing seen yet
        skier.records.append(SimpleNamespace(seen=saw(course=course)))  # type: ignore[arg-type]
        expected = sign * 36.0 / radius * math.cos(course) ** 2
        assert skier._pressed(0.0, 0.0) == pytest.approx(expected, rel=2e-3)
        assert skier._stand_on(0.0, 0.0)[1].normal == pytest.approx(9.81 + expected, rel=1e-3)


def test_a_carve_behind_the_fall_line_has_the_force_of_its_path_and_ends_at_20_degrees() -> None:
    """v²/(R cos ϑ) + g sin α sin χ with sin ϑ = v²/(R g). The slip fades from 20 to 5° before the fall line.

    After a carve the slip is 0.
    """
    apexes, gravity, degree = [(0.0, 0.0), (8.0, 2.5), (24.0, -2.5), (40.0, 2.5)], Gravity(9.66, 1.7), math.radians(1.0)
    plan = CarvedLine(HalfWaves(apexes), apexes, 13.0)
    skids = np.asarray(plan.ahead(saw(place=(4.0, 1.5), course=24 * degree, speed=8.0, slip=-0.3), gravity).slides)
    assert skids[0] == 1.0
    assert skids.min() == 0.0
    radius = 13.0 * math.sqrt(1.0 - (64.0 / (13.0 * 9.66)) ** 2)  # of a carve in balance
    at_apex = {"place": apexes[1], "speed": 8.0, "slip": degree, "turn_rate": -8.0 / radius}
    carves = plan.ahead(saw(course=-3 * degree, **at_apex), gravity)
    assert carves.carves == pytest.approx(-64.0 / 13.0)
    assert carves.force[0] == pytest.approx(-64.0 / radius - 1.7 * math.sin(3 * degree))
    ended = plan.ahead(saw(course=-21 * degree, **at_apex), gravity)
    assert ended.carves == 0.0
    assert not np.asarray(ended.slides)[ended.force < 0.0].any()
