"""The steps of the control by hand: pendulum, filters, limits, foresight against another integration."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from skisnow import Profile, load_scenario
from skisnow.scenario import Skier
from skisnow.skier.balance import BalancedSkier, BalanceRecord
from skisnow.skier.edges import Edges
from skisnow.skier.seen import Seen, seen_at
from skisnow.skier.steering import LineThroughGates, TurnsOverTime, Underway, pursued

TURNS = load_scenario("skier-10deg")
HEIGHT, MASS = 0.6, 75.0
NORMAL, DOWNHILL = 9.81 * math.cos(math.radians(10.0)), 9.81 * math.sin(math.radians(10.0))
"""Acceleration along the normal and down the slope (m/s²)."""


def control(**numbers: Any) -> BalancedSkier:
    return BalancedSkier(TURNS.with_(skier=Skier(**numbers)))


def saw(**changes: Any) -> Seen:
    usual: dict[str, Any] = {
        "aside": 0.1, "aside_rate": 0.0, "height": HEIGHT, "pressure": 0.0, "left": 360.0, "right": 360.0,
        "place": (3.0, 1.0), "speed": 6.0, "heading": 0.2, "course": 0.25, "bears": True, "lifted": False,
    }  # fmt: skip
    return Seen(**usual | changes)


def test_the_pendulum() -> None:
    """ω² = m g z/(I cos²Ψ + m z²), 60° of lean: a quarter of the roll inertia."""
    skier, roll = control(), TURNS.sledge.inertia[0]
    upright = math.sqrt(MASS * NORMAL * HEIGHT / (roll + MASS * HEIGHT**2))
    leant = math.sqrt(MASS * NORMAL * HEIGHT / (roll / 4.0 + MASS * HEIGHT**2))
    assert skier._rate == pytest.approx(upright)
    assert skier._rate_at(HEIGHT * math.tan(math.radians(60.0))) == pytest.approx(leant)
    assert skier._weight == pytest.approx(MASS * 9.81)
    assert skier._downhill == pytest.approx(DOWNHILL)


def on_profile(x: np.ndarray[Any, Any], y: np.ndarray[Any, Any]) -> BalancedSkier:
    return BalancedSkier(TURNS.with_(slope=Profile(x, y)))


def test_a_straight_profile_is_as_the_plane() -> None:
    x = np.linspace(-20.0, 60.0, 81)
    skier = on_profile(x, -math.tan(math.radians(10.0)) * x)
    skier.records.append(record(saw()))
    skier._stand_on(3.0, 1.0)
    assert (skier._gravity, skier._downhill) == pytest.approx((NORMAL, DOWNHILL))


def record(seen: Seen) -> BalanceRecord:
    return BalanceRecord(time=0.0, seen=seen, balanced=0.0, capture=0.0, edge_angle=0.0)


@pytest.mark.parametrize("course", [0.0, 0.5])
def test_a_hollow_presses_by_v2_over_its_radius_and_a_crest_takes_as_much(course: float) -> None:
    """Of a radius of 40 m at 6 m/s, 0.9 m/s² down the fall line; across it the cylinder bends by cos² of the course."""
    x, radius = np.linspace(-20.0, 20.0, 801), 40.0
    for sign in (1.0, -1.0):
        skier = on_profile(x, sign * (radius - np.sqrt(radius**2 - x**2)))
        assert skier._pressed(0.0, 0.0) == 0.0  # nothing seen yet
        skier.records.append(record(saw(course=course)))
        expected = sign * 36.0 / radius * math.cos(course) ** 2
        assert skier._pressed(0.0, 0.0) == pytest.approx(expected, rel=2e-3)
        skier._stand_on(0.0, 0.0)
        assert skier._gravity == pytest.approx(9.81 + expected, rel=1e-3)
        skier.records.append(record(saw(speed=30.0)))
        assert skier._pressed(0.0, 0.0) == sign * Skier().greatest_pressed


def test_short_waves_press_as_they_bend_over_a_ski() -> None:
    """A hollow of -0.05 cos(2π x/3 m): the slope at half a ski's length before and behind, over that length."""
    x, rate, half = np.linspace(-6.0, 6.0, 1201), 2.0 * math.pi / 3.0, 0.5 * TURNS.ski.length
    skier = on_profile(x, -0.05 * np.cos(rate * x))
    skier.records.append(record(saw(course=0.0, speed=2.0)))
    slope = 0.05 * rate * math.sin(rate * half)
    assert skier._pressed(0.0, 0.0) == pytest.approx(4.0 * math.sin(math.atan(slope)) / half, rel=1e-3)


def test_limits_of_what_is_planned() -> None:
    """v²/(R_sc cos 66°), and g tan 48° of the greatest lean, over what a carve in balance has."""
    skier, radius = control(), TURNS.ski.sidecut_radius_of_edge_line
    assert skier._limit(4.0) == pytest.approx(16.0 / (radius * math.cos(math.radians(66.0))))
    assert skier._limit(30.0) == skier._most(30.0) == pytest.approx(NORMAL * math.tan(math.radians(48.0)))
    lean = math.asin(36.0 / (radius * NORMAL))
    assert skier._most(6.0) == pytest.approx(NORMAL * math.tan(lean))
    at = Underway(0.0, 0.0, 0.0, 0.0, 4.0, 0.0)
    for wish, most, planned in ((0.6, 3.0, 0.2), (-0.6, 3.0, -0.2), (99.0, 2.0, 0.5 * skier._limit(4.0))):
        skier.steering = Wish(constant=wish)
        assert skier._planned(at, most) == pytest.approx(planned)
    assert skier._planned(at, 0.0) == pytest.approx(1e3 * skier._limit(4.0))


@dataclass
class Wish:
    """Steers by all that it is told."""

    constant: float = 0.0
    by_all: float = 0.0

    def acceleration(self, at: Underway, carving: float) -> float:
        told = 0.3 * math.sin(5.0 * at.time) - 0.05 * at.x + 0.4 * at.y - 0.6 * at.heading
        return self.constant + self.by_all * (told + 0.1 * at.speed + 0.2 * at.acceleration + 0.05 * carving)


def test_what_is_foreseen_is_the_integral_over_what_the_filters_will_do() -> None:
    """ω ∫ exp(-ω s) b(s) ds over 1.6 s, of the equations of the page on the skier, by another integrator."""
    skier = control(foresight_step=0.001)
    skier.steering = Wish(0.5, 1.0)
    skier._turn, skier._acceleration, skier._asked = [0.2, -0.5], -0.4, 0.8
    seen, change, lag = saw(), 10.0, 0.6 / 6.0
    most, omega = skier._most(6.0), skier._rate

    def rates(time: float, state: Any) -> list[float]:
        turn, rate, acceleration, x, y, heading = state
        wish = skier.steering.acceleration(Underway(2.0 + time, x, y, heading, 6.0, acceleration), most)
        target = most * turn + 0.8 * math.exp(-0.7 * omega * time)
        return [
            rate, change**2 * (wish / most - turn) - 2.0 * change * rate, (target - acceleration) / lag,
            6.0 * math.cos(heading), 6.0 * math.sin(heading), acceleration / 6.0,
        ]  # fmt: skip

    begin = [0.2, -0.5, -0.4, 3.0, 1.0, 0.25]
    way: Any = solve_ivp(rates, (0.0, 1.6), begin, rtol=1e-8, atol=1e-8, dense_output=True).sol

    def balanced(time: float) -> float:
        return float(HEIGHT * (way(time)[2] + DOWNHILL * math.sin(way(time)[5])) / NORMAL)

    whole = quad(lambda time: omega * math.exp(-omega * time), 0.0, 1.6)[0]
    exact = quad(lambda time: omega * math.exp(-omega * time) * balanced(time), 0.0, 1.6)[0] / whole
    wanted, now = skier._foreseen(2.0, seen)
    assert wanted == pytest.approx(exact, abs=2e-4)
    assert abs(exact - balanced(0.0)) > 0.02
    assert now == pytest.approx(balanced(0.001), abs=1e-5)


def test_one_step_of_the_foresight() -> None:
    """Of 0.1 s at 1 m/s, computed with the slowest speed of 2 m/s: a lag of 0.3 s."""
    skier = control(foresight=0.1, foresight_step=0.1)
    seen = saw(speed=1.0)
    skier.steering = Wish(constant=0.05)
    most = skier._most(1.0)
    rate = 0.1 * 100.0 * 0.05 / most
    target = most * 0.1 * rate
    acceleration = target * 0.1 / 0.4
    expected = HEIGHT * (acceleration + DOWNHILL * math.sin(0.25)) / NORMAL
    assert skier._foreseen(0.0, seen) == pytest.approx((expected, expected))


def test_what_the_loads_teach() -> None:
    """u = y - b - y''/ω²: what b is beside the plan, a fifth of it in 10 ms at 25 rad/s, with the edge's square."""
    skier, share = control(), 0.01 / (0.01 + 1.0 / 25.0)
    skier._edge, skier._aside = [math.radians(-5.0), 0.0], [0.0, 0.0, 0.5]
    found = 0.1 - 0.03 - 0.5 / skier._rate**2 - 0.02
    skier._learn(saw(pressure=0.03), 0.02, 0.01)
    assert skier._correction == pytest.approx(share * 0.25 * found)
    for edge, aside, limit in ((20.0, 9.0, 0.12), (-20.0, -9.0, -0.12)):
        skier._correction, skier._edge = 0.02, [math.radians(edge), 0.0]
        skier._learn(saw(aside=aside), 0.0, 0.01)
        assert skier._correction == pytest.approx(0.02 + share * (limit - 0.02))
    skier._correction, skier._edge, skier._aside = 0.0, [math.radians(20.0), 0.0], [0.0, 0.0, 0.0]
    skier._learn(saw(aside=0.05), 0.0, 0.01)
    assert skier._correction == pytest.approx(share * 0.05)
    for blind in ({"bears": False}, {"lifted": True}):
        skier._correction = 0.1
        skier._learn(saw(**blind), 0.0, 0.01)
        assert skier._correction == pytest.approx(0.1 * (1.0 - share))


def test_a_step_aside_on_both_skis() -> None:
    """u = (1 + k)(ξ - ξ_ref), y'' = ω²(y - u - b); the place by even acceleration, with the legs that give way."""
    skier = control()
    omega = skier._rate
    skier._aside, skier._gives, skier._pressure = [0.1, 0.2, 0.0], 0.03, 0.01
    error = skier._step_aside(saw(pressure=0.05, aside=9.0, aside_rate=9.0), 0.12, 0.02, 0.01)
    assert error == pytest.approx(0.1 + 0.2 / omega - 0.12)
    growth = omega**2 * (0.1 - 1.7 * error - 0.02)
    later = 0.2 + 0.01 * growth
    place = 0.1 + 0.5 * 0.01 * (0.2 + 0.03 + later + 0.04)
    assert skier._aside == pytest.approx([place, later, growth])
    assert skier._gives == pytest.approx(0.04)
    assert skier._pressure == pytest.approx(1.7 * error)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_step_aside_within_stance_and_leg(side: float) -> None:
    """The centre of pressure within 0.8 of half the stance, the centre of mass within √(1.05² - 0.6²) m."""
    skier, half = control(), 0.5 * TURNS.sledge.stance_width
    skier._aside = [0.86 * side, 2.0 * side, 0.0]
    skier._step_aside(saw(), 0.0, 0.0, 0.01)
    assert skier._pressure == pytest.approx(0.8 * half * side)
    assert skier._aside[0] == pytest.approx(side * math.sqrt(1.05**2 - 0.6**2))
    assert skier._aside[2] == pytest.approx(skier._rate**2 * side * (0.86 - 0.8 * half))


@pytest.mark.parametrize("blind", [{"lifted": True}, {"bears": False}])
def test_a_lifted_ski_is_put_down_with_the_body_as_it_is(blind: dict[str, bool]) -> None:
    """By 20/s: a fifth of the way in 10 ms, from the legs as they are to the body as it is seen."""
    skier = control()
    omega = skier._rate
    skier._aside = [0.1, 0.2, 0.0]
    error = skier._step_aside(saw(aside=0.13, aside_rate=-0.3, **blind), 0.1, 0.02, 0.01)
    assert error == pytest.approx(0.13 - 0.3 / omega - 0.1)
    growth = omega**2 * (0.13 - 1.7 * error - 0.02)
    later = 0.8 * 0.2 - 0.2 * 0.3 + 0.01 * growth
    assert skier._gives == pytest.approx(20.0 * 0.03)
    assert skier._aside == pytest.approx([0.1 + 0.005 * (0.2 + later + 0.6), later, growth])
    swift = control(touch=300.0)
    swift._step_aside(saw(aside=0.13, aside_rate=-0.3, **blind), 0.1, 0.02, 0.01)
    assert swift._aside[1] == pytest.approx(-0.3 + 0.01 * growth)


def test_one_step_of_the_edge() -> None:
    """Rates first, then what they move; of the share of balance, the lag and the edge each as much as they have."""
    skier, seen, dt = control(), saw(), 0.01
    skier.steering = Wish(constant=1.2)
    skier._turn, skier._edge, skier._asked, skier._acceleration = [0.1, 0.3], [0.05, 0.2], 0.4, 0.7
    most = skier._most(6.0)
    skier._step_edge(0.0, seen, 0.03, dt)
    rate = 0.3 + dt * (100.0 * (1.2 / most - 0.1) - 20.0 * 0.3)
    turn = 0.1 + dt * rate
    asked = 0.4 + dt / (dt + 1.0 / 19.0) * (2.0 * NORMAL * 0.03 / HEIGHT - 0.4)
    ahead = most * turn + asked
    grip = (ahead + DOWNHILL * math.sin(0.25)) / NORMAL
    wanted = skier.edges.angle(ahead, grip, 6.0, MASS * 9.81)
    turning = 0.2 + dt * (19.0**2 * (wanted - 0.05) - 38.0 * 0.2)
    assert skier._turn == pytest.approx([turn, rate])
    assert skier._asked == pytest.approx(asked)
    assert skier._acceleration == pytest.approx(0.7 + (ahead - 0.7) * dt / (0.1 + dt))
    assert skier._edge == pytest.approx([0.05 + 0.5 * dt * (0.2 + turning), turning])


def test_the_edge_is_steered_by_where_the_skier_is() -> None:
    """Time, place, course, speed and acceleration of that moment; what balance asks for within that of a carve."""
    skier, seen = control(), saw()
    skier.steering = Wish(by_all=1.0)
    skier._acceleration = 0.7
    most = skier._most(6.0)
    wish = 0.3 * math.sin(1.5) - 0.15 + 0.4 - 0.15 + 0.6 + 0.14 + 0.05 * most
    skier._step_edge(0.3, seen, 0.0, 0.01)
    assert skier._turn[1] == pytest.approx(0.01 * 100.0 * wish / most)
    for error, asked in ((5.0, most), (-5.0, -most)):
        other = control()
        other.steering = Wish()
        other._step_edge(0.0, seen, error, 0.01)
        assert other._asked == pytest.approx(asked * 0.01 / (0.01 + 1.0 / 19.0))


def test_slow_the_lag_and_the_edge_are_those_of_2_m_per_s() -> None:
    skier = control()
    skier.steering = Wish()
    skier._asked = 0.1
    skier._step_edge(0.0, saw(speed=0.5, course=0.0), 0.0, 0.01)
    asked = 0.1 * (1.0 - 0.01 / (0.01 + 1.0 / 19.0))
    assert skier._acceleration == pytest.approx(asked * 0.01 / (0.3 + 0.01))
    wanted = skier.edges.angle(asked, asked / NORMAL, 2.0, MASS * 9.81)
    assert skier._edge[1] == pytest.approx(0.01 * 19.0**2 * wanted)


class Told(BalancedSkier):
    """Foresees what it is told."""

    def _foreseen(self, *_: object) -> tuple[float, float]:
        return 0.04, 0.03


def moment(**changes: Any) -> Any:
    """Upright, yawed by 0.3 from the fall line, two boots 0.44 m apart and 0.1 m ahead of the body's origin."""
    yaw = np.array([[math.cos(0.3), -math.sin(0.3), 0.0], [math.sin(0.3), math.cos(0.3), 0.0], [0.0, 0.0, 1.0]])
    boots = [[[0.1, y, 0.0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.0, 0.05, 0.0]] for y in (0.22, -0.22)]
    usual = {
        "time": 1.0, "until": 1.01, "position": np.array([10.0, 2.0, 0.0]), "rotation": yaw,
        "velocity": np.array([5.0, 0.0, 0.0, 0.2, 0.0, 0.1]), "boots": np.array(boots),
        "wrench": np.array([[0.0, 20.0, 300.0, 6.0, 1.0, 2.0], [0.0, 0.0, 500.0, 0.0, 0.0, 0.0]]),
    }  # fmt: skip
    return SimpleNamespace(**usual | changes)


def test_a_call_records_what_it_wants_with_what_the_loads_taught() -> None:
    """ξ_ref is 1.1 of what is foreseen and of the correction over 1 + k; nothing is done in no time."""
    skier = Told(TURNS)
    skier._correction, skier._aside, skier._gives = 0.05, [0.0, 0.3, 0.0], 0.2
    rate = skier._rate
    poses = skier(moment(until=1.0))
    assert skier.records == []
    assert poses[0].velocity == pytest.approx([0.0, 0.0, 0.5 / HEIGHT * 0.22])  # 0.3 m/s and 0.2 of legs that give way
    skier._aside = [0.6, 0.3, 0.0]
    skier(moment())
    assert skier._rate == pytest.approx(skier._rate_at(0.6))
    assert skier._rate > rate
    share = 0.01 / (0.01 + 1.0 / 25.0)
    correction = 0.05 * (1.0 - share)  # the edges are flat
    (found,) = skier.records
    assert found.time == 1.01
    assert found.balanced == pytest.approx(0.03 + correction)
    assert found.capture == pytest.approx(1.1 * (0.04 + correction / 1.7))
    assert found.edge_angle == skier._edge[0] != 0.0
    skier(moment(time=1.01, until=1.02))
    assert skier.edge_steps == pytest.approx([skier.records[1].edge_angle - skier.records[0].edge_angle])


def test_what_is_seen_upright() -> None:
    """The moments about the middle of the feet, 0.22 · 300 - 0.22 · 500 + 6 N m, over 800 N; rates by hand."""
    found = seen_at(moment(), HEIGHT, np.array([0.0, 0.0, 1.0]), 100.0, 0.4)
    assert (found.aside, found.height, found.lean) == pytest.approx((0.0, HEIGHT, 0.0))
    assert found.aside_rate == pytest.approx(-0.1 * 0.1 - 0.2 * HEIGHT - 0.05)
    assert found.pressure == pytest.approx(-38.0 / 800.0)
    assert (found.left, found.right, found.load) == pytest.approx((300.0, 500.0, 800.0))
    assert found.place == pytest.approx((10.0 + 0.1 * math.cos(0.3), 2.0 + 0.1 * math.sin(0.3)))
    assert found.speed == pytest.approx(math.hypot(5.0, 0.06))
    assert found.heading == pytest.approx(0.3)
    assert found.course == pytest.approx(0.3 + math.atan2(0.06, 5.0))
    assert (found.bears, found.lifted) == (True, True)
    assert not seen_at(moment(), HEIGHT, np.array([0.0, 0.0, 1.0]), 100.0, 0.37).lifted
    blind = seen_at(moment(), HEIGHT, np.array([0.0, 0.0, 1.0]), 800.1, 0.4)
    assert (blind.pressure, blind.bears, blind.lifted) == (0.0, False, False)


def test_on_a_steeper_place_all_turns_with_the_snow() -> None:
    """By 0.4 rad about the left: the same but for the place."""
    cos, sin = math.cos(0.4), math.sin(0.4)
    tilt = np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    level = moment()
    flat = seen_at(level, HEIGHT, np.array([0.0, 0.0, 1.0]), 100.0, 0.02)
    steep = seen_at(moment(rotation=tilt @ level.rotation), HEIGHT, tilt @ [0.0, 0.0, 1.0], 100.0, 0.02)
    for name in ("aside", "aside_rate", "height", "pressure", "left", "right", "speed", "heading", "course"):
        assert getattr(steep, name) == pytest.approx(getattr(flat, name), abs=1e-12)
    assert steep.place[0] == pytest.approx(10.0 + 0.1 * math.cos(0.3) * cos)


@pytest.mark.parametrize("pitch", [0.0, 0.3])
def test_who_leans_is_seen_leaning(pitch: float) -> None:
    """Rolled by 0.5 rad to the left about the feet's middle, skis level with the snow though the body pitches."""
    roll = -0.5
    cos, sin = math.cos(roll), math.sin(roll)
    lean = np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])
    boots = [[[0.0, y, 0.0], *(lean.T @ np.eye(3)).T, [0.0, 0.0, 0.0]] for y in (0.22, -0.22)]
    boots[0][1][2] += math.tan(pitch) * cos
    boots[1][1][2] -= math.tan(pitch) * cos
    found = seen_at(moment(rotation=lean, boots=np.array(boots)), HEIGHT, np.array([0.0, 0.0, 1.0]), 100.0, 0.02)
    assert (found.aside, found.height) == pytest.approx((HEIGHT * math.sin(0.5), HEIGHT * math.cos(0.5)))
    assert found.lean == pytest.approx(0.5)


def test_edges_of_a_scenario() -> None:
    """2 S_f² L/H_V."""
    snow, ski, found = TURNS.contact.snow, TURNS.ski, Edges.of(TURNS, 9.0, Skier(greatest_edge=1.0))
    strength = snow.failure_shear_stress
    assert strength is not None
    assert found.softness == pytest.approx(2.0 * strength**2 * ski.running_length / snow.snow_hardness)
    assert (found.gravity, found.greatest, found.radius) == (9.0, 1.0, ski.sidecut_radius_of_edge_line)


EDGES = Edges(radius=12.0, gravity=9.0, softness=4e4, greatest=1.0, carving_share=0.4, beyond_lean=0.05)


def test_the_edge_goes_from_a_skid_to_a_carve() -> None:
    """Below 0.4 of v²/R the skid's alone; half way to 1 half of each; beyond 1 R_sc cos ϑ = R, within the greatest."""
    speed, load, grip = 6.0, 700.0, 0.3
    skid, carve = math.atan(grip**2 * load / 8e4), math.atan(grip) + 0.05
    straightest = 36.0 / 12.0
    asked = {0.39: skid, 0.7: 0.5 * (skid + carve), 1.0: carve, 0.55: skid + (carve - skid) * 0.15625}
    for share, angle in asked.items():
        assert EDGES.angle(share * straightest, grip, speed, load) == pytest.approx(angle)
        assert EDGES.angle(-share * straightest, -grip, speed, load) == pytest.approx(-angle)
    assert EDGES.angle(1.5 * straightest, grip, speed, load) == pytest.approx(math.acos(1.0 / 1.5))
    assert EDGES.angle(9.0 * straightest, grip, speed, load) == 1.0
    assert EDGES.angle(1.1 * straightest, 0.9, speed, load) == pytest.approx(math.atan(0.9) + 0.05)
    assert EDGES.angle(0.3 * straightest, 99.0, speed, load) == 1.0
    assert EDGES.angle(0.3 * straightest, 9.0, speed, load) == pytest.approx(math.atan(81.0 * load / 8e4))


def test_a_carve_leans_no_more_than_the_greatest_edge() -> None:
    assert EDGES.carving_acceleration(20.0) == pytest.approx(400.0 / (12.0 * math.cos(1.0)))


def test_who_turns_over_time_looks_at_no_gates() -> None:
    slalom = load_scenario("slalom-20-gates")
    assert slalom.skier is not None
    assert isinstance(BalancedSkier(slalom).steering, LineThroughGates)
    assert isinstance(BalancedSkier(slalom.with_(skier=replace(slalom.skier, steers="turns"))).steering, TurnsOverTime)


class Hill:
    """A line that is a parabola."""

    def at(self, x: float) -> tuple[float, float, float]:
        return 0.02 * x * x, 0.04 * x, 0.04


def test_a_line_is_pursued_from_beside_it() -> None:
    """v² κ, -r² e for the distance and -2 r v sin δ for the angle by which it will be off, half a second ahead."""
    at = Underway(0.0, 1.0, 0.3, 0.2, 5.0, 2.0)
    turned = 0.5 * 2.0 * 0.5 / 5.0
    x, y = 1.0 + 2.5 * math.cos(0.2 + turned), 0.3 + 2.5 * math.sin(0.2 + turned)
    slope = 0.04 * x
    curvature = 0.04 / (1.0 + slope**2) ** 1.5
    off = (y - 0.02 * x * x) / math.sqrt(1.0 + slope**2)
    angle = 0.2 + 2.0 * 0.5 / 5.0 - math.atan(slope)
    expected = 25.0 * curvature - 9.0 * off - 6.0 * 5.0 * math.sin(angle)
    assert pursued(Hill(), at, sight=0.5, rate=3.0) == pytest.approx(expected)
    slow = Underway(0.0, 1.0, 0.3, 0.2, 0.1, 2.0)  # turns as at 1 m/s
    x = 1.0 + 0.05 * math.cos(0.7)
    slope, y = 0.04 * x, 0.3 + 0.05 * math.sin(0.7)
    off = (y - 0.02 * x * x) / math.sqrt(1.0 + slope**2)
    expected = 0.01 * 0.04 / (1.0 + slope**2) ** 1.5 - 9.0 * off - 0.6 * math.sin(1.2 - math.atan(slope))
    assert pursued(Hill(), slow, sight=0.5, rate=3.0) == pytest.approx(expected)
